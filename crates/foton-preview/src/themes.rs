//! The colours of both themes. All text stands out from its ground by a contrast of 4.5:1 at least, in disabled controls too.

use egui::{Color32, Context, Theme, Visuals};

/// Gives a context the themes.
pub(crate) fn dress(ctx: &Context) {
    ctx.set_visuals_of(Theme::Dark, dark());
    ctx.set_visuals_of(Theme::Light, light());
    ctx.all_styles_mut(|style| {
        style.spacing.scroll = egui::style::ScrollStyle::thin();
        style.spacing.item_spacing = egui::vec2(6.0, 4.0);
    });
}

fn dark() -> Visuals {
    let mut visuals = Visuals::dark();
    visuals.widgets.noninteractive.fg_stroke.color = Color32::from_gray(205);
    visuals.widgets.inactive.fg_stroke.color = Color32::from_gray(225);
    visuals.widgets.open.fg_stroke.color = Color32::from_gray(225);
    visuals.weak_text_color = Some(Color32::from_gray(172));
    visuals.warn_fg_color = Color32::from_rgb(255, 165, 60);
    visuals.error_fg_color = Color32::from_rgb(255, 120, 110);
    visuals.disabled_alpha = 0.72;
    visuals
}

fn light() -> Visuals {
    let mut visuals = Visuals::light();
    visuals.widgets.noninteractive.fg_stroke.color = Color32::from_gray(50);
    visuals.widgets.inactive.fg_stroke.color = Color32::from_gray(40);
    visuals.widgets.open.fg_stroke.color = Color32::from_gray(40);
    visuals.weak_text_color = Some(Color32::from_gray(85));
    visuals.warn_fg_color = Color32::from_rgb(140, 70, 0);
    visuals.error_fg_color = Color32::from_rgb(180, 0, 0);
    visuals.hyperlink_color = Color32::from_rgb(0, 90, 180);
    visuals.disabled_alpha = 0.78;
    visuals
}
