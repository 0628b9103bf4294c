//! The eye samples of a render: each is followed once, all at one time or some first.
//!
//! A render of the first ones alone has the whole picture soon, with rough edges. One of all of them then starts from its first pass
//! again, with the photons that it would have had anyway: it has the bits of a render that never stopped on the way, each of its hit
//! points has seen all photons, and no sum has to know which samples came first.

use std::sync::Arc;

use foton_math::Purpose;
use foton_scene::Scene;
use foton_transport::camera_paths::{EyePass, EyePaths, FirstRadius, Gloss, HitPoint};
use foton_transport::{Cancel, Cancelled};

use super::lobes::{LOBE_POLICY, lobe_use};
use crate::settings::{Method, RenderSettings};
use crate::shutter::at_pass;

/// The eye samples of a render, as far as they have been followed.
pub struct EyeSamples {
    pub(super) scene: Arc<Scene>,
    pub(super) settings: RenderSettings,
    pub(super) paths: EyePaths,
}

impl EyeSamples {
    /// Those of a render of a scene with such settings, none of them followed.
    #[must_use]
    pub fn new(scene: Arc<Scene>, settings: RenderSettings) -> Self {
        Self { scene, settings, paths: EyePaths::default() }
    }

    /// Samples of each pixel that have been followed.
    #[must_use]
    pub const fn followed(&self) -> u32 {
        self.paths.samples
    }

    /// The scene.
    #[must_use]
    pub const fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }

    /// The settings of the render.
    #[must_use]
    pub const fn settings(&self) -> &RenderSettings {
        &self.settings
    }

    /// Follows the first `samples` of each pixel, as far as there are so many and they have not been. `tell` is told by many threads
    /// what share of all the pixels' samples is done.
    ///
    /// # Errors
    /// When cancelled; none is then followed any more.
    pub fn follow(
        &mut self,
        samples: u32,
        cancel: &Cancel,
        tell: &(dyn Fn(f64) + Sync),
    ) -> Result<(), Cancelled> {
        let all = self.settings.samples_per_pixel.get();
        let (before, samples) = (self.followed(), samples.min(all));
        if samples <= before {
            return Ok(());
        }
        let share = |of_these: f64| {
            tell((f64::from(before) + of_these * f64::from(samples - before)) / f64::from(all));
        };
        let pass = (self.settings.method == Method::Sppm).then_some(0);
        if let (Some(first), 0) = (pass, before) {
            self.scene = at_pass(&self.scene, &self.settings, first, cancel)?;
        }
        let earlier = std::mem::take(&mut self.paths);
        let max_depth = self.settings.max_depth_in(&self.scene);
        let pass = EyePass { pass, ..eye_pass(&self.scene, &self.settings, max_depth, Purpose::Eye) };
        self.paths = pass.run(earlier, samples, cancel, &share)?;
        Ok(())
    }

    /// Follows all samples.
    ///
    /// # Errors
    /// As [`EyeSamples::follow`].
    pub fn follow_all(&mut self, cancel: &Cancel, tell: &(dyn Fn(f64) + Sync)) -> Result<(), Cancelled> {
        self.follow(u32::MAX, cancel, tell)
    }

    /// Bytes held, without the scene.
    #[must_use]
    pub const fn bytes(&self) -> usize {
        let EyePaths { hit_points, gloss, counts, emission, shapes, .. } = &self.paths;
        size_of::<HitPoint>() * hit_points.len()
            + size_of::<Gloss>() * gloss.len()
            + size_of::<u32>() * (counts.len() + shapes.len())
            + size_of::<foton_math::Rgb>() * emission.len()
    }
}

/// The eye pass of a render with such settings.
pub(crate) fn eye_pass<'a>(
    scene: &'a Scene,
    settings: &RenderSettings,
    max_depth: u32,
    purpose: Purpose,
) -> EyePass<'a> {
    let scale = settings.ppm.radius_scale.get();
    // Samples that are new in each pass leave no gaps that discs would have to bridge.
    let floor = if settings.method == Method::Sppm { 0.0 } else { settings.ppm.radius_floor.get() };
    EyePass {
        scene,
        sensor: settings.sensor,
        samples_per_pixel: settings.samples_per_pixel,
        pass: None,
        hit_points_per_sample: settings.ppm.hit_points_per_sample,
        radius: FirstRadius::new(scene, settings.ppm.radius, scale, floor, settings.samples_per_pixel.get()),
        max_depth,
        policy: LOBE_POLICY,
        uses: lobe_use(scene),
        seed: settings.seed,
        purpose,
    }
}
