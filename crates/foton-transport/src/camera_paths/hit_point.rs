//! Hit points: where eye paths end on surfaces that gather light.

use std::num::NonZeroU32;

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
    /// How far along the normal an origin for rays is that lies certainly on the eye's side.
    pub offset: f32,
    /// Eye throughput, times the BSDF's value where that is Lambertian: radiance at the eye per irradiance here (sr⁻¹).
    pub weight: Rgb,
    /// Its [`Gloss`]; `None` for a Lambertian one.
    pub gloss: Option<GlossIndex>,
    /// Area that the pixel covers here, whatever radii the settings ask for.
    pub footprint: f32,
    /// First squared radius.
    pub radius2: f32,
    /// The squared radius below which it does not shrink.
    pub smallest2: f32,
    /// The largest number of edges that a photon's path may have here.
    pub remaining_edges: u8,
    /// See [`Surface::patch_towards`](foton_scene::Surface::patch_towards).
    pub patch: u8,
    /// Whether the surface is curved: see [`slab2`].
    pub curved: bool,
}

impl HitPoint {
    /// An origin for rays, certainly on the eye's side.
    #[must_use]
    #[inline]
    pub fn origin(&self) -> Vec3 {
        self.position + self.normal * self.offset
    }
}

/// Squared half-thickness of the slab in which photons count, over the squared radius.
///
/// A plane needs none, but a neighbouring step or a parallel sheet must stay out. A curved surface leaves its tangent plane
/// by r/2R, and is let in as long as normals agree.
#[must_use]
#[inline]
pub const fn slab2(curved: bool) -> f32 {
    if curved { 1.0 } else { 0.01 }
}

/// Where the [`Gloss`] of a hit point lies in a list.
#[derive(Clone, Copy, Debug)]
pub struct GlossIndex(NonZeroU32);

impl GlossIndex {
    /// The last one in a list of so many; `None` in an empty one.
    #[must_use]
    pub fn last_of(count: usize) -> Option<Self> {
        u32::try_from(count).ok().and_then(NonZeroU32::new).map(Self)
    }

    /// The same where so many lie before the list.
    #[must_use]
    pub const fn after(self, before: u32) -> Self {
        Self(self.0.saturating_add(before))
    }

    /// The place in the list.
    #[must_use]
    pub const fn get(self) -> usize {
        self.0.get() as usize - 1
    }
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
