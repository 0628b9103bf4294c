//! What decides the maps of two-pass photon mapping, and how they are shown.

use std::num::NonZeroU32;

use foton_transport::kd_tree::{KernelFilter, PACKED_BYTES};
use foton_transport::photon_map::Photon;

/// How indirect light is taken from the maps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MapDisplay {
    /// By rays from what is seen to surfaces whose light the global map knows.
    #[default]
    FinalGathering,
    /// From the global map where it is seen.
    Direct,
}

impl MapDisplay {
    /// Both ways.
    pub const ALL: [Self; 2] = [Self::FinalGathering, Self::Direct];

    /// The name in files and on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::FinalGathering => "final-gathering",
            Self::Direct => "direct",
        }
    }
}

/// Settings of two-pass photon mapping.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhotonMapSettings {
    /// Photons of the global map: emission stops once so many are stored.
    pub global_photons: NonZeroU32,
    /// Photons of the caustic map; 0 for no caustics.
    pub caustic_photons: u32,
    /// Photons whose disc makes an estimate.
    pub neighbours: NonZeroU32,
    /// How photons of caustics count by their distance.
    pub filter: KernelFilter,
    /// How indirect light is taken from the global map.
    pub display: MapDisplay,
    /// Rays of final gathering for each eye sample.
    pub gather_rays: NonZeroU32,
    /// Whether shadow photons tell where shadow rays would be in vain.
    pub shadow_photons: bool,
}

impl PhotonMapSettings {
    /// Bytes of maps while they are made: photons as they are traced, and as they stay.
    pub(crate) fn bytes(&self) -> f64 {
        let [global, caustic] = [self.global_photons.get(), self.caustic_photons].map(f64::from);
        let photon = (size_of::<Photon>() + 2 * PACKED_BYTES) as f64;
        let shadows = if self.shadow_photons { 2.0 * global * (2 * PACKED_BYTES) as f64 } else { 0.0 };
        // Emission stops at the end of a pass, a little later. Irradiance is kept at a few of them, with directions.
        1.2 * (global + caustic) * photon + global * 16.0 + shadows
    }
}

impl Default for PhotonMapSettings {
    fn default() -> Self {
        let number = |n| NonZeroU32::new(n).unwrap_or(NonZeroU32::MIN);
        Self {
            global_photons: number(200_000),
            caustic_photons: 200_000,
            neighbours: number(60),
            filter: KernelFilter::default(),
            display: MapDisplay::default(),
            gather_rays: number(8),
            shadow_photons: false,
        }
    }
}
