//! What is made beside a file while it is written, what it leads to, and what killed processes have left there.

#![cfg(unix)]

mod common;

use std::ffi::OsStr;
use std::fs::{self, File};
use std::io::{self, Read, Write};
use std::os::unix::ffi::OsStrExt;
use std::os::unix::fs::{MetadataExt, PermissionsExt, symlink};
use std::os::unix::net::UnixListener;
use std::path::Path;
use std::process::{self, Command};

use common::Folder;
use foton_film::{WriteError, atomic_write, check_writable, create_log, is_same_file, write_spare};

fn write(path: &Path, text: &str) -> Result<(), WriteError> {
    atomic_write(path, |file| file.write_all(text.as_bytes()))
}

fn mode(path: &Path) -> u32 {
    fs::metadata(path).unwrap().mode() & 0o7777
}

/// The number of a process that has ended.
fn dead_process() -> u32 {
    let mut child = Command::new("true").spawn().unwrap();
    child.wait().unwrap();
    child.id()
}

#[test]
fn temporary_names_cannot_be_guessed() {
    let folder = Folder::new("names");
    let path = folder.file("out.txt");
    let name = || {
        let mut names = Vec::new();
        atomic_write(&path, |_| {
            names = folder.names();
            Ok(())
        })
        .unwrap();
        names.remove(0)
    };
    let [a, b] = [name(), name()].map(|name| {
        let start = format!(".out.txt.tmp-{}-", process::id());
        let random = name.strip_prefix(&start).unwrap_or_else(|| panic!("{name}"));
        assert_eq!(random.len(), 16, "{name}");
        u64::from_str_radix(random, 16).unwrap()
    });
    assert!(a.abs_diff(b) > 1 << 20 && a > 1 << 20 && b > 1 << 20, "{a:x}, {b:x}");
}

#[test]
fn the_rights_and_the_owner_of_the_old_file_are_kept() {
    let folder = Folder::new("rights");
    let path = folder.file("out.txt");
    fs::write(&path, "old").unwrap();
    // Root may give files away; nobody else has any to be given back.
    let given = std::os::unix::fs::chown(&path, Some(1234), Some(4321)).is_ok();
    for rights in [0o600, 0o640, 0o604, 0o666, 0o755] {
        fs::set_permissions(&path, fs::Permissions::from_mode(rights)).unwrap();
        atomic_write(&path, |file| {
            let beside = file.get_ref().metadata()?.mode() & 0o777;
            assert_eq!(beside, rights, "nor is the file on the way open to more people");
            file.write_all(b"new")
        })
        .unwrap();
        assert_eq!(mode(&path), rights, "{rights:o}");
    }
    let found = fs::metadata(&path).unwrap();
    assert!(!given || (found.uid(), found.gid()) == (1234, 4321), "{found:?}");
    // A write takes these from a program, too.
    fs::set_permissions(&path, fs::Permissions::from_mode(0o6755)).unwrap();
    write(&path, "new").unwrap();
    assert_eq!(mode(&path), 0o755);
}

#[test]
fn new_files_have_the_rights_of_any_new_file() {
    let folder = Folder::new("new");
    fs::write(folder.file("plain.txt"), "").unwrap();
    write(&folder.file("out.txt"), "").unwrap();
    assert_eq!(mode(&folder.file("out.txt")), mode(&folder.file("plain.txt")));
}

