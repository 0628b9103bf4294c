//! The total error of methods, antialiasing included, after some processor seconds on one thread. docs/sppm.md records what it prints.
//!
//! `cargo run -p foton-tests --example total -- SCENES METHODS WIDTH SECONDS REFERENCE-SECONDS`, the first four separated by commas; a
//! method may have settings, as in `ppm:spp=4` or `sppm:photons=65536:rule=local`. References are two renders of
//! stochastic progressive photon mapping with other seeds, kept in the target folder; half their difference is the noise of their mean.
#![allow(clippy::print_stdout, reason = "a program that prints tables")]

use std::fs;
use std::num::NonZeroU32;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use foton_film::{Image, Metadata, read_exr, write_exr};
use foton_integrator::{Cancel, DirectLight, Method, RadiusRule, RadiusScale, Render, RenderSettings, Stage};
use foton_measure::{Pair, without_bright_emitters};
use foton_scene::Scene;

/// Of the numbers in `/proc/self/stat`: the same on all Linux systems.
const TICKS_PER_SECOND: f64 = 100.0;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [scenes, methods, widths, seconds, reference_seconds] = &arguments[..] else {
        eprintln!("usage: total SCENES METHODS WIDTH SECONDS REFERENCE-SECONDS");
        std::process::exit(2);
    };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    let seconds: Vec<f64> = seconds.split(',').map(number).collect();
    println!("| scene | method | seconds | passes | error | relative | live | noise | bias | time |");
    println!("|---|---|---|---|---|---|---|---|---|---|");
    for name in scenes.split(',') {
        for width in widths.split(',') {
            let scene = scene(name, number(width) as u32);
            let reference = pool.install(|| reference(name, &scene, number(reference_seconds)));
            let truth = pool.install(|| Truth::new(&scene, mean_of(&reference)));
            let [error, relative] = errors(&reference[0], &truth);
            println!(
                "| {name} | reference's noise | | | {:.2} % | {:.2} % | | | | |",
                100.0 * error,
                100.0 * relative
            );
            for method in methods.split(',') {
                let settings = settings(method, 0);
                pool.install(|| {
                    course(&scene, settings, &seconds, &mut |seconds, render, clock| {
                        print(name, method, &truth, (seconds, render, clock));
                    });
                });
            }
        }
    }
}

fn number(text: &str) -> f64 {
    text.parse().unwrap_or_else(|_| panic!("{text} is no number"))
}

fn scene(name: &str, width: u32) -> Arc<Scene> {
    let assets = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("in the repository").join("assets");
    let path = assets.join(name).join("scene.xml");
    let mut description =
        foton_format::open(&path, &foton_format::Options::default()).expect("an asset").description;
    for sensor in &mut description.sensors {
        let height = (sensor.height * width).div_ceil(sensor.width);
        sensor.resize(width, height);
    }
    Arc::new(Scene::build(&description).expect("a sound scene"))
}

/// `METHOD:NAME=VALUE…`.
fn settings(text: &str, seed: u64) -> RenderSettings {
    let mut words = text.split(':');
    let name = words.next().unwrap_or_default();
    let method = Method::from_name(name).unwrap_or_else(|| panic!("no method {name}"));
    let samples_per_pixel = method.default_samples();
    let mut settings =
        RenderSettings { method, seed, error: true, samples_per_pixel, ..RenderSettings::default() };
    for (name, value) in words.filter_map(|word| word.split_once('=')) {
        let count = || NonZeroU32::new(number(value) as u32).expect("above 0");
        match name {
            "spp" => settings.samples_per_pixel = count(),
            "seed" => settings.seed = u64::from(count().get()),
            "photons" => settings.ppm.photons_per_pass = count(),
            "first" => settings.ppm.first_pass = count(),
            "scale" => settings.ppm.radius_scale = RadiusScale::new(number(value)).expect("above 0"),
            "rule" => settings.ppm.radius_rule = RadiusRule::from_name(value).expect("a rule"),
            "direct" if value == "photons" => settings.ppm.direct_light = DirectLight::Photons,
            "direct" => settings.ppm.direct_light = DirectLight::ShadowRays,
            "error" => settings.error = value == "1",
            _ => panic!("no setting {name}"),
        }
    }
    settings
}

/// Processor time of this process so far.
fn processor_seconds() -> f64 {
    let stat = fs::read_to_string("/proc/self/stat").expect("Linux");
    let fields: Vec<&str> = stat.rsplit_once(')').expect("a name").1.split_whitespace().collect();
    fields[11..13].iter().map(|ticks| ticks.parse::<f64>().expect("a number")).sum::<f64>() / TICKS_PER_SECOND
}

/// Shows a render after some seconds.
type Show<'a> = &'a mut dyn FnMut(f64, &Render, &Clock);

/// Seconds by stage.
#[derive(Default)]
struct Clock {
    stages: [f64; Stage::ALL.len()],
    running: Option<(Stage, f64)>,
}

impl Clock {
    fn begin(&mut self, stage: Option<Stage>) {
        let now = processor_seconds();
        if let Some((stage, begin)) = self.running {
            self.stages[stage as usize] += now - begin;
        }
        self.running = stage.map(|stage| (stage, now));
    }
}

