//! Error a processor second: the bright spot under the glass ball of the benchmark box, one sample a pixel at its centre.
//!
//! The reference has the same eye samples, the mean of four runs with other photons and half of the first radius; its noise is
//! known from how the four differ, and taken off squared errors.

use std::fs;
use std::sync::Arc;

use foton_integrator::{Alpha, Cancel, DirectLight, PpmSettings, RadiusScale, Render, RenderSettings};
use foton_measure::processor_time;
use foton_scene::Scene;

use crate::rig;

pub(crate) const SIDE: u32 = 256;
/// Columns and rows of the spot.
const SPOT: [std::ops::RangeInclusive<u32>; 2] = [180..=235, 205..=235];
const RUNS: u64 = 4;
const REFERENCE_PASSES: u32 = 64;
const REFERENCE_PHOTONS: u32 = 1 << 20;
const REFERENCE_SCALE: f64 = 0.5;
/// Processor seconds after which a run ends.
const BUDGET: f64 = 61.0;

pub(crate) struct Reference {
    /// Mean of the spot's pixels.
    pixels: Vec<f64>,
    /// Root mean square of that mean's standard deviation.
    noise: f64,
}

pub(crate) fn print() {
    let reference = Reference::load_or_render();
    let mean = reference.pixels.iter().sum::<f64>() / reference.pixels.len() as f64;
    println!(
        "reference: {RUNS} x {REFERENCE_PASSES} x {REFERENCE_PHOTONS} photons, mean {mean:.4}, noise {:.4}\n",
        reference.noise
    );
    println!(
        "| settings | 1 | 2 | 4 | 6 | 15 | 30 | 60 CPU s | to 0.06 | to 0.03 |\n|---|---|---|---|---|---|---|---|---|---|"
    );
    for (name, settings) in rows() {
        let course = course(&settings, &reference);
        let at = |seconds: f64| course.iter().rfind(|(s, _)| *s <= seconds).map_or(f64::NAN, |c| c.1);
        let to = |error: f64| {
            course
                .iter()
                .find(|(_, e)| *e <= error)
                .map_or_else(|| "–".to_owned(), |c| format!("{:.1} s", c.0))
        };
        let cells = [1.0, 2.0, 4.0, 6.0, 15.0, 30.0, 60.0].map(|s| format!("{:.3}", at(s))).join(" | ");
        println!("| {name} | {cells} | {} | {} |", to(0.06), to(0.03));
    }
}

/// What is compared: names, and settings.
fn rows() -> [(&'static str, RenderSettings); 6] {
    let with = |change: fn(&mut PpmSettings)| {
        let mut settings = rig::settings();
        settings.ppm.first_pass = rig::number(1 << 14);
        change(&mut settings.ppm);
        settings
    };
    [
        ("2^18 photons a pass, α 2/3", with(|_| ())),
        ("2^16", with(|ppm| ppm.photons_per_pass = rig::number(1 << 16))),
        ("2^18, shadow rays", with(|ppm| ppm.direct_light = DirectLight::ShadowRays)),
        (
            "2^16, shadow rays",
            with(|ppm| {
                ppm.photons_per_pass = rig::number(1 << 16);
                ppm.direct_light = DirectLight::ShadowRays;
            }),
        ),
        ("2^18, α 0.8", with(|ppm| ppm.alpha = Alpha::new(0.8).expect("in range"))),
        ("2^18, the radius of the pixel's footprint", with(|ppm| ppm.radius = None)),
    ]
}

/// Processor seconds and error after each pass.
fn course(settings: &RenderSettings, reference: &Reference) -> Vec<(f64, f64)> {
    let scene = Arc::new(Scene::build(&rig::box_spheres(SIDE, SIDE)).expect("a sound scene"));
    let cancel = Cancel::default();
    let mut spent = 0.0;
    let mut begin = processor_time();
    let mut render = Render::start(scene, settings.clone(), &mut |_| (), &cancel).expect("nobody cancels");
    let mut course = Vec::new();
    while spent < BUDGET {
        render.advance(&mut |_| (), &cancel).expect("nobody cancels");
        spent += (processor_time() - begin).as_secs_f64();
        course.push((spent, error(&render, reference)));
        begin = processor_time();
    }
    course
}

/// Root mean squared error of luminance over the spot.
pub(crate) fn error(render: &Render, reference: &Reference) -> f64 {
    let squares = spot(render).into_iter().zip(&reference.pixels).map(|(a, b)| (a - b) * (a - b));
    let mean = squares.sum::<f64>() / reference.pixels.len() as f64;
    (mean - reference.noise * reference.noise).max(0.0).sqrt()
}

fn spot(render: &Render) -> Vec<f64> {
    let image = render.image();
    let [columns, rows] = SPOT;
    rows.flat_map(|y| columns.clone().map(move |x| (y * SIDE + x) as usize))
        .map(|i| f64::from(image.pixels[i].luminance()))
        .collect()
}

impl Reference {
    /// Kept in the target folder, since it takes minutes.
    pub(crate) fn load_or_render() -> Self {
        let name = format!("bench/box-spheres-{RUNS}x{REFERENCE_PASSES}x{REFERENCE_PHOTONS}.txt");
        let path = rig::target().join(name);
        let runs = fs::read_to_string(&path).ok().and_then(|text| parse(&text)).unwrap_or_else(|| {
            eprintln!("rendering the reference, once: minutes");
            let runs: Vec<Vec<f64>> = (1..=RUNS).map(render).collect();
            let line = |run: &Vec<f64>| run.iter().map(f64::to_string).collect::<Vec<_>>().join(" ");
            let text = runs.iter().map(line).collect::<Vec<_>>().join("\n");
            let folder = path.parent().expect("the name has a folder");
            if let Err(cause) = fs::create_dir_all(folder).and_then(|()| fs::write(&path, text)) {
                eprintln!("{}: {cause}", path.display());
            }
            runs
        });
        let n = runs.len() as f64;
        let mean = |i: usize| runs.iter().map(|run| run[i]).sum::<f64>() / n;
        let pixels: Vec<f64> = (0..runs[0].len()).map(mean).collect();
        let variance =
            |i: usize| runs.iter().map(|run| (run[i] - pixels[i]).powi(2)).sum::<f64>() / (n - 1.0) / n;
        let noise = ((0..pixels.len()).map(variance).sum::<f64>() / pixels.len() as f64).sqrt();
        Self { pixels, noise }
    }
}

fn render(seed: u64) -> Vec<f64> {
    let settings = RenderSettings {
        // Pixels' centres need no seed; photons do.
        seed: 1000 + seed,
        ppm: PpmSettings {
            photons_per_pass: rig::number(REFERENCE_PHOTONS),
            radius_scale: RadiusScale::new(REFERENCE_SCALE).expect("above 0"),
            ..rig::settings().ppm
        },
        ..rig::settings()
    };
    spot(&rig::run(&rig::box_spheres(SIDE, SIDE), &settings, 2, REFERENCE_PASSES as usize).render)
}

fn parse(text: &str) -> Option<Vec<Vec<f64>>> {
    let pixels = SPOT.map(|range| range.count()).iter().product::<usize>();
    let line = |line: &str| line.split(' ').map(|w| w.parse().ok()).collect::<Option<Vec<f64>>>();
    let runs = text.lines().map(line).collect::<Option<Vec<_>>>()?;
    (runs.len() as u64 == RUNS && runs.iter().all(|run| run.len() == pixels)).then_some(runs)
}
