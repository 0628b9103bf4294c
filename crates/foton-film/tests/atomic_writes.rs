//! Writing whole files: a failure leaves the old file and nothing else.

mod common;

use std::fs;
use std::io::{self, Write};
use std::panic::{AssertUnwindSafe, catch_unwind};

use common::Folder;
use foton_film::{Image, Metadata, WriteError, atomic_write, write_exr};

#[test]
fn a_write_replaces_the_old_file_and_leaves_nothing_else() {
    let folder = Folder::new("replace");
    let path = folder.file("out.txt");
    for text in ["old", "new and longer", ""] {
        atomic_write(&path, |file| file.write_all(text.as_bytes())).unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), text);
    }
    assert_eq!(folder.names(), ["out.txt"]);
}

#[test]
fn while_it_is_written_the_old_file_is_still_there() {
    let folder = Folder::new("during");
    let path = folder.file("out.txt");
    fs::write(&path, "old").unwrap();
    atomic_write(&path, |file| {
        file.write_all(b"new")?;
        file.flush()?;
        assert_eq!(fs::read_to_string(&path)?, "old");
        let temp = format!(".out.txt.tmp-{}", std::process::id());
        assert!(folder.names()[0].starts_with(&temp), "{:?}", folder.names());
        Ok(())
    })
    .unwrap();
    assert_eq!(fs::read_to_string(&path).unwrap(), "new");
}

#[test]
fn a_failed_write_leaves_the_old_file_and_no_temporary_one() {
    let folder = Folder::new("failed");
    let path = folder.file("out.txt");
    fs::write(&path, "old").unwrap();
    let error = atomic_write(&path, |file| {
        file.write_all(b"half of the new")?;
        Err(io::Error::other("the disk is full"))
    })
    .unwrap_err();
    assert_eq!(error.to_string(), format!("cannot write {}: the disk is full", path.display()));
    let panicked = catch_unwind(AssertUnwindSafe(|| atomic_write(&path, |_| panic!("in the middle"))));
    assert!(panicked.is_err());
    assert_eq!(fs::read_to_string(&path).unwrap(), "old");
    assert_eq!(folder.names(), ["out.txt"]);
}

#[test]
fn a_missing_folder_is_named() {
    let folder = Folder::new("missing");
    let path = folder.file("no").join("out.exr");
    let error = write_exr(&path, &Image::black(1, 1), &[], &Metadata::default()).unwrap_err();
    let folder = folder.file("no");
    let expected = format!("cannot write {}: the folder {} does not exist", path.display(), folder.display());
    assert_eq!(error.to_string(), expected);
}

#[test]
fn a_folder_is_not_replaced_by_a_file() {
    let folder = Folder::new("folder");
    let error = atomic_write(folder.path(), |_| Ok(())).unwrap_err();
    assert!(matches!(error, WriteError::Io { .. }), "{error}");
    assert!(folder.path().is_dir());
}

#[test]
fn a_read_only_file_is_kept() {
    let folder = Folder::new("read-only");
    let path = folder.file("out.txt");
    fs::write(&path, "old").unwrap();
    let mut permissions = fs::metadata(&path).unwrap().permissions();
    permissions.set_readonly(true);
    fs::set_permissions(&path, permissions).unwrap();
    let error = atomic_write(&path, |file| file.write_all(b"new")).unwrap_err();
    assert!(matches!(error, WriteError::ReadOnly { .. }), "{error}");
    assert_eq!(fs::read_to_string(&path).unwrap(), "old");
}

#[test]
fn threads_that_write_one_file_leave_one_whole_file() {
    let folder = Folder::new("threads");
    let path = folder.file("out.txt");
    std::thread::scope(|scope| {
        for i in 0..8u8 {
            let path = &path;
            scope.spawn(move || atomic_write(path, |file| file.write_all(&[i; 100_000])).unwrap());
        }
    });
    let bytes = fs::read(&path).unwrap();
    assert!(bytes.len() == 100_000 && bytes.iter().all(|b| *b == bytes[0]));
    assert_eq!(folder.names(), ["out.txt"]);
}

#[cfg(unix)]
#[test]
fn links_are_followed() {
    let folder = Folder::new("links");
    let (path, link) = (folder.file("out.txt"), folder.file("link.txt"));
    fs::write(&path, "old").unwrap();
    std::os::unix::fs::symlink("out.txt", &link).unwrap();
    atomic_write(&link, |file| file.write_all(b"new")).unwrap();
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    assert_eq!(fs::read_to_string(&path).unwrap(), "new");
}

#[cfg(target_os = "linux")]
#[test]
fn a_pipe_is_written_and_not_replaced() {
    use std::os::fd::AsRawFd;
    let (mut reader, writer) = io::pipe().unwrap();
    let path = format!("/proc/self/fd/{}", writer.as_raw_fd());
    atomic_write(path.as_ref(), |file| file.write_all(b"through")).unwrap();
    drop(writer);
    assert_eq!(io::read_to_string(&mut reader).unwrap(), "through");
}
