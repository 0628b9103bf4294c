//! The live error: its figure, its split, its plot, and when it will be small enough.

use foton_session::{ErrorEstimate, StopRule};

use crate::state::{State, Trace};

/// Points of a trace that a slope is fitted to, at least.
const MIN_POINTS: usize = 6;

/// What a person who asks for nothing else may want to know the time to: 2 %.
const USUAL_GOAL: f64 = 0.02;

const HELP: &str = "Root mean square error of the image over its mean reflected light, estimated from the passes. Noise is what more \
                    photons take away, bias what smaller radii do. Left out: what the eye samples miss, light that no photon has \
                    found, most of the bias right at edges";

/// Names and remedies of the parts of the error.
const CLASSES: [(&str, &str); 3] = [
    (
        "of it direct",
        "What light straight from emitters has of the error (noise, bias). Direct light by shadow rays has no bias",
    ),
    (
        "caustic",
        "What light by mirrors and glass has of the error (noise, bias). Against its bias helps a smaller radius, against its noise \
         more photons",
    ),
    (
        "indirect",
        "What light by surfaces that scatter has of the error (noise, bias). Against its noise help a larger radius and more passes",
    ),
];

/// "3.1 %".
fn percent(share: f64) -> String {
    let digits = if share < 0.1 { 2 } else { 1 };
    format!("{:.digits$} %", 100.0 * share)
}

/// The figure in the line at the bottom.
pub(super) fn status(ui: &mut egui::Ui, error: Option<&ErrorEstimate>) {
    let Some(e) = error else { return };
    let text = format!("error {} (noise {}, bias {})", percent(e.total), percent(e.noise), percent(e.bias));
    ui.label(text).on_hover_text(HELP);
    ui.separator();
}

/// A row of the table of statistics.
pub(super) struct Row {
    pub(super) name: &'static str,
    pub(super) value: String,
    pub(super) help: &'static str,
}

impl Row {
    pub(super) fn new(name: &'static str, value: impl Into<String>, help: &'static str) -> Self {
        Self { name, value: value.into(), help }
    }
}

/// The rows of the error.
pub(super) fn rows(state: &State) -> Vec<Row> {
    let Some((frame, e)) = state.frame.as_ref().and_then(|f| Some((f, f.stats.error?))) else {
        return Vec::new();
    };
    let mut rows = vec![
        Row::new("error", percent(e.total), HELP),
        Row::new("noise, bias", format!("{}, {}", percent(e.noise), percent(e.bias)), HELP),
        Row::new(
            "from, to ",
            format!("{}, {}", percent(e.low), percent(e.high)),
            "The error lies between these, nine times in ten; the upper end takes all bias to be that of edges, of which the \
             estimate sees a half",
        ),
    ];
    if e.is_of_narrow_light() {
        rows.push(Row::new(
            "narrow light",
            percent(e.focus),
            "Light narrower than the discs (foci, beams) may add this: a few bright pixels decide, and how much is uncertain. More eye \
             samples a pixel make the smallest radius smaller",
        ));
    }
    for ((name, help), part) in CLASSES.into_iter().zip(e.classes.iter().flatten()) {
        let text = format!("{} ({}, {})", percent(part.total()), percent(part.noise), percent(part.bias));
        rows.push(Row::new(name, text, help));
    }
    let goal = frame.stop.error.unwrap_or(USUAL_GOAL);
    if let Some(seconds) = seconds_to(&state.error, goal) {
        let text = format!("about {} to {}", duration(seconds), percent(goal));
        rows.push(Row::new("time left", text, "From the slope of the error over time, both as logarithms"));
    }
    rows
}

/// "40 s", "12 min", "3 h".
fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 120.0 => format!("{s:.0} s"),
        s if s < 7200.0 => format!("{:.0} min", s / 60.0),
        s if s < 1e7 => format!("{:.0} h", s / 3600.0),
        _ => "months".to_owned(),
    }
}

/// No error falls faster in the long run than that of independent passes. At first it seems to, since time also counts the eye
/// pass.
const STEEPEST: f64 = -0.5;

/// Seconds until the error is at a goal, going on with the slope of the later part of its trace on logarithmic axes; `None` when
/// it is there already or does not fall.
fn seconds_to(trace: &Trace, goal: f64) -> Option<f64> {
    let &[now, error] = trace.points.back()?;
    let since = now / 4.0;
    let points = trace.points.iter().filter(|p| p[0] >= since && p[0] > 0.0 && p[1] > 0.0);
    let logs: Vec<[f64; 2]> = points.map(|p| [p[0].ln(), (p[1] / 100.0).ln()]).collect();
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

/// The part of the stop rule that asks for an error.
pub(super) fn stop_at(ui: &mut egui::Ui, rule: StopRule) -> StopRule {
    let mut share = rule.error;
    ui.horizontal(|ui| {
        let mut on = rule.error.is_some();
        let label = ui.checkbox(&mut on, "at error");
        let mut value = 100.0 * rule.error.unwrap_or(USUAL_GOAL);
        let field = egui::DragValue::new(&mut value).range(0.01..=99.0).speed(0.02).max_decimals(2);
        ui.add_enabled(on, field.suffix(" %"))
            .labelled_by(label.id)
            .on_hover_text("Pauses once the error is certainly below: its upper end counts, and not before photons are found");
        share = on.then_some(value / 100.0);
    });
    StopRule { error: share, ..rule }
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
        assert_eq!(
            (duration(40.2), duration(720.0), duration(7300.0)),
            ("40 s".into(), "12 min".into(), "2 h".into())
        );
    }
}
