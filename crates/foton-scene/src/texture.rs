//! Colours over texture coordinates.

use std::sync::Arc;

use foton_math::Rgb;
use foton_math::glam::{DAffine2, DVec2, Vec2};

use crate::description::{Bitmap, Texture, TextureKind, Wrap};

/// Texture coordinates from here on count as zero, as do those that are not numbers.
const FARTHEST: f32 = 1e12;

/// A texture ready to be looked up.
#[derive(Clone, Debug)]
pub(crate) struct Sampler {
    to_uv: DAffine2,
    kind: Kind,
}

#[derive(Clone, Debug)]
enum Kind {
    Bitmap { bitmap: Arc<Bitmap>, wrap: Wrap, bilinear: bool },
    Checkerboard { colours: [Rgb; 2] },
}

impl Sampler {
    pub(crate) fn new(texture: &Texture) -> Self {
        let kind = match &texture.kind {
            TextureKind::Bitmap { bitmap, wrap, bilinear } => {
                Kind::Bitmap { bitmap: bitmap.clone(), wrap: *wrap, bilinear: *bilinear }
            }
            TextureKind::Checkerboard { colours } => Kind::Checkerboard { colours: *colours },
        };
        Self { to_uv: texture.to_uv, kind }
    }

    /// The colour at a texture coordinate; v points up.
    pub(crate) fn colour(&self, uv: Vec2) -> Rgb {
        let uv = self.to_uv.transform_point2(uv.as_dvec2()).as_vec2();
        // So far out single precision has no fractions left, and infinities would make colours that are no numbers.
        let uv = if uv.abs().max_element() < FARTHEST { uv } else { Vec2::ZERO };
        match &self.kind {
            Kind::Checkerboard { colours } => {
                let field = uv - uv.floor();
                colours[usize::from((field.x > 0.5) != (field.y > 0.5))]
            }
            Kind::Bitmap { bitmap, wrap, bilinear } => {
                let size = Vec2::new(bitmap.width as f32, bitmap.height as f32);
                let p = Vec2::new(uv.x, 1.0 - uv.y) * size;
                let at = |x: f32, y: f32| {
                    let x = wrapped(x as i64, bitmap.width, *wrap);
                    let y = wrapped(y as i64, bitmap.height, *wrap);
                    bitmap.pixels[y * bitmap.width as usize + x]
                };
                if !bilinear {
                    let p = p.floor();
                    return at(p.x, p.y);
                }
                let low = (p - 0.5).floor();
                let f = p - 0.5 - low;
                let row = |y: f32| at(low.x, y) * (1.0 - f.x) + at(low.x + 1.0, y) * f.x;
                row(low.y) * (1.0 - f.y) + row(low.y + 1.0) * f.y
            }
        }
    }
}

impl Sampler {
    /// How far along u and v a slope is taken: half a texel of a bitmap, so that slopes are continuous.
    pub(crate) fn step(&self) -> Vec2 {
        const SMALLEST: f64 = 1e-6;
        let size = match &self.kind {
            Kind::Bitmap { bitmap, .. } => DVec2::new(f64::from(bitmap.width), f64::from(bitmap.height)),
            Kind::Checkerboard { .. } => DVec2::splat(512.0),
        };
        let m = self.to_uv.matrix2;
        let texels = |axis: DVec2| (axis.abs() * size).max_element();
        let step = |axis: DVec2| (0.5 / texels(axis).max(1e-6)).max(SMALLEST) as f32;
        Vec2::new(step(m.x_axis), step(m.y_axis))
    }

    /// One number at a texture coordinate: luminance of a bitmap, the mean channel of other colours, as in Mitsuba 3.
    pub(crate) fn scalar(&self, uv: Vec2) -> f32 {
        let colour = self.colour(uv);
        if matches!(self.kind, Kind::Bitmap { .. }) { colour.luminance() } else { colour.mean() }
    }
}

