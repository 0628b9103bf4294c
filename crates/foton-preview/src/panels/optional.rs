//! A number that may be off: a switch with its name, and the number.

use egui::Ui;

use super::number::{Change, Number};

/// The switch in a column of `width` points, then the number, which is `other` while it is off; typing it switches it on. Where `other` is
/// not known yet, there is no number, and nothing to switch on. What holds from now on.
pub(super) fn optional(
    ui: &mut Ui,
    width: f32,
    name: &str,
    help: &str,
    value: Option<f64>,
    other: impl Into<Option<f64>>,
    number: Number<'_>,
) -> Option<f64> {
    let shown = value.or(other.into());
    ui.horizontal(|ui| {
        let mut is_on = value.is_some();
        let size = egui::vec2(width, ui.spacing().interact_size.y);
        let layout = egui::Layout::left_to_right(egui::Align::Center);
        ui.allocate_ui_with_layout(size, layout, |ui| {
            ui.set_min_width(width);
            ui.add_enabled(shown.is_some(), egui::Checkbox::new(&mut is_on, name)).on_hover_text(help);
        });
        let Some(shown) = shown else {
            ui.label("—").on_hover_text(help);
            return None;
        };
        let (field, change) = number.show(ui, shown);
        field.on_hover_text(help);
        change.and_then(Change::done).or_else(|| is_on.then_some(shown))
    })
    .inner
}
