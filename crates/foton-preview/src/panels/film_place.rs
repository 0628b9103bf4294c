//! Where on the screen the film is.

use egui::{Pos2, Rect, Vec2};

use crate::state::Placement;

/// Where the image is in the window, in points, and how large it is in pixels.
#[derive(Clone, Copy)]
pub(super) struct Film {
    pub(super) rect: Rect,
    pub(super) image: Rect,
    pub(super) size: Vec2,
}

impl Film {
    /// Points per pixel.
    pub(super) fn scale(&self) -> f32 {
        self.image.width() / self.size.x.max(1.0)
    }

    /// From pixels to points.
    pub(super) fn to_points(self, film: [f32; 2]) -> Pos2 {
        self.image.min + Vec2::from(film) * self.scale()
    }

    /// From points to pixels.
    pub(super) fn to_film(self, at: Pos2) -> [f64; 2] {
        let film = (at - self.image.min) / self.scale();
        [f64::from(film.x), f64::from(film.y)]
    }

    pub(super) fn pixel(self, at: Pos2) -> Option<[u32; 2]> {
        let [x, y] = self.to_film(at);
        let inside = x >= 0.0 && y >= 0.0 && x < f64::from(self.size.x) && y < f64::from(self.size.y);
        inside.then_some([x as u32, y as u32])
    }
}

/// The rectangle of an image of `size` pixels in the view.
pub(super) fn place(view: Rect, size: Vec2, placement: Placement) -> Rect {
    let fit = (view.width() / size.x.max(1.0)).min(view.height() / size.y.max(1.0));
    let scale = placement.zoom.unwrap_or(fit);
    let image = size * scale;
    let min = view.center() - image * Vec2::from(placement.centre);
    Rect::from_min_size(min, image)
}
