//! Folders of the user: where pictures go when nobody says where. Nothing is made here.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use foton_input::{Limit, Named, read_file};

/// What `user-dirs.dirs` may be long.
const MAX_BYTES: u64 = 1 << 16;

/// foton's folder among the user's pictures: `foton` in what `user-dirs.dirs` calls the pictures' folder, or else in `Pictures` of
/// the home folder; without a home the working directory.
#[must_use]
pub fn pictures() -> PathBuf {
    pictures_of(|name| std::env::var_os(name).filter(|value| !value.is_empty()))
}

/// foton's folder for what can be made again; `None` without a home.
#[must_use]
pub fn cache() -> Option<PathBuf> {
    cache_of(|name| std::env::var_os(name).filter(|value| !value.is_empty()))
}

/// Where the small picture of a scene's file is kept; `None` without a home.
#[must_use]
pub fn thumbnail(scene: &Path) -> Option<PathBuf> {
    // FNV-1a, 64 bits.
    let bytes = scene.as_os_str().as_encoded_bytes();
    let hash = bytes
        .iter()
        .fold(0xcbf2_9ce4_8422_2325_u64, |h, &b| (h ^ u64::from(b)).wrapping_mul(0x0100_0000_01b3));
    Some(cache()?.join("thumbnails").join(format!("{hash:016x}.png")))
}

fn home_of(variable: &impl Fn(&str) -> Option<OsString>) -> Option<PathBuf> {
    let home = variable("HOME").or_else(|| variable("USERPROFILE")).map(PathBuf::from)?;
    home.is_absolute().then_some(home)
}

fn pictures_of(variable: impl Fn(&str) -> Option<OsString>) -> PathBuf {
    let Some(home) = home_of(&variable) else {
        return std::env::current_dir().unwrap_or_else(|_| PathBuf::from("."));
    };
    let settings = variable("XDG_CONFIG_HOME").map_or_else(|| home.join(".config"), PathBuf::from);
    let limit = Limit::new(Some(MAX_BYTES), 1);
    let text = read_file(&settings.join("user-dirs.dirs"), Named::ByFile, limit, &|| false).ok();
    let named = text.and_then(|bytes| pictures_in(&String::from_utf8_lossy(&bytes), &home));
    named.unwrap_or_else(|| home.join("Pictures")).join("foton")
}

/// What a line such as `XDG_PICTURES_DIR="$HOME/Bilder"` names.
fn pictures_in(text: &str, home: &Path) -> Option<PathBuf> {
    let value = text.lines().filter_map(|line| line.trim().strip_prefix("XDG_PICTURES_DIR=")).next_back()?;
    let value = value.trim().strip_prefix('"')?.strip_suffix('"')?.replace("\\\"", "\"");
    let path = match value.strip_prefix("$HOME") {
        Some(rest) => home.join(rest.trim_start_matches('/')),
        None => PathBuf::from(value),
    };
    path.is_absolute().then_some(path)
}

fn cache_of(variable: impl Fn(&str) -> Option<OsString>) -> Option<PathBuf> {
    let named = variable("XDG_CACHE_HOME").or_else(|| variable("LOCALAPPDATA")).map(PathBuf::from);
    let folder = named.filter(|folder| folder.is_absolute());
    Some(folder.or_else(|| home_of(&variable).map(|home| home.join(".cache")))?.join("foton"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_go_where_the_desktop_keeps_them() {
        let home = std::env::temp_dir().join(format!("foton-home-{}", std::process::id()));
        let here = std::env::current_dir().expect("a folder");
        std::fs::create_dir_all(home.join(".config")).expect("a folder");
        let variable = |name: &str| (name == "HOME").then(|| home.clone().into_os_string());
        assert_eq!(pictures_of(variable), home.join("Pictures/foton"));
        let say = |text: &str| std::fs::write(home.join(".config/user-dirs.dirs"), text).expect("written");
        say("# a comment\nXDG_MUSIC_DIR=\"$HOME/Musik\"\nXDG_PICTURES_DIR=\"$HOME/Bilder\"\n");
        assert_eq!(pictures_of(variable), home.join("Bilder/foton"));
        say("XDG_PICTURES_DIR=\"/pool/pictures\"");
        assert_eq!(pictures_of(variable), Path::new("/pool/pictures/foton"));
        say("XDG_PICTURES_DIR=relative\nXDG_PICTURES_DIR=\"relative\"");
        assert_eq!(pictures_of(variable), home.join("Pictures/foton"));
        assert_eq!(pictures_of(|_| None), here);
        assert_eq!(cache_of(variable), Some(home.join(".cache/foton")));
        assert_eq!(cache_of(|_| None), None);
        std::fs::remove_dir_all(home).expect("ours");
    }
}
