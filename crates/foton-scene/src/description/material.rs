//! Materials: how surfaces scatter light, by one BSDF or a mixture, on a surface that may be perturbed.

use foton_math::Rgb;

use super::texture::{Colour, Number};
use crate::bsdf::{Bsdf, Coating, Diffuse};

/// How a surface scatters, on each side.
#[derive(Clone, Debug)]
pub struct Material {
    /// The id in the file, or a name made from the type.
    pub name: String,
    /// On the side that the normal points to. A dielectric describes both sides by itself.
    pub front: Bsdf,
    /// On the other side. `None`: a reflector is black there.
    pub back: Option<Bsdf>,
    /// What lies over the front and over the back. That of the front lies on both sides of what describes both by itself.
    pub coatings: [Option<Coating>; 2],
    /// Share of light that meets the surface at all; the rest passes straight through. `None`: all. Of a colour the mean channel
    /// counts, of a bitmap's the luminance, as in Mitsuba 3.
    pub opacity: Option<Colour>,
    /// What perturbs the shading normal.
    pub relief: Option<Relief>,
    /// Materials that are blended with this one, in turn: each takes its weight of the result, and what came before the rest.
    pub mixture: Vec<Blend>,
}

impl Default for Material {
    /// Half grey in front, black behind: Mitsuba's material of a shape that names none.
    fn default() -> Self {
        Self {
            name: String::new(),
            front: Bsdf::Diffuse(Diffuse { reflectance: Rgb::splat(0.5).into() }),
            back: None,
            coatings: [None; 2],
            opacity: None,
            relief: None,
            mixture: Vec::new(),
        }
    }
}

impl Material {
    /// Whether anything but the name differs.
    #[must_use]
    pub fn scatters_differently(&self, other: &Self) -> bool {
        let all = |m: &Self| (m.front, m.back, m.coatings, m.opacity, m.relief);
        all(self) != all(other) || self.mixture != other.mixture
    }
}

/// A material that is blended with another one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blend {
    /// Index into [`SceneDescription::materials`](super::SceneDescription::materials).
    pub material: usize,
    /// Its share, in [0, 1].
    pub weight: Number,
}

/// A texture that perturbs the shading normal of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Relief {
    /// Index into [`SceneDescription::textures`](super::SceneDescription::textures).
    pub texture: usize,
    /// What the texture says.
    pub kind: ReliefKind,
    /// Whether the surface seen from behind has the same relief as from the front, as where Mitsuba's `twosided` stands around the
    /// relief; otherwise what stands out in front is sunk behind.
    pub same_behind: bool,
}

/// What the texture of a relief says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ReliefKind {
    /// How far the surface stands out along its normal, in world units, times a factor. `[BLI78]`
    Bump {
        /// The factor.
        scale: f32,
    },
    /// The normal in the frame of the tangent along u, the bitangent and the shading normal, each component n as (n + 1)/2.
    Normal,
}
