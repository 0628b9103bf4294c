//! What the colours of photons say: the path by which their light came.

use egui::{Color32, FontId, Rect, Vec2};
use foton_session::PathClass;

/// The colour of a photon.
pub(super) const fn colour(class: PathClass) -> Color32 {
    match class {
        PathClass::Direct => Color32::from_rgb(255, 215, 70),
        PathClass::Caustic => Color32::WHITE,
        PathClass::Indirect => Color32::from_rgb(110, 170, 255),
    }
}

/// Draws the legend in the lower left corner of a view.
pub(super) fn draw(painter: &egui::Painter, view: Rect) {
    const PATHS: [(PathClass, &str); 3] = [
        (PathClass::Direct, "direct"),
        (PathClass::Caustic, "caustic: by mirrors and glass only"),
        (PathClass::Indirect, "indirect"),
    ];
    let font = FontId::proportional(12.0);
    let lines: Vec<_> = PATHS
        .into_iter()
        .map(|(class, text)| {
            (colour(class), painter.layout_no_wrap(text.to_owned(), font.clone(), Color32::WHITE))
        })
        .collect();
    let width = lines.iter().map(|(_, line)| line.size().x).fold(0.0, f32::max) + 30.0;
    let size = Vec2::new(width, 18.0 * lines.len() as f32 + 8.0);
    let back = Rect::from_min_size(view.left_bottom() - Vec2::new(-10.0, size.y + 34.0), size);
    painter.rect_filled(back, 4.0, Color32::from_black_alpha(190));
    for (i, (colour, line)) in lines.into_iter().enumerate() {
        let middle = back.left_top() + Vec2::new(12.0, 13.0 + 18.0 * i as f32);
        painter.rect_filled(Rect::from_center_size(middle, Vec2::splat(7.0)), 0.0, colour);
        let corner = middle + Vec2::new(10.0, -0.5 * line.size().y);
        painter.galley(corner, line, Color32::WHITE);
    }
}
