//! What several panels are made of.

use egui::{Align2, Color32, Response, Sense, Ui, Vec2};

use super::icons::{self, Icon};

/// Width of the labels before a panel's controls, in points.
pub(super) const LABEL: f32 = 104.0;

/// What a panel holds, in its own rectangle: whatever it needs, the panel grows no wider or higher for it.
pub(super) fn within(ui: &mut Ui, content: impl FnOnce(&mut Ui)) {
    let rect = ui.available_rect_before_wrap();
    let mut inside = ui.new_child(egui::UiBuilder::new().max_rect(rect));
    inside.set_clip_rect(rect.intersect(ui.clip_rect()));
    content(&mut inside);
    ui.advance_cursor_after_rect(rect);
}

/// What is shown in a scrolled panel, no wider than is seen of it: a line that is too long makes the others no longer.
pub(super) fn as_wide_as_seen(ui: &mut Ui, content: impl FnOnce(&mut Ui)) {
    let rect = ui.available_rect_before_wrap();
    let rect = rect.with_max_x(ui.clip_rect().right().min(rect.right()).max(rect.left() + 1.0));
    ui.scope_builder(egui::UiBuilder::new().max_rect(rect), content);
}

/// A part of a panel that folds. Its heading is a button, for keys and screen readers too.
pub(super) fn section(ui: &mut Ui, name: &str, is_open: bool, content: impl FnOnce(&mut Ui)) -> Response {
    let title = egui::RichText::new(name).strong();
    let header = egui::CollapsingHeader::new(title).id_salt(name).default_open(is_open);
    let shown = header.show_unindented(ui, |ui| as_wide_as_seen(ui, content));
    ui.add_space(4.0);
    shown.header_response
}

/// A line of a panel: a name in a column of its own, then the control that it names; what the control returned.
pub(super) fn row<R>(ui: &mut Ui, name: &str, help: &str, control: impl FnOnce(&mut Ui, egui::Id) -> R) -> R {
    ui.horizontal(|ui| {
        let size = Vec2::new(LABEL, ui.spacing().interact_size.y);
        let layout = egui::Layout::left_to_right(egui::Align::Center);
        let label = ui.allocate_ui_with_layout(size, layout, |ui| {
            ui.set_min_width(LABEL);
            ui.add(egui::Label::new(name).truncate()).on_hover_text(help)
        });
        control(ui, label.inner.id)
    })
    .inner
}

/// Lets several buttons share a line of a narrow panel.
pub(super) fn tight(ui: &mut Ui) {
    ui.spacing_mut().item_spacing.x = 3.0;
    ui.spacing_mut().button_padding.x = 5.0;
}

/// A button of the toolbar: an icon and its label.
pub(super) struct Tool<'a> {
    pub(super) icon: Icon,
    pub(super) label: &'a str,
    /// The widest label that it can have: its width is always for that one.
    pub(super) widest: &'a str,
    /// Whether it is switched on; `None` for one that does something.
    pub(super) is_on: Option<bool>,
    /// Without its label, which is still its name.
    pub(super) is_short: bool,
}

impl<'a> Tool<'a> {
    pub(super) const fn new(icon: Icon, label: &'a str) -> Self {
        Self { icon, label, widest: label, is_on: None, is_short: false }
    }

    pub(super) fn show(&self, ui: &mut Ui) -> Response {
        const MARGIN: f32 = 6.0;
        let font = egui::TextStyle::Button.resolve(ui.style());
        let lay_out =
            |text: &str| ui.painter().layout_no_wrap(text.to_owned(), font.clone(), Color32::PLACEHOLDER);
        let (galley, widest) = (lay_out(self.label), lay_out(self.widest));
        let text_left = icons::SIDE + 2.0 * MARGIN;
        let width = if self.is_short { text_left } else { text_left + widest.size().x + MARGIN };
        let size = Vec2::new(width, ui.spacing().interact_size.y);
        let (rect, response) = ui.allocate_exact_size(size, Sense::click());
        let is_enabled = ui.is_enabled();
        response.widget_info(|| match self.is_on {
            Some(on) => egui::WidgetInfo::selected(egui::Role::Button, is_enabled, on, self.label),
            None => egui::WidgetInfo::labeled(egui::Role::Button, is_enabled, self.label),
        });
        let visuals = ui.style().interact_selectable(&response, self.is_on == Some(true));
        let colour = visuals.text_color();
        let (fill, stroke) = (visuals.weak_bg_fill, visuals.bg_stroke);
        ui.painter().rect(rect, visuals.corner_radius, fill, stroke, egui::StrokeKind::Inside);
        icons::draw(ui.painter(), rect.with_max_x(rect.left() + text_left), self.icon, colour);
        let at = egui::pos2(rect.left() + text_left, rect.center().y);
        if !self.is_short {
            ui.painter().galley(Align2::LEFT_CENTER.anchor_size(at, galley.size()).min, galley, colour);
        }
        response
    }
}

/// An icon in front of a control that it stands for.
pub(super) fn icon(ui: &mut Ui, icon: Icon, help: &str) {
    let (rect, response) =
        ui.allocate_exact_size(Vec2::new(icons::SIDE, ui.spacing().interact_size.y), Sense::hover());
    icons::draw(ui.painter(), rect, icon, ui.visuals().text_color());
    response.on_hover_text(help);
}
