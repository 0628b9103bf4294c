//! Keyboard shortcuts. They rest while someone types.

use egui::{Key, Modifiers};
use foton_edit::DragMode;
use foton_session::engine::{Activity, Command, Gesture, SceneEdit};

use super::toolbar::{PICTURES, open_dialog, save_dialog};
use crate::state::{Grip, Pinned, Placement, State};

/// What a key does.
type Act = fn(&mut State);

/// How far a key flies, as a share of the distance to what the camera looks at.
const STEP: f64 = 0.03;

pub(super) fn obey(ui: &egui::Ui, state: &mut State) {
    if state.dialog.is_some() || ui.ctx().egui_wants_keyboard_input() {
        return;
    }
    let pressed = |modifiers: Modifiers, key: Key| ui.input_mut(|i| i.consume_key(modifiers, key));
    if pressed(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z) || pressed(Modifiers::COMMAND, Key::Y) {
        state.ask(Command::Edit(SceneEdit::Redo));
    }
    let with_command: [(Key, Act); 5] = [
        (Key::Z, |s| s.ask(Command::Edit(SceneEdit::Undo))),
        (Key::R, |s| s.ask(Command::Restart)),
        (Key::O, open_dialog),
        (Key::S, save_dialog),
        (Key::Q, |s| s.wants_to_close = true),
    ];
    for (key, act) in with_command {
        if pressed(Modifiers::COMMAND, key) {
            act(state);
        }
    }
    if ui.input(|i| i.events.iter().any(|e| matches!(e, egui::Event::Text(t) if t == "?"))) {
        state.show_help = !state.show_help;
    }
    let plain: [(Key, Act); 12] = [
        (Key::Space, toggle_pause),
        (Key::Period, |s| s.ask(Command::Step)),
        (Key::F, |s| s.placement = Placement::FIT),
        (Key::H, |s| s.ask(Command::ResetCamera)),
        (Key::P, |s| {
            let folder = s.snapshot_folder();
            s.ask(Command::Snapshot(folder));
        }),
        (Key::O, |s| {
            s.show_photons = !s.show_photons;
            s.ask(Command::ShowPhotons(s.show_photons));
        }),
        (Key::K, toggle_pin),
        (Key::N, |s| s.ask(Command::Remember)),
        (Key::T, |s| s.show_history = !s.show_history),
        (Key::L, |s| s.show_histogram = !s.show_histogram),
        (Key::C, |s| s.marks_clipping = !s.marks_clipping),
        (Key::Escape, escape),
    ];
    for (key, act) in plain {
        if pressed(Modifiers::NONE, key) {
            act(state);
        }
    }
    for (key, (_, view)) in [Key::Num1, Key::Num2, Key::Num3, Key::Num4, Key::Num5].into_iter().zip(PICTURES)
    {
        if pressed(Modifiers::NONE, key) {
            state.choose_view(view);
        }
    }
    nudge(ui, state);
    fly(ui, state);
}

fn toggle_pause(state: &mut State) {
    let waits = state.frame.as_ref().is_some_and(|f| matches!(f.activity, Activity::Paused | Activity::Done));
    state.ask(if waits { Command::Resume } else { Command::Pause });
}

fn toggle_pin(state: &mut State) {
    if state.pinned.take().is_some() {
        return;
    }
    let Some(frame) = &state.frame else { return };
    let label = format!("pass {}", frame.stats.passes);
    state.pinned = frame.picture.clone().map(|picture| Pinned { picture, label, entry: None });
}

fn escape(state: &mut State) {
    if state.show_help {
        state.show_help = false;
    } else if state.choosing_region.take().is_some() {
        // That was to be given up.
    } else if state.grip == Grip::Object {
        state.grip = Grip::None;
        state.ask(Command::Edit(SceneEdit::CancelDrag));
    } else {
        state.ask(Command::Choose(None));
    }
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
            state.ask(Command::Edit(SceneEdit::Nudge { steps, mode }));
        }
    }
}

fn fly(ui: &egui::Ui, state: &mut State) {
    let (modifiers, now) = ui.input(|i| (i.modifiers, i.time));
    if modifiers.any() {
        return;
    }
    let held = |key: Key| ui.input(|i| f64::from(u8::from(i.key_down(key))));
    let along = |ahead: Key, back: Key| (held(ahead) - held(back)) * STEP;
    let (forward, right, up) = (along(Key::W, Key::S), along(Key::D, Key::A), along(Key::E, Key::Q));
    if (forward, right, up) != (0.0, 0.0, 0.0) {
        state.moved_at = Some(now);
        state.ask(Command::Camera { gesture: Gesture::Fly { forward, right, up }, moving: true });
        ui.ctx().request_repaint_after(std::time::Duration::from_millis(30));
    }
}
