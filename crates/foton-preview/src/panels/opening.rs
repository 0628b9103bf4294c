//! A scene that is being opened: how far it is, and a way to call it off.

use egui::Ui;
use foton_session::engine::{BuildProgress, BuildStep, Command};

use super::text::shortened;
use crate::state::State;

pub(super) fn show(ui: &mut Ui, state: &mut State) {
    let opening = state.frame.as_ref().and_then(|f| f.opening.clone().map(|name| (name, f.building)));
    let Some((name, building)) = opening else { return };
    ui.separator();
    ui.spinner();
    ui.label(format!("Opening {}", shortened(&name, 28))).on_hover_text(&name);
    if let Some(BuildProgress { step, share }) = building {
        ui.add(
            egui::ProgressBar::new(share as f32)
                .desired_width(160.0)
                .text(step.map_or("reading the file", BuildStep::text)),
        );
    }
    if ui.button("Cancel").clicked() {
        state.ask(Command::CancelOpen);
    }
}
