//! What is chosen: its material and fields, all of them editable live.

use foton_edit::{Control, Field, Value};
use foton_session::engine::{Command, SceneEdit};

use super::widgets::{heading, slider};
use crate::state::State;

pub(super) fn show(ui: &mut egui::Ui, state: &mut State) {
    let Some(selection) = state.frame.as_ref().and_then(|f| f.selection.clone()) else { return };
    let inspection = &selection.inspection;
    ui.add_space(6.0);
    ui.horizontal(|ui| {
        ui.label(egui::RichText::new(&inspection.title).strong().size(16.0));
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            if ui.button("Close").on_hover_text("Nothing selected (Esc)").clicked() {
                state.ask(Command::Choose(None));
            }
        });
    });
    ui.weak(&inspection.kind);
    if let Some(material) = &inspection.material {
        ui.horizontal_wrapped(|ui| {
            ui.label(format!("Material {}", material.name));
            if material.shapes > 1 {
                ui.weak(format!("shared by {} shapes", material.shapes));
                let own = ui.button("Make its own").on_hover_text("Edits then change this shape alone");
                if own.clicked() {
                    state.ask(Command::Edit(SceneEdit::OwnMaterial));
                }
            }
        });
    }
    heading(ui, "Properties");
    ui.spacing_mut().slider_width = 64.0;
    egui::Grid::new("fields").num_columns(2).min_col_width(112.0).show(ui, |ui| {
        for field in &inspection.fields {
            show_field(ui, state, field);
            ui.end_row();
        }
    });
    for note in &inspection.notes {
        ui.weak(note);
    }
    ui.add_space(8.0);
    history(ui, state);
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

/// A row: the label, then the control that it names.
fn show_field(ui: &mut egui::Ui, state: &mut State, field: &Field) {
    let label = ui.label(field.label).on_hover_text(field.help).id;
    let mut set = |value: Value, done: bool| {
        state.ask(Command::Edit(SceneEdit::SetField { field: field.id, value, done }));
    };
    match (&field.control, field.value) {
        (Control::Number { min, max, logarithmic }, Value::Number(value)) => {
            // What is nothing but rounding is no negative number.
            let mut number = if value.abs() < 1e-12 { 0.0 } else { value };
            let has_slider = *logarithmic || max - min <= 1000.0;
            let response = ui.horizontal(|ui| {
                let range = *min..=*max;
                let track = has_slider.then(|| {
                    let track = slider(&mut number, range.clone()).logarithmic(*logarithmic);
                    ui.add(track.show_value(false)).labelled_by(label)
                });
                let speed = if has_slider { (max - min) * 1e-3 } else { (value.abs() * 0.005).max(1e-4) };
                let speed = if *logarithmic { (value.abs() * 0.005).max(1e-6) } else { speed };
                let unit = if field.unit.is_empty() { String::new() } else { format!(" {}", field.unit) };
                let typed = egui::DragValue::new(&mut number).range(range).clamp_existing_to_range(false);
                let typed = ui.add(typed.speed(speed).suffix(unit)).labelled_by(label);
                track.map_or(typed.clone(), |track| track | typed)
            });
            let response = response.inner.on_hover_text(field.help);
            if response.changed() && number.is_finite() {
                set(Value::Number(number.clamp(*min, *max)), !response.dragged());
            } else if response.drag_stopped() {
                set(Value::Number(value), true);
            }
        }
        (Control::Colour, Value::Colour(colour)) => {
            let mut linear = colour;
            let response = ui.color_edit_button_rgb(&mut linear).labelled_by(label).on_hover_text(field.help);
            if response.changed() {
                set(Value::Colour(linear.map(|c| c.clamp(0.0, 1.0))), true);
            }
        }
        (Control::Choice(options), Value::Choice(chosen)) => {
            let text = options.get(chosen).map_or("", String::as_str);
            let list = egui::ComboBox::from_id_salt(field.label).selected_text(text).show_ui(ui, |ui| {
                for (i, option) in options.iter().enumerate() {
                    if ui.selectable_label(i == chosen, option).clicked() {
                        set(Value::Choice(i), true);
                    }
                }
            });
            list.response.labelled_by(label).on_hover_text(field.help);
        }
        (Control::Toggle, Value::Toggle(on)) => {
            let mut now = on;
            let response = ui.checkbox(&mut now, "").labelled_by(label).on_hover_text(field.help);
            if response.changed() {
                set(Value::Toggle(now), true);
            }
        }
        _ => {}
    }
}
