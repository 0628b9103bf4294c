//! The settings that restart the render. Nothing happens until they are applied, and what will be different is said before.

use std::num::NonZeroU32;

use egui::Ui;
use foton_session::engine::{Command, Configuration};
use foton_session::{DirectLight, Method, RadiusFloor, RadiusRule};

use super::number::{Change, Digits, Number};
use super::optional::optional;
use super::slider::Slider;
use super::widgets::{LABEL, row};
use crate::state::State;

pub(super) fn show(ui: &mut Ui, state: &mut State) {
    let Some(frame) = state.frame.clone() else { return };
    let now = Configuration::of(&frame.settings, frame.threads, frame.region);
    let mut draft = match state.draft.take() {
        Some((base, draft)) => rebased(draft, &base, &now),
        None => now.clone(),
    };
    method(ui, &mut draft);
    if draft.method.has_discs() {
        discs(ui, &mut draft);
    }
    samples(ui, &mut draft);
    if draft.method.has_discs() {
        radii(ui, &mut draft, frame.stats.radii.median);
    }
    depth(ui, &mut draft);
    let seed = seed_and_threads(ui, &mut draft);
    state.place("seed", &seed);
    let names: Vec<&str> = frame.scene.sensors.iter().map(|s| s.name.as_str()).collect();
    sensors(ui, &names, &mut draft);
    let changes = changes(&now, &draft, &names);
    if changes.is_empty() {
        ui.weak("Changes here take effect when you apply them, and restart the render.");
        return;
    }
    ui.add_space(2.0);
    ui.label(format!("Restarts the render with {}.", changes.join(", ")));
    ui.horizontal(|ui| {
        if ui.button("Apply and restart").clicked() {
            state.ask(Command::Configure(draft.clone()));
            state.notice(format!("Restarted with {}", changes.join(", ")));
        } else if !ui.button("Revert").on_hover_text("Back to the settings of this render").clicked() {
            state.draft = Some((now, draft));
        }
    });
}

/// A draft that was made over other settings than there are now: what it changed stays changed, the rest is as it is now.
fn rebased(draft: Configuration, base: &Configuration, now: &Configuration) -> Configuration {
    macro_rules! newest {
        ($($field:ident),*) => {
            Configuration {
                $($field: if draft.$field == base.$field { now.$field } else { draft.$field },)*
            }
        };
    }
    newest!(
        method,
        radius,
        radius_floor,
        radius_rule,
        direct_light,
        samples_per_pixel,
        seed,
        sensor,
        region,
        max_depth,
        threads
    )
}

const fn direct_light_name(method: DirectLight) -> &'static str {
    match method {
        DirectLight::Auto => "Auto",
        DirectLight::Photons => "Photons",
        DirectLight::ShadowRays => "Shadow rays",
    }
}

const fn radius_rule_name(rule: RadiusRule) -> &'static str {
    match rule {
        RadiusRule::Local => "Local",
        RadiusRule::Global => "Global",
        RadiusRule::Adaptive => "Adaptive",
    }
}

/// What would be different, in words.
fn changes(now: &Configuration, draft: &Configuration, sensors: &[&str]) -> Vec<String> {
    let mut said = Vec::new();
    let mut say = |is_other: bool, text: String| {
        if is_other {
            said.push(text);
        }
    };
    say(draft.method != now.method, draft.method.title().to_lowercase());
    let automatic = |value: Option<String>| value.unwrap_or_else(|| "automatic".to_owned());
    say(
        draft.direct_light != now.direct_light,
        match draft.direct_light {
            DirectLight::Auto => "direct light as the scene suggests".to_owned(),
            method => format!("direct light by {}", direct_light_name(method).to_lowercase()),
        },
    );
    say(
        draft.radius_rule != now.radius_rule,
        format!("{} radius reduction", radius_rule_name(draft.radius_rule).to_lowercase()),
    );
    say(
        draft.samples_per_pixel != now.samples_per_pixel,
        format!(
            "{} samples/pixel{}",
            draft.samples_per_pixel,
            if draft.method.renews_eye_samples() { " in each pass" } else { " (collects hit points again)" }
        ),
    );
    say(
        draft.radius != now.radius,
        format!("first radius {}", automatic(draft.radius.map(|r| r.to_string()))),
    );
    say(
        draft.radius_floor != now.radius_floor,
        format!("smallest radius {} spacings", draft.radius_floor.get()),
    );
    say(
        draft.max_depth != now.max_depth,
        format!("max depth {}", draft.max_depth.map_or_else(|| "of the scene".to_owned(), |d| d.to_string())),
    );
    say(draft.seed != now.seed, format!("seed {}", draft.seed));
    say(draft.threads != now.threads, format!("{} threads", automatic(draft.threads.map(|n| n.to_string()))));
    say(
        draft.sensor != now.sensor,
        format!("camera \u{201c}{}\u{201d}", sensors.get(draft.sensor).copied().unwrap_or_default()),
    );
    said
}

