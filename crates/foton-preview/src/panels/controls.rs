//! The sliders: what steers the render while it runs, and what restarts it.

use std::num::NonZeroU32;
use std::time::Duration;

use foton_session::engine::{Command, Configuration, Gesture};
use foton_session::{Alpha, DirectLight, RadiusFloor, RadiusRule, RenderSettings, SettingChange, StopRule};

use super::output;
use super::widgets::{heading, slider};
use crate::state::State;

pub(super) fn show(ui: &mut egui::Ui, state: &mut State) {
    let Some(frame) = &state.frame else {
        ui.weak("No scene yet: open one, or drop a file here.");
        return;
    };
    let (settings, stop) = (frame.settings.clone(), frame.stop);
    let now = Configuration::of(&settings, frame.threads, frame.region);
    heading(ui, "While it runs");
    steer(ui, state, &settings);
    heading(ui, "Stop");
    stop_rule(ui, state, stop);
    heading(ui, "Restarts the render");
    restarting(ui, state, now);
    heading(ui, "Camera");
    camera(ui, state, settings.sensor);
}

fn steer(ui: &mut egui::Ui, state: &mut State, settings: &RenderSettings) {
    let before = settings.ppm.alpha.get();
    let mut alpha = before;
    let response = ui.add(slider(&mut alpha, 0.01..=1.0).text("α").max_decimals(3).smart_aim(false));
    state.place("alpha", &response);
    let response = response.on_hover_text(
        "Share of new photons that each hit point keeps, from above 0 to 1. Small: radii shrink fast, so bias goes and noise stays. \
         Large: smooth, but the bias of the radius stays longer. 2/3 lets both fall together. Costs no time.",
    );
    // A text that was opened and left says the old value in fewer digits: nobody asked for that one.
    let is_old = !response.dragged() && (alpha - before).abs() < 0.5e-3;
    if response.changed()
        && !is_old
        && let Some(alpha) = Alpha::new(alpha)
    {
        state.steer(SettingChange::Alpha(alpha));
    }
    let mut photons = settings.ppm.photons_per_pass.get();
    let response = ui.add(slider(&mut photons, 1 << 10..=1 << 24).logarithmic(true).text("photons a pass"));
    state.place("photons per pass", &response);
    let response = response.on_hover_text(
        "Photons traced in each pass, 1 024 to 16 777 216. Fewer: the picture answers sooner. More: less overhead for each photon, \
         and radii shrink by fewer, better-founded steps.",
    );
    if response.changed()
        && let Some(photons) = NonZeroU32::new(photons)
    {
        state.steer(SettingChange::PhotonsPerPass(photons));
    }
}

fn stop_rule(ui: &mut egui::Ui, state: &mut State, rule: StopRule) {
    let mut new = rule;
    ui.horizontal(|ui| {
        let mut on = rule.passes.is_some();
        let label = ui.checkbox(&mut on, "after passes");
        let mut passes = rule.passes.unwrap_or(64);
        let value = ui.add_enabled(on, egui::DragValue::new(&mut passes).range(1..=1_000_000_000u64));
        value
            .labelled_by(label.id)
            .on_hover_text("Pauses after this many passes; raise the number and press Resume to continue");
        new.passes = on.then_some(passes);
    });
    ui.horizontal(|ui| {
        let mut on = rule.time.is_some();
        let label = ui.checkbox(&mut on, "after time");
        let mut seconds = rule.time.map_or(60.0, |t| t.as_secs_f64());
        let value = ui.add_enabled(
            on,
            egui::DragValue::new(&mut seconds).range(0.1..=1e7).speed(0.5).max_decimals(1).suffix(" s"),
        );
        value
            .labelled_by(label.id)
            .on_hover_text("Pauses after this much rendering; a pass that would end later is not begun");
        new.time = on.then(|| Duration::from_secs_f64(seconds));
    });
    let new = super::error::stop_at(ui, new);
    if new != rule {
        state.ask(Command::StopAt(new));
    }
}

/// Settings that restart the render: sent when a control is let go.
fn restarting(ui: &mut egui::Ui, state: &mut State, now: Configuration) {
    let mut draft = state.draft.take().unwrap_or_else(|| now.clone());
    methods(ui, &mut draft);
    let median = state.frame.as_ref().map_or(1.0, |f| f.stats.radii.median);
    let is_held = samples(ui, &mut draft) | radii(ui, &mut draft, median) | seed_and_threads(ui, &mut draft);
    sensors(ui, state, &mut draft);
    if draft != now {
        if is_held {
            state.draft = Some(draft);
        } else {
            state.ask(Command::Configure(draft));
            state.notice("Restarted with the new settings");
        }
    }
}

/// How direct light is estimated, and how radii shrink.
fn methods(ui: &mut egui::Ui, draft: &mut Configuration) {
    ui.horizontal(|ui| {
        ui.label("Direct light");
        ui.selectable_value(&mut draft.direct_light, DirectLight::Photons, "photons").on_hover_text(
            "Direct light by photons, like all other light: no extra time, soft shadow edges at first",
        );
        ui.selectable_value(&mut draft.direct_light, DirectLight::ShadowRays, "shadow rays").on_hover_text(
            "A shadow ray from each hit point in each pass: sharp shadows at once, slower passes",
        );
    });
    ui.horizontal(|ui| {
        ui.label("Radii shrink");
        let mut choice = |rule, name, help| {
            ui.selectable_value(&mut draft.radius_rule, rule, name).on_hover_text(help);
        };
        choice(RadiusRule::Local, "each", "Each by the photons that it finds: fast where there is light");
        choice(RadiusRule::Global, "together", "All by one factor, by the photons emitted");
        choice(
            RadiusRule::Adaptive,
            "adaptive",
            "Each as far as bias outweighs noise there; α says how fast where they are in balance",
        );
    });
}

