//! What the start of a render makes of its eye samples: hit points laid out for the gather, and what photons are aimed at.

use foton_math::Rgb;
use foton_math::glam::Vec3;
use foton_scene::{Scene, Sources};
use foton_transport::camera_paths::{EyePaths, HitPoint};
use foton_transport::photon_map::BAND;
use foton_transport::{Cancel, Cancelled, NotFinite};

use super::direct::by_shadow_rays;
use super::eye_samples::EyeSamples;
use super::guidance::Guidance;
use super::hit_points::{HitPoints, Layout};
use super::lobes::lobe_use;
use super::settings::RadiusRule;
use crate::report::Start;
use crate::settings::{Method, RenderSettings};

/// About this many hit points stand for all of them.
pub(super) const MAX_PROBED: usize = 4096;

/// Eye samples, laid out.
pub(super) struct LaidOut {
    pub(super) hit_points: HitPoints,
    pub(super) sources: Sources,
    pub(super) guidance: Guidance,
    /// Samples a pixel.
    pub(super) samples: u32,
    /// [`foton_transport::camera_paths::EyePaths::mean_emission`].
    pub(super) emission: Vec<Rgb>,
    pub(super) start: Start,
    pub(super) not_finite: Option<NotFinite>,
    /// Of the hit points in sample order, where pixels have to know them.
    pub(super) first_radius2: Vec<f32>,
}

impl LaidOut {
    /// Lays out what has been followed for a render with such settings, with first radii multiplied by `widened`.
    pub(super) fn new(
        eye: &EyeSamples,
        settings: &RenderSettings,
        widened: f32,
        cancel: &Cancel,
    ) -> Result<Self, Cancelled> {
        let EyeSamples { scene, paths, .. } = eye;
        let found = &paths.hit_points;
        let shadow_rays = by_shadow_rays(scene, settings);
        let mut hit_points = lay_out(scene, paths, (shadow_rays, BAND), cancel)?;
        if widened != 1.0 {
            hit_points = hit_points.widened(widened);
        }
        let sources = scene.sources(&discs(found));
        Ok(Self {
            guidance: Guidance::new(&sources, paths, settings.ppm.guided),
            sources,
            samples: eye.followed(),
            emission: paths.mean_emission(),
            start: Start {
                hit_points: hit_points.len() as u64,
                eye_rays: paths.rays,
                dropped: paths.dropped,
            },
            not_finite: paths.left_out.map(|left_out| NotFinite::new(scene, 0, left_out)),
            first_radius2: if settings.method == Method::Sppm {
                found.iter().map(|h| h.radius2).collect()
            } else {
                Vec::new()
            },
            hit_points,
        })
    }
}

/// Lays out hit points, without room for statistics, with or without shadow rays; neighbours are looked for among so many.
pub(crate) fn lay_out(
    scene: &Scene,
    paths: &EyePaths,
    (shadow_rays, in_band): (bool, usize),
    cancel: &Cancel,
) -> Result<HitPoints, Cancelled> {
    let how = Layout { shading_normals: lobe_use(scene).shading_normals, shadow_rays, in_band };
    HitPoints::new(&paths.hit_points, &paths.gloss, paths.pixel_start(), how, cancel)
}

/// Whether hit points keep what radii that adapt go by, and the error's upper end.
pub(crate) fn has_moments(settings: &RenderSettings) -> bool {
    settings.error || settings.ppm.radius_rule == RadiusRule::Adaptive
}

/// First discs that stand for all, by which photons are aimed.
pub(super) fn discs(found: &[HitPoint]) -> Vec<(Vec3, f32)> {
    let step = (found.len() / MAX_PROBED).max(1);
    found.iter().step_by(step).map(|h| (h.position, h.radius2.sqrt())).collect()
}