impl Sampler {
    /// The least and the greatest of [`Sampler::scalar`].
    pub(crate) fn scalar_range(&self) -> [f32; 2] {
        let of = |numbers: &mut dyn Iterator<Item = f32>| {
            let [least, most] =
                numbers.fold([f32::INFINITY, f32::NEG_INFINITY], |[a, b], x| [a.min(x), b.max(x)]);
            if least <= most { [least, most] } else { [0.0, 0.0] }
        };
        match &self.kind {
            // Interpolation lies between pixels.
            Kind::Bitmap { bitmap, .. } => of(&mut bitmap.pixels.iter().map(|p| p.luminance())),
            Kind::Checkerboard { colours } => of(&mut colours.iter().map(|c| c.mean())),
        }
    }
}

/// The pixel that a coordinate beyond the picture shows.
fn wrapped(i: i64, size: u32, wrap: Wrap) -> usize {
    let n = i64::from(size);
    let inside = match wrap {
        Wrap::Repeat => i.rem_euclid(n),
        Wrap::Clamp => i.clamp(0, n - 1),
        Wrap::Mirror => {
            let m = i.rem_euclid(2 * n);
            if m < n { m } else { 2 * n - 1 - m }
        }
    };
    inside as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sampler(kind: TextureKind) -> Sampler {
        Sampler::new(&Texture { name: "t".into(), to_uv: DAffine2::IDENTITY, kind })
    }

    #[test]
    fn bitmaps_start_at_the_top_left_and_wrap_as_asked() {
        let pixels = [1.0, 2.0, 3.0, 4.0].map(Rgb::splat).to_vec();
        let bitmap = Arc::new(Bitmap { width: 2, height: 2, pixels });
        let value = |wrap, bilinear, u, v| {
            sampler(TextureKind::Bitmap { bitmap: bitmap.clone(), wrap, bilinear }).colour(Vec2::new(u, v)).r
        };
        assert_eq!(value(Wrap::Repeat, false, 0.1, 0.9), 1.0);
        assert_eq!(value(Wrap::Repeat, false, 0.9, 0.1), 4.0);
        assert_eq!(value(Wrap::Repeat, false, 1.1, 0.9), 1.0);
        assert_eq!(value(Wrap::Clamp, false, 1.1, 0.9), 2.0);
        assert_eq!(value(Wrap::Mirror, false, 1.1, 0.9), 2.0);
        assert_eq!(value(Wrap::Mirror, false, -0.1, 0.9), 1.0);
        assert!((value(Wrap::Clamp, true, 0.5, 0.5) - 2.5).abs() < 1e-6);
        assert!((value(Wrap::Repeat, true, 0.0, 0.75) - 1.5).abs() < 1e-6);
    }

    /// A mesh may have coordinates of 10³⁰⁰, a transform may magnify them, and between two infinities lies no number.
    #[test]
    fn coordinates_beyond_all_fractions_have_a_colour_all_the_same() {
        let bitmap = Arc::new(Bitmap { width: 2, height: 2, pixels: vec![Rgb::splat(0.5); 4] });
        for far in [1e13, -1e30, f32::MAX, f32::INFINITY, f32::NEG_INFINITY, f32::NAN] {
            for wrap in [Wrap::Repeat, Wrap::Clamp, Wrap::Mirror] {
                for bilinear in [false, true] {
                    let kind = TextureKind::Bitmap { bitmap: bitmap.clone(), wrap, bilinear };
                    for uv in [Vec2::new(far, 0.3), Vec2::new(0.3, far), Vec2::splat(far)] {
                        assert_eq!(sampler(kind.clone()).colour(uv), Rgb::splat(0.5), "{uv} {wrap:?}");
                        let mut magnified = sampler(kind.clone());
                        magnified.to_uv = DAffine2::from_scale((1e300, 1e300).into());
                        assert_eq!(magnified.colour(uv), Rgb::splat(0.5), "{uv} {wrap:?}, magnified");
                    }
                }
            }
        }
    }

    #[test]
    fn the_checkerboards_first_field_is_at_the_origin() {
        let s = sampler(TextureKind::Checkerboard { colours: [Rgb::BLACK, Rgb::WHITE] });
        let at = |u, v| s.colour(Vec2::new(u, v)).r;
        assert_eq!((at(0.2, 0.2), at(0.7, 0.2), at(0.7, 0.7), at(1.2, 0.2)), (0.0, 1.0, 0.0, 0.0));
    }
}
