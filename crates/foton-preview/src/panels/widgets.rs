//! What several panels are made of.

/// A heading over a group of controls.
pub(super) fn heading(ui: &mut egui::Ui, text: &str) {
    ui.add_space(8.0);
    ui.label(egui::RichText::new(text).strong());
    ui.add_space(2.0);
}

/// A slider that leaves a value alone until someone moves it: one that rounds or clamps what it shows would steer by itself.
pub(super) fn slider<N: egui::emath::Numeric>(
    value: &mut N,
    range: std::ops::RangeInclusive<N>,
) -> egui::Slider<'_> {
    egui::Slider::new(value, range).clamping(egui::SliderClamping::Edits)
}
