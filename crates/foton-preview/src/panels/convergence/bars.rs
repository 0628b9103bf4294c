//! Bars: noise against bias, and which kind of light the error is of.

use egui::{Align2, Color32, Rect, Sense, TextStyle, Ui, Vec2};
use foton_session::ErrorEstimate;

use crate::panels::text::percent;

/// Width of the names before bars, and of the figures behind them.
const NAME: f32 = 58.0;
const VALUE: f32 = 56.0;

/// Names and remedies of the parts of the error.
const CLASSES: [(&str, &str); 3] = [
    ("Direct", "What light straight from emitters has of the error. Direct light by shadow rays has no bias"),
    (
        "Caustic",
        "What light by mirrors and glass has of the error. Against its bias helps a smaller radius, against its noise more photons",
    ),
    (
        "Indirect",
        "What light by surfaces that scatter has of the error. Against its noise help a larger radius and more passes",
    ),
];

pub(super) fn noise_colour(ui: &Ui) -> Color32 {
    if is_dark(ui) { Color32::from_rgb(110, 175, 255) } else { Color32::from_rgb(15, 90, 190) }
}

pub(super) fn bias_colour(ui: &Ui) -> Color32 {
    if is_dark(ui) { Color32::from_rgb(255, 165, 90) } else { Color32::from_rgb(165, 75, 0) }
}

/// Noise against bias, by what each has of the squared error.
pub(super) fn noise_and_bias(ui: &mut Ui, error: &ErrorEstimate) {
    let parts = [error.noise, error.bias];
    let words = format!("Noise {}, bias {}", percent(error.noise), percent(error.bias));
    let help = "Noise falls with more photons, bias with smaller radii: α moves the balance";
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        ui.colored_label(noise_colour(ui), format!("Noise {}", percent(error.noise)));
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            ui.colored_label(bias_colour(ui), format!("Bias {}", percent(error.bias)));
        });
    });
    let (rect, response) = ui.allocate_exact_size(Vec2::new(ui.available_width(), 10.0), Sense::hover());
    split(ui, rect, parts);
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, &words));
    response.on_hover_text(help);
}

/// A bar for each kind of light, as long as its error.
pub(super) fn light_paths(ui: &mut Ui, error: &ErrorEstimate) {
    let Some(classes) = &error.classes else { return };
    ui.add_space(4.0);
    ui.label("Error by light path");
    let largest = classes.iter().map(|c| c.total()).fold(f64::MIN_POSITIVE, f64::max);
    for ((name, help), class) in CLASSES.into_iter().zip(classes) {
        let height = ui.text_style_height(&TextStyle::Body) + 2.0;
        let (rect, response) =
            ui.allocate_exact_size(Vec2::new(ui.available_width(), height), Sense::hover());
        let room = rect.width() - NAME - VALUE - 8.0;
        let length = room * (class.total() / largest).clamp(0.0, 1.0) as f32;
        let left = rect.left() + NAME;
        let bar = Rect::from_min_max(
            egui::pos2(left, rect.center().y - 4.0),
            egui::pos2(left + length.max(1.0), rect.center().y + 4.0),
        );
        split(ui, bar, [class.noise, class.bias]);
        let (body, mono) = (TextStyle::Body.resolve(ui.style()), TextStyle::Monospace.resolve(ui.style()));
        let colour = ui.visuals().text_color();
        ui.painter().text(rect.left_center(), Align2::LEFT_CENTER, name, body, colour);
        ui.painter().text(rect.right_center(), Align2::RIGHT_CENTER, percent(class.total()), mono, colour);
        let words = format!(
            "{name}: {}, noise {}, bias {}",
            percent(class.total()),
            percent(class.noise),
            percent(class.bias)
        );
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Label, true, &words));
        response.on_hover_text(format!("{words}. {help}"));
    }
}

/// A bar that is split by squares, which add up where errors do not.
fn split(ui: &Ui, rect: Rect, [noise, bias]: [f64; 2]) {
    let all = noise * noise + bias * bias;
    if all <= 0.0 || !all.is_finite() {
        return;
    }
    let x = rect.left() + rect.width() * (noise * noise / all) as f32;
    ui.painter().rect_filled(rect.with_max_x(x), 1.0, noise_colour(ui));
    ui.painter().rect_filled(rect.with_min_x(x), 1.0, bias_colour(ui));
}

fn is_dark(ui: &Ui) -> bool {
    ui.visuals().dark_mode
}
