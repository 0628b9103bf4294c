//! Opening a file by its kind, and reading no more of it than may be.
//!
//! What is no file of data is refused: a device may never end, and opening one may do something; a pipe waits for whoever
//! writes; files of the kernel, such as those of `/proc`, tell of the system and not of a scene. The kind is checked before the
//! file is opened and on the open handle again, since the name may stand for something else by then. Reading is bounded even
//! where the size is not known before.

use std::fs::{File, FileType, Metadata};
use std::io::{self, Read};
use std::path::Path;

use thiserror::Error;

/// A file up to this size is never refused by it.
const SMALL: u64 = 1 << 20;

/// Who names a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Named {
    /// The user, on the command line: a pipe is as good as a file (`foton render <(generate)`, `/dev/stdin`).
    ByUser,
    /// Another file, whoever wrote that: plain files alone.
    ByFile,
}

/// How much memory reading a file may take.
#[derive(Clone, Copy, Debug)]
pub struct Limit {
    memory: u64,
    per_byte: u64,
}

impl Limit {
    /// As much as there is.
    pub const NONE: Self = Self { memory: u64::MAX, per_byte: 1 };

    /// `memory` bytes, if that is known, where reading takes `per_byte` bytes for each of the file. Files of up to 1 MiB are read in any case.
    #[must_use]
    pub fn new(memory: Option<u64>, per_byte: u64) -> Self {
        memory.map_or(Self::NONE, |memory| Self { memory, per_byte: per_byte.max(1) })
    }

    /// The size of the largest file.
    fn max_bytes(self) -> u64 {
        (self.memory / self.per_byte).max(SMALL)
    }

    fn too_large(self, bytes: Option<u64>) -> io::Error {
        io::Error::other(Refusal::TooLarge {
            takes: bytes.map(|bytes| bytes.saturating_mul(self.per_byte)),
            limit: self.memory,
        })
    }
}

/// Why a file is not read although it is there; inside the [`io::Error`] of [`read_file`].
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
pub enum Refusal {
    /// It is a folder.
    #[error("it is a folder, not a file")]
    Folder,
    /// It is a device.
    #[error("it is a device, not a file")]
    Device,
    /// It is a socket.
    #[error("it is a socket, not a file")]
    Socket,
    /// It is a pipe, which only a user may name.
    #[error("it is a pipe: only a scene that is named on the command line may come from one")]
    Pipe,
    /// It is a file of the kernel.
    #[error("it is a file of the kernel, as in /proc or /sys, not one of data")]
    Kernel,
    /// Reading it takes too much memory.
    #[error("{}", too_large(*takes, *limit))]
    TooLarge {
        /// Bytes that reading it takes at most; `None`: its size is not known, and what was read is too much already.
        takes: Option<u64>,
        /// Bytes that may be used.
        limit: u64,
    },
}

fn too_large(takes: Option<u64>, limit: u64) -> String {
    let limit = limit >> 20;
    takes.map_or_else(
        || format!("reading it takes more than the {limit} MiB that may be used"),
        |takes| format!("reading it takes up to {} MiB, {limit} MiB may be used", takes >> 20),
    )
}

/// Reads a file. Where it is a pipe that the user named, `gives_up` is called about twenty times a second and says whether to stop waiting.
///
/// # Errors
/// What the system says, or a [`Refusal`] by kind or size.
pub fn read_file(
    path: &Path,
    named: Named,
    limit: Limit,
    gives_up: &dyn Fn() -> bool,
) -> io::Result<Vec<u8>> {
    refuse_kind(std::fs::metadata(path)?.file_type(), named)?;
    let file = open(path)?;
    let metadata = file.metadata()?;
    refuse_kind(metadata.file_type(), named)?;
    if metadata.is_file() { read_plain(&file, &metadata, limit) } else { read_pipe(file, limit, gives_up) }
}

fn refuse_kind(kind: FileType, named: Named) -> io::Result<()> {
    let refusal = match () {
        () if kind.is_file() => return Ok(()),
        () if kind.is_dir() => Refusal::Folder,
        () if is_pipe(kind) && named == Named::ByUser => return Ok(()),
        () if is_pipe(kind) => Refusal::Pipe,
        () if is_socket(kind) => Refusal::Socket,
        () => Refusal::Device,
    };
    Err(io::Error::other(refusal))
}

