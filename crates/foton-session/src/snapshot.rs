//! Image files: which format, which name, what goes in.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use foton_film::tone_map::ToneMap;
use foton_film::{WriteError, write_exr, write_png};
use foton_integrator::{LayerKind, Render};

use crate::metadata::{self, SceneIdentity};
use crate::shown::Shown;

/// Endings of scenes' files.
const ENDINGS: [&str; 8] = ["xml", "pbrt", "gltf", "glb", "obj", "ply", "stl", "off"];

/// How many letters of a scene's name stand in those of files.
const LETTERS: usize = 80;

/// Formats that images are written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Linear radiance.
    Exr,
    /// Tone-mapped, to look at.
    Png,
}

impl Format {
    /// The format that a file name asks for.
    #[must_use]
    pub fn of(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_str()?.to_ascii_lowercase();
        match extension.as_str() {
            "exr" => Some(Self::Exr),
            "png" => Some(Self::Png),
            _ => None,
        }
    }
}

/// How a PNG shows radiance. An EXR is linear whatever this says.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Look {
    /// How radiance is brought into the range of a screen.
    pub tone_map: ToneMap,
    /// Each stop doubles the light.
    pub exposure_stops: f32,
}

/// Writes what is to be shown of a render as it stands; a PNG shows it by `look`, and says so in its metadata.
///
/// # Errors
/// [`WriteError`] with the path; a file that was there before is then still whole.
pub fn write(
    path: &Path,
    format: Format,
    (render, shown): (&Render, &Shown),
    layers: &[LayerKind],
    look: Look,
    scene: &SceneIdentity,
) -> Result<(), WriteError> {
    let mut metadata = metadata::of(render, layers, scene);
    if let Some(shown) = shown.name() {
        metadata.set("foton:shown", shown);
    }
    let image = shown.image(render);
    match format {
        Format::Exr => {
            let layers: Vec<_> = layers.iter().filter_map(|&kind| render.layer(kind)).collect();
            write_exr(path, &image, &layers, &metadata)
        }
        Format::Png => {
            let Look { tone_map, exposure_stops } = look;
            metadata.set("foton:look", format!("exposure={exposure_stops} tone_map={}", tone_map.key()));
            write_png(path, &image, tone_map, exposure_stops, &metadata)
        }
    }
}

/// `OUT-000016.exr` for `OUT.exr` after 16 passes.
#[must_use]
pub fn numbered(path: &Path, pass: u64) -> PathBuf {
    suffixed(path, &format!("{pass:06}"))
}

/// `OUT-SUFFIX.exr` for `OUT.exr`.
#[must_use]
pub fn suffixed(path: &Path, suffix: &str) -> PathBuf {
    // Names need not be text.
    let mut name = path.file_stem().unwrap_or_default().to_owned();
    name.push(format!("-{suffix}."));
    name.push(path.extension().unwrap_or_default());
    path.with_file_name(name)
}

/// The pass of which a file of that name would be [`numbered`] for `path`, if of any.
#[must_use]
pub fn pass_of(path: &Path, name: &OsStr) -> Option<u64> {
    let stem = path.file_stem()?.as_encoded_bytes();
    let rest = name.as_encoded_bytes().strip_prefix(stem)?.strip_prefix(b"-")?;
    let digits = rest.iter().take_while(|b| b.is_ascii_digit()).count();
    let pass = std::str::from_utf8(&rest[..digits]).ok()?.parse().ok()?;
    (numbered(path, pass).file_name() == Some(name)).then_some(pass)
}

/// The name that all files of a run share, such as `ring-001`: that of the scene, and the number after the largest that a file of
/// such a name has in the folder, so that runs are in the order of their numbers.
#[must_use]
pub fn next_run(folder: &Path, scene: &str) -> String {
    let scene = file_stem(scene);
    let begins = format!("{scene}-");
    let number = |name: &str| {
        let digits = name.strip_prefix(&begins)?.split(['-', '.']).next()?;
        digits.parse::<u32>().ok().filter(|_| digits.len() >= 3)
    };
    let entries = folder.read_dir().into_iter().flatten().flatten();
    let last = entries.filter_map(|entry| number(&entry.file_name().to_string_lossy())).max();
    format!("{scene}-{:03}", last.unwrap_or(0).saturating_add(1))
}

