//! What the pointer does over the picture: it points, selects, drags handles, and moves the camera and the image.

use egui::{Pos2, Vec2};
use foton_session::engine::{Command, Gesture, SceneEdit};

use super::film_place::Film;
use super::gizmo;
use crate::looking::Compare;
use crate::state::{Grip, Placement, State};

/// Radians that the camera turns for each point that the pointer moves.
const TURN: f64 = 0.006;

/// How near the wipe's line the pointer must be to take it, in points.
const WIPE_REACH: f32 = 6.0;

/// A wheel or key counts as over after this many seconds.
const STILL: f64 = 0.25;

/// What the pointer does.
pub(super) fn obey(ui: &egui::Ui, state: &mut State, response: &egui::Response, film: Film) {
    let (modifiers, now) = ui.input(|i| (i.modifiers, i.time));
    if response.clicked() {
        ui.memory_mut(|m| m.request_focus(response.id));
    }
    probe(state, response, film);
    wheel(ui, state, response, film, now);
    gizmo::point(ui, state, response, film);
    // What closes a menu or a list does nothing else.
    if state.editing.is_press_spent {
        if response.drag_started() {
            egui::Popup::close_all(ui.ctx());
        }
        return rest(ui, state, now);
    }
    click(state, response, film);
    let mut by = response.drag_delta();
    if response.drag_started()
        && let Some(at) = ui.input(|i| i.pointer.press_origin())
    {
        begin(state, response, film, at, modifiers);
        // All of the way since the button went down: what was before the drag, some of it in the same frame, counts too.
        by = response.interact_pointer_pos().unwrap_or(at) - at;
    }
    if response.dragged() {
        go_on(state, response, film, by, modifiers);
    }
    if response.drag_stopped() {
        end(state, response, film, modifiers);
    }
    rest(ui, state, now);
}

/// A click selects, focuses the lens, or aims what is selected; two show the whole image. No click moves anything.
fn click(state: &mut State, response: &egui::Response, film: Film) {
    if response.double_clicked() {
        state.placement = Placement::FIT;
    } else if response.clicked()
        && (state.editing.aiming || state.editing.focusing || state.editing.handle.is_none())
        && let Some(at) = response.interact_pointer_pos()
    {
        let at = film.to_film(at);
        let aims = std::mem::take(&mut state.editing.aiming);
        let focuses = std::mem::take(&mut state.editing.focusing);
        state.ask(match (aims, focuses) {
            (true, _) => Command::Edit(SceneEdit::AimAt(at)),
            (false, true) => Command::Camera { gesture: Gesture::FocusAt(at), moving: false },
            (false, false) => Command::Choose(Some(at)),
        });
    }
}

/// Ends a move by wheel or keys a while after the last one.
fn rest(ui: &egui::Ui, state: &mut State, now: f64) {
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
    let wipes = state.pinned.is_some() && state.looking.compare == Compare::Wipe;
    state.grip = if wipes && (at.x - wipe).abs() < WIPE_REACH {
        Grip::Wipe
    } else if response.dragged_by(egui::PointerButton::Primary) && gizmo::take(state, film, at) {
        Grip::Object
    } else if modifiers.command || response.dragged_by(egui::PointerButton::Middle) {
        Grip::Image
    } else if modifiers.shift || response.dragged_by(egui::PointerButton::Secondary) {
        Grip::Pan
    } else {
        Grip::Orbit
    };
}

fn go_on(state: &mut State, response: &egui::Response, film: Film, by: Vec2, modifiers: egui::Modifiers) {
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
                let snap = gizmo::snaps(state, modifiers);
                state.ask(Command::Edit(SceneEdit::DragTo { film: film.to_film(at), snap }));
            }
        }
        Grip::Wipe => {
            if let Some(at) = response.interact_pointer_pos() {
                state.wipe = ((at.x - film.rect.left()) / film.rect.width()).clamp(0.02, 0.98);
            }
        }
    }
}

fn end(state: &mut State, response: &egui::Response, film: Film, modifiers: egui::Modifiers) {
    match std::mem::take(&mut state.grip) {
        Grip::Orbit | Grip::Pan => state.ask(Command::Moving(false)),
        Grip::Object => {
            let at = response.interact_pointer_pos().unwrap_or(film.image.center());
            let snap = gizmo::snaps(state, modifiers);
            state.ask(Command::Edit(SceneEdit::EndDrag { film: film.to_film(at), snap }));
        }
        Grip::None | Grip::Image | Grip::Wipe => {}
    }
}

#[cfg(test)]
mod tests {
    use egui::Rect;

    use super::super::film_place::place;
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