/// Renders on the thread that this is called from, and shows it at each of some seconds.
fn course(scene: &Arc<Scene>, settings: RenderSettings, seconds: &[f64], show: Show<'_>) {
    let cancel = Cancel::default();
    let begin = processor_seconds();
    let mut clock = Clock::default();
    let mut render =
        Render::start(Arc::clone(scene), settings, &mut |stage| clock.begin(Some(stage)), &cancel)
            .expect("nobody cancels");
    let mut left = seconds.iter();
    let mut next = left.next();
    while let Some(limit) = next {
        render.advance(&mut |stage| clock.begin(Some(stage)), &cancel).expect("nobody cancels");
        clock.begin(None);
        let spent = processor_seconds() - begin;
        if spent >= *limit {
            show(spent, &render, &clock);
            next = left.find(|limit| **limit > spent);
        }
    }
}

/// What images are compared with, and the pixels that count: those that do not see an emitter brighter than white, and have no neighbour
/// that does.
struct Truth {
    image: Image,
    counts: Vec<bool>,
}

impl Truth {
    fn new(scene: &Arc<Scene>, image: Image) -> Self {
        const PASSES: u32 = 32;
        let settings = RenderSettings { max_depth: Some(1), ..settings("path", 0) };
        let cancel = Cancel::default();
        let mut render =
            Render::start(Arc::clone(scene), settings, &mut |_| {}, &cancel).expect("nobody cancels");
        for _ in 0..PASSES {
            render.advance(&mut |_| {}, &cancel).expect("nobody cancels");
        }
        Self { counts: without_bright_emitters(&render.image(), &image), image }
    }
}

/// Root mean square of the difference in luminance over the reference's mean, without the brightest 0.5 % of the pixels that count; and
/// relative to each pixel's own.
fn errors(image: &Image, truth: &Truth) -> [f64; 2] {
    let pair = Pair::new(image, &truth.image).expect("images of one size");
    let trimmed = pair.trimmed_rmse(|pixel| truth.counts[pixel]);
    let luminances: Vec<[f64; 2]> = image
        .pixels
        .iter()
        .zip(&truth.image.pixels)
        .zip(&truth.counts)
        .filter(|(_, counts)| **counts)
        .map(|((p, r), _)| [f64::from(p.luminance()), f64::from(r.luminance())])
        .collect();
    let n = luminances.len() as f64;
    let mean = luminances.iter().map(|[_, r]| r).sum::<f64>() / n;
    let relative =
        luminances.iter().map(|[p, r]| (p - r).powi(2) / (r * r + 0.01 * mean * mean)).sum::<f64>() / n;
    [trimmed, relative.sqrt()]
}

fn mean_of([a, b]: &[Image; 2]) -> Image {
    let mut image = a.clone();
    image.pixels.iter_mut().zip(&b.pixels).for_each(|(p, q)| *p = (*p + *q) * 0.5);
    image
}

/// Keeps an image beside the references.
fn keep(name: &str, method: &str, seconds: f64, image: &Image) {
    let path = folder().join(format!("{name}-{}-{method}-{seconds:.0}.exr", image.width));
    write_exr(&path, image, &[], &Metadata::default()).expect("it can be written");
}

fn print(name: &str, method: &str, truth: &Truth, (seconds, render, clock): (f64, &Render, &Clock)) {
    let [error, relative] = errors(&render.image(), truth);
    keep(name, method, seconds, &render.image());
    let percent = |x: f64| format!("{:.2} %", 100.0 * x);
    let live = render.error();
    let of = |f: fn(&foton_integrator::ErrorEstimate) -> f64| {
        live.as_ref().map_or("–".to_owned(), |e| percent(f(e)))
    };
    let all: f64 = clock.stages.iter().sum();
    let stages: Vec<String> = Stage::ALL
        .iter()
        .map(|stage| format!("{} {:.0} %", stage.name(), 100.0 * clock.stages[*stage as usize] / all))
        .collect();
    println!(
        "| {name} | {method} | {seconds:.1} | {} | {} | {} | {} | {} | {} | {} |",
        render.passes(),
        percent(error),
        percent(relative),
        of(|e| e.total),
        of(|e| e.noise),
        of(|e| e.bias),
        stages.join(", "),
    );
}

fn folder() -> PathBuf {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .expect("in the repository")
        .join("target/bench/references");
    fs::create_dir_all(&folder).expect("it can be made");
    folder
}

fn reference(name: &str, scene: &Arc<Scene>, seconds: f64) -> [Image; 2] {
    [101, 102].map(|seed| {
        let width = scene.sensors()[0].width;
        let path = folder().join(format!("{name}-{width}-total-{seed}-{seconds}.exr"));
        if !path.exists() {
            let settings = RenderSettings { error: false, ..settings("sppm", seed) };
            course(scene, settings, &[seconds / 2.0], &mut |_, render, _| {
                write_exr(&path, &render.image(), &[], &Metadata::default()).expect("it can be written");
            });
        }
        read_exr(&path).expect("it was written").0
    })
}
