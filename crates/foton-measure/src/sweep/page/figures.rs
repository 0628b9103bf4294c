//! The page's figures: which curves each shows, and what it says below.

use foton_integrator::{Alpha, DirectLight, RadiusRule};

use super::advice::{Curve, common_time, curves};

use super::Report;
use crate::plot::colours::{hex, named, ordered};
use crate::plot::{Plot, Series, escape, short};
use crate::sweep::plan::{Configuration, count, scale, share};
use crate::sweep::table::Point;
use crate::viridis;

const TIME: &str = "processor time (s)";
const ERROR: &str = "error (% of mean light)";

fn percent(points: &[&Point], f: impl Fn(&Point) -> f64) -> Vec<(f64, f64)> {
    points.iter().map(|p| (p.cpu, 100.0 * f(p))).collect()
}

fn figure(svg: Option<String>, caption: &str) -> Option<String> {
    Some(format!("<figure>{}<figcaption>{caption}</figcaption></figure>", svg?))
}

impl Report<'_> {
    fn arm<'a>(
        &self,
        curves: &'a [Curve<'a>],
        belongs: impl Fn(&Configuration) -> bool,
    ) -> Vec<&'a Curve<'a>> {
        curves.iter().filter(|c| belongs(&c.configuration)).collect()
    }

    pub(crate) fn error_per_alpha(&self) -> Option<String> {
        let all = curves(self.points);
        let centre = self.centre;
        let mut arm = self.arm(&all, |c| Configuration { alpha: centre.alpha, ..*c } == centre);
        arm.sort_by(|a, b| a.configuration.alpha.get().total_cmp(&b.configuration.alpha.get()));
        let series = arm.iter().enumerate().map(|(i, c)| {
            let name = format!("α {}{}", share(c.configuration.alpha), self.mark(c));
            Series::new(name, ordered(i), i, percent(&c.points, |p| p.error))
        });
        let title = format!("Error over time, by α ({} photons a pass)", count(centre.photons.get().into()));
        let plot = Plot { title: &title, x: TIME, y: ERROR, series: series.collect() };
        figure(plot.svg(), "Small α shrinks radii fast: less bias, more noise. Means over seeds.")
    }

    pub(crate) fn error_per_radius(&self) -> Option<String> {
        let all = curves(self.points);
        let centre = self.centre;
        let mut arm = self.arm(&all, |c| Configuration { radius_scale: centre.radius_scale, ..*c } == centre);
        let of = |c: &&Curve<'_>| c.configuration.radius_scale.get();
        arm.sort_by(|a, b| of(a).total_cmp(&of(b)));
        let series = arm.iter().enumerate().map(|(i, c)| {
            let name = format!("radius × {}{}", scale(of(c)), self.mark(c));
            Series::new(
                name,
                ordered(i * 6 / arm.len().saturating_sub(1).max(1)),
                i,
                percent(&c.points, |p| p.error),
            )
        });
        let plot =
            Plot { title: "Error over time, by first radius", x: TIME, y: ERROR, series: series.collect() };
        figure(plot.svg(), "Factors on the first radius, which is four pixel footprints unless it was set.")
    }

    pub(crate) fn error_per_rule(&self) -> Option<String> {
        let all = curves(self.points);
        let centre = self.centre;
        let arm = self.arm(&all, |c| {
            let plain =
                Configuration { radius_rule: centre.radius_rule, direct_light: centre.direct_light, ..*c };
            plain == centre
        });
        let mut series = Vec::new();
        for (i, c) in arm.iter().enumerate() {
            let name = match (
                c.configuration.radius_rule != centre.radius_rule,
                c.configuration.direct_light != centre.direct_light,
            ) {
                (true, _) => match c.configuration.radius_rule {
                    RadiusRule::Local => "local radii",
                    RadiusRule::Global => "global radii",
                    RadiusRule::Adaptive => "adaptive radii",
                },
                (_, true) => direct_name(&c.configuration),
                _ => "centre",
            };
            series.push(Series::new(name, named(i), i, percent(&c.points, |p| p.total(1))));
            let mut edge =
                Series::new(format!("{name}, edges"), named(i), i, percent(&c.points, |p| p.total(2)));
            edge.dashed = true;
            series.push(edge);
        }
        let plot = Plot { title: "Shadow rays and the rule of radii", x: TIME, y: ERROR, series };
        figure(plot.svg(), "Solid: smooth pixels; dashed: edges.")
    }

    /// What differs between seeds and what does not, of the centre.
    pub(crate) fn parts(&self) -> Option<String> {
        let all = curves(self.points);
        let curve = all.iter().find(|c| c.configuration == self.centre)?;
        let over_photons = |f: &dyn Fn(&Point) -> f64| {
            curve.points.iter().map(|p| (p.photons as f64, 100.0 * f(p))).collect::<Vec<_>>()
        };
        let mut series = Vec::new();
        for (i, (mask, name)) in [(1, "smooth"), (2, "edges")].into_iter().enumerate() {
            let mut bias = Series::new(format!("bias, {name}"), named(i), i, over_photons(&|p| p.bias(mask)));
            bias.dashed = true;
            series.push(Series::new(format!("noise, {name}"), named(i), i, over_photons(&|p| p.noise(mask))));
            series.push(bias);
        }
        if let (Some(first), Some(last)) = (curve.points.first(), curve.points.last()) {
            let guide = |p: &Point| {
                100.0 * first.noise(1) * (p.photons as f64 / first.photons as f64).powf(-1.0 / 3.0)
            };
            let points = [first, last].map(|p| (p.photons as f64, guide(p))).to_vec();
            let mut line = Series::new("slope −1/3", "var(--dim)".to_owned(), 0, points);
            line.dashed = true;
            series.push(line);
        }
        let plot = Plot { title: "Noise and bias of the centre", x: "photons emitted", y: ERROR, series };
        figure(
            plot.svg(),
            "Noise differs from seed to seed, bias does not. Away from edges both fall with n<sup>−1/3</sup> at α 2/3 where radii do not adapt; bias \
            across edges falls more slowly.",
        )
    }

    /// What each kind of light contributes, of the centre.
    pub(crate) fn classes(&self) -> Option<String> {
        let all = curves(self.points);
        let curve = all.iter().find(|c| c.configuration == self.centre)?;
        let mut series = Vec::new();
        for (i, name) in ["direct", "caustic", "indirect"].into_iter().enumerate() {
            let of = |p: &Point| p.spread.classes.as_ref().map(|c| c[i]);
            let values = |f: &dyn Fn(&Point) -> Option<f64>| {
                curve.points.iter().filter_map(|p| Some((p.cpu, 100.0 * f(p)?))).collect::<Vec<_>>()
            };
            let total = values(&|p| of(p).map(|s| (s.variance + s.bias2).max(0.0).sqrt()));
            let mut noise = Series::new(
                format!("{name}, noise"),
                named(i),
                i,
                values(&|p| of(p).map(|s| s.variance.sqrt())),
            );
            noise.dashed = true;
            if !total.iter().all(|(_, y)| *y == 0.0) {
                series.push(Series::new(name, named(i), i, total));
                series.push(noise);
            }
        }
        let plot =
            Plot { title: "What direct, caustic and indirect light contribute", x: TIME, y: ERROR, series };
        figure(
            plot.svg(),
            "Errors of each kind of light alone, of the centre, over the mean of all light. Where direct light is largest, shadow \
            rays help; where caustics are, photons; where bias dominates, a smaller first radius. The reference's own noise is part of these.",
        )
    }

    /// All that was measured, and what nothing beats.
    pub(crate) fn pareto(&self) -> Option<String> {
        let mut cloud = Series::new(
            "all runs",
            "var(--dim)".to_owned(),
            0,
            self.points.iter().map(|p| (p.cpu, 100.0 * p.error)).collect(),
        );
        cloud.cloud = true;
        let front = self.front();
        let front = Series::new(
            "Pareto front",
            named(1),
            0,
            front.iter().map(|p| (p.cpu, 100.0 * p.error)).collect(),
        );
        let centre = curves(self.points);
        let centre = centre.iter().find(|c| c.configuration == self.centre);
        let centre = centre.map(|c| Series::new("centre", named(0), 1, percent(&c.points, |p| p.error)));
        let series = [Some(cloud), centre, Some(front)].into_iter().flatten().collect();
        let plot = Plot { title: "Pareto front of time against error", x: TIME, y: ERROR, series };
        figure(plot.svg(), "No run is faster and better than one on the front; the table below names them.")
    }

    /// The points that no other beats in both time and error, by time.
    pub(crate) fn front(&self) -> Vec<&Point> {
        let mut sorted: Vec<&Point> = self.points.iter().collect();
        sorted.sort_by(|a, b| a.cpu.total_cmp(&b.cpu));
        let mut min_error = f64::INFINITY;
        sorted.retain(|p| {
            p.error < min_error && {
                min_error = p.error;
                true
            }
        });
        sorted
    }

    /// A marker for the centre in legends.
    fn mark(&self, curve: &Curve<'_>) -> &'static str {
        if curve.configuration == self.centre { " (centre)" } else { "" }
    }

    /// Error at a common time over α and photons a pass.
    pub(crate) fn plane(&self) -> Option<String> {
        let all = curves(self.points);
        let time = common_time(&all)?;
        let centre = self.centre;
        let cells: Vec<(Alpha, u32, Option<f64>)> = all
            .iter()
            .filter(|c| {
                Configuration { alpha: centre.alpha, photons: centre.photons, ..c.configuration } == centre
            })
            .map(|c| (c.configuration.alpha, c.configuration.photons.get(), c.at(time).map(|e| e.0)))
            .collect();
        let mut alphas: Vec<f64> = cells.iter().map(|c| c.0.get()).collect();
        let mut photons: Vec<u32> = cells.iter().map(|c| c.1).collect();
        alphas.sort_by(f64::total_cmp);
        alphas.dedup();
        photons.sort_unstable();
        photons.dedup();
        let known: Vec<f64> = cells.iter().filter_map(|c| c.2).collect();
        let (low, high) =
            known.iter().fold((f64::MAX, f64::MIN_POSITIVE), |(a, b), v| (a.min(*v), b.max(*v)));
        let (left, top, right, bottom) = (62.0, 34.0, 12.0, 48.0);
        let width = (640.0 - left - right) / photons.len() as f64;
        let height = (400.0 - top - bottom) / alphas.len() as f64;
        let title = format!("Error (%) at {} s, over α and photons a pass", short(time));
        let mut svg = format!(
            "<svg viewBox=\"0 0 640 400\" role=\"img\" aria-label=\"{0}\"><text class=\"title\" x=\"{left}\" y=\"18\">{0}</text>",
            escape(&title)
        );
        for (row, alpha) in alphas.iter().rev().enumerate() {
            let y = top + row as f64 * height;
            svg += &format!(
                "<text class=\"dim\" x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{}</text>",
                left - 7.0,
                y + 0.5 * height + 4.0,
                Alpha::new(*alpha).map_or_else(String::new, share)
            );
            for (column, n) in photons.iter().enumerate() {
                let x = left + column as f64 * width;
                let error = cells.iter().find(|c| c.0.get() == *alpha && c.1 == *n).and_then(|c| c.2);
                svg += &cell(error, (low, high), (x, y, width, height));
            }
        }
        for (column, n) in photons.iter().enumerate() {
            let x = left + (column as f64 + 0.5) * width;
            svg += &format!(
                "<text class=\"dim\" x=\"{x:.1}\" y=\"{}\" text-anchor=\"middle\">{}</text>",
                400.0 - bottom + 17.0,
                count((*n).into())
            );
        }
        svg += &format!(
            "<text x=\"{:.1}\" y=\"390\" text-anchor=\"middle\">photons a pass</text>\
             <text transform=\"translate(15 {:.1}) rotate(-90)\" text-anchor=\"middle\">α</text></svg>",
            0.5 * (left + 640.0 - right),
            0.5 * (top + 400.0 - bottom)
        );
        figure(Some(svg), "Dark is good. A dash: not measured at that time.")
    }
}

