//! How long it takes until the render stops by its rule, or until its error is as small as most people want.

use foton_session::engine::Frame;

use crate::state::{State, Trace};

/// Points of a trace that a slope is fitted to, at least.
const MIN_POINTS: usize = 6;

/// What a person who asks for nothing else may want to know the time to: 2 %.
const USUAL_GOAL: f64 = 0.02;

/// No error falls faster in the long run than that of independent passes. At first it seems to, since time also counts the eye
/// pass.
const STEEPEST: f64 = -0.5;

/// Seconds that are left, and until what.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Left {
    /// Until the stop rule ends the render.
    ToStop(f64),
    /// Until the error is at a share that nobody asked for.
    ToError(f64, f64),
}

/// The error that the panel shows the way to.
pub(super) fn goal(frame: &Frame) -> f64 {
    frame.stop.error.unwrap_or(USUAL_GOAL)
}

/// The time left by whichever rule is reached first; without a rule the time to the usual goal. `None` where nothing is known.
pub(crate) fn left(state: &State) -> Option<Left> {
    let frame = state.frame.as_ref()?;
    let (n, rule) = (&frame.stats, &frame.stop);
    if rule.passes.is_none() && rule.time.is_none() && rule.error.is_none() {
        return seconds_to(&state.error, USUAL_GOAL).map(|seconds| Left::ToError(seconds, USUAL_GOAL));
    }
    let by_passes = rule.passes.and_then(|limit| {
        let photons =
            limit.saturating_sub(n.passes) as f64 * f64::from(frame.settings.ppm.photons_per_pass.get());
        (n.photons_per_s > 0.0).then(|| photons / n.photons_per_s)
    });
    let by_time = rule.time.map(|limit| limit.saturating_sub(n.elapsed).as_secs_f64());
    // It is the upper end of the interval that has to fall below.
    let by_error = rule.error.and_then(|goal| seconds_to(&state.upper_error, goal));
    let first = by_passes.into_iter().chain(by_time).chain(by_error).reduce(f64::min);
    first.map(Left::ToStop)
}

/// "40 s", "12 min", "3 h".
pub(crate) fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 120.0 => format!("{s:.0} s"),
        s if s < 7200.0 => format!("{:.0} min", s / 60.0),
        s if s < 1e7 => format!("{:.0} h", s / 3600.0),
        _ => "months".to_owned(),
    }
}

/// The later part of a trace, as logarithms of seconds and per cent.
fn later_logs(trace: &Trace) -> Vec<[f64; 2]> {
    let since = trace.points.back().map_or(0.0, |p| p[0] / 4.0);
    let points = trace.points.iter().filter(|p| p[0] >= since && p[0] > 0.0 && p[1] > 0.0);
    points.map(|p| [p[0].ln(), p[1].ln()]).collect()
}

/// Per cent after one second of the error that falls by the 2/3 law, error² ∝ t^(−2/3), closest to the later part of a trace.
pub(super) fn law(trace: &Trace) -> Option<f64> {
    let logs = later_logs(trace);
    if logs.len() < MIN_POINTS {
        return None;
    }
    let mean = logs.iter().map(|[x, y]| y + x / 3.0).sum::<f64>() / logs.len() as f64;
    Some(mean.exp())
}

/// Seconds until the error is at a goal, going on with the slope of the later part of its trace on logarithmic axes; `None` when
/// it is there already or does not fall.
pub(super) fn seconds_to(trace: &Trace, goal: f64) -> Option<f64> {
    let &[now, error] = trace.points.back()?;
    let logs = later_logs(trace);
    if logs.len() < MIN_POINTS || error <= 100.0 * goal {
        return None;
    }
    let n = logs.len() as f64;
    let mean = |axis: usize| logs.iter().map(|p| p[axis]).sum::<f64>() / n;
    let (x, y) = (mean(0), mean(1));
    let slope = logs.iter().map(|p| (p[0] - x) * (p[1] - y)).sum::<f64>()
        / logs.iter().map(|p| (p[0] - x).powi(2)).sum::<f64>();
    let slope = slope.max(STEEPEST);
    let seconds = now * ((100.0 * goal / error).powf(1.0 / slope) - 1.0);
    (slope < -0.02 && seconds > 0.0).then_some(seconds)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_time_left_is_that_of_the_slope() {
        let mut trace = Trace::default();
        for i in 1..=40 {
            let seconds = f64::from(i);
            trace.push(seconds, 100.0 * 0.2 * seconds.powf(-1.0 / 3.0));
        }
        // 0.2 t^(−1/3) = 0.04 at t = 125.
        let left = seconds_to(&trace, 0.04).expect("it falls");
        assert!((left - 85.0).abs() < 1e-6, "{left}");
        assert_eq!(seconds_to(&trace, 0.3), None, "it is there already");
        let mut steep = Trace::default();
        (1..=40).for_each(|i| steep.push(f64::from(i), 100.0 / f64::from(i)));
        let left = seconds_to(&steep, 0.0125).expect("it falls");
        assert!((left - 120.0).abs() < 1e-6, "half the error takes four times as long: {left}");
        let mut flat = Trace::default();
        (1..40).for_each(|i| flat.push(f64::from(i), 5.0));
        assert_eq!(seconds_to(&flat, 0.04), None, "it does not fall");
        let law = law(&trace).expect("points enough");
        assert!((law - 20.0).abs() < 1e-9, "{law} % after a second");
        assert_eq!(
            (duration(40.2), duration(720.0), duration(7300.0)),
            ("40 s".into(), "12 min".into(), "2 h".into())
        );
    }
}
