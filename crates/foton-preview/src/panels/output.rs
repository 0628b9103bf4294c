//! Where pictures and checkpoints go.

use egui::Ui;
use foton_session::engine::Command;

use super::actions;
use super::widgets::row;
use crate::state::State;

pub(super) fn show(ui: &mut Ui, state: &mut State) {
    row(ui, "Folder", "Where snapshots are saved", |ui, label| {
        let mut edited = state.preferences.snapshot_folder.display().to_string();
        let width = ui.available_width() - 8.0;
        let field = ui.add(egui::TextEdit::singleline(&mut edited).desired_width(width)).labelled_by(label);
        if field.changed() {
            state.preferences.snapshot_folder = edited.into();
        }
    });
    let auto = ui.checkbox(&mut state.auto_snapshots, "Snapshots at passes 1, 2, 4, 8, …");
    if auto.on_hover_text("Writes a picture at powers of two: frames of a film of the convergence").changed()
    {
        let folder = state.auto_snapshots.then(|| state.snapshot_folder());
        state.ask(Command::AutoSnapshots(folder));
    }
    ui.horizontal_wrapped(|ui| {
        if ui
            .button("Keep checkpoint…")
            .on_hover_text("Updates a file with this render's state every 30 s")
            .clicked()
        {
            actions::checkpoint_dialog(state);
        }
        if ui.button("Resume checkpoint…").on_hover_text("Goes on from such a file, bit for bit").clicked()
        {
            actions::resume_dialog(state);
        }
    });
}