/// Eye samples. Whether a control is held.
fn samples(ui: &mut egui::Ui, draft: &mut Configuration) -> bool {
    let mut held = false;
    let mut hold = |response: &egui::Response| held |= response.dragged() || response.has_focus();
    let mut samples = draft.samples_per_pixel.get();
    let value = ui.add(slider(&mut samples, 1..=64).text("hit points a pixel"));
    hold(&value);
    value.on_hover_text(
        "Eye samples a pixel, 1 to 64. More: smoother edges and gloss. Memory and gathering grow with it.",
    );
    draft.samples_per_pixel = NonZeroU32::new(samples).unwrap_or(NonZeroU32::MIN);
    held
}

/// The first and the smallest radius. Whether a control is held.
fn radii(ui: &mut egui::Ui, draft: &mut Configuration, median: f64) -> bool {
    let mut held = false;
    let mut hold = |response: &egui::Response| held |= response.dragged() || response.has_focus();
    ui.horizontal(|ui| {
        let mut own = draft.radius.is_some();
        let label = ui.checkbox(&mut own, "first radius").on_hover_text(
            "Off: from each pixel's footprint. Large: smooth and biased at first; small: sharp and noisy",
        );
        let start = median.max(1e-9);
        let mut radius = draft.radius.unwrap_or(start);
        let speed = radius * 0.01;
        let value = ui.add_enabled(
            own,
            egui::DragValue::new(&mut radius).range(1e-9..=1e9).speed(speed).suffix(" world units"),
        );
        let value = value.labelled_by(label.id);
        hold(&value);
        draft.radius = own.then_some(radius);
    });
    ui.horizontal(|ui| {
        let label = ui.label("Smallest radius");
        let mut spacings = draft.radius_floor.get();
        let field = egui::DragValue::new(&mut spacings).range(0.0..=100.0).speed(0.01).suffix(" spacings");
        let value = ui.add(field).labelled_by(label.id);
        hold(&value);
        value.on_hover_text(
            "In spacings of the eye samples: light narrower than that falls between them. 0: radii shrink for ever",
        );
        draft.radius_floor = RadiusFloor::new(spacings).unwrap_or(draft.radius_floor);
    });
    held
}

/// The seed, and threads. Whether a control is held.
fn seed_and_threads(ui: &mut egui::Ui, draft: &mut Configuration) -> bool {
    let mut held = false;
    let mut hold = |response: &egui::Response| held |= response.dragged() || response.has_focus();
    ui.horizontal(|ui| {
        let label = ui.label("Seed");
        let value = ui.add(egui::DragValue::new(&mut draft.seed)).labelled_by(label.id);
        hold(&value);
        value.on_hover_text("Another seed gives other noise and the same light");
        let label = ui.label("Threads");
        let most = std::thread::available_parallelism().map_or(1, |n| n.get());
        let mut n = draft.threads.unwrap_or(most);
        let value = ui.add(egui::DragValue::new(&mut n).range(1..=4 * most)).labelled_by(label.id);
        hold(&value);
        value.on_hover_text("The picture is the same for any number");
        if n != draft.threads.unwrap_or(most) {
            draft.threads = Some(n);
        }
    });
    held
}

fn sensors(ui: &mut egui::Ui, state: &State, draft: &mut Configuration) {
    let Some(frame) = state.frame.as_ref().filter(|f| f.scene.sensors.len() > 1) else { return };
    let name = frame.scene.sensors.get(draft.sensor).map_or("", |s| s.name.as_str());
    let label = ui.label("Camera of the scene");
    let list = egui::ComboBox::from_id_salt("sensor").selected_text(name).show_ui(ui, |ui| {
        for (i, sensor) in frame.scene.sensors.iter().enumerate() {
            ui.selectable_value(&mut draft.sensor, i, &sensor.name);
        }
    });
    list.response.labelled_by(label.id);
}

fn camera(ui: &mut egui::Ui, state: &mut State, sensor: usize) {
    let Some(fov) = state.frame.as_ref().and_then(|f| f.scene.sensors.get(sensor)).map(|s| s.fov_degrees)
    else {
        return;
    };
    let mut degrees = fov;
    let response =
        ui.add(slider(&mut degrees, 1.0..=170.0).text("field of view").suffix("°").max_decimals(1));
    if response.changed() {
        state.ask(Command::Camera { gesture: Gesture::FieldOfView(degrees), moving: response.dragged() });
    }
    if response.drag_stopped() {
        state.ask(Command::Moving(false));
    }
    if ui.button("Reset camera").on_hover_text("Back to where the scene's file has it (H)").clicked() {
        state.ask(Command::ResetCamera);
    }
    heading(ui, "Snapshots");
    output::show(ui, state);
}
