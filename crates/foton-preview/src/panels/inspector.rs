//! What is chosen: its material and fields, all of them editable live.

use foton_edit::{Control, Field, Value};
use foton_session::engine::{Command, SceneEdit};

use super::number::{Change, Number};
use super::slider::Slider;
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
    if let Some(material) = &inspection.material {
        ui.horizontal_wrapped(|ui| {
            ui.add(egui::Label::new(format!("Material {}", material.name)).truncate());
            if material.shapes > 1 {
                ui.weak(format!("shared by {} shapes", material.shapes));
                let own = ui.button("Make its own").on_hover_text("Edits then change this shape alone");
                if own.clicked() {
                    state.ask(Command::Edit(SceneEdit::OwnMaterial));
                }
            }
        });
    }
    egui::Grid::new("fields").num_columns(2).min_col_width(96.0).show(ui, |ui| {
        for field in &inspection.fields {
            // A text under edit belongs to what is selected, and to nothing that is selected later.
            let salt = egui::Id::unique((format!("{:?}", selection.target), field.id)).value();
            show_field(ui, state, field, salt);
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
fn show_field(ui: &mut egui::Ui, state: &mut State, field: &Field, salt: u64) {
    let label = ui.label(field.label).on_hover_text(field.help).id;
    let mut set = |value: Value, done: bool| {
        state.ask(Command::Edit(SceneEdit::SetField { field: field.id, value, done }));
    };
    match (&field.control, field.value) {
        (Control::Number { min, max, logarithmic }, Value::Number(value)) => {
            match show_number(ui, field, salt, value, (*min, *max, *logarithmic)) {
                Some(Change::Moving(number)) => set(Value::Number(number), false),
                Some(Change::Done(number)) => set(Value::Number(number), true),
                None => {}
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

/// A slider where the range is of use, and a field.
fn show_number(
    ui: &mut egui::Ui,
    field: &Field,
    salt: u64,
    value: f64,
    (min, max, logarithmic): (f64, f64, bool),
) -> Option<Change> {
    // What is nothing but rounding is no negative number.
    let value = if value.abs() < 1e-12 { 0.0 } else { value };
    let has_slider = logarithmic || max - min <= 1000.0;
    let speed = if has_slider && !logarithmic { (max - min) * 1e-3 } else { (value.abs() * 0.005).max(1e-4) };
    let number = Number::new(field.label, min..=max).salt(salt).unit(field.unit).speed(speed);
    let (response, change) = ui
        .horizontal(|ui| {
            if has_slider {
                let slider = Slider::new(field.label, min..=max).logarithmic(logarithmic);
                let ([slider, field], change) = slider.salt(salt).show(ui, number, value);
                (slider | field, change)
            } else {
                number.wide().show(ui, value)
            }
        })
        .inner;
    response.on_hover_text(field.help);
    change
}
