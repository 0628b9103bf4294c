//! Standard output that takes nothing: what was asked for there and is not there was not done. A reader that goes away is none of that.

use std::fs::OpenOptions;
use std::os::unix::fs::symlink;

use super::*;

/// Runs with standard output on a device that has no room.
fn into_full(folder: &Folder, arguments: &str) -> (Option<i32>, String) {
    let full = OpenOptions::new().write(true).open("/dev/full").expect("Linux has it");
    let output = folder.command(arguments).stdout(full).output().expect("the program starts");
    (output.status.code(), text(&output.stderr))
}

#[test]
fn results_that_standard_output_does_not_take_are_an_error() {
    let folder = Folder::new("full-output");
    folder.done("render scene.xml --passes 1 --photons 500 -o a.exr");
    for arguments in [
        "render scene.xml --passes 3 --photons 500 -o x.exr --json",
        "info scene.xml",
        "info scene.xml --json",
        "compare a.exr a.exr",
        "compare a.exr a.exr --json",
        "measure scene.xml -o dir --budget 1ms --seeds 2 --spp 1 --photons 500 --size 8x8 --json",
    ] {
        let (code, said) = into_full(&folder, arguments);
        assert_eq!(code, Some(1), "foton {arguments}: {said}");
        let error = "error: cannot write standard output: No space left on device (os error 28)";
        assert!(said.contains(error), "foton {arguments}: {said}");
        // Said once when it happens, for a render may be long, and once at the end.
        assert_eq!(said.matches("No space left").count(), 2, "foton {arguments}: {said}");
    }
    // What files were asked for are there.
    assert_eq!(folder.exr("x.exr").1.get("foton:passes"), Some("3"));
    assert!(folder.file("dir/index.html").exists());
    // Nothing is asked of it here.
    for arguments in ["render scene.xml --passes 1 --photons 500 -o y.exr", "convert scene.xml out.xml"] {
        assert_eq!(into_full(&folder, arguments).0, Some(0), "foton {arguments}");
    }
    // A failure keeps its own words.
    let (code, said) = into_full(&folder, "render nowhere.xml -o z.exr --json");
    assert!(code == Some(1) && said.contains("nowhere.xml"), "{said}");
}

#[test]
fn a_reader_that_goes_away_is_no_error() {
    let folder = Folder::new("closed-pipe");
    let program = env!("CARGO_BIN_EXE_foton");
    for arguments in ["render scene.xml --passes 3 --photons 500 -o x.exr --json", "info scene.xml --json"] {
        let (reader, writer) = std::io::pipe().expect("a pipe");
        drop(reader);
        let mut command = Command::new(program);
        command.args(arguments.split(' ')).current_dir(&folder.0).stdin(Stdio::null());
        let output =
            command.stdout(writer).stderr(Stdio::piped()).spawn().expect("starts").wait_with_output();
        let output = output.expect("it ends");
        let said = text(&output.stderr);
        assert!(output.status.success() && !said.contains("standard output"), "foton {arguments}: {said}");
    }
    assert_eq!(folder.exr("x.exr").1.get("foton:passes"), Some("3"));
}

/// Numbers are worth having without their picture.
#[test]
fn a_comparison_whose_picture_cannot_be_written_says_its_numbers_all_the_same() {
    let folder = Folder::new("compare-full");
    folder.done("render scene.xml --passes 1 --photons 500 -o a.exr");
    folder.done("render scene.xml --passes 1 --photons 500 --seed 1 -o b.exr");
    symlink("/dev/full", folder.file("d.png")).expect("a link");
    let output = folder.run("compare a.exr b.exr -o d.png --json");
    assert_eq!(output.status.code(), Some(1));
    let events = events(&output.stdout);
    assert!(number(&events[0]["rmse"], "all") > 0.0 && events[0]["output"].is_null(), "{events:?}");
    let said = "cannot write d.png: No space left on device (os error 28)";
    assert_eq!(events[1]["message"], said);
    let output = folder.run("compare a.exr b.exr -o d.png");
    assert!(text(&output.stdout).contains("relMSE") && !text(&output.stdout).contains("wrote"));
    assert!(text(&output.stderr).contains(said));
    // A place that takes nothing is refused before anything is computed.
    let output = folder.run("compare a.exr b.exr -o no/d.png");
    assert!(output.status.code() == Some(1) && output.stdout.is_empty());
}
