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
    /// Whether any surface that stores hit points has interpolated normals: photons need their adjoint correction there.
    pub shading_normals: bool,
    /// Whether eye paths follow a lobe of any surface: mirrors, glass, narrow gloss, things that light passes through.
    pub specular: bool,
    /// Whether any surface refracts: eye paths may split there.
    pub refraction: bool,
    /// Whether any followed lobe is rough: eye paths follow it in a random direction, which one eye pass freezes.
    pub narrow_gloss: bool,
    /// Whether any followed lobe is a single direction other than straight on: mirrors, smooth glass and coats.
    pub single_directions: bool,
    /// Whether light passes straight through any surface: thin glass, masks, nothing.
    pub straight: bool,
    /// Whether hit points keep any lobe that is not Lambertian: photons are weighed one by one there.
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
    /// Whether there are lights to be looked up where eye paths follow a rough lobe in one direction.
    #[must_use]
    pub const fn has_narrow_highlights(&self) -> bool {
        self.narrow_gloss && (self.delta_emitters || self.area_emitters)
    }

    /// Whether mirrors or smooth glass may throw the light of points, spots and suns on lobes that eye paths follow in a random
    /// direction: no such path meets those lights, so photons are weighed there.
    #[must_use]
    pub const fn has_narrow_caustics(&self) -> bool {
        self.narrow_gloss && self.delta_emitters && self.single_directions
    }
}
