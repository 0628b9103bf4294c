//! The file dialog: picks a file to open or a name to save under, drawn by egui like everything else in the window.
//!
//! The desktop's own dialog needs a portal or a helper program and fails in silence without one. This one always works, by
//! keyboard alone as well. Not here: reading or writing the file that was picked.

mod listing;
mod panel;

#[cfg(test)]
mod tests;

use std::path::{Path, PathBuf};

use foton_input::shown_path;
use listing::Entry;

/// What scenes and meshes end in.
pub(crate) const SCENES: &[&str] = &["xml", "pbrt", "gltf", "glb", "obj", "ply", "stl", "off"];

/// What meshes end in.
pub(crate) const MESHES: &[&str] = &["gltf", "glb", "obj", "ply", "stl", "off"];

/// What checkpoints end in.
pub(crate) const CHECKPOINTS: &[&str] = &["checkpoint"];

/// What the picked path is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Purpose {
    /// The file must be there.
    Open,
    /// A file that is there is replaced only when asked for twice.
    Save,
}

/// What became of the dialog in a frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Outcome {
    /// It is still open.
    Browsing,
    /// It was closed without a choice.
    Cancelled,
    /// The file to open, or to write.
    Chosen(PathBuf),
}

/// An open dialog. It is gone when its owner drops it, after an [`Outcome`] other than [`Outcome::Browsing`].
#[derive(Debug)]
pub(crate) struct FileDialog {
    purpose: Purpose,
    /// Without the dot, in lower case; the first is given to a saved file that has none.
    extensions: &'static [&'static str],
    every_file: bool,
    folder: PathBuf,
    entries: Vec<Entry>,
    selected: Option<usize>,
    /// A name in the folder, or a path.
    typed: String,
    trouble: Option<String>,
    /// The file that will be replaced if it is chosen again.
    replaces: Option<PathBuf>,
    /// The name field takes the keyboard in the next frame.
    wants_focus: bool,
}

impl FileDialog {
    /// A dialog that opens a file with one of `extensions`, starting in `folder`.
    pub(crate) fn open(folder: &Path, extensions: &'static [&'static str]) -> Self {
        Self::new(Purpose::Open, folder, String::new(), extensions)
    }

    /// A dialog that saves under `path`, unless another name is given.
    pub(crate) fn save(path: &Path, extensions: &'static [&'static str]) -> Self {
        let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        Self::new(Purpose::Save, path.parent().unwrap_or(Path::new("")), name, extensions)
    }

    fn new(purpose: Purpose, folder: &Path, typed: String, extensions: &'static [&'static str]) -> Self {
        let mut dialog = Self {
            purpose,
            extensions,
            every_file: false,
            folder: PathBuf::new(),
            entries: Vec::new(),
            selected: None,
            typed: String::new(),
            trouble: None,
            replaces: None,
            wants_focus: true,
        };
        dialog.enter(folder);
        dialog.typed = typed;
        dialog
    }

    /// Lists another folder.
    fn enter(&mut self, folder: &Path) {
        self.folder = std::path::absolute(folder)
            .or_else(|_| std::env::current_dir())
            .unwrap_or_else(|_| folder.to_path_buf());
        self.list();
        if self.purpose == Purpose::Open {
            self.typed.clear();
        }
    }

    /// Reads the folder again.
    fn list(&mut self) {
        self.selected = None;
        self.replaces = None;
        let wanted = if self.every_file { None } else { Some(self.extensions) };
        (self.entries, self.trouble) = match listing::read(&self.folder, wanted) {
            Ok(entries) => (entries, None),
            Err(cause) => (Vec::new(), Some(format!("{} cannot be read: {cause}", shown_path(&self.folder)))),
        };
    }

    /// Goes one folder up, if there is one.
    fn leave(&mut self) {
        if let Some(parent) = self.folder.parent().map(Path::to_path_buf) {
            self.enter(&parent);
        }
    }

    /// Selects an entry; a file's name is taken over, and when opening a folder's too.
    fn select(&mut self, index: usize) {
        let Some(entry) = self.entries.get(index) else { return };
        self.selected = Some(index);
        self.replaces = None;
        self.trouble = None;
        if !entry.is_folder || self.purpose == Purpose::Open {
            self.typed.clone_from(&entry.name);
        }
    }

    /// Selects the entry below or above; the first or the last if none is.
    fn step(&mut self, down: bool) {
        let last = self.entries.len().saturating_sub(1);
        self.select(match self.selected {
            Some(at) if down => (at + 1).min(last),
            Some(at) => at.saturating_sub(1),
            None if down => 0,
            None => last,
        });
    }

    /// Opens the entry: goes into a folder, chooses a file.
    fn activate(&mut self, index: usize) -> Option<PathBuf> {
        self.select(index);
        let entry = self.entries.get(index)?;
        if entry.is_folder {
            self.enter(&self.folder.join(&entry.name));
            return None;
        }
        self.submit()
    }

    /// Takes what is typed: goes into a folder, or chooses a file, or says why not.
    fn submit(&mut self) -> Option<PathBuf> {
        self.trouble = None;
        let typed = self.typed.trim();
        if typed.is_empty() {
            self.trouble = Some("Choose a file or type its name.".to_owned());
            return None;
        }
        let mut path = listing::resolve(&self.folder, typed);
        if path.is_dir() {
            self.enter(&path);
            self.typed.clear();
            return None;
        }
        match self.purpose {
            Purpose::Open if path.is_file() => return Some(path),
            Purpose::Open => self.trouble = Some(format!("There is no file {}.", shown_path(&path))),
            Purpose::Save => {
                if path.extension().is_none() {
                    path.set_extension(self.extensions.first().copied().unwrap_or_default());
                }
                let folder = path.parent().unwrap_or(Path::new("/"));
                if !folder.is_dir() {
                    self.trouble = Some(format!("There is no folder {}.", shown_path(folder)));
                } else if path.exists() && self.replaces.as_deref() != Some(&path) {
                    self.trouble = Some(format!("{} is there already. Replace it?", shown_path(&path)));
                    self.replaces = Some(path);
                } else {
                    return Some(path);
                }
            }
        }
        None
    }
}
