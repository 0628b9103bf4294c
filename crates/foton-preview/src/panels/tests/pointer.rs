//! The pointer over the picture: it points, chooses, turns, moves, zooms.

use egui::{Modifiers, MouseWheelUnit, Pos2, vec2};
use foton_session::engine::{Gesture, SceneEdit};

use super::*;
use crate::state::Placement;

/// Where a pixel's position is in the window.
fn at(harness: &Harness<'_, State>, film: [f32; 2]) -> Pos2 {
    let places = &harness.state().places;
    let canvas = places.iter().find(|(name, _)| *name == "canvas").expect("a canvas").1;
    let scale = (canvas.width() / SIZE[0] as f32).min(canvas.height() / SIZE[1] as f32);
    canvas.center() + (vec2(film[0], film[1]) - vec2(SIZE[0] as f32, SIZE[1] as f32) * 0.5) * scale
}

fn chosen() -> Harness<'static, State> {
    window(|state| state.frame.as_mut().expect("there").selection = Some(selection()))
}

/// Presses at one film position and moves to another; all that was asked for but the probes.
fn drag(harness: &mut Harness<'_, State>, from: [f32; 2], to: [f32; 2]) -> Vec<String> {
    let (from, to) = (at(harness, from), at(harness, to));
    harness.hover_at(from);
    harness.run_steps(2);
    harness.drag_at(from);
    for share in [0.25, 0.5, 1.0] {
        harness.hover_at(from + (to - from) * share);
        harness.run_steps(2);
    }
    harness.drop_at(to);
    asked(harness).into_iter().filter(|a| !a.starts_with("Probe")).collect()
}

#[test]
fn the_pixel_under_the_pointer_is_asked_about() {
    let mut harness = window(|_| ());
    let inside = at(&harness, [12.5, 30.5]);
    harness.hover_at(inside);
    assert_asked(&mut harness, &Command::Probe(Some([12, 30])));
    harness.hover_at(egui::pos2(5.0, 400.0));
    assert_asked(&mut harness, &Command::Probe(None));
}

#[test]
fn a_click_chooses_and_a_second_one_fits_the_image() {
    let mut harness = window(|_| ());
    let here = at(&harness, [30.0, 20.0]);
    harness.hover_at(here);
    settle(&mut harness);
    harness.state_mut().outbox.clear();
    harness.drag_at(here);
    harness.drop_at(here);
    let asked = asked(&mut harness);
    assert_eq!(asked[0], format!("{:?}", Command::Choose(Some([30.0, 20.0]))), "{asked:?}");
    harness.state_mut().placement = Placement { zoom: Some(3.0), centre: [0.1, 0.1] };
    // In one frame, for a double click is quick.
    let press = |pressed| egui::Event::PointerButton {
        pos: here,
        button: egui::PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    let twice = [egui::Event::PointerMoved(here), press(true), press(false), press(true), press(false)];
    harness.input_mut().events.extend(twice);
    harness.step();
    assert_eq!(harness.state().placement, Placement::FIT);
}

#[test]
fn dragging_turns_the_camera_and_never_moves_what_is_selected() {
    // Beside what is selected, and on it: without a handle under the pointer both turn the camera.
    for (from, to) in [([50.0, 35.0], [55.0, 35.0]), ([21.0, 12.0], [26.0, 12.0])] {
        let mut harness = chosen();
        let asked = drag(&mut harness, from, to);
        let (last, moves) = asked.split_last().expect("something");
        assert_eq!(*last, format!("{:?}", Command::Moving(false)));
        assert!(
            !moves.is_empty() && moves.iter().all(|a| a.contains("Orbit") && a.contains("moving: true")),
            "{asked:?}"
        );
    }
}

#[test]
fn a_click_and_a_drag_after_it_select_and_turn_the_camera() {
    let mut harness = window(|state| {
        let mut selection = selection();
        selection.gizmo = None;
        state.frame.as_mut().expect("there").selection = Some(selection);
    });
    let here = at(&harness, [30.0, 20.0]);
    harness.hover_at(here);
    settle(&mut harness);
    harness.state_mut().outbox.clear();
    harness.drag_at(here);
    harness.drop_at(here);
    let clicked = asked(&mut harness);
    assert!(clicked.iter().all(|a| a.starts_with("Choose") || a.starts_with("Probe")), "{clicked:?}");
    let dragged = drag(&mut harness, [30.0, 20.0], [40.0, 25.0]);
    assert!(dragged.iter().all(|a| !a.contains("Edit(")), "{dragged:?}");
}

#[test]
fn a_handle_is_dragged_and_ctrl_lets_it_snap() {
    let mut harness = chosen();
    let asked = drag(&mut harness, [30.0, 20.0], [34.0, 20.0]);
    assert!(asked[0].contains("BeginDrag { handle: MoveView, film: [30."), "{asked:?}");
    assert!(asked[1].contains("DragTo") && asked[1].contains("snap: false"), "{asked:?}");
    assert!(asked.last().is_some_and(|a| a.contains("EndDrag { film: [34.")), "{asked:?}");
    assert!(!asked.iter().any(|a| a.contains("Camera")), "{asked:?}");
    harness.state_mut().editing.snap = true;
    let snapping = drag(&mut harness, [30.0, 20.0], [34.0, 20.0]);
    assert!(snapping.iter().any(|a| a.contains("DragTo") && a.contains("snap: true")), "{snapping:?}");
}

#[test]
fn a_click_that_closes_a_menu_does_nothing_else() {
    let mut harness = chosen();
    let open = |harness: &mut Harness<'_, State>| {
        click(harness, Role::Button, "Add");
        assert!(harness.query_by_label("Sphere").is_some(), "the menu is open");
        harness.state_mut().outbox.clear();
    };
    open(&mut harness);
    let here = at(&harness, [50.0, 30.0]);
    harness.hover_at(here);
    harness.run_steps(2);
    harness.drag_at(here);
    harness.drop_at(here);
    let closing: Vec<String> = asked(&mut harness).into_iter().filter(|a| !a.starts_with("Probe")).collect();
    assert_eq!(closing, [""; 0]);
    assert!(harness.query_by_label("Sphere").is_none(), "the menu is closed");
    // A drag neither, on a handle or beside it.
    for from in [[30.0, 20.0], [50.0, 30.0]] {
        open(&mut harness);
        let dragged = drag(&mut harness, from, [20.0, 10.0]);
        assert_eq!(dragged, [""; 0], "from {from:?}");
    }
    let after = drag(&mut harness, [50.0, 30.0], [45.0, 30.0]);
    assert!(after.iter().any(|a| a.contains("Orbit")), "{after:?}");
}

