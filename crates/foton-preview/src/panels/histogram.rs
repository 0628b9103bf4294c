//! The histogram of the picture over a corner of it, and the wheel over it or over a control of the exposure.

use std::sync::Arc;

use egui::{Color32, Rect, Sense, Vec2};
use foton_film::Image;
use foton_session::engine::Picture;

use crate::light_scale::{BARS, LightScale, PER_STOP, STOPS};
use crate::state::State;

/// Points of the wheel for a stop.
const WHEEL: f32 = 200.0;

/// Width and height of the histogram.
const SIZE: Vec2 = Vec2::new(256.0, 84.0);

/// Exposures that can be reached.
const LIMIT: f32 = 16.0;

/// The wheel over a control changes the exposure, by tenths of stops.
pub(super) fn turn(ui: &egui::Ui, state: &mut State, response: &egui::Response) {
    if !response.contains_pointer() {
        return;
    }
    let scroll = ui.input_mut(|i| std::mem::take(&mut i.smooth_scroll_delta)).y;
    if scroll != 0.0 {
        state.looking.turned += scroll / WHEEL;
        let tenths = (state.looking.turned * 10.0).trunc();
        state.looking.turned -= tenths / 10.0;
        change(state, tenths / 10.0);
    }
}

fn change(state: &mut State, by: f32) {
    let stops = ((state.exposure_stops + by) * 10.0).round() / 10.0;
    state.exposure_stops = stops.clamp(-LIMIT, LIMIT);
}

/// The radiance on the screen, if it is that.
fn radiance(state: &State) -> Option<Arc<Image>> {
    match state.frame.as_ref()?.picture.as_ref()? {
        Picture::Colour(image) => Some(Arc::clone(image)),
        Picture::Measure { .. } => None,
    }
}

/// How bright a picture is, worked out once.
fn scale<'a>(state: &'a mut State, image: &Arc<Image>) -> &'a LightScale {
    let known = state.looking.light_scale.take().filter(|scale| scale.is_of(image));
    state.looking.light_scale.insert(known.unwrap_or_else(|| LightScale::of(image)))
}

/// The histogram over a corner of the picture, if it is wanted. Dragging it changes the exposure.
pub(super) fn show(ctx: &egui::Context, state: &mut State, canvas: Rect) {
    if !state.looking.show_histogram {
        return;
    }
    let Some(image) = radiance(state) else { return };
    let area = egui::Area::new(egui::Id::unique("histogram")).constrain_to(canvas);
    area.fixed_pos(canvas.left_top() + Vec2::splat(10.0)).show(ctx, |ui| {
        egui::Frame::popup(ui.style()).show(ui, |ui| draw(ui, state, &image));
    });
}

fn draw(ui: &mut egui::Ui, state: &mut State, image: &Arc<Image>) {
    let (rect, response) = ui.allocate_exact_size(SIZE, Sense::drag());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, "Histogram"));
    let per_point = (STOPS.end - STOPS.start) as f32 / rect.width();
    if response.dragged() {
        // What is held goes with the hand.
        state.looking.turned += response.drag_delta().x * per_point;
        let tenths = (state.looking.turned * 10.0).trunc();
        state.looking.turned -= tenths / 10.0;
        change(state, tenths / 10.0);
    }
    turn(ui, state, &response);
    let stops = state.exposure_stops;
    let scale = scale(state, image);
    let painter = ui.painter_at(rect);
    let colour = ui.visuals().text_color();
    // The scale is that of the screen: white stays where it is, and light moves under it.
    let x = |of_light: f32| rect.left() + (of_light + stops - STOPS.start as f32) / per_point;
    let white = rect.left() + (0.0 - STOPS.start as f32) / per_point;
    painter.rect_filled(rect.with_min_x(white), 0.0, Color32::from_rgba_unmultiplied(255, 60, 60, 40));
    let most = scale.bars.iter().copied().fold(1e-6, f32::max);
    for (i, share) in scale.bars.iter().enumerate().filter(|(_, share)| **share > 0.0) {
        let left = x(STOPS.start as f32 + i as f32 / PER_STOP as f32);
        let width = rect.width() / BARS as f32;
        let height = (share / most).sqrt() * rect.height();
        let bar = Rect::from_min_max(
            egui::pos2(left, rect.bottom() - height),
            egui::pos2(left + width, rect.bottom()),
        );
        painter.rect_filled(bar, 0.0, colour.gamma_multiply(0.75));
    }
    for stop in (STOPS.start + 2..STOPS.end).step_by(2) {
        let at = rect.left() + (stop - STOPS.start) as f32 / per_point;
        let height = if stop == 0 { rect.height() } else { 4.0 };
        painter.vline(at, rect.bottom() - height..=rect.bottom(), egui::Stroke::new(1.0, colour));
    }
    let (clipped, dark) = (100.0 * scale.above_white(stops), 100.0 * scale.beyond[0]);
    ui.label(format!("{clipped:.1} % above white, {dark:.1} % without light")).on_hover_text(
        "Pixels by luminance in stops, the line at the luminance that the screen shows as white without a tone map. Drag or turn \
         the wheel to change the exposure",
    );
}
