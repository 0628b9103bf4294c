//! The question before a scene with unsaved edits goes: save it, discard them, or stay.

use egui::{Key, Modifiers};

use super::actions::save_dialog;
use crate::state::State;

pub(super) fn show(ctx: &egui::Context, state: &mut State) {
    if state.leaving.is_none() {
        return;
    }
    let name = state.frame.as_ref().map(|f| f.scene.title.clone()).unwrap_or_default();
    let modal = egui::Modal::new(egui::Id::unique("unsaved")).show(ctx, |ui| {
        ui.set_max_width(380.0);
        ui.heading("Save the edited scene?");
        ui.label(format!("{name} has edits that no file holds. Discarding them cannot be undone."));
        ui.add_space(10.0);
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            let save = ui.button("Save…");
            if state.wants_focus_on_save {
                save.request_focus();
                state.wants_focus_on_save = false;
            }
            let discard = ui.button("Discard");
            let cancel = ui.button("Cancel");
            state.place("discard", &discard);
            (save.clicked(), discard.clicked(), cancel.clicked())
        })
        .inner
    });
    let (save, discard, cancel) = modal.inner;
    if save {
        state.after_save = state.leaving.take();
        save_dialog(state);
    } else if discard {
        if let Some(to) = state.leaving.take() {
            state.go(to);
        }
    } else if cancel || modal.should_close() {
        state.leaving = None;
        ctx.input_mut(|i| i.consume_key(Modifiers::NONE, Key::Escape));
    }
}
