//! The picture in the middle: where it lies, and what is drawn over it.

use std::sync::Arc;

use egui::{Rect, Sense, Vec2};
use foton_session::engine::Picture as EnginePicture;

use super::film_place::{Film, place};
use super::{dot_legend, gizmo, legend, overlay, pixel_values, pointer, region};
use crate::difference::Difference;
use crate::looking::Compare;
use crate::present::{self, Mode, PresentCallback, View};
use crate::state::State;

pub(super) fn show(ui: &mut egui::Ui, state: &mut State) {
    let (rect, response) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
    state.place("canvas", &response);
    state.canvas = Some(response.id);
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, "Rendered image"));
    let Some(frame) = state.frame.clone() else {
        hint(ui, rect, "Open a scene, or drop a file here");
        return;
    };
    let Some(picture) = &frame.picture else {
        hint(ui, rect, "Collecting the first light…");
        return;
    };
    let size = Vec2::new(frame.size[0] as f32, frame.size[1] as f32);
    let image = place(rect, size, state.placement);
    if !region::drag(ui, state, &response, Film { rect, image, size }) {
        pointer::obey(ui, state, &response, Film { rect, image, size });
    }
    let film = Film { rect, image: place(rect, size, state.placement), size };
    let part = region::place(film, frame.window);
    let difference = difference(state, picture);
    let picture = difference.as_ref().unwrap_or(picture);
    let (mode, scale) = mode(picture);
    paint(ui, state, rect, part, picture, mode);
    let painter = ui.painter_at(rect);
    pixel_values::draw(&painter, state, rect, part, picture);
    overlay::draw(&painter, state, &frame, film);
    gizmo::draw(&painter, state, &frame, film);
    region::draw(&painter, state, film);
    if state.show_photons || state.show_paths {
        dot_legend::draw(&painter, rect);
    }
    let reduction = present::reduction(frame.size, state.largest_texture);
    if reduction > 1 {
        let text = format!(
            "shown at 1/{reduction}: the adapter's textures hold {} pixels a side",
            state.largest_texture
        );
        let font = egui::FontId::proportional(13.0);
        painter.text(
            rect.left_top() + Vec2::splat(8.0),
            egui::Align2::LEFT_TOP,
            text,
            font,
            egui::Color32::WHITE,
        );
    }
    super::hint::draw(ui, state, rect);
    if let Some(scale) = scale {
        legend::draw(&painter, rect, &scale);
    }
}

fn hint(ui: &egui::Ui, rect: Rect, text: &str) {
    let colour = ui.visuals().weak_text_color();
    ui.painter_at(rect).text(
        rect.center(),
        egui::Align2::CENTER_CENTER,
        text,
        egui::FontId::proportional(16.0),
        colour,
    );
}

/// How far the picture is from the pinned one, where that is what is to be seen.
fn difference(state: &mut State, picture: &EnginePicture) -> Option<EnginePicture> {
    let EnginePicture::Colour(pinned) = &state.pinned.as_ref()?.picture else { return None };
    let EnginePicture::Colour(image) = picture else { return None };
    if state.looking.compare != Compare::Difference {
        return None;
    }
    let known = state.looking.difference.take().filter(|known| known.is_of(image, pinned));
    // While things move, the picture is of fewer pixels: the last difference stays away until it can be told again.
    let difference = known.or_else(|| Difference::new(image, pinned))?;
    let plane = Arc::clone(&difference.plane);
    state.looking.difference = Some(difference);
    Some(EnginePicture::Measure { label: "difference (W/m²/sr)", plane })
}

/// How a picture is drawn, and the scale of false colours.
fn mode(picture: &EnginePicture) -> (Mode, Option<legend::Scale>) {
    match picture {
        EnginePicture::Colour(_) => (Mode::Radiance, None),
        EnginePicture::Measure { label, plane } => {
            let scale = legend::Scale::of(label, &plane.values);
            let mode = Mode::FalseColour { low: scale.low, high: scale.high, logarithmic: scale.logarithmic };
            (mode, Some(scale))
        }
    }
}

fn shared(picture: &EnginePicture) -> present::Picture {
    match picture {
        EnginePicture::Colour(image) => present::Picture::Rgb(image.clone()),
        EnginePicture::Measure { plane, .. } => present::Picture::Scalar(plane.clone()),
    }
}

fn paint(ui: &egui::Ui, state: &State, rect: Rect, image: Rect, picture: &EnginePicture, mode: Mode) {
    let to_pixels = ui.ctx().pixels_per_point();
    let view = View {
        exposure_stops: state.exposure_stops,
        tone_map: state.tone_map,
        mode,
        marks_clipping: state.looking.marks_clipping,
        image_rect: Rect::from_min_max(image.min * to_pixels, image.max * to_pixels),
        wipe: state.pinned.as_ref().filter(|_| state.looking.compare == Compare::Wipe).map(|_| state.wipe),
        // White around a picture would make it look darker than it is.
        background: if ui.visuals().dark_mode {
            ui.visuals().extreme_bg_color
        } else {
            egui::Color32::from_gray(200)
        },
    };
    let pinned = state.pinned.as_ref().map(|p| shared(&p.picture));
    let callback = PresentCallback { view, picture: shared(picture), pinned, rect };
    ui.painter().add(egui_wgpu::Callback::new_paint_callback(rect, callback));
}
