//! Where the bytes of a file go: links followed, and what must not be replaced told apart.

use std::fs::{self, File, Metadata};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use crate::WriteError;

/// Links on the way to one file, as many as Linux follows.
const MAX_LINKS: usize = 40;

/// Where the bytes go.
pub(super) enum Target {
    /// A plain file, with links followed; without `old` it does not exist yet.
    File {
        /// Its path.
        target: PathBuf,
        /// What is there now.
        old: Option<Metadata>,
    },
    /// Something that must not be replaced.
    Stream(Stream),
}

impl Target {
    pub(super) fn of(path: &Path) -> Result<Self, WriteError> {
        let to_error = WriteError::io(path);
        match fs::metadata(path) {
            Ok(found) if found.is_dir() => Err(to_error(ErrorKind::IsADirectory.into())),
            Ok(found) if !found.is_file() => Stream::of(&found)
                .map(Self::Stream)
                .map_err(|what| WriteError::Special { path: path.into(), what }),
            Ok(found) if found.permissions().readonly() => Err(WriteError::ReadOnly { path: path.into() }),
            Ok(found) => {
                let target = fs::canonicalize(path).map_err(to_error)?;
                Ok(Self::File { target, old: Some(found) })
            }
            Err(cause) if cause.kind() == ErrorKind::NotFound => {
                let target = end_of_links(path).map_err(to_error)?;
                let folder = folder_of(&target);
                if folder.is_dir() {
                    Ok(Self::File { target, old: None })
                } else {
                    Err(WriteError::NoFolder { path: path.into(), folder: folder.into() })
                }
            }
            Err(cause) => Err(to_error(cause)),
        }
    }
}

/// What is written in place.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Stream {
    /// A character device.
    Device,
    /// A pipe with a name.
    #[cfg_attr(not(unix), allow(dead_code, reason = "there are none in folders"))]
    Pipe,
}

impl Stream {
    /// What a thing that is neither file nor folder is; the name of what nothing can be written to.
    #[cfg(unix)]
    fn of(found: &Metadata) -> Result<Self, &'static str> {
        use std::os::unix::fs::FileTypeExt;
        let kind = found.file_type();
        if kind.is_fifo() {
            Ok(Self::Pipe)
        } else if kind.is_char_device() {
            Ok(Self::Device)
        } else if kind.is_block_device() {
            Err("a whole disk (a block device)")
        } else {
            Err("a socket")
        }
    }

    #[cfg(not(unix))]
    fn of(_: &Metadata) -> Result<Self, &'static str> {
        Ok(Self::Device)
    }

    /// Opens it to write. Opening a pipe without a reader would wait for one, for ever and in silence; it is an error.
    pub(super) fn open(self, path: &Path) -> io::Result<File> {
        #[cfg(unix)]
        let _holds_the_reader = (self == Self::Pipe).then(|| without_waiting(path)).transpose()?;
        File::options().write(true).open(path)
    }
}

#[cfg(unix)]
fn without_waiting(path: &Path) -> io::Result<File> {
    use rustix::fs::OFlags;
    use std::os::unix::fs::OpenOptionsExt;
    let flags = OFlags::NONBLOCK.bits().cast_signed();
    File::options().write(true).custom_flags(flags).open(path).map_err(|cause| {
        if cause.raw_os_error() == Some(rustix::io::Errno::NXIO.raw_os_error()) {
            return io::Error::other("it is a pipe that no program reads");
        }
        cause
    })
}

/// The folder of a file; the current one when the path names none.
pub(super) fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Where links lead to that end in nothing.
fn end_of_links(path: &Path) -> io::Result<PathBuf> {
    let mut path = path.to_owned();
    for _ in 0..MAX_LINKS {
        if !fs::symlink_metadata(&path).is_ok_and(|found| found.is_symlink()) {
            return Ok(path);
        }
        path = path.with_file_name(fs::read_link(&path)?);
    }
    Err(io::Error::other("too many links, one to another"))
}

