//! Image files: which format, which name, what goes in.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use foton_film::tone_map::ToneMap;
use foton_film::{WriteError, write_exr, write_png};
use foton_integrator::{LayerKind, Render};

use crate::metadata::{self, SceneIdentity};

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

/// Writes a render as it stands.
///
/// # Errors
/// [`WriteError`] with the path; a file that was there before is then still whole.
pub fn write(
    path: &Path,
    format: Format,
    render: &Render,
    layers: &[LayerKind],
    scene: &SceneIdentity,
) -> Result<(), WriteError> {
    let metadata = metadata::of(render, scene);
    match format {
        Format::Exr => {
            let layers: Vec<_> = layers.iter().filter_map(|&kind| render.layer(kind)).collect();
            write_exr(path, &render.image(), &layers, &metadata)
        }
        Format::Png => write_png(path, &render.image(), ToneMap::default(), 0.0, &metadata),
    }
}

/// `OUT-000016.exr` for `OUT.exr` after 16 passes.
#[must_use]
pub fn numbered(path: &Path, pass: u64) -> PathBuf {
    // Names need not be text.
    let mut name = path.file_stem().unwrap_or_default().to_owned();
    name.push(format!("-{pass:06}."));
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
