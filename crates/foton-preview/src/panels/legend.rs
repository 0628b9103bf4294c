//! The scale of false colours.

use egui::{Align2, Color32, FontId, Pos2, Rect, Vec2};

use super::text::short;
use crate::present::colour_map;

/// What the colours mean.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Scale {
    label: String,
    pub(super) low: f32,
    pub(super) high: f32,
    pub(super) logarithmic: bool,
}

/// A measure that spans more than this factor gets a logarithmic scale.
const WIDE: f32 = 20.0;

impl Scale {
    /// The scale of a measure: from its 1st to its 99th percentile of values above zero, so that single pixels do not set it.
    pub(super) fn of(label: &str, values: &[f32]) -> Self {
        let mut positive: Vec<f32> = values.iter().copied().filter(|v| *v > 0.0 && v.is_finite()).collect();
        if positive.is_empty() {
            return Self { label: label.to_owned(), low: 0.0, high: 1.0, logarithmic: false };
        }
        let mut at = |share: f64| {
            let index = ((positive.len() - 1) as f64 * share).round() as usize;
            *positive.select_nth_unstable_by(index, f32::total_cmp).1
        };
        let (low, high) = (at(0.01), at(0.99));
        let logarithmic = high > WIDE * low;
        let low = if logarithmic { low.max(high * 1e-6) } else { 0.0 };
        Self { label: label.to_owned(), low, high: high.max(low * 1.0001 + f32::MIN_POSITIVE), logarithmic }
    }

    /// The value at a share of the scale.
    fn value(&self, t: f32) -> f32 {
        if self.logarithmic {
            self.low * (self.high / self.low).powf(t)
        } else {
            self.low + (self.high - self.low) * t
        }
    }
}

/// Draws the scale at the right edge of a view.
pub(super) fn draw(painter: &egui::Painter, view: Rect, scale: &Scale) {
    const STEPS: u32 = 64;
    let bar = Rect::from_min_size(
        Pos2::new(view.right() - 92.0, view.top() + 64.0),
        Vec2::new(14.0, (view.height() - 104.0).clamp(40.0, 260.0)),
    );
    let back = bar.expand2(Vec2::new(8.0, 28.0)).with_max_x(view.right() - 8.0);
    painter.rect_filled(back, 4.0, Color32::from_black_alpha(170));
    for i in 0..STEPS {
        let t = i as f32 / (STEPS - 1) as f32;
        let [r, g, b] = colour_map::at(t);
        let top = bar.bottom() - bar.height() * (i + 1) as f32 / STEPS as f32;
        let part = Rect::from_min_size(
            Pos2::new(bar.left(), top),
            Vec2::new(bar.width(), bar.height() / STEPS as f32 + 0.5),
        );
        painter.rect_filled(part, 0.0, Color32::from_rgb(r, g, b));
    }
    let font = FontId::proportional(12.0);
    for i in 0..=4 {
        let t = i as f32 / 4.0;
        let at = Pos2::new(bar.right() + 6.0, bar.bottom() - bar.height() * t);
        painter.text(at, Align2::LEFT_CENTER, short(f64::from(scale.value(t))), font.clone(), Color32::WHITE);
    }
    let at = Pos2::new(back.right(), back.top() - 4.0);
    let text = painter.layout_no_wrap(scale.label.clone(), font, Color32::WHITE);
    let corner = at - Vec2::new(text.size().x + 4.0, text.size().y + 2.0);
    painter.rect_filled(
        Rect::from_min_size(corner, text.size()).expand(3.0),
        3.0,
        Color32::from_black_alpha(170),
    );
    painter.galley(corner, text, Color32::WHITE);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wide_measures_are_logarithmic_and_single_pixels_do_not_set_the_scale() {
        let mut values: Vec<f32> = (1..=1000).map(|i| i as f32).collect();
        values.extend([1e9, f32::NAN, 0.0]);
        let scale = Scale::of("x", &values);
        assert!(scale.logarithmic && scale.high < 1001.0 && scale.low > 1.0);
        let narrow = Scale::of("x", &[1.0, 2.0, 3.0]);
        assert!(!narrow.logarithmic && narrow.low == 0.0 && narrow.high == 3.0);
        assert_eq!(Scale::of("x", &[]).high, 1.0);
        assert!((scale.value(0.0) / scale.low - 1.0).abs() < 1e-6);
    }
}
