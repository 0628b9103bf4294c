//! What steers the render while it runs, and when it stops.

use std::num::NonZeroU32;
use std::time::Duration;

use egui::Ui;
use foton_session::engine::Command;
use foton_session::{Alpha, RenderSettings, SettingChange, StopRule};

use super::number::{Change, Digits, Number};
use super::optional::optional;
use super::slider::Slider;
use super::widgets::row;
use crate::state::State;

const ALPHA_HELP: &str = "Share of new photons that each hit point keeps, from above 0 to 1. Small: radii shrink fast, so bias goes and \
                          noise stays. Large: smooth, but the bias of the radius stays longer. 2/3 lets both fall together. Costs no \
                          time.";

const PHOTONS_HELP: &str = "Photons traced in each pass, 1 024 to 16 777 216, from the next pass on. Fewer: the picture answers sooner. \
                            More: less overhead for each photon, and radii shrink by fewer, better-founded steps.";

const PASSES_HELP: &str = "Pauses after this many passes; raise the number and press Resume to continue";

const TIME_HELP: &str = "Pauses after this much rendering; a pass that would end later is not begun. 90 s, 5 min and 2 h can be typed";

const ERROR_HELP: &str = "Pauses once the error is certainly below: the upper end of its interval counts, and not before photons are \
                          found";

pub(super) fn show(ui: &mut Ui, state: &mut State) {
    let Some((settings, rule)) = state.frame.as_ref().map(|f| (f.settings.clone(), f.stop)) else { return };
    if settings.method.has_discs() {
        alpha(ui, state, &settings);
        photons(ui, state, &settings);
    }
    stop_rule(ui, state, rule);
}

fn alpha(ui: &mut Ui, state: &mut State, settings: &RenderSettings) {
    let value = settings.ppm.alpha.get();
    row(ui, "α", ALPHA_HELP, |ui, _| {
        let number = Number::new("α", 0.001..=1.0).digits(Digits::Decimals(3)).speed(0.002);
        let ([slider, field], change) = Slider::new("α", 0.01..=1.0).show(ui, number, value);
        state.place("alpha", &slider);
        state.place("alpha field", &field);
        (slider | field).on_hover_text(ALPHA_HELP);
        // It may be steered live, since a change costs nothing.
        if let Some(Change::Moving(new) | Change::Done(new)) = change
            && new != value
            && let Some(alpha) = Alpha::new(new)
        {
            state.steer(SettingChange::Alpha(alpha));
        }
    });
}

fn photons(ui: &mut Ui, state: &mut State, settings: &RenderSettings) {
    let value = f64::from(settings.ppm.photons_per_pass.get());
    row(ui, "Photons/pass", PHOTONS_HELP, |ui, _| {
        let number =
            Number::new("Photons/pass", 1.0..=f64::from(u32::MAX)).digits(Digits::Whole).speed(1024.0);
        let slider = Slider::new("Photons/pass", 1024.0..=f64::from(1 << 24)).logarithmic(true);
        let ([slider, field], change) = slider.show(ui, number, value);
        state.place("photons per pass", &field);
        (slider | field).on_hover_text(PHOTONS_HELP);
        if let Some(photons) = change.and_then(Change::done).and_then(|v| NonZeroU32::new(v as u32))
            && photons != settings.ppm.photons_per_pass
        {
            state.steer(SettingChange::PhotonsPerPass(photons));
        }
    });
}

fn stop_rule(ui: &mut Ui, state: &mut State, rule: StopRule) {
    let [passes, seconds, percent] = &mut state.stop_values;
    ui.add_space(2.0);
    // What is left of the field, which is as wide as its digits.
    let width = ui.available_width() - 84.0;
    let number = Number::new("Stop after passes", 1.0..=1e9).digits(Digits::Whole).speed(1.0);
    let new_passes =
        optional(ui, width, "Stop after passes", PASSES_HELP, rule.passes.map(|n| n as f64), *passes, number);
    let number = Number::new("Stop after time", 0.1..=1e7).unit("s").speed(0.5);
    let new_seconds = optional(
        ui,
        width,
        "Stop after time",
        TIME_HELP,
        rule.time.map(|t| t.as_secs_f64()),
        *seconds,
        number,
    );
    let number = Number::new("Stop at error", 0.01..=99.0).unit("%").speed(0.02);
    let new_percent =
        optional(ui, width, "Stop at error", ERROR_HELP, rule.error.map(|e| 100.0 * e), *percent, number);
    for (value, new) in [(passes, new_passes), (seconds, new_seconds), (percent, new_percent)] {
        *value = new.unwrap_or(*value);
    }
    let new = StopRule {
        passes: new_passes.map(|n| n as u64),
        // What was not touched stays as it is, to the last bit.
        time: if new_seconds == rule.time.map(|t| t.as_secs_f64()) {
            rule.time
        } else {
            new_seconds.map(Duration::from_secs_f64)
        },
        error: if new_percent == rule.error.map(|e| 100.0 * e) {
            rule.error
        } else {
            new_percent.map(|p| p / 100.0)
        },
    };
    if new != rule {
        state.ask(Command::StopAt(new));
    }
}
