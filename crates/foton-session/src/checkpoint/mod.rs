//! Checkpoints: a render's state in a file, from which it goes on with the same bits as if it had never stopped.
//!
//! Layout, little-endian: 8 bytes of magic, version (u32), length of the text (u64), nanoseconds of rendering (u64), rays (u64),
//! length of the state (u64), the text (what must be the same: see `identity.rs`), the state as zstd, and a hash of all bytes before (u64).
//! What the start of a render makes is not in it: hit points are collected again.

mod identity;
mod keeper;
#[cfg(test)]
mod tests;

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::time::Duration;

use foton_film::{WriteError, atomic_write};
use foton_input::{Limit, Named, shown_path};
use foton_integrator::{Render, StateError};
use thiserror::Error;

use crate::metadata::SceneIdentity;
use crate::session::Session;

pub use keeper::{Keeper, Unwritten};

const MAGIC: [u8; 8] = *b"fotonPPM";
const VERSION: u32 = 5;
const HEADER: usize = 8 + 4 + 4 * 8;
const TRAILER: usize = 8;

/// zstd's own middle: states hardly shrink any further above it.
const COMPRESSION: i32 = 3;

/// Bytes of a checkpoint beside its state, at most: its text, and what packing adds where nothing can be packed.
const BESIDE: u64 = 1 << 20;

/// Why a checkpoint cannot be resumed.
#[derive(Debug, Error)]
pub enum ResumeError {
    /// The file cannot be read.
    #[error("{path}: {cause}", path = shown_path(path))]
    Read {
        /// Its path.
        path: PathBuf,
        /// What the system says.
        cause: std::io::Error,
    },
    /// It is none.
    #[error("{path}: this is no checkpoint of foton", path = shown_path(path))]
    NoCheckpoint {
        /// Its path.
        path: PathBuf,
    },
    /// It is of another version.
    #[error("{path}: a checkpoint of version {found}; this foton reads version {VERSION}", path = shown_path(path))]
    Version {
        /// Its path.
        path: PathBuf,
        /// Its version.
        found: u32,
    },
    /// Its hash is not that of its bytes.
    #[error("{path}: the checkpoint is damaged", path = shown_path(path))]
    Damaged {
        /// Its path.
        path: PathBuf,
    },
    /// The scene or a setting is another.
    #[error("{path}: the checkpoint {difference}", path = shown_path(path))]
    OtherRender {
        /// Its path.
        path: PathBuf,
        /// What is another, in words.
        difference: String,
    },
    /// Its state makes no sense, although its hash is right.
    #[error("{path}: {cause}", path = shown_path(path))]
    State {
        /// Its path.
        path: PathBuf,
        /// What is wrong.
        cause: StateError,
    },
}

/// Writes a render as it stands, with the time and the rays that it has taken; the file that was there before stays whole until the new one is.
///
/// # Errors
/// [`WriteError`] with the path.
pub fn write(
    path: &Path,
    render: &Render,
    elapsed: Duration,
    rays: u64,
    scene: &SceneIdentity,
) -> Result<(), WriteError> {
    Prepared::of(render, elapsed, rays, scene).write(path)
}

/// A render's state that is still to be written, apart from the render.
pub struct Prepared {
    state: Vec<u8>,
    text: String,
    nanoseconds: u64,
    rays: u64,
}

impl Prepared {
    /// Of a render as it stands, with the time and the rays that it has taken.
    #[must_use]
    pub fn of(render: &Render, elapsed: Duration, rays: u64, scene: &SceneIdentity) -> Self {
        let nanoseconds = u64::try_from(elapsed.as_nanos()).unwrap_or(u64::MAX);
        Self { state: render.save(), text: identity::of(render, scene), nanoseconds, rays }
    }

