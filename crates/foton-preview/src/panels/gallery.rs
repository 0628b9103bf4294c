//! Scenes to open, with pictures: those of before, and those that ship with the program.

use std::path::{Path, PathBuf};
use std::time::SystemTime;

use egui::{ColorImage, TextureHandle, TextureOptions, Vec2};
use foton_film::{Image, ToneMap, decode_png, read_png_within, tone_map};
use foton_session::engine::Source;

use crate::state::{Leaving, State};

/// Height of a picture in points.
const HEIGHT: f32 = 44.0;

/// Bytes that a picture may take while it is read.
const MEMORY: u64 = 64 << 20;

/// Scenes that ship with the program.
pub(super) fn built_in(ui: &mut egui::Ui, state: &mut State) {
    for i in 0..state.built_in.len() {
        let scene = &state.built_in[i];
        let (name, bytes) = (scene.name.clone(), scene.thumbnail);
        let key = PathBuf::from(format!("built in/{name}"));
        let texture = texture(ui.ctx(), state, &key, None, || decode_png(bytes, &key, Some(MEMORY)).ok());
        if entry(ui, texture.as_ref(), &name, None) {
            state.leave(Leaving::Open(Source::BuiltIn(name)));
        }
    }
}

/// Scenes that were opened before, the last one first.
pub(super) fn recent(ui: &mut egui::Ui, state: &mut State) {
    if state.preferences.recent.is_empty() {
        ui.label("No scene file was opened yet");
        return;
    }
    for file in state.preferences.recent.clone() {
        let picture = foton_session::folders::thumbnail(&file);
        let written = picture.as_ref().and_then(|path| path.metadata().ok()?.modified().ok());
        let texture = picture.filter(|_| written.is_some()).and_then(|path| {
            texture(ui.ctx(), state, &path, written, || read_png_within(&path, Some(MEMORY)).ok())
        });
        if entry(ui, texture.as_ref(), &Source::File(file.clone()).title(), file.parent()) {
            state.open(file);
        }
    }
    ui.separator();
    if ui.button("Forget these").on_hover_text("Empties this list; the scenes stay").clicked() {
        state.preferences.recent.clear();
    }
}

/// A scene with its picture, if there is one. Whether it was chosen.
fn entry(ui: &mut egui::Ui, texture: Option<&TextureHandle>, name: &str, folder: Option<&Path>) -> bool {
    let button = match texture {
        Some(texture) => {
            let [width, height] = texture.size().map(|side| side as f32);
            let size = Vec2::new(HEIGHT * width / height.max(1.0), HEIGHT);
            egui::Button::image_and_text(egui::load::SizedTexture::new(texture.id(), size), name)
        }
        None => egui::Button::new(name),
    };
    let response = ui.add(button);
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, name));
    match folder {
        Some(folder) => response.on_hover_text(foton_input::shown_path(folder)).clicked(),
        None => response.clicked(),
    }
}

/// The texture of a picture, made once for each time that it was written.
fn texture(
    ctx: &egui::Context,
    state: &mut State,
    key: &Path,
    written: Option<SystemTime>,
    read: impl FnOnce() -> Option<Image>,
) -> Option<TextureHandle> {
    if let Some(known) = state.looking.scene_pictures.iter().find(|p| p.key == key && p.written == written) {
        return known.texture.clone();
    }
    let texture = read().map(|image| {
        let size = [image.width as usize, image.height as usize];
        let shown = |&c| tone_map::display(c, ToneMap::Linear, 0.0);
        let rgb: Vec<u8> = image.pixels.iter().flat_map(shown).collect();
        ctx.load_texture(key.to_string_lossy(), ColorImage::from_rgb(size, &rgb), TextureOptions::LINEAR)
    });
    state.looking.scene_pictures.retain(|p| p.key != key);
    state.looking.scene_pictures.push(crate::looking::ScenePicture {
        key: key.to_owned(),
        written,
        texture: texture.clone(),
    });
    texture
}
