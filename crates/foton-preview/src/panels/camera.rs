//! The camera: its field of view, its lens, and the way back.

use std::ops::RangeInclusive;

use egui::Ui;
use foton_edit::{LENS, ViewSide};
use foton_session::engine::{Command, Gesture};

use super::number::{Change, Digits, Number};
use super::slider::Slider;
use super::widgets::{row, tight};
use crate::state::State;

/// The largest lens that the slider offers, the nearest focus and the farthest, as shares of half the scene's size; and the largest
/// numbers that may be typed.
const WIDEST: f64 = 0.1;
const NEAREST: f64 = 0.01;
const FARTHEST: f64 = 10.0;
const MOST: f64 = 1e6;

const HELP: &str = "Angle of view along the camera's own axis, 1° to 170°";

pub(super) fn show(ui: &mut Ui, state: &mut State) {
    let sensor = state.frame.as_ref().and_then(|f| f.scene.sensors.get(f.settings.sensor));
    let Some((degrees, width)) = sensor.map(|s| (s.fov_degrees, s.width)) else { return };
    match width {
        Some(width) => show_width(ui, state, width),
        None => field_of_view(ui, state, degrees),
    }
    lens(ui, state);
    sides(ui, state);
    if ui.button("Reset camera").on_hover_text("Back to where the scene's file has it (H)").clicked() {
        state.ask(Command::ResetCamera);
    }
}

fn field_of_view(ui: &mut Ui, state: &mut State, degrees: f64) {
    row(ui, "Field of view", HELP, |ui, _| {
        let number =
            Number::new("Field of view", 1.0..=170.0).unit("°").digits(Digits::Decimals(1)).speed(0.2);
        let ([slider, field], change) = Slider::new("Field of view", 1.0..=170.0).show(ui, number, degrees);
        (slider | field).on_hover_text(HELP);
        let turn = |degrees, moving| Command::Camera { gesture: Gesture::FieldOfView(degrees), moving };
        match change {
            Some(Change::Moving(degrees)) => state.ask(turn(degrees, true)),
            Some(Change::Done(degrees)) => state.ask(turn(degrees, false)),
            None => {}
        }
    });
}

/// How much an orthographic camera sees.
fn show_width(ui: &mut Ui, state: &mut State, width: f64) {
    const HELP: &str = "How wide the image is in the scene's units. This camera has no perspective; the mouse wheel changes it too";
    row(ui, "Width", HELP, |ui, _| {
        let number = Number::new("Width", f64::MIN_POSITIVE..=MOST).speed(1e-3 * width);
        let size = state.frame.as_ref().map_or(1.0, |f| f.scene.radius);
        let slider = Slider::new("Width", NEAREST * size..=FARTHEST * size).logarithmic(true);
        let ([slider, field], change) = slider.show(ui, number, width);
        (slider | field).on_hover_text(HELP);
        let turn = |width, moving| Command::Camera { gesture: Gesture::Width(width), moving };
        match change {
            Some(Change::Moving(width)) => state.ask(turn(width, true)),
            Some(Change::Done(width)) => state.ask(turn(width, false)),
            None => {}
        }
    });
}

/// Views along the axes.
pub(super) fn sides(ui: &mut Ui, state: &mut State) {
    const HELP: &str = "Looks along an axis at what the camera turns around, from the same distance. A perspective camera stays one; \
                        a narrow field of view from afar comes near to an orthographic view";
    row(ui, "View from", HELP, |ui, _| {
        tight(ui);
        for side in ViewSide::ALL {
            if ui.button(side.name()).on_hover_text(HELP).clicked() {
                state.ask(Command::Camera { gesture: Gesture::Face(side), moving: false });
            }
        }
    });
}

/// How wide the lens is, and what it shows sharp.
fn lens(ui: &mut Ui, state: &mut State) {
    let Some(frame) = &state.frame else { return };
    let Some(lens) = frame.scene.sensors.get(frame.settings.sensor).map(|s| s.lens) else { return };
    let [aperture, focus] = LENS.map(|p| (p.label, p.help));
    let (size, radius) = (frame.scene.radius, lens.map_or(0.0, |lens| lens.aperture_radius));
    let turn = |gesture: fn(f64) -> Gesture, change: Change| match change {
        Change::Moving(value) => Command::Camera { gesture: gesture(value), moving: true },
        Change::Done(value) => Command::Camera { gesture: gesture(value), moving: false },
    };
    let line = |ui: &mut Ui, (label, help): (&str, &str), range: RangeInclusive<f64>, value: f64| {
        row(ui, label, help, |ui, _| {
            let least = if *range.start() > 0.0 { f64::MIN_POSITIVE } else { 0.0 };
            let number = Number::new(label, least..=MOST).speed(1e-3 * size);
            let slider = Slider::new(label, range).logarithmic(true);
            let ([slider, field], change) = slider.show(ui, number, value);
            (slider | field).on_hover_text(help);
            change
        })
    };
    let change = line(ui, aperture, 0.0..=WIDEST * size, radius);
    state.outbox.extend(change.map(|change| turn(Gesture::Aperture, change)));
    ui.add_enabled_ui(radius > 0.0, |ui| {
        let distance = lens.map_or(0.0, |lens| lens.focus_distance);
        let change = line(ui, focus, NEAREST * size..=FARTHEST * size, distance);
        state.outbox.extend(change.map(|change| turn(Gesture::FocusDistance, change)));
        let pick = egui::Button::new("Focus on a point").selected(state.editing.focusing);
        let pick =
            ui.add(pick).on_hover_text("The next click in the picture says what is sharp; Esc leaves it");
        if pick.clicked() {
            state.editing.focusing = !state.editing.focusing;
        }
    });
}
