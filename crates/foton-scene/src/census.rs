//! What a scene contains, counted once: the renderer models only what is there.

/// The kinds of things that a scene has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Census {
    /// Triangles that rays are tested against.
    pub triangles: u64,
    /// Spheres.
    pub spheres: u64,
    /// Discs.
    pub discs: u64,
    /// Cylinders, open at both ends.
    pub cylinders: u64,
    /// Triangles without area, left out.
    pub degenerate_triangles: u64,
    /// Whether any surface with hit points has interpolated normals: photons need their adjoint correction there.
    pub shading_normals: bool,
    /// Whether any surface has specular lobes: mirrors, glass, narrow gloss, things that light passes through.
    pub specular: bool,
    /// Whether any surface refracts: eye paths may split there.
    pub refraction: bool,
    /// Whether any specular lobe is rough: eye paths sample a direction, which stays the same for all passes.
    pub narrow_gloss: bool,
    /// Whether any specular lobe is a single direction other than straight on: mirrors, smooth glass and coats.
    pub single_directions: bool,
    /// Whether light passes straight through any surface: thin glass, masks, nothing.
    pub straight: bool,
    /// Whether any gathered lobe is not Lambertian: photons are weighed one by one there.
    pub gathered_gloss: bool,
    /// Whether any coat is rough: what gets through it is integrated beforehand.
    pub rough_coats: bool,
    /// Whether any colour comes from a texture.
    pub textures: bool,
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
    /// Whether emitters are sampled where eye paths meet a rough specular lobe.
    #[must_use]
    pub const fn has_narrow_highlights(&self) -> bool {
        self.narrow_gloss && (self.delta_emitters || self.area_emitters)
    }

    /// Whether mirrors or smooth glass may cast light of delta emitters on rough specular lobes: no eye path finds that light, so photons
    /// are gathered there.
    #[must_use]
    pub const fn has_narrow_caustics(&self) -> bool {
        self.narrow_gloss && self.delta_emitters && self.single_directions
    }
}
