//! What training passes note of their photons.

use foton_math::Rgb;
use foton_scene::PrimaryNumbers;

use super::cells::Start;
use super::worth::Worth;

/// Of a pass, about so many photons are noted at most.
const MAX_SAMPLES: u64 = 1 << 17;

/// What one photon cost and was worth.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// Where it started.
    pub(super) primary: PrimaryNumbers,
    pub(super) emitter: u32,
    /// Density with which it was chosen.
    pub(super) density: f64,
    /// Σ over the places where it was stored of its squared power times what that is worth there.
    pub(super) worth: f64,
    /// In rays, about: one for the start, one for each ray, one for each time it was stored.
    pub(super) cost: f32,
}

impl Sample {
    /// A photon that starts.
    #[must_use]
    #[inline]
    pub fn new(start: &Start) -> Self {
        Self {
            primary: start.primary,
            emitter: start.emitter as u32,
            density: start.density,
            worth: 0.0,
            cost: 1.0,
        }
    }

    /// Notes a ray.
    #[inline]
    pub fn has_flown(&mut self) {
        self.cost += 1.0;
    }

    /// Notes that it is stored where power is worth so much.
    #[inline]
    pub fn is_stored(&mut self, power: Rgb, worth: f32) {
        let luminance = f64::from(power.luminance());
        self.worth += luminance * luminance * f64::from(worth);
        self.cost += 1.0;
    }
}

/// All that a training pass has noted.
#[derive(Default)]
pub struct Samples {
    pub(super) noted: Vec<Sample>,
}

impl Samples {
    /// Forgets all.
    pub fn clear(&mut self) {
        self.noted.clear();
    }

    /// Takes those of a chunk.
    pub fn take(&mut self, mut chunk: Vec<Sample>) {
        self.noted.append(&mut chunk);
    }

    /// Bytes held.
    #[must_use]
    pub const fn held(&self) -> usize {
        self.noted.capacity() * size_of::<Sample>()
    }

    /// Of a pass of so many photons every how-many-th is noted.
    #[must_use]
    pub const fn stride(photons: u64) -> u64 {
        let stride = photons.div_ceil(MAX_SAMPLES);
        if stride == 0 { 1 } else { stride }
    }

    /// Bytes that the samples of a pass of so many photons take, here and in chunks.
    #[must_use]
    pub const fn bytes(photons: u64) -> u64 {
        let noted = if photons < MAX_SAMPLES { photons } else { MAX_SAMPLES };
        2 * noted * size_of::<Sample>() as u64
    }
}

/// Whether cells are learnt from the pass that follows so many others: often at first, and then ever more rarely.
#[must_use]
pub const fn is_training_pass(before: u64) -> bool {
    let pass = before + 1;
    if pass > 64 { pass.is_multiple_of(64) } else { pass.is_power_of_two() }
}

/// What a training pass needs while photons fly.
#[derive(Clone, Copy)]
pub struct Training<'a> {
    /// What light is worth where.
    pub worth: &'a Worth,
    /// Every how-many-th photon is noted.
    pub stride: u64,
}
