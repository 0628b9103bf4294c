//! What a material wants of a picture: of which channel, and what its numbers become.

use foton_math::Rgb;
use foton_scene::description::Bitmap;

use crate::image::{Channel, Curve, Purpose, Reading};

/// What a material wants of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Wanted {
    /// Colours that sRGB's curve encodes, times a factor: shares of light.
    Colour([u32; 3]),
    /// The same, of light that is emitted.
    Light([u32; 3]),
    /// Linear numbers of a channel, times a factor.
    Number(usize, u32),
    /// The squares of linear numbers of a channel, times a factor: α of a roughness.
    Square(usize, u32),
    /// 1 less a linear number of a channel, times a factor: the roughness of a gloss.
    Rest(usize, u32),
    /// Opacity times a factor.
    Opacity(u32),
    /// Whether opacity times a factor reaches a threshold.
    Cutout(u32, u32),
    /// Normals whose slopes are scaled, upside down or not.
    Normal(u32, bool),
}

impl Wanted {
    pub(super) fn colour(factor: Rgb) -> Self {
        Self::Colour(factor.to_array().map(f32::to_bits))
    }

    pub(super) fn light(factor: Rgb) -> Self {
        Self::Light(factor.to_array().map(f32::to_bits))
    }

    pub(super) fn number(channel: usize, factor: f32) -> Self {
        Self::Number(channel, factor.to_bits())
    }

    /// How an image is decoded for that.
    pub(super) fn reading(self) -> Reading {
        let linear = Reading { curve: Curve::Power(1.0), purpose: Purpose::Number, ..Reading::LIGHT };
        match self {
            Self::Colour(_) | Self::Light(_) => Reading::LIGHT,
            Self::Number(channel, _) | Self::Square(channel, _) | Self::Rest(channel, _) => {
                let channel = if channel < 3 { Channel::Rgb(channel) } else { Channel::Opacity };
                Reading { channel: Some(channel), ..linear }
            }
            Self::Opacity(_) | Self::Cutout(..) => Reading { channel: Some(Channel::Opacity), ..linear },
            Self::Normal(..) => linear,
        }
    }

    /// What the numbers of a picture become.
    pub(super) fn apply(self, bitmap: &mut Bitmap) {
        let share = |x: f32| x.clamp(0.0, 1.0);
        let of_each = |bitmap: &mut Bitmap, of: &dyn Fn(Rgb) -> Rgb| {
            bitmap.pixels.iter_mut().for_each(|p| *p = of(*p));
        };
        match self {
            Self::Colour(factor) => {
                let factor = Rgb::from_array(factor.map(f32::from_bits));
                of_each(bitmap, &|p| (p * factor).map(share));
            }
            Self::Light(factor) => {
                let factor = Rgb::from_array(factor.map(f32::from_bits));
                of_each(bitmap, &|p| p * factor);
            }
            Self::Number(_, factor) | Self::Opacity(factor) => {
                let factor = f32::from_bits(factor);
                of_each(bitmap, &|p| (p * factor).map(share));
            }
            Self::Square(_, factor) => {
                let factor = f32::from_bits(factor);
                of_each(bitmap, &|p| (p * factor).map(|x| share(x) * share(x)));
            }
            Self::Rest(_, factor) => {
                let factor = f32::from_bits(factor);
                of_each(bitmap, &|p| (p * factor).map(|x| 1.0 - share(x)));
            }
            Self::Cutout(factor, threshold) => {
                let (factor, threshold) = (f32::from_bits(factor), f32::from_bits(threshold));
                of_each(bitmap, &|p| p.map(|x| f32::from(u8::from(x * factor >= threshold))));
            }
            Self::Normal(scale, is_turned) => {
                let scale = f32::from_bits(scale);
                let up = if is_turned { -scale } else { scale };
                let scaled = |x: f32, by: f32| 0.5 + (x - 0.5) * by;
                of_each(bitmap, &|p| Rgb::new(scaled(p.r, scale), scaled(p.g, up), p.b));
            }
        }
    }
}
