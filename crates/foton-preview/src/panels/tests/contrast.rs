//! Every text that is drawn stands out from what is drawn below it, by the formula of WCAG 2.1.

use egui::{Color32, Rect, Shape};
use foton_session::findings::{Finding, FindingKind};

use super::*;

/// What readers with weak eyes need.
const LEAST: f64 = 4.5;

fn luminance(colour: Color32) -> f64 {
    let linear = |c: u8| {
        let c = f64::from(c) / 255.0;
        if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
    };
    let [r, g, b, _] = colour.to_array();
    0.2126 * linear(r) + 0.7152 * linear(g) + 0.0722 * linear(b)
}

fn contrast(a: Color32, b: Color32) -> f64 {
    let (a, b) = (luminance(a), luminance(b));
    (a.max(b) + 0.05) / (a.min(b) + 0.05)
}

/// A colour over an opaque one, as the adapter blends them: in gamma space, with colours that have their alpha in them.
fn over(below: Color32, above: Color32) -> Color32 {
    let keep = 1.0 - f32::from(above.a()) / 255.0;
    let mix = |b: u8, a: u8| (f32::from(b) * keep + f32::from(a)).min(255.0) as u8;
    Color32::from_rgb(mix(below.r(), above.r()), mix(below.g(), above.g()), mix(below.b(), above.b()))
}

/// Everything drawn, in order: filled rectangles and texts.
struct Drawn {
    ground: Color32,
    canvas: Rect,
    fills: Vec<(Rect, Color32)>,
    poor: Vec<String>,
    texts: usize,
}

impl Drawn {
    fn add(&mut self, clip: Rect, shape: &Shape) {
        match shape {
            Shape::Vec(shapes) => shapes.iter().for_each(|shape| self.add(clip, shape)),
            Shape::Rect(rect) if rect.fill.a() > 0 => {
                self.fills.push((rect.visual_bounding_rect().intersect(clip), rect.fill));
            }
            Shape::Text(text) => {
                let rect = text.visual_bounding_rect().intersect(clip);
                // What lies over the picture is outlined or on a ground of its own.
                if rect.is_positive() && !self.canvas.contains(rect.center()) {
                    self.read(rect.center(), text);
                }
            }
            _ => {}
        }
    }

    fn read(&mut self, at: egui::Pos2, text: &egui::epaint::TextShape) {
        let below = self.fills.iter().filter(|(rect, _)| rect.contains(at));
        let ground = below.fold(self.ground, |ground, (_, fill)| over(ground, *fill));
        for section in &text.galley.job.sections {
            let own = if section.format.color == Color32::PLACEHOLDER {
                text.fallback_color
            } else {
                section.format.color
            };
            let colour = text.override_text_color.unwrap_or(own).gamma_multiply(text.opacity_factor);
            let contrast = contrast(over(ground, colour), ground);
            self.texts += 1;
            if contrast < LEAST && !text.galley.job.text.trim().is_empty() {
                self.poor.push(format!("{contrast:.2}: “{}” {colour:?} on {ground:?}", text.galley.job.text));
            }
        }
    }
}

/// The texts of a window that stand out too little.
fn poor(harness: &Harness<'_, State>) -> Vec<String> {
    let canvas = harness.state().places.iter().find(|(name, _)| *name == "canvas").expect("a canvas").1;
    let ground = crate::panels::ground(&harness.ctx.global_style().visuals);
    let mut drawn = Drawn { ground, canvas, fills: Vec::new(), poor: Vec::new(), texts: 0 };
    for clipped in &harness.output().shapes {
        drawn.add(clipped.clip_rect, &clipped.shape);
    }
    assert!(drawn.texts > 30, "{} texts", drawn.texts);
    drawn.poor
}

#[test]
fn contrasts_are_those_of_the_standard() {
    assert!((contrast(Color32::WHITE, Color32::BLACK) - 21.0).abs() < 1e-9);
    assert!((contrast(Color32::from_gray(118), Color32::WHITE) - 4.54).abs() < 0.01);
    assert_eq!(over(Color32::BLACK, Color32::from_white_alpha(51)), Color32::from_gray(51));
}

#[test]
fn all_text_stands_out_in_both_themes() {
    for theme in [egui::Theme::Dark, egui::Theme::Light] {
        let mut harness = window(|state| {
            state.preferences.dark = theme == egui::Theme::Dark;
            layout::fill(state);
            let found = |kind, text: &str| Finding { kind, place: None, text: text.into() };
            let findings =
                vec![found(FindingKind::StarvedEmitter, "\"cellar lamp\" takes 65 % of the photons")];
            state.frame.as_mut().expect("there").stats.findings = Arc::new(findings);
            state.error("room.xml:1:1: wrong");
            state.notice("Opened room.xml");
        });
        harness.ctx.set_theme(theme);
        click(&mut harness, Role::DisclosureTriangle, "Diagnostics");
        assert_eq!(poor(&harness), [""; 0], "{theme:?}");
        // Disabled controls, a hint, a draft, the overlay of keys.
        harness.state_mut().view = ViewMode::Radius;
        harness.state_mut().show_help = true;
        harness.state_mut().frame.as_mut().expect("there").selection = None;
        type_number(&mut harness, "Seed", "5");
        assert_eq!(poor(&harness), [""; 0], "{theme:?}");
        harness.state_mut().show_help = false;
        for (role, list) in [(Role::Button, "File"), (Role::Button, "View"), (Role::ComboBox, "View")] {
            click(&mut harness, role, list);
            assert_eq!(poor(&harness), [""; 0], "{list} {theme:?}");
            harness.key_press(egui::Key::Escape);
            settle(&mut harness);
        }
        harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::O);
        settle(&mut harness);
        assert_eq!(poor(&harness), [""; 0], "the file dialog, {theme:?}");
    }
}
