//! Hit points: where eye paths end on surfaces that gather light.

use foton_math::glam::Vec3;
use foton_math::{Frame, Rgb};
use foton_scene::{LobeFlags, Scattering};

/// A hit point as the eye pass finds it. Scene units.
#[derive(Clone, Copy, Debug)]
pub struct HitPoint {
    /// Where the path ends.
    pub position: Vec3,
    /// Unit geometric normal on the eye's side.
    pub normal: Vec3,
    /// Unit shading normal on the same side.
    pub shading_normal: Vec3,
    /// An origin for shadow rays, certainly on the eye's side.
    pub origin: Vec3,
    /// Eye throughput, times the BSDF's value where that is Lambertian: radiance at the eye per irradiance here (sr⁻¹).
    pub weight: Rgb,
    /// Index of its [`Gloss`]; `None` for a Lambertian one.
    pub gloss: Option<u32>,
    /// Area that the pixel covers here, whatever radii the settings ask for.
    pub footprint: f32,
    /// First squared radius.
    pub radius2: f32,
    /// Squared half-thickness of the slab in which photons count, over the squared radius.
    pub slab2: f32,
    /// The squared radius below which it does not shrink.
    pub smallest2: f32,
    /// The largest number of edges that a photon's path may have here.
    pub remaining_edges: u8,
    /// See [`Surface::patch_towards`](foton_scene::Surface::patch_towards).
    pub patch: u8,
}

/// How a hit point weighs light from each direction, where that is not the same for all.
#[derive(Clone, Copy, Debug)]
pub struct Gloss {
    /// The BSDF with its parameters there.
    pub scattering: Scattering,
    /// The frame around the shading normal in which the BSDF is stated.
    pub frame: Frame,
    /// Unit direction to the eye in that frame.
    pub wo: Vec3,
    /// The lobes that it weights light with.
    pub lobes: LobeFlags,
    /// Whether they are specular: it then gathers only light that eye paths cannot find.
    pub specular: bool,
}

impl Gloss {
    /// The value of its lobes for light from the unit direction `wi` (sr⁻¹).
    pub fn eval(&self, wi: Vec3) -> Rgb {
        let wi = self.frame.to_local(wi);
        self.scattering.eval(self.wo, wi, self.lobes)
    }
}
