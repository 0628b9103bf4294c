//! Maps of photons in a file: made once, and shown again by other renders of the same scene, through any camera.
//!
//! Layout, little-endian: 8 bytes of magic, version (u32), the scene's fingerprint, the length of the maps, the maps as zstd, and a hash of
//! all bytes before (u64 each).

use std::io::Write as _;
use std::path::{Path, PathBuf};

use foton_film::{WriteError, atomic_write};
use foton_input::{Limit, Named, shown_path};
use foton_integrator::{KeptMaps, StateError};
use foton_scene::Scene;
use thiserror::Error;

use crate::checkpoint::hash;

const MAGIC: [u8; 8] = *b"fotonMAP";
const VERSION: u32 = 1;
const HEADER: usize = 8 + 4 + 2 * 8;
const TRAILER: usize = 8;

/// zstd's own middle: photons hardly shrink at all.
const COMPRESSION: i32 = 3;

/// Maps are at most this large once they are unpacked: a billion photons.
const MOST: u64 = 20 << 30;

/// Why maps cannot be used.
#[derive(Debug, Error)]
pub enum MapsError {
    /// The file cannot be read.
    #[error("{path}: {cause}", path = shown_path(path))]
    Read {
        /// Its path.
        path: PathBuf,
        /// What the system says.
        cause: std::io::Error,
    },
    /// It has none.
    #[error("{path}: these are no photon maps of foton", path = shown_path(path))]
    NoMaps {
        /// Its path.
        path: PathBuf,
    },
    /// It is of another version.
    #[error("{path}: photon maps of version {found}; this foton reads version {VERSION}", path = shown_path(path))]
    Version {
        /// Its path.
        path: PathBuf,
        /// Its version.
        found: u32,
    },
    /// Its hash is not that of its bytes.
    #[error("{path}: the photon maps are damaged", path = shown_path(path))]
    Damaged {
        /// Its path.
        path: PathBuf,
    },
    /// They are of another scene.
    #[error("{path}: the photon maps are of another scene: its surfaces, materials or emitters differ; --save-maps makes new ones", path = shown_path(path))]
    OtherScene {
        /// Its path.
        path: PathBuf,
    },
    /// They were made for paths of another length.
    #[error(
        "{path}: the photon maps were made with max-depth {found}, and this render has {wanted}; --max-depth {found} shows them",
        path = shown_path(path)
    )]
    OtherDepth {
        /// Its path.
        path: PathBuf,
        /// What they were made with.
        found: u32,
        /// What is asked for.
        wanted: u32,
    },
    /// They make no sense, although the hash is right.
    #[error("{path}: {cause}", path = shown_path(path))]
    State {
        /// Its path.
        path: PathBuf,
        /// What is wrong.
        cause: StateError,
    },
}

/// Writes the maps of a scene; the file that was there before stays whole until the new one is.
///
/// # Errors
/// [`WriteError`] with the path.
pub fn write(path: &Path, maps: &KeptMaps, scene: &Scene) -> Result<(), WriteError> {
    atomic_write(path, |file| {
        let whole = maps.to_bytes();
        let packed = zstd::bulk::compress(&whole, COMPRESSION)?;
        let mut bytes = Vec::with_capacity(HEADER + packed.len() + TRAILER);
        bytes.extend_from_slice(&MAGIC);
        bytes.extend_from_slice(&VERSION.to_le_bytes());
        bytes.extend_from_slice(&scene.fingerprint().to_le_bytes());
        bytes.extend_from_slice(&(whole.len() as u64).to_le_bytes());
        bytes.extend_from_slice(&packed);
        bytes.extend_from_slice(&hash(&bytes).to_le_bytes());
        file.write_all(&bytes)
    })
}

/// Reads maps for a render of a scene with such a longest path.
///
/// # Errors
/// When the file has no maps of that scene; see [`MapsError`].
pub fn read(path: &Path, scene: &Scene, max_depth: u32) -> Result<KeptMaps, MapsError> {
    let owned = || path.to_owned();
    let bytes = foton_input::read_file(path, Named::ByFile, Limit::new(Some(MOST), 1), &|| false)
        .map_err(|cause| MapsError::Read { path: owned(), cause })?;
    let damaged = || MapsError::Damaged { path: owned() };
    if !bytes.starts_with(&MAGIC) {
        return Err(MapsError::NoMaps { path: owned() });
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
        return Err(MapsError::Version { path: owned(), found });
    }
    let (content, trailer) = bytes.split_at(bytes.len() - TRAILER);
    if hash(content).to_le_bytes() != trailer {
        return Err(damaged());
    }
    if number(12) != scene.fingerprint() {
        return Err(MapsError::OtherScene { path: owned() });
    }
    let length = number(20);
    if length > MOST {
        return Err(damaged());
    }
    let whole = zstd::bulk::decompress(&content[HEADER..], length as usize).map_err(|_| damaged())?;
    let maps = KeptMaps::from_bytes(&whole).map_err(|cause| MapsError::State { path: owned(), cause })?;
    if maps.max_depth() != max_depth {
        return Err(MapsError::OtherDepth { path: owned(), found: maps.max_depth(), wanted: max_depth });
    }
    Ok(maps)
}