/// Whether a file that was made beside `target` could be renamed over it, although it could be made: in a folder like `/tmp` only
/// the owners of a file and of the folder may replace it, and a file that a container was given by itself is nobody's to replace.
#[cfg(unix)]
pub(super) fn check_replaceable(beside: &File, target: &Path, old: &Metadata) -> io::Result<()> {
    use std::os::unix::fs::MetadataExt;
    const STICKY: u32 = 0o1000;
    if is_mounted(target) {
        return Err(io::Error::other(
            "it is mounted by itself and cannot be replaced; mount its folder instead",
        ));
    }
    let (us, folder) = (beside.metadata()?.uid(), fs::metadata(folder_of(target))?);
    if us == 0 || folder.mode() & STICKY == 0 || [old.uid(), folder.uid()].contains(&us) {
        return Ok(());
    }
    Err(io::Error::new(ErrorKind::PermissionDenied, "in its folder only its owner may replace it"))
}

#[cfg(not(unix))]
pub(super) fn check_replaceable(_: &File, _: &Path, _: &Metadata) -> io::Result<()> {
    Ok(())
}

/// Whether something is mounted on a file; only Linux is asked.
#[cfg(unix)]
fn is_mounted(file: &Path) -> bool {
    #[cfg(target_os = "linux")]
    {
        use rustix::fs::{AtFlags, CWD, StatxAttributes, StatxFlags, statx};
        let found = statx(CWD, file, AtFlags::empty(), StatxFlags::empty());
        found.is_ok_and(|found| found.stx_attributes.contains(StatxAttributes::MOUNT_ROOT))
    }
    #[cfg(not(target_os = "linux"))]
    {
        let _ = file;
        false
    }
}

/// Whether writing one path would be writing the other: both lead to one file, by links of either kind, or to one that is still to be
/// made. Character devices are never the same, for nothing is lost when two things go to `/dev/null`.
#[must_use]
pub fn is_same_file(a: &Path, b: &Path) -> bool {
    match (fs::metadata(a), fs::metadata(b)) {
        (Ok(found_a), Ok(found_b)) => {
            (found_a.is_file() || found_a.is_dir() || matches!(Stream::of(&found_a), Ok(Stream::Pipe)))
                && is_same((a, &found_a), (b, &found_b))
        }
        (Err(_), Err(_)) => match (end_of_links(a), end_of_links(b)) {
            (Ok(a), Ok(b)) => {
                let folders = [&a, &b].map(|path| folder_of(path).to_owned());
                let names = [&a, &b].map(|path| path.file_name().map(plain));
                names[0].is_some()
                    && names[0] == names[1]
                    && (a == b || is_same_file(&folders[0], &folders[1]))
            }
            _ => false,
        },
        _ => false,
    }
}

/// Whether an open file, such as a standard stream that was redirected, is the one of a path. Only plain files are.
#[must_use]
pub fn stands_for(open: &File, path: &Path) -> bool {
    match (open.metadata(), fs::metadata(path)) {
        (Ok(open), Ok(found)) if open.is_file() => is_same_inode(&open, &found).unwrap_or(false),
        _ => false,
    }
}

fn is_same((a, found_a): (&Path, &Metadata), (b, found_b): (&Path, &Metadata)) -> bool {
    let by_name = || fs::canonicalize(a).is_ok_and(|a| fs::canonicalize(b).is_ok_and(|b| a == b));
    is_same_inode(found_a, found_b).unwrap_or_else(by_name)
}

/// Whether two files are one; `None` where the system does not number them.
fn is_same_inode(a: &Metadata, b: &Metadata) -> Option<bool> {
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt;
        Some((a.dev(), a.ino()) == (b.dev(), b.ino()))
    }
    #[cfg(not(unix))]
    {
        let _ = (a, b);
        None
    }
}

/// A file's name as the system compares names.
fn plain(name: &std::ffi::OsStr) -> std::ffi::OsString {
    if cfg!(any(windows, target_vendor = "apple")) {
        return name.to_string_lossy().to_lowercase().into();
    }
    name.to_owned()
}
