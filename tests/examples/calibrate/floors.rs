//! What the smallest radius costs and saves: against the truth of the same eye samples, whose narrow light a large disc smears,
//! and against that of many eye samples, whose light falls between those of a small one.

use std::num::NonZeroU32;

use foton_integrator::{Cancel, PpmSettings, RadiusFloor, RenderSettings, Variants};

use crate::truth::{self, Truth};

/// Pixels along a side.
const SIDE: u32 = 128;
/// Spacings of the eye samples.
const FLOORS: [f64; 6] = [0.0, 0.5, 0.75, 1.0, 1.25, 1.5];
const CHECKPOINTS: [u64; 3] = [16, 64, 256];
const MANY_SAMPLES: NonZeroU32 = NonZeroU32::new(16).expect("above 0");

/// Prints the table: error at the same eye samples, and with antialiasing, in % of the mean light.
pub(crate) fn print(named: &[&str], samples: u64, passes: u64) {
    let heads = FLOORS.map(|floor| format!(" {floor} |")).concat();
    println!("| scene | passes |{heads}\n|---|---|{}", "---|".repeat(FLOORS.len()));
    let samples = NonZeroU32::new(samples as u32).expect("above 0");
    for name in if named.is_empty() { crate::ASSETS.to_vec() } else { named.to_vec() } {
        let scene = truth::open(name, SIDE);
        let base = RenderSettings { samples_per_pixel: samples, ..crate::settings(crate::PHOTONS, 1) };
        let same_eyes = Truth::render(&scene, &base, passes);
        let other = RenderSettings { samples_per_pixel: MANY_SAMPLES, seed: 1001, ..base.clone() };
        let many_eyes = Truth::render(&scene, &other, passes / 4);
        let settings = FLOORS.map(|floor| RenderSettings {
            ppm: PpmSettings { radius_floor: RadiusFloor::new(floor).expect("not below 0"), ..base.ppm },
            ..base.clone()
        });
        let started = Variants::start(&scene, &settings, base.seed, &mut |_| (), &Cancel::default());
        let mut runs = started.expect("not cancelled").expect("variants");
        for pass in 1..=CHECKPOINTS[CHECKPOINTS.len() - 1] {
            truth::advance(&mut runs);
            if CHECKPOINTS.contains(&pass) {
                let cells: Vec<String> = runs
                    .runs()
                    .iter()
                    .map(|render| {
                        let [same, many] = [&same_eyes, &many_eyes].map(|t| 100.0 * t.error(render).value);
                        format!(" {same:.1}, {many:.1} |")
                    })
                    .collect();
                println!("| {name} | {pass} |{}", cells.concat());
            }
        }
    }
}
