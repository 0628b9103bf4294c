//! How a pass grows with triangles, photons and hit points, over three decades each: tables and docs/pictures/scaling-*.svg.

use std::sync::Arc;

use foton_integrator::{PpmSettings, RenderSettings, Stage};
use foton_math::glam::{DAffine3, DVec3};
use foton_measure::plot::{Plot, Series, colour};
use foton_scene::description::{Geometry, Mesh, SceneDescription, ShapeDescription};

use crate::rig::{self, Run};

const THREADS: usize = 2;
const SIDE: u32 = 256;
const PASSES: usize = 12;
/// Passes before the median is taken.
const FIRST: usize = 4;

pub(crate) fn print() {
    let side_of = |cells: f64| (cells / 2.0).sqrt().round() as usize;
    let triangles: Vec<(f64, Run)> = [1e3, 1e4, 1e5, 1e6]
        .map(|n| {
            let side = side_of(n);
            let run = rig::run(&on_a_fine_floor(side), &rig::settings(), THREADS, PASSES);
            ((2 * side * side) as f64, run)
        })
        .into();
    table("triangles", &triangles);
    plot("scaling-triangles", "A pass over the triangles of a floor", "triangles", &triangles);

    let photons: Vec<(f64, Run)> = (12..=22)
        .step_by(2)
        .map(|power| {
            let photons = 1 << power;
            let settings = RenderSettings {
                ppm: PpmSettings {
                    photons_per_pass: rig::number(photons),
                    first_pass: rig::number(photons),
                    ..rig::settings().ppm
                },
                ..rig::settings()
            };
            (f64::from(photons), rig::run(&rig::box_spheres(SIDE, SIDE), &settings, THREADS, PASSES))
        })
        .collect();
    table("photons a pass", &photons);
    plot("scaling-photons", "A pass over its photons", "photons a pass", &photons);

    let hit_points: Vec<(f64, Run)> = [32, 64, 128, 256, 512, 1024]
        .map(|side| {
            let run = rig::run(&rig::box_spheres(side, side), &rig::settings(), THREADS, PASSES);
            (run.render.start_report().hit_points as f64, run)
        })
        .into();
    table("hit points", &hit_points);
    plot("scaling-hit-points", "A pass over its hit points", "hit points", &hit_points);
}

fn table(what: &str, runs: &[(f64, Run)]) {
    println!(
        "\n| {what} | ms a pass | trace | sort | gather | radiance | M photons/s | MiB |\n|---|---|---|---|---|---|---|---|"
    );
    for (x, run) in runs {
        let ms = |stage| format!("{:.1}", 1e3 * run.median_of(stage, FIRST));
        let stages = [Stage::Trace, Stage::Sort, Stage::Gather, Stage::Radiance].map(ms).join(" | ");
        let seconds = run.median(FIRST);
        let rate = run.mean(FIRST, |r| r.photons_in_pass) / seconds / 1e6;
        let bytes = run.render.bytes() as f64 / f64::from(1 << 20);
        println!("| {x} | {:.1} | {stages} | {rate:.3} | {bytes:.0} |", 1e3 * seconds);
    }
}

fn plot(file: &str, title: &str, x: &str, runs: &[(f64, Run)]) {
    let points = |f: &dyn Fn(&Run) -> f64| runs.iter().map(|(x, run)| (*x, 1e3 * f(run))).collect();
    let stages = [
        ("trace", Stage::Trace),
        ("sort", Stage::Sort),
        ("gather", Stage::Gather),
        ("radiance", Stage::Radiance),
    ];
    let mut series = vec![Series::new("whole pass", colour(0), 0, points(&|run| run.median(FIRST)))];
    for (i, (name, stage)) in stages.into_iter().enumerate() {
        series.push(Series::new(name, colour(i + 1), i + 1, points(&|run| run.median_of(stage, FIRST))));
    }
    let plot = Plot { title, x, y: "ms a pass", series };
    if let Some(svg) = plot.file() {
        let path = rig::root().join(format!("docs/pictures/{file}.svg"));
        std::fs::write(&path, svg).expect("docs/pictures can be written");
        eprintln!("wrote {}", path.display());
    }
}

/// The box with a floor of 2 `side`² triangles in gentle waves just above its own.
pub(crate) fn on_a_fine_floor(side: usize) -> SceneDescription {
    let mut description = rig::box_spheres(SIDE, SIDE);
    let at = |i: usize| i as f64 / side as f64;
    let positions = (0..=side)
        .flat_map(|j| (0..=side).map(move |i| (at(i), at(j))))
        .map(|(u, v)| {
            let height = 0.05 + 0.02 * ((40.0 * u).sin() + (40.0 * v).cos());
            DVec3::new(1.0 + 98.0 * u, height, 170.0 * v)
        })
        .collect();
    let corner = |i: usize, j: usize| (j * (side + 1) + i) as u32;
    let triangles = (0..side)
        .flat_map(|j| (0..side).map(move |i| (i, j)))
        .flat_map(|(i, j)| {
            let [a, b, c, d] = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
            [[a, d, c], [a, c, b]]
        })
        .collect();
    let floor = description.shapes.iter().position(|s| s.name == "floor").expect("a floor");
    let material = description.shapes[floor].material;
    description.shapes.push(ShapeDescription {
        name: "fine floor".into(),
        geometry: Geometry::Mesh(Arc::new(Mesh { positions, triangles, ..Mesh::default() })),
        to_world: DAffine3::IDENTITY,
        flip_normals: false,
        material,
        radiance: None,
    });
    description
}
