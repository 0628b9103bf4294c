//! The bar on top: scene, run, snapshot, view.

use std::path::PathBuf;

use foton_film::ToneMap;
use foton_session::engine::{Activity, BuildProgress, Command, ErrorPart, ViewMode};

use super::{exposure, gallery, region};
use crate::files::{CHECKPOINTS, FileDialog, SCENES};
use crate::state::{DialogPurpose, Pinned, Placement, State};

pub(super) fn show(ui: &mut egui::Ui, state: &mut State) {
    ui.horizontal_wrapped(|ui| {
        scene_menu(ui, state);
        ui.separator();
        run(ui, state);
        ui.separator();
        view(ui, state);
        ui.separator();
        compare(ui, state);
        let help = ui.button("?").on_hover_text("Keys and gestures (?)");
        if help.clicked() {
            state.show_help = !state.show_help;
        }
    });
}

fn scene_menu(ui: &mut egui::Ui, state: &mut State) {
    ui.menu_button("Scene", |ui| {
        if ui.button("Open…").clicked() {
            open_dialog(state);
        }
        ui.menu_button("Open recent", |ui| gallery::recent(ui, state));
        ui.menu_button("Gallery", |ui| gallery::built_in(ui, state));
        if ui.button("Save edited scene…").clicked() {
            save_dialog(state);
        }
        checkpoints(ui, state);
        let xml =
            state.frame.as_ref().and_then(|f| f.scene.sensors.get(f.settings.sensor)).map(|s| s.xml.clone());
        let copy = ui.add_enabled(xml.is_some(), egui::Button::new("Copy camera as XML"));
        if let Some(xml) = xml.filter(|_| copy.clicked()) {
            ui.ctx().copy_text(xml);
            state.notice("The camera is on the clipboard, as Mitsuba XML");
        }
        ui.separator();
        ui.checkbox(&mut state.preferences.dark, "Dark colours");
    });
    if state.changed_on_disk
        && ui.button("Reload").on_hover_text("The scene's file has changed on the disk").clicked()
    {
        state.changed_on_disk = false;
        state.reloads = true;
        if let Some(file) = state.frame.as_ref().and_then(|f| f.scene.file.clone()) {
            state.open(file);
        }
    }
    let opening = state.frame.as_ref().and_then(|f| f.opening.clone().map(|name| (name, f.building)));
    if let Some((name, building)) = opening {
        ui.spinner();
        ui.label(format!("Opening {name}"));
        if let Some(BuildProgress { step, share }) = building {
            ui.add(egui::ProgressBar::new(share as f32).desired_width(160.0).text(step.text()));
        }
        if ui.button("Cancel").clicked() {
            state.ask(Command::CancelOpen);
        }
    }
}

pub(super) fn open_dialog(state: &mut State) {
    state.dialog =
        Some((DialogPurpose::OpenScene, FileDialog::open(&state.preferences.scene_folder, SCENES)));
}

pub(super) fn save_dialog(state: &mut State) {
    let path = beside_the_scene(state, "-edited.xml");
    state.dialog = Some((DialogPurpose::SaveScene, FileDialog::save(&path, &["xml"])));
}

/// Where what belongs to the scene is looked for first: its own folder if it has one.
fn beside_the_scene(state: &State, ending: &str) -> PathBuf {
    let scene = state.frame.as_ref().map(|f| &f.scene);
    let name = scene.map_or("scene", |s| s.name.as_str());
    let stem = name.strip_suffix(".xml").unwrap_or(name);
    let file = scene.and_then(|s| s.file.as_ref());
    let folder = file.and_then(|f| f.parent()).unwrap_or(&state.preferences.scene_folder);
    folder.join(format!("{stem}{ending}"))
}

fn checkpoints(ui: &mut egui::Ui, state: &mut State) {
    let keep = ui.button("Keep a checkpoint…").on_hover_text(
        "The state of this render in a file, brought up to date every 30 s and at the end, until it restarts; \
         `foton render --resume` reads it too",
    );
    if keep.clicked() {
        let path = beside_the_scene(state, ".checkpoint");
        state.dialog = Some((DialogPurpose::KeepCheckpoint, FileDialog::save(&path, CHECKPOINTS)));
    }
    let resume_in = ui.button("Resume a checkpoint…").on_hover_text(
        "The checkpoint must have this scene, radius, direct light, eye samples per pixel and seed; the result is bit-identical to an uninterrupted render",
    );
    if resume_in.clicked() {
        let dialog =
            FileDialog::open(beside_the_scene(state, "").parent().unwrap_or("".as_ref()), CHECKPOINTS);
        state.dialog = Some((DialogPurpose::ResumeCheckpoint, dialog));
    }
}

