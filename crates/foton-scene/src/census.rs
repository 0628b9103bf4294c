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
    /// Triangles without area, left out.
    pub degenerate_triangles: u64,
    /// Whether any surface that stores hit points has interpolated normals: photons need their adjoint correction there.
    pub shading_normals: bool,
    /// Whether any surface reflects or refracts into single directions.
    pub specular: bool,
    /// Emitters of any kind that emit at all.
    pub emitters: u64,
    /// Whether light comes from infinity.
    pub environment: bool,
}
