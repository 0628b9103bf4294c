//! A pass in batches is the same pass: counts and radii bit by bit where radii go by counts, light (and radii that go by that) to
//! rounding, and the same bits on any number of threads.

use std::num::NonZeroU32;
use std::sync::atomic::{AtomicU32, Ordering};

use foton_film::LayerData;
use foton_math::Rgb;
use foton_transport::{Cancel, Stage};

use crate::layers::LayerKind;
use crate::ppm::settings::{DirectLight, PpmSettings, RadiusRule};
use crate::ppm::{EyeSamples, Ppm};
use crate::report::PassReport;
use crate::settings::{Method, RenderSettings};
use crate::test_scene::scene;

const PHOTONS: u32 = 30_000;
/// Three batches, and not equal ones.
const MAX: u64 = 10_100;

fn settings() -> RenderSettings {
    let photons = NonZeroU32::new(PHOTONS).expect("above 0");
    RenderSettings {
        layers: true,
        error: true,
        ppm: PpmSettings { photons_per_pass: photons, first_pass: photons, ..PpmSettings::default() },
        ..RenderSettings::default()
    }
}

fn start(settings: RenderSettings, max_in_batch: u64) -> Ppm {
    Ppm::start(EyeSamples::new(scene(), settings), &|_| (), &mut |_| (), &Cancel::default())
        .expect("not cancelled")
        .with_batches_of(max_in_batch)
}

fn advance(ppm: &mut Ppm) -> PassReport {
    ppm.advance(&mut |_| (), &Cancel::default(), &|| false).expect("not cancelled")
}

/// Everything that passes have changed, and all layers.
fn state(ppm: &Ppm) -> (Vec<u8>, String) {
    let layers: Vec<_> = LayerKind::ALL.into_iter().map(|kind| ppm.layer(kind)).collect();
    (ppm.save(), format!("{layers:?}"))
}

#[test]
fn a_pass_in_batches_is_the_pass_at_once() {
    let local = || RenderSettings {
        ppm: PpmSettings { radius_rule: RadiusRule::Local, ..settings().ppm },
        ..settings()
    };
    let (mut whole, mut parts) = (start(local(), u64::MAX), start(local(), MAX));
    for _ in 0..4 {
        let (at_once, in_parts) = (advance(&mut whole), advance(&mut parts));
        assert_eq!(at_once, in_parts, "counted by the pass, not by the batch");
    }
    let colour = |ppm: &Ppm, kind| match ppm.layer(kind).expect("summed").channels {
        LayerData::Rgb(image) => image.pixels,
        _ => panic!("{kind:?} is colour"),
    };
    // Hundreds of photons are summed in single precision, in two orders.
    let off = |p: &[Rgb], q: &[Rgb]| {
        let pairs = p.iter().zip(q).flat_map(|(p, q)| p.to_array().into_iter().zip(q.to_array()));
        pairs.map(|(p, q)| (p - q).abs() / p.max(1e-6)).fold(0.0, f32::max)
    };
    let error = off(&whole.image().pixels, &parts.image().pixels);
    assert!(error <= 3e-6, "{error}");
    for kind in [LayerKind::Direct, LayerKind::Caustic, LayerKind::Indirect] {
        let error = off(&colour(&whole, kind), &colour(&parts, kind));
        assert!(error <= 1e-5, "{kind:?}: {error}");
    }
    for kind in [LayerKind::Radius, LayerKind::PhotonCount, LayerKind::Emission, LayerKind::ShapeId] {
        assert_eq!(whole.layer(kind), parts.layer(kind), "{kind:?}");
    }
    assert_eq!(whole.light_use(), parts.light_use());
    let (a, b) = (whole.error().expect("known"), parts.error().expect("known"));
    assert!((a.noise / b.noise - 1.0).abs() < 1e-4 && (a.bias / b.bias - 1.0).abs() < 1e-3, "{a:?} {b:?}");
    assert!((whole.ledger().absorbed / parts.ledger().absorbed - 1.0).abs() < 1e-12);
    assert_eq!(whole.ledger().imbalance().abs() < 1e-6, parts.ledger().imbalance().abs() < 1e-6);
}

#[test]
fn radii_that_adapt_do_so_by_all_batches_of_a_pass() {
    let (mut whole, mut parts) = (start(settings(), u64::MAX), start(settings(), MAX));
    let mut radii = || {
        advance(&mut whole);
        advance(&mut parts);
        [&whole, &parts].map(|ppm| match ppm.layer(LayerKind::Radius).expect("known").channels {
            LayerData::F32(plane) => plane.values,
            _ => panic!("radii are numbers"),
        })
    };
    for _ in 0..2 {
        let [at_once, in_parts] = radii();
        for (a, b) in at_once.iter().zip(&in_parts) {
            assert!((a / b - 1.0).abs() < 1e-3, "{a} {b}");
        }
    }
}