/// How light is transported.
fn method(ui: &mut Ui, draft: &mut Configuration) {
    const HELP: &str = "How light is transported. Settings that a method does not have are not shown";
    row(ui, "Method", HELP, |ui, label| {
        let before = draft.method;
        let list = egui::ComboBox::from_id_salt("method").width(ui.available_width()).truncate();
        let list = list.selected_text(before.title()).show_ui(ui, |ui| {
            for method in Method::ALL {
                ui.selectable_value(&mut draft.method, method, method.title());
            }
        });
        // A number of eye samples that nobody has chosen is that of the method.
        if draft.method != before && draft.samples_per_pixel == before.default_samples() {
            draft.samples_per_pixel = draft.method.default_samples();
        }
        list.response.labelled_by(label).on_hover_text(HELP);
    });
}

/// How direct light is estimated, and how radii shrink.
fn discs(ui: &mut Ui, draft: &mut Configuration) {
    const DIRECT: &str = "How direct light is estimated";
    row(ui, "Direct light", DIRECT, |ui, label| {
        let list = egui::ComboBox::from_id_salt("direct light").width(ui.available_width());
        let list = list.selected_text(direct_light_name(draft.direct_light)).show_ui(ui, |ui| {
            let mut choice = |method, help| {
                let name = direct_light_name(method);
                ui.selectable_value(&mut draft.direct_light, method, name).on_hover_text(help);
            };
            choice(DirectLight::Auto, "By shadow rays, unless most of them would be in vain");
            choice(
                DirectLight::Photons,
                "Direct light by photons, like all other light: soft shadow edges at first",
            );
            choice(
                DirectLight::ShadowRays,
                "Shadow rays from hit points, about a quarter of each pass: sharp shadows at once",
            );
        });
        list.response.labelled_by(label).on_hover_text(DIRECT);
    });
    const REDUCTION: &str = "How radii shrink from pass to pass";
    row(ui, "Radius reduction", REDUCTION, |ui, label| {
        let list = egui::ComboBox::from_id_salt("radius reduction").width(ui.available_width());
        let list = list.selected_text(radius_rule_name(draft.radius_rule)).show_ui(ui, |ui| {
            let mut choice = |rule, help| {
                ui.selectable_value(&mut draft.radius_rule, rule, radius_rule_name(rule)).on_hover_text(help);
            };
            choice(
                RadiusRule::Local,
                "Each radius by the photons that its hit point finds: fast where there is light",
            );
            choice(RadiusRule::Global, "All radii by one factor, by the photons emitted");
            choice(
                RadiusRule::Adaptive,
                "Each radius as far as bias outweighs noise there; α says how fast where they are in balance",
            );
        });
        list.response.labelled_by(label).on_hover_text(REDUCTION);
    });
}

