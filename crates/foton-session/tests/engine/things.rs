//! Things that come, go and have other names; what is selected by its name.

use foton_edit::{Handle, Make, NewThing, Side, Target, ViewSide};
use foton_session::engine::{Activity, Command, Configuration, Frame, Gesture, SceneEdit};

use crate::rig::{BALL, Rig, image};

fn edit(rig: &Rig, change: SceneEdit) {
    rig.send(Command::Edit(change));
}

fn names(frame: &Frame) -> Vec<&str> {
    frame.scene.contents.iter().map(|item| item.name.as_str()).collect()
}

fn selected(frame: &Frame) -> Option<&str> {
    frame.selection.as_ref().map(|s| s.inspection.title.as_str())
}

/// The frame in which these things are there and all is rendered.
#[track_caller]
fn with(rig: &Rig, expected: &[&str]) -> Frame {
    rig.until("the things", |f| names(f) == expected && f.activity == Activity::Done)
}

#[test]
fn things_are_added_copied_hidden_and_deleted_and_each_is_one_step() {
    let (rig, before) = Rig::at_pass(1);
    assert_eq!(names(&before), ["floor", "ball", "bulb", "camera"]);
    edit(&rig, SceneEdit::Add(NewThing::Cube));
    let added = with(&rig, &["floor", "ball", "cube", "bulb", "camera"]);
    assert_eq!(selected(&added), Some("cube"));
    assert_ne!(image(&added), image(&before));
    edit(&rig, SceneEdit::Duplicate(Target::Shape(2)));
    let copied = with(&rig, &["floor", "ball", "cube", "cube-2", "bulb", "camera"]);
    assert_eq!(selected(&copied), Some("cube-2"));
    edit(&rig, SceneEdit::Delete(Target::Shape(2)));
    let deleted = with(&rig, &["floor", "ball", "cube-2", "bulb", "camera"]);
    assert_eq!(selected(&deleted), Some("cube-2"), "the same, at another place in the list");
    edit(&rig, SceneEdit::Delete(Target::Shape(2)));
    let gone = with(&rig, &["floor", "ball", "bulb", "camera"]);
    assert_eq!((selected(&gone), image(&gone)), (None, image(&before)));
    edit(&rig, SceneEdit::Hide { target: Target::Shape(1), hide: true });
    let hidden = rig.until("it hidden", |f| {
        f.scene.contents.iter().any(|i| i.is_hidden && i.name == "ball") && f.activity == Activity::Done
    });
    assert_ne!(image(&hidden), image(&before));
    for _ in 0..5 {
        edit(&rig, SceneEdit::Undo);
    }
    let undone = rig.until("all of it back", |f| f.scene.undo.is_none() && f.activity == Activity::Done);
    assert_eq!((names(&undone), image(&undone)), (names(&before), image(&before)));
    assert!(!undone.scene.is_unsaved);
}

#[test]
fn a_scene_may_lose_its_last_light_and_says_what_it_lacks() {
    let (rig, _) = Rig::at_pass(1);
    edit(&rig, SceneEdit::Delete(Target::Emitter(0)));
    let dark = with(&rig, &["floor", "ball", "camera"]);
    assert!(image(&dark).pixels.iter().all(|c| c.luminance() == 0.0));
    let said = |text: &str| dark.stats.findings.iter().any(|f| f.text.contains(text));
    assert!(said("nothing in the scene emits light"), "{:?}", dark.stats.findings);
    edit(&rig, SceneEdit::Delete(Target::Sensor(0)));
    assert!(rig.failure().contains("last one"));
}

