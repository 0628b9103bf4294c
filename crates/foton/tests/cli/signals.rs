//! Renders that a signal ends.

use std::io::{BufRead, BufReader, Read};
use std::process::{Child, ChildStderr};
use std::thread::sleep;
use std::time::Duration;

use super::*;

pub(super) fn interrupt(child: &Child) {
    let status = Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(status.expect("kill runs").success());
}

#[test]
fn an_interrupt_ends_a_long_render_after_its_pass_and_writes_the_image() {
    let folder = Folder::new("interrupt");
    let mut command = folder.command("render scene.xml -o x.exr --passes 1000000 --photons 2000 --json");
    let mut child = command.stdout(Stdio::piped()).spawn().expect("starts");
    let mut stdout = BufReader::new(child.stdout.take().expect("piped"));
    let mut first = String::new();
    stdout.read_line(&mut first).expect("a line");
    assert_eq!(events(first.as_bytes())[0]["event"], "pass");
    interrupt(&child);
    let mut rest = Vec::new();
    stdout.read_to_end(&mut rest).expect("lines");
    assert_eq!(child.wait().expect("ends").code(), Some(0));
    let events = events(&rest);
    let done = events.last().expect("the end");
    assert_eq!((&done["event"], &done["outputs"]), (&json!("done"), &json!(["x.exr"])));
    let passes = folder.exr("x.exr").1.get("foton:passes").map(str::to_owned);
    assert_eq!(passes, Some(done["passes"].to_string()));
    assert_eq!(folder.images(), ["x.exr"]);
}

/// The system's own shutdown sends this one.
#[test]
fn a_terminated_render_leaves_its_image_and_a_checkpoint_that_goes_on_with_the_same_bits() {
    let folder = Folder::new("terminate");
    let render = "render scene.xml --photons 2000 --json";
    let arguments = format!("{render} -o x.exr --passes 1000000 --checkpoint x.ck");
    let mut child = folder.command(&arguments).stdout(Stdio::piped()).spawn().expect("starts");
    let mut stdout = BufReader::new(child.stdout.take().expect("piped"));
    stdout.read_line(&mut String::new()).expect("a line");
    let status = Command::new("kill").args(["-TERM", &child.id().to_string()]).status();
    assert!(status.expect("kill runs").success());
    let mut rest = Vec::new();
    stdout.read_to_end(&mut rest).expect("lines");
    assert_eq!(child.wait().expect("ends").code(), Some(0));
    let passes = number(events(&rest).last().expect("the end"), "passes");
    assert_eq!(folder.images(), ["x.ck", "x.exr"]);
    // Three more, and as many without a break.
    let more = passes + 3.0;
    folder.done(&format!("{render} -o on.exr --resume x.ck --passes {more}"));
    folder.done(&format!("{render} -o straight.exr --passes {more}"));
    assert!(folder.exr("on.exr").0 == folder.exr("straight.exr").0);
    // What does not fit is said, and no image is made of it.
    let said = folder.fails(1, &format!("{render} -o no.exr --resume x.ck --seed 7"));
    assert!(
        said.contains("x.ck: the checkpoint was made with seed 0, not 7, which cannot change on the way"),
        "{said}"
    );
    let said = folder.fails(1, &format!("{render} -o no.exr --resume nowhere.ck"));
    assert!(said.contains("nowhere.ck: No such file"), "{said}");
    folder.write("scene.xml", &SCENE.replace("0.7", "0.6"));
    let said = folder.fails(1, &format!("{render} -o no.exr --resume x.ck"));
    assert!(said.contains("of another scene"), "{said}");
    assert_eq!(folder.images(), ["on.exr", "straight.exr", "x.ck", "x.exr"]);
}

/// Starts the minute-long render and waits until it says that Ctrl-C stops it.
fn start(folder: &Folder, arguments: &str) -> (Child, BufReader<ChildStderr>, String) {
    let mut child = folder.command(arguments).stderr(Stdio::piped()).spawn().expect("starts");
    let mut stderr = BufReader::new(child.stderr.take().expect("piped"));
    let mut said = String::new();
    while !said.contains("Ctrl-C") {
        assert_ne!(stderr.read_line(&mut said).expect("a line"), 0, "{said}");
    }
    (child, stderr, said)
}

fn start_and_interrupt(folder: &Folder) {
    let (mut child, mut stderr, mut said) = start(folder, "scene.xml");
    interrupt(&child);
    stderr.read_to_string(&mut said).expect("lines");
    assert_eq!(child.wait().expect("ends").code(), Some(0), "{said}");
}

