//! Curves over two logarithmic axes, as SVG that takes its colours from the page around it, or stands alone. No other kinds of axes.

pub(crate) mod colours;

use std::fmt::Write;
use std::ops::RangeInclusive;

const WIDTH: f64 = 640.0;
const HEIGHT: f64 = 400.0;
const LEFT: f64 = 62.0;
const TOP: f64 = 34.0;
const BOTTOM: f64 = 48.0;
/// The legend's column.
const RIGHT: f64 = 164.0;

/// How text and lines look; a page sets `--ink`, `--dim` and `--line`.
pub(crate) const STYLE: &str = "svg text{fill:var(--ink);font:12px system-ui,sans-serif}\
svg .dim{fill:var(--dim)}svg .title{font-weight:600;font-size:13.5px}\
svg .grid{stroke:var(--line);stroke-width:1}svg .axis{stroke:var(--dim);stroke-width:1}";

/// Text for markup.
pub(crate) fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// Up to three decimals.
pub(crate) fn short(v: f64) -> String {
    let text = format!("{v:.3}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// A curve.
pub struct Series {
    /// In the legend; none where it is empty.
    pub name: String,
    /// A colour, or a variable of the page's style.
    pub colour: String,
    /// Which of seven shapes.
    pub marker: usize,
    /// A line without markers.
    pub dashed: bool,
    /// Dots alone, faint.
    pub cloud: bool,
    /// Both above zero.
    pub points: Vec<(f64, f64)>,
}

impl Series {
    /// A line with markers; what is not above zero is left out.
    pub fn new(name: impl Into<String>, colour: String, marker: usize, points: Vec<(f64, f64)>) -> Self {
        let points =
            points.into_iter().filter(|(x, y)| *x > 0.0 && *y > 0.0 && x.is_finite() && y.is_finite());
        Self { name: name.into(), colour, marker, dashed: false, cloud: false, points: points.collect() }
    }
}

/// A plot with a legend to the right.
pub struct Plot<'a> {
    /// Above the plot.
    pub title: &'a str,
    /// With its unit.
    pub x: &'a str,
    /// With its unit.
    pub y: &'a str,
    /// In the legend from above.
    pub series: Vec<Series>,
}

/// One axis: logarithms from `low` to `high` onto `from` to `to`.
struct Scale {
    low: f64,
    high: f64,
    from: f64,
    to: f64,
}

impl Scale {
    /// For the values that have a logarithm: others do not make it endless.
    fn new(values: impl Iterator<Item = f64>, from: f64, to: f64) -> Self {
        let values = values.filter(|v| v.is_finite() && *v > 0.0);
        let (low, high) = values.fold((f64::MAX, f64::MIN_POSITIVE), |(a, b), v| (a.min(v), b.max(v)));
        let margin = 0.04 * (high / low).ln().max(0.5);
        let (low, high) = (low * (-margin).exp(), high * margin.exp());
        Self { low: low.max(f64::MIN_POSITIVE), high: high.min(f64::MAX), from, to }
    }

    fn at(&self, v: f64) -> f64 {
        self.from + (self.to - self.from) * (v / self.low).ln() / (self.high / self.low).ln()
    }

    /// The powers of ten around it.
    fn decades(&self) -> RangeInclusive<i32> {
        self.low.log10().floor() as i32..=self.high.log10().ceil() as i32
    }

    /// Round values: 1, 2, 5 in each decade, fewer over many, more within one.
    fn ticks(&self) -> Vec<f64> {
        let decades = (self.high / self.low).log10();
        let steps: &[f64] = match decades {
            d if d < 0.35 => {
                &[1.0, 1.2, 1.4, 1.6, 1.8, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0, 6.0, 7.0, 8.0, 9.0]
            }
            d if d < 0.7 => &[1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0],
            d if d < 1.5 => &[1.0, 1.5, 2.0, 3.0, 5.0, 7.0],
            d if d < 3.5 => &[1.0, 2.0, 5.0],
            _ => &[1.0],
        };
        let all = self.decades().flat_map(|power| steps.iter().map(move |s| s * 10f64.powi(power)));
        all.filter(|t| (self.low..=self.high).contains(t)).collect()
    }
}

impl Plot<'_> {
    /// The plot as SVG; nothing where there is no point.
    #[must_use]
    pub fn svg(&self) -> Option<String> {
        let points = || self.series.iter().flat_map(|s| &s.points);
        points().next()?;
        let x = Scale::new(points().map(|p| p.0), LEFT, WIDTH - RIGHT);
        let y = Scale::new(points().map(|p| p.1), HEIGHT - BOTTOM, TOP);
        let mut svg = format!(
            "<svg viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=\"img\" aria-label=\"{0}\"><text class=\"title\" x=\"{LEFT}\" y=\"18\">{0}</text>",
            escape(self.title)
        );
        self.axes(&x, &y, &mut svg);
        // Clouds lie below.
        for series in self.series.iter().filter(|s| s.cloud).chain(self.series.iter().filter(|s| !s.cloud)) {
            series.draw(&x, &y, &mut svg);
        }
        self.legend(&mut svg);
        svg += "</svg>";
        Some(svg)
    }

    /// The plot as a file of its own: dark on white, colours of the day.
    #[must_use]
    pub fn file(&self) -> Option<String> {
        let style = format!(
            "<style>:root{{--ink:#1b1f24;--dim:#59636e;--line:#d1d9e0}}{STYLE}{}</style><rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>",
            colours::by_day()
        );
        let svg = self.svg()?.replacen("<svg ", "<svg xmlns=\"http://www.w3.org/2000/svg\" ", 1);
        let head = svg.find('>')? + 1;
        Some(format!("{}{style}{}\n", &svg[..head], &svg[head..]))
    }

    fn axes(&self, x: &Scale, y: &Scale, svg: &mut String) {
        let (right, bottom) = (WIDTH - RIGHT, HEIGHT - BOTTOM);
        // Writing to a string does not fail.
        for tick in x.ticks() {
            let at = x.at(tick);
            let _ = write!(
                svg,
                "<line class=\"grid\" x1=\"{at:.1}\" y1=\"{TOP}\" x2=\"{at:.1}\" y2=\"{bottom}\"/>\
                 <text class=\"dim\" x=\"{at:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text>",
                bottom + 17.0,
                tick_text(tick)
            );
        }
        for tick in y.ticks() {
            let at = y.at(tick);
            let _ = write!(
                svg,
                "<line class=\"grid\" x1=\"{LEFT}\" y1=\"{at:.1}\" x2=\"{right}\" y2=\"{at:.1}\"/>\
                 <text class=\"dim\" x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{}</text>",
                LEFT - 7.0,
                at + 4.0,
                tick_text(tick)
            );
        }
        let _ = write!(
            svg,
            "<path class=\"axis\" fill=\"none\" d=\"M{LEFT} {TOP}V{bottom}H{right}\"/>\
             <text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text>\
             <text transform=\"translate(15 {:.1}) rotate(-90)\" text-anchor=\"middle\">{}</text>",
            0.5 * (LEFT + right),
            HEIGHT - 10.0,
            escape(self.x),
            0.5 * (TOP + bottom),
            escape(self.y)
        );
    }

    fn legend(&self, svg: &mut String) {
        let left = WIDTH - RIGHT + 14.0;
        for (i, series) in self.series.iter().filter(|s| !s.name.is_empty()).enumerate() {
            let y = TOP + 8.0 + 19.0 * i as f64;
            if !series.cloud {
                let _ = write!(
                    svg,
                    "<line x1=\"{left}\" y1=\"{y}\" x2=\"{:.1}\" y2=\"{y}\" style=\"stroke:{}\" stroke-width=\"2\"{}/>",
                    left + 22.0,
                    series.colour,
                    if series.dashed { " stroke-dasharray=\"5 4\"" } else { "" }
                );
            }
            if !series.dashed {
                *svg += &marker(series.marker, left + 11.0, y, &series.colour);
            }
            let _ = write!(
                svg,
                "<text x=\"{:.1}\" y=\"{:.1}\">{}</text>",
                left + 29.0,
                y + 4.0,
                escape(&series.name)
            );
        }
    }
}

