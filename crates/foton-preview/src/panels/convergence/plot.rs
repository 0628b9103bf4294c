//! The error over time on logarithmic axes: error, noise and bias, the 2/3 law through the later part, and the target.

use std::ops::RangeInclusive;

use egui::{Color32, Ui};
use egui_plot::{GridInput, GridMark, HLine, Line, LineStyle, Plot, PlotBounds, PlotPoints, Points};

use super::bars::{bias_colour, noise_colour};
use super::left::{self, duration};
use crate::panels::text::percent;
use crate::state::{State, Trace};

const HEIGHT: f32 = 150.0;

/// Between the lowest and the highest value, as factors of ten at least: the curve of a few passes is no wall.
const DECADES: f64 = 1.0;

pub(super) fn show(ui: &mut Ui, state: &State, goal: f64) {
    let last = state.error.points.back().copied();
    let text = ui.visuals().strong_text_color();
    let target = target_colour(ui);
    let (noise, bias) = (noise_colour(ui), bias_colour(ui));
    let law = left::law(&state.error);
    let arrival = left::seconds_to(&state.error, goal).zip(last).map(|(seconds, [now, _])| now + seconds);
    let bounds = bounds(&[&state.error, &state.noise, &state.bias], 100.0 * goal, arrival);
    let plot = Plot::new("error over time")
        .height(HEIGHT)
        .allow_drag(false)
        .allow_zoom(false)
        .allow_scroll(false)
        .allow_boxed_zoom(false)
        .allow_double_click_reset(false)
        .show_x(false)
        .show_y(false)
        .show_background(false)
        .x_grid_spacer(decades)
        .y_grid_spacer(decades)
        .x_axis_formatter(
            |mark, range| if is_said(mark, range) { time_mark(mark.value) } else { String::new() },
        )
        .y_axis_formatter(
            |mark, range| if is_said(mark, range) { error_mark(mark.value) } else { String::new() },
        );
    let shown = plot.show(ui, |plot| {
        plot.set_plot_bounds(bounds);
        plot.line(Line::new("noise", logarithms(&state.noise)).color(noise).width(1.2));
        plot.line(Line::new("bias", logarithms(&state.bias)).color(bias).width(1.2));
        plot.line(Line::new("error", logarithms(&state.error)).color(text).width(2.0));
        if let Some(law) = law {
            plot.line(law_line(law, &bounds).color(text.gamma_multiply(0.7)));
        }
        plot.hline(HLine::new("target", (100.0 * goal).log10()).color(target).width(1.0));
        if let Some(at) = arrival.filter(|at| *at > 0.0) {
            let point = PlotPoints::from(vec![[at.log10(), (100.0 * goal).log10()]]);
            plot.points(Points::new("arrival", point).radius(3.5).color(target));
        }
    });
    let now = last.map_or_else(|| "unknown".to_owned(), |[_, error]| percent(error / 100.0));
    let words = format!("Error over time: now {now}, target {}", percent(goal));
    shown.response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, words.clone()));
    key(ui, text, noise, bias);
}

fn target_colour(ui: &Ui) -> Color32 {
    if ui.visuals().dark_mode { Color32::from_rgb(120, 200, 120) } else { Color32::from_rgb(0, 110, 30) }
}

/// What the lines are, below them.
fn key(ui: &mut Ui, text: Color32, noise: Color32, bias: Color32) {
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 9.0;
        ui.style_mut().override_text_style = Some(egui::TextStyle::Small);
        ui.colored_label(text, "– error");
        ui.colored_label(noise, "– noise");
        ui.colored_label(bias, "– bias");
        ui.label("- - 2/3 law").on_hover_text(
            "Error² ∝ t^(−2/3): how the error falls at best with α = 2/3, fitted to the later part",
        );
        ui.colored_label(target_colour(ui), "– target");
    });
}

fn logarithms(trace: &Trace) -> PlotPoints<'static> {
    let points = trace.points.iter().filter(|p| p[0] > 0.0 && p[1] > 0.0);
    points.map(|p| [p[0].log10(), p[1].log10()]).collect()
}

/// The line of the 2/3 law, whose error is `law` per cent after one second, across the plot.
fn law_line(law: f64, bounds: &PlotBounds) -> Line<'static> {
    let at = |x: f64| [x, law.log10() - x / 3.0];
    let ends = vec![at(bounds.min()[0]), at(bounds.max()[0])];
    Line::new("2/3 law", PlotPoints::from(ends)).style(LineStyle::dashed_loose()).width(1.2)
}

