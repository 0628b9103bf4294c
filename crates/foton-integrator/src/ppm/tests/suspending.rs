//! A pass that is suspended, anywhere and any number of times, is the same pass; settings that change meanwhile wait for the next.

use std::num::NonZeroU32;
use std::sync::atomic::{AtomicU64, Ordering};

use foton_transport::{Cancel, Halt, Stage};

use crate::layers::LayerKind;
use crate::ppm::settings::{Alpha, DirectLight, PpmSettings};
use crate::ppm::{EyeSamples, Ppm};
use crate::report::PassReport;
use crate::settings::{Method, RenderSettings, SettingChange};
use crate::test_scene::scene;

/// Three batches of several chunks.
const PHOTONS: u32 = 60_000;
const MAX: u64 = 20_100;

/// Both methods have the same passes.
const METHODS: [Method; 2] = [Method::Ppm, Method::Sppm];

fn start(method: Method, direct_light: DirectLight) -> Ppm {
    let photons = NonZeroU32::new(PHOTONS).expect("above 0");
    let ppm = PpmSettings {
        photons_per_pass: photons,
        first_pass: photons,
        direct_light,
        ..PpmSettings::default()
    };
    // As many hit points as make several blocks.
    let samples = NonZeroU32::new(9).expect("above 0");
    let settings = RenderSettings {
        method,
        layers: true,
        error: true,
        samples_per_pixel: samples,
        ppm,
        ..RenderSettings::default()
    };
    let ppm = Ppm::start(EyeSamples::new(scene(), settings), &|_| (), &mut |_| (), &Cancel::default())
        .expect("not cancelled");
    ppm.with_batches_of(MAX)
}

fn advance(ppm: &mut Ppm) -> PassReport {
    ppm.advance(&mut |_| (), &Cancel::default(), &|| false).expect("neither cancelled nor suspended")
}

/// A pass that is suspended each time it has been asked `every` times; how often that was, and what was next each time.
fn advance_by(ppm: &mut Ppm, every: u64, between: &mut dyn FnMut(&mut Ppm)) -> (PassReport, Vec<Stage>) {
    let mut stages = Vec::new();
    loop {
        let asked = AtomicU64::new(0);
        let mut last = Stage::EyePass;
        let mut watch = |stage| last = stage;
        let should_suspend = || asked.fetch_add(1, Ordering::Relaxed) >= every;
        match ppm.advance(&mut watch, &Cancel::default(), &should_suspend) {
            Ok(report) => return (report, stages),
            Err(Halt::Suspended(_)) => {
                stages.push(last);
                between(ppm);
            }
            Err(other) => panic!("{other}"),
        }
    }
}

fn state(ppm: &Ppm) -> (Vec<u8>, String) {
    let layers: Vec<_> = LayerKind::ALL.into_iter().map(|kind| ppm.layer(kind)).collect();
    (ppm.save(), format!("{layers:?}"))
}

#[test]
fn a_pass_that_is_suspended_again_and_again_is_the_same_pass() {
    let lights = [DirectLight::Photons, DirectLight::ShadowRays];
    for (method, direct_light) in METHODS.into_iter().flat_map(|method| lights.map(|light| (method, light))) {
        let mut straight = start(method, direct_light);
        let reports = [advance(&mut straight), advance(&mut straight)];
        for every in [1, 2, 7] {
            let mut halting = start(method, direct_light);
            for (pass, report) in reports.iter().enumerate() {
                let mut shares = vec![0.0];
                let (after, stages) =
                    advance_by(&mut halting, every, &mut |ppm| shares.push(ppm.pass_share()));
                assert_eq!(after, *report);
                assert!(shares.is_sorted() && shares.iter().all(|s| (0.0..=1.0).contains(s)), "{shares:?}");
                let (is_stochastic, is_often) = (method == Method::Sppm, every < 4);
                let mut wanted = vec![Stage::Trace, Stage::Gather];
                let by_rays = direct_light == DirectLight::ShadowRays && (is_often || !is_stochastic);
                wanted.extend(by_rays.then_some(Stage::ShadowRays));
                // The start has followed the samples of the first pass.
                wanted.extend((is_stochastic && is_often && pass > 0).then_some(Stage::EyePass));
                assert!(wanted.iter().all(|stage| stages.contains(stage)), "{every}: {stages:?}");
            }
            assert!(state(&halting) == state(&straight), "{method:?}, {direct_light:?}, every {every}");
        }
    }
}

