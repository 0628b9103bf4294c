//! The menu bar: all that can be done, by name and with its key.

use egui::{Button, Ui};
use foton_session::engine::{Command, SceneEdit};

use super::{actions, gallery, region, views};
use crate::state::{Leaving, Placement, State};

pub(super) fn show(ui: &mut Ui, state: &mut State) {
    egui::MenuBar::new().ui(ui, |ui| {
        let button = ui.menu_button("File", |ui| file(ui, state)).response;
        state.place("file menu", &button);
        ui.menu_button("Edit", |ui| edit(ui, state));
        let button = ui.menu_button("View", |ui| view(ui, state)).response;
        state.place("view menu", &button);
        ui.menu_button("Help", |ui| help(ui, state));
        if state.changed_on_disk
            && ui.button("Reload").on_hover_text("The scene's file has changed on the disk").clicked()
        {
            actions::reload(state);
        }
        super::opening::show(ui, state);
    });
}

/// An entry with its key; whether it was chosen.
fn entry(ui: &mut Ui, is_enabled: bool, label: &str, key: &str) -> egui::Response {
    let entry = ui.add_enabled(is_enabled, Button::new(label).shortcut_text(key));
    // The key is no part of the name.
    entry.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, is_enabled, label));
    entry
}

fn file(ui: &mut Ui, state: &mut State) {
    let has_scene = actions::has_scene(state);
    if entry(ui, true, "Open…", "Ctrl+O").clicked() {
        actions::open_dialog(state);
    }
    ui.menu_button("Open recent", |ui| gallery::recent(ui, state));
    ui.menu_button("Gallery", |ui| gallery::built_in(ui, state));
    ui.separator();
    if entry(ui, has_scene, "Save edited scene…", "Ctrl+S").clicked() {
        actions::save_dialog(state);
    }
    if entry(ui, has_scene, "Save snapshot", "P").on_hover_text("This pass as EXR and PNG").clicked() {
        actions::snapshot(state);
    }
    let keep = entry(ui, has_scene, "Keep in history", "B");
    if keep.on_hover_text("Keeps this pass with its state, to compare with and to return to").clicked() {
        state.ask(Command::Remember);
    }
    ui.separator();
    let keep = entry(ui, has_scene, "Keep checkpoint…", "").on_hover_text(
        "Keeps the state of this render in a file and updates it every 30 s and at the end, until the render restarts; \
         `foton render --resume` reads it too",
    );
    if keep.clicked() {
        actions::checkpoint_dialog(state);
    }
    let resume = entry(ui, has_scene, "Resume checkpoint…", "").on_hover_text(
        "The checkpoint must have this scene, radius, direct light, samples/pixel and seed; the result has the bits of a render \
         that never stopped",
    );
    if resume.clicked() {
        actions::resume_dialog(state);
    }
    ui.separator();
    if entry(ui, true, "Quit", "Ctrl+Q").clicked() {
        state.leave(Leaving::Close);
    }
}

fn edit(ui: &mut Ui, state: &mut State) {
    let frame = state.frame.as_ref();
    let (undo, redo) = frame.map_or((None, None), |f| (f.scene.undo.clone(), f.scene.redo.clone()));
    let is_selected = frame.is_some_and(|f| f.selection.is_some());
    let named = |verb: &str, step: Option<&String>| {
        step.map_or_else(|| verb.to_owned(), |step| format!("{verb}: {step}"))
    };
    if entry(ui, undo.is_some(), &named("Undo", undo.as_ref()), "Ctrl+Z").clicked() {
        state.ask(Command::Edit(SceneEdit::Undo));
    }
    if entry(ui, redo.is_some(), &named("Redo", redo.as_ref()), "Ctrl+Shift+Z").clicked() {
        state.ask(Command::Edit(SceneEdit::Redo));
    }
    ui.separator();
    if entry(ui, is_selected, "Rename", "F2").clicked() {
        actions::rename(state);
    }
    if entry(ui, is_selected, "Duplicate", "Ctrl+D").clicked() {
        actions::duplicate(state);
    }
    if entry(ui, is_selected, "Delete", "Del").clicked() {
        actions::delete(state);
    }
    if entry(ui, is_selected, "Deselect", "Esc").clicked() {
        actions::deselect(state);
    }
    ui.separator();
    if entry(ui, actions::has_scene(state), "Copy camera as XML", "").clicked() {
        actions::copy_camera(ui.ctx(), state);
    }
}

fn view(ui: &mut Ui, state: &mut State) {
    views::choices(ui, state);
    ui.separator();
    if entry(ui, true, "Photons as dots", "O").clicked() {
        actions::toggle_photons(state);
    }
    if entry(ui, true, "Photon paths to the pixel", "V").clicked() {
        actions::toggle_paths(state);
    }
    views::over_the_picture(ui, state);
    ui.separator();
    region::entry(ui, state);
    if entry(ui, true, "Fit image", "F").clicked() {
        state.placement = Placement::FIT;
    }
    if entry(ui, actions::has_scene(state), "Reset camera", "H").clicked() {
        state.ask(Command::ResetCamera);
    }
    ui.separator();
    let label = if state.hides_panels { "Show panels" } else { "Hide panels" };
    if entry(ui, true, label, "Tab").clicked() {
        state.hides_panels = !state.hides_panels;
    }
    ui.checkbox(&mut state.preferences.dark, "Dark theme");
}

fn help(ui: &mut Ui, state: &mut State) {
    if entry(ui, true, "Keys and gestures", "?").clicked() {
        state.show_help = !state.show_help;
    }
}
