//! Where files go: links, special files, names of any kind, folders of others; what they are then, and what is there beside them.
//!
//! Permissions and special files are those of Linux.

use std::os::unix::fs::symlink;

use super::write_faults::{RENDER, of_kind};
use super::*;

/// Whatever is there: a link to what is not there yet, itself, a socket, a pipe.
#[test]
fn links_and_special_files_are_followed_or_refused_before_rendering() {
    let folder = Folder::new("special");
    fs::create_dir(folder.file("sub")).expect("a folder");
    for (target, link) in [
        ("sub/relative.exr", "relative.exr"),
        (folder.file("absolute-target.exr").to_str().expect("text"), "absolute.exr"),
        ("relative.exr", "chain.exr"),
        ("loop-b.exr", "loop-a.exr"),
        ("loop-a.exr", "loop-b.exr"),
        ("no/lost.exr", "lost.exr"),
        ("socket", "socket.exr"),
    ] {
        symlink(target, folder.file(link)).expect("a link");
    }
    let _listener = std::os::unix::net::UnixListener::bind(folder.file("socket")).expect("a socket");
    for (name, made) in [
        ("chain.exr", "sub/relative.exr"),
        ("relative.exr", "sub/relative.exr"),
        ("absolute.exr", "absolute-target.exr"),
    ] {
        folder.done(&format!("{RENDER} --passes 1 -o {name}"));
        assert!(fs::symlink_metadata(folder.file(name)).expect("there").is_symlink(), "{name}");
        assert!(folder.exr(made).0.width > 0, "{name}");
    }
    for (name, said) in [
        ("loop-a.exr", "cannot write loop-a.exr: Too many levels of symbolic links (os error 40)"),
        ("lost.exr", "cannot write lost.exr: the folder no does not exist"),
        ("socket.exr", "cannot write socket.exr: it is a socket"),
    ] {
        for arguments in [format!("-o {name}"), format!("-o x.exr --checkpoint {name}")] {
            let output = folder.run(&format!("{RENDER} --passes 1 {arguments}"));
            let events = events(&output.stdout);
            assert_eq!(output.status.code(), Some(1), "{arguments}");
            assert_eq!((events.len(), &*of_kind(&events, "error")[0]), (1, said), "no pass was rendered");
        }
    }
    // A pipe that nobody reads is an error at the end, and no wait without one.
    assert!(Command::new("mkfifo").arg(folder.file("pipe.exr")).status().expect("mkfifo").success());
    let said = folder.fails(1, "render scene.xml --photons 500 --passes 1 -o pipe.exr");
    assert!(said.contains("cannot write pipe.exr: it is a pipe that no program reads"), "{said}");
    assert!(folder.exr("foton-pipe-001.exr").0.width > 0);
    assert!(!folder.file("x.exr").exists());
}

/// Names as long as the system takes them, and such as are not text.
#[test]
fn names_of_any_length_and_any_bytes_are_written() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    let folder = Folder::new("names");
    let (long, odd) = (format!("{}.exr", "n".repeat(251)), OsStr::from_bytes(b"\xff\xfe.exr"));
    let run = |names: &[&OsStr], more: &str| {
        let mut command = folder.command("render scene.xml --photons 500 --passes 2");
        for (option, name) in ["-o", "--checkpoint"].iter().zip(names) {
            command.arg(option).arg(name);
        }
        let output = command.args(more.split_whitespace()).output().expect("the program starts");
        (output.status.code(), text(&output.stderr))
    };
    let ck = OsStr::from_bytes(b"\xfe.ck");
    assert_eq!(run(&[OsStr::new(&long)], "").0, Some(0));
    assert_eq!(run(&[odd, ck], "--every 1").0, Some(0));
    assert!(read_exr(&folder.0.join(odd)).is_ok() && folder.0.join(ck).exists());
    assert!(read_exr(&folder.0.join(OsStr::from_bytes(b"\xff\xfe-000001.exr"))).is_ok());
    // No image on the way would have such a name: that is known before the first.
    fs::remove_file(folder.file(&long)).expect("ours");
    let (code, said) = run(&[OsStr::new(&long)], "--every 1");
    assert!(code == Some(1) && said.contains("File name too long"), "{said}");
    assert!(!folder.file(&long).exists());
}

#[test]
fn new_files_have_the_rights_that_the_umask_leaves_and_old_ones_keep_theirs() {
    use std::os::unix::fs::PermissionsExt;
    let folder = Folder::new("umask");
    let program = env!("CARGO_BIN_EXE_foton");
    let mode = |name: &str| fs::metadata(folder.file(name)).expect("there").permissions().mode() & 0o777;
    let run = |umask: &str| {
        let arguments = "--passes 1 -o x.exr --checkpoint x.ck";
        let line = format!("umask {umask}; exec \"{program}\" {RENDER} {arguments}");
        let status = Command::new("sh").args(["-c", &line]).current_dir(&folder.0).output();
        assert!(status.expect("a shell").status.success());
        ["x.exr", "x.ck"].map(mode)
    };
    assert_eq!(run("027"), [0o640; 2]);
    assert_eq!(run("077"), [0o640; 2], "they were there");
    fs::set_permissions(folder.file("x.exr"), fs::Permissions::from_mode(0o666)).expect("ours");
    fs::remove_file(folder.file("x.ck")).expect("ours");
    assert_eq!(run("077"), [0o666, 0o600]);
}

