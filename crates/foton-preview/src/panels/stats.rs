//! The statistics: how the render stands, where its time goes, and how both went.

use std::time::Duration;

use egui_plot::{Line, Plot, PlotPoints};
use foton_session::Ledger;
use foton_session::engine::{Activity, Frame, RenderStats, SurfaceNames};
use foton_session::findings::MIN_CUT_OFF;

use super::error::{self, Row};
use super::text::{grouped, short};
use super::widgets::heading;
use crate::state::{State, Trace};

/// The line at the bottom.
pub(super) fn status(ui: &mut egui::Ui, state: &State) {
    ui.horizontal(|ui| {
        let Some(frame) = &state.frame else {
            ui.weak("no scene");
            return;
        };
        let n = &frame.stats;
        ui.label(activity(frame));
        ui.separator();
        ui.label(format!("pass {}", n.passes));
        ui.separator();
        ui.label(format!("{} photons", grouped(n.photons)));
        ui.separator();
        ui.label(format!("{:.2} M photons/s", n.photons_per_s / 1e6));
        ui.separator();
        error::status(ui, n.error.as_ref());
        if let Some(probe) = frame.probe.as_ref().filter(|p| Some(p.pixel) == state.probed) {
            let c = probe.radiance;
            let [r, g, b] = [c.r, c.g, c.b].map(|v| short(f64::from(v)));
            let mut text = format!("({}, {})  {r} {g} {b} W/m²/sr", probe.pixel[0], probe.pixel[1]);
            if let Some(radius) = probe.radius {
                text += &format!("  r {}  N {}", short(radius), grouped(probe.photons_found));
            }
            if let Some(distance) = probe.distance {
                text += &format!("  depth {}", short(distance));
            }
            if let Some(SurfaceNames { shape, material }) = &probe.surface {
                text += &format!("  {shape} · {material}");
            }
            ui.label(text);
        } else {
            ui.weak(&frame.scene.name);
        }
    });
}

fn activity(frame: &Frame) -> String {
    match frame.activity {
        Activity::Empty => "no scene".to_owned(),
        Activity::Moving => "moving".to_owned(),
        Activity::Building => "building the scene…".to_owned(),
        Activity::Collecting => "collecting hit points…".to_owned(),
        Activity::Rendering => match share_done(frame) {
            Some(share) => format!("rendering {:.0} %", share * 100.0),
            None => "rendering".to_owned(),
        },
        Activity::Paused => "paused".to_owned(),
        Activity::Done => "done".to_owned(),
    }
}

fn share_done(frame: &Frame) -> Option<f64> {
    let n = &frame.stats;
    frame.stop.fraction(n.passes, n.elapsed, n.error.as_ref())
}

/// The table, findings and plots.
pub(super) fn show(ui: &mut egui::Ui, state: &mut State) {
    let Some(frame) = state.frame.clone() else { return };
    let n = &frame.stats;
    heading(ui, "Statistics");
    egui::Grid::new("stats").num_columns(2).spacing([12.0, 3.0]).show(ui, |ui| {
        let time = Row::new(
            "time",
            format!("{:.1} s", n.elapsed.as_secs_f64()),
            "Of rendering; pauses do not count",
        );
        let all = [time].into_iter().chain(error::rows(state)).chain(render_rows(&frame));
        all.for_each(|row| add(ui, &row, None));
        light_rows(ui, &n.ledger);
    });
    findings(ui, n);
    stages(ui, n);
    ui.checkbox(&mut state.preferences.show_plots, "Plots");
    if state.preferences.show_plots {
        plot(ui, "M photons/s over time (s)", &state.rate);
        plot(ui, "error over time (%, s)", &state.error);
        plot(ui, "median radius over time (s)", &state.radius);
    }
    if !state.adapter.is_empty() {
        ui.weak(&state.adapter);
    }
}

/// Adds a row to the table, its value in a colour if one is given.
fn add(ui: &mut egui::Ui, row: &Row, colour: Option<egui::Color32>) {
    ui.weak(row.name).on_hover_text(row.help);
    let value = egui::RichText::new(&row.value).monospace();
    ui.label(colour.map_or_else(|| value.clone(), |colour| value.clone().color(colour)));
    ui.end_row();
}

