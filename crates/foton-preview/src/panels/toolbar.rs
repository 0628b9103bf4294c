//! The toolbar: what is used all the time, as icons with labels. It has one line, whatever is shown.

use egui::Ui;
use foton_film::ToneMap;
use foton_session::engine::Command;

use super::icons::Icon;
use super::widgets::{self, Tool};
use super::{actions, exposure, views};
use crate::state::State;

/// How much there is room for.
#[derive(Clone, Copy)]
struct Room {
    /// Labels of what runs the render.
    main_labels: bool,
    /// Labels of what is looked at.
    view_labels: bool,
    /// A slider of the exposure.
    slider: bool,
}

impl Room {
    /// In so many points.
    fn in_width(width: f32) -> Self {
        Self { main_labels: width >= 840.0, view_labels: width >= 1040.0, slider: width >= 1140.0 }
    }
}

pub(super) fn show(ui: &mut Ui, state: &mut State) {
    let room = Room::in_width(ui.available_width());
    egui::ScrollArea::horizontal().auto_shrink([false, true]).show(ui, |ui| {
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 4.0;
            run(ui, state, room);
            ui.separator();
            view(ui, state, room);
            light(ui, state, room);
            ui.separator();
            pin(ui, state, room);
        });
    });
}

fn run(ui: &mut Ui, state: &mut State, room: Room) {
    let tool = |icon, label| Tool { is_short: !room.main_labels, ..Tool::new(icon, label) };
    let (there, waits) = (actions::has_scene(state), actions::waits(state));
    let (icon, label) = if waits { (Icon::Play, "Resume") } else { (Icon::Pause, "Pause") };
    let pause = Tool { widest: "Resume", ..tool(icon, label) };
    let pause = ui
        .add_enabled_ui(there, |ui| pause.show(ui))
        .inner
        .on_hover_text("Pauses or resumes the render (Space)");
    state.place("pause", &pause);
    if pause.clicked() {
        actions::toggle_pause(state);
    }
    let step = ui.add_enabled_ui(there && waits, |ui| tool(Icon::Step, "Step").show(ui)).inner;
    if step.on_hover_text("Renders one pass (.)").clicked() {
        state.ask(Command::Step);
    }
    let restart = ui.add_enabled_ui(there, |ui| tool(Icon::Restart, "Restart").show(ui)).inner;
    if restart.on_hover_text("Restarts the render from its first pass (Ctrl+R)").clicked() {
        state.ask(Command::Restart);
    }
    let snapshot = ui.add_enabled_ui(there, |ui| tool(Icon::Snapshot, "Snapshot").show(ui)).inner;
    let snapshot = snapshot.on_hover_text("Saves this pass as EXR and PNG, and keeps it in the history (P)");
    state.place("snapshot", &snapshot);
    if snapshot.clicked() {
        actions::snapshot(state);
    }
}

fn view(ui: &mut Ui, state: &mut State, room: Room) {
    widgets::icon(ui, Icon::View, "What the picture shows");
    let list = egui::ComboBox::from_id_salt("view")
        .truncate()
        .width(if room.view_labels { 104.0 } else { 88.0 })
        .selected_text(views::name(state.view));
    let list = list.show_ui(ui, |ui| views::choices(ui, state)).response;
    name(&list, "View", views::name(state.view));
    state.place("view list", &list);
    let is_short = !room.view_labels;
    let photons = Tool { is_on: Some(state.show_photons), is_short, ..Tool::new(Icon::Photons, "Photons") };
    let has_photons = state.frame.as_ref().is_none_or(|f| f.settings.method.has_photons());
    let photons = ui.add_enabled_ui(has_photons, |ui| photons.show(ui)).inner;
    state.place("photons", &photons);
    let help = "The last pass's photons as dots (O): direct yellow, caustic white, indirect blue";
    if photons.on_hover_text(help).clicked() {
        actions::toggle_photons(state);
    }
}

/// Light paths, exposure and tone map: disabled over measures, which have none.
fn light(ui: &mut Ui, state: &mut State, room: Room) {
    let button = Tool::new(Icon::LightPaths, "Light paths")
        .show(ui)
        .on_hover_text("Which kinds of light the view shows");
    let menu = egui::Popup::menu(&button).close_behavior(egui::PopupCloseBehavior::CloseOnClickOutside);
    menu.show(|ui| views::light_paths(ui, state));
    let is_light = views::is_light(state.view);
    ui.add_enabled_ui(is_light, |ui| {
        exposure::show(ui, state, room.slider);
        widgets::icon(ui, Icon::ToneMap, "Tone map");
        let list = egui::ComboBox::from_id_salt("tone map")
            .truncate()
            .width(88.0)
            .selected_text(state.tone_map.name());
        let list = list.show_ui(ui, |ui| {
            for map in ToneMap::ALL {
                ui.selectable_value(&mut state.tone_map, map, map.name());
            }
        });
        name(&list.response, "Tone map", state.tone_map.name());
    });
}

/// Names a list for screen readers.
fn name(list: &egui::Response, name: &str, value: &str) {
    list.ctx.accesskit_node_builder(list.id, |node| {
        node.set_label(name.to_owned());
        node.set_value(value.to_owned());
    });
}

fn pin(ui: &mut Ui, state: &mut State, room: Room) {
    let is_short = !room.view_labels;
    let is_pinned = state.pinned.is_some();
    let has_picture = state.frame.as_ref().is_some_and(|f| f.picture.is_some());
    let label = if is_pinned { "Unpin" } else { "Pin" };
    let tool = Tool { widest: "Unpin", is_on: Some(is_pinned), is_short, ..Tool::new(Icon::Pin, label) };
    let pin = ui
        .add_enabled_ui(is_pinned || has_picture, |ui| tool.show(ui))
        .inner
        .on_hover_text("Keeps this picture to the right of a line that can be dragged, to compare with (K)");
    if pin.clicked() {
        actions::toggle_pin(state);
    }
}
