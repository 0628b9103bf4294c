//! What is chosen: its material and fields, all of them editable live.

use foton_edit::Target;
use foton_session::engine::{Command, Configuration, SceneEdit};

use super::{camera as views, fields, material, tools};
use crate::state::State;

pub(super) fn show(ui: &mut egui::Ui, state: &mut State) {
    let Some(selection) = state.frame.as_ref().and_then(|f| f.selection.clone()) else {
        if state.frame.is_some() {
            ui.weak("Nothing selected. Click a shape or a light to edit it.");
        }
        return;
    };
    let inspection = &selection.inspection;
    ui.add_space(6.0);
    ui.horizontal(|ui| {
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            if ui.button("Deselect").on_hover_text("Esc").clicked() {
                state.ask(Command::Choose(None));
            }
            ui.with_layout(egui::Layout::left_to_right(egui::Align::Center), |ui| {
                let title = egui::RichText::new(&inspection.title).strong().size(16.0);
                ui.add(egui::Label::new(title).truncate());
            });
        });
    });
    ui.add(egui::Label::new(egui::RichText::new(&inspection.kind).weak()).truncate());
    tools::show(ui, state, &selection);
    match selection.target {
        Target::Sensor(sensor) => camera(ui, state, sensor),
        _ => material::show(ui, state, &selection),
    }
    fields::show(ui, state, &selection);
    for note in &inspection.notes {
        ui.weak(note);
    }
    ui.add_space(8.0);
    history(ui, state);
}

/// What is done with a camera: looking through it.
fn camera(ui: &mut egui::Ui, state: &mut State, sensor: usize) {
    let Some(frame) = &state.frame else { return };
    if frame.settings.sensor == sensor {
        views::sides(ui, state);
        return;
    }
    let configuration = Configuration { sensor, ..Configuration::of(&frame.settings, frame.threads, None) };
    if ui.button("Look through it").on_hover_text("Renders what this camera sees; restarts").clicked() {
        state.ask(Command::Configure(configuration));
    }
}

fn history(ui: &mut egui::Ui, state: &mut State) {
    let Some(scene) = state.frame.as_ref().map(|f| f.scene.clone()) else { return };
    ui.horizontal(|ui| {
        let steps = [
            ("Undo", &scene.undo, SceneEdit::Undo, "Ctrl+Z"),
            ("Redo", &scene.redo, SceneEdit::Redo, "Ctrl+Shift+Z"),
        ];
        for (label, step, change, keys) in steps {
            let button = ui.add_enabled(step.is_some(), egui::Button::new(label));
            let button = button.on_hover_text(format!("{} ({keys})", step.as_deref().unwrap_or("Nothing")));
            if button.clicked() {
                state.ask(Command::Edit(change));
            }
        }
    });
}