/// Speed, hit points, radii, memory, size.
fn render_rows(frame: &Frame) -> [Row; 7] {
    let (n, r) = (&frame.stats, &frame.stats.radii);
    [
        Row::new("rays/s", format!("{:.2} M", n.rays_per_s / 1e6), "Over the last two seconds"),
        Row::new("hit points", grouped(n.hit_points), "Where eye paths end on surfaces that spread light"),
        Row::new("without photon", format!("{:.2} %", n.no_photon_share * 100.0), "Unknown, not dark"),
        Row::new("radius", short(r.median), "Median over all hit points, in world units"),
        Row::new(
            "from, to",
            format!("{}, {}", short(r.smallest), short(r.largest)),
            "Smallest and largest radius",
        ),
        Row::new(
            "memory",
            format!("{:.0} MiB", n.bytes as f64 / f64::from(1 << 20)),
            "Scene, hit points and photons",
        ),
        Row::new("image", format!("{} × {}", frame.size[0], frame.size[1]), "In pixels"),
    ]
}

/// What became of the emitted light.
fn light_rows(ui: &mut egui::Ui, ledger: &Ledger) {
    if ledger.emitted <= 0.0 {
        return;
    }
    let percent = |power: f64| format!("{:.2} %", 100.0 * power / ledger.emitted);
    let absorbed = Row::new(
        "absorbed, escaped",
        format!("{}, {}", percent(ledger.absorbed), percent(ledger.escaped)),
        "Of the emitted light: absorbed by surfaces, and gone from the scene",
    );
    add(ui, &absorbed, None);
    let missing = Row::new(
        "cut off, dropped",
        format!("{}, {}", percent(ledger.truncated), grouped(ledger.dropped)),
        "Light still under way at the longest path, and photons whose power was no number; max_depth in the scene file moves the \
         end",
    );
    let is_much = ledger.truncated > MIN_CUT_OFF * ledger.emitted || ledger.dropped > 0;
    add(ui, &missing, is_much.then_some(ui.visuals().warn_fg_color));
    if ledger.shading_gain > 0.0 {
        let gained = Row::new(
            "gained at normals",
            percent(ledger.shading_gain),
            "Light that photons gain where interpolated normals differ from true ones, beside what they lose there",
        );
        add(ui, &gained, None);
    }
}

/// Where the time went.
fn stages(ui: &mut egui::Ui, n: &RenderStats) {
    let all: f64 = n.stages.iter().map(|(_, t)| t.as_secs_f64()).sum();
    if all <= 0.0 {
        return;
    }
    let large = n.stages.iter().filter(|(_, t)| t.as_secs_f64() > 0.005 * all);
    let share = |t: Duration| 100.0 * t.as_secs_f64() / all;
    let parts = large.map(|(stage, t)| format!("{} {:.0} %", stage.name().replace('_', " "), share(t)));
    ui.weak(parts.collect::<Vec<_>>().join(" · ")).on_hover_text("Where the time went, in all");
}

/// What the command line prints as warnings after a render.
fn findings(ui: &mut egui::Ui, n: &RenderStats) {
    let colour = ui.visuals().warn_fg_color;
    for finding in &*n.findings {
        let text = egui::RichText::new(foton_input::printable(&finding.text));
        ui.label(if finding.kind.is_note() { text.weak() } else { text.color(colour) });
    }
}

fn plot(ui: &mut egui::Ui, name: &str, trace: &Trace) {
    ui.weak(name);
    let points: Vec<[f64; 2]> = trace.points.iter().copied().collect();
    let last = points.last().copied();
    let plot = Plot::new(name)
        .height(72.0)
        .allow_drag(false)
        .allow_zoom(false)
        .allow_scroll(false)
        .allow_boxed_zoom(false)
        .show_x(false)
        .include_y(0.0)
        .show(ui, |plot| plot.line(Line::new(name, PlotPoints::from(points))));
    let words = last.map_or_else(|| name.to_owned(), |[_, value]| format!("{name}: now {}", short(value)));
    plot.response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, words.clone()));
}
