//! Options of two-pass photon mapping.

use std::num::NonZeroU32;
use std::path::PathBuf;

use clap::{Args as ClapArgs, ValueEnum};
use foton_integrator::{KernelFilter, MapDisplay, PhotonMapSettings};

// No doc comment: clap would take it for a description of the command.

// What `--integrator photon-map` goes by.
#[derive(Debug, ClapArgs)]
pub(crate) struct PhotonMapOptions {
    /// Photons of the global map: emission stops once so many are stored
    #[arg(long, value_name = "N", default_value_t = PhotonMapSettings::default().global_photons)]
    global_photons: NonZeroU32,
    /// Photons of the caustic map, for which light is aimed at mirrors and glass; 0: no caustics
    #[arg(long, value_name = "N", default_value_t = PhotonMapSettings::default().caustic_photons)]
    caustic_photons: u32,
    /// Photons of an estimate: more are smoother, fewer sharper
    #[arg(long, value_name = "N", default_value_t = PhotonMapSettings::default().neighbours)]
    neighbours: NonZeroU32,
    /// How photons of caustics count by their distance
    #[arg(long, value_name = "NAME", value_enum, default_value_t = PhotonMapSettings::default().filter.into())]
    photon_filter: Filter,
    /// How indirect light is taken from the global map
    #[arg(long, value_name = "HOW", value_enum, default_value_t = PhotonMapSettings::default().display.into())]
    map_display: Display,
    /// Rays of final gathering for each eye sample
    #[arg(long, value_name = "N", default_value_t = PhotonMapSettings::default().gather_rays)]
    gather_rays: NonZeroU32,
    /// Let shadow photons tell where shadow rays would be in vain
    #[arg(long)]
    shadow_photons: bool,
    /// Write the maps to this file
    #[arg(long, value_name = "FILE")]
    pub(crate) save_maps: Option<PathBuf>,
    /// Show the maps of this file, which another render of the same scene has saved, instead of making new ones; the camera may be
    /// another
    #[arg(long, value_name = "FILE")]
    pub(crate) maps: Option<PathBuf>,
}

/// `--photon-filter`.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Filter {
    /// All photons of the disc alike
    Box,
    /// Falling off evenly towards the rim
    Cone,
    /// Falling off like a bell
    Gaussian,
}

/// `--map-display`.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Display {
    /// By rays to surfaces whose light the map knows
    FinalGathering,
    /// Where it is seen: fast and blotchy
    Direct,
}

impl From<KernelFilter> for Filter {
    fn from(filter: KernelFilter) -> Self {
        match filter {
            KernelFilter::Box => Self::Box,
            KernelFilter::Cone => Self::Cone,
            KernelFilter::Gaussian => Self::Gaussian,
        }
    }
}

impl From<MapDisplay> for Display {
    fn from(display: MapDisplay) -> Self {
        match display {
            MapDisplay::FinalGathering => Self::FinalGathering,
            MapDisplay::Direct => Self::Direct,
        }
    }
}

impl PhotonMapOptions {
    /// The settings that they say.
    pub(crate) fn settings(&self) -> PhotonMapSettings {
        PhotonMapSettings {
            global_photons: self.global_photons,
            caustic_photons: self.caustic_photons,
            neighbours: self.neighbours,
            filter: match self.photon_filter {
                Filter::Box => KernelFilter::Box,
                Filter::Cone => KernelFilter::Cone,
                Filter::Gaussian => KernelFilter::Gaussian,
            },
            display: match self.map_display {
                Display::FinalGathering => MapDisplay::FinalGathering,
                Display::Direct => MapDisplay::Direct,
            },
            gather_rays: self.gather_rays,
            shadow_photons: self.shadow_photons,
        }
    }
}
