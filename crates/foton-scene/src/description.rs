//! A scene as a person or a file states it: world units, double precision, nothing derived.
//!
//! An editor changes a description and builds the next [`Scene`](crate::Scene) from it. Meanings follow Mitsuba 3, so
//! that one file renders alike in both. Nothing is validated here: building a scene does that.

use std::sync::Arc;

use foton_math::Rgb;
use foton_math::glam::{DAffine2, DAffine3, DVec2, DVec3};

/// Everything that a scene consists of.
#[derive(Clone, Debug, Default)]
pub struct SceneDescription {
    /// Cameras; the first is used unless another is asked for by name.
    pub sensors: Vec<SensorDescription>,
    /// Materials, referred to by index.
    pub materials: Vec<Material>,
    /// Textures, referred to by index.
    pub textures: Vec<Texture>,
    /// Surfaces, in the order of the file. The index is the shape's identity in every output.
    pub shapes: Vec<ShapeDescription>,
    /// Emitters that are not surfaces.
    pub emitters: Vec<EmitterDescription>,
    /// The longest path in edges, as Mitsuba counts them (1: emitters seen directly, 2: one bounce); `None`: no bound.
    pub max_depth: Option<u32>,
}

/// A camera.
#[derive(Clone, Debug)]
pub struct SensorDescription {
    /// The id in the file, or `sensor`, `sensor-2`, …
    pub name: String,
    /// Camera to world. The camera looks along its +z; +y is up in the image and +x points to the image's *left*.
    pub to_world: DAffine3,
    /// Field of view in degrees along `fov_axis`, in (0, 180).
    pub fov_degrees: f64,
    /// What `fov_degrees` spans.
    pub fov_axis: FovAxis,
    /// Image width in pixels, at least 1.
    pub width: u32,
    /// Image height in pixels, at least 1.
    pub height: u32,
    /// The part of the image that is rendered; `None`: all of it.
    pub crop: Option<Crop>,
    /// How eye samples spread around a pixel's centre.
    pub filter: Filter,
    /// Nothing nearer than this depth along the camera's z is seen, in world units. `None`: no bound.
    pub near_clip: Option<f64>,
    /// Nothing farther than this depth along the camera's z is seen, in world units. `None`: no bound.
    pub far_clip: Option<f64>,
}

impl SensorDescription {
    /// The same view at another size in pixels, a crop in proportion.
    pub fn resize(&mut self, width: u32, height: u32) {
        if let Some(crop) = &mut self.crop {
            // Rounded outwards, which keeps it inside and not empty.
            let scaled = |first: &mut u32, count: &mut u32, old: u32, new: u32| {
                let (old, new) = (u64::from(old.max(1)), u64::from(new));
                let end = (u64::from(*first) + u64::from(*count)) * new;
                let begin = u64::from(*first) * new / old;
                (*first, *count) = (begin as u32, (end.div_ceil(old) - begin) as u32);
            };
            scaled(&mut crop.x, &mut crop.width, self.width, width);
            scaled(&mut crop.y, &mut crop.height, self.height, height);
        }
        (self.width, self.height) = (width, height);
    }
}

/// A window of an image, in pixels from its top left. It must lie inside and hold a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Crop {
    /// First column.
    pub x: u32,
    /// First row.
    pub y: u32,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

/// The image axis that a field of view spans.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FovAxis {
    /// Horizontal.
    #[default]
    X,
    /// Vertical.
    Y,
    /// Corner to corner.
    Diagonal,
    /// The shorter side.
    Smaller,
    /// The longer side.
    Larger,
}

/// A separable reconstruction filter, sampled in proportion to its height. Widths in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Filter {
    /// Constant over `|x| ≤ radius`; 0.5 covers the pixel exactly.
    Box {
        /// Half the width.
        radius: f64,
    },
    /// A triangle that falls to zero at `radius`.
    Tent {
        /// Half the base.
        radius: f64,
    },
    /// A Gaussian cut off, and lowered to zero, at four standard deviations.
    Gaussian {
        /// Standard deviation.
        stddev: f64,
    },
}

/// A surface with its material.
#[derive(Clone, Debug)]
pub struct ShapeDescription {
    /// The id in the file, or `shape-N` with its number in the file, from 1.
    pub name: String,
    /// The surface in object space.
    pub geometry: Geometry,
    /// Object to world.
    pub to_world: DAffine3,
    /// Turns all normals around: what was outside is inside.
    pub flip_normals: bool,
    /// Index into [`SceneDescription::materials`].
    pub material: usize,
    /// Emitted radiance on the side that the normal points to (W·m⁻²·sr⁻¹), where the surface is an area emitter.
    pub radiance: Option<Rgb>,
}

/// A surface in object space.
#[derive(Clone, Debug)]
pub enum Geometry {
    /// Triangles.
    Mesh(Arc<Mesh>),
    /// A sphere, its normal outwards. A transform may turn, move and scale it evenly, nothing else.
    Sphere {
        /// The centre.
        centre: DVec3,
        /// The radius, above zero.
        radius: f64,
    },
    /// The unit disc in the xy plane, its normal +z. A transform must keep it circular.
    Disc,
    /// An open tube between two points, its normal away from the axis. A transform must keep it round.
    Cylinder {
        /// Middle of one end.
        from: DVec3,
        /// Middle of the other end.
        to: DVec3,
        /// The radius, above zero.
        radius: f64,
    },
}

