//! What the statistics tell beside figures.

use foton_session::findings::{Finding, FindingKind, SettingNames};

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