#[test]
fn without_a_command_pictures_are_numbered_from_1_and_an_interrupt_ends_the_minute() {
    let folder = Folder::new("minute");
    start_and_interrupt(&folder);
    assert_eq!(folder.images(), ["foton-001.exr", "foton-001.png"]);
    let first = folder.bytes("foton-001.exr");
    start_and_interrupt(&folder);
    let both = ["foton-001.exr", "foton-001.png", "foton-002.exr", "foton-002.png"];
    assert_eq!(folder.images(), both);
    assert!(folder.bytes("foton-001.exr") == first, "the first picture is left alone");
    assert_eq!(folder.exr("foton-002.exr").1.get("foton:scene"), Some("scene.xml"));
}

/// Its first pass takes long in a test build, so it is given up.
#[test]
fn without_a_scene_the_embedded_one_is_begun_and_further_interrupts_give_it_up() {
    let folder = Folder::new("embedded");
    let (mut child, _stderr, said) = start(&folder, "");
    assert!(said.contains("glass-and-ring") && said.contains("foton-001.png"), "{said}");
    while child.try_wait().expect("ours").is_none() {
        interrupt(&child);
        sleep(Duration::from_millis(50));
    }
    let status = child.wait().expect("ends");
    assert!(status.code().is_some(), "it ends by itself, not killed: {status}");
}

/// Sends a signal to a render after its first pass; its exit code, its last event, and all that it said on stderr.
#[cfg(target_os = "linux")]
fn signalled(folder: &Folder, signal: &str, begun_by: &str) -> (std::process::ExitStatus, Value, String) {
    let program = env!("CARGO_BIN_EXE_foton");
    let render = "render scene.xml -o x.exr --passes 1000000 --photons 2000 --json";
    let line = format!("{begun_by} exec \"{program}\" {render}");
    let mut command = Command::new("sh");
    command.args(["-c", &line]).current_dir(&folder.0).env("TMPDIR", &folder.0).stdin(Stdio::null());
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("starts");
    let mut stdout = BufReader::new(child.stdout.take().expect("piped"));
    stdout.read_line(&mut String::new()).expect("a line");
    let pid = child.id().to_string();
    for name in signal.split(' ') {
        assert!(Command::new("kill").args([name, &pid]).status().expect("kill runs").success());
        // Those that are ignored leave it running: it goes on for two passes more.
        stdout.read_line(&mut String::new()).expect("a line");
        stdout.read_line(&mut String::new()).expect("a line");
    }
    let mut rest = Vec::new();
    stdout.read_to_end(&mut rest).expect("lines");
    let mut said = String::new();
    child.stderr.take().expect("piped").read_to_string(&mut said).expect("text");
    (child.wait().expect("ends"), events(&rest).pop().unwrap_or_default(), said)
}

/// A batch system warns by these that time, or room for a file, is up.
#[cfg(target_os = "linux")]
#[test]
fn limits_of_the_system_end_a_render_as_an_interrupt_does() {
    for (signal, why) in [
        ("-XCPU", Some("the limit on processor time is reached (SIGXCPU, ulimit -t)")),
        ("-XFSZ", Some("a file has reached the limit on its size (SIGXFSZ, ulimit -f)")),
        ("-HUP", None),
        ("-TERM", None),
        ("-INT", None),
    ] {
        let folder = Folder::new(&format!("limit{signal}"));
        let (status, _, said) = signalled(&folder, signal, "");
        assert_eq!(status.code(), Some(0), "{signal}: {status}: {said}");
        let warning = why.map(|why| format!("warning: the render ends early: {why}"));
        assert_eq!(said.contains("ends early"), why.is_some(), "{signal}: {said}");
        assert!(warning.is_none_or(|warning| said.contains(&warning)), "{signal}: {said}");
        assert!(folder.exr("x.exr").1.get("foton:passes").is_some(), "{signal}");
        assert_eq!(folder.images(), ["x.exr"]);
    }
}

/// `nohup` and its like turn them off for the program that they begin.
#[cfg(target_os = "linux")]
#[test]
fn signals_that_were_turned_off_stay_so() {
    let folder = Folder::new("turned-off");
    let (status, done, said) = signalled(&folder, "-HUP -XCPU -XFSZ -TERM", "trap '' HUP XCPU XFSZ;");
    assert_eq!(status.code(), Some(0), "{status}: {said}");
    assert!(!said.contains("ends early"), "{said}");
    // The last one was heard.
    assert!(done.is_null() || number(&done, "passes") >= 7.0, "{done}");
}

/// Time of the processor: the kernel's own signal, not one that somebody sends.
#[cfg(target_os = "linux")]
#[test]
fn a_render_that_is_out_of_processor_time_leaves_its_image() {
    let folder = Folder::new("out-of-time");
    let program = env!("CARGO_BIN_EXE_foton");
    let line = format!(
        "ulimit -S -t 1; exec \"{program}\" render scene.xml -o x.exr --passes 1000000 --photons 2000"
    );
    let output = Command::new("sh").args(["-c", &line]).current_dir(&folder.0).output().expect("a shell");
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{}: {said}", output.status);
    assert!(said.contains("the limit on processor time is reached"), "{said}");
    assert!(folder.exr("x.exr").0.width > 0);
}
