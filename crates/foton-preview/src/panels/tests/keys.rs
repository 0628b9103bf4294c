//! Keys: each does one thing, and none while someone types.

use egui::{Key, Modifiers};
use foton_edit::DragMode;
use foton_session::engine::{Gesture, SceneEdit};

use super::*;

#[test]
fn keys_do_what_the_overlay_says() {
    let mut harness = window(|state| {
        state.preferences.snapshot_folder = "/pictures".into();
        state.frame.as_mut().expect("there").selection = Some(selection());
    });
    let nudge = |x, y, mode| Command::Edit(SceneEdit::Nudge { steps: [x, y], mode });
    let plain = Modifiers::NONE;
    for (modifiers, key, command) in [
        (plain, Key::Space, Command::Pause),
        (plain, Key::Period, Command::Step),
        (plain, Key::H, Command::ResetCamera),
        (plain, Key::P, Command::Snapshot("/pictures".into())),
        (plain, Key::O, Command::ShowPhotons(true)),
        (plain, Key::V, Command::ShowPaths(true)),
        (plain, Key::Num2, Command::SetView(ViewMode::Luminance)),
        (plain, Key::Num3, Command::SetView(ViewMode::Radius)),
        (plain, Key::Num4, Command::SetView(ViewMode::PhotonCount)),
        (plain, Key::Num5, Command::SetView(ViewMode::Unknown)),
        (plain, Key::Num1, Command::SetView(ViewMode::Radiance)),
        (plain, Key::Escape, Command::Choose(None)),
        (plain, Key::ArrowLeft, nudge(-1.0, 0.0, DragMode::Horizontal)),
        (plain, Key::ArrowDown, nudge(0.0, 1.0, DragMode::Horizontal)),
        (plain, Key::PageUp, nudge(0.0, -1.0, DragMode::Vertical)),
        (Modifiers::COMMAND, Key::R, Command::Restart),
        (Modifiers::COMMAND, Key::Z, Command::Edit(SceneEdit::Undo)),
        (Modifiers::COMMAND | Modifiers::SHIFT, Key::Z, Command::Edit(SceneEdit::Redo)),
        (Modifiers::COMMAND, Key::Y, Command::Edit(SceneEdit::Redo)),
    ] {
        harness.key_press_modifiers(modifiers, key);
        let asked = asked(&mut harness);
        assert_eq!(asked, [format!("{command:?}")], "{modifiers:?} {key:?}");
    }
}

#[test]
fn flying_goes_on_while_a_key_is_held_and_ends_with_the_whole_picture() {
    let mut harness = window(|_| ());
    harness.key_down(Key::W);
    let flying = asked(&mut harness);
    let ahead = Gesture::Fly { forward: 0.03, right: 0.0, up: 0.0 };
    let expected = format!("{:?}", Command::Camera { gesture: ahead, moving: true });
    assert!(flying.len() > 1 && flying.iter().all(|a| *a == expected), "{flying:?}");
    harness.key_up(Key::W);
    harness.run_steps(60);
    let ended = asked(&mut harness);
    assert_eq!(ended.last(), Some(&format!("{:?}", Command::Moving(false))));
}

#[test]
fn a_key_that_outlasts_its_ctrl_does_not_fly() {
    let mut harness = window(|_| ());
    for key in [Key::Q, Key::D, Key::S] {
        harness.key_down_modifiers(Modifiers::COMMAND, key);
        harness.run_steps(2);
        harness.state_mut().dialog = None;
        harness.state_mut().outbox.clear();
        // Ctrl is let go first, as xdotool and many hands do, and the key repeats until it is let go too.
        harness.key_down(key);
        harness.run_steps(3);
        assert_eq!(asked(&mut harness), [""; 0], "{key:?}");
        harness.key_up(key);
        harness.run_steps(2);
        // Pressed by itself it flies, however briefly.
        harness.key_down(key);
        harness.key_up(key);
        let flown = asked(&mut harness);
        assert!(flown.iter().any(|a| a.contains("Fly")), "{key:?}: {flown:?}");
        harness.run_steps(60);
        harness.state_mut().outbox.clear();
    }
}

#[test]
fn the_overlay_opens_and_closes_by_key_and_button() {
    let mut harness = window(|_| ());
    let is_open =
        |harness: &Harness<'_, State>| harness.query_by_label_contains("orbit the camera").is_some();
    click(&mut harness, Role::Button, "Help");
    // By the pointer, which closes the menu.
    find(&harness, Role::Button, "Keys and gestures").click();
    settle(&mut harness);
    assert!(is_open(&harness));
    harness.key_press(Key::Escape);
    assert_eq!(asked(&mut harness), [""; 0], "the overlay takes the key");
    assert!(!is_open(&harness));
    harness.event(egui::Event::Text("?".into()));
    settle(&mut harness);
    assert!(is_open(&harness));
}

#[test]
fn keys_rest_while_someone_types() {
    let mut harness = window(|_| ());
    find(&harness, Role::TextInput, "Folder").focus();
    settle(&mut harness);
    for key in [Key::P, Key::Space, Key::W, Key::H] {
        harness.key_press(key);
    }
    assert_eq!(asked(&mut harness), [""; 0]);
    find(&harness, Role::TextInput, "Folder").type_text("x");
    settle(&mut harness);
    assert!(harness.state().snapshot_folder().to_string_lossy().contains('x'));
}

#[test]
fn a_dialog_opens_by_key_and_takes_the_keys() {
    let mut harness = window(|_| ());
    harness.key_press_modifiers(Modifiers::COMMAND, Key::O);
    settle(&mut harness);
    assert!(harness.state().dialog.is_some());
    harness.key_press(Key::H);
    assert_eq!(asked(&mut harness), [""; 0]);
}

