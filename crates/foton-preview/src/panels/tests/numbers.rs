//! Typed numbers: what was typed is what is committed, once, whatever frames arrive between the keys.

use egui::Key;
use foton_session::engine::Gesture;

use super::*;

/// Types character by character; before each one a frame arrives, whose values are others.
fn type_under_fire(harness: &mut Harness<'_, State>, label: &str, text: &str) {
    find(harness, Role::SpinButton, label).focus();
    harness.run_steps(2);
    for (i, character) in text.chars().enumerate() {
        disturb(harness, i as u32 + 1);
        harness.event(egui::Event::Text(character.into()));
        harness.step();
        disturb(harness, i as u32 + 100);
        harness.step();
    }
}

/// Another frame of the engine, in which all that fields show is different.
fn disturb(harness: &mut Harness<'_, State>, n: u32) {
    let mut frame = frame();
    frame.settings.ppm.photons_per_pass = NonZeroU32::new(1000 + n).expect("not zero");
    frame.settings.ppm.alpha = Alpha::new(0.2 + 0.001 * f64::from(n)).expect("an alpha");
    frame.stop = StopRule::passes(u64::from(600 + n));
    let mut scene = SceneFacts::clone(&frame.scene);
    scene.sensors[0].fov_degrees = 30.0 + 0.1 * f64::from(n);
    frame.scene = Arc::new(scene);
    let mut selection = selection();
    selection.inspection.fields[0].value = Value::Number(f64::from(n));
    frame.selection = Some(selection);
    harness.state_mut().show(frame);
}

fn cases() -> [(&'static str, &'static str, Command); 5] {
    let photons = NonZeroU32::new(262_144).expect("not zero");
    let set = foton_session::engine::SceneEdit::SetField {
        field: FieldId::Position(0),
        value: Value::Number(-12.5),
        done: true,
    };
    [
        ("Photons/pass", "262144", Command::Steer(SettingChange::PhotonsPerPass(photons))),
        ("α", "0.5", alpha(0.5)),
        ("Field of view", "50", Command::Camera { gesture: Gesture::FieldOfView(50.0), moving: false }),
        ("Stop after passes", "25", Command::StopAt(StopRule::passes(25))),
        ("X", "-12.5", Command::Edit(set)),
    ]
}

#[test]
fn a_number_is_committed_once_by_enter_as_it_was_typed() {
    for (label, text, command) in cases() {
        let mut harness = window(|state| state.frame.as_mut().expect("there").selection = Some(selection()));
        type_under_fire(&mut harness, label, text);
        assert_eq!(asked(&mut harness), [""; 0], "{label}: nothing is sent on the way");
        harness.key_press(Key::Enter);
        assert_eq!(asked(&mut harness), [format!("{command:?}")], "{label}");
        assert_eq!(asked(&mut harness), [""; 0], "{label}: once");
    }
}

#[test]
fn leaving_a_field_commits_it_and_escape_gives_it_up() {
    for (label, text, command) in cases() {
        let mut harness = window(|state| state.frame.as_mut().expect("there").selection = Some(selection()));
        type_under_fire(&mut harness, label, text);
        harness.key_press(Key::Tab);
        assert_eq!(asked(&mut harness), [format!("{command:?}")], "{label}");
        let mut harness = window(|state| state.frame.as_mut().expect("there").selection = Some(selection()));
        type_under_fire(&mut harness, label, text);
        harness.key_press(Key::Escape);
        assert_eq!(asked(&mut harness), [""; 0], "{label}: nothing is sent, and nothing deselected");
    }
}

#[test]
fn a_field_that_is_opened_and_left_sends_nothing() {
    let mut harness = window(|state| {
        state.frame.as_mut().expect("there").settings.ppm.alpha = Alpha::new(2.0 / 3.0).expect("an alpha");
    });
    for label in ["α", "Photons/pass", "Field of view", "Stop after passes", "Seed"] {
        find(&harness, Role::SpinButton, label).focus();
        settle(&mut harness);
        harness.key_press(Key::Enter);
        assert_eq!(asked(&mut harness), [""; 0], "{label}");
    }
}

#[test]
fn an_orthographic_camera_has_a_width_in_place_of_an_angle() {
    let mut harness = window(|state| {
        let frame = state.frame.as_mut().expect("there");
        let mut scene = SceneFacts::clone(&frame.scene);
        scene.sensors[0].width = Some(4.5);
        frame.scene = Arc::new(scene);
    });
    assert!(harness.query_by_role_and_label(Role::SpinButton, "Field of view").is_none());
    type_number(&mut harness, "Width", "6");
    assert_asked(&mut harness, &Command::Camera { gesture: Gesture::Width(6.0), moving: false });
}

#[test]
fn what_is_out_of_range_goes_to_its_end_and_what_is_no_number_is_said() {
    let half = Alpha::new(0.5).expect("an alpha");
    let mut harness = window(|state| state.frame.as_mut().expect("there").settings.ppm.alpha = half);
    type_number(&mut harness, "α", "0.45");
    assert_asked(&mut harness, &alpha(0.45));
    harness.state_mut().frame.as_mut().expect("there").settings.ppm.alpha =
        Alpha::new(0.45).expect("an alpha");
    type_number(&mut harness, "α", "7");
    assert_asked(&mut harness, &alpha(1.0));
    assert!(harness.query_by_label("The largest value is 1.").is_some());
    type_number(&mut harness, "α", "nonsense");
    assert_eq!(asked(&mut harness), [""; 0]);
    assert!(harness.query_by_label_contains("“nonsense” is not a number").is_some());
    type_number(&mut harness, "Photons/pass", "1 000 000");
    assert!(asked(&mut harness).pop().is_some_and(|a| a.contains("1000000")));
}

#[test]
fn a_committed_value_is_shown_until_frames_have_it() {
    let mut harness = window(|_| ());
    type_into(&mut harness, "Photons/pass", "12345");
    harness.key_press(Key::Enter);
    harness.run_steps(2);
    assert_eq!(harness.state().outbox.len(), 1);
    let shown = |harness: &Harness<'_, State>| {
        find(harness, Role::SpinButton, "Photons/pass").accesskit_node().value().expect("a value")
    };
    assert_eq!(shown(&harness), "12\u{a0}345");
    harness.state_mut().frame.as_mut().expect("there").settings.ppm.photons_per_pass =
        NonZeroU32::new(777).expect("not zero");
    settle(&mut harness);
    assert_eq!(shown(&harness), "777", "what the engine says");
}

#[test]
fn a_text_whose_field_goes_away_is_not_committed_when_it_comes_back() {
    let mut harness = window(|state| state.frame.as_mut().expect("there").selection = Some(selection()));
    type_into(&mut harness, "X", "77");
    harness.state_mut().frame.as_mut().expect("there").selection = None;
    assert_eq!(asked(&mut harness), [""; 0]);
    harness.state_mut().frame.as_mut().expect("there").selection = Some(selection());
    assert_eq!(asked(&mut harness), [""; 0]);
}
