//! Where `--error` stops against the error that is there: at the same eye samples, and with antialiasing in it.

use std::num::NonZeroU32;
use std::sync::Arc;

use foton_integrator::RenderSettings;
use foton_scene::Scene;
use foton_session::StopRule;

use crate::truth::{self, Truth};

/// Pixels along a side.
const SIDE: u32 = 128;
const SCENES: [&str; 6] = ["furnace", "cornell-diffuse", "cornell-spheres", "ring", "pool", "box-spheres"];
const GOALS: [f64; 3] = [0.2, 0.15, 0.1];
const PHOTONS: u32 = 1 << 16;
const MAX_PASSES: u64 = 2000;
/// Eye samples a pixel of the image that has none of the antialiasing error.
const MANY_SAMPLES: NonZeroU32 = NonZeroU32::new(16).expect("above 0");

/// Prints the table.
pub(crate) fn print(named: &[&str], seed: u64, passes: u64) {
    println!(
        "| scene | asked % | passes | estimated % (low–high) | true % | true/asked | total with antialiasing % |"
    );
    println!("|---|---|---|---|---|---|---|");
    for name in if named.is_empty() { SCENES.to_vec() } else { named.to_vec() } {
        rows(name, &truth::open(name, SIDE), seed, passes);
    }
}

fn rows(name: &str, scene: &Arc<Scene>, seed: u64, truth_passes: u64) {
    let settings = RenderSettings { error: true, ..crate::settings(PHOTONS, seed) };
    let same_eyes = Truth::render(scene, &settings, truth_passes);
    let other = RenderSettings { samples_per_pixel: MANY_SAMPLES, seed: seed + 1000, ..settings };
    let many_eyes = Truth::render(scene, &other, truth_passes / 8);
    let mut runs = truth::start(scene, settings, seed);
    for goal in GOALS {
        let rule = StopRule { error: Some(goal), ..StopRule::default() };
        let time = std::time::Duration::ZERO;
        loop {
            let render = &runs.runs()[0];
            if rule.is_reached(render.passes(), time, time, render.error().as_ref())
                || render.passes() >= MAX_PASSES
            {
                break;
            }
            truth::advance(&mut runs);
        }
        let render = &runs.runs()[0];
        let Some(error) = render.error() else { continue };
        let real = same_eyes.error(render);
        let total = many_eyes.error(render).value;
        let never = if render.passes() >= MAX_PASSES { " (never stopped)" } else { "" };
        println!(
            "| {name} | {:.0} | {}{never} | {:.1} ({:.1}–{:.1}) | {:.1} ± {:.1} | {:.2} | {:.1} |",
            100.0 * goal,
            render.passes(),
            100.0 * error.total,
            100.0 * error.low,
            100.0 * error.high,
            100.0 * real.value,
            100.0 * real.deviation,
            real.value / goal,
            100.0 * total,
        );
    }
}