#[test]
fn names_and_materials_are_changed_for_what_is_selected() {
    let (rig, _) = Rig::at_pass(1);
    rig.send(Command::Select(Some(Target::Shape(1))));
    let chosen = rig.until("a selection", |f| f.selection.is_some());
    assert!(chosen.selection.as_ref().is_some_and(|s| s.gizmo.is_some() && !s.outline.is_empty()));
    edit(&rig, SceneEdit::Rename { target: Target::Shape(1), name: "pearl".into() });
    let renamed = rig.until("the name", |f| names(f).contains(&"pearl") && f.activity == Activity::Done);
    assert_eq!(selected(&renamed), Some("pearl"));
    assert_eq!((renamed.render, renamed.scene.is_unsaved), (chosen.render, true), "the render goes on");
    edit(&rig, SceneEdit::Rename { target: Target::Shape(1), name: "bulb".into() });
    assert!(rig.failure().contains("has a \"bulb\" already"));
    for (step, name) in [(SceneEdit::Undo, "ball"), (SceneEdit::Redo, "pearl")] {
        edit(&rig, step);
        let named = rig.until("the name", |f| names(f).contains(&name) && f.activity == Activity::Done);
        assert_eq!((named.render, selected(&named)), (chosen.render, Some(name)), "the render goes on");
    }
    let make = Make::Kind(Side::Front, 0);
    edit(&rig, SceneEdit::Remake { make, name: "chalk".into(), all: false });
    let remade = rig.until("the material", |f| {
        let material = f.selection.as_ref().and_then(|s| s.inspection.material.clone());
        material.is_some_and(|m| m.name == "chalk") && f.activity == Activity::Done
    });
    assert_ne!(image(&remade), image(&renamed));
}

#[test]
fn the_camera_in_use_stays_in_use_when_others_come_and_go() {
    let (rig, before) = Rig::at_pass(1);
    edit(&rig, SceneEdit::Duplicate(Target::Sensor(0)));
    let two = with(&rig, &["floor", "ball", "bulb", "camera", "camera-2"]);
    let second = Configuration { sensor: 1, ..Configuration::of(&two.settings, two.threads, None) };
    rig.send(Command::Configure(second));
    rig.send(Command::Camera { gesture: Gesture::Face(ViewSide::Top), moving: false });
    let above = rig.until("the view from above", |f| {
        f.settings.sensor == 1
            && f.scene.sensors[1].xml != f.scene.sensors[0].xml
            && f.activity == Activity::Done
    });
    edit(&rig, SceneEdit::Delete(Target::Sensor(0)));
    let one = with(&rig, &["floor", "ball", "bulb", "camera-2"]);
    assert_eq!((one.settings.sensor, image(&one)), (0, image(&above)));
    edit(&rig, SceneEdit::Undo);
    let back = with(&rig, &["floor", "ball", "bulb", "camera", "camera-2"]);
    assert_eq!(back.settings.sensor, 1);
    assert_eq!(back.scene.sensors[0], before.scene.sensors[0]);
}

#[test]
fn a_mesh_is_imported_and_what_cannot_be_is_said() {
    let (rig, _) = Rig::at_pass(1);
    edit(&rig, SceneEdit::Import("models/heap.ply".into()));
    let there = rig.until("the model", |f| names(f).contains(&"heap") && f.activity == Activity::Done);
    assert_eq!(selected(&there), Some("floor-2"), "the first of its shapes");
    edit(&rig, SceneEdit::Import("nothing.ply".into()));
    assert!(rig.failure().contains("nothing.ply"));
}

#[test]
fn selecting_and_a_click_move_nothing() {
    let (rig, before) = Rig::at_pass(1);
    rig.send(Command::Choose(Some(BALL)));
    let handle = Handle::MoveView;
    edit(&rig, SceneEdit::BeginDrag { handle, film: BALL, reach: 60.0 });
    edit(&rig, SceneEdit::EndDrag { film: BALL, snap: false });
    rig.send(Command::Select(None));
    let after = rig.until("nothing selected", |f| f.selection.is_none() && f.activity == Activity::Done);
    assert!(!after.scene.is_unsaved && after.scene.undo.is_none());
    assert_eq!(image(&after), image(&before));
}