#[test]
fn batches_give_the_same_bits_on_any_number_of_threads() {
    for (method, direct_light) in [
        (Method::Ppm, DirectLight::Photons),
        (Method::Ppm, DirectLight::ShadowRays),
        (Method::Sppm, DirectLight::ShadowRays),
    ] {
        let run = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            pool.install(|| {
                let mut ppm = start(
                    RenderSettings {
                        method,
                        ppm: PpmSettings { direct_light, ..settings().ppm },
                        ..settings()
                    },
                    MAX,
                );
                for _ in 0..3 {
                    advance(&mut ppm);
                }
                state(&ppm)
            })
        };
        let one = run(1);
        assert!(one == run(2) && one == run(7), "{method:?}, {direct_light:?}");
    }
}

#[test]
fn a_pass_that_is_cancelled_between_its_batches_has_not_happened() {
    for method in [Method::Ppm, Method::Sppm] {
        let settings = RenderSettings { method, ..settings() };
        let mut ppm = start(settings.clone(), MAX);
        advance(&mut ppm);
        let before = state(&ppm);
        let cancel = Cancel::default();
        let mut traced = 0;
        let mut watch = |stage| {
            traced += u32::from(stage == Stage::Trace);
            if traced == 3 {
                cancel.request();
            }
        };
        assert!(ppm.advance(&mut watch, &cancel, &|| false).is_err());
        assert!(traced == 3 && before == state(&ppm));
        advance(&mut ppm);
        let mut straight = start(settings, MAX);
        for _ in 0..2 {
            advance(&mut straight);
        }
        assert!(state(&ppm) == state(&straight));
    }
}

/// The eye pass, laying hit points out and marking cells.
#[test]
fn a_start_that_is_cancelled_ends_in_that_wherever_it_comes() {
    let (mut questions, mut cancelled, mut stages) = (0, 0, Vec::new());
    loop {
        let mut last = None;
        let mut watch = |stage| last = Some(stage);
        let started =
            Ppm::start(EyeSamples::new(scene(), settings()), &|_| (), &mut watch, &Cancel::after(questions));
        stages.extend(last);
        if started.is_ok() {
            break;
        }
        cancelled += 1;
        // In steps that the shorter stage is not missed by.
        questions += if last == Some(Stage::Layout) { 20 } else { 1 + questions / 64 };
    }
    assert!(
        cancelled > 40 && stages.contains(&Stage::EyePass) && stages.contains(&Stage::Layout),
        "{cancelled}"
    );
    let in_layout = stages.iter().filter(|&&stage| stage == Stage::Layout).count();
    assert!(in_layout > 5, "{in_layout}");
}

#[test]
fn a_batch_that_is_shown_stands_for_its_pass() {
    // Photons as dots: those of the last batch come from everywhere, and are as bright in all as those of a pass.
    let shown = |max_in_batch| {
        let mut ppm = start(settings(), max_in_batch);
        advance(&mut ppm);
        let photons = ppm.stored_photons(usize::MAX);
        (photons.len() as f64, photons.iter().map(|p| f64::from(p.power.g)).sum::<f64>())
    };
    let ((all, watts), (some, as_bright)) = (shown(u64::MAX), shown(MAX));
    assert!((some / all * 3.0 - 1.0).abs() < 0.05, "a third: {some} of {all}");
    assert!((as_bright / watts - 1.0).abs() < 0.05, "{as_bright} {watts}");
}

#[test]
fn memory_does_not_grow_with_photons_beyond_a_batch() {
    let bytes = |photons: u32| {
        let photons = NonZeroU32::new(photons).expect("above 0");
        let settings = RenderSettings {
            ppm: PpmSettings { photons_per_pass: photons, first_pass: photons, ..settings().ppm },
            ..settings()
        };
        let mut ppm = start(settings, 16_384);
        advance(&mut ppm);
        ppm.bytes() as f64
    };
    let (two, eight) = (bytes(32_768), bytes(131_072));
    assert!(eight < 1.05 * two, "{two} {eight}");
}

#[test]
fn batches_end_when_passes_are_small_again() {
    let mut ppm = start(settings(), MAX);
    let (traced, mut between) = (AtomicU32::new(0), 0);
    let mut watch = |stage| {
        traced.fetch_add(u32::from(stage == Stage::Trace), Ordering::Relaxed);
    };
    // In the second batch, as long as it has not been gone on with.
    while ppm.advance(&mut watch, &Cancel::default(), &|| traced.load(Ordering::Relaxed) == 2).is_err() {
        between = between.max(ppm.light.bytes_between_batches());
    }
    assert!(between > 0, "the second batch begins with what the first has left");
    assert_eq!(ppm.light.bytes_between_batches(), 0, "what one batch needs is no more than before");
}