#[test]
fn what_killed_processes_left_is_removed_and_nothing_else() {
    let folder = Folder::new("leftovers");
    let path = folder.file("out.txt");
    let (dead, parent) = (dead_process(), std::os::unix::process::parent_id());
    let leftovers = [
        format!(".out.txt.tmp-{dead}-0123456789abcdef"),
        // As earlier versions counted.
        format!(".out.txt.tmp-{dead}-0"),
        // No system has so many processes.
        ".out.txt.tmp-4294967295-0".to_owned(),
        // Of an earlier process with our number, as in a container that was started again.
        format!(".out.txt.tmp-{}-12", process::id()),
    ];
    let kept = [
        format!(".out.txt.tmp-{parent}-0"),
        ".out.txt.tmp-1-fedcba9876543210".to_owned(),
        format!(".other.txt.tmp-{dead}-0"),
        format!(".out.txt.tmp-{dead}-0.txt"),
        format!(".out.txt.tmp-{dead}-"),
        format!(".out.txt.tmp-{dead}"),
        ".out.txt.tmp-x-0".to_owned(),
        format!("out.txt.tmp-{dead}-0"),
    ];
    for name in leftovers.iter().chain(&kept) {
        fs::write(folder.file(name), "half").unwrap();
    }
    let (link, inner) = (format!(".out.txt.tmp-{dead}-1"), format!(".out.txt.tmp-{dead}-2"));
    fs::write(folder.file("precious"), "kept").unwrap();
    symlink("precious", folder.file(&link)).unwrap();
    fs::create_dir(folder.file(&inner)).unwrap();
    // Whoever writes it holds it, be its process in another container, where numbers are others.
    let held = format!(".out.txt.tmp-{dead}-3");
    let holder = File::create(folder.file(&held)).unwrap();
    holder.lock().unwrap();
    check_writable(&path).unwrap();
    assert!(folder.file(&leftovers[0]).exists(), "a look removes nothing");
    write(&path, "new").unwrap();
    let mut expected: Vec<String> = kept.into_iter().chain([link, inner, held.clone()]).collect();
    expected.extend(["out.txt", "precious"].map(str::to_owned));
    expected.sort();
    assert_eq!(folder.names(), expected);
    drop(holder);
    write(&path, "newer").unwrap();
    assert!(!folder.file(&held).exists(), "once let go it is a leftover");
}

#[test]
fn leftovers_beside_the_end_of_a_link_are_removed_there() {
    let folder = Folder::new("leftovers-link");
    fs::create_dir(folder.file("sub")).unwrap();
    fs::write(folder.file("sub/real.txt"), "old").unwrap();
    symlink("sub/real.txt", folder.file("out.txt")).unwrap();
    let left = format!("sub/.real.txt.tmp-{}-7", dead_process());
    fs::write(folder.file(&left), "half").unwrap();
    write(&folder.file("out.txt"), "new").unwrap();
    assert!(!folder.file(&left).exists());
    assert_eq!(fs::read_to_string(folder.file("sub/real.txt")).unwrap(), "new");
}

#[test]
fn links_to_what_is_not_there_yet_are_followed() {
    let folder = Folder::new("dangling");
    fs::create_dir(folder.file("sub")).unwrap();
    symlink("sub/relative.txt", folder.file("relative")).unwrap();
    symlink(folder.file("sub/absolute.txt"), folder.file("absolute")).unwrap();
    // A relative target counts from where its own link is.
    symlink("../chain.txt", folder.file("sub/second")).unwrap();
    symlink("sub/second", folder.file("chain")).unwrap();
    for (link, target) in
        [("relative", "sub/relative.txt"), ("absolute", "sub/absolute.txt"), ("chain", "chain.txt")]
    {
        check_writable(&folder.file(link)).unwrap();
        assert!(!folder.file(target).exists(), "{link}: a look makes nothing");
        write(&folder.file(link), link).unwrap();
        assert!(fs::symlink_metadata(folder.file(link)).unwrap().is_symlink(), "{link}");
        assert_eq!(fs::read_to_string(folder.file(target)).unwrap(), link);
    }
}

#[test]
fn links_to_themselves_and_into_folders_that_are_not_there_are_named() {
    let folder = Folder::new("loops");
    symlink("b", folder.file("a")).unwrap();
    symlink("a", folder.file("b")).unwrap();
    symlink("no/out.txt", folder.file("lost")).unwrap();
    symlink("..", folder.file("up")).unwrap();
    let name = |name: &str| folder.file(name).display().to_string();
    for (link, said) in [
        ("a", format!("cannot write {}: Too many levels of symbolic links", name("a"))),
        ("lost", format!("cannot write {}: the folder {} does not exist", name("lost"), name("no"))),
        ("up", format!("cannot write {}: is a directory", name("up"))),
    ] {
        for outcome in [check_writable(&folder.file(link)), write(&folder.file(link), "")] {
            let found = outcome.unwrap_err().to_string();
            assert!(found.starts_with(&said), "{found}");
        }
    }
    assert_eq!(folder.names(), ["a", "b", "lost", "up"]);
}

