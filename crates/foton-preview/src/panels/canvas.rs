//! The picture in the middle: where it lies, what the pointer does to it, and what is drawn over it.

use std::sync::Arc;

use egui::{Pos2, Rect, Sense, Vec2};
use foton_edit::DragMode;
use foton_session::engine::{Command, Gesture, Picture as EnginePicture, SceneEdit};

use super::film_place::{Film, place};
use super::{dot_legend, legend, overlay, pixel_values, region};
use crate::difference::Difference;
use crate::looking::Compare;
use crate::present::{self, Mode, PresentCallback, View};
use crate::state::{Grip, Placement, State};

/// Radians that the camera turns for each point that the pointer moves.
const TURN: f64 = 0.006;

/// How near the wipe's line the pointer must be to take it, in points.
const WIPE_REACH: f32 = 6.0;

/// A wheel or key counts as over after this many seconds.
const STILL: f64 = 0.25;

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
        point(ui, state, &response, Film { rect, image, size });
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
    region::draw(&painter, state, film);
    if state.show_photons {
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

/// What the pointer does.
fn point(ui: &egui::Ui, state: &mut State, response: &egui::Response, film: Film) {
    let (modifiers, now) = ui.input(|i| (i.modifiers, i.time));
    if response.clicked() {
        ui.memory_mut(|m| m.request_focus(response.id));
    }
    probe(state, response, film);
    wheel(ui, state, response, film, now);
    if response.double_clicked() {
        state.placement = Placement::FIT;
    } else if response.clicked()
        && let Some(at) = response.interact_pointer_pos()
    {
        state.ask(Command::Choose(Some(film.to_film(at))));
    }
    let mut by = response.drag_delta();
    if response.drag_started()
        && let Some(at) = ui.input(|i| i.pointer.press_origin())
    {
        begin(state, response, film, at, modifiers);
        // All of the way since the button went down: what was before the drag, some of it in the same frame, counts too.
        by = response.interact_pointer_pos().unwrap_or(at) - at;
    }
    if response.dragged() {
        go_on(state, response, film, by);
    }
    if response.drag_stopped() {
        end(state, response, film);
    }
    if state.grip == Grip::None && state.moved_at.is_some_and(|at| now - at > STILL) {
        state.moved_at = None;
        state.ask(Command::Moving(false));
    } else if state.moved_at.is_some() {
        ui.ctx().request_repaint_after(std::time::Duration::from_secs_f64(STILL));
    }
}

fn probe(state: &mut State, response: &egui::Response, film: Film) {
    let pixel = response.hover_pos().and_then(|at| film.pixel(at));
    if pixel != state.probed {
        state.probed = pixel;
        state.ask(Command::Probe(pixel));
    }
}

/// The wheel moves the camera to and fro; with Ctrl it zooms the image.
fn wheel(ui: &egui::Ui, state: &mut State, response: &egui::Response, film: Film, now: f64) {
    let Some(at) = response.hover_pos() else { return };
    let (scroll, zoom) = ui.input(|i| (i.smooth_scroll_delta().y, i.zoom_delta()));
    if zoom != 1.0 {
        zoom_image(state, film, at, zoom);
    } else if scroll != 0.0 {
        state.moved_at = Some(now);
        let factor = f64::from(-scroll * 0.002).exp();
        state.ask(Command::Camera { gesture: Gesture::Zoom(factor), moving: true });
    }
}

/// Zooms about a point of the window.
fn zoom_image(state: &mut State, film: Film, at: Pos2, factor: f32) {
    let scale = (film.scale() * factor).clamp(0.02, 256.0);
    let [x, y] = film.to_film(at);
    let under = Vec2::new(x as f32, y as f32);
    // What is under the pointer stays there.
    let centre = (under * scale + (film.rect.center() - at)) / (film.size * scale);
    state.placement = Placement { zoom: Some(scale), centre: centre.into() };
}

fn begin(state: &mut State, response: &egui::Response, film: Film, at: Pos2, modifiers: egui::Modifiers) {
    let wipe = film.rect.left() + film.rect.width() * state.wipe;
    let over_chosen = state
        .frame
        .as_ref()
        .and_then(|f| f.selection.as_ref())
        .is_some_and(|s| overlay::holds(&s.outline, film.to_film(at)));
    let on_handle =
        state.frame.as_ref().and_then(|f| f.selection.as_ref()).is_some_and(|s| {
            overlay::handle(&s.outline).is_some_and(|h| film.to_points(h).distance(at) < 12.0)
        });
    let wipes = state.pinned.is_some() && state.looking.compare == Compare::Wipe;
    state.grip = if wipes && (at.x - wipe).abs() < WIPE_REACH {
        Grip::Wipe
    } else if modifiers.command || response.dragged_by(egui::PointerButton::Middle) {
        Grip::Image
    } else if modifiers.shift || response.dragged_by(egui::PointerButton::Secondary) {
        Grip::Pan
    } else if over_chosen || on_handle {
        let mode = if on_handle || modifiers.alt { DragMode::Vertical } else { DragMode::Horizontal };
        state.ask(Command::Edit(SceneEdit::BeginDrag { film: film.to_film(at), mode }));
        Grip::Object
    } else {
        Grip::Orbit
    };
}

fn go_on(state: &mut State, response: &egui::Response, film: Film, by: Vec2) {
    if by == Vec2::ZERO {
        return;
    }
    let (x, y) = (f64::from(by.x), f64::from(by.y));
    let camera = |gesture| Command::Camera { gesture, moving: true };
    match state.grip {
        Grip::None => {}
        Grip::Orbit => state.ask(camera(Gesture::Orbit { yaw: -x * TURN, pitch: -y * TURN })),
        Grip::Pan => {
            let pixels = f64::from(film.scale()).recip();
            state.ask(camera(Gesture::Pan { right: -x * pixels, down: -y * pixels }));
        }
        Grip::Image => {
            let centre = Vec2::from(state.placement.centre) - by / film.image.size();
            state.placement = Placement { zoom: Some(film.scale()), centre: centre.into() };
        }
        Grip::Object => {
            if let Some(at) = response.interact_pointer_pos() {
                state.ask(Command::Edit(SceneEdit::DragTo(film.to_film(at))));
            }
        }
        Grip::Wipe => {
            if let Some(at) = response.interact_pointer_pos() {
                state.wipe = ((at.x - film.rect.left()) / film.rect.width()).clamp(0.02, 0.98);
            }
        }
    }
}

fn end(state: &mut State, response: &egui::Response, film: Film) {
    match std::mem::take(&mut state.grip) {
        Grip::Orbit | Grip::Pan => state.ask(Command::Moving(false)),
        Grip::Object => {
            let at = response.interact_pointer_pos().unwrap_or(film.image.center());
            state.ask(Command::Edit(SceneEdit::EndDrag(film.to_film(at))));
        }
        Grip::None | Grip::Image | Grip::Wipe => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zooming_keeps_what_is_under_the_pointer_and_fitting_shows_all() {
        let view = Rect::from_min_size(Pos2::new(100.0, 50.0), Vec2::new(800.0, 600.0));
        let size = Vec2::new(400.0, 400.0);
        let image = place(view, size, Placement::FIT);
        assert_eq!((image.height(), image.center()), (600.0, view.center()));
        let mut state = State::new(crate::preferences::Preferences::default(), Vec::new());
        let at = Pos2::new(333.0, 222.0);
        let film = Film { rect: view, image, size };
        let before = film.to_film(at);
        zoom_image(&mut state, film, at, 7.0);
        let film = Film { image: place(view, size, state.placement), ..film };
        let after = film.to_film(at);
        assert!(
            (before[0] - after[0]).abs() < 1e-3 && (before[1] - after[1]).abs() < 1e-3,
            "{before:?} {after:?}"
        );
        assert!((film.scale() / (600.0 / 400.0) - 7.0).abs() < 1e-4);
    }
}