/// The accessible way to click: the pointer goes there, and the button down and up.
fn click_at(harness: &mut Harness<'_, State>, at: egui::Pos2) {
    harness.hover_at(at);
    harness.run_steps(2);
    harness.drag_at(at);
    harness.run_steps(2);
    harness.drop_at(at);
    settle(harness);
}

fn canvas(harness: &Harness<'_, State>) -> egui::Rect {
    harness.state().places.iter().find(|(name, _)| *name == "canvas").expect("a canvas").1
}

#[test]
fn keys_work_after_a_click_in_the_picture() {
    let mut harness = window(|state| state.frame.as_mut().expect("there").selection = Some(selection()));
    let middle = canvas(&harness).center();
    click_at(&mut harness, middle);
    harness.state_mut().outbox.clear();
    let nudge = Command::Edit(SceneEdit::Nudge { steps: [1.0, 0.0], mode: DragMode::Horizontal });
    for (key, command) in [
        (Key::Space, Command::Pause),
        (Key::H, Command::ResetCamera),
        (Key::ArrowRight, nudge.clone()),
        (Key::ArrowRight, nudge),
        (Key::Num3, Command::SetView(ViewMode::Radius)),
        (Key::Escape, Command::Choose(None)),
    ] {
        harness.key_press(key);
        assert_eq!(asked(&mut harness), [format!("{command:?}")], "{key:?}");
    }
}

#[test]
fn escape_with_a_list_or_menu_open_closes_that_alone() {
    let mut harness = window(|state| state.frame.as_mut().expect("there").selection = Some(selection()));
    for (role, name, inside) in [
        (Role::ComboBox, "View", "Noise"),
        (Role::ComboBox, "Direct light", "Shadow rays"),
        (Role::Button, "File", "Quit"),
        (Role::Button, "Light paths", "Caustic"),
    ] {
        click(&mut harness, role, name);
        let is_open = |harness: &Harness<'_, State>| harness.query_all_by_label_contains(inside).count() > 0;
        assert!(is_open(&harness), "{name}");
        harness.key_press(Key::Escape);
        assert_eq!(asked(&mut harness), [""; 0], "{name}: nothing is deselected");
        assert!(!is_open(&harness), "{name}");
    }
    harness.key_press(Key::Escape);
    assert_eq!(asked(&mut harness), [format!("{:?}", Command::Choose(None))]);
}

#[test]
fn digits_typed_at_a_field_switch_no_view() {
    let mut harness = window(|_| ());
    // A disabled one: measures have no exposure.
    harness.state_mut().choose_view(ViewMode::Radius);
    settle(&mut harness);
    harness.state_mut().outbox.clear();
    let at = find(&harness, Role::SpinButton, "Exposure").rect().center();
    click_at(&mut harness, at);
    for key in [Key::Num4, Key::Num2, Key::P] {
        harness.key_press(key);
    }
    let asked_for: Vec<String> =
        asked(&mut harness).into_iter().filter(|a| !a.starts_with("Probe")).collect();
    assert_eq!(asked_for, [""; 0]);
    harness.key_press(Key::Escape);
    assert_eq!(asked(&mut harness), [""; 0], "it ends that");
    // One under edit.
    find(&harness, Role::SpinButton, "Photons/pass").focus();
    settle(&mut harness);
    harness.key_press(Key::Num4);
    assert_eq!(asked(&mut harness), [""; 0]);
    harness.key_press(Key::Escape);
    assert_eq!(asked(&mut harness), [""; 0], "it gives the text up");
    harness.key_press(Key::Num4);
    assert_asked(&mut harness, &Command::SetView(ViewMode::PhotonCount));
}

#[test]
fn tab_hides_the_panels_unless_a_control_has_the_focus() {
    let mut harness = window(|_| ());
    let narrow = canvas(&harness);
    harness.key_press(Key::Tab);
    settle(&mut harness);
    assert!(harness.state().hides_panels && canvas(&harness).width() > narrow.width() + 400.0);
    harness.key_press(Key::Tab);
    settle(&mut harness);
    assert_eq!(canvas(&harness), narrow);
    find(&harness, Role::Button, "Restart").focus();
    settle(&mut harness);
    harness.key_press(Key::Tab);
    settle(&mut harness);
    assert!(!harness.state().hides_panels, "the next control has the focus");
    harness.key_press(Key::Space);
    assert_ne!(asked(&mut harness), ["Pause"], "it presses the control");
}

#[test]
fn the_controls_are_reached_from_the_picture_and_left_again_by_a_key() {
    let mut harness = window(|_| ());
    harness.key_press(Key::F6);
    settle(&mut harness);
    assert!(harness.state().has_focused_control);
    harness.key_press(Key::F6);
    settle(&mut harness);
    assert!(!harness.state().has_focused_control);
    harness.key_press(Key::Space);
    assert_asked(&mut harness, &Command::Pause);
}

#[test]
fn each_press_of_undo_counts_however_many_come_in_a_frame() {
    let mut harness = window(|_| ());
    let press = |pressed| egui::Event::Key {
        key: Key::Z,
        physical_key: None,
        pressed,
        repeat: false,
        modifiers: Modifiers::COMMAND,
    };
    harness.input_mut().events.extend([press(true), press(false), press(true), press(false)]);
    harness.step();
    let undo = format!("{:?}", Command::Edit(SceneEdit::Undo));
    assert_eq!(asked(&mut harness), [undo.clone(), undo]);
}