#[test]
fn names_of_any_length_and_any_bytes_are_written() {
    let folder = Folder::new("long");
    let long = "n".repeat(251) + ".txt";
    for name in [OsStr::new(&long), OsStr::from_bytes(b"\xff\xfe.txt"), OsStr::from_bytes(&[0xe4; 255])] {
        let path = folder.path().join(name);
        check_writable(&path).unwrap();
        let mut beside = Vec::new();
        atomic_write(&path, |file| {
            beside = folder.names();
            file.write_all(b"new")
        })
        .unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"new");
        fs::remove_file(&path).unwrap();
        // What is left of it is found again.
        let [left] = &beside[..] else { panic!("{beside:?}") };
        if !left.contains('\u{fffd}') {
            let left = left.replace(&format!("-{}-", process::id()), &format!("-{}-", dead_process()));
            fs::write(folder.file(&left), "half").unwrap();
            write(&path, "newer").unwrap();
            fs::remove_file(&path).unwrap();
        }
        assert_eq!(folder.names(), [""; 0]);
    }
}

#[test]
fn sockets_are_refused_and_pipes_without_a_reader_do_not_wait() {
    let folder = Folder::new("special");
    let socket = folder.file("socket");
    let _listener = UnixListener::bind(&socket).unwrap();
    for outcome in [check_writable(&socket), write(&socket, "")] {
        let said = outcome.unwrap_err().to_string();
        assert_eq!(said, format!("cannot write {}: it is a socket", socket.display()));
    }
    let pipe = folder.file("pipe");
    assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    check_writable(&pipe).unwrap();
    let said = write(&pipe, "").unwrap_err().to_string();
    assert_eq!(said, format!("cannot write {}: it is a pipe that no program reads", pipe.display()));
    // More than a pipe holds, to a reader that comes late to it.
    let text = "a long text ".repeat(100_000);
    std::thread::scope(|scope| {
        let reader = scope.spawn(|| {
            let mut read = String::new();
            File::open(&pipe).and_then(|mut file| file.read_to_string(&mut read)).map(|_| read)
        });
        let mut outcome = write(&pipe, &text);
        while outcome.is_err() {
            std::thread::yield_now();
            outcome = write(&pipe, &text);
        }
        assert!(reader.join().unwrap().unwrap() == text);
    });
}

#[test]
fn files_in_a_folder_that_cannot_be_listed_are_written() {
    let folder = Folder::new("unlisted");
    let inner = folder.file("inner");
    fs::create_dir(&inner).unwrap();
    fs::set_permissions(&inner, fs::Permissions::from_mode(0o300)).unwrap();
    for text in ["old", "new"] {
        check_writable(&inner.join("out.txt")).unwrap();
        write(&inner.join("out.txt"), text).unwrap();
        assert_eq!(fs::read_to_string(inner.join("out.txt")).unwrap(), text);
    }
    fs::set_permissions(&inner, fs::Permissions::from_mode(0o700)).unwrap();
}

#[test]
fn paths_that_lead_to_one_file_are_the_same() {
    let folder = Folder::new("same");
    let file = |name: &str| folder.file(name);
    fs::create_dir(file("sub")).unwrap();
    for name in ["a", "b"] {
        fs::write(file(name), "equal content").unwrap();
    }
    symlink("a", file("link")).unwrap();
    symlink(file("link"), file("link-to-link")).unwrap();
    fs::hard_link(file("a"), file("hard")).unwrap();
    symlink("new", file("dangling")).unwrap();
    symlink("sub", file("door")).unwrap();
    for (one, other) in [
        ("a", "a"),
        ("a", "sub/../a"),
        ("a", "link-to-link"),
        ("link", "link-to-link"),
        ("hard", "link"),
        ("new", "new"),
        ("new", "sub/../new"),
        ("new", "dangling"),
        ("sub/new", "door/new"),
    ] {
        assert!(is_same_file(&file(one), &file(other)), "{one} and {other}");
        assert!(is_same_file(&file(other), &file(one)), "{other} and {one}");
    }
    for (one, other) in [("a", "b"), ("a", "new"), ("new", "newer"), ("new", "sub/new"), ("dangling", "a")] {
        assert!(!is_same_file(&file(one), &file(other)), "{one} and {other}");
    }
    let null = Path::new("/dev/null");
    assert!(!is_same_file(null, null), "what goes nowhere loses nothing");
}

