//! Whole runs of the benchmark box: stages, rates, efficiency, and beside them the image's hash and its error.

use foton_integrator::{RenderSettings, Stage};

use crate::accuracy::{self, Reference};
use crate::rig::{self, PHOTONS, Run, WARM_UP};

const SIDE: u32 = 512;
const PASSES: usize = 48;
/// Stages that a pass goes through here.
const STAGES: [Stage; 4] = [Stage::Trace, Stage::Sort, Stage::Gather, Stage::Radiance];

pub(crate) fn print() {
    let settings = rig::settings();
    let description = rig::box_spheres(SIDE, SIDE);
    // One pixel touches next to no cell: the same photon paths without deposits, lookups and sorting.
    let bare = rig::box_spheres(1, 1);
    let [two, one] = [2, 1].map(|threads| {
        let run = rig::run(&description, &settings, threads, PASSES);
        let bare = rig::run(&bare, &settings, threads, PASSES);
        report(&run, &bare, threads);
        run
    });
    println!("\n| stage | one thread over two |\n|---|---|");
    let faster = |stage| one.median_of(stage, WARM_UP) / two.median_of(stage, WARM_UP);
    for stage in STAGES {
        println!("| {} | {:.2} |", stage.name(), faster(stage));
    }
    println!("| all | {:.2} |", one.median(WARM_UP) / two.median(WARM_UP));
    println!("\nimages: {:016x} on two threads, {:016x} on one", two.hash(), one.hash());
    let error = error_of_those_photons(&settings);
    println!("the same settings at 256x256: {error:.4} RMSE of luminance in the bright spot");
    eye_pass();
}

fn report(run: &Run, bare: &Run, threads: usize) {
    println!(
        "\n512x512, one sample a pixel, radius {}, {threads} threads, medians after pass {WARM_UP}\n",
        rig::RADIUS
    );
    println!("| stage | ms a pass | share | ns a photon |\n|---|---|---|---|");
    let photons = f64::from(PHOTONS);
    let whole = run.median(WARM_UP);
    for stage in STAGES {
        let seconds = run.median_of(stage, WARM_UP);
        println!(
            "| {} | {:.1} | {:.1} % | {:.0} |",
            stage.name(),
            1e3 * seconds,
            100.0 * seconds / whole,
            1e9 * seconds / photons
        );
    }
    println!("| all | {:.1} | | {:.0} |\n", 1e3 * whole, 1e9 * whole / photons);
    let mean = |f: fn(&foton_integrator::PassReport) -> u64| run.mean(WARM_UP, f);
    let (trace, rays) = (run.median_of(Stage::Trace, WARM_UP), mean(|r| r.rays));
    let (tests, found, stored) = (mean(|r| r.candidates), mean(|r| r.accepted), mean(|r| r.stored));
    let alone = bare.median_of(Stage::Trace, WARM_UP);
    println!("- {:.3} M photons/s", photons / whole / 1e6);
    println!("- {:.2} rays a photon, {:.2} M rays/s while tracing", rays / photons, rays / trace / 1e6);
    println!(
        "- {:.2} photons stored a photon, each tested against {:.1} packets of 16",
        stored / photons,
        tests / stored
    );
    println!(
        "- {:.1} hit points accept a photon stored: {:.1} % of those tested",
        found / stored,
        100.0 * found / (16.0 * tests)
    );
    println!("- efficiency {:.0} %: tracing alone takes {:.1} ms", 100.0 * alone / whole, 1e3 * alone);
    println!("- {:.1} MiB held", run.render.bytes() as f64 / f64::from(1 << 20));
}

/// At the size for which there is a reference.
fn error_of_those_photons(settings: &RenderSettings) -> f64 {
    let run = rig::run(&rig::box_spheres(accuracy::SIDE, accuracy::SIDE), settings, 2, PASSES);
    accuracy::error(&run.render, &Reference::load_or_render())
}

fn eye_pass() {
    for (threads, samples) in [(1, 1), (2, 4)] {
        let settings = RenderSettings { samples_per_pixel: rig::number(samples), ..rig::settings() };
        let mut description = rig::box_spheres(1024, 768);
        description.sensors[0].filter = foton_scene::description::Filter::Box { radius: 0.5 };
        let runs = [0; 5].map(|_| rig::run(&description, &settings, threads, 0));
        let seconds = rig::median(runs.iter().map(|r| r.eye_seconds));
        let rays = runs[0].render.start_report().eye_rays as f64;
        println!(
            "eye pass at 1024x768, {samples} samples a pixel, {threads} threads, laying out included: {seconds:.3} s, {:.2} M rays/s",
            rays / seconds / 1e6
        );
    }
}
