//! Colours of series that people with any kind of colour vision can tell apart, on white and on black; markers help.

use crate::viridis;

/// Colours in an order: darker to brighter.
pub(crate) const ORDERED: usize = 7;

/// Okabe and Ito's palette without black and yellow: blue, vermilion, green, purple, orange, sky.
const NAMED_BY_DAY: [&str; 6] = ["#0072b2", "#d55e00", "#009e73", "#b0568c", "#b87d00", "#3a8fc4"];
const NAMED_BY_NIGHT: [&str; 6] = ["#56b4e9", "#f07c2b", "#1fc79a", "#dd8fbd", "#e69f00", "#9ad1f5"];

/// The variable of the `i`-th of seven ordered colours.
pub(crate) fn ordered(i: usize) -> String {
    format!("var(--q{})", i.min(ORDERED - 1))
}

/// The variable of the `i`-th named colour.
pub(crate) fn named(i: usize) -> String {
    format!("var(--c{})", i % NAMED_BY_DAY.len())
}

/// The variables, for light and for dark pages.
pub(crate) fn style() -> String {
    format!("{}@media(prefers-color-scheme:dark){{{}}}", by_day(), theme(0.3, 1.0, &NAMED_BY_NIGHT))
}

/// The variables for light pages alone.
pub(crate) fn by_day() -> String {
    theme(0.0, 0.8, &NAMED_BY_DAY)
}

/// The ordered colours leave out that end of the scale that would vanish.
fn theme(low: f32, high: f32, named: &[&str]) -> String {
    let of = |i: usize| low + (high - low) * i as f32 / (ORDERED - 1) as f32;
    let ordered: String = (0..ORDERED).map(|i| format!("--q{i}:{};", hex(viridis(of(i))))).collect();
    let named: String = named.iter().enumerate().map(|(i, c)| format!("--c{i}:{c};")).collect();
    format!(":root{{{ordered}{named}}}")
}

/// As in style sheets.
pub(crate) fn hex(rgb: [f32; 3]) -> String {
    let [r, g, b] = rgb.map(|c| (c * 255.0).round() as u8);
    format!("#{r:02x}{g:02x}{b:02x}")
}
