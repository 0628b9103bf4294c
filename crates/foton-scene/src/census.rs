//! What a scene contains, counted once: the renderer models only what is there.

use crate::bsdf::LobeFlags;

/// The kinds of things that a scene has.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Census {
    /// Triangles that rays are tested against.
    pub triangles: u64,
    /// Spheres.
    pub spheres: u64,
    /// Discs.
    pub discs: u64,
    /// Cylinders, open at both ends.
    pub cylinders: u64,
    /// Meshes that share a tree with others; their triangles are counted, too.
    pub instances: u64,
    /// Triangles without area, left out.
    pub degenerate_triangles: u64,
    /// The BSDFs of surfaces, each kind once: what a method's rules for paths go by.
    pub bsdfs: Vec<BsdfKind>,
    /// Whether any surface refracts: eye paths may split there.
    pub refraction: bool,
    /// Whether light passes straight through any surface: thin glass, masks, nothing.
    pub straight: bool,
    /// Whether any coat is rough: what gets through it is integrated beforehand.
    pub rough_coats: bool,
    /// Whether any colour or number comes from a texture.
    pub textures: bool,
    /// Whether any surface is blended of several materials.
    pub mixtures: bool,
    /// Whether any surface has a bump map or a normal map.
    pub reliefs: bool,
    /// Whether any roughness differs along u and v: frames follow texture coordinates.
    pub anisotropy: bool,
    /// Emitters of any kind that emit at all.
    pub emitters: u64,
    /// Whether light comes from infinity.
    pub environment: bool,
    /// Whether any emitter shines from one point or in one direction: no path meets it by chance.
    pub delta_emitters: bool,
    /// Whether any surface emits.
    pub area_emitters: bool,
}

impl Census {
    /// Whether mirrors or smooth glass throw light on other surfaces.
    #[must_use]
    pub fn bends_light(&self) -> bool {
        self.bsdfs.iter().any(BsdfKind::bends_light)
    }
}

/// What methods need to know of a BSDF that surfaces have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BsdfKind {
    /// Its lobes.
    pub flags: LobeFlags,
    /// The larger roughness of its glossy lobes, if it has any.
    pub roughness: Option<f32>,
    /// Whether any surface that has it has interpolated normals.
    pub interpolated_normals: bool,
    /// Whether it is Lambertian and nothing else.
    pub lambertian: bool,
    /// Whether it has holes.
    pub masked: bool,
}

impl BsdfKind {
    /// Whether light leaves it in a single direction that is not the one it came in: a surface that light only passes straight through
    /// has no delta lobe that reflects.
    #[must_use]
    pub const fn bends_light(&self) -> bool {
        let is_nothing =
            self.flags.intersects(LobeFlags::STRAIGHT) && !self.flags.intersects(LobeFlags::REFLECTION);
        self.flags.intersects(LobeFlags::DELTA) && !is_nothing
    }
}
