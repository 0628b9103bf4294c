//! Keyboard shortcuts. They rest while someone types, and while a list, a menu or a dialog is open.

use egui::{FocusDirection, Key, Modifiers};
use foton_edit::{DragMode, Tool};
use foton_session::engine::{Command, Gesture, SceneEdit};

use super::views::VIEWS;
use super::{actions, typing, views};
use crate::state::{Leaving, Placement, State};

/// What a key does.
type Act = fn(&mut State);

/// How far a key flies, as a share of the distance to what the camera looks at.
const STEP: f64 = 0.03;

/// Keys with Ctrl that mean nothing in a text, and so work everywhere.
const ANYWHERE: [(Key, Act); 4] = [
    (Key::R, |s| s.ask(Command::Restart)),
    (Key::O, actions::open_dialog),
    (Key::S, actions::save_dialog),
    (Key::Q, |s| s.leave(Leaving::Close)),
];

/// Keys that are letters or signs.
const LETTERS: [(Key, Act); 15] = [
    (Key::Period, |s| s.ask(Command::Step)),
    (Key::F, |s| s.placement = Placement::FIT),
    (Key::H, |s| s.ask(Command::ResetCamera)),
    (Key::P, actions::snapshot),
    (Key::O, actions::toggle_photons),
    (Key::V, actions::toggle_paths),
    (Key::K, actions::toggle_pin),
    (Key::L, |s| s.looking.show_histogram = !s.looking.show_histogram),
    (Key::C, |s| s.looking.marks_clipping = !s.looking.marks_clipping),
    (Key::B, |s| s.ask(Command::Remember)),
    (Key::T, |s| s.looking.show_history = !s.looking.show_history),
    (Key::M, |s| s.editing.tool = Tool::Move),
    (Key::R, |s| s.editing.tool = Tool::Rotate),
    (Key::X, |s| s.editing.tool = Tool::Scale),
    (Key::N, |s| s.editing.snap = !s.editing.snap),
];

const DIGITS: [Key; 5] = [Key::Num1, Key::Num2, Key::Num3, Key::Num4, Key::Num5];

pub(super) fn obey(ui: &egui::Ui, state: &mut State) {
    let is_typing = typing::is_under_way(ui.ctx(), state);
    // Not by egui's modal layer, which it knows of a frame late: the key after Esc would be lost.
    if state.dialog.is_some() || state.leaving.is_some() || egui::Popup::is_any_open(ui.ctx()) {
        return;
    }
    let pressed = |modifiers: Modifiers, key: Key| ui.input_mut(|i| i.consume_key(modifiers, key));
    for (key, act) in ANYWHERE {
        if pressed(Modifiers::COMMAND, key) {
            act(state);
        }
    }
    // Keys that come with a click are for what was clicked, and that has no focus yet.
    if is_typing || ui.input(|i| i.pointer.any_click()) {
        return;
    }
    // Each press counts, however many come in a frame that took long.
    let times = |modifiers: Modifiers, key: Key| ui.input_mut(|i| i.count_and_consume_key(modifiers, key));
    let redone = times(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z) + times(Modifiers::COMMAND, Key::Y);
    let undone = times(Modifiers::COMMAND, Key::Z);
    (0..redone).for_each(|_| state.ask(Command::Edit(SceneEdit::Redo)));
    (0..undone).for_each(|_| state.ask(Command::Edit(SceneEdit::Undo)));
    if pressed(Modifiers::COMMAND, Key::D) {
        actions::duplicate(state);
    }
    if pressed(Modifiers::NONE, Key::Delete) {
        actions::delete(state);
    }
    if pressed(Modifiers::NONE, Key::F2) {
        actions::rename(state);
    }
    if ui.input(|i| i.events.iter().any(|e| matches!(e, egui::Event::Text(t) if t == "?"))) {
        state.show_help = !state.show_help;
    }
    for (key, act) in LETTERS {
        if pressed(Modifiers::NONE, key) {
            act(state);
        }
    }
    for (key, (_, view)) in DIGITS.into_iter().zip(VIEWS) {
        if pressed(Modifiers::NONE, key) && views::is_there(view, state) {
            state.choose_view(view);
        }
    }
    fly(ui, state);
    // A control that has the focus needs the rest: Space presses it, arrows set it, Tab and Esc leave it.
    let focused = ui.memory(|m| m.focused());
    if state.has_focused_control || focused.is_some_and(|id| Some(id) != state.canvas) {
        if pressed(Modifiers::NONE, Key::F6)
            && let Some(canvas) = state.canvas
        {
            ui.memory_mut(|m| m.request_focus(canvas));
        }
        return;
    }
    without_focus(ui, state);
}

