//! What leaving things out saves: one scene that needs nothing special, rendered with each part of the renderer forced on.
//!
//! `cargo xtask bench census` runs it and prints the table that docs/census.md records. One thread; the shortest time of
//! several renders, on the processor where the system tells (Linux), else on the wall.
#![allow(clippy::print_stdout, reason = "a program that prints a table")]

use std::num::NonZeroU32;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use foton_format::Options;
use foton_integrator::{Cancel, DirectLight, PpmSettings, Render, RenderSettings};
use foton_scene::description::SceneDescription;
use foton_scene::{BsdfKind, BuildOptions, Census, LobeFlags, Scene};

const PASSES: u32 = 6;
const RENDERS: u32 = 5;

struct Cost {
    eye_seconds: f64,
    pass_seconds: f64,
    bytes: usize,
}

fn main() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("tests/ lies in the repository");
    let path = root.join("assets/cornell-diffuse/scene.xml");
    let opened = foton_format::open(&path, &Options::default()).expect("an asset");
    let mut description = opened.description;
    for sensor in &mut description.sensors {
        (sensor.width, sensor.height) = (256, 256);
    }
    let none = Census::default();
    let kind = |flags, roughness, interpolated_normals| BsdfKind {
        flags,
        roughness,
        interpolated_normals,
        lambertian: true,
        masked: false,
    };
    let diffuse = LobeFlags::DIFFUSE | LobeFlags::REFLECTION;
    let smooth = vec![kind(diffuse, None, true)];
    let settings = || RenderSettings {
        ppm: PpmSettings {
            photons_per_pass: NonZeroU32::new(1 << 17).expect("above 0"),
            direct_light: DirectLight::Photons,
            ..PpmSettings::default()
        },
        ..RenderSettings::default()
    };
    let plain = settings();
    let shadow_rays = RenderSettings {
        ppm: PpmSettings { direct_light: DirectLight::ShadowRays, ..settings().ppm },
        ..settings()
    };
    let error = RenderSettings { error: true, ..settings() };
    let layers = RenderSettings { layers: true, ..settings() };
    let rows = [
        ("nothing", none.clone(), &plain),
        ("shading normals' correction", Census { bsdfs: smooth, ..none.clone() }, &plain),
        ("textures", Census { textures: true, ..none.clone() }, &plain),
        ("blends", Census { mixtures: true, ..none.clone() }, &plain),
        ("bump and normal maps", Census { reliefs: true, ..none.clone() }, &plain),
        ("anisotropic frames", Census { anisotropy: true, ..none.clone() }, &plain),
        ("environment", Census { environment: true, ..none.clone() }, &plain),
        ("rough coats", Census { rough_coats: true, ..none.clone() }, &plain),
        ("shadow rays", none.clone(), &shadow_rays),
        ("light by path class", none.clone(), &layers),
        ("live error", none, &error),
    ];
    let costs = costs(&description, &rows.clone().map(|(_, forced, settings)| (forced, settings)));
    println!("| forced on | eye pass, s | {PASSES} passes, s | passes | memory, MB |");
    println!("|---|---|---|---|---|");
    let base = costs.first().map_or(1.0, |c| c.pass_seconds);
    for ((name, ..), c) in rows.iter().zip(&costs) {
        println!(
            "| {name} | {:.3} | {:.3} | {:+.1} % | {:.1} |",
            c.eye_seconds,
            c.pass_seconds,
            100.0 * (c.pass_seconds / base - 1.0),
            c.bytes as f64 / 1e6
        );
    }
}

/// The shortest times of several renders, on one thread, of each census with its settings.
fn costs(description: &SceneDescription, rows: &[(Census, &RenderSettings)]) -> Vec<Cost> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    let mut best: Vec<Option<Cost>> = rows.iter().map(|_| None).collect();
    // In turns, so that a slow minute of the machine falls on all alike.
    for _ in 0..RENDERS {
        for ((forced, settings), best) in rows.iter().zip(&mut best) {
            let cost = pool.install(|| render(description, forced.clone(), settings));
            *best = Some(match best.take() {
                None => cost,
                Some(b) => Cost {
                    eye_seconds: b.eye_seconds.min(cost.eye_seconds),
                    pass_seconds: b.pass_seconds.min(cost.pass_seconds),
                    bytes: cost.bytes,
                },
            });
        }
    }
    best.into_iter().flatten().collect()
}

fn render(description: &SceneDescription, forced: Census, settings: &RenderSettings) -> Cost {
    let scene = Arc::new(
        Scene::build_with(description, &BuildOptions { forced, ..BuildOptions::default() })
            .expect("an asset"),
    );
    let cancel = Cancel::default();
    let clock = Clock::new();
    let mut render = Render::start(scene, settings.clone(), &mut |_| {}, &cancel).expect("not cancelled");
    let eye_seconds = clock.seconds();
    let clock = Clock::new();
    for _ in 0..PASSES {
        render.advance(&mut |_| {}, &cancel).expect("not cancelled");
    }
    Cost { eye_seconds, pass_seconds: clock.seconds(), bytes: render.bytes() }
}

/// Time of this thread.
struct Clock {
    begin: Instant,
    on_processor: Option<u64>,
}

impl Clock {
    fn new() -> Self {
        Self { begin: Instant::now(), on_processor: on_processor() }
    }

    fn seconds(&self) -> f64 {
        match (self.on_processor, on_processor()) {
            (Some(begin), Some(end)) => (end - begin) as f64 * 1e-9,
            _ => self.begin.elapsed().as_secs_f64(),
        }
    }
}

/// Nanoseconds that this thread has spent on a processor, where Linux tells.
fn on_processor() -> Option<u64> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    text.split_whitespace().next()?.parse().ok()
}
