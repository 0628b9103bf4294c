//! What kernels other than the box would be worth, as the moments of the live error tell.
//!
//! With s = d²/r², the box sums Φ/(π r²) and the estimated bias is B̂ = Σ 6(s − ½) Φ/(π r²). So L − B̂/3 = Σ 2(1 − s) Φ/(π r²) is what
//! Epanechnikov's kernel makes of the same photons, and L − B̂ = Σ (4 − 6s) Φ/(π r²), which is below zero at the rim, has no bias of
//! order r² at all. Each is judged at its own best first radius.

use std::sync::Arc;

use foton_integrator::{Cancel, PpmSettings, RadiusRule, RadiusScale, RenderSettings, Variants};
use foton_scene::Scene;

use crate::truth::{self, Truth};

/// Pixels along a side.
const SIDE: u32 = 64;
const PHOTONS: u32 = 1 << 16;
const SCALES: [f64; 7] = [0.5, 0.6, 0.7, 0.85, 1.0, 1.2, 1.4];
const SHOWN: [u64; 3] = [4, 16, 64];
/// What of B̂ each kernel takes off.
const KERNELS: [f64; 3] = [0.0, 1.0 / 3.0, 1.0];

/// Prints the table.
pub(crate) fn print(named: &[&str], seeds: u64, truth_passes: u64) {
    println!(
        "| scene | passes | box % (first radius ×) | Epanechnikov % | its error over the box's | 4 − 6s % | its error over the box's |"
    );
    println!("|---|---|---|---|---|---|---|");
    for name in if named.is_empty() { crate::ASSETS.to_vec() } else { named.to_vec() } {
        rows(name, &truth::open(name, SIDE), seeds, truth_passes);
    }
}

fn rows(name: &str, scene: &Arc<Scene>, seeds: u64, truth_passes: u64) {
    // Radii that adapt go by the box's noise and bias, whatever the kernel.
    let base = RenderSettings {
        error: true,
        ppm: PpmSettings { radius_rule: RadiusRule::Local, ..crate::settings(PHOTONS, 1).ppm },
        ..crate::settings(PHOTONS, 1)
    };
    let truth = Truth::render(scene, &base, truth_passes);
    let of_scale = |scale| RenderSettings {
        ppm: PpmSettings { radius_scale: RadiusScale::new(scale).expect("above 0"), ..base.ppm },
        ..base.clone()
    };
    let all = SCALES.map(of_scale);
    let cancel = Cancel::default();
    // By shown pass, scale and kernel.
    let mut squares = [[[0.0; KERNELS.len()]; SCALES.len()]; SHOWN.len()];
    for seed in 0..seeds {
        let runs = Variants::start(scene, &all, seed + 1, &mut |_| (), &cancel);
        let mut runs = runs.expect("not cancelled").expect("they share their photons");
        for pass in 1..=SHOWN[SHOWN.len() - 1] {
            runs.advance(&mut |_| (), &cancel).expect("not cancelled");
            let Some(shown) = SHOWN.iter().position(|s| *s == pass) else { continue };
            for (render, squares) in runs.runs().iter().zip(&mut squares[shown]) {
                let (light, blur) =
                    (truth::reflected(render), render.bias().expect("the error is estimated"));
                for (square, share) in squares.iter_mut().zip(KERNELS) {
                    let image: Vec<f64> = light.iter().zip(&blur).map(|(l, b)| l - share * b).collect();
                    *square += truth.squares(&image)[0].value / seeds as f64;
                }
            }
        }
    }
    for (pass, squares) in SHOWN.iter().zip(&squares) {
        let best = |kernel: usize| {
            let of =
                |(i, of_scale): (usize, &[f64; 3])| (100.0 * of_scale[kernel].max(0.0).sqrt(), SCALES[i]);
            let all = squares.iter().enumerate().map(of);
            all.min_by(|a, b| a.0.total_cmp(&b.0)).expect("some scales")
        };
        let [flat, smooth, sharp] = [0, 1, 2].map(best);
        println!(
            "| {name} | {pass} | {:.2} (× {}) | {:.2} (× {}) | {:.2} | {:.2} (× {}) | {:.2} |",
            flat.0,
            flat.1,
            smooth.0,
            smooth.1,
            smooth.0 / flat.0,
            sharp.0,
            sharp.1,
            sharp.0 / flat.0,
        );
    }
}