/// What the axes span: half decades, so that they stand still for long.
fn bounds(traces: &[&Trace], goal: f64, arrival: Option<f64>) -> PlotBounds {
    let points = || traces.iter().flat_map(|t| &t.points).filter(|p| p[0] > 0.0 && p[1] > 0.0);
    let span = |values: &mut dyn Iterator<Item = f64>| {
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        let (low, high) = if low <= high { (low, high) } else { (0.0, 0.0) };
        let (low, high) = ((2.0 * low).floor() / 2.0, (2.0 * high).ceil() / 2.0);
        (low, high.max(low + DECADES))
    };
    // An arrival in some months is no reason to show nothing of now.
    let latest = points().map(|p| p[0]).fold(0.0, f64::max);
    let arrival = arrival.filter(|at| *at < 100.0 * latest.max(1e-3));
    let (left, right) = span(&mut points().map(|p| p[0].log10()).chain(arrival.map(f64::log10)));
    // Noise and bias that are next to nothing are cut off.
    let errors = points().map(|p| p[1]).fold(0.0, f64::max);
    let lowest = (errors * 1e-3).max(1e-6);
    let heights = points().map(|p| p[1].max(lowest).log10()).chain([goal.log10()]);
    let (bottom, top) = span(&mut { heights });
    PlotBounds::from_min_max([left, bottom], [right, top])
}

/// Above this many powers of ten, lines between them have no words.
const CROWDED: f64 = 1.6;

/// Lines at 1, 2, 5 times powers of ten.
fn decades(input: GridInput) -> Vec<GridMark> {
    // What has words is drawn as strongly as powers of ten: words fade with their lines.
    let between = if input.bounds.1 - input.bounds.0 > CROWDED { 0.3 } else { 1.0 };
    let (low, high) = (input.bounds.0.floor() as i32, input.bounds.1.ceil() as i32);
    let marks = (low..=high).flat_map(|decade| {
        [(1.0_f64, 1.0), (2.0, between), (5.0, between)]
            .map(|(factor, step_size)| GridMark { value: f64::from(decade) + factor.log10(), step_size })
    });
    marks.filter(|mark| (input.bounds.0..=input.bounds.1).contains(&mark.value)).collect()
}

/// Whether a line has words: over several decades those between powers of ten stand too close, and at the ends of an axis there is
/// no room.
fn is_said(mark: GridMark, range: &RangeInclusive<f64>) -> bool {
    let span = range.end() - range.start();
    let is_whole = (mark.value - mark.value.round()).abs() < 1e-6;
    let margin = 0.06 * span;
    let is_inside = mark.value >= range.start() + margin && mark.value <= range.end() - margin;
    is_inside && (is_whole || span <= CROWDED)
}

fn time_mark(log: f64) -> String {
    let seconds = 10_f64.powf(log);
    if seconds < 1.0 { format!("{seconds:.*} s", (-log).ceil().max(0.0) as usize) } else { duration(seconds) }
}

fn error_mark(log: f64) -> String {
    let value = 10_f64.powf(log);
    let digits = if value < 0.95 { (-log).ceil().max(0.0) as usize } else { 0 };
    format!("{value:.digits$} %")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_stand_still_while_the_error_falls_a_little() {
        let mut trace = Trace::default();
        for i in 10..40 {
            trace.push(f64::from(i), 100.0 / f64::from(i));
        }
        let before = bounds(&[&trace], 2.0, None);
        trace.push(41.0, 2.4);
        let after = bounds(&[&trace], 2.0, None);
        assert_eq!((before.min(), before.max()), (after.min(), after.max()));
        assert!(before.min()[0] <= 1.0 && before.max()[0] >= 40_f64.log10());
        let empty = bounds(&[&Trace::default()], 2.0, None);
        assert!(empty.is_valid(), "{empty:?}");
    }

    #[test]
    fn marks_are_words() {
        assert_eq!(
            (time_mark(-1.0), time_mark(1.0), time_mark(3.0)),
            ("0.1 s".into(), "10 s".into(), "17 min".into())
        );
        let mark = |value: f64| error_mark(value.log10());
        assert_eq!((mark(10.0), mark(2.0), mark(0.5)), ("10 %".into(), "2 %".into(), "0.5 %".into()));
    }
}
