//! The steps that a pass takes more where its eye samples are new.

use foton_math::Rgb;
use foton_transport::camera_paths::EyePaths;
use foton_transport::photon_map::Grid;
use foton_transport::{Cancel, Cancelled, Halt, Omissions, ShouldSuspend, Stage, Suspended};
use rayon::prelude::*;

use super::pixels::Shrinkage;
use super::renewal::{LIT_BLOCK, Renewal};
use crate::by_block::ByBlock;
use crate::ppm::Ppm;
use crate::ppm::direct::Lighting;
use crate::ppm::laid_out::{has_moments, lay_out};
use crate::ppm::settings::RadiusRule;
use crate::ppm::under_way::UnderWay;

/// Rows of pixels whose hit points are put into packets together.
const ROWS: usize = 8;
/// Hit points that are, at least.
const MIN_BAND: usize = 1 << 10;

impl Ppm {
    /// Follows the eye samples of a pass, if it has samples of its own, and lays out what they find.
    pub(crate) fn renew_hit_points(
        &mut self,
        pass: &mut UnderWay,
        watch: &mut dyn FnMut(Stage),
        cancel: &Cancel,
        should_suspend: ShouldSuspend<'_>,
    ) -> Result<(), Halt> {
        let Some(renewal) = self.renewal.as_mut().filter(|_| !pass.has_hit_points) else { return Ok(()) };
        if !renewal.is_fresh {
            watch(Stage::EyePass);
            renewal.open_shutter((&mut self.scene, &self.settings, self.passes), cancel)?;
            let of = (&*self.scene, &self.settings, self.passes);
            let (paths, first_radius2) = renewal.follow(of, cancel, should_suspend)?;
            watch(Stage::Layout);
            pass.counts.rays += paths.rays;
            pass.counts.leave_out(Omissions { count: paths.dropped, first: paths.left_out });
            self.lay_out_anew(paths, first_radius2, cancel)?;
        }
        pass.has_hit_points = true;
        self.halt_at(pass.counts.left_out)
    }

    /// Lays out hit points in place of those before.
    fn lay_out_anew(
        &mut self,
        paths: EyePaths,
        first_radius2: Vec<f32>,
        cancel: &Cancel,
    ) -> Result<(), Cancelled> {
        let (_, height) = self.size();
        // Neighbours lie in a few rows. They are found sooner there than in the whole, and every pass looks for them.
        let in_band = (ROWS * paths.hit_points.len()).div_ceil(height as usize).max(MIN_BAND);
        let how = (self.has_shadow_rays(), in_band);
        let hit_points = lay_out(&self.scene, &paths, how, cancel)?;
        let hit_points = hit_points.with_statistics(has_moments(&self.settings));
        let grid = Grid::new(&hit_points.packets, cancel)?;
        (self.hit_points, self.grid) = (hit_points, grid);
        self.light.make_room_for(&self.hit_points);
        if let Some(renewal) = &mut self.renewal {
            renewal.take(paths.mean_emission(), first_radius2);
        }
        Ok(())
    }

    /// Lights all pixels by shadow rays from their new hit points.
    pub(crate) fn light_hit_points(
        &self,
        renewal: &Renewal,
        pass: &mut UnderWay,
        should_suspend: ShouldSuspend<'_>,
    ) -> Result<(), Suspended> {
        let Some(lights) = &renewal.lights else { return Ok(()) };
        let samples = self.settings.samples_per_pixel.get();
        let seed = self.settings.photon_seed();
        let lighting = Lighting { scene: &self.scene, hit_points: &self.hit_points, lights, samples, seed };
        let pixels = self.shapes.len();
        let by_block = ByBlock { done: &mut pass.lit, should_suspend };
        by_block.places(pixels.div_ceil(LIT_BLOCK)).enumerate().for_each(|(block, place)| {
            let first = block * LIT_BLOCK;
            place.fill(|| Renewal::light(&lighting, self.passes, first..pixels.min(first + LIT_BLOCK)));
        });
        if pass.lit.iter().any(Option::is_none) { Err(Suspended) } else { Ok(()) }
    }

    /// Adds a pass to what pixels keep; says which share of them has found no photon yet. `None` where hit points stay.
    pub(crate) fn add_to_renewal(&mut self, pass: &mut UnderWay) -> Option<f64> {
        let renewal = self.renewal.as_mut()?;
        renewal.is_fresh = false;
        let (rule, photons) = (self.settings.ppm.radius_rule, pass.counts.photons);
        let how = Shrinkage {
            alpha: pass.alpha,
            common: rule.common(pass.alpha, self.photons_emitted, photons),
            adapts: rule == RadiusRule::Adaptive,
        };
        let direct: Vec<Rgb> = pass.lit.drain(..).flatten().flat_map(|lit| lit.light).collect();
        let all = (self.light.luminance_sum(), self.photons_emitted + photons);
        renewal.add(&self.hit_points, how, (photons, direct), all);
        Some(renewal.pixels.unknown_share())
    }

    /// Lays out the hit points of the last pass, of a render that was restored: they are shown until the next.
    pub(crate) fn lay_out_last(&mut self) {
        let Some(renewal) = self.renewal.as_mut() else { return };
        let (last, cancel) = (self.passes.saturating_sub(1), Cancel::default());
        // Neither of the two that may break this off is asked for.
        if renewal.open_shutter((&mut self.scene, &self.settings, last), &cancel).is_err() {
            return;
        }
        let of = (&*self.scene, &self.settings, last);
        let Ok((paths, first_radius2)) = renewal.follow(of, &cancel, &|| false) else { return };
        let _ = self.lay_out_anew(paths, first_radius2, &cancel);
        if let Some(renewal) = &mut self.renewal {
            renewal.is_fresh = self.passes == 0;
        }
    }
}