#[test]
fn a_failed_write_leaves_the_old_file_with_its_rights() {
    let folder = Folder::new("left");
    let path = folder.file("out.txt");
    fs::write(&path, "old").unwrap();
    fs::set_permissions(&path, fs::Permissions::from_mode(0o640)).unwrap();
    let outcome = atomic_write(&path, |file| {
        file.write_all(b"half")?;
        Err(io::ErrorKind::StorageFull.into())
    });
    assert!(outcome.is_err());
    assert_eq!((folder.names(), mode(&path)), (vec!["out.txt".to_owned()], 0o640));
    assert_eq!(fs::read_to_string(&path).unwrap(), "old");
}

#[test]
fn what_has_no_place_goes_beside_under_a_name_that_nobody_has() {
    let folder = Folder::new("spare");
    fs::write(folder.file("foton-x-001.exr"), "another's").unwrap();
    // A link that somebody has put in the way.
    symlink("victim", folder.file("foton-x-002.exr")).unwrap();
    let spare = write_spare(&folder.file("x.exr"), |path| write(path, "rescued")).unwrap();
    assert_eq!(spare, folder.file("foton-x-003.exr"));
    assert_eq!(fs::read_to_string(&spare).unwrap(), "rescued");
    assert_eq!(folder.names(), ["foton-x-001.exr", "foton-x-002.exr", "foton-x-003.exr"]);
    // Where the folder is not there any more, among the temporary files; the test's own go.
    let gone = folder.file("gone").join(format!("{}.exr", process::id()));
    let spare = write_spare(&gone, |path| write(path, "rescued")).unwrap();
    assert_eq!(spare.parent(), Some(&*std::env::temp_dir()));
    fs::remove_file(&spare).unwrap();
    // Of what fails nothing is left.
    let none = write_spare(&gone, |path| atomic_write(path, |_| Err(io::ErrorKind::StorageFull.into())));
    assert_eq!(none, None);
    assert!(!spare.exists());
}

#[test]
fn a_log_replaces_only_logs() {
    let folder = Folder::new("log");
    fs::write(folder.file("scene.xml"), "<scene/>").unwrap();
    symlink("scene.xml", folder.file("link.log")).unwrap();
    for name in ["scene.xml", "link.log"] {
        let said = create_log(&folder.file(name), "{\"event\":").unwrap_err().to_string();
        let path = folder.file(name).display().to_string();
        assert_eq!(said, format!("cannot write {path}: it is another kind of file, which would be lost"));
    }
    assert_eq!(fs::read_to_string(folder.file("scene.xml")).unwrap(), "<scene/>");
    symlink("new.log", folder.file("dangling.log")).unwrap();
    for (name, target) in [("a.log", "a.log"), ("a.log", "a.log"), ("dangling.log", "new.log")] {
        let mut log = create_log(&folder.file(name), "{\"event\":").unwrap();
        log.write_all(b"{\"event\":1}\n").unwrap();
        assert_eq!(fs::read_to_string(folder.file(target)).unwrap(), "{\"event\":1}\n", "{name}");
    }
    let pipe = folder.file("pipe.log");
    assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let said = create_log(&pipe, "").unwrap_err().to_string();
    assert!(said.contains("it is a pipe that no program reads"), "{said}");
    assert!(create_log(Path::new("/dev/null"), "{").is_ok());
}
