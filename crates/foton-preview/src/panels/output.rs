//! Where pictures and checkpoints go.

use egui::Ui;
use foton_session::engine::Command;

use super::actions;
use super::widgets::row;
use crate::state::State;

pub(super) fn show(ui: &mut Ui, state: &mut State) {
    folder(ui, state);
    ui.checkbox(&mut state.preferences.png_as_shown, "PNG as shown").on_hover_text(
        "On: the PNG of a snapshot has the exposure and the tone map of the screen. Off: exposure 0 and PBR Neutral, the defaults of \
         `foton render`. The EXR is linear either way.",
    );
    let auto = ui.checkbox(&mut state.auto_snapshots, "Snapshots at passes 1, 2, 4, 8, …");
    if auto.on_hover_text("Writes a picture at powers of two: frames of a film of the convergence").changed()
    {
        tell(state);
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

fn folder(ui: &mut Ui, state: &mut State) {
    let help = format!(
        "Snapshots are saved in {}. Scene, run and pass make their names, and nothing is written over. The folder is made when it is \
         needed.",
        foton_input::shown_path(&state.snapshot_folder())
    );
    row(ui, "Folder", &help, |ui, label| {
        let mut edited = state.preferences.snapshot_folder.display().to_string();
        let width = ui.available_width() - 8.0;
        let field = ui.add(egui::TextEdit::singleline(&mut edited).desired_width(width)).labelled_by(label);
        if field.changed() {
            state.preferences.snapshot_folder = edited.into();
        }
        if field.lost_focus() && state.auto_snapshots {
            tell(state);
        }
    });
}

/// Tells the engine whether, and where, snapshots are to come by themselves.
fn tell(state: &mut State) {
    let folder = state.auto_snapshots.then(|| state.snapshot_folder());
    state.ask(Command::AutoSnapshots(folder));
}
