//! The camera: its field of view, and the way back.

use egui::Ui;
use foton_edit::ViewSide;
use foton_session::engine::{Command, Gesture};

use super::number::{Change, Digits, Number};
use super::slider::Slider;
use super::widgets::{row, tight};
use crate::state::State;

const HELP: &str = "Angle of view along the camera's own axis, 1° to 170°";

pub(super) fn show(ui: &mut Ui, state: &mut State) {
    let sensor = state.frame.as_ref().and_then(|f| f.scene.sensors.get(f.settings.sensor));
    let Some(degrees) = sensor.map(|s| s.fov_degrees) else { return };
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
    sides(ui, state);
    if ui.button("Reset camera").on_hover_text("Back to where the scene's file has it (H)").clicked() {
        state.ask(Command::ResetCamera);
    }
}

/// Views along the axes.
pub(super) fn sides(ui: &mut Ui, state: &mut State) {
    const HELP: &str = "Looks along an axis at what the camera turns around, from the same distance. The camera stays a perspective one; \
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
