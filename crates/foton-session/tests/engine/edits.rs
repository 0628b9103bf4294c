//! Cameras and edits through the engine: what moves answers small and quick, what is undone has the same bits as before.

use std::time::Duration;

use foton_edit::{DragMode, FieldId, Handle, Property, Side, Target, Value};
use foton_film::Image;
use foton_session::StopRule;
use foton_session::engine::{Activity, Command, Frame, Gesture, SceneEdit};

use crate::rig::{BALL, Folder, Rig, SIZE, image};

fn edit(rig: &Rig, change: SceneEdit) {
    rig.send(Command::Edit(change));
}

/// Takes hold of the middle of the ball's handles.
fn hold(film: [f64; 2]) -> SceneEdit {
    SceneEdit::BeginDrag { handle: Handle::MoveView, film, reach: 60.0 }
}

fn drag_to(film: [f64; 2]) -> SceneEdit {
    SceneEdit::DragTo { film, snap: false }
}

fn let_go(film: [f64; 2]) -> SceneEdit {
    SceneEdit::EndDrag { film, snap: false }
}

/// The whole picture of another render than that of `before`.
#[track_caller]
fn whole(rig: &Rig, before: &Frame) -> Frame {
    rig.until("the whole picture", |f| f.render != before.render && f.activity == Activity::Done)
}

/// A small picture of another render, in the middle of a move.
#[track_caller]
fn moving(rig: &Rig, before: &Frame) -> Frame {
    rig.until("the move", |f| {
        let is_small = f.picture.as_ref().is_some_and(|p| p.size() != SIZE);
        f.activity == Activity::Moving && f.render != before.render && is_small
    })
}

/// Pixels that differ.
fn differing(a: &Image, b: &Image) -> usize {
    a.pixels.iter().zip(&b.pixels).filter(|(a, b)| a != b).count()
}

#[test]
fn a_moving_camera_gives_small_pictures_then_the_whole() {
    let (rig, before) = Rig::at_pass(2);
    rig.send(Command::Camera { gesture: Gesture::Orbit { yaw: 0.2, pitch: 0.1 }, moving: true });
    let moving = moving(&rig, &before);
    let [width, height] = moving.picture.as_ref().expect("a picture").size();
    assert!(width < SIZE[0] && height < SIZE[1], "{width} × {height}");
    assert_eq!(moving.size, SIZE, "the image keeps its size");
    rig.send(Command::Moving(false));
    let after = whole(&rig, &before);
    assert_eq!(after.picture.as_ref().expect("a picture").size(), SIZE);
    assert!(differing(&image(&before), &image(&after)) > 1000);
    assert!(after.scene.is_edited && after.scene.sensors[0].xml != before.scene.sensors[0].xml);
    rig.send(Command::Camera { gesture: Gesture::FieldOfView(30.0), moving: false });
    let near = whole(&rig, &after);
    assert!((near.scene.sensors[0].fov_degrees - 30.0).abs() < 1e-9);
    rig.send(Command::ResetCamera);
    let back = whole(&rig, &near);
    assert_eq!(image(&back), image(&before));
    assert!(!back.scene.is_edited);
}

#[test]
fn a_lens_opens_focuses_on_what_is_picked_and_goes_with_the_camera_when_it_is_reset() {
    let (rig, before) = Rig::at_pass(2);
    let look = |gesture| rig.send(Command::Camera { gesture, moving: false });
    assert_eq!(before.scene.sensors[0].lens, None);
    look(Gesture::Aperture(0.3));
    let open = whole(&rig, &before);
    let lens = open.scene.sensors[0].lens.expect("a lens");
    assert!((lens.aperture_radius - 0.3).abs() < 1e-12 && open.scene.is_edited);
    assert!(open.scene.sensors[0].xml.contains("thinlens"));
    assert!(differing(&image(&before), &image(&open)) > 1000);
    look(Gesture::FocusAt(BALL));
    let focused = whole(&rig, &open);
    let ball = focused.scene.sensors[0].lens.expect("kept").focus_distance;
    look(Gesture::FocusAt([BALL[0], f64::from(SIZE[1]) - 1.0]));
    let near = whole(&rig, &focused);
    let floor = near.scene.sensors[0].lens.expect("kept").focus_distance;
    assert!(floor > 0.0 && floor < ball, "the floor before the ball is nearer: {floor} {ball}");
    // An orbit keeps it, and so does undoing something else.
    look(Gesture::Orbit { yaw: 0.2, pitch: 0.0 });
    let turned = whole(&rig, &near);
    assert_eq!(turned.scene.sensors[0].lens, near.scene.sensors[0].lens);
    rig.send(Command::ResetCamera);
    let back = whole(&rig, &turned);
    assert_eq!(image(&back), image(&before));
    assert!(back.scene.sensors[0].lens.is_none() && !back.scene.is_edited);
}