/// What a killed render has left goes with the next one that writes there.
#[test]
fn what_a_killed_render_left_is_removed_by_the_next() {
    let folder = Folder::new("killed");
    let mut child = Command::new("true").spawn().expect("starts");
    child.wait().expect("ends");
    let dead = child.id();
    let names = [format!(".x.exr.tmp-{dead}-0"), format!(".x.ck.tmp-{dead}-0123456789abcdef")];
    let other = format!(".y.exr.tmp-{dead}-0");
    for name in names.iter().chain([&other]) {
        folder.write(name, "half");
    }
    folder.done(&format!("{RENDER} --passes 1 -o x.exr --checkpoint x.ck"));
    assert_eq!(folder.images(), [&*other, "x.ck", "x.exr"]);
}

/// As another person than root, whom no permissions bind; where there is no way to be one, as whoever runs the tests.
#[test]
fn files_in_folders_of_others_are_refused_before_rendering() {
    use std::os::unix::fs::{PermissionsExt, chown};
    const NOBODY: u32 = 65534;
    let folder = Folder::new("others");
    fs::copy(env!("CARGO_BIN_EXE_foton"), folder.file("foton")).expect("copied");
    for name in ["locked", "sticky"] {
        fs::create_dir(folder.file(name)).expect("a folder");
        folder.write(&format!("{name}/x.exr"), "the image before");
    }
    let set = |name: &str, mode: u32| {
        fs::set_permissions(folder.file(name), fs::Permissions::from_mode(mode)).expect("ours");
    };
    let is_root = chown(folder.file("locked/x.exr"), Some(NOBODY), None).is_ok();
    let run = |arguments: &str| {
        let mut command = if is_root {
            let mut command = Command::new("setpriv");
            let nobody = NOBODY.to_string();
            command
                .args(["--reuid", &nobody, "--regid", &nobody, "--clear-groups"])
                .arg(folder.file("foton"));
            command
        } else {
            Command::new(folder.file("foton"))
        };
        command.args(arguments.split(' ')).current_dir(&folder.0).env("TMPDIR", &folder.0).output()
    };
    set("", 0o755);
    set("locked", 0o555);
    let Ok(help) = run("--version") else { return };
    assert!(help.status.success(), "{}", text(&help.stderr));
    let refused = |path: &str, said: &str| {
        let output = run(&format!("{RENDER} --passes 1 -o {path}")).expect("starts");
        let events = events(&output.stdout);
        let found = of_kind(&events, "error");
        assert!(events.len() == 1 && found[0].contains(said), "{events:?}");
        assert_eq!(folder.bytes(path), b"the image before");
    };
    // The file may be written, but nothing can be made beside it.
    let locked = folder.file("locked").canonicalize().expect("there");
    refused(
        "locked/x.exr",
        &format!(
            "cannot write locked/x.exr: nothing can be made in its folder {}: Permission denied (os error 13)",
            locked.display()
        ),
    );
    if is_root {
        // Files can be made there, but not put in the place of another's.
        set("sticky", 0o1777);
        set("sticky/x.exr", 0o666);
        refused("sticky/x.exr", "cannot write sticky/x.exr: in its folder only its owner may replace it");
        // The folder is ours to write in, the file is not.
        set("sticky", 0o777);
        set("sticky/x.exr", 0o644);
        refused("sticky/x.exr", "cannot write sticky/x.exr: Permission denied (os error 13)");
    }
    set("locked", 0o755);
}

/// As a container is given a single file. Only root may mount, and not everywhere; where it may not, nothing is shown.
#[test]
fn a_file_that_is_mounted_by_itself_is_refused_before_rendering() {
    let folder = Folder::new("mounted");
    folder.write("x.exr", "the image before");
    folder.write("outside.exr", "outside");
    let program = env!("CARGO_BIN_EXE_foton");
    let line =
        format!("mount --bind outside.exr x.exr || exit 77; exec \"{program}\" {RENDER} --passes 1 -o x.exr");
    let output = Command::new("unshare").args(["--mount", "sh", "-c", &line]).current_dir(&folder.0).output();
    let Ok(output) = output.map_err(|_| ()) else { return };
    let events = events(&output.stdout);
    if output.status.code() == Some(77) || (events.is_empty() && text(&output.stderr).contains("unshare")) {
        return;
    }
    let said = "cannot write x.exr: it is mounted by itself and cannot be replaced; mount its folder instead";
    assert_eq!((output.status.code(), of_kind(&events, "error")), (Some(1), vec![said.to_owned()]));
    assert_eq!(events.len(), 1, "no pass was rendered");
    assert_eq!(folder.bytes("x.exr"), b"the image before");
}
