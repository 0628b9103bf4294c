//! The stages of a render, for those who time them.

/// The parts of a render, in the order in which they come. Those from `Trace` on come once a pass, the first three
/// of them once for each million photons of a larger pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Stage {
    /// Following eye paths.
    EyePass,
    /// Laying hit points out.
    Layout,
    /// Tracing photons.
    Trace,
    /// Sorting photons by cell.
    Sort,
    /// Gathering photons and refining hit points.
    Gather,
    /// Direct light by shadow rays.
    ShadowRays,
    /// Adding the pass to the pixels.
    Radiance,
}

impl Stage {
    /// All stages.
    pub const ALL: [Self; 7] = [
        Self::EyePass,
        Self::Layout,
        Self::Trace,
        Self::Sort,
        Self::Gather,
        Self::ShadowRays,
        Self::Radiance,
    ];

    /// The name in output.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::EyePass => "eye_pass",
            Self::Layout => "layout",
            Self::Trace => "trace",
            Self::Sort => "sort",
            Self::Gather => "gather",
            Self::ShadowRays => "shadow_rays",
            Self::Radiance => "radiance",
        }
    }
}