#[test]
fn until_hit_points_are_refined_a_suspended_pass_has_changed_nothing() {
    for method in METHODS {
        let mut ppm = start(method, DirectLight::ShadowRays);
        advance(&mut ppm);
        let before = state(&ppm);
        let (mut unchanged, mut refined) = (0, 0);
        let image = ppm.image();
        advance_by(&mut ppm, 1, &mut |ppm| {
            assert!(ppm.image() == image, "the image is that of whole passes");
            if ppm.has_refined() {
                refined += 1;
            } else {
                assert!(state(ppm) == before);
                unchanged += 1;
            }
        });
        assert!(unchanged > 10, "{unchanged}");
        // Pixels keep what hit points of a single pass have found only once it is whole.
        assert!(if method == Method::Sppm { refined == 0 } else { refined > 2 }, "{refined}");
        assert!(!ppm.has_refined() && ppm.pass_share() == 0.0);
    }
}

#[test]
fn a_change_during_a_pass_takes_effect_with_the_next() {
    let alpha = SettingChange::Alpha(Alpha::new(0.4).expect("in range"));
    let photons = SettingChange::PhotonsPerPass(NonZeroU32::new(9_000).expect("above 0"));
    METHODS.into_iter().for_each(|method| {
        let mut straight = start(method, DirectLight::Photons);
        advance(&mut straight);
        [alpha, photons].into_iter().for_each(|change| straight.change(change));
        advance(&mut straight);

        let mut halting = start(method, DirectLight::Photons);
        let mut halts = 0;
        advance_by(&mut halting, 3, &mut |ppm| {
            halts += 1;
            if halts == 2 {
                [alpha, photons].into_iter().for_each(|change| ppm.change(change));
                assert!(ppm.changes().is_empty(), "not before the pass is whole");
            }
        });
        assert_eq!(halting.changes(), [(1, alpha), (1, photons)]);
        advance(&mut halting);
        assert!(state(&halting) == state(&straight));
    });
}

#[test]
fn a_suspended_pass_that_is_then_cancelled_or_discarded_has_not_happened() {
    let change = SettingChange::Alpha(Alpha::new(0.4).expect("in range"));
    for (method, after) in [(Method::Ppm, 0), (Method::Sppm, 0), (Method::Sppm, 1), (Method::Sppm, 20)] {
        for discards in [false, true] {
            let mut ppm = start(method, DirectLight::Photons);
            let mut straight = start(method, DirectLight::Photons);
            // The second pass of the stochastic method has samples to follow first.
            let passes = u32::from(method == Method::Sppm);
            (0..passes).for_each(|_| _ = (advance(&mut ppm), advance(&mut straight)));
            let asked = AtomicU64::new(0);
            let should_suspend = || asked.fetch_add(1, Ordering::Relaxed) >= after;
            let suspended = ppm.advance(&mut |_| (), &Cancel::default(), &should_suspend);
            assert!(matches!(suspended, Err(Halt::Suspended(_))));
            ppm.change(change);
            if discards {
                assert!(ppm.discard_pass());
            } else {
                let cancel = Cancel::default();
                cancel.request();
                let cancelled = ppm.advance(&mut |_| (), &cancel, &|| false);
                assert!(matches!(cancelled, Err(Halt::Cancelled(_))), "{cancelled:?}");
            }
            straight.change(change);
            advance(&mut ppm);
            advance(&mut straight);
            assert!(state(&ppm) == state(&straight), "{method:?} after {after}, {discards}");
        }
    }
}
