//! Linear RGB triples: radiance, power, reflectance. No colour management beyond the luminance weights of sRGB.

use std::iter::Sum;
use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Sub};

use glam::Vec3;

/// A linear RGB triple with sRGB primaries, in whatever unit its name says.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rgb {
    /// Red.
    pub r: f32,
    /// Green.
    pub g: f32,
    /// Blue.
    pub b: f32,
}

impl Rgb {
    /// No light.
    pub const BLACK: Self = Self::splat(0.0);
    /// One in each channel.
    pub const WHITE: Self = Self::splat(1.0);

    /// The triple of the three channels.
    #[must_use]
    #[inline]
    pub const fn new(r: f32, g: f32, b: f32) -> Self {
        Self { r, g, b }
    }

    /// The same value in each channel.
    #[must_use]
    #[inline]
    pub const fn splat(v: f32) -> Self {
        Self::new(v, v, v)
    }

    /// Channels as an array, red first.
    #[must_use]
    #[inline]
    pub const fn to_array(self) -> [f32; 3] {
        [self.r, self.g, self.b]
    }

    /// The triple of an array, red first.
    #[must_use]
    #[inline]
    pub const fn from_array([r, g, b]: [f32; 3]) -> Self {
        Self::new(r, g, b)
    }

    /// The largest channel.
    #[must_use]
    #[inline]
    pub fn max_component(self) -> f32 {
        self.r.max(self.g).max(self.b)
    }

    /// The mean of the channels: the measure by which the ledger and the choice of emitters count power.
    #[must_use]
    #[inline]
    pub fn mean(self) -> f32 {
        (self.r + self.g + self.b) / 3.0
    }

    /// What each channel adds to luminance, by ITU-R BT.709.
    pub const LUMINANCE: [f32; 3] = [0.2126, 0.7152, 0.0722];

    /// Relative luminance with the weights of ITU-R BT.709.
    #[must_use]
    #[inline]
    pub fn luminance(self) -> f32 {
        let [r, g, b] = Self::LUMINANCE;
        r * self.r + g * self.g + b * self.b
    }

    /// Whether no channel is above zero.
    #[must_use]
    #[inline]
    pub fn is_black(self) -> bool {
        self.max_component() <= 0.0
    }

    /// Whether every channel is finite.
    #[must_use]
    #[inline]
    pub fn is_finite(self) -> bool {
        self.r.is_finite() && self.g.is_finite() && self.b.is_finite()
    }

    /// `f` applied to each channel.
    #[must_use]
    #[inline]
    pub fn map(self, mut f: impl FnMut(f32) -> f32) -> Self {
        Self::new(f(self.r), f(self.g), f(self.b))
    }
}

impl From<Rgb> for Vec3 {
    #[inline]
    fn from(c: Rgb) -> Self {
        Self::new(c.r, c.g, c.b)
    }
}

impl Add for Rgb {
    type Output = Self;
    #[inline]
    fn add(self, o: Self) -> Self {
        Self::new(self.r + o.r, self.g + o.g, self.b + o.b)
    }
}

impl Sub for Rgb {
    type Output = Self;
    #[inline]
    fn sub(self, o: Self) -> Self {
        Self::new(self.r - o.r, self.g - o.g, self.b - o.b)
    }
}

impl AddAssign for Rgb {
    #[inline]
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}

impl Mul for Rgb {
    type Output = Self;
    #[inline]
    fn mul(self, o: Self) -> Self {
        Self::new(self.r * o.r, self.g * o.g, self.b * o.b)
    }
}

impl MulAssign for Rgb {
    #[inline]
    fn mul_assign(&mut self, o: Self) {
        *self = *self * o;
    }
}

impl Mul<f32> for Rgb {
    type Output = Self;
    #[inline]
    fn mul(self, s: f32) -> Self {
        self.map(|c| c * s)
    }
}

impl MulAssign<f32> for Rgb {
    #[inline]
    fn mul_assign(&mut self, s: f32) {
        *self = *self * s;
    }
}

impl Div<f32> for Rgb {
    type Output = Self;
    #[inline]
    fn div(self, s: f32) -> Self {
        self.map(|c| c / s)
    }
}

impl Sum for Rgb {
    #[inline]
    fn sum<I: Iterator<Item = Self>>(iter: I) -> Self {
        iter.fold(Self::BLACK, Add::add)
    }
}