fn run(ui: &mut egui::Ui, state: &mut State) {
    let activity = state.frame.as_ref().map_or(Activity::Empty, |f| f.activity);
    let waits = matches!(activity, Activity::Paused | Activity::Done);
    let (label, command) = if waits { ("Resume", Command::Resume) } else { ("Pause", Command::Pause) };
    let there = activity != Activity::Empty;
    let pause =
        ui.add_enabled(there, egui::Button::new(label)).on_hover_text("After the pass under way (space)");
    state.place("pause", &pause);
    if pause.clicked() {
        state.ask(command);
    }
    let step = ui.add_enabled(there && waits, egui::Button::new("Step")).on_hover_text("One pass (.)");
    if step.clicked() {
        state.ask(Command::Step);
    }
    let restart =
        ui.add_enabled(there, egui::Button::new("Restart")).on_hover_text("From the first pass on (Ctrl+R)");
    if restart.clicked() {
        state.ask(Command::Restart);
    }
    let snapshot = ui
        .add_enabled(there, egui::Button::new("Snapshot"))
        .on_hover_text("Saves this pass as EXR and PNG (P)");
    state.place("snapshot", &snapshot);
    if snapshot.clicked() {
        let folder = state.snapshot_folder();
        state.ask(Command::Snapshot(folder));
    }
}

/// Views, by name.
pub(super) const PICTURES: [(&str, ViewMode); 8] = [
    ("Radiance", ViewMode::Radiance),
    ("Luminance", ViewMode::Luminance),
    ("Radius", ViewMode::Radius),
    ("Photons found", ViewMode::PhotonCount),
    ("No photon yet", ViewMode::Unknown),
    ("Error", ViewMode::Error(ErrorPart::Total)),
    ("Noise", ViewMode::Error(ErrorPart::Noise)),
    ("Bias", ViewMode::Error(ErrorPart::Bias)),
];

fn view(ui: &mut egui::Ui, state: &mut State) {
    let now = PICTURES.iter().find(|(_, view)| *view == state.view).map_or("Light by kind", |(name, _)| name);
    let label = ui.label("Show");
    let list = egui::ComboBox::from_id_salt("picture").selected_text(now).show_ui(ui, |ui| {
        for (name, view) in PICTURES {
            if ui.selectable_label(state.view == view, name).clicked() {
                state.choose_view(view);
            }
        }
    });
    list.response.labelled_by(label.id);
    if matches!(state.view, ViewMode::Radiance | ViewMode::Classes { .. }) {
        exposure::control(ui, state);
        let label = ui.label("Tone");
        let list =
            egui::ComboBox::from_id_salt("tone").selected_text(state.tone_map.name()).show_ui(ui, |ui| {
                for map in ToneMap::ALL {
                    ui.selectable_value(&mut state.tone_map, map, map.name());
                }
            });
        list.response.labelled_by(label.id);
        ui.menu_button("Light", |ui| classes(ui, state))
            .response
            .on_hover_text("Which kinds of light the view has");
    }
    let photons = ui.toggle_value(&mut state.show_photons, "Photons");
    state.place("photons", &photons);
    if photons
        .on_hover_text("The last pass's photons as dots (O): direct yellow, caustic white, indirect blue")
        .changed()
    {
        state.ask(Command::ShowPhotons(state.show_photons));
    }
    ui.menu_button("Looking", |ui| looking(ui, state))
        .response
        .on_hover_text("What is drawn over the picture");
    region::button(ui, state);
    let history = ui.toggle_value(&mut state.show_history, "History");
    state.place("history", &history);
    history.on_hover_text("Passes that were kept, to compare with and to return to; films (T)");
    if ui.button("Fit").on_hover_text("The whole image (F)").clicked() {
        state.placement = Placement::FIT;
    }
}

fn looking(ui: &mut egui::Ui, state: &mut State) {
    ui.checkbox(&mut state.show_histogram, "Histogram").on_hover_text("How bright the pixels are (L)");
    ui.checkbox(&mut state.marks_clipping, "Clipping").on_hover_text(
        "Stripes over pixels that are 255 in a channel, blue over black ones: what a PNG would clip (C)",
    );
}

fn classes(ui: &mut egui::Ui, state: &mut State) {
    let (mut reflected, mut emission) = match state.view {
        ViewMode::Classes { reflected, emission } => (reflected, emission),
        _ => ([true; 3], true),
    };
    let before = (reflected, emission);
    let names = ["Direct", "Caustic", "Indirect"];
    for (on, name) in reflected.iter_mut().zip(names) {
        ui.checkbox(on, name);
    }
    ui.checkbox(&mut emission, "Emitters");
    if (reflected, emission) == before {
        return;
    }
    if reflected == [true; 3] && emission {
        state.choose_view(ViewMode::Radiance);
        return;
    }
    state.choose_view(ViewMode::Classes { reflected, emission });
}

fn compare(ui: &mut egui::Ui, state: &mut State) {
    let picture = state.frame.as_ref().and_then(|f| f.picture.clone().map(|p| (p, f.stats.passes)));
    if state.pinned.is_some() {
        if ui.button("Unpin").on_hover_text("Ends the comparison (K)").clicked() {
            state.pinned = None;
        }
    } else if let Some((picture, passes)) = picture {
        let pin = ui.button("Pin").on_hover_text(
            "Keeps this picture to the right of a line that can be dragged, to compare with (K)",
        );
        if pin.clicked() {
            state.pinned = Some(Pinned { picture, label: format!("pass {passes}"), entry: None });
        }
    }
}