/// Triangles over shared vertices.
///
/// Where there are vertex normals, they say which side of a triangle is outside; without them the winding does
/// (counter-clockwise seen from outside).
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Vertex positions.
    pub positions: Vec<DVec3>,
    /// Vertex normals, need not be of unit length: one a position, or none for flat faces.
    pub normals: Vec<DVec3>,
    /// Texture coordinates: one a position, or none.
    pub texture_coordinates: Vec<DVec2>,
    /// Vertex indices of each triangle.
    pub triangles: Vec<[u32; 3]>,
}

/// A colour that is the same everywhere, or comes from a texture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Colour {
    /// The same everywhere.
    Constant(Rgb),
    /// Index into [`SceneDescription::textures`].
    Texture(usize),
}

impl From<Rgb> for Colour {
    fn from(c: Rgb) -> Self {
        Self::Constant(c)
    }
}

/// A colour over texture coordinates.
#[derive(Clone, Debug)]
pub struct Texture {
    /// The id in the file, or a name made from the type.
    pub name: String,
    /// Applied to texture coordinates before the lookup.
    pub to_uv: DAffine2,
    /// Where the colour comes from.
    pub kind: TextureKind,
}

/// Where a texture's colour comes from.
#[derive(Clone, Debug)]
pub enum TextureKind {
    /// Pixels.
    Bitmap {
        /// The pixels.
        bitmap: Arc<Bitmap>,
        /// What lies beyond the unit square.
        wrap: Wrap,
        /// Whether colours are interpolated between pixel centres.
        bilinear: bool,
    },
    /// Two colours on a board of 2 × 2 fields to the unit square; the field at the origin has the first.
    Checkerboard {
        /// The two colours.
        colours: [Rgb; 2],
    },
}

/// Linear pixels, row-major from the top left; texture coordinate v points up, so v = 0 is the last row's lower edge.
#[derive(Clone, Debug, Default)]
pub struct Bitmap {
    /// Width in pixels, at least 1.
    pub width: u32,
    /// Height in pixels, at least 1.
    pub height: u32,
    /// `width × height` pixels.
    pub pixels: Vec<Rgb>,
}

impl Bitmap {
    /// Whether there is at least one pixel, and as many as width and height say.
    #[must_use]
    pub fn is_sound(&self) -> bool {
        let pixels = u64::from(self.width) * u64::from(self.height);
        pixels > 0 && pixels == self.pixels.len() as u64
    }
}

/// What a bitmap shows beyond the unit square.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Wrap {
    /// The same again.
    #[default]
    Repeat,
    /// The same again, mirrored each time.
    Mirror,
    /// The edge's pixels.
    Clamp,
}

/// How a surface scatters, on each side.
#[derive(Clone, Debug)]
pub struct Material {
    /// The id in the file, or a name made from the type.
    pub name: String,
    /// On the side that the normal points to. A dielectric describes both sides by itself.
    pub front: Bsdf,
    /// On the other side. `None`: a reflector is black there.
    pub back: Option<Bsdf>,
    /// Share of light that meets the surface at all; the rest passes straight through. `None`: all. Of a colour the mean channel
    /// counts, of a bitmap's the luminance, as in Mitsuba 3.
    pub opacity: Option<Colour>,
}

/// A bidirectional scattering distribution function, over colours `C`: [`Colour`] in a description, [`Rgb`] at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bsdf<C = Colour> {
    /// Lambertian reflection.
    Diffuse {
        /// Share of light reflected, in [0, 1].
        reflectance: C,
    },
    /// A boundary of two transparent media.
    Dielectric {
        /// Index of refraction on the side away from the normal.
        int_ior: f32,
        /// Index of refraction on the side that the normal points to.
        ext_ior: f32,
        /// Factor on reflected light, physically 1.
        specular_reflectance: C,
        /// Factor on refracted light, physically 1.
        specular_transmittance: C,
        /// `None`: smooth.
        roughness: Option<Microfacets>,
    },
    /// A thin pane of glass: light passes straight on, reflections between its faces included.
    ThinDielectric {
        /// Index of refraction of the pane.
        int_ior: f32,
        /// Index of refraction around it.
        ext_ior: f32,
        /// Factor on reflected light, physically 1.
        specular_reflectance: C,
        /// Factor on transmitted light, physically 1.
        specular_transmittance: C,
    },
    /// A smooth mirror that reflects the same share at every angle (Mitsuba's material `none`).
    Mirror {
        /// Share of light reflected, in [0, 1].
        reflectance: C,
    },
    /// A metal.
    Conductor {
        /// Real part of the index of refraction per channel, relative to the outside.
        eta: Rgb,
        /// Imaginary part per channel.
        k: Rgb,
        /// Factor on reflected light, physically 1.
        specular_reflectance: C,
        /// `None`: smooth.
        roughness: Option<Microfacets>,
    },
    /// A clear coat over a diffuse base.
    Plastic {
        /// Index of refraction of the coat.
        int_ior: f32,
        /// Index of refraction outside.
        ext_ior: f32,
        /// Share of light that the base reflects, in [0, 1].
        diffuse_reflectance: C,
        /// Factor on light reflected by the coat, physically 1.
        specular_reflectance: C,
        /// Whether light that is reflected inside the coat takes on the base's colour each time.
        nonlinear: bool,
        /// `None`: a smooth coat.
        roughness: Option<Microfacets>,
    },
    /// Nothing: light passes as if there were no surface.
    Null,
}

