//! Renders that differ only in how they refine, over the same photons: each pass is traced once and gathered by all of them.
//!
//! Photon paths do not depend on hit points: neither α nor radii change them. Whether direct light comes by shadow rays changes where
//! guided photons start, and those only. Each variant has the bits of a run of its own; only the use of emitters is that of the
//! widest, and where discs of one are so wide that it begins with smaller passes, all do. Not here: what the differences are worth
//! (`foton-measure`).

use std::sync::Arc;

use foton_scene::Scene;
use foton_transport::guide::WorthPoints;
use foton_transport::light_paths::PhotonPass;
use foton_transport::photon_map::{Chunk, Grid, PathClass};
use foton_transport::{Cancel, Cancelled, ShouldSuspend, Stage};
use rayon::prelude::*;

use super::algorithm::Ppm;
use super::eye_samples::EyeSamples;
use super::guidance::{Guidance, add_points};
use super::laid_out::discs;
use super::settings::PpmSettings;
use super::under_way::UnderWay;
use crate::render::Render;
use crate::report::PassReport;
use crate::settings::{Method, RenderSettings};

/// Whose work begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// Tracing for all: each would have done it alone.
    Trace,
    /// Handing photons out, which a run of its own has no need of.
    Share,
    /// A stage of the variant of that index.
    Of(usize, Stage),
}

/// What [`Variants::start`] makes sure of.
const OF_PPM: &str = "variants are renders by progressive photon mapping";

fn ppm(run: &Render) -> &Ppm {
    run.ppm().expect(OF_PPM)
}

fn ppm_mut(run: &mut Render) -> &mut Ppm {
    run.ppm_mut().expect(OF_PPM)
}

/// Variants advance by whole passes.
const NEVER: ShouldSuspend<'static> = &|| false;

/// Renders under way that share their photons.
pub struct Variants {
    runs: Vec<Render>,
    /// Touched by any disc of any variant, now or later: radii never grow.
    everywhere: Grid,
    chunks: Vec<Chunk>,
}

impl Variants {
    /// Collects the hit points of each of `settings`, which may differ in α, radii, layers, error and, unless photons
    /// are guided, direct light alone.
    /// Photons then have the seed `photons`: with that of the settings, each variant is what a run of its own would be; with
    /// others, runs are independent that see the same eye samples. `None` without settings, or if they differ otherwise.
    ///
    /// # Errors
    /// When cancelled.
    pub fn start(
        scene: &Arc<Scene>,
        settings: &[RenderSettings],
        photons: u64,
        watch: &mut dyn FnMut(Step),
        cancel: &Cancel,
    ) -> Result<Option<Self>, Cancelled> {
        let Some(first) = settings.first() else { return Ok(None) };
        if first.method != Method::Ppm || settings.iter().any(|s| !shares_photons(first, s)) {
            return Ok(None);
        }
        let start = |(i, settings): (usize, &RenderSettings)| {
            let watch = &mut |stage| watch(Step::Of(i, stage));
            let mut run = Render::start(Arc::clone(scene), settings.clone(), watch, cancel)?;
            ppm_mut(&mut run).settings.photon_seed = Some(photons);
            Ok(run)
        };
        let mut runs: Vec<Render> = settings.iter().enumerate().map(start).collect::<Result<_, _>>()?;
        begin_alike(&mut runs);
        let widest = |run: &&Render| ppm(run).hit_points.in_sample_order().map(|s| s.radius2()).sum::<f64>();
        let widest = runs.iter().max_by(|a, b| widest(a).total_cmp(&widest(b)));
        let Some(everywhere) =
            widest.map(|run| Grid::new(&ppm(run).hit_points.packets, cancel)).transpose()?
        else {
            return Ok(None);
        };
        Ok(Some(Self { runs, everywhere, chunks: Vec::new() }))
    }

