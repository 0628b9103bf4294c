//! Colours over texture coordinates: at a point, and the mean over an area around it.
//!
//! Photons look textures up at points. An eye path looks up the mean over its footprint, the area that an eye sample stands for: a frozen
//! sample would otherwise freeze one of the colours that its pixel covers.

mod checkerboard;
mod filter;

use std::sync::Arc;

use foton_math::Rgb;
use foton_math::glam::{DAffine2, DVec2, Vec2};

use crate::attributes::{Attributes, Corner};
use crate::bitmap::{Bitmap, Wrap};
use crate::description::{Colour, Texture, TextureKind};
use filter::Probes;

/// Texture coordinates from here on count as zero, as do those that are not numbers.
const FARTHEST: f32 = 1e12;

/// A lookup in a bitmap has at most so many parts along its footprint's longer side.
const MOST_PROBES: u32 = 16;

/// Where a texture is looked up.
#[derive(Clone, Copy, Debug)]
pub(crate) struct At {
    /// Texture coordinate of the surface; v points up.
    pub(crate) uv: Vec2,
    /// The place on a mesh.
    pub(crate) corner: Corner,
}

/// A texture ready to be looked up.
#[derive(Clone, Debug)]
pub(crate) struct Sampler {
    to_uv: DAffine2,
    kind: Kind,
}

#[derive(Clone, Debug)]
enum Kind {
    Bitmap { bitmap: Arc<Bitmap>, wrap: Wrap, bilinear: bool },
    Checkerboard { colours: [Source; 2] },
    Attribute { values: Arc<Attributes>, scale: f32, most: f32 },
}

/// A colour of a checkerboard.
#[derive(Clone, Debug)]
enum Source {
    Constant(Rgb),
    Texture(Arc<Sampler>),
}

impl Source {
    fn colour(&self, look: impl Fn(&Sampler) -> Rgb) -> Rgb {
        match self {
            Self::Constant(c) => *c,
            Self::Texture(sampler) => look(sampler),
        }
    }
}

/// All textures of a description, of which `attributes` has those of meshes. One that is made of another stands behind it.
pub(crate) fn samplers(textures: &[Texture], attributes: &[Option<Arc<Attributes>>]) -> Arc<[Arc<Sampler>]> {
    let mut all: Vec<Arc<Sampler>> = Vec::with_capacity(textures.len());
    for (texture, values) in textures.iter().zip(attributes) {
        let kind = match &texture.kind {
            TextureKind::Bitmap { bitmap, wrap, bilinear } => {
                Kind::Bitmap { bitmap: bitmap.clone(), wrap: *wrap, bilinear: *bilinear }
            }
            TextureKind::Checkerboard { colours } => {
                let source = |colour: &Colour| match *colour {
                    Colour::Constant(c) => Source::Constant(c),
                    Colour::Texture(i) => {
                        all.get(i).map_or(Source::Constant(Rgb::BLACK), |s| Source::Texture(Arc::clone(s)))
                    }
                };
                Kind::Checkerboard { colours: [source(&colours[0]), source(&colours[1])] }
            }
            TextureKind::Attribute { scale, most, .. } => {
                let values = values.clone().unwrap_or_default();
                Kind::Attribute { values, scale: *scale, most: *most }
            }
        };
        all.push(Arc::new(Sampler { to_uv: texture.to_uv, kind }));
    }
    all.into()
}

impl Sampler {
    /// The colour at a point.
    #[inline]
    pub(crate) fn colour(&self, at: &At) -> Rgb {
        match &self.kind {
            Kind::Bitmap { bitmap, wrap, bilinear } => bitmap.at(self.own(at.uv), *wrap, *bilinear),
            Kind::Checkerboard { colours } => {
                let field = self.own(at.uv);
                let field = field - field.floor();
                colours[usize::from((field.x > 0.5) != (field.y > 0.5))].colour(|s| s.colour(at))
            }
            Kind::Attribute { values, scale, most } => {
                values.at(&at.corner).map(|c| (c * scale).clamp(0.0, *most))
            }
        }
    }

    /// The mean colour over the parallelogram around a point whose sides are `axes`, in coordinates of the surface. Bitmaps without
    /// interpolation have sharp pixels as long as these are larger.
    pub(crate) fn filtered(&self, at: &At, axes: &[Vec2; 2]) -> Rgb {
        match &self.kind {
            Kind::Bitmap { bitmap, wrap, bilinear } => {
                let uv = self.own(at.uv);
                let pixels = self.own_axes(axes).map(|a| a * bitmap.size());
                if Probes::is_point(&pixels, 1.0) {
                    return bitmap.at(uv, *wrap, *bilinear);
                }
                let probes = Probes::new(pixels, MOST_PROBES, 1.0);
                probes.mean(|offset| smoothed(bitmap, uv + offset / bitmap.size(), *wrap, probes.width))
            }
            Kind::Checkerboard { colours } => {
                let share = checkerboard::share_of_first(self.own(at.uv), self.own_axes(axes));
                let [first, second] = colours.each_ref().map(|c| c.colour(|s| s.filtered(at, axes)));
                second + (first - second) * share
            }
            Kind::Attribute { .. } => self.colour(at),
        }
    }

