//! Files under names that the program chose: nothing is ever written over.

mod common;

use std::fs;
use std::path::Path;

use common::Folder;
use foton_film::{Image, Metadata, WriteError, atomic_write, write_exr, write_new};

fn text(path: &Path, text: &str) -> Result<(), WriteError> {
    write_new(path, |path| atomic_write(path, |file| std::io::Write::write_all(file, text.as_bytes())))
}

#[test]
fn a_name_is_given_once() {
    let folder = Folder::new("new-names");
    let path = folder.file("ring-001-p000016.exr");
    text(&path, "first").unwrap();
    let refused = text(&path, "second").unwrap_err();
    assert!(refused.is_taken() && refused.to_string().contains("ring-001-p000016.exr"), "{refused}");
    assert_eq!(fs::read_to_string(&path).unwrap(), "first");
    assert_eq!(folder.names(), ["ring-001-p000016.exr"], "nothing is left beside it");
}

#[test]
fn what_fails_leaves_nothing_and_names_the_file() {
    let folder = Folder::new("new-fails");
    let path = folder.file("out.exr");
    let refused = write_new(&path, |path| write_exr(path, &Image::black(0, 0), &[], &Metadata::default()));
    let refused = refused.unwrap_err();
    assert!(!refused.is_taken() && refused.to_string().contains("/out.exr: an image of 0"), "{refused}");
    assert!(folder.names().is_empty());
    let missing = text(&folder.file("nowhere/out.exr"), "").unwrap_err();
    assert!(matches!(missing, WriteError::NoFolder { .. }), "{missing}");
}

#[test]
fn of_writers_that_choose_one_name_one_gets_it() {
    let folder = Folder::new("new-race");
    let path = folder.file("out.txt");
    let got: Vec<bool> = std::thread::scope(|scope| {
        let writers: Vec<_> = (0..8)
            .map(|n| {
                let path = &path;
                scope.spawn(move || text(path, &n.to_string()).is_ok())
            })
            .collect();
        writers.into_iter().map(|writer| writer.join().unwrap()).collect()
    });
    assert_eq!(got.iter().filter(|got| **got).count(), 1);
    let winner = got.iter().position(|got| *got).unwrap();
    assert_eq!(fs::read_to_string(&path).unwrap(), winner.to_string());
    assert_eq!(folder.names(), ["out.txt"]);
}

#[test]
#[cfg(unix)]
fn a_link_to_nothing_is_somebodys_too() {
    let folder = Folder::new("new-link");
    let path = folder.file("out.txt");
    std::os::unix::fs::symlink("elsewhere", &path).unwrap();
    assert!(text(&path, "x").unwrap_err().is_taken());
    assert_eq!(folder.names(), ["out.txt"]);
}