    /// Renders of a scene through several of its sensors, which photons are aimed at and guided to all together: each hit point gets the
    /// light of a render of its own, with the noise of photons that start elsewhere. Where they are neither guided nor aimed, and passes
    /// of that render would begin as small, it has its bits. `None` without sensors, or by another method.
    ///
    /// # Errors
    /// When cancelled.
    pub fn of_sensors(
        scene: &Arc<Scene>,
        settings: &RenderSettings,
        sensors: &[usize],
        watch: &mut dyn FnMut(Step),
        cancel: &Cancel,
    ) -> Result<Option<Self>, Cancelled> {
        if settings.method != Method::Ppm || sensors.is_empty() {
            return Ok(None);
        }
        let (mut points, mut seen) = (WorthPoints::default(), Vec::new());
        let mut runs = Vec::with_capacity(sensors.len());
        for (i, &sensor) in sensors.iter().enumerate() {
            let watch = &mut |stage| watch(Step::Of(i, stage));
            watch(Stage::EyePass);
            let mut eye = EyeSamples::new(Arc::clone(scene), RenderSettings { sensor, ..settings.clone() });
            eye.follow_all(cancel, &|_| ())?;
            add_points(&mut points, &eye.paths);
            seen.extend(discs(&eye.paths.hit_points));
            runs.push(Render::of_ppm(Ppm::start(eye, &|_| (), watch, cancel)?));
        }
        begin_alike(&mut runs);
        let sources = scene.sources(&seen);
        for run in &mut runs {
            let run = ppm_mut(run);
            // The first emits for all, and alone has to know what light is worth.
            let points = settings.ppm.guided.then(|| std::mem::take(&mut points));
            run.guidance = Guidance::over(&sources, points);
            run.sources = sources.clone();
            run.cameras = sensors.to_vec();
        }
        let all = runs.iter().flat_map(|run| ppm(run).hit_points.packets.iter().cloned());
        let everywhere = Grid::new(&all.collect::<Vec<_>>(), cancel)?;
        Ok(Some(Self { runs, everywhere, chunks: Vec::new() }))
    }

    /// One pass of all variants, in their order.
    ///
    /// # Errors
    /// When cancelled; the variants may then be a pass apart and are not to be used.
    pub fn advance(
        &mut self,
        watch: &mut dyn FnMut(Step),
        cancel: &Cancel,
    ) -> Result<Vec<PassReport>, Cancelled> {
        let mut passes: Vec<UnderWay> = self.runs.iter_mut().map(|run| ppm_mut(run).begin_pass()).collect();
        let photons = passes[0].planned();
        let stores_direct = self.runs.iter().any(|run| ppm(run).direct.is_none());
        while let Some(batch) = passes[0].batch() {
            watch(Step::Trace);
            let pass = ppm(&self.runs[0]).photon_pass(photons, batch);
            let photon_pass = PhotonPass { grid: &self.everywhere, stores_direct, ..pass };
            photon_pass.begin(&mut self.chunks);
            photon_pass.shoot(&mut self.chunks, cancel, NEVER).map_err(|_| Cancelled)?;
            // All have the cells of the first.
            ppm_mut(&mut self.runs[0]).guidance.take(&mut self.chunks);
            for (i, (run, pass)) in self.runs.iter_mut().zip(&mut passes).enumerate() {
                let run = ppm_mut(run);
                watch(Step::Share);
                hand_out(&self.chunks, run);
                let watch = &mut |stage| watch(Step::Of(i, stage));
                run.build_map(pass, watch, cancel)?;
                run.gather_and_refine(batch, pass, watch, NEVER).map_err(|_| Cancelled)?;
                pass.end_batch();
            }
        }
        let runs = self.runs.iter_mut().zip(passes).enumerate();
        let conclude = |(i, (run, mut pass)): (usize, (&mut Render, UnderWay))| {
            let watch = &mut |stage| watch(Step::Of(i, stage));
            let run = ppm_mut(run);
            run.add_shadow_rays(&mut pass, watch, NEVER).map_err(|_| Cancelled)?;
            Ok(run.accumulate(pass, watch))
        };
        runs.map(conclude).collect()
    }