/// Keys that belong to a control, if one has the focus.
fn without_focus(ui: &egui::Ui, state: &mut State) {
    let pressed = |key: Key| ui.input_mut(|i| i.consume_key(Modifiers::NONE, key));
    if pressed(Key::Space) {
        actions::toggle_pause(state);
    }
    if pressed(Key::Escape) {
        actions::escape(state);
    }
    if pressed(Key::Tab) {
        ui.memory_mut(|m| m.move_focus(FocusDirection::None));
        state.hides_panels = !state.hides_panels;
    }
    if pressed(Key::F6) {
        // Nothing has the focus then, and the first control takes it.
        ui.memory_mut(|m| {
            m.stop_text_input();
            m.move_focus(FocusDirection::Next);
        });
        state.hides_panels = false;
    }
    nudge(ui, state);
}

fn nudge(ui: &egui::Ui, state: &mut State) {
    if state.frame.as_ref().is_none_or(|f| f.selection.is_none()) {
        return;
    }
    let steps = [
        (Key::ArrowLeft, [-1.0, 0.0], DragMode::Horizontal),
        (Key::ArrowRight, [1.0, 0.0], DragMode::Horizontal),
        (Key::ArrowUp, [0.0, -1.0], DragMode::Horizontal),
        (Key::ArrowDown, [0.0, 1.0], DragMode::Horizontal),
        (Key::PageUp, [0.0, -1.0], DragMode::Vertical),
        (Key::PageDown, [0.0, 1.0], DragMode::Vertical),
    ];
    for (key, steps, mode) in steps {
        if ui.input_mut(|i| i.consume_key(Modifiers::NONE, key)) {
            // The picture keeps the focus.
            ui.memory_mut(|m| m.move_focus(FocusDirection::None));
            state.ask(Command::Edit(SceneEdit::Nudge { steps, mode }));
        }
    }
}

/// Flies by the keys that are held. Only by those that were pressed for that: one that is still down when Ctrl has been let go, or
/// the field that it was typed into, moves nothing.
fn fly(ui: &egui::Ui, state: &mut State) {
    let (modifiers, now) = ui.input(|i| (i.modifiers, i.time));
    let flying = &mut state.editing.flying;
    ui.input(|i| flying.extend(i.events.iter().filter_map(begins_to_fly)));
    let held = |key: Key| f64::from(u8::from(flying.contains(&key)));
    let along = |ahead: Key, back: Key| (held(ahead) - held(back)) * STEP;
    let (forward, right, up) = (along(Key::W, Key::S), along(Key::D, Key::A), along(Key::E, Key::Q));
    // A key that was down for less than a frame has counted.
    flying.retain(|key| ui.input(|i| i.key_down(*key)));
    if !modifiers.any() && (forward, right, up) != (0.0, 0.0, 0.0) {
        state.moved_at = Some(now);
        state.ask(Command::Camera { gesture: Gesture::Fly { forward, right, up }, moving: true });
        ui.ctx().request_repaint_after(std::time::Duration::from_millis(30));
    }
}

fn begins_to_fly(event: &egui::Event) -> Option<Key> {
    match event {
        egui::Event::Key { key, pressed: true, repeat: false, modifiers, .. } => {
            let flies = matches!(key, Key::W | Key::A | Key::S | Key::D | Key::Q | Key::E);
            (flies && !modifiers.any()).then_some(*key)
        }
        _ => None,
    }
}
