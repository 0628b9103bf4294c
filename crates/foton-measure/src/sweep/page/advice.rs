//! What to take: errors at a common time, and the configuration with the least.

use crate::plot::short;
use crate::sweep::plan::Configuration;
use crate::sweep::table::Point;

/// A recommendation.
pub(crate) struct Advice {
    pub(crate) sentence: String,
    pub(crate) best: Configuration,
}

/// One configuration's points in the order of their time.
pub(crate) struct Curve<'a> {
    pub(crate) configuration: Configuration,
    pub(crate) points: Vec<&'a Point>,
}

impl Curve<'_> {
    /// Error and its standard deviation between seeds at a time, on a straight line between logarithms; `None` outside.
    pub(crate) fn at(&self, time: f64) -> Option<(f64, f64)> {
        let after = self.points.iter().position(|p| p.cpu >= time)?;
        let b = self.points[after];
        let Some(a) = after.checked_sub(1).map(|before| self.points[before]) else {
            return (b.cpu <= time).then_some((b.error, b.error_deviation));
        };
        let t = (time / a.cpu).ln() / (b.cpu / a.cpu).ln();
        let error = (a.error.ln() * (1.0 - t) + b.error.ln() * t).exp();
        Some((error, a.error_deviation * (1.0 - t) + b.error_deviation * t))
    }

    /// The time at which the error first falls to a share.
    pub(crate) fn time_to(&self, error: f64) -> Option<f64> {
        let after = self.points.iter().position(|p| p.error <= error)?;
        let b = self.points[after];
        let Some(a) = after.checked_sub(1).map(|before| self.points[before]) else { return Some(b.cpu) };
        let t = (a.error / error).ln() / (a.error / b.error).ln();
        Some((a.cpu.ln() * (1.0 - t) + b.cpu.ln() * t).exp())
    }

    fn last(&self) -> f64 {
        self.points.last().map_or(0.0, |p| p.cpu)
    }
}

/// All configurations, in the order in which they ran.
pub(crate) fn curves(points: &[Point]) -> Vec<Curve<'_>> {
    let mut curves: Vec<Curve<'_>> = Vec::new();
    for point in points {
        match curves.iter_mut().find(|c| c.configuration == point.configuration) {
            Some(curve) => curve.points.push(point),
            None => curves.push(Curve { configuration: point.configuration, points: vec![point] }),
        }
    }
    for curve in &mut curves {
        curve.points.sort_by(|a, b| a.cpu.total_cmp(&b.cpu));
    }
    curves
}

/// A round time that at least three quarters of the configurations reach.
pub(crate) fn common_time(curves: &[Curve<'_>]) -> Option<f64> {
    let mut last: Vec<f64> = curves.iter().map(Curve::last).collect();
    last.sort_by(f64::total_cmp);
    last.get(last.len() / 4).and_then(|reached| round(*reached))
}

/// The next round number below.
fn round(reached: f64) -> Option<f64> {
    let steps = [1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0];
    let power = 10f64.powf(reached.log10().floor());
    steps.into_iter().rev().map(|step| step * power).find(|time| *time <= reached)
}

/// The configuration with the least error at the round time that the centre reaches; of those that ran as long.
///
/// The centre's own is beside it, and whether the difference is more than what seeds scatter.
pub(crate) fn recommend(name: &str, centre: &Configuration, points: &[Point]) -> Option<Advice> {
    let curves = curves(points);
    let central = curves.iter().find(|c| c.configuration == *centre)?;
    let time = round(central.last())?;
    let there = curves.iter().filter_map(|c| Some((c, c.at(time)?)));
    let (best, (error, deviation)) = there.min_by(|a, b| a.1.0.total_cmp(&b.1.0))?;
    let percent = |share: f64| short((share * 1e4).round() / 100.0);
    let mut sentence = format!(
        "For {name} at {} s of processor time: {}; error {} ± {} %",
        short(time),
        best.configuration,
        percent(error),
        percent(deviation)
    );
    if let Some((own, own_deviation)) = central.at(time).filter(|_| best.configuration != *centre) {
        sentence += &format!(" ({} ± {} % at the centre", percent(own), percent(own_deviation));
        if own - error < deviation.hypot(own_deviation) {
            sentence += ", no clear difference";
        }
        sentence.push(')');
    }
    sentence.push('.');
    Some(Advice { sentence, best: best.configuration })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sweep::table::tests::point;
    use foton_integrator::{Alpha, RenderSettings};

    #[test]
    fn the_least_error_at_a_time_that_most_reach_is_recommended() {
        let centre = Configuration::of(&RenderSettings::default());
        let better = Configuration { alpha: Alpha::new(0.8).expect("in range"), ..centre };
        let brief = Configuration { alpha: Alpha::new(0.5).expect("in range"), ..centre };
        // The brief one is best where it is, which is not where most are.
        let points = [
            point(centre, 1.0, 0.10),
            point(centre, 100.0, 0.01),
            point(better, 1.0, 0.08),
            point(better, 100.0, 0.008),
            point(centre, 10.0, 0.0316),
            point(brief, 0.5, 0.001),
        ];
        let curves = curves(&points);
        assert_eq!(curves.len(), 3);
        let (error, _) = curves[0].at(10.0).expect("measured");
        assert!((error - 0.0316).abs() < 1e-9, "{error}");
        assert!((curves[1].at(10.0).expect("between").0 - 0.0253).abs() < 1e-4);
        assert!(curves[0].at(0.5).is_none() && curves[0].at(101.0).is_none());
        assert!((curves[1].time_to(0.0253).expect("reached") - 10.0).abs() < 0.01);
        assert_eq!(curves[1].time_to(0.001), None);
        let time = common_time(&curves[..2]).expect("some");
        assert_eq!(time, 100.0);
        let advice = recommend("ring", &centre, &points[..5]).expect("points");
        assert_eq!(advice.best, better);
        assert_eq!(
            advice.sentence,
            "For ring at 100 s of processor time: α 0.8, 262 k photons, radius × 1; error 0.8 ± 0.02 % (1 ± 0.02 % at the centre)."
        );
        assert!(recommend("nothing", &centre, &[]).is_none());
    }
}