impl Series {
    fn draw(&self, x: &Scale, y: &Scale, svg: &mut String) {
        if self.cloud {
            for (px, py) in &self.points {
                let (cx, cy) = (x.at(*px), y.at(*py));
                let _ = write!(
                    svg,
                    "<circle cx=\"{cx:.1}\" cy=\"{cy:.1}\" r=\"2.2\" style=\"fill:{}\" opacity=\"0.35\"/>",
                    self.colour
                );
            }
            return;
        }
        let mut path = String::new();
        for (i, (px, py)) in self.points.iter().enumerate() {
            let _ = write!(path, "{}{:.1} {:.1}", if i == 0 { 'M' } else { 'L' }, x.at(*px), y.at(*py));
        }
        let _ = write!(
            svg,
            "<path fill=\"none\" stroke-width=\"1.8\" stroke-linejoin=\"round\" style=\"stroke:{}\" d=\"{path}\"{}/>",
            self.colour,
            if self.dashed { " stroke-dasharray=\"5 4\"" } else { "" }
        );
        if !self.dashed {
            for (px, py) in &self.points {
                *svg += &marker(self.marker, x.at(*px), y.at(*py), &self.colour);
            }
        }
    }
}

/// One of seven shapes.
fn marker(kind: usize, x: f64, y: f64, colour: &str) -> String {
    let path = match kind % 7 {
        0 => return format!("<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3.4\" style=\"fill:{colour}\"/>"),
        1 => "m-3.1-3.1h6.2v6.2h-6.2z",
        2 => "m0-4.2 4 7.2h-8z",
        3 => "m0-4.4 4.4 4.4-4.4 4.4-4.4-4.4z",
        4 => "m0 4.2 4-7.2h-8z",
        5 => "m-4.2-1.2h3v-3h2.4v3h3v2.4h-3v3h-2.4v-3h-3z",
        _ => "m-4.2-3.1h8.4l-2 6.2h-4.4z",
    };
    format!("<path d=\"M{x:.1} {y:.1}{path}\" style=\"fill:{colour}\"/>")
}

