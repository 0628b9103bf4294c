//! The fields of what is selected, all of them editable live: where it is first, then what it is made of, and last what only those
//! set who know the physics.

use egui::Ui;
use foton_edit::{Control, Field, FieldId, Make, Property, Value};
use foton_session::engine::{Command, SceneEdit, Selection};

use super::actions;
use super::number::{Change, Digits, Number};
use super::slider::Slider;
use super::widgets::row;
use crate::state::State;

/// Names of three fields that share a line.
const TRIPLES: [(&str, &str, &str); 3] = [
    ("Position", "units", "Of its middle, in the world: X, Y and Z"),
    ("Rotation", "°", "About its middle: first Z, then Y, then X, axes of the world"),
    ("Length", "units", "Along its own X, Y and Z, before it is turned"),
];

/// The line that a field belongs to, and its axis.
const fn triple(id: FieldId) -> Option<(usize, u8)> {
    match id {
        FieldId::Position(axis) => Some((0, axis)),
        FieldId::Rotation(axis) => Some((1, axis)),
        FieldId::Extent(axis) => Some((2, axis)),
        _ => None,
    }
}

pub(super) fn show(ui: &mut Ui, state: &mut State, selection: &Selection) {
    let fields = &selection.inspection.fields;
    // A text under edit belongs to what is selected, and to nothing that is selected later.
    let salt = |field: &Field| egui::Id::unique((format!("{:?}", selection.target), field.id)).value();
    for (line, (name, unit, help)) in TRIPLES.into_iter().enumerate() {
        let members: Vec<&Field> =
            fields.iter().filter(|f| triple(f.id).is_some_and(|t| t.0 == line)).collect();
        if !members.is_empty() {
            show_triple(ui, state, (name, unit, help), &members, &salt);
        }
    }
    let single =
        |advanced: bool| fields.iter().filter(move |f| triple(f.id).is_none() && f.is_advanced == advanced);
    let grid = |ui: &mut Ui, state: &mut State, advanced: bool| {
        egui::Grid::new(("fields", advanced)).num_columns(2).min_col_width(96.0).show(ui, |ui| {
            for field in single(advanced) {
                show_field(ui, state, field, salt(field));
                ui.end_row();
            }
        });
    };
    grid(ui, state, false);
    if single(true).next().is_some() {
        let advanced = egui::CollapsingHeader::new("Advanced").id_salt("advanced fields");
        advanced.show_unindented(ui, |ui| grid(ui, state, true));
    }
}

/// Digits of a number that there is room for in a third of a line; what is too small for decimals is written as it is.
fn digits(value: f64) -> Digits {
    let size = value.abs();
    if size > 0.0 && size < 1e-3 {
        return Digits::Significant;
    }
    let before_point = 1 + size.max(1.0).log10().floor() as usize + usize::from(value < 0.0);
    Digits::Decimals(4_usize.saturating_sub(before_point).min(3))
}

/// Three numbers in one line, each with the name of its axis.
fn show_triple(
    ui: &mut Ui,
    state: &mut State,
    (name, unit, help): (&str, &str, &str),
    fields: &[&Field],
    salt: &impl Fn(&Field) -> u64,
) {
    row(ui, name, &format!("{help} ({unit})"), |ui, _| {
        ui.spacing_mut().item_spacing.x = 3.0;
        let width = ((ui.available_width() - 6.0) / 3.0).max(36.0);
        for field in fields {
            let (Control::Number { min, max, .. }, Value::Number(value)) = (&field.control, field.value)
            else {
                continue;
            };
            // What is nothing but rounding is no negative number.
            let value = if value.abs() < 1e-12 { 0.0 } else { value };
            let speed = if unit == "°" { 0.5 } else { (value.abs() * 0.005).max(1e-3) };
            let number = Number::new(field.label, *min..=*max).salt(salt(field)).speed(speed).width(width);
            let number = number.digits(digits(value));
            let (response, change) = number.show(ui, value);
            response.on_hover_text(format!("{}: {help}", field.label));
            let (value, done) = match change {
                Some(Change::Moving(value)) => (value, false),
                Some(Change::Done(value)) => (value, true),
                None => continue,
            };
            let value = Value::Number(value);
            state.ask(Command::Edit(SceneEdit::SetField { field: field.id, value, done }));
        }
    });
}

/// A row: the label, then the control that it names.
fn show_field(ui: &mut Ui, state: &mut State, field: &Field, salt: u64) {
    let label = ui.add(egui::Label::new(field.label).truncate()).on_hover_text(field.help).id;
    let set = |state: &mut State, value: Value, done: bool| {
        state.ask(Command::Edit(SceneEdit::SetField { field: field.id, value, done }));
    };
    match (&field.control, field.value) {
        (Control::Number { min, max, logarithmic }, Value::Number(value)) => {
            match show_number(ui, field, salt, value, (*min, *max, *logarithmic)) {
                Some(Change::Moving(number)) => set(state, Value::Number(number), false),
                Some(Change::Done(number)) => set(state, Value::Number(number), true),
                None => {}
            }
        }
        (Control::Colour, Value::Colour(colour)) => {
            let mut linear = colour;
            let response = ui.color_edit_button_rgb(&mut linear).labelled_by(label).on_hover_text(field.help);
            if response.changed() {
                set(state, Value::Colour(linear.map(|c| c.clamp(0.0, 1.0))), true);
            }
        }
        (Control::Choice(options), Value::Choice(chosen)) => {
            let mut picked = None;
            let text = options.get(chosen).map_or("", String::as_str);
            let list = egui::ComboBox::from_id_salt(field.label).selected_text(text).show_ui(ui, |ui| {
                for (i, option) in options.iter().enumerate() {
                    if ui.selectable_label(i == chosen, option).clicked() {
                        picked = Some((i, option));
                    }
                }
            });
            list.response.labelled_by(label).on_hover_text(field.help);
            match (picked, field.id) {
                // Another kind is another material, under a name of its own.
                (Some((kind, name)), FieldId::Material(side, Property::Kind)) if kind != chosen => {
                    actions::remake(state, Make::Kind(side, kind), name);
                }
                (Some((_, _)), FieldId::Material(_, Property::Kind)) => {}
                (Some((i, _)), _) => set(state, Value::Choice(i), true),
                (None, _) => {}
            }
        }
        (Control::Toggle, Value::Toggle(on)) => {
            let mut now = on;
            let response = ui.checkbox(&mut now, "").labelled_by(label).on_hover_text(field.help);
            if response.changed() {
                set(state, Value::Toggle(now), true);
            }
        }
        _ => {}
    }
}

/// A slider where the range is of use, and a field.
fn show_number(
    ui: &mut Ui,
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
