//! What can go wrong with an image file. Every message is one line and names the file.

use std::io;
use std::path::{Path, PathBuf};

use foton_input::{printable, shown_path};
use thiserror::Error;

use crate::MetadataError;

/// Why a file was not written; the file that was there before is untouched.
#[derive(Debug, Error)]
pub enum WriteError {
    /// The folder to write in is missing.
    #[error("cannot write {}: the folder {} does not exist", shown_path(path), shown_path(folder))]
    NoFolder {
        /// The file asked for.
        path: PathBuf,
        /// Its folder.
        folder: PathBuf,
    },
    /// The file is there and marked read-only.
    #[error("cannot write {}: the file is read-only", shown_path(path))]
    ReadOnly {
        /// The file asked for.
        path: PathBuf,
    },
    /// Nothing can be made beside the file, which is written anew and renamed, so that no reader meets half of it.
    #[error("cannot write {}: nothing can be made in its folder {}: {cause}", path.display(), folder.display())]
    Folder {
        /// The file asked for.
        path: PathBuf,
        /// Its folder, with links followed.
        folder: PathBuf,
        /// What the system said.
        cause: io::Error,
    },
    /// It is something that no file can be written to.
    #[error("cannot write {}: it is {what}", path.display())]
    Special {
        /// The file asked for.
        path: PathBuf,
        /// What it is.
        what: &'static str,
    },
    /// The operating system refused.
    #[error("cannot write {}: {cause}", shown_path(path))]
    Io {
        /// The file asked for.
        path: PathBuf,
        /// What it said.
        cause: io::Error,
    },
    /// The image, a layer or the metadata cannot be stored; nothing on the disk was touched.
    #[error("cannot write {}: {reason}", shown_path(path))]
    Content {
        /// The file asked for.
        path: PathBuf,
        /// What is wrong with it.
        reason: ContentError,
    },
}

impl WriteError {
    /// Whether something has the name already that a new file was to have: see [`write_new`](crate::write_new).
    #[must_use]
    pub fn is_taken(&self) -> bool {
        matches!(self, Self::Io { cause, .. } if cause.kind() == io::ErrorKind::AlreadyExists)
    }

    /// The same of another file.
    pub(crate) fn about(mut self, of: &Path) -> Self {
        let (Self::NoFolder { path, .. }
        | Self::ReadOnly { path }
        | Self::Folder { path, .. }
        | Self::Special { path, .. }
        | Self::Io { path, .. }
        | Self::Content { path, .. }) = &mut self;
        of.clone_into(path);
        self
    }

    /// For `map_err`: an I/O failure while writing `path`.
    pub(crate) fn io(path: &Path) -> impl Fn(io::Error) -> Self {
        move |cause| Self::Io { path: path.into(), cause }
    }

    /// For `map_err`: content that `path` cannot hold.
    pub(crate) fn content(path: &Path) -> impl Fn(ContentError) -> Self {
        move |reason| Self::Content { path: path.into(), reason }
    }
}

/// What makes an image, its layers or its metadata impossible to store.
#[derive(Debug, Error, PartialEq, Eq)]
pub enum ContentError {
    /// There is no pixel.
    #[error("an image of {width} × {height} pixels has nothing to store")]
    Empty {
        /// Its width.
        width: u32,
        /// Its height.
        height: u32,
    },
    /// The pixels do not fill the size.
    #[error("an image of {width} × {height} pixels holds {found} of them")]
    PixelCount {
        /// Its width.
        width: u32,
        /// Its height.
        height: u32,
        /// How many pixels it has.
        found: usize,
    },
    /// A layer is not of the image's size.
    #[error("the layer {name:?} is {width} × {height} with {found} values, the image {} × {}", expected.0, expected.1)]
    LayerSize {
        /// The layer.
        name: String,
        /// Its width.
        width: u32,
        /// Its height.
        height: u32,
        /// How many values each of its channels has.
        found: usize,
        /// Width and height of the image.
        expected: (u32, u32),
    },
    /// A layer's name is empty, holds a NUL or is longer than 200 bytes.
    #[error("the layer name {name:?} cannot name a channel")]
    LayerName {
        /// The name.
        name: String,
    },
    /// Two layers have the same name.
    #[error("two layers are called {name:?}")]
    LayerTwice {
        /// The name.
        name: String,
    },
    /// The metadata cannot be carried.
    #[error(transparent)]
    Metadata(#[from] MetadataError),
    /// The encoder refused.
    #[error("{0}")]
    Encoder(String),
}

/// Why a file was not read.
#[derive(Debug, Error)]
pub enum ReadError {
    /// The operating system refused.
    #[error("cannot read {}: {cause}", shown_path(path))]
    Io {
        /// The file asked for.
        path: PathBuf,
        /// What it said.
        cause: io::Error,
    },
    /// It is no file of its format, or a broken one.
    #[error("cannot read {} as {format}: {reason}", shown_path(path))]
    Malformed {
        /// The file asked for.
        path: PathBuf,
        /// What it should be: `EXR` or `PNG`.
        format: &'static str,
        /// What is wrong with it.
        reason: String,
    },
    /// Its pixels take more memory than may be used.
    #[error(
        "cannot read {}: its {width} × {height} pixels take up to {} MiB, {} MiB may be used", shown_path(path), takes >> 20, limit >> 20
    )]
    TooLarge {
        /// The file asked for.
        path: PathBuf,
        /// Its width in pixels.
        width: u64,
        /// Its height in pixels.
        height: u64,
        /// Bytes that reading it takes.
        takes: u64,
        /// Bytes that may be used.
        limit: u64,
    },
    /// No layer has the channels R, G and B, nor Y alone.
    #[error("cannot read {}: it has no channels R, G and B, only {channels}", shown_path(path))]
    NoRgb {
        /// The file asked for.
        path: PathBuf,
        /// The channels of its first layer, separated by commas.
        channels: String,
    },
}

impl ReadError {
    /// A file that is no EXR or PNG file as it should be. Libraries quote what they find: their words are cut and escaped.
    pub(crate) fn malformed(path: &Path, format: &'static str, reason: &str) -> Self {
        let mut reason = printable(reason).into_owned();
        if let Some((end, _)) = reason.char_indices().nth(MAX_REASON) {
            reason.truncate(end);
            reason.push('…');
        }
        Self::Malformed { path: path.into(), format, reason }
    }
}

/// The largest number of characters of a library's message about a file.
const MAX_REASON: usize = 160;
