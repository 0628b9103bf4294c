//! Names of files whose letters are of another case on the disk: scenes come from systems that do not tell them apart.

use std::fs;
use std::path::{Component, Path, PathBuf};

/// The most entries of a folder that are looked at.
const MOST: usize = 100_000;

/// The one file or folder whose path differs from this one by the case of its letters alone; `None` where there is none, or more than one.
/// Where the path itself is there, that is it.
#[must_use]
pub fn of_other_case(path: &Path) -> Option<PathBuf> {
    let mut found = PathBuf::new();
    for component in path.components() {
        let exact = found.join(component);
        let Component::Normal(name) = component else {
            found = exact;
            continue;
        };
        if exact.symlink_metadata().is_ok() {
            found = exact;
            continue;
        }
        let wanted = name.to_str()?.to_lowercase();
        let folder = if found.as_os_str().is_empty() { Path::new(".") } else { &found };
        let entries = fs::read_dir(folder).ok()?.take(MOST).flatten();
        let mut like = entries
            .map(|entry| entry.file_name())
            .filter(|n| n.to_str().is_some_and(|n| n.to_lowercase() == wanted));
        let only = like.next()?;
        if like.next().is_some() {
            return None;
        }
        found.push(only);
    }
    Some(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_only_file_of_another_case_is_found() {
        let folder = std::env::temp_dir().join(format!("foton-other-case-{}", std::process::id()));
        fs::create_dir_all(folder.join("Meshes")).expect("a folder");
        for name in ["Meshes/Ball.OBJ", "one.txt", "ONE.txt"] {
            fs::write(folder.join(name), "").expect("a file");
        }
        let of = |name: &str| of_other_case(&folder.join(name));
        let distinct = fs::read_dir(&folder).expect("it is there").count() == 3;
        if distinct {
            assert_eq!(of("meshes/ball.obj"), Some(folder.join("Meshes/Ball.OBJ")));
            assert_eq!(of("meshes/../MESHES/ball.obj"), Some(folder.join("Meshes/../Meshes/Ball.OBJ")));
            assert_eq!(of("One.txt"), None, "there are two");
        }
        assert_eq!(of("one.txt"), Some(folder.join("one.txt")));
        assert_eq!(of("none.txt"), None);
        let _ = fs::remove_dir_all(folder);
    }
}
