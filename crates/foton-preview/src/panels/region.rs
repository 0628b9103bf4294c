//! A part of the image to render alone: dragged out over the picture, shown by its frame.

use egui::{Align2, Color32, FontId, Pos2, Rect, Stroke, StrokeKind};
use foton_session::engine::{Command, Configuration, Region};

use super::film_place::Film;
use crate::looking::Choosing;
use crate::state::State;

/// A part of fewer pixels a side was a slip of the hand.
const LEAST: u32 = 4;

const EDGE: Color32 = Color32::from_rgb(120, 220, 255);

/// The entry of a menu that begins it, or renders all of the image again.
pub(super) fn entry(ui: &mut egui::Ui, state: &mut State) {
    let frame = state.frame.as_ref();
    let is_chosen = frame.is_some_and(|f| f.region.is_some());
    let label = if is_chosen { "Render the whole image" } else { "Render a region…" };
    let entry = ui.add_enabled(frame.is_some(), egui::Button::new(label)).on_hover_text(
        "A part of the image, dragged out over the picture, is rendered alone, as `foton render --region` does. Restarts the render",
    );
    state.place("region entry", &entry);
    if entry.clicked() && is_chosen {
        configure(state, None);
    } else if entry.clicked() {
        state.looking.choosing_region = Some(Choosing::default());
        state.notice("Drag out the part of the image to render; Esc gives up");
    }
}

/// Takes the pointer while a region is being chosen. Whether it did.
pub(super) fn drag(ui: &egui::Ui, state: &mut State, response: &egui::Response, film: Film) -> bool {
    let Some(mut choosing) = state.looking.choosing_region else { return false };
    ui.ctx().set_cursor_icon(egui::CursorIcon::Crosshair);
    if response.drag_started()
        && let Some(at) = ui.input(|i| i.pointer.press_origin())
    {
        choosing.from = Some(film.to_film(at));
    }
    if let Some(at) = response.interact_pointer_pos() {
        choosing.to = film.to_film(at);
    }
    state.looking.choosing_region = Some(choosing);
    if response.drag_stopped()
        && let Some(from) = choosing.from
    {
        state.looking.choosing_region = None;
        match between(from, choosing.to, film) {
            Some(region) => configure(state, Some(region)),
            None => state.notice(format!("A region has at least {LEAST} × {LEAST} pixels")),
        }
    }
    true
}

/// The pixels between two positions, as far as they are of the image.
fn between(from: [f64; 2], to: [f64; 2], film: Film) -> Option<Region> {
    let size = [film.size.x, film.size.y].map(f64::from);
    let span = |i: usize| {
        let (low, high) = (from[i].min(to[i]).max(0.0).floor(), from[i].max(to[i]).min(size[i]).ceil());
        (low as u32, (high - low).max(0.0) as u32)
    };
    let ((x, width), (y, height)) = (span(0), span(1));
    (width >= LEAST && height >= LEAST).then_some(Region { x, y, width, height })
}

fn configure(state: &mut State, region: Option<Region>) {
    let Some(frame) = &state.frame else { return };
    state.ask(Command::Configure(Configuration::of(&frame.settings, frame.threads, region)));
    state.draft = None;
}

/// Draws what is dragged out, and the frame of what is rendered where that is not all of the image.
pub(super) fn draw(painter: &egui::Painter, state: &State, film: Film) {
    let stroke = Stroke::new(1.5, EDGE);
    if let Some(Choosing { from: Some(from), to }) = state.looking.choosing_region {
        let corner = |at: [f64; 2]| film.to_points(at.map(|v| v as f32));
        let rect = Rect::from_two_pos(corner(from), corner(to)).intersect(film.image);
        painter.rect_filled(rect, 0.0, EDGE.gamma_multiply(0.12));
        painter.rect_stroke(rect, 0.0, stroke, StrokeKind::Inside);
        if let Some(Region { width, height, .. }) = between(from, to, film) {
            label(painter, rect.left_bottom(), &format!("{width} × {height} pixels"));
        }
        return;
    }
    let Some(region) = state.frame.as_ref().and_then(|f| f.region) else { return };
    let rect = place(film, region);
    painter.rect_stroke(rect.expand(1.5), 0.0, stroke, StrokeKind::Outside);
    label(painter, rect.left_bottom(), &format!("region {region}"));
}

fn label(painter: &egui::Painter, at: Pos2, text: &str) {
    let galley = painter.layout_no_wrap(text.to_owned(), FontId::proportional(12.0), Color32::WHITE);
    let corner = Align2::LEFT_TOP.anchor_size(at + egui::vec2(2.0, 6.0), galley.size()).min;
    let back = Rect::from_min_size(corner, galley.size()).expand(3.0);
    painter.rect_filled(back, 3.0, Color32::from_black_alpha(190));
    painter.galley(corner, galley, Color32::WHITE);
}

/// Where a part of the image is in the window.
pub(super) fn place(film: Film, region: Region) -> Rect {
    let Region { x, y, width, height } = region;
    let corner = |x: u32, y: u32| film.to_points([x as f32, y as f32]);
    Rect::from_min_max(corner(x, y), corner(x + width, y + height))
}