/// `ring-001-p000016`, the name of the files of a run after 16 passes; `ring-001-p000016-2` where `is_taken` says so, and so on.
#[must_use]
pub fn of_run(run: &str, pass: u64, is_taken: impl Fn(&str) -> bool) -> String {
    let name = format!("{run}-p{pass:06}");
    if !is_taken(&name) {
        return name;
    }
    (2u64..).map(|n| format!("{name}-{n}")).find(|name| !is_taken(name)).unwrap_or(name)
}

/// A scene's name without the ending of its file.
pub(crate) fn without_ending(scene: &str) -> &str {
    let ended =
        scene.rsplit_once('.').filter(|(_, e)| ENDINGS.iter().any(|known| e.eq_ignore_ascii_case(known)));
    ended.map_or(scene, |(stem, _)| stem)
}

/// A scene's name as the beginning of a file's, on any system.
fn file_stem(scene: &str) -> String {
    let scene = without_ending(scene);
    let harmless = |c: char| if c.is_alphanumeric() || "-_+. ".contains(c) { c } else { '_' };
    let stem: String = scene.chars().map(harmless).take(LETTERS).collect();
    let stem = stem.trim_matches([' ', '.']);
    if stem.is_empty() { "scene".to_owned() } else { stem.to_owned() }
}

/// `foton-001` with the next number of which neither a PNG nor an EXR is there.
#[must_use]
pub fn next_free(folder: &Path) -> PathBuf {
    // A link to what is not there is somebody's, too.
    let taken =
        |stem: &Path| ["png", "exr"].iter().any(|e| stem.with_extension(e).symlink_metadata().is_ok());
    (1u32..).map(|n| folder.join(format!("foton-{n:03}"))).find(|stem| !taken(stem)).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_are_numbered_after_all_that_are_there() {
        let folder = std::env::temp_dir().join(format!("foton-runs-{}", std::process::id()));
        assert_eq!(next_run(&folder, "ring"), "ring-001", "a folder that is still to be made");
        std::fs::create_dir_all(&folder).expect("a folder");
        for name in ["ring-001-p000001.exr", "ring-007-p000016.png", "ring-2024.txt", "rings-900-p000001.exr"]
        {
            std::fs::write(folder.join(name), "").expect("written");
        }
        assert_eq!(next_run(&folder, "ring"), "ring-2025");
        std::fs::remove_file(folder.join("ring-2024.txt")).expect("ours");
        assert_eq!(next_run(&folder, "ring"), "ring-008");
        assert_eq!(next_run(&folder, "a/b:c"), "a_b_c-001");
        assert_eq!(next_run(&folder, ".."), "scene-001");
        assert_eq!(
            (next_run(&folder, "lamp.XML"), next_run(&folder, "v1.2")),
            ("lamp-001".into(), "v1.2-001".into())
        );
        assert_eq!(of_run("ring-008", 16, |_| false), "ring-008-p000016");
        let taken = ["ring-008-p000016", "ring-008-p000016-2"];
        assert_eq!(of_run("ring-008", 16, |name| taken.contains(&name)), "ring-008-p000016-3");
        std::fs::remove_dir_all(folder).expect("ours");
    }

    #[test]
    fn names_carry_the_pass_and_the_format() {
        assert_eq!(numbered(Path::new("a/b.c.exr"), 16), Path::new("a/b.c-000016.exr"));
        let pass = |name: &str| pass_of(Path::new("a/b.c.exr"), OsStr::new(name));
        assert_eq!((pass("b.c-000016.exr"), pass("b.c-1234567.exr")), (Some(16), Some(1_234_567)));
        for other in
            ["b.c-16.exr", "b.c-0000016.exr", "b.c-000016.png", "b-000016.exr", "b.c-.exr", "b.c.exr"]
        {
            assert_eq!(pass(other), None, "{other}");
        }
        assert_eq!(Format::of(Path::new("x.PNG")), Some(Format::Png));
        assert_eq!((Format::of(Path::new("x.jpg")), Format::of(Path::new("exr"))), (None, None));
    }
}
