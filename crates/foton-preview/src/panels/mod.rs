//! The panels: pure functions of the window's state. What they ask for goes into its outbox.

mod canvas;
mod controls;
mod dot_legend;
mod dropping;
mod error;
mod exposure;
mod film_place;
mod gallery;
mod help;
mod hint;
mod history;
mod inspector;
mod keys;
mod legend;
mod messages;
mod output;
mod overlay;
mod pixel_values;
mod region;
mod stats;
mod text;
mod toolbar;
mod widgets;

#[cfg(test)]
mod tests;

use foton_session::engine::Command;

use crate::files::Outcome;
use crate::state::{DialogPurpose, State};

/// What the window is cleared to before [`show`] is drawn over it.
pub(crate) fn ground(visuals: &egui::Visuals) -> egui::Color32 {
    visuals.panel_fill
}

/// Everything in the window, over a [`ground`].
pub(crate) fn show(ui: &mut egui::Ui, state: &mut State) {
    state.places.clear();
    state.tell_look();
    // Screen readers say a window's name first.
    ui.ctx().accesskit_node_builder(egui::accesskit_root_id(), |window| window.set_label("foton"));
    keys::obey(ui, state);
    // The window is cleared to the panels' colour (see `ground`), so that they need not be filled: on a software adapter egui's
    // shader takes some 60 ns of a core for each pixel, which makes fills the most of a frame.
    let frame = egui::Frame::side_top_panel(ui.style()).fill(egui::Color32::TRANSPARENT);
    egui::Panel::top("toolbar").frame(frame).show(ui, |ui| toolbar::show(ui, state));
    egui::Panel::bottom("status").frame(frame).show(ui, |ui| stats::status(ui, state));
    if state.show_history {
        egui::Panel::bottom("history").frame(frame).show(ui, |ui| history::show(ui, state));
    }
    let controls = egui::Panel::left("controls").frame(frame);
    controls.default_size(300.0).size_range(260.0..=440.0).show(ui, |ui| {
        egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            controls::show(ui, state);
            stats::show(ui, state);
        });
    });
    if state.frame.as_ref().is_some_and(|f| f.selection.is_some()) {
        let inspector = egui::Panel::right("inspector").frame(frame);
        inspector.default_size(280.0).size_range(240.0..=440.0).show(ui, |ui| {
            egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| inspector::show(ui, state));
        });
    }
    let canvas =
        egui::CentralPanel::default().frame(egui::Frame::NONE).show(ui, |ui| canvas::show(ui, state));
    exposure::histogram(ui.ctx(), state, canvas.response.rect);
    messages::show(ui.ctx(), state);
    help::show(ui.ctx(), state);
    dialog(ui.ctx(), state);
    dropping::show(ui.ctx(), canvas.response.rect);
}

fn dialog(ctx: &egui::Context, state: &mut State) {
    let Some((purpose, mut dialog)) = state.dialog.take() else { return };
    match dialog.show(ctx) {
        Outcome::Browsing => state.dialog = Some((purpose, dialog)),
        Outcome::Cancelled => {}
        Outcome::Chosen(path) => {
            if let Some(folder) = path.parent() {
                state.preferences.scene_folder = folder.to_owned();
            }
            match purpose {
                DialogPurpose::OpenScene => state.open(path),
                DialogPurpose::SaveScene => state.ask(Command::SaveScene(path)),
                DialogPurpose::KeepCheckpoint => state.ask(Command::KeepCheckpoint(path)),
                DialogPurpose::ResumeCheckpoint => state.ask(Command::ResumeCheckpoint(path)),
            }
        }
    }
}
