//! What to do first, said in a line over the picture that fades.

use egui::{Align2, FontId, Rect, Vec2};

use crate::state::State;

const TEXT: &str = "drag: orbit     wheel: nearer, farther     click: select     ?: keys";

/// Starts of the program at which it is said.
pub(super) const STARTS: u32 = 5;

/// Seconds that it stays, and takes to fade.
const STAYS: f64 = 12.0;
const FADES: f64 = 2.0;

/// Draws it at the lower edge of a view, the first times.
pub(super) fn draw(ui: &egui::Ui, state: &mut State, view: Rect) {
    if state.preferences.starts > STARTS {
        return;
    }
    let now = ui.input(|i| i.time);
    let since = now - *state.looking.hinted.get_or_insert(now);
    let left = (STAYS + FADES - since) / FADES;
    if left <= 0.0 {
        return;
    }
    let opacity = left.min(1.0) as f32;
    let wait = if left > 1.0 { (left - 1.0) * FADES } else { 0.1 };
    ui.ctx().request_repaint_after(std::time::Duration::from_secs_f64(wait.max(0.1)));
    let painter = ui.painter_at(view);
    let galley = painter.layout_no_wrap(TEXT.to_owned(), FontId::proportional(15.0), egui::Color32::WHITE);
    let middle = view.center_bottom() - Vec2::new(0.0, 44.0);
    let back = Align2::CENTER_CENTER.anchor_size(middle, galley.size() + Vec2::new(28.0, 14.0));
    painter.rect_filled(back, 8.0, egui::Color32::from_black_alpha(190).gamma_multiply(opacity));
    let corner = back.center() - 0.5 * galley.size();
    painter.galley_with_override_text_color(corner, galley, egui::Color32::WHITE.gamma_multiply(opacity));
}
