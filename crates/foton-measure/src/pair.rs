//! An image and its reference, and the figures that need no neighbours: RMSE, relMSE, means.

use foton_film::{Image, Plane};
use foton_math::Rgb;
use thiserror::Error;

/// Added to the squared reference in relative errors, so that black pixels do not outweigh all others.
const EPSILON: f64 = 0.01;

/// Two images of one size of which at least one pixel is finite in both: `a`, and `b`, the reference.
#[derive(Clone, Copy, Debug)]
pub struct Pair<'a> {
    pub(crate) a: &'a Image,
    pub(crate) b: &'a Image,
    non_finite: NonFinite,
}

/// A figure for red, green and blue, and one for all of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Channels {
    /// Red, green, blue.
    pub rgb: [f64; 3],
    /// Over all channels.
    pub all: f64,
}

/// Pixels with a NaN or infinite channel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct NonFinite {
    /// In the image.
    pub a: usize,
    /// In the reference.
    pub b: usize,
    /// In either: the pixels left out.
    pub either: usize,
}

/// Why two images cannot be compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum CompareError {
    /// Their sizes differ.
    #[error("A is {} × {} pixels, B is {} × {}: only images of one size can be compared", a.0, a.1, b.0, b.1)]
    Sizes {
        /// Width and height of the image.
        a: (u32, u32),
        /// Width and height of the reference.
        b: (u32, u32),
    },
    /// Nothing is left to compare.
    #[error("none of {pixels} pixels is finite in both images")]
    NothingFinite {
        /// How many there are.
        pixels: usize,
    },
}

impl<'a> Pair<'a> {
    /// The image `a` and its reference `b`.
    ///
    /// # Errors
    /// [`CompareError`]: the sizes differ, or no pixel is finite in both.
    ///
    /// # Panics
    /// If the pixels of an image do not fill its size.
    pub fn new(a: &'a Image, b: &'a Image) -> Result<Self, CompareError> {
        let size = |image: &Image| {
            let (width, height) = (image.width, image.height);
            assert_eq!(image.pixels.len(), width as usize * height as usize, "{width} × {height}");
            (width, height)
        };
        if size(a) != size(b) {
            return Err(CompareError::Sizes { a: size(a), b: size(b) });
        }
        let mut non_finite = NonFinite::default();
        for (x, y) in a.pixels.iter().zip(&b.pixels) {
            non_finite.a += usize::from(!x.is_finite());
            non_finite.b += usize::from(!y.is_finite());
            non_finite.either += usize::from(!(x.is_finite() && y.is_finite()));
        }
        if non_finite.either == a.pixels.len() {
            return Err(CompareError::NothingFinite { pixels: a.pixels.len() });
        }
        Ok(Self { a, b, non_finite })
    }

    /// How many pixels are not finite.
    #[must_use]
    pub const fn non_finite(&self) -> NonFinite {
        self.non_finite
    }

    /// Root mean square error √(mean((x − y)²)), in units of radiance.
    #[must_use]
    pub fn rmse(&self) -> Channels {
        let mean_square = self.mean_of(|x, y| (x - y) * (x - y));
        Channels { rgb: mean_square.rgb.map(f64::sqrt), all: mean_square.all.sqrt() }
    }

    /// Root mean square difference of luminance over the mean luminance of the reference, over the pixels that `counts` and without the
    /// brightest 0.5 % of those, in which a few may hold most of it. NaN where none counts.
    #[must_use]
    pub fn trimmed_rmse(&self, counts: impl Fn(usize) -> bool) -> f64 {
        const BRIGHTEST: f64 = 0.005;
        let luminance = |c: &Rgb| f64::from(c.luminance());
        let all = self.a.pixels.iter().zip(&self.b.pixels).enumerate();
        let mut pixels: Vec<[f64; 2]> = all
            .filter(|(pixel, (x, y))| counts(*pixel) && x.is_finite() && y.is_finite())
            .map(|(_, (x, y))| [luminance(x), luminance(y)])
            .collect();
        pixels.sort_by(|a, b| a[1].total_cmp(&b[1]));
        pixels.truncate(pixels.len() - (pixels.len() as f64 * BRIGHTEST) as usize);
        let count = pixels.len() as f64;
        let mean = pixels.iter().map(|[_, y]| y).sum::<f64>() / count;
        let square = pixels.iter().map(|[x, y]| (x - y) * (x - y)).sum::<f64>() / count;
        square.sqrt() / mean
    }

    /// Relative mean square error mean((x − y)²/(y² + 0.01)).
    #[must_use]
    pub fn rel_mse(&self) -> Channels {
        self.mean_of(relative_square)
    }

    /// Mean of the image.
    #[must_use]
    pub fn mean_a(&self) -> Channels {
        self.mean_of(|x, _| x)
    }

    /// Mean of the reference.
    #[must_use]
    pub fn mean_b(&self) -> Channels {
        self.mean_of(|_, y| y)
    }

    /// Mean of the image over the mean of the reference; not finite where the reference's mean is zero.
    #[must_use]
    pub fn ratio(&self) -> Channels {
        let (a, b) = (self.mean_a(), self.mean_b());
        Channels { rgb: std::array::from_fn(|c| a.rgb[c] / b.rgb[c]), all: a.all / b.all }
    }

    /// √(mean over the channels of (x − y)²/(y² + 0.01)) of each pixel, whose mean square is relMSE; NaN where a pixel
    /// is left out.
    #[must_use]
    pub fn relative_error(&self) -> Plane<f32> {
        let error = |(x, y): (&Rgb, &Rgb)| {
            if !(x.is_finite() && y.is_finite()) {
                return f32::NAN;
            }
            let squares = channels(*x).into_iter().zip(channels(*y)).map(|(x, y)| relative_square(x, y));
            (squares.sum::<f64>() / 3.0).sqrt() as f32
        };
        let values = self.a.pixels.iter().zip(&self.b.pixels).map(error).collect();
        Plane { width: self.a.width, height: self.a.height, values }
    }

    /// The signed difference x − y of each pixel; not finite where a pixel is left out.
    #[must_use]
    pub fn difference(&self) -> Image {
        let pixels = self.a.pixels.iter().zip(&self.b.pixels).map(|(&x, &y)| x - y).collect();
        Image { width: self.a.width, height: self.a.height, pixels }
    }

    /// The pixels that are finite in both images.
    fn finite(&self) -> impl Iterator<Item = (Rgb, Rgb)> {
        let pixels = self.a.pixels.iter().copied().zip(self.b.pixels.iter().copied());
        pixels.filter(|(x, y)| x.is_finite() && y.is_finite())
    }

    /// The mean of `f(x, y)` over the pixels, for each channel and over all.
    fn mean_of(&self, f: impl Fn(f64, f64) -> f64) -> Channels {
        let mut rgb = [0.0; 3];
        for (x, y) in self.finite() {
            for ((sum, x), y) in rgb.iter_mut().zip(channels(x)).zip(channels(y)) {
                *sum += f(x, y);
            }
        }
        let count = (self.a.pixels.len() - self.non_finite.either) as f64;
        let rgb = rgb.map(|sum| sum / count);
        Channels { rgb, all: rgb.iter().sum::<f64>() / 3.0 }
    }
}

/// (x − y)²/(y² + 0.01).
fn relative_square(x: f64, y: f64) -> f64 {
    (x - y) * (x - y) / (y * y + EPSILON)
}

fn channels(c: Rgb) -> [f64; 3] {
    c.to_array().map(f64::from)
}