    /// The renders, in the order of their settings.
    #[must_use]
    pub fn runs(&self) -> &[Render] {
        &self.runs
    }
}

/// All begin with passes as small as those with the widest discs.
fn begin_alike(runs: &mut [Render]) {
    let least = runs.iter().map(|run| run.settings().ppm.first_pass).min();
    for run in runs {
        let settings = &mut ppm_mut(run).settings;
        settings.ppm.first_pass = least.unwrap_or(settings.ppm.first_pass);
    }
}

/// Whether two renders trace the same photons from the same eye samples.
fn shares_photons(a: &RenderSettings, b: &RenderSettings) -> bool {
    let same = RenderSettings {
        layers: a.layers,
        error: a.error,
        ppm: PpmSettings {
            alpha: a.ppm.alpha,
            radius: a.ppm.radius,
            radius_scale: a.ppm.radius_scale,
            radius_floor: a.ppm.radius_floor,
            radius_rule: a.ppm.radius_rule,
            direct_light: if a.ppm.guided { b.ppm.direct_light } else { a.ppm.direct_light },
            ..b.ppm
        },
        ..b.clone()
    };
    same == *a
}

/// Gives a render those photons that its discs can reach.
fn hand_out(all: &[Chunk], run: &mut Ppm) {
    let skip_direct = run.direct.is_some();
    let (own, grid) = (&mut run.chunks, &run.grid);
    own.resize_with(all.len(), Chunk::default);
    own.par_iter_mut().zip(all).for_each(|(own, all)| {
        own.photons.clear();
        own.cells.clear();
        for photon in &all.photons {
            if skip_direct && photon.class_index() == PathClass::Direct as usize {
                continue;
            }
            if let Some(cell) = grid.number(photon.position) {
                own.photons.push(*photon);
                own.cells.push(cell);
            }
        }
        (own.ledger, own.rays) = (all.ledger, all.rays);
        own.lights.clone_from(&all.lights);
        own.losses.clone_from(&all.losses);
        own.left_out = all.left_out;
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::num::NonZeroU32;

    use super::super::settings::{Alpha, DirectLight, RadiusScale};
    use crate::test_scene::{description, scene};
    use foton_film::Image;
    use foton_math::glam::DAffine3;
    use foton_scene::description::SensorDescription;

    #[test]
    fn variants_in_batches_have_the_bits_of_runs_of_their_own_in_batches() {
        let photons = NonZeroU32::new(20_000).expect("above 0");
        // So short that power is cut off at the materials.
        let base = RenderSettings {
            max_depth: Some(3),
            ppm: PpmSettings { photons_per_pass: photons, first_pass: photons, ..PpmSettings::default() },
            ..RenderSettings::default()
        };
        let with = |ppm: PpmSettings| RenderSettings { ppm, ..base.clone() };
        let steep = PpmSettings { alpha: Alpha::new(0.3).expect("in range"), ..base.ppm };
        let wide = PpmSettings { radius_scale: RadiusScale::new(2.0).expect("above 0"), ..base.ppm };
        assert_each_is_a_run_of_its_own(&[
            base.clone(),
            RenderSettings { error: true, ..with(steep) },
            with(wide),
        ]);
        let unguided = PpmSettings { guided: false, ..base.ppm };
        let photons = PpmSettings { direct_light: DirectLight::Photons, ..unguided };
        let shadow_rays = PpmSettings { direct_light: DirectLight::ShadowRays, ..unguided };
        assert_each_is_a_run_of_its_own(&[with(photons), with(shadow_rays)]);
        // Guided photons start where they are worth something, which those of direct light are not behind shadow rays.
        let guided = [photons, shadow_rays].map(|ppm| with(PpmSettings { guided: true, ..ppm }));
        let started = Variants::start(&scene(), &guided, 0, &mut |_| (), &Cancel::default());
        assert!(started.expect("not cancelled").is_none());
    }

    fn assert_each_is_a_run_of_its_own(settings: &[RenderSettings]) {
        let (scene, cancel) = (scene(), Cancel::default());
        let started = Variants::start(&scene, settings, 0, &mut |_| (), &cancel).expect("not cancelled");
        let mut together = started.expect("they share their photons");
        together.runs.iter_mut().for_each(|run| ppm_mut(run).max_in_batch = 6_000);
        for _ in 0..3 {
            together.advance(&mut |_| (), &cancel).expect("not cancelled");
        }
        for (settings, run) in settings.iter().zip(together.runs()) {
            let alone = Ppm::start(
                EyeSamples::new(Arc::clone(&scene), settings.clone()),
                &|_| (),
                &mut |_| (),
                &cancel,
            );
            let mut alone = alone.expect("not cancelled").with_batches_of(6_000);
            for _ in 0..3 {
                alone.advance(&mut |_| (), &cancel, NEVER).expect("not cancelled");
            }
            assert!(run.image() == alone.image() && run.ledger() == alone.ledger());
            assert!(alone.material_losses().iter().any(|loss| loss.truncated > 0.0));
            assert_eq!(run.material_losses(), alone.material_losses());
        }
    }

    /// The scene with a second camera, which looks at the glass ball from aside and is as large as half the first.
    fn two_cameras() -> Arc<Scene> {
        let mut description = description();
        let turned = DAffine3::from_rotation_y(0.4) * description.sensors[0].to_world;
        let aside =
            SensorDescription { name: "aside".into(), to_world: turned, ..description.sensors[0].clone() };
        description.sensors.push(SensorDescription { width: 16, height: 24, ..aside });
        Arc::new(Scene::build(&description).expect("sound"))
    }

    fn of_two(guided: bool) -> (RenderSettings, Vec<Image>) {
        let (scene, cancel) = (two_cameras(), Cancel::default());
        let photons = NonZeroU32::new(20_000).expect("above 0");
        let ppm =
            PpmSettings { photons_per_pass: photons, first_pass: photons, guided, ..PpmSettings::default() };
        let settings = RenderSettings { error: true, ppm, ..RenderSettings::default() };
        let started = Variants::of_sensors(&scene, &settings, &[0, 1], &mut |_| (), &cancel);
        let mut together = started.expect("not cancelled").expect("by photons");
        for _ in 0..4 {
            together.advance(&mut |_| (), &cancel).expect("not cancelled");
        }
        let images = together.runs().iter().map(Render::image).collect();
        (settings, images)
    }

    fn alone(settings: &RenderSettings, sensor: usize, passes: u32) -> Image {
        let cancel = Cancel::default();
        let settings = RenderSettings { sensor, ..settings.clone() };
        let mut alone = Render::start(two_cameras(), settings, &mut |_| (), &cancel).expect("not cancelled");
        for _ in 0..passes {
            alone.advance(&mut |_| (), &cancel).expect("not cancelled");
        }
        alone.image()
    }

    #[test]
    fn cameras_that_share_unguided_photons_have_the_bits_of_renders_of_their_own() {
        let (settings, images) = of_two(false);
        for (sensor, image) in images.iter().enumerate() {
            assert!(*image == alone(&settings, sensor, 4), "camera {sensor}");
        }
        assert_eq!([images[1].width, images[1].height], [16, 24]);
    }

    #[test]
    fn cameras_that_share_guided_photons_see_the_same_light() {
        let (settings, images) = of_two(true);
        for (sensor, image) in images.iter().enumerate() {
            let mean = |image: &Image| {
                image.pixels.iter().map(|p| f64::from(p.luminance())).sum::<f64>() / image.pixels.len() as f64
            };
            let reference = mean(&alone(&settings, sensor, 16));
            let deviation = mean(image) / reference - 1.0;
            assert!(deviation.abs() < 0.02, "camera {sensor}: {deviation}");
            assert!(*image != alone(&settings, sensor, 4), "guided to what both see");
        }
    }
}
