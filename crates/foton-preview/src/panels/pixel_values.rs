//! Numbers in the pixels of the picture, once it is zoomed in so far that they fit.

use egui::{Align2, Color32, FontId, Pos2, Rect, Vec2};
use foton_film::tone_map;
use foton_session::engine::Picture;

use super::text::short;
use crate::state::State;

/// Points a pixel from which there is room for one number, and for three.
const ONE: f32 = 24.0;
const THREE: f32 = 44.0;

/// Pixels that get numbers, at most.
const MOST: usize = 4000;

/// Writes them into a picture that lies in `image` of the view.
pub(super) fn draw(painter: &egui::Painter, state: &State, view: Rect, image: Rect, picture: &Picture) {
    let [width, height] = picture.size();
    let cell = Vec2::new(image.width() / width.max(1) as f32, image.height() / height.max(1) as f32);
    if cell.x < ONE {
        return;
    }
    let seen = view.intersect(image);
    let range = |from: f32, to: f32, side: f32, all: u32| {
        let index = |at: f32| (at / side).floor().max(0.0) as u32;
        index(from).min(all)..(index(to) + 1).min(all)
    };
    let columns = range(seen.left() - image.left(), seen.right() - image.left(), cell.x, width);
    let rows = range(seen.top() - image.top(), seen.bottom() - image.top(), cell.y, height);
    if columns.len() * rows.len() > MOST || !seen.is_positive() {
        return;
    }
    for y in rows {
        for x in columns.clone() {
            let middle = image.min + Vec2::new((x as f32 + 0.5) * cell.x, (y as f32 + 0.5) * cell.y);
            write(painter, state, picture, (y * width + x) as usize, middle, cell.x);
        }
    }
}

fn write(painter: &egui::Painter, state: &State, picture: &Picture, index: usize, middle: Pos2, side: f32) {
    let font = FontId::proportional((side * 0.22).clamp(8.0, 13.0));
    match picture {
        Picture::Colour(image) => {
            let Some(&c) = image.pixels.get(index) else { return };
            let [r, g, b] = tone_map::display(c, state.tone_map, state.exposure_stops).map(f32::from);
            let ink = ink(0.299 * r + 0.587 * g + 0.114 * b);
            let text = |v: f32| short(f64::from(v));
            if side < THREE {
                painter.text(middle, Align2::CENTER_CENTER, text(c.luminance()), font, ink);
                return;
            }
            for (i, v) in c.to_array().into_iter().enumerate() {
                let at = middle + Vec2::new(0.0, (i as f32 - 1.0) * (font.size + 2.0));
                painter.text(at, Align2::CENTER_CENTER, text(v), font.clone(), ink);
            }
        }
        Picture::Measure { plane, .. } => {
            let Some(&v) = plane.values.get(index) else { return };
            // Over any colour of the map.
            let galley = painter.layout_no_wrap(short(f64::from(v)), font, Color32::WHITE);
            let at = middle - 0.5 * galley.size();
            painter.rect_filled(
                Rect::from_min_size(at, galley.size()).expand(1.0),
                2.0,
                Color32::from_black_alpha(150),
            );
            painter.galley(at, galley, Color32::WHITE);
        }
    }
}

/// What can be read over a brightness from 0 to 255.
fn ink(brightness: f32) -> Color32 {
    if brightness > 120.0 { Color32::BLACK } else { Color32::WHITE }
}
