//! What can be put beside the image, pixel by pixel.

/// A layer of output.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum LayerKind {
    /// Reflected light that came straight from emitters. Needs [`RenderSettings::layers`](crate::RenderSettings::layers).
    Direct,
    /// Reflected light that came by mirrors and glass only. Needs [`RenderSettings::layers`](crate::RenderSettings::layers).
    Caustic,
    /// Reflected light that came by diffuse surfaces. Needs [`RenderSettings::layers`](crate::RenderSettings::layers).
    Indirect,
    /// Emitters seen directly or by specular bounces.
    Emission,
    /// Mean radius of the pixel's hit points, in world units.
    Radius,
    /// Photons found by the pixel's hit points in all passes.
    PhotonCount,
    /// Index of the shape that the pixel's first sample meets first, from 0; 2³² − 1 for none.
    ShapeId,
    /// Standard deviation of the pixel's luminance. Needs [`RenderSettings::error`](crate::RenderSettings::error), as all errors do.
    ErrorNoise,
    /// Bias of the pixel's luminance, from the radius: a root mean square over 5 × 5 pixels.
    ErrorBias,
    /// √(noise² + bias²).
    ErrorTotal,
}

impl LayerKind {
    /// All kinds.
    pub const ALL: [Self; 10] = [
        Self::Direct,
        Self::Caustic,
        Self::Indirect,
        Self::Emission,
        Self::Radius,
        Self::PhotonCount,
        Self::ShapeId,
        Self::ErrorNoise,
        Self::ErrorBias,
        Self::ErrorTotal,
    ];

    /// The name in files and on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Direct => "direct",
            Self::Caustic => "caustic",
            Self::Indirect => "indirect",
            Self::Emission => "emission",
            Self::Radius => "radius",
            Self::PhotonCount => "photon_count",
            Self::ShapeId => "shape_id",
            Self::ErrorNoise => "error_noise",
            Self::ErrorBias => "error_bias",
            Self::ErrorTotal => "error_total",
        }
    }

    /// The kind of a name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|k| k.name() == name)
    }

    /// Whether it needs light by path class.
    #[must_use]
    pub const fn needs_classes(self) -> bool {
        matches!(self, Self::Direct | Self::Caustic | Self::Indirect)
    }

    /// Whether it tells of photons, which not all methods have.
    #[must_use]
    pub const fn needs_photons(self) -> bool {
        matches!(self, Self::Radius | Self::PhotonCount)
    }

    /// Whether the error must be estimated for it.
    #[must_use]
    pub const fn needs_error(self) -> bool {
        matches!(self, Self::ErrorNoise | Self::ErrorBias | Self::ErrorTotal)
    }
}
