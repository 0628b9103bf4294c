//! What menu, toolbar and keys have in common: each thing that they do, once.

use std::path::{Path, PathBuf};

use foton_edit::{Item, Make};
use foton_session::engine::{Activity, Command, Frame, SceneEdit};

use crate::editing::{Remaking, Renaming};
use crate::files::{CHECKPOINTS, FileDialog, SCENES};
use crate::state::{DialogPurpose, Grip, Pinned, State};

/// Whether the render waits for a person.
pub(super) fn waits(state: &State) -> bool {
    state.frame.as_ref().is_some_and(|f| matches!(f.activity, Activity::Paused | Activity::Done))
}

/// Whether there is a scene.
pub(super) fn has_scene(state: &State) -> bool {
    state.frame.as_ref().is_some_and(|f| f.activity != Activity::Empty)
}

pub(super) fn toggle_pause(state: &mut State) {
    let command = if waits(state) { Command::Resume } else { Command::Pause };
    state.ask(command);
}

pub(super) fn snapshot(state: &mut State) {
    let folder = state.snapshot_folder();
    state.ask(Command::Snapshot(folder));
}

pub(super) fn toggle_photons(state: &mut State) {
    state.show_photons = !state.show_photons;
    state.ask(Command::ShowPhotons(state.show_photons));
}

pub(super) fn toggle_paths(state: &mut State) {
    state.show_paths = !state.show_paths;
    state.ask(Command::ShowPaths(state.show_paths));
}

/// What a frame shows: `ppm, pass 12`.
pub(super) fn pass_of(frame: &Frame) -> String {
    format!("{}, pass {}", frame.settings.method.name(), frame.stats.passes)
}

/// Keeps this picture to compare with, or ends the comparison.
pub(super) fn toggle_pin(state: &mut State) {
    if state.pinned.take().is_some() {
        return;
    }
    let Some(frame) = &state.frame else { return };
    let label = pass_of(frame);
    state.pinned = frame.picture.clone().map(|picture| Pinned { picture, label, entry: None });
}

/// Ends what is under way, or else the selection.
pub(super) fn escape(state: &mut State) {
    if state.show_help {
        state.show_help = false;
    } else if state.looking.choosing_region.take().is_some() {
        // That was to be given up.
    } else if state.grip == Grip::Object {
        state.grip = Grip::None;
        state.ask(Command::Edit(SceneEdit::CancelDrag));
    } else if state.editing.aiming || state.editing.focusing {
        (state.editing.aiming, state.editing.focusing) = (false, false);
    } else {
        deselect(state);
    }
}

pub(super) fn deselect(state: &mut State) {
    state.ask(Command::Choose(None));
}

/// What is selected, as it stands in the list of things.
pub(super) fn selected(state: &State) -> Option<&Item> {
    let frame = state.frame.as_ref()?;
    let target = frame.selection.as_ref()?.target;
    frame.scene.contents.iter().find(|item| item.target == target)
}

/// Lets a person type another name for what is selected.
pub(super) fn rename(state: &mut State) {
    state.editing.renaming = selected(state).map(Renaming::of);
}

/// Asks for the name of another material for what is selected.
pub(super) fn remake(state: &mut State, make: Make, name: &str) {
    if let Some(target) = selected(state).map(|item| item.target) {
        state.editing.remaking = Some(Remaking::new(target, make, name));
    }
}

pub(super) fn duplicate(state: &mut State) {
    if let Some(target) = selected(state).map(|item| item.target) {
        state.ask(Command::Edit(SceneEdit::Duplicate(target)));
    }
}

pub(super) fn delete(state: &mut State) {
    if let Some(target) = selected(state).map(|item| item.target) {
        state.ask(Command::Edit(SceneEdit::Delete(target)));
    }
}

pub(super) fn copy_camera(ctx: &egui::Context, state: &mut State) {
    let sensor = state.frame.as_ref().and_then(|f| f.scene.sensors.get(f.settings.sensor));
    let Some(xml) = sensor.map(|s| s.xml.clone()) else { return };
    ctx.copy_text(xml);
    state.notice("The camera is on the clipboard, as Mitsuba XML");
}

/// Opens the scene's file again.
pub(super) fn reload(state: &mut State) {
    state.changed_on_disk = false;
    state.reloads = true;
    if let Some(file) = state.frame.as_ref().and_then(|f| f.scene.file.clone()) {
        state.open(file);
    }
}

pub(super) fn open_dialog(state: &mut State) {
    let dialog = FileDialog::open(&state.preferences.scene_folder, SCENES);
    state.dialog = Some((DialogPurpose::OpenScene, dialog));
}

pub(super) fn save_dialog(state: &mut State) {
    let is_edited_file = state.frame.as_ref().is_some_and(|f| f.scene.name.ends_with("-edited.xml"));
    let mut path = beside_the_scene(state, if is_edited_file { ".xml" } else { "-edited.xml" });
    // Scenes of other formats are saved as Mitsuba's: `teapot.obj` as `teapot-edited.xml`.
    let file = state.frame.as_ref().and_then(|f| f.scene.file.clone());
    if let Some(stem) = file.filter(|file| !is_xml(file)).as_deref().and_then(Path::file_stem) {
        path.set_file_name(format!("{}-edited.xml", stem.to_string_lossy()));
    }
    state.dialog = Some((DialogPurpose::SaveScene, FileDialog::save(&path, &["xml"])));
}

fn is_xml(file: &Path) -> bool {
    file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("xml"))
}

pub(super) fn checkpoint_dialog(state: &mut State) {
    let path = beside_the_scene(state, ".checkpoint");
    state.dialog = Some((DialogPurpose::KeepCheckpoint, FileDialog::save(&path, CHECKPOINTS)));
}

pub(super) fn resume_dialog(state: &mut State) {
    let beside = beside_the_scene(state, "");
    let dialog = FileDialog::open(beside.parent().unwrap_or("".as_ref()), CHECKPOINTS);
    state.dialog = Some((DialogPurpose::ResumeCheckpoint, dialog));
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