/// A window that draws in software takes long for a frame: one that only says that a picture will come would delay it.
#[test]
fn while_the_camera_moves_every_frame_has_its_picture() {
    let (rig, before) = Rig::at_pass(2);
    let mut last = before.render;
    for _ in 0..20 {
        // Longer than frames are held apart, so that nothing but its reason to be holds one up.
        std::thread::sleep(Duration::from_millis(50));
        // Two at once: the second calls off the picture that the first began.
        for yaw in [0.01, 0.02] {
            rig.send(Command::Camera { gesture: Gesture::Orbit { yaw, pitch: 0.0 }, moving: true });
        }
        let next = rig.until("the next picture", |f| {
            assert!(f.render == before.render || f.pictured == f.render, "{} shows {}", f.render, f.pictured);
            f.render > last
        });
        last = next.render;
    }
}

#[test]
fn a_drag_changes_the_picture_and_undoing_it_brings_the_same_bits_back() {
    let (rig, before) = Rig::at_pass(2);
    rig.send(Command::Choose(Some(BALL)));
    let chosen = rig.until("a choice", |f| f.selection.is_some());
    let selection = chosen.selection.expect("just seen");
    assert_eq!((selection.target, selection.inspection.title.as_str()), (Target::Shape(1), "ball"));
    assert!(!selection.outline.is_empty());
    assert_eq!(chosen.render, before.render, "choosing starts nothing anew");

    edit(&rig, hold(BALL));
    edit(&rig, drag_to([BALL[0] + 25.0, BALL[1]]));
    let moving = moving(&rig, &before);
    assert_ne!(moving.selection.expect("kept").outline, selection.outline);
    edit(&rig, let_go([BALL[0] + 25.0, BALL[1] + 2.0]));
    let after = whole(&rig, &before);
    assert!(differing(&image(&before), &image(&after)) > 500);
    assert!(after.scene.is_edited && after.scene.undo.as_ref().is_some_and(|name| name.contains("ball")));

    edit(&rig, SceneEdit::Undo);
    let undone = whole(&rig, &after);
    assert_eq!(image(&undone), image(&before));
    assert_eq!(undone.selection.expect("kept").outline, selection.outline);
    edit(&rig, SceneEdit::Redo);
    let redone = rig.until("it again", |f| f.render != undone.render && f.activity == Activity::Done);
    assert_eq!(image(&redone), image(&after));
}

#[test]
fn in_a_large_scene_the_outline_is_dragged_and_the_picture_follows_when_it_is_let_go() {
    let rig = Rig::new(crate::rig::settings(), None);
    rig.open("heap");
    rig.send(Command::StopAt(StopRule::passes(2)));
    let before = rig.done(2);
    rig.send(Command::Choose(Some(BALL)));
    let chosen = rig.until("a choice", |f| f.selection.is_some()).selection.expect("just seen");
    let to = [BALL[0] + 25.0, BALL[1]];
    edit(&rig, hold(BALL));
    edit(&rig, drag_to(to));
    let is_elsewhere = |f: &Frame| f.selection.as_ref().is_some_and(|s| s.outline != chosen.outline);
    let moving = rig.until("the outline", is_elsewhere);
    assert_eq!(moving.render, before.render, "no other scene yet");
    assert_eq!(image(&moving), image(&before));
    edit(&rig, let_go(to));
    let after = whole(&rig, &before);
    assert!(differing(&image(&before), &image(&after)) > 500);
    let outline = |f: &Frame| f.selection.as_ref().map(|s| s.outline.clone());
    assert_eq!(outline(&after), outline(&moving));

    // Called off, everything is where it was.
    edit(&rig, hold(to));
    edit(&rig, drag_to([to[0] - 40.0, to[1]]));
    edit(&rig, SceneEdit::CancelDrag);
    let back = rig.until("it back", |f| f.render != after.render && f.activity == Activity::Done);
    assert_eq!(image(&back), image(&after));
}

#[test]
fn what_is_undone_is_held_where_it_is() {
    let (rig, before) = Rig::at_pass(1);
    rig.send(Command::Choose(Some(BALL)));
    let far = SceneEdit::Nudge { steps: [20.0, 0.0], mode: DragMode::Horizontal };
    let near = SceneEdit::Nudge { steps: [1.0, 0.0], mode: DragMode::Horizontal };
    let outline = |f: &Frame| f.selection.as_ref().map(|s| s.outline.clone());
    edit(&rig, near.clone());
    let once = whole(&rig, &before);
    edit(&rig, SceneEdit::Undo);
    edit(&rig, far);
    edit(&rig, SceneEdit::Undo);
    edit(&rig, near);
    // A step is so many pixels at the place of the grip: at another place it would be another way.
    let again = rig.until("the same step", |f| {
        f.scene.undo.is_some() && f.activity == Activity::Done && f.render > once.render + 3
    });
    assert_eq!(outline(&again), outline(&once));
}