fn read_plain(file: &File, metadata: &Metadata, limit: Limit) -> io::Result<Vec<u8>> {
    if is_of_kernel(file) {
        return Err(io::Error::other(Refusal::Kernel));
    }
    if metadata.len() > limit.max_bytes() {
        return Err(limit.too_large(Some(metadata.len())));
    }
    let mut bytes = Vec::new();
    // One more, so that the end of the file is met without growing.
    let length = usize::try_from(metadata.len()).ok().and_then(|length| length.checked_add(1));
    length.and_then(|length| bytes.try_reserve_exact(length).ok()).ok_or(io::ErrorKind::OutOfMemory)?;
    read_within(file, &mut bytes, limit)?;
    Ok(bytes)
}

/// Reads to the end: a file may grow meanwhile, and some do not say how long they are.
fn read_within(source: impl Read, bytes: &mut Vec<u8>, limit: Limit) -> io::Result<()> {
    let max = limit.max_bytes();
    source.take(max.saturating_add(1)).read_to_end(bytes)?;
    if bytes.len() as u64 > max { Err(limit.too_large(None)) } else { Ok(()) }
}

#[cfg(unix)]
fn open(path: &Path) -> io::Result<File> {
    use std::os::unix::fs::OpenOptionsExt;
    // Whatever took the file's place since it was looked at: opening waits for nobody, and no terminal becomes ours.
    let flags = rustix::fs::OFlags::NONBLOCK | rustix::fs::OFlags::NOCTTY;
    File::options().read(true).custom_flags(flags.bits().cast_signed()).open(path)
}

#[cfg(not(unix))]
fn open(path: &Path) -> io::Result<File> {
    File::open(path)
}

#[cfg(unix)]
fn is_pipe(kind: FileType) -> bool {
    use std::os::unix::fs::FileTypeExt;
    kind.is_fifo()
}

#[cfg(not(unix))]
fn is_pipe(_: FileType) -> bool {
    false
}

#[cfg(unix)]
fn is_socket(kind: FileType) -> bool {
    use std::os::unix::fs::FileTypeExt;
    kind.is_socket()
}

#[cfg(not(unix))]
fn is_socket(_: FileType) -> bool {
    false
}

/// Whether a file lies where the kernel makes files up: `proc`, `sysfs`, `debugfs`, `tracefs`, `securityfs` and control groups.
#[cfg(target_os = "linux")]
fn is_of_kernel(file: &File) -> bool {
    /// The numbers of those in `linux/magic.h`.
    const KERNEL: [i64; 7] =
        [0x9fa0, 0x6265_6572, 0x6462_6720, 0x7472_6163, 0x7363_6673, 0x0027_e0eb, 0x6367_7270];
    // The width of the number depends on the machine.
    rustix::fs::fstatfs(file)
        .is_ok_and(|system| KERNEL.iter().any(|&kind| i128::from(system.f_type) == i128::from(kind)))
}

#[cfg(not(target_os = "linux"))]
fn is_of_kernel(_: &File) -> bool {
    false
}

/// Reads a pipe, which was opened so that reading does not wait: whoever waits here can be interrupted.
#[cfg(unix)]
fn read_pipe(mut file: File, limit: Limit, gives_up: &dyn Fn() -> bool) -> io::Result<Vec<u8>> {
    use rustix::event::{PollFd, PollFlags, Timespec, poll};
    const PATIENCE: Timespec = Timespec { tv_sec: 0, tv_nsec: 50_000_000 };
    let mut bytes = Vec::new();
    let mut buffer = vec![0; 1 << 16];
    loop {
        if gives_up() {
            return Err(io::ErrorKind::Interrupted.into());
        }
        // Without a writer yet there is nothing to poll; once the last has gone, reading says so.
        match poll(&mut [PollFd::new(&file, PollFlags::IN)], Some(&PATIENCE)) {
            Ok(0) | Err(rustix::io::Errno::INTR) => continue,
            Ok(_) => {}
            Err(error) => return Err(error.into()),
        }
        match file.read(&mut buffer) {
            Ok(0) => return Ok(bytes),
            Ok(length) if (bytes.len() + length) as u64 > limit.max_bytes() => {
                return Err(limit.too_large(None));
            }
            Ok(length) => bytes.extend_from_slice(&buffer[..length]),
            Err(error) if matches!(error.kind(), io::ErrorKind::WouldBlock | io::ErrorKind::Interrupted) => {}
            Err(error) => return Err(error),
        }
    }
}

#[cfg(not(unix))]
fn read_pipe(file: File, limit: Limit, _: &dyn Fn() -> bool) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    read_within(file, &mut bytes, limit)?;
    Ok(bytes)
}
