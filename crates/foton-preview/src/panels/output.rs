//! What the window writes by itself: where pictures go, how PNGs look, and the film of a convergence.

use foton_session::engine::Command;

use crate::state::State;

pub(super) fn show(ui: &mut egui::Ui, state: &mut State) {
    folder(ui, state);
    ui.checkbox(&mut state.preferences.png_as_shown, "PNG as shown").on_hover_text(
        "On: the PNG has the exposure and the tone map of the screen. Off: exposure 0 and PBR Neutral, as `foton render` has \
         by default. The EXR is linear either way.",
    );
    let auto = ui.checkbox(&mut state.auto_snapshots, "at passes 1, 2, 4, 8, …");
    if auto.on_hover_text("Writes a picture at powers of two: frames of a film of the convergence").changed()
    {
        tell(state);
    }
}

fn folder(ui: &mut egui::Ui, state: &mut State) {
    ui.horizontal(|ui| {
        let label = ui.label("Folder");
        let mut edited = state.preferences.snapshot_folder.display().to_string();
        let field = ui.add(egui::TextEdit::singleline(&mut edited).desired_width(f32::INFINITY));
        let field = field.labelled_by(label.id).on_hover_text(format!(
            "Snapshots go to {}: scene, run and pass make their names, and nothing is written over. The folder is made when it \
             is needed.",
            state.snapshot_folder().display()
        ));
        if field.changed() {
            state.preferences.snapshot_folder = edited.into();
        }
        if field.lost_focus() && state.auto_snapshots {
            tell(state);
        }
    });
}

fn tell(state: &mut State) {
    let folder = state.auto_snapshots.then(|| state.snapshot_folder());
    state.ask(Command::AutoSnapshots(folder));
}