fn samples(ui: &mut Ui, draft: &mut Configuration) {
    const OF_ALL: &str =
        "Eye samples per pixel, 1 to 64. More: smoother edges and gloss. Memory and gathering grow with it.";
    const OF_A_PASS: &str =
        "Eye samples per pixel in each pass, 1 to 64. More: longer passes with less noise.";
    let help = if draft.method.renews_eye_samples() { OF_A_PASS } else { OF_ALL };
    row(ui, "Samples/pixel", help, |ui, _| {
        let number = Number::new("Samples/pixel", 1.0..=65536.0).digits(Digits::Whole).speed(0.2);
        let value = f64::from(draft.samples_per_pixel.get());
        let ([slider, field], change) = Slider::new("Samples/pixel", 1.0..=64.0).show(ui, number, value);
        (slider | field).on_hover_text(help);
        if let Some(n) = change.and_then(Change::done).and_then(|v| NonZeroU32::new(v as u32)) {
            draft.samples_per_pixel = n;
        }
    });
}

/// The first and the smallest radius.
fn radii(ui: &mut Ui, draft: &mut Configuration, median: f64) {
    const FIRST: &str =
        "Off: from each pixel's footprint. Large: smooth and biased at first; small: sharp and noisy";
    // Known once there are hit points.
    let start = (median > 0.0).then(|| median.max(1e-9));
    let number = Number::new("First radius", 1e-9..=1e9).unit("units").wide();
    let number = number.speed(0.01 * draft.radius.or(start).unwrap_or(1.0));
    draft.radius = optional(ui, LABEL, "First radius", FIRST, draft.radius, start, number);
    const SMALLEST: &str = "In spacings of the eye samples: light narrower than that falls between them. 0: radii shrink for ever";
    row(ui, "Smallest radius", SMALLEST, |ui, _| {
        let number = Number::new("Smallest radius", 0.0..=100.0).unit("spacings").speed(0.01).wide();
        let (field, change) = number.show(ui, draft.radius_floor.get());
        field.on_hover_text(SMALLEST);
        if let Some(floor) = change.and_then(Change::done).and_then(RadiusFloor::new) {
            draft.radius_floor = floor;
        }
    });
}

fn depth(ui: &mut Ui, draft: &mut Configuration) {
    const HELP: &str = "Longest light path in edges; off: what the scene says. Light beyond it is missing: Truncated (max depth)";
    let number = Number::new("Max depth", 1.0..=65535.0).digits(Digits::Whole).speed(0.2).wide();
    let depth = optional(ui, LABEL, "Max depth", HELP, draft.max_depth.map(f64::from), 64.0, number);
    draft.max_depth = depth.map(|d| d as u32);
}

/// The seed and the number of threads; the field of the seed.
fn seed_and_threads(ui: &mut Ui, draft: &mut Configuration) -> egui::Response {
    const SEED: &str = "Another seed gives other noise and the same light";
    let seed = row(ui, "Seed", SEED, |ui, _| {
        // Beyond this, double precision skips whole numbers.
        let number = Number::new("Seed", 0.0..=9e15).digits(Digits::Whole).speed(1.0).wide();
        let (field, change) = number.show(ui, draft.seed as f64);
        if let Some(seed) = change.and_then(Change::done) {
            draft.seed = seed as u64;
        }
        field.on_hover_text(SEED)
    });
    const THREADS: &str = "The picture is the same for any number";
    row(ui, "Threads", THREADS, |ui, _| {
        let most = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
        let number = Number::new("Threads", 1.0..=4.0 * most as f64).digits(Digits::Whole).speed(0.05).wide();
        let (field, change) = number.show(ui, draft.threads.unwrap_or(most) as f64);
        field.on_hover_text(THREADS);
        if let Some(n) = change.and_then(Change::done) {
            draft.threads = Some(n as usize);
        }
    });
    seed
}

fn sensors(ui: &mut Ui, names: &[&str], draft: &mut Configuration) {
    if names.len() < 2 {
        return;
    }
    row(ui, "Camera", "Which camera of the scene renders", |ui, label| {
        let chosen = names.get(draft.sensor).copied().unwrap_or_default();
        let list = egui::ComboBox::from_id_salt("sensor")
            .width(ui.available_width())
            .truncate()
            .selected_text(chosen);
        let list = list.show_ui(ui, |ui| {
            for (i, name) in names.iter().enumerate() {
                ui.selectable_value(&mut draft.sensor, i, *name);
            }
        });
        list.response.labelled_by(label);
    });
}