/// One cell of the plane: its error on its colour.
fn cell(error: Option<f64>, (low, high): (f64, f64), (x, y, width, height): (f64, f64, f64, f64)) -> String {
    let place = format!(
        "x=\"{:.1}\" y=\"{:.1}\" width=\"{:.1}\" height=\"{:.1}\" rx=\"3\"",
        x + 1.0,
        y + 1.0,
        width - 2.0,
        height - 2.0
    );
    let text =
        format!("x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\"", x + 0.5 * width, y + 0.5 * height + 4.0);
    match error {
        None => format!("<rect class=\"hole\" {place}/><text class=\"dim\" {text}>–</text>"),
        Some(error) => {
            let t = if high > low { (error / low).ln() / (high / low).ln() } else { 0.0 };
            let class = if t > 0.55 { "on-light" } else { "on-dark" };
            let fill = hex(viridis(t as f32));
            format!(
                "<rect {place} fill=\"{fill}\"/><text class=\"{class}\" {text}>{}</text>",
                three_digits(100.0 * error)
            )
        }
    }
}

/// Three significant digits.
pub(crate) fn three_digits(v: f64) -> String {
    match v.abs() {
        a if a >= 99.95 => format!("{v:.0}"),
        a if a >= 9.995 => format!("{v:.1}"),
        _ => format!("{v:.2}"),
    }
}

fn direct_name(c: &Configuration) -> &'static str {
    match c.direct_light {
        DirectLight::Auto => "auto",
        DirectLight::Photons => "photons",
        DirectLight::ShadowRays => "shadow rays",
    }
}

/// Whether a configuration is on the star: no more than one thing differs from the centre.
pub(crate) fn is_on_star(c: &Configuration, centre: &Configuration) -> bool {
    let differs = [
        c.alpha != centre.alpha,
        c.photons != centre.photons,
        c.radius_scale != centre.radius_scale,
        c.radius_rule != centre.radius_rule,
        c.direct_light != centre.direct_light,
    ];
    differs.into_iter().filter(|d| *d).count() <= 1
}
