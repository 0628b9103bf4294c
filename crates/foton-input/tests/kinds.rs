//! What is no file of data is refused by its kind, and nothing is read without end.
#![cfg(unix)]

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::atomic::{AtomicU32, Ordering};
use std::thread;

use foton_input::{Limit, Named, read_file};

/// A folder of its own for each test.
fn folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("foton-input-{name}-{}", std::process::id()));
    fs::create_dir_all(&folder).expect("a folder");
    folder
}

fn refusal(path: &Path, named: Named, limit: Limit) -> String {
    read_file(path, named, limit, &|| false).expect_err("refused").to_string()
}

fn pipe(path: &Path) {
    assert!(Command::new("mkfifo").arg(path).status().expect("mkfifo").success());
}

#[test]
fn what_is_no_file_is_refused_by_its_kind_and_never_waited_for() {
    let folder = folder("kinds");
    let (fifo, socket, link) = (folder.join("pipe"), folder.join("socket"), folder.join("link"));
    pipe(&fifo);
    let _socket = std::os::unix::net::UnixListener::bind(&socket).expect("a socket");
    std::os::unix::fs::symlink("/dev/zero", &link).expect("a link");
    for (path, said) in [
        (folder.as_path(), "it is a folder, not a file"),
        (&fifo, "it is a pipe: only a scene that is named on the command line may come from one"),
        (&socket, "it is a socket, not a file"),
        (Path::new("/dev/zero"), "it is a device, not a file"),
        (Path::new("/dev/null"), "it is a device, not a file"),
        (&link, "it is a device, not a file"),
    ] {
        // Where one is waited for all the same, that is given up.
        let asked = AtomicU32::new(0);
        let give_up = || asked.fetch_add(1, Ordering::Relaxed) >= 50;
        let refused = read_file(path, Named::ByFile, Limit::NONE, &give_up).expect_err("refused");
        assert_eq!(refused.to_string(), said, "{}", path.display());
    }
    assert_eq!(refusal(Path::new("/dev/zero"), Named::ByUser, Limit::NONE), "it is a device, not a file");
    let _ = fs::remove_dir_all(folder);
}

#[cfg(target_os = "linux")]
#[test]
fn files_of_the_kernel_are_none_of_data() {
    let said = "it is a file of the kernel, as in /proc or /sys, not one of data";
    for named in [Named::ByFile, Named::ByUser] {
        assert_eq!(refusal(Path::new("/proc/self/environ"), named, Limit::NONE), said);
        assert_eq!(refusal(Path::new("/proc/self/maps"), named, Limit::NONE), said);
    }
}

#[test]
fn no_more_is_read_than_may_be() {
    let folder = folder("sizes");
    let (path, fifo) = (folder.join("large"), folder.join("endless"));
    let limit = Limit::new(Some(8 << 20), 4);
    fs::File::create(&path).and_then(|file| file.set_len((2 << 20) + 1)).expect("a file");
    assert_eq!(refusal(&path, Named::ByFile, limit), "reading it takes up to 8 MiB, 8 MiB may be used");
    fs::File::create(&path).and_then(|file| file.set_len(2 << 20)).expect("a file");
    assert_eq!(read_file(&path, Named::ByFile, limit, &|| false).expect("read").len(), 2 << 20);
    // Small files are read whatever the limit.
    fs::write(&path, "small").expect("written");
    assert_eq!(read_file(&path, Named::ByFile, Limit::new(Some(1), 4), &|| false).expect("read"), b"small");
    pipe(&fifo);
    let writer = thread::spawn({
        let fifo = fifo.clone();
        move || {
            let mut file = fs::File::options().write(true).open(fifo).expect("a pipe");
            let mut written = 0;
            while file.write_all(&[b' '; 4096]).is_ok() {
                written += 4096;
            }
            written
        }
    });
    let said = refusal(&fifo, Named::ByUser, limit);
    assert_eq!(said, "reading it takes more than the 8 MiB that may be used");
    // A pipe holds some more than was taken from it.
    let written = writer.join().expect("the writer ends");
    assert!(written < 8 << 20, "{written} bytes were written");
    let _ = fs::remove_dir_all(folder);
}

#[test]
fn a_pipe_that_the_user_names_is_read_to_its_end() {
    let folder = folder("pipes");
    let fifo = folder.join("pipe");
    pipe(&fifo);
    let writer = thread::spawn({
        let fifo = fifo.clone();
        move || {
            let mut file = fs::File::options().write(true).open(fifo).expect("a pipe");
            for _ in 0..100 {
                file.write_all(&[7; 1000]).expect("written");
            }
        }
    });
    assert_eq!(read_file(&fifo, Named::ByUser, Limit::NONE, &|| false).expect("read"), vec![7; 100_000]);
    writer.join().expect("the writer ends");
    // Nobody writes, and whoever waits may give up.
    let asked = std::cell::Cell::new(0);
    let gives_up = || asked.replace(asked.get() + 1) >= 2;
    let error = read_file(&fifo, Named::ByUser, Limit::NONE, &gives_up).expect_err("given up");
    assert_eq!(error.kind(), std::io::ErrorKind::Interrupted);
    let _ = fs::remove_dir_all(folder);
}
