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
