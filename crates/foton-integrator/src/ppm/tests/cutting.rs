//! A pass that is cut short is a valid pass of fewer photons: the same as one that was planned to end there, right in its weights and
//! accounts, and followed by the same passes.

use std::num::NonZeroU32;
use std::sync::atomic::{AtomicU64, Ordering};

use foton_transport::{Cancel, Halt};

use crate::layers::LayerKind;
use crate::ppm::settings::{DirectLight, PpmSettings, RadiusRule};
use crate::ppm::{EyeSamples, Ppm};
use crate::report::PassReport;
use crate::settings::{Method, RenderSettings, SettingChange};
use crate::test_scene::scene;

/// Three batches of several chunks.
const PHOTONS: u32 = 60_000;
const MAX: u64 = 20_100;

fn start(method: Method, direct_light: DirectLight, radius_rule: RadiusRule) -> Ppm {
    let photons = NonZeroU32::new(PHOTONS).expect("above 0");
    let ppm = PpmSettings {
        photons_per_pass: photons,
        first_pass: photons,
        direct_light,
        radius_rule,
        ..PpmSettings::default()
    };
    let settings = RenderSettings {
        method,
        layers: true,
        error: true,
        samples_per_pixel: NonZeroU32::new(9).expect("above 0"),
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

/// Begins a pass and suspends it after so many questions; `false` where it is over by then.
fn suspend_after(ppm: &mut Ppm, questions: u64) -> bool {
    let asked = AtomicU64::new(0);
    let should_suspend = || asked.fetch_add(1, Ordering::Relaxed) >= questions;
    matches!(ppm.advance(&mut |_| (), &Cancel::default(), &should_suspend), Err(Halt::Suspended(_)))
}

fn state(ppm: &Ppm) -> (Vec<u8>, String) {
    let layers: Vec<_> = LayerKind::ALL.into_iter().map(|kind| ppm.layer(kind)).collect();
    (ppm.save(), format!("{layers:?}"))
}

fn cut(batches: u32) -> SettingChange {
    SettingChange::CutPass(NonZeroU32::new(batches).expect("above 0"))
}

#[test]
fn a_pass_that_is_cut_anywhere_is_one_that_was_planned_to_end_there() {
    for (method, light, rule) in [
        (Method::Ppm, DirectLight::Photons, RadiusRule::Adaptive),
        (Method::Ppm, DirectLight::ShadowRays, RadiusRule::Global),
        (Method::Sppm, DirectLight::ShadowRays, RadiusRule::Adaptive),
    ] {
        let planned: Vec<_> = (1..3)
            .map(|batches| {
                let mut ppm = start(method, light, rule);
                advance(&mut ppm);
                ppm.change(cut(batches));
                let report = advance(&mut ppm);
                assert_eq!(report.photons_in_pass, 20_000 * u64::from(batches));
                let state_after = state(&ppm);
                (state_after, advance(&mut ppm), state(&ppm))
            })
            .collect();
        let mut ends = [0; 3];
        for questions in (0..200).step_by(7) {
            let mut ppm = start(method, light, rule);
            advance(&mut ppm);
            if !suspend_after(&mut ppm, questions) {
                break;
            }
            ppm.cut_pass(questions % 2 == 0);
            advance(&mut ppm);
            let batches = match ppm.changes() {
                [] => 3,
                [(1, SettingChange::CutPass(batches))] => batches.get() as usize,
                other => panic!("{other:?}"),
            };
            ends[batches - 1] += 1;
            if let Some((after, next, after_next)) = planned.get(batches - 1) {
                assert!(state(&ppm) == *after, "{method:?}, {light:?}, after {questions}");
                assert!(advance(&mut ppm) == *next && state(&ppm) == *after_next, "the passes that follow");
            }
        }
        assert!(ends.iter().all(|n| *n > 0), "{ends:?}");
    }
}

#[test]
fn a_batch_whose_photons_are_on_their_way_is_finished_or_left_out() {
    let ends = [false, true].map(|drops| {
        let mut ppm = start(Method::Ppm, DirectLight::Photons, RadiusRule::Adaptive);
        let mut questions = 0;
        while {
            assert!(suspend_after(&mut ppm, 1));
            questions += 1;
            ppm.under_way.as_ref().expect("suspended").batch().is_some_and(|batch| batch.is_first())
        } {}
        assert!(questions > 5);
        ppm.cut_pass(drops);
        advance(&mut ppm).photons_in_pass
    });
    assert_eq!(ends, [40_000, 20_000]);
}

#[test]
fn a_pass_that_is_cut_is_as_bright_and_its_power_balances() {
    let mean = |ppm: &Ppm| ppm.image().pixels.iter().map(|p| f64::from(p.luminance())).sum::<f64>();
    for method in [Method::Ppm, Method::Sppm] {
        let [mut whole, mut parts] = [0; 2].map(|_| start(method, DirectLight::Photons, RadiusRule::Local));
        for pass in 0..8 {
            advance(&mut whole);
            parts.change(cut(1 + pass % 2));
            advance(&mut parts);
        }
        assert_eq!(parts.photons_emitted(), 4 * (20_000 + 40_000));
        let (a, b) = (mean(&whole), mean(&parts));
        assert!((b / a - 1.0).abs() < 0.01, "{a} {b}");
        assert!(parts.ledger().imbalance().abs() < 1e-6);
        let a_photon = |ppm: &Ppm| ppm.ledger().emitted / ppm.photons_emitted() as f64;
        assert!((a_photon(&parts) / a_photon(&whole) - 1.0).abs() < 1e-3);
        let [many, few] = [&whole, &parts].map(|ppm| ppm.error().expect("known").noise);
        assert!(few > many && few < 2.0 * many, "half the photons: {many} {few}");
    }
}

#[test]
fn a_pass_of_one_batch_is_not_cut() {
    let mut ppm = start(Method::Ppm, DirectLight::Photons, RadiusRule::Adaptive).with_batches_of(u64::MAX);
    assert!(suspend_after(&mut ppm, 2));
    ppm.cut_pass(true);
    assert_eq!(advance(&mut ppm).photons_in_pass, u64::from(PHOTONS));
    assert!(ppm.changes().is_empty());
}

#[test]
fn a_pass_that_is_given_up_has_not_happened() {
    for method in [Method::Ppm, Method::Sppm] {
        let mut ppm = start(method, DirectLight::Photons, RadiusRule::Adaptive);
        advance(&mut ppm);
        let before = state(&ppm);
        assert!(!ppm.discard_pass(), "there is none");
        assert!(suspend_after(&mut ppm, 12) && ppm.discard_pass());
        assert!(state(&ppm) == before);
        let mut straight = start(method, DirectLight::Photons, RadiusRule::Adaptive);
        advance(&mut straight);
        assert_eq!(advance(&mut ppm), advance(&mut straight));
        assert!(state(&ppm) == state(&straight));
    }
}

#[test]
fn a_pass_of_photons_of_its_own_is_logged_and_the_next_is_as_ever() {
    let mut ppm = start(Method::Ppm, DirectLight::Photons, RadiusRule::Adaptive);
    let once = SettingChange::PhotonsOnce(NonZeroU32::new(5_000).expect("above 0"));
    ppm.change(once);
    assert_eq!(ppm.next_batch(), 5_000);
    assert_eq!(advance(&mut ppm).photons_in_pass, 5_000);
    assert_eq!(ppm.changes(), [(0, once)]);
    assert_eq!(ppm.next_batch(), 20_000);
    assert_eq!(advance(&mut ppm).photons_in_pass, u64::from(PHOTONS));
    let mut restored = start(Method::Ppm, DirectLight::Photons, RadiusRule::Adaptive);
    restored.restore(&ppm.save()).expect("its own state");
    assert_eq!(restored.changes(), [(0, once)]);
}