    /// Writes it; the file that was there before stays whole until the new one is.
    ///
    /// # Errors
    /// [`WriteError`] with the path.
    pub fn write(&self, path: &Path) -> Result<(), WriteError> {
        let Self { state, text, nanoseconds, rays } = self;
        atomic_write(path, |file| {
            let packed = zstd::bulk::compress(state, COMPRESSION)?;
            let mut bytes = Vec::with_capacity(HEADER + text.len() + packed.len() + TRAILER);
            bytes.extend_from_slice(&MAGIC);
            bytes.extend_from_slice(&VERSION.to_le_bytes());
            for number in [text.len() as u64, *nanoseconds, *rays, state.len() as u64] {
                bytes.extend_from_slice(&number.to_le_bytes());
            }
            bytes.extend_from_slice(text.as_bytes());
            bytes.extend_from_slice(&packed);
            bytes.extend_from_slice(&hash(&bytes).to_le_bytes());
            file.write_all(&bytes)
        })
    }
}

/// Resumes a checkpoint in a render that was started with the same scene and settings. α and photons a pass come from the
/// checkpoint. `needs_classes` says that light by path class must be that of all passes; otherwise, where the checkpoint has none, it
/// is summed from here on ([`Render::photons_by_class`]).
///
/// # Errors
/// When the file is no checkpoint of this render; see [`ResumeError`]. The session is then not to be used.
pub fn resume(
    path: &Path,
    session: &mut Session,
    scene: &SceneIdentity,
    needs_classes: bool,
) -> Result<(), ResumeError> {
    let owned = || path.to_owned();
    let expected = session.render().save().len() as u64;
    // Each change of a setting takes 24 bytes; no render has so many that the state grows eightfold.
    let most = 8 * expected.max(1 << 20);
    let bytes = foton_input::read_file(path, Named::ByFile, Limit::new(Some(most + BESIDE), 1), &|| false)
        .map_err(|cause| ResumeError::Read { path: owned(), cause })?;
    let damaged = || ResumeError::Damaged { path: owned() };
    if !bytes.starts_with(&MAGIC) {
        return Err(ResumeError::NoCheckpoint { path: owned() });
    }
    if bytes.len() < HEADER + TRAILER {
        return Err(damaged());
    }
    let number = |at: usize| {
        let field = bytes.get(at..at + 8).and_then(|b| b.try_into().ok());
        field.map_or(0, u64::from_le_bytes)
    };
    let found = number(8) as u32;
    if found != VERSION {
        return Err(ResumeError::Version { path: owned(), found });
    }
    let (content, trailer) = bytes.split_at(bytes.len() - TRAILER);
    if hash(content).to_le_bytes() != trailer {
        return Err(damaged());
    }
    let body = &content[HEADER..];
    let (text, packed) =
        usize::try_from(number(12)).ok().and_then(|at| body.split_at_checked(at)).ok_or_else(damaged)?;
    if let Some(difference) =
        identity::difference(&String::from_utf8_lossy(text), &identity::of(session.render(), scene))
    {
        return Err(ResumeError::OtherRender { path: owned(), difference });
    }
    let length = number(36);
    if length > most || number(28) > 1 << 60 {
        return Err(damaged());
    }
    let state = zstd::bulk::decompress(packed, length as usize).map_err(|_| damaged())?;
    session
        .restore(&state, Duration::from_nanos(number(20)), number(28))
        .map_err(|cause| ResumeError::State { path: owned(), cause })?;
    let render = session.render();
    // Photons of maps are those of no pass.
    let of_passes = if render.settings().method.has_discs() { render.photons_emitted() } else { 0 };
    if needs_classes && render.photons_by_class().is_none_or(|photons| photons < of_passes) {
        let difference = identity::WITHOUT_CLASSES.to_owned();
        return Err(ResumeError::OtherRender { path: owned(), difference });
    }
    Ok(())
}

/// FNV-1a, 64 bits.
pub(crate) fn hash(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |h, &b| (h ^ u64::from(b)).wrapping_mul(0x0100_0000_01b3))
}
