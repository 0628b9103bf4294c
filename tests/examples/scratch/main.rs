use foton_film::Image;
use foton_integrator::{Cancel, EyeSamples, PpmSettings, Render, RenderSettings, Stage};
use foton_scene::Scene;
use std::num::NonZeroU32;
use std::path::Path;
use std::sync::Arc;

fn cpu() -> f64 {
    let s = std::fs::read_to_string("/proc/self/stat").unwrap();
    let f: Vec<&str> = s[s.rfind(')').unwrap() + 2..].split(' ').collect();
    (f[11].parse::<f64>().unwrap() + f[12].parse::<f64>().unwrap()) / 100.0
}

fn rmse(a: &Image, t: &Image) -> (f64, f64) {
    let mut sq: Vec<f64> = a
        .pixels
        .iter()
        .zip(&t.pixels)
        .map(|(a, t)| f64::from(a.luminance() - t.luminance()).powi(2))
        .collect();
    let mean = t.pixels.iter().map(|p| f64::from(p.luminance())).sum::<f64>() / sq.len() as f64;
    sq.sort_by(f64::total_cmp);
    let cut = sq.len() * 995 / 1000;
    let trimmed = (sq[..cut].iter().sum::<f64>() / cut as f64).sqrt() / mean;
    // what eyes see: tone-mapped difference
    let tm = |l: f32| f64::from(l / (l + mean as f32)).powf(1.0 / 2.2);
    let seen = (a
        .pixels
        .iter()
        .zip(&t.pixels)
        .map(|(a, t)| (tm(a.luminance()) - tm(t.luminance())).powi(2))
        .sum::<f64>()
        / sq.len() as f64)
        .sqrt();
    (trimmed, seen)
}

fn main() {
    let args: Vec<String> = std::env::args().collect();
    let path = args[1].clone();
    let n = |n| NonZeroU32::new(n).unwrap();
    let opened = foton_format::open(Path::new(&path), &foton_format::Options::default()).unwrap();
    let scene = Arc::new(Scene::build(&opened.description).unwrap());
    let settings =
        RenderSettings { error: false, samples_per_pixel: n(4), layers: true, ..RenderSettings::default() };
    let cancel = Cancel::default();
    let mut watch = |s: Stage| eprintln!("   {:.2} {}", cpu(), s.name());
    let c = cpu();
    let mut whole = Render::start(Arc::clone(&scene), settings.clone(), &mut watch, &cancel).unwrap();
    println!("whole start {:.2} CPU s, {:?}", cpu() - c, whole.start_report());
    let mut snaps = Vec::new();
    let mut found = 0.0;
    let passes: u64 = args[2].parse().unwrap();
    for pass in 1..=passes {
        let c = cpu();
        let r = whole.advance(&mut |_| (), &cancel).unwrap();
        found += r.accepted as f64 / whole.start_report().hit_points as f64;
        if pass <= 8 || pass.is_power_of_two() {
            snaps.push((pass, cpu() - c, r.no_photon_share, found, whole.image(), r.photons));
        }
    }
    let truth = whole.image();
    for (pass, took, share, found, image, photons) in &snaps {
        println!(
            "whole pass {pass} {photons}: {took:.2} CPU s, unlit {share:.4}, found {found:.2}, rmse {:?}",
            rmse(image, &truth)
        );
    }
    for (photons, widened) in [
        (14, 1.0),
        (14, 2.0),
        (16, 1.0),
        (16, 1.5),
        (16, 2.0),
        (17, 1.0),
        (17, 1.5),
        (17, 2.0),
        (18, 1.0),
        (18, 1.5),
        (18, 2.0),
    ] {
        let mut eye = EyeSamples::new(Arc::clone(&scene), settings.clone());
        let some = RenderSettings {
            error: false,
            ppm: PpmSettings {
                photons_per_pass: n(1 << photons),
                first_pass: n(1 << photons),
                ..settings.ppm
            },
            ..settings.clone()
        };
        let c = cpu();
        let mut r = Render::over_some((&mut eye, 1), (some, widened), &|_| (), &mut |_| (), &cancel).unwrap();
        print!("some 2^{photons} x{widened}: start {:.2}", cpu() - c);
        let mut found = 0.0;
        for _ in 0..2 {
            let c = cpu();
            let rep = r.advance(&mut |_| (), &cancel).unwrap();
            found += rep.accepted as f64 / r.start_report().hit_points as f64;
            let c = cpu() - c;
            print!(
                " | pass {c:.2} CPU s, unlit {:.4}, found {found:.2}, rmse {:?}",
                rep.no_photon_share,
                rmse(&r.image(), &truth)
            );
        }
        println!();
    }
}
