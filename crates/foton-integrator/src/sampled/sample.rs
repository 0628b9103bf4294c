//! What an estimator is given of an eye sample, and what it makes of it.

use foton_math::glam::Vec2;
use foton_math::{Ray, Rgb, Stream};
use foton_transport::direct_light::{SCRAMBLES, Scramble};
use foton_transport::photon_map::PathClass;
use foton_transport::{Differential, LeftOut};

/// An eye sample that is to be followed.
pub(crate) struct EyeSample {
    /// From the camera on.
    pub(crate) ray: Ray,
    /// How far it is from neighbouring samples; `None` where nothing asks for it.
    pub(crate) differential: Option<Differential>,
    /// What is left to chance.
    pub(crate) numbers: Numbers,
}

/// Random numbers along a path: those of its first diffuse surface are stratified over all passes' samples of the pixel.
pub(crate) struct Numbers {
    stream: Stream,
    /// Index of the sample, and the pixel's scrambles; `None` once they are used.
    first_lights: Option<(u32, [Scramble; SCRAMBLES])>,
    first_direction: Option<Vec2>,
    /// Streams that were handed out.
    streams: u64,
}

impl Numbers {
    /// Those of the `index`-th sample of a pixel with these scrambles.
    pub(crate) const fn new(
        stream: Stream,
        index: u32,
        scrambles: [Scramble; SCRAMBLES],
        direction: Vec2,
    ) -> Self {
        Self { stream, first_lights: Some((index, scrambles)), first_direction: Some(direction), streams: 0 }
    }

    /// For a ray to each emitter, or to one that is chosen.
    pub(crate) fn lights(&mut self) -> (u32, [Scramble; SCRAMBLES]) {
        self.first_lights.take().unwrap_or_else(|| (0, scrambles(&mut self.stream)))
    }

    /// For a direction.
    pub(crate) fn direction(&mut self) -> Vec2 {
        self.first_direction.take().unwrap_or_else(|| self.stream.next_2d())
    }

    /// A stream for as many as it takes, with numbers of its own each time.
    pub(crate) const fn stream(&mut self) -> Stream {
        self.streams += 1;
        self.stream.from_dimension(self.streams << 32)
    }

    /// For a choice.
    pub(crate) fn choice(&mut self) -> f32 {
        self.stream.next_1d()
    }
}

/// Scrambles at random.
pub(crate) fn scrambles(stream: &mut Stream) -> [Scramble; SCRAMBLES] {
    std::array::from_fn(|_| std::array::from_fn(|_| stream.next_bits()))
}

/// What eye samples of a pixel have seen: sums over samples.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Seen {
    /// Radiance of emitters, directly or by specular bounces.
    pub(crate) emission: Rgb,
    /// Reflected radiance by path class.
    pub(crate) reflected: [Rgb; PathClass::ALL.len()],
    /// Whether anything reflects.
    pub(crate) scatters: bool,
    /// The shape that the first ray met; `None` for none.
    pub(crate) shape: Option<u32>,
    /// Rays traced.
    pub(crate) rays: u64,
    /// The first value that was no finite number.
    pub(crate) left_out: Option<LeftOut>,
}

impl Seen {
    /// All radiance.
    pub(crate) fn all(&self) -> Rgb {
        self.reflected.iter().fold(self.emission, |sum, class| sum + *class)
    }

    /// Adds light of a class, or of emitters that are seen.
    pub(crate) fn add(&mut self, class: Option<PathClass>, light: Rgb) {
        match class {
            None => self.emission += light,
            Some(class) => self.reflected[class as usize] += light,
        }
    }
}
