//! One render for many minutes: memory stays flat, the running mean stays the mean of its passes, nothing becomes NaN.
//!
//! `cargo xtask soak [MINUTES]` runs it on one thread in the dev build, with debug assertions, and docs/robustness.md records what it printed. The image is
//! small, so that there are many passes. What sums hold is read from the render's state: double precision, 36 bytes a pixel.
#![allow(clippy::print_stdout, reason = "a program that prints figures")]

use std::num::NonZeroU32;
use std::process::ExitCode;
use std::sync::Arc;
use std::time::{Duration, Instant};

use foton_integrator::{Cancel, PpmSettings, Render, RenderSettings};
use foton_math::Rgb;
use foton_math::glam::DVec3;
use foton_scene::Scene;
use foton_tests::{Sketch, glass, grey};

/// Side of the image in pixels.
const SIDE: u32 = 16;
const PHOTONS: u32 = 1000;
/// How far the running mean may be from that summed with Kahan's compensation, as a share of it.
const MAX_DRIFT: f64 = 1e-9;
/// How much more memory the last quarter of the time may have taken than the second: the system's allocator rounds.
const MAX_GROWTH: u64 = 1 << 20;
/// Bytes of a pixel in a state: three sums in double precision, then the last pass's three addends in single precision.
const PIXEL: usize = 36;

/// A compensated sum: it adds what rounding loses.
#[derive(Clone, Copy, Default)]
struct Kahan {
    sum: f64,
    lost: f64,
}

impl Kahan {
    fn add(&mut self, term: f64) {
        let term = term - self.lost;
        let sum = self.sum + term;
        self.lost = (sum - self.sum) - term;
        self.sum = sum;
    }
}

/// Where in a state the pixels lie: before a flag and what the error appends, which grows once the error is known.
struct Layout {
    without_error: usize,
}

impl Layout {
    fn of(scene: &Arc<Scene>) -> Self {
        Self { without_error: start(scene, false).save().len() }
    }

    /// Each pixel's sum and last addend, channel by channel.
    fn pixels<'a>(&self, state: &'a [u8]) -> impl Iterator<Item = (f64, f32)> + use<'a> {
        let end = self.without_error - 8;
        assert!(state.len() >= self.without_error, "no state");
        let pixels = &state[end - PIXEL * (SIDE * SIDE) as usize..end];
        pixels.chunks_exact(PIXEL).flat_map(|pixel| {
            (0..3).map(|c| {
                let sum = pixel[8 * c..][..8].try_into().expect("eight bytes");
                let last = pixel[24 + 4 * c..][..4].try_into().expect("four bytes");
                (f64::from_le_bytes(sum), f32::from_le_bytes(last))
            })
        })
    }
}

fn scene() -> Arc<Scene> {
    Sketch::default()
        .camera(DVec3::new(0.0, 0.0, 0.95), DVec3::new(0.0, -0.2, -1.0), 70.0, SIDE)
        .room(grey(0.6), None)
        .sphere(DVec3::new(0.4, -0.6, 0.0), 0.35, glass(1.5), None)
        .sphere(DVec3::new(0.0, 0.8, 0.0), 0.1, grey(0.0), Some(Rgb::new(40.0, 30.0, 20.0)))
        .build()
        .expect("a sound scene")
}

fn start(scene: &Arc<Scene>, error: bool) -> Render {
    let photons = NonZeroU32::new(PHOTONS).expect("above 0");
    let settings = RenderSettings {
        error,
        ppm: PpmSettings { photons_per_pass: photons, first_pass: photons, ..PpmSettings::default() },
        ..RenderSettings::default()
    };
    Render::start(Arc::clone(scene), settings, &mut |_| (), &Cancel::default()).expect("not cancelled")
}

/// Bytes in memory; 0 where the system does not say.
fn resident() -> u64 {
    let pages = std::fs::read_to_string("/proc/self/statm").ok();
    let pages = pages.and_then(|s| s.split(' ').nth(1)?.parse::<u64>().ok());
    pages.unwrap_or(0) * 4096
}

fn main() -> ExitCode {
    let minutes: f64 = std::env::args().nth(1).and_then(|m| m.parse().ok()).unwrap_or(20.0);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    if pool.install(|| soak(Duration::from_secs_f64(60.0 * minutes))) {
        ExitCode::SUCCESS
    } else {
        println!("a bound was broken");
        ExitCode::FAILURE
    }
}

/// Whether all bounds held.
fn soak(time: Duration) -> bool {
    let scene = scene();
    let layout = Layout::of(&scene);
    let mut render = start(&scene, true);
    let mut reference = vec![Kahan::default(); 3 * (SIDE * SIDE) as usize];
    let mut quarters = [0u64; 4];
    let mut drift = 0f64;
    let mut finite = true;
    let begin = Instant::now();
    let mut told = Duration::ZERO;
    loop {
        render.advance(&mut |_| (), &Cancel::default()).expect("not cancelled");
        let state = render.save();
        for (reference, (_, last)) in reference.iter_mut().zip(layout.pixels(&state)) {
            reference.add(f64::from(last));
        }
        let elapsed = begin.elapsed();
        let over = elapsed >= time;
        if elapsed - told >= time / 40 || over {
            told = elapsed;
            for (reference, (sum, _)) in reference.iter().zip(layout.pixels(&state)) {
                drift = drift.max((sum - reference.sum).abs() / reference.sum.max(f64::MIN_POSITIVE));
            }
            finite &= render.image().pixels.iter().all(|p| p.is_finite() && p.g >= 0.0);
            finite &= render.radii().smallest > 0.0 && render.ledger().imbalance().abs() < 1e-6;
            let quarter = (4.0 * elapsed.as_secs_f64() / time.as_secs_f64()) as usize;
            let quarter = &mut quarters[quarter.min(3)];
            *quarter = resident().max(*quarter);
            println!(
                "{:6.1} min: {} passes, {:.2e} photons, drift {drift:.1e}, median radius {:.2e}, ledger off by {:.1e}, {} KiB",
                elapsed.as_secs_f64() / 60.0,
                render.passes(),
                render.photons_emitted() as f64,
                render.radii().median,
                render.ledger().imbalance(),
                resident() >> 10
            );
        }
        if over {
            break;
        }
    }
    println!(
        "memory in the quarters of the time: {:?} KiB; all numbers finite: {finite}",
        quarters.map(|q| q >> 10)
    );
    finite && drift <= MAX_DRIFT && quarters[3] <= quarters[1] + MAX_GROWTH
}
