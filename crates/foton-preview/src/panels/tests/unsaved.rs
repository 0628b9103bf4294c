//! What is asked before unsaved edits go.

use std::path::PathBuf;

use super::*;
use crate::state::Leaving;
use crate::turns::first_turn;

fn edited() -> Harness<'static, State> {
    window(|state| {
        let frame = state.frame.as_mut().expect("there");
        let mut scene = SceneFacts::clone(&frame.scene);
        (scene.is_edited, scene.is_unsaved) = (true, true);
        frame.scene = Arc::new(scene);
    })
}

fn is_asked(harness: &Harness<'_, State>) -> bool {
    harness.query_by_label("Save the edited scene?").is_some()
}

fn opened(harness: &mut Harness<'_, State>) -> bool {
    asked(harness).iter().any(|a| a.contains("Open(File(\"/scenes/other.xml\"))"))
}

#[test]
fn a_scene_without_edits_is_left_at_once() {
    let mut harness = window(|_| ());
    harness.state_mut().open("/scenes/other.xml".into());
    assert!(!is_asked(&harness) && opened(&mut harness));
    harness.state_mut().leave(Leaving::Close);
    assert!(harness.state().wants_to_close);
}

#[test]
fn opening_another_scene_asks_first_and_can_be_called_off_or_done() {
    let mut harness = edited();
    let open = |harness: &mut Harness<'_, State>| {
        harness.state_mut().open("/scenes/other.xml".into());
        settle(harness);
        assert!(is_asked(harness) && !opened(harness));
    };
    open(&mut harness);
    click(&mut harness, Role::Button, "Cancel");
    assert!(!is_asked(&harness) && !opened(&mut harness));
    open(&mut harness);
    harness.key_press(egui::Key::Escape);
    settle(&mut harness);
    assert!(!is_asked(&harness) && !opened(&mut harness));
    open(&mut harness);
    click(&mut harness, Role::Button, "Discard");
    assert!(!is_asked(&harness) && opened(&mut harness));
}

#[test]
fn what_is_to_be_saved_is_saved_before_the_window_closes() {
    let mut harness = edited();
    harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::Q);
    settle(&mut harness);
    assert!(is_asked(&harness) && !harness.state().wants_to_close);
    click(&mut harness, Role::Button, "Save…");
    assert!(harness.state().dialog.is_some() && !harness.state().wants_to_close);
    // What could not be written is not left.
    harness.state_mut().hear(Event::Failed("no room".into()));
    harness.state_mut().hear(Event::SceneSaved(PathBuf::from("/scenes/edited.xml")));
    assert!(!harness.state().wants_to_close);
    harness.state_mut().dialog = None;
    harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::Q);
    settle(&mut harness);
    click(&mut harness, Role::Button, "Save…");
    harness.state_mut().hear(Event::SceneSaved(PathBuf::from("/scenes/edited.xml")));
    assert!(harness.state().wants_to_close);
}

#[test]
fn the_window_is_called_after_the_scene() {
    let mut harness = edited();
    assert_eq!(harness.state().title(), "room.xml (edited) – foton");
    harness.state_mut().frame = None;
    assert_eq!(harness.state().title(), "foton");
}

#[test]
fn keys_that_come_in_one_frame_do_what_they_do_one_by_one() {
    let mut harness = edited();
    let pressed = |key: egui::Key, modifiers| egui::Event::Key {
        key,
        physical_key: None,
        pressed: true,
        repeat: false,
        modifiers,
    };
    let undo = pressed(egui::Key::Z, egui::Modifiers::COMMAND);
    let mut waiting = vec![
        pressed(egui::Key::Q, egui::Modifiers::COMMAND),
        pressed(egui::Key::Escape, egui::Modifiers::NONE),
        undo.clone(),
        undo,
    ];
    while !waiting.is_empty() {
        harness.input_mut().events = first_turn(&mut waiting);
        harness.step();
    }
    assert!(!is_asked(&harness), "Esc was for the question");
    let undone = asked(&mut harness).iter().filter(|a| a.contains("Undo")).count();
    assert_eq!(undone, 2, "and what came after it for the scene");
}
