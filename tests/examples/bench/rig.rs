//! Renders that are timed stage by stage, pass by pass.

use std::fs;
use std::num::NonZeroU32;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use foton_format::Options;
use foton_integrator::{Cancel, DirectLight, PassReport, PpmSettings, Render, RenderSettings, Stage};
use foton_scene::Scene;
use foton_scene::description::{Filter, SceneDescription};

/// The first radius of the peers in the table of targets, in world units.
pub(crate) const RADIUS: f64 = 0.455;
/// Photons a pass.
pub(crate) const PHOTONS: u32 = 1 << 18;
/// Passes before rates are steady: radii shrink fastest in the first.
pub(crate) const WARM_UP: usize = 16;

const STAGES: usize = Stage::ALL.len();

/// Of the numbers in `/proc/PID/stat`: the same on all Linux systems.
const TICKS_PER_SECOND: f64 = 100.0;

/// What one render took.
pub(crate) struct Run {
    /// Seconds of collecting hit points on the wall.
    pub(crate) eye_seconds: f64,
    /// Seconds on the wall by pass and stage.
    pub(crate) passes: Vec<[f64; STAGES]>,
    pub(crate) reports: Vec<PassReport>,
    pub(crate) render: Render,
}

/// The benchmark box.
pub(crate) fn box_spheres(width: u32, height: u32) -> SceneDescription {
    let path = root().join("assets/box-spheres/scene.xml");
    let mut description = foton_format::open(&path, &Options::default()).expect("an asset").description;
    for sensor in &mut description.sensors {
        sensor.resize(width, height);
        // One sample a pixel, at its centre.
        sensor.filter = Filter::Box { radius: 1e-6 };
    }
    description
}

/// The repository.
pub(crate) fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("tests/ lies in the repository")
}

/// The folder that cargo builds into.
pub(crate) fn target() -> PathBuf {
    std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), PathBuf::from)
}

/// Processor time of a running process, user's and system's.
pub(crate) fn processor_seconds(id: u32) -> Option<f64> {
    let stat = fs::read_to_string(Path::new("/proc").join(id.to_string()).join("stat")).ok()?;
    // The name, in brackets, may hold anything.
    let fields: Vec<&str> = stat.rsplit_once(')')?.1.split_whitespace().collect();
    let ticks: u64 = fields.get(11..13)?.iter().filter_map(|field| field.parse::<u64>().ok()).sum();
    Some(ticks as f64 / TICKS_PER_SECOND)
}

/// FNV-1a.
pub(crate) fn fnv(bytes: impl IntoIterator<Item = u8>) -> u64 {
    let bytes = bytes.into_iter();
    bytes.fold(0xcbf2_9ce4_8422_2325, |h, b| (h ^ u64::from(b)).wrapping_mul(0x0100_0000_01b3))
}

pub(crate) fn number(n: u32) -> NonZeroU32 {
    NonZeroU32::new(n).expect("above 0")
}

/// One sample a pixel, passes of [`PHOTONS`] from the first on, and nothing that was not asked for.
pub(crate) fn settings() -> RenderSettings {
    RenderSettings {
        samples_per_pixel: NonZeroU32::MIN,
        ppm: PpmSettings {
            photons_per_pass: number(PHOTONS),
            first_pass: number(PHOTONS),
            radius: Some(RADIUS),
            direct_light: DirectLight::Photons,
            ..PpmSettings::default()
        },
        ..RenderSettings::default()
    }
}

/// Builds the scene and renders it on so many threads.
pub(crate) fn run(
    description: &SceneDescription,
    settings: &RenderSettings,
    threads: usize,
    passes: usize,
) -> Run {
    let scene = Arc::new(Scene::build(description).expect("a sound scene"));
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    pool.install(|| {
        let cancel = Cancel::default();
        let clock = Instant::now();
        let mut render =
            Render::start(scene, settings.clone(), &mut |_| (), &cancel).expect("nobody cancels");
        let eye_seconds = clock.elapsed().as_secs_f64();
        let mut timed = Vec::new();
        let mut reports = Vec::new();
        for _ in 0..passes {
            let mut seconds = [0.0; STAGES];
            let mut running: Option<(Stage, Instant)> = None;
            let mut end = |running: Option<(Stage, Instant)>| {
                if let Some((stage, begin)) = running {
                    seconds[stage as usize] += begin.elapsed().as_secs_f64();
                }
            };
            let report = render.advance(&mut |stage| end(running.replace((stage, Instant::now()))), &cancel);
            end(running);
            reports.push(report.expect("nobody cancels"));
            timed.push(seconds);
        }
        Run { eye_seconds, passes: timed, reports, render }
    })
}

impl Run {
    /// Median seconds of a stage in the passes from the `first` on.
    pub(crate) fn median_of(&self, stage: Stage, first: usize) -> f64 {
        median(self.passes[first..].iter().map(|pass| pass[stage as usize]))
    }

    /// Median seconds of a pass from the `first` on.
    pub(crate) fn median(&self, first: usize) -> f64 {
        median(self.passes[first..].iter().map(|pass| pass.iter().sum::<f64>()))
    }

    /// Mean over the passes from the `first` on of a number that each reports.
    pub(crate) fn mean(&self, first: usize, f: impl Fn(&PassReport) -> u64) -> f64 {
        let reports = &self.reports[first..];
        reports.iter().map(|r| f(r) as f64).sum::<f64>() / reports.len() as f64
    }

    /// FNV-1a of the image's bits.
    pub(crate) fn hash(&self) -> u64 {
        let bits = self.render.image().pixels;
        fnv(bits.iter().flat_map(|p| p.to_array()).flat_map(|c| c.to_bits().to_le_bytes()))
    }
}

/// The middle one.
pub(crate) fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}
