//! What is remembered from one time to the next: a small JSON file in the user's configuration folder. Never a reason to fail.

use std::path::{Path, PathBuf};

use foton_input::{Limit, Named, read_file};
use serde_json::{Value, json};

/// Scene files that are remembered at most.
const MAX_RECENT: usize = 10;

/// What is remembered.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Preferences {
    /// Width and height of the window in points.
    pub(crate) window: [f32; 2],
    pub(crate) dark: bool,
    /// Where snapshots go; it is made when it is needed.
    pub(crate) snapshot_folder: PathBuf,
    /// Whether the PNGs of snapshots have the exposure and the tone map of the screen.
    pub(crate) png_as_shown: bool,
    /// Where file dialogs begin.
    pub(crate) scene_folder: PathBuf,
    /// Scene files that were opened, the last one first.
    pub(crate) recent: Vec<PathBuf>,
    /// How often the window was opened.
    pub(crate) starts: u32,
}

impl Default for Preferences {
    fn default() -> Self {
        Self {
            window: [1280.0, 800.0],
            dark: true,
            snapshot_folder: foton_session::folders::pictures(),
            png_as_shown: true,
            scene_folder: PathBuf::from("."),
            recent: Vec::new(),
            starts: 0,
        }
    }
}

impl Preferences {
    fn path() -> Option<PathBuf> {
        let from = |name: &str| std::env::var_os(name).filter(|v| !v.is_empty()).map(PathBuf::from);
        let folder = from("XDG_CONFIG_HOME")
            .or_else(|| from("APPDATA"))
            .or_else(|| from("HOME").map(|home| home.join(".config")))?;
        Some(folder.join("foton").join("window.json"))
    }

    /// What was remembered; what cannot be read is as at the first time.
    pub(crate) fn load() -> Self {
        let read =
            |path: PathBuf| read_file(&path, Named::ByFile, Limit::new(Some(1 << 20), 1), &|| false).ok();
        let text = Self::path().and_then(read).and_then(|bytes| String::from_utf8(bytes).ok());
        text.map_or_else(Self::default, |text| Self::parse(&text))
    }

    fn parse(text: &str) -> Self {
        let Ok(value) = serde_json::from_str::<Value>(text) else { return Self::default() };
        let default = Self::default();
        let side = |i: usize| {
            let side = value["window"][i].as_f64().map(|v| v as f32);
            side.filter(|v| (320.0..=16384.0).contains(v)).unwrap_or(default.window[i])
        };
        let folder = |name: &str, default: &PathBuf| {
            // Relative ones are of the first edition, whose default was the working directory.
            let folder = value[name].as_str().map(PathBuf::from).filter(|f| f.is_absolute() && f.is_dir());
            folder.unwrap_or_else(|| default.clone())
        };
        Self {
            window: [side(0), side(1)],
            dark: value["dark"].as_bool().unwrap_or(default.dark),
            snapshot_folder: folder("snapshot_folder", &default.snapshot_folder),
            png_as_shown: value["png_as_shown"].as_bool().unwrap_or(default.png_as_shown),
            scene_folder: folder("scene_folder", &default.scene_folder),
            recent: value["recent"].as_array().map_or_else(Vec::new, |files| {
                let files = files.iter().filter_map(|file| file.as_str().map(PathBuf::from));
                files.filter(|file| file.is_absolute()).take(MAX_RECENT).collect()
            }),
            starts: value["starts"].as_u64().map_or(default.starts, |n| n.min(u32::MAX.into()) as u32),
        }
    }

    /// Puts a scene's file first among those that were opened.
    pub(crate) fn remember(&mut self, file: &Path) {
        self.recent.retain(|other| other != file);
        self.recent.insert(0, file.to_owned());
        self.recent.truncate(MAX_RECENT);
    }

    fn text(&self) -> String {
        let value = json!({
            "window": self.window,
            "dark": self.dark,
            "snapshot_folder": self.snapshot_folder.to_string_lossy(),
            "png_as_shown": self.png_as_shown,
            "scene_folder": self.scene_folder.to_string_lossy(),
            "recent": self.recent.iter().filter_map(|file| file.to_str()).collect::<Vec<_>>(),
            "starts": self.starts,
        });
        format!("{value:#}\n")
    }

    /// Remembers; a disk that refuses is nobody's business here.
    pub(crate) fn save(&self) {
        let Some(path) = Self::path() else { return };
        if let Some(folder) = path.parent() {
            let _ = std::fs::create_dir_all(folder);
        }
        let _ =
            foton_film::atomic_write(&path, |file| std::io::Write::write_all(file, self.text().as_bytes()));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_reads_back_and_nonsense_is_the_default() {
        let snapshot_folder = std::env::temp_dir();
        let preferences = Preferences {
            window: [900.0, 700.0],
            dark: false,
            png_as_shown: false,
            snapshot_folder,
            recent: vec!["/scenes/a.xml".into(), "/scenes/b.xml".into()],
            starts: 3,
            ..Preferences::default()
        };
        assert_eq!(Preferences::parse(&preferences.text()), preferences);
        for bad in [
            "",
            "[]",
            "{\"window\":[1e9,\"x\"],\"dark\":3}",
            "{\"snapshot_folder\":\"/nowhere/at/all\"}",
            "{\"snapshot_folder\":\".\"}",
        ] {
            assert_eq!(Preferences::parse(bad), Preferences::default(), "{bad}");
        }
    }

    #[test]
    fn scenes_are_remembered_once_the_last_one_first() {
        let mut preferences = Preferences::default();
        for n in [1, 2, 3, 1] {
            preferences.remember(Path::new(&format!("/scenes/{n}.xml")));
        }
        assert_eq!(
            preferences.recent,
            ["/scenes/1.xml", "/scenes/3.xml", "/scenes/2.xml"].map(PathBuf::from)
        );
        (0..40).for_each(|n| preferences.remember(Path::new(&format!("/scenes/{n}.xml"))));
        assert_eq!(preferences.recent.len(), MAX_RECENT);
    }
}