#[test]
fn a_light_is_aimed_by_the_next_click() {
    let mut harness = window(|state| {
        let mut selection = selection();
        selection.inspection.can_aim = true;
        state.frame.as_mut().expect("there").selection = Some(selection);
    });
    click(&mut harness, Role::Button, "Aim at a point");
    let here = at(&harness, [50.0, 30.0]);
    harness.hover_at(here);
    settle(&mut harness);
    harness.state_mut().outbox.clear();
    harness.drag_at(here);
    harness.drop_at(here);
    let aimed = asked(&mut harness);
    assert!(aimed[0].starts_with("Edit(AimAt(["), "{aimed:?}");
    assert!(!harness.state().editing.aiming);
}

/// On a slow machine the button goes down and the pointer goes all the way in a single frame, and rests from then on.
#[test]
fn a_drag_that_is_over_within_a_frame_goes_all_the_way() {
    let mut harness = chosen();
    let (from, to) = (at(&harness, [30.0, 20.0]), at(&harness, [34.0, 20.0]));
    harness.hover_at(from);
    settle(&mut harness);
    harness.state_mut().outbox.clear();
    let press = egui::Event::PointerButton {
        pos: from,
        button: egui::PointerButton::Primary,
        pressed: true,
        modifiers: Modifiers::NONE,
    };
    harness.input_mut().events.extend([press, egui::Event::PointerMoved(to)]);
    harness.run_steps(4);
    let asked: Vec<String> = asked(&mut harness).into_iter().filter(|a| !a.starts_with("Probe")).collect();
    assert!(asked[0].contains("BeginDrag") && asked[0].contains("film: [30."), "{asked:?}");
    assert!(asked.get(1).is_some_and(|a| a.contains("DragTo { film: [34.")), "{asked:?}");
}

#[test]
fn escape_in_the_middle_of_a_drag_puts_it_back() {
    let mut harness = chosen();
    let (from, to) = (at(&harness, [30.0, 20.0]), at(&harness, [36.0, 20.0]));
    harness.hover_at(from);
    harness.run_steps(2);
    harness.drag_at(from);
    harness.hover_at(to);
    harness.run_steps(3);
    harness.state_mut().outbox.clear();
    harness.key_press(egui::Key::Escape);
    let put_back = format!("{:?}", Command::Edit(SceneEdit::CancelDrag));
    assert_eq!(asked(&mut harness)[0], put_back);
    harness.hover_at(from);
    harness.drop_at(from);
    let after = asked(&mut harness);
    assert!(!after.iter().any(|a| a.contains("Drag")), "{after:?}");
}

#[test]
fn the_wheel_goes_nearer_and_with_ctrl_enlarges_the_image() {
    let mut harness = window(|_| ());
    let here = at(&harness, [30.0, 20.0]);
    harness.hover_at(here);
    settle(&mut harness);
    harness.state_mut().outbox.clear();
    let wheel = |modifiers| egui::Event::MouseWheel {
        unit: MouseWheelUnit::Point,
        delta: vec2(0.0, 40.0),
        phase: egui::TouchPhase::Move,
        source: egui::MouseWheelSource::Wheel,
        modifiers,
    };
    harness.event(wheel(Modifiers::NONE));
    harness.run_steps(10);
    let nearer = asked(&mut harness);
    let zoom = |factor| format!("{:?}", Command::Camera { gesture: Gesture::Zoom(factor), moving: true });
    assert!(nearer[0].starts_with(&zoom(0.9)[..22]) && nearer[0].contains("Zoom(0."), "{nearer:?}");
    assert_eq!(harness.state().placement, Placement::FIT);
    harness.event_modifiers(wheel(Modifiers::COMMAND), Modifiers::COMMAND);
    harness.run_steps(10);
    assert!(harness.state().placement.zoom.is_some());
}

#[test]
fn a_file_held_over_the_window_is_told_what_comes_of_dropping_it() {
    let mut harness = chosen();
    let says = "Drop to open ring \u{17f}cene.xml";
    assert!(harness.query_by_label(says).is_none());
    let file = egui::HoveredFile { path: Some("/scenes/ring \u{17f}cene.xml".into()), ..Default::default() };
    harness.input_mut().hovered_files = vec![egui::HoveredFile::default(), file];
    settle(&mut harness);
    assert!(harness.query_by_label(says).is_some());
    harness.input_mut().hovered_files.clear();
    settle(&mut harness);
    assert!(harness.query_by_label(says).is_none());
}