#[test]
fn a_drag_that_is_called_off_leaves_no_step() {
    let (rig, before) = Rig::at_pass(2);
    rig.send(Command::Choose(Some(BALL)));
    edit(&rig, hold(BALL));
    edit(&rig, drag_to([BALL[0], BALL[1] - 20.0]));
    moving(&rig, &before);
    edit(&rig, SceneEdit::CancelDrag);
    let after = whole(&rig, &before);
    assert_eq!(image(&after), image(&before));
    assert_eq!((after.scene.undo.clone(), after.scene.is_edited), (None, false));
}

#[test]
fn a_field_that_is_dragged_is_one_step_and_a_saved_scene_is_unedited() {
    let folder = Folder::new("save");
    let (rig, before) = Rig::at_pass(1);
    rig.send(Command::Choose(Some(BALL)));
    let field = FieldId::Material(Side::Front, Property::Parameter("int_ior"));
    for (ior, done) in [(1.8, false), (2.0, false), (2.4, true)] {
        edit(&rig, SceneEdit::SetField { field, value: Value::Number(ior), done });
    }
    edit(&rig, SceneEdit::Nudge { steps: [1.0, 0.0], mode: DragMode::Horizontal });
    let ior = |f: &Frame| {
        let fields = &f.selection.as_ref().expect("kept").inspection.fields;
        fields.iter().find(|f| f.id == field).map(|f| f.value).expect("glass has one")
    };
    let is = |value, ior: f64| matches!(value, Value::Number(v) if (v - ior).abs() < 1e-6);
    let after = whole(&rig, &before);
    assert!(is(ior(&after), 2.4), "{:?}", ior(&after));
    let path = folder.0.join("edited.xml");
    rig.send(Command::SaveScene(path.clone()));
    assert_eq!(rig.scene_saved(), path);
    let saved = rig.until("it saved", |f| !f.scene.is_edited && !f.scene.is_unsaved);
    assert_eq!((saved.render, saved.scene.file.as_ref()), (after.render, Some(&path)), "the render goes on");
    assert_eq!(std::fs::read_to_string(&path).expect("written"), "Some(42) 2");
    // What is rendered is the scene of that file from now on.
    rig.send(Command::Snapshot(folder.0.clone()));
    assert_eq!(named(&rig.saved()[0]), ("edited.xml".to_owned(), format!("{:016x}", 77)));
    let checkpoint = folder.0.join("saved.checkpoint");
    rig.send(Command::KeepCheckpoint(checkpoint.clone()));
    assert_eq!(rig.saved(), [checkpoint]);
    edit(&rig, SceneEdit::Undo);
    edit(&rig, SceneEdit::Undo);
    let undone = rig.until("two steps back", |f| f.scene.undo.is_none() && f.activity == Activity::Done);
    assert!(is(ior(&undone), 1.5), "{:?}", ior(&undone));
    assert_eq!(image(&undone), image(&before));
    assert!(undone.scene.is_unsaved, "the file has the steps that were taken back");
    rig.send(Command::Snapshot(folder.0.clone()));
    assert_eq!(named(&rig.saved()[0]).0, "edited.xml (edited)");
}

/// The scene that an EXR says it is of, and its hash.
fn named(path: &std::path::Path) -> (String, String) {
    let (_, metadata) = foton_film::read_exr(path).expect("an EXR");
    let of = |key: &str| metadata.get(key).expect("it is there").to_owned();
    (of("foton:scene"), of("foton:scene-hash"))
}

#[test]
fn what_was_asked_to_be_written_is_written_before_the_end() {
    let folder = Folder::new("finish");
    let (rig, _) = Rig::at_pass(1);
    rig.send(Command::Snapshot(folder.0.clone()));
    rig.engine.finish_writing();
    let there = |name: &str| folder.0.join(name).exists();
    assert!(there("room-001-p000001.exr") && there("room-001-p000001.png"));
}

#[test]
fn a_choice_beside_everything_chooses_nothing_and_restarts_nothing() {
    let (rig, before) = Rig::at_pass(1);
    rig.send(Command::Choose(Some(BALL)));
    rig.until("a choice", |f| f.selection.is_some());
    rig.send(Command::Choose(None));
    let frame = rig.until("no choice", |f| f.selection.is_none());
    assert_eq!(frame.render, before.render);
    edit(&rig, drag_to([0.0, 0.0]));
    edit(&rig, SceneEdit::Undo);
    rig.send(Command::StopAt(StopRule::passes(2)));
    assert_eq!(rig.done(2).render, before.render, "edits of nothing are none");
}
