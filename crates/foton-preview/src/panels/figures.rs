//! A panel's figures: names on the left, values in a column of their own, their digits in constant places.

use egui::{Align2, Color32, Sense, Ui, Vec2};

/// A line of figures.
pub(super) struct Figure {
    name: &'static str,
    value: String,
    help: &'static str,
    is_warning: bool,
}

impl Figure {
    pub(super) fn new(name: &'static str, value: impl Into<String>, help: &'static str) -> Self {
        Self { name, value: value.into(), help, is_warning: false }
    }

    /// In the colour of warnings, if it is one.
    pub(super) fn warning(self, is_warning: bool) -> Self {
        Self { is_warning, ..self }
    }

    /// The name at the left edge, the value at the right one.
    pub(super) fn show(&self, ui: &mut Ui) {
        let height = ui.text_style_height(&egui::TextStyle::Body) + 2.0;
        let (rect, response) =
            ui.allocate_exact_size(Vec2::new(ui.available_width(), height), Sense::hover());
        let colour = if self.is_warning { ui.visuals().warn_fg_color } else { ui.visuals().text_color() };
        let fonts =
            [egui::TextStyle::Body, egui::TextStyle::Monospace].map(|style| style.resolve(ui.style()));
        let lay_out = |text: &str, font: &egui::FontId, colour: Color32| {
            ui.painter().layout_no_wrap(text.to_owned(), font.clone(), colour)
        };
        let [name, value] = [
            lay_out(self.name, &fonts[0], ui.visuals().weak_text_color()),
            lay_out(&self.value, &fonts[1], colour),
        ];
        let place = |at, anchor: Align2, size| anchor.anchor_size(at, size).min;
        ui.painter().galley(place(rect.left_center(), Align2::LEFT_CENTER, name.size()), name, colour);
        ui.painter().galley(place(rect.right_center(), Align2::RIGHT_CENTER, value.size()), value, colour);
        // One label for screen readers: what it is, and how much.
        let said = format!("{}: {}", self.name, self.value);
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Label, true, &said));
        response.on_hover_text(self.help);
    }
}
