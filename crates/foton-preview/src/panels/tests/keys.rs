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
fn the_overlay_opens_and_closes_by_key_and_button() {
    let mut harness = window(|_| ());
    let is_open = |harness: &Harness<'_, State>| harness.query_by_label_contains("turn the camera").is_some();
    click(&mut harness, Role::Button, "?");
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