/// A distribution of microfacet normals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Microfacets {
    /// Its shape.
    pub distribution: MicrofacetDistribution,
    /// Roughness α along the texture's u, above 0.
    pub alpha_u: f32,
    /// Roughness α along the texture's v, above 0.
    pub alpha_v: f32,
}

/// The shape of a distribution of microfacet normals.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MicrofacetDistribution {
    /// Gaussian slopes.
    #[default]
    Beckmann,
    /// Longer tails; also known as Trowbridge–Reitz.
    Ggx,
}

/// An emitter that is not a surface.
#[derive(Clone, Debug)]
pub struct EmitterDescription {
    /// The id in the file, or a name made from the type.
    pub name: String,
    /// What it emits.
    pub kind: EmitterKind,
}

/// Kinds of emitters that are not surfaces.
#[derive(Clone, Debug)]
pub enum EmitterKind {
    /// The same radiant intensity (W·sr⁻¹) in all directions.
    Point {
        /// Where it is.
        position: DVec3,
        /// Radiant intensity.
        intensity: Rgb,
    },
    /// A point emitter that shines along its +z, fading linearly in the angle between two cones.
    Spot {
        /// Emitter to world.
        to_world: DAffine3,
        /// Radiant intensity inside the inner cone (W·sr⁻¹).
        intensity: Rgb,
        /// Half angle beyond which nothing is emitted, in degrees.
        cutoff_degrees: f64,
        /// Half angle within which the intensity is full, in degrees, at most the cutoff.
        beam_degrees: f64,
    },
    /// The same radiance (W·m⁻²·sr⁻¹) from every direction, from infinitely far away.
    Constant {
        /// Radiance.
        radiance: Rgb,
    },
    /// Parallel light from infinitely far away.
    Directional {
        /// The way the light goes, need not be of unit length.
        direction: DVec3,
        /// On a surface that faces it (W·m⁻²).
        irradiance: Rgb,
    },
    /// Radiance from infinitely far away, by direction: latitudes are rows, the first and the last of them the poles, +y of the
    /// emitter's space is up, the middle of the picture lies towards +z and its right half towards −x, as in Mitsuba 3's
    /// `envmap`.
    Environment {
        /// Emitter to world; only its rotation matters.
        to_world: DAffine3,
        /// Radiance (W·m⁻²·sr⁻¹) before `scale`.
        bitmap: Arc<Bitmap>,
        /// Factor on the radiance.
        scale: f32,
    },
}

impl Mesh {
    /// Whether a triangle has an area that double precision can tell, its corners being there. Others are left out of scenes, and
    /// nothing goes by where their corners are.
    #[must_use]
    pub fn has_area(&self, triangle: [u32; 3]) -> bool {
        let [Some(&a), Some(&b), Some(&c)] = triangle.map(|i| self.positions.get(i as usize)) else {
            return false;
        };
        let (u, v, w) = (b - a, c - a, c - b);
        let longest = u.abs().max(v.abs()).max(w.abs()).max_element();
        longest > 0.0 && (u / longest).cross(v / longest).length_squared() > FLATTEST * FLATTEST
    }

    /// The square [−1, 1]² in the xy plane, its normal +z.
    #[must_use]
    pub fn rectangle() -> Self {
        let corner = |x, y| DVec3::new(x, y, 0.0);
        Self {
            positions: vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)],
            normals: Vec::new(),
            texture_coordinates: [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(DVec2::from).to_vec(),
            triangles: vec![[0, 1, 2], [0, 2, 3]],
        }
    }

    /// The cube [−1, 1]³ with flat faces, normals outwards.
    #[must_use]
    pub fn cube() -> Self {
        let positions = (0..8)
            .map(|i| {
                let side = |bit: i32| if i & bit == 0 { -1.0 } else { 1.0 };
                DVec3::new(side(1), side(2), side(4))
            })
            .collect();
        let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        let triangles = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
        Self { positions, normals: Vec::new(), texture_coordinates: Vec::new(), triangles }
    }
}

/// The height of a triangle of no area, by its longest side: rounding.
const FLATTEST: f64 = 1e-12;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faces_of_the_cube_point_outwards() {
        let cube = Mesh::cube();
        for t in &cube.triangles {
            let [a, b, c] = t.map(|i| cube.positions[i as usize]);
            assert!((b - a).cross(c - a).dot(a + b + c) > 0.0, "{t:?}");
        }
        assert_eq!(cube.triangles.len(), 12);
    }
}
