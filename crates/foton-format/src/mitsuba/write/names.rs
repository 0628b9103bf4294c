//! Names of files beside a scene file, and the mark that they carry.

use std::path::Path;

use foton_input::printable;

/// What stands in the files that are written for a scene file.
pub(super) fn mark(scene: &Path) -> String {
    let name = scene.file_name().unwrap_or_default().to_string_lossy();
    format!("written by foton for {}", printable(&name))
}

/// A name as it may stand in a file name anywhere.
pub(super) fn file_name(name: &str) -> String {
    let letter = |c: char| if c.is_ascii_alphanumeric() || c == '-' || c == '_' { c } else { '_' };
    let name: String = name.chars().take(60).map(letter).collect();
    if name.is_empty() { "unnamed".to_owned() } else { name }
}