/// The `i`-th of six colours that any kind of colour vision tells apart.
#[must_use]
pub fn colour(i: usize) -> String {
    colours::named(i)
}

/// A tick's value in as few characters as it needs.
fn tick_text(v: f64) -> String {
    match v {
        v if v >= 1e9 => format!("{} G", short(v / 1e9)),
        v if v >= 1e6 => format!("{} M", short(v / 1e6)),
        v if v >= 1e4 => format!("{} k", short(v / 1e3)),
        v if v >= 1e-3 => short(v),
        v => format!("{v:.0e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_without_a_logarithm_make_no_axis_endless() {
        for odd in [0.0, -1.0, f64::NAN, f64::INFINITY, f64::MAX, f64::MIN_POSITIVE, 5e-324] {
            for values in [&[odd, 1.0, 3.0][..], &[odd]] {
                let scale = Scale::new(values.iter().copied(), 0.0, 100.0);
                let all = scale.decades();
                assert!(i64::from(*all.end()) - i64::from(*all.start()) < 1000, "{odd}: {all:?}");
            }
        }
    }

    #[test]
    fn ticks_are_round_inside_and_neither_few_nor_many() {
        for (low, high) in [(0.011, 0.019), (0.8, 3.2), (1.0, 60.0), (0.02, 900.0), (1e4, 3e9)] {
            let scale = Scale::new([low, high].into_iter(), 0.0, 100.0);
            let ticks = scale.ticks();
            assert!((2..=12).contains(&ticks.len()), "{low} to {high}: {ticks:?}");
            assert!(ticks.iter().all(|t| (0.0..=100.0).contains(&scale.at(*t))), "{ticks:?}");
        }
        assert_eq!([tick_text(0.05), tick_text(20_000.0), tick_text(1e9)], ["0.05", "20 k", "1 G"]);
    }

    #[test]
    fn a_plot_has_a_path_a_series_and_nothing_without_points() {
        let series = |points| Series::new("a<b", "red".into(), 3, points);
        let plot = |series| Plot { title: "t", x: "time (s)", y: "error (%)", series };
        let svg = plot(vec![series(vec![(1.0, 2.0), (3.0, 1.0), (0.0, 1.0)])]).svg().expect("points");
        assert!(svg.contains("a&lt;b") && svg.starts_with("<svg") && svg.ends_with("</svg>"));
        assert_eq!(svg.matches("style=\"fill:red\"").count(), 3, "two points and the legend; none at zero");
        assert!(plot(vec![series(Vec::new())]).svg().is_none());
    }
}