    /// How far along u and v a slope is taken: half a pixel of a bitmap, so that slopes are continuous.
    pub(crate) fn step(&self) -> Vec2 {
        /// Slopes of coordinates that are hardly scaled at all are taken over no more than this.
        const LARGEST: f32 = 0.5;
        let size = match &self.kind {
            Kind::Bitmap { bitmap, .. } => bitmap.size(),
            Kind::Checkerboard { .. } | Kind::Attribute { .. } => Vec2::splat(512.0),
        };
        let m = self.to_uv.matrix2;
        let step = |axis: DVec2| (0.5 / (axis.as_vec2().abs() * size).max_element()).min(LARGEST);
        Vec2::new(step(m.x_axis), step(m.y_axis))
    }

    /// One number at a point: luminance of a bitmap, the mean channel of other colours, as in Mitsuba 3.
    pub(crate) fn scalar(&self, at: &At) -> f32 {
        self.number(self.colour(at))
    }

    /// The mean of one number over an area.
    pub(crate) fn filtered_scalar(&self, at: &At, axes: &[Vec2; 2]) -> f32 {
        self.number(self.filtered(at, axes))
    }

    /// The least and the greatest of [`Sampler::scalar`].
    pub(crate) fn scalar_range(&self) -> [f32; 2] {
        let join = |[a, b]: [f32; 2], [c, d]: [f32; 2]| [a.min(c), b.max(d)];
        let nothing = [f32::INFINITY, f32::NEG_INFINITY];
        let range = match &self.kind {
            // Interpolation lies between pixels.
            Kind::Bitmap { bitmap, .. } => {
                bitmap.pixels.iter().map(|p| p.luminance()).fold(nothing, |range, x| join(range, [x, x]))
            }
            Kind::Checkerboard { colours } => colours.iter().fold(nothing, |range, colour| {
                join(
                    range,
                    match colour {
                        Source::Constant(c) => [c.mean(); 2],
                        Source::Texture(inner) => inner.scalar_range(),
                    },
                )
            }),
            Kind::Attribute { most, .. } => [0.0, *most],
        };
        if range[0] <= range[1] { range } else { [0.0, 0.0] }
    }

    fn number(&self, colour: Rgb) -> f32 {
        if matches!(self.kind, Kind::Bitmap { .. }) { colour.luminance() } else { colour.mean() }
    }

    /// Width and height of a bitmap in pixels; a square for others.
    pub(crate) fn shape(&self) -> [f64; 2] {
        match &self.kind {
            Kind::Bitmap { bitmap, .. } => [bitmap.width, bitmap.height].map(f64::from),
            Kind::Checkerboard { .. } | Kind::Attribute { .. } => [1.0; 2],
        }
    }

    /// About how many pixels there are to a unit of the surface's u and v; `None` where there are none.
    pub(crate) fn detail(&self) -> Option<Vec2> {
        let m = self.to_uv.matrix2.as_mat2();
        match &self.kind {
            Kind::Bitmap { bitmap, .. } => {
                let along = |axis: Vec2| (axis * bitmap.size()).length();
                Some(Vec2::new(along(m.x_axis), along(m.y_axis)))
            }
            Kind::Checkerboard { colours } => {
                let inner = colours.iter().filter_map(|c| match c {
                    Source::Constant(_) => None,
                    Source::Texture(sampler) => sampler.detail(),
                });
                let fields = Vec2::new(m.x_axis.length(), m.y_axis.length()) * checkerboard::FIELDS;
                Some(inner.fold(fields, Vec2::max))
            }
            Kind::Attribute { .. } => None,
        }
    }

    /// The texture's own coordinate.
    fn own(&self, uv: Vec2) -> Vec2 {
        let uv = self.to_uv.transform_point2(uv.as_dvec2()).as_vec2();
        // So far out single precision has no fractions left, and infinities would make colours that are no numbers.
        if uv.abs().max_element() < FARTHEST { uv } else { Vec2::ZERO }
    }

    fn own_axes(&self, axes: &[Vec2; 2]) -> [Vec2; 2] {
        axes.map(|a| self.to_uv.transform_vector2(a.as_dvec2()).as_vec2())
    }
}

/// The mean over a square of `width` pixels around a place, between two of the smaller copies.
fn smoothed(bitmap: &Bitmap, uv: Vec2, wrap: Wrap, width: f32) -> Rgb {
    let smaller = bitmap.smaller();
    let level = width.max(1.0).log2().min(smaller.len() as f32);
    let (lower, share) = (level as usize, level.fract());
    let of = |level: usize| level.checked_sub(1).map_or(bitmap, |i| &smaller[i]).at(uv, wrap, true);
    let fine = of(lower);
    if share > 0.0 { fine + (of(lower + 1) - fine) * share } else { fine }
}

#[cfg(test)]
mod tests;
