//! Handles over the picture: how they look, which one is under the pointer, and taking hold of it.

use egui::{Color32, Pos2, Shape, Stroke};
use foton_edit::{Gizmo, Handle, HandleShape, Tool, nearest};
use foton_session::engine::{Command, Frame, SceneEdit};

use super::film_place::Film;
use crate::state::{Grip, State};

/// From the middle of the handles to their ends, in points.
const REACH: f32 = 84.0;

/// How near a line of a handle the pointer must be to take it, in points.
const NEAR: f32 = 7.0;

/// Colours of the axes, and of what belongs to none.
const AXES: [Color32; 3] =
    [Color32::from_rgb(235, 80, 80), Color32::from_rgb(110, 200, 70), Color32::from_rgb(80, 140, 255)];
const MIDDLE: Color32 = Color32::from_rgb(255, 200, 90);
const HELD: Color32 = Color32::from_rgb(255, 240, 130);

fn reach(film: Film) -> f64 {
    f64::from(REACH / film.scale())
}

fn gizmo(state: &State) -> Option<Gizmo> {
    state.frame.as_ref()?.selection.as_ref()?.gizmo
}

/// The tool whose handles are shown: the one that was picked, or where it can do nothing the first that can.
pub(super) fn tool(state: &State, gizmo: &Gizmo) -> Tool {
    let picked = state.editing.tool;
    if gizmo.has(picked) { picked } else { Tool::ALL.into_iter().find(|t| gizmo.has(*t)).unwrap_or(picked) }
}

fn handles(state: &State, gizmo: &Gizmo, film: Film) -> Vec<HandleShape> {
    gizmo.handles(tool(state, gizmo), reach(film))
}

fn at(state: &State, film: Film, at: Pos2) -> Option<Handle> {
    let gizmo = gizmo(state)?;
    nearest(&handles(state, &gizmo, film), film.to_film(at), f64::from(NEAR / film.scale()))
}

/// Whether drags go in round steps now.
pub(super) const fn snaps(state: &State, modifiers: egui::Modifiers) -> bool {
    state.editing.snap != modifiers.command
}

/// Notes the handle under the pointer.
pub(super) fn point(ui: &egui::Ui, state: &mut State, response: &egui::Response, film: Film) {
    if state.grip == Grip::Object {
        ui.ctx().set_cursor_icon(egui::CursorIcon::Grabbing);
        return;
    }
    note_places(state, film);
    state.editing.handle = response.hover_pos().and_then(|pointer| at(state, film, pointer));
    if (state.editing.aiming || state.editing.focusing) && response.hovered() {
        ui.ctx().set_cursor_icon(egui::CursorIcon::Crosshair);
    } else if state.editing.handle.is_some() {
        ui.ctx().set_cursor_icon(egui::CursorIcon::Grab);
    }
}

/// Remembers where the ends of handles are.
fn note_places(state: &mut State, film: Film) {
    let Some(gizmo) = gizmo(state) else { return };
    for shape in handles(state, &gizmo, film) {
        if let (Some(axis), Some([_, end])) = (shape.handle.axis(), shape.lines.last()) {
            let place = egui::Rect::from_center_size(film.to_points(*end), egui::Vec2::splat(4.0));
            state
                .places
                .push((format!("handle {}", ["x", "y", "z"][usize::from(axis.min(2))]).into(), place));
        }
    }
}

/// Takes hold of the handle at a point, if there is one.
pub(super) fn take(state: &mut State, film: Film, from: Pos2) -> bool {
    let Some(handle) = at(state, film, from) else { return false };
    state.editing.handle = Some(handle);
    let (film, reach) = (film.to_film(from), reach(film));
    state.ask(Command::Edit(SceneEdit::BeginDrag { handle, film, reach }));
    true
}

/// Draws the handles, and how far a drag is.
pub(super) fn draw(painter: &egui::Painter, state: &State, frame: &Frame, film: Film) {
    let Some(selection) = &frame.selection else { return };
    let Some(gizmo) = &selection.gizmo else { return };
    let held = state.editing.handle;
    for shape in handles(state, gizmo, film) {
        // While one is dragged, the others are in the way.
        if state.grip == Grip::Object && held != Some(shape.handle) {
            continue;
        }
        draw_handle(painter, &shape, held == Some(shape.handle), film);
    }
    if let Some(words) = &selection.drag {
        let [x, y] = gizmo.film().map(|v| v as f32);
        let at = film.to_points([x, y]) + egui::vec2(14.0, 18.0);
        label(painter, at, words);
    }
}

fn draw_handle(painter: &egui::Painter, shape: &HandleShape, is_held: bool, film: Film) {
    let own = shape.handle.axis().map_or(MIDDLE, |axis| AXES[usize::from(axis.min(2))]);
    let colour = if is_held { HELD } else { own };
    let width = if is_held { 3.5 } else { 2.4 };
    for line in &shape.lines {
        let ends = line.map(|end| film.to_points(end));
        // Seen on white and on black.
        painter.line_segment(ends, Stroke::new(width + 1.6, Color32::from_black_alpha(110)));
        painter.line_segment(ends, Stroke::new(width, colour));
    }
    if shape.area.len() > 2 {
        let fill = if matches!(shape.handle, Handle::MovePlane(_)) && !is_held {
            colour.gamma_multiply(0.45)
        } else {
            colour
        };
        let corners = shape.area.iter().map(|c| film.to_points(*c)).collect();
        painter.add(Shape::convex_polygon(corners, fill, Stroke::new(1.0, Color32::from_black_alpha(140))));
    }
}

fn label(painter: &egui::Painter, at: Pos2, text: &str) {
    let font = egui::FontId::monospace(13.0);
    let galley = painter.layout_no_wrap(text.to_owned(), font, Color32::WHITE);
    let back = egui::Rect::from_min_size(at, galley.size()).expand2(egui::vec2(6.0, 3.0));
    painter.rect_filled(back, 3.0, Color32::from_black_alpha(170));
    painter.galley(at, galley, Color32::WHITE);
}
