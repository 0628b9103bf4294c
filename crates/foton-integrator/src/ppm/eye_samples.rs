//! The eye pass of progressive photon mapping.

use foton_math::Purpose;
use foton_scene::Scene;
use foton_transport::camera_paths::{EyePass, FirstRadius};

use super::lobes::{LOBE_POLICY, lobe_use};
use crate::settings::RenderSettings;

/// The eye pass of a render with such settings.
pub(super) fn eye_pass<'a>(
    scene: &'a Scene,
    settings: &RenderSettings,
    max_depth: u32,
    purpose: Purpose,
) -> EyePass<'a> {
    let (scale, floor) = (settings.ppm.radius_scale.get(), settings.ppm.radius_floor.get());
    EyePass {
        scene,
        sensor: settings.sensor,
        samples_per_pixel: settings.samples_per_pixel,
        hit_points_per_sample: settings.ppm.hit_points_per_sample,
        radius: FirstRadius::new(scene, settings.ppm.radius, scale, floor, settings.samples_per_pixel.get()),
        max_depth,
        policy: LOBE_POLICY,
        uses: lobe_use(scene),
        seed: settings.seed,
        purpose,
    }
}
