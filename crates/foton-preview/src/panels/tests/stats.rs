//! What the statistics tell beside figures.

use foton_session::findings::{Finding, FindingKind, SettingNames};
use foton_session::{ClassError, ErrorEstimate};

use super::*;

#[test]
fn findings_in_the_render_are_displayed() {
    let found = |kind, text: &str| Finding { kind, place: None, text: text.into() };
    let harness = window(|state| {
        let findings = vec![
            found(FindingKind::StarvedEmitter, "\"cellar lamp\" takes 65 % of the photons"),
            found(FindingKind::PowerCutOff, "1.2 % of the emitted power was cut off"),
        ];
        state.frame.as_mut().expect("there").stats.findings = Arc::new(findings);
    });
    for text in ["\"cellar lamp\" takes", "1.2 % of the emitted power"] {
        assert!(harness.query_by_label_contains(text).is_some(), "{text}");
    }
}

#[test]
fn warnings_of_the_scene_stay_when_their_messages_are_gone() {
    let mut harness = window(|state| {
        let facts = Arc::make_mut(&mut state.frame.as_mut().expect("there").scene);
        facts.warnings =
            Arc::new(vec!["room.xml:2:2: odd".into(), "nothing in the scene emits light".into()]);
    });
    click(&mut harness, Role::DisclosureTriangle, "2 warnings in the scene");
    for text in ["room.xml:2:2: odd", "nothing in the scene emits light"] {
        assert!(harness.query_by_label(text).is_some(), "{text}");
    }
}

#[test]
fn controls_that_findings_name_are_there() {
    let harness = window(|_| ());
    let SettingNames { radius, radius_floor, eye_samples, max_depth } = SettingNames::CONTROLS;
    for (role, name) in [
        (Role::CheckBox, radius),
        (Role::SpinButton, radius_floor),
        (Role::Slider, eye_samples),
        (Role::CheckBox, max_depth),
    ] {
        assert!(harness.query_by_role_and_label(role, name).is_some(), "{name}");
    }
}

/// Errors of a render of some seconds, falling by the 2/3 law from 20 % after a second, whose upper end is twice as high.
fn converging(state: &mut State, seconds: u32) {
    for second in 1..=seconds {
        let mut frame = frame();
        let total = 0.2 * f64::from(second).powf(-1.0 / 3.0);
        frame.stats.passes = u64::from(second);
        frame.stats.elapsed = Duration::from_secs(u64::from(second));
        frame.stats.error = Some(ErrorEstimate {
            total,
            noise: 0.8 * total,
            bias: 0.6 * total,
            low: 0.9 * total,
            high: 2.0 * total,
            focus: 0.0,
            unknown_share: 0.0,
            effective_passes: 9.0,
            mean_luminance: 1.0,
            classes: Some(
                [(3.0, 1.0), (6.0, 5.0), (2.0, 2.0)]
                    .map(|(noise, bias)| ClassError { noise: noise / 100.0, bias: bias / 100.0 }),
            ),
        });
        state.show(frame);
    }
}

#[test]
fn the_time_left_knows_all_stop_rules() {
    // 2^18 photons a pass at 1.5 M photons/s; 9 s are over.
    let passes = StopRule::passes(112);
    let time = StopRule::time(Duration::from_secs(60));
    let both = StopRule { time: time.time, ..passes };
    let late = StopRule { time: time.time, ..StopRule::passes(100_000) };
    for (rule, text) in [(passes, "17 s left"), (time, "51 s left"), (both, "17 s left"), (late, "51 s left")]
    {
        let harness = window(|state| state.frame.as_mut().expect("there").stop = rule);
        assert!(harness.query_by_label(text).is_some(), "{rule:?}: {text}");
    }
    // The upper end is at 40 % t^(−1/3): at 8 % after 125 s, of which 40 are over.
    let mut harness = window(|state| converging(state, 40));
    assert!(harness.query_by_label("11 h to error 2 %").is_none());
    assert!(harness.query_by_label("16 min to error 2 %").is_some(), "no rule: the usual goal");
    harness.state_mut().frame.as_mut().expect("there").stop =
        StopRule { error: Some(0.08), ..StopRule::default() };
    settle(&mut harness);
    assert!(harness.query_by_label("85 s left").is_some());
    harness.state_mut().frame.as_mut().expect("there").activity = Activity::Paused;
    settle(&mut harness);
    assert!(harness.query_by_label_contains("left").is_none(), "nothing goes on");
}

#[test]
fn convergence_is_plotted_and_split() {
    let harness = window(|state| converging(state, 40));
    for text in [
        "Error over time: now 5.85 %, target 2.00 %",
        "90 % interval: 5.26 % – 11.7 %",
        "Noise 4.68 %, bias 3.51 %",
        "Error by light path",
        "Caustic: 7.81 %, noise 6.00 %, bias 5.00 %",
        "Time to 2 %: about 16 min",
    ] {
        assert!(harness.query_by_label(text).is_some(), "{text}");
    }
    let early = window(|_| ());
    assert!(early.query_by_label("The error is known after a few passes.").is_some());
}

#[test]
fn the_line_at_the_bottom_tells_of_the_pass_under_way_and_the_checkpoint() {
    let harness = window(|state| {
        let frame = state.frame.as_mut().expect("there");
        frame.pass_share = 0.4;
        frame.checkpoint_age = Some(Duration::from_secs(12));
    });
    for text in ["Pass 12", "Pass under way: 40 % done", "Checkpoint 12 s old"] {
        assert!(harness.query_by_label(text).is_some(), "{text}");
    }
}
