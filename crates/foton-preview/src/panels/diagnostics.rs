//! Diagnostics: how fast, how large, where the time and the light went. Folded until someone wants to know.

use std::time::Duration;

use egui::Ui;
use foton_session::engine::{Frame, RenderStats};
use foton_session::{Ledger, findings::MIN_CUT_OFF};

use super::figures::Figure;
use super::text::{grouped, short};
use crate::state::State;

pub(super) fn show(ui: &mut Ui, state: &State) {
    let Some(frame) = &state.frame else { return };
    render(frame).iter().for_each(|figure| figure.show(ui));
    light(&frame.stats.ledger).iter().for_each(|figure| figure.show(ui));
    stages(ui, &frame.stats);
    if !state.adapter.is_empty() {
        ui.add(egui::Label::new(egui::RichText::new(&state.adapter).weak()).wrap());
    }
}

/// Speed, hit points, radii, memory, size.
fn render(frame: &Frame) -> Vec<Figure> {
    let method = frame.settings.method;
    let (n, r) = (&frame.stats, &frame.stats.radii);
    let millions = |rate: f64| format!("{:.2} M", rate / 1e6);
    let mut figures = vec![Figure::new(
        "Render time",
        format!("{:.1} s", n.elapsed.as_secs_f64()),
        "Pauses and loading do not count",
    )];
    if method.has_photons() {
        figures.push(Figure::new("Photons/s", millions(n.photons_per_s), "Over the last two seconds"));
    }
    figures.push(Figure::new("Rays/s", millions(n.rays_per_s), "Over the last two seconds"));
    if method.has_discs() {
        figures.extend([
            Figure::new(
                "Hit points",
                grouped(n.hit_points),
                "Where eye paths end on surfaces that spread light",
            ),
            Figure::new(
                "Unlit hit points",
                format!("{:.2} %", n.no_photon_share * 100.0),
                "Hit points that no photon has found yet: unknown, not dark",
            ),
            Figure::new("Radius", short(r.median), "Median over all hit points, in world units"),
            Figure::new(
                "Radius range",
                format!("{} \u{2013} {}", short(r.smallest), short(r.largest)),
                "Smallest and largest radius, in world units",
            ),
        ]);
    }
    figures.extend([
        Figure::new(
            "Memory",
            format!("{:.0} MiB", n.bytes as f64 / f64::from(1 << 20)),
            "Scene, pixels, hit points and photons",
        ),
        Figure::new("Image", format!("{} × {}", frame.size[0], frame.size[1]), "In pixels"),
    ]);
    figures
}

/// What became of the emitted light.
fn light(ledger: &Ledger) -> Vec<Figure> {
    if ledger.emitted <= 0.0 {
        return Vec::new();
    }
    let percent = |power: f64| format!("{:.2} %", 100.0 * power / ledger.emitted);
    let mut figures = vec![
        Figure::new(
            "Absorbed",
            percent(ledger.absorbed),
            "Share of the emitted light that surfaces absorbed",
        ),
        Figure::new("Escaped", percent(ledger.escaped), "Share of the emitted light that left the scene"),
        Figure::new(
            "Truncated (max depth)",
            percent(ledger.truncated),
            "Share of the emitted light that was still under way at the longest path",
        )
        .warning(ledger.truncated > MIN_CUT_OFF * ledger.emitted),
        Figure::new(
            "Invalid",
            grouped(ledger.dropped),
            "Photons that were dropped because their power was no number",
        )
        .warning(ledger.dropped > 0),
    ];
    if ledger.shading_gain > 0.0 {
        figures.push(Figure::new(
            "Gained at normals",
            percent(ledger.shading_gain),
            "Light that photons gain where interpolated normals differ from true ones, beside what they lose there",
        ));
    }
    figures
}

/// Where the time went.
fn stages(ui: &mut Ui, n: &RenderStats) {
    let all: f64 = n.stages.iter().map(|(_, t)| t.as_secs_f64()).sum();
    if all <= 0.0 {
        return;
    }
    let large = n.stages.iter().filter(|(_, t)| t.as_secs_f64() > 0.005 * all);
    let share = |t: Duration| 100.0 * t.as_secs_f64() / all;
    let parts = large.map(|(stage, t)| format!("{} {:.0} %", stage.name().replace('_', " "), share(t)));
    let text = egui::RichText::new(parts.collect::<Vec<_>>().join(" · ")).weak();
    ui.add(egui::Label::new(text).wrap()).on_hover_text("Where the time went, in all");
}
