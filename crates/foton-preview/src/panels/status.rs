//! The line at the bottom: what goes on, the pass, the error, the time left, and the pixel under the pointer.

use egui::{Align, Label, Layout, RichText, Ui, Vec2};
use foton_session::engine::{Activity, Frame, Probe, SurfaceNames};

use super::convergence::{self, Left, duration};
use super::text::{grouped, percent, short};
use crate::state::State;

pub(super) fn show(ui: &mut Ui, state: &State) {
    ui.horizontal(|ui| {
        let Some(frame) = &state.frame else {
            ui.weak("No scene");
            return;
        };
        cell(ui, 140.0, &activity(frame));
        ui.separator();
        let pass = cell(ui, 76.0, &format!("Pass {}", grouped(frame.stats.passes)));
        progress(ui, pass, frame.pass_share as f32);
        ui.separator();
        let error =
            frame.stats.error.map_or_else(|| "Error –".to_owned(), |e| format!("Error {}", percent(e.total)));
        cell(ui, 92.0, &error);
        ui.separator();
        cell(ui, 128.0, &time_left(state));
        ui.separator();
        if let Some(age) = frame.checkpoint_age {
            cell(ui, 116.0, &format!("Checkpoint {} old", duration(age.as_secs_f64())));
            ui.separator();
        }
        let probe = frame.probe.as_ref().filter(|p| Some(p.pixel) == state.probed);
        let rest = probe.map_or_else(|| frame.scene.title.clone(), probed);
        ui.with_layout(Layout::left_to_right(Align::Center), |ui| ui.add(Label::new(rest).truncate()));
    });
}

/// Words in a cell of constant width: what changes beside it moves nothing.
fn cell(ui: &mut Ui, width: f32, text: &str) -> egui::Rect {
    let size = Vec2::new(width, ui.spacing().interact_size.y);
    let cell = ui.allocate_ui_with_layout(size, Layout::left_to_right(Align::Center), |ui| {
        ui.set_min_width(width);
        if text.is_empty() {
            return;
        }
        ui.add(Label::new(RichText::new(text)).truncate());
    });
    cell.response.rect
}

/// A line under a cell, as long as what is done.
fn progress(ui: &mut Ui, cell: egui::Rect, share: f32) {
    let line =
        egui::Rect::from_min_size(cell.left_bottom() - Vec2::new(0.0, 1.0), Vec2::new(cell.width(), 2.0));
    let done = line.with_max_x(line.left() + line.width() * share.clamp(0.0, 1.0));
    ui.painter().rect_filled(line, 1.0, ui.visuals().widgets.inactive.bg_fill);
    ui.painter().rect_filled(done, 1.0, ui.visuals().selection.bg_fill);
    let response = ui.interact(cell, ui.scope_id().with("pass"), egui::Sense::hover());
    let words = format!("Pass under way: {:.0} % done", 100.0 * share);
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::ProgressIndicator, true, &words));
    response.on_hover_text(words);
}

/// The time left; nothing where it is not known, or where nothing goes on.
fn time_left(state: &State) -> String {
    let goes_on = state.frame.as_ref().is_some_and(|f| f.activity == Activity::Rendering);
    match convergence::left(state).filter(|_| goes_on) {
        Some(Left::ToStop(seconds)) => format!("{} left", duration(seconds)),
        Some(Left::ToError(seconds, goal)) => {
            format!("{} to error {} %", duration(seconds), 100.0 * goal)
        }
        None => String::new(),
    }
}

fn activity(frame: &Frame) -> String {
    match frame.activity {
        Activity::Empty => "No scene".to_owned(),
        Activity::Moving => "Moving".to_owned(),
        Activity::Building => "Building the scene…".to_owned(),
        Activity::Collecting => match frame.collecting {
            Some(share) => format!("Hit points {:.0} %", share * 100.0),
            None => "Collecting hit points…".to_owned(),
        },
        Activity::Rendering => match share_done(frame) {
            Some(share) => format!("Rendering {:.0} %", share * 100.0),
            None => "Rendering".to_owned(),
        },
        Activity::Paused => "Paused".to_owned(),
        Activity::Done => "Done".to_owned(),
    }
}

fn share_done(frame: &Frame) -> Option<f64> {
    let n = &frame.stats;
    frame.stop.fraction(n.passes, n.elapsed, n.error.as_ref())
}

/// What is known of a pixel.
fn probed(probe: &Probe) -> String {
    let c = probe.radiance;
    let [r, g, b] = [c.r, c.g, c.b].map(|v| short(f64::from(v)));
    let mut text = format!("({}, {})  {r} {g} {b} W/m²/sr", probe.pixel[0], probe.pixel[1]);
    if let Some(radius) = probe.radius {
        text += &format!("  r {}  N {}", short(radius), grouped(probe.photons_found));
    }
    if let Some(distance) = probe.distance {
        text += &format!("  depth {}", short(distance));
    }
    if let Some(SurfaceNames { shape, material }) = &probe.surface {
        text += &format!("  {shape} · {material}");
    }
    text
}
