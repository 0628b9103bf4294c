//! Where scenes are, and how large they are rendered.

use std::path::{Path, PathBuf};

use foton_format::Options as FormatOptions;

use crate::rig;

/// A scene's file.
pub(super) struct SceneFile {
    pub(super) name: String,
    pub(super) path: PathBuf,
    /// Height over width of its first sensor.
    aspect: f64,
}

impl SceneFile {
    /// The scene of a name, in `assets`, `tests/scenes` or beside the checkout, or at a path.
    pub(super) fn find(name: &str) -> Result<Option<Self>, String> {
        let root = rig::root();
        let places = [
            PathBuf::from(name),
            root.join("assets").join(name).join("scene.xml"),
            root.join("tests/scenes").join(name).with_extension("xml"),
            root.join("../shared/scenes").join(name).join("scene.xml"),
        ];
        let Some(path) = places.into_iter().find(|path| path.is_file()) else { return Ok(None) };
        let opened = foton_format::open(&path, &FormatOptions::default()).map_err(|e| e.to_string())?;
        let sensor = opened.description.sensors.first().ok_or_else(|| format!("{name}: no sensor"))?;
        let aspect = f64::from(sensor.height) / f64::from(sensor.width);
        Ok(Some(Self { name: title(&path), path, aspect }))
    }

    /// As `--size` wants it.
    pub(super) fn size(&self, width: u32) -> [u32; 2] {
        [width, (f64::from(width) * self.aspect).round().max(1.0) as u32]
    }
}

/// The folder's name where the file is one of many called `scene.xml`.
fn title(path: &Path) -> String {
    let stem = path.file_stem().unwrap_or_default();
    let folder = path.parent().and_then(Path::file_name).filter(|_| stem == "scene");
    folder.unwrap_or(stem).to_string_lossy().into_owned()
}
