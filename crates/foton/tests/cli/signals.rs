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

/// A mesh of a million triangles, which takes some processor seconds to read and build.
fn write_large_mesh(folder: &Folder) {
    const SIDE: u32 = 708;
    let mut bytes = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n\
         element face {}\nproperty list uchar int vertex_indices\nend_header\n",
        (SIDE + 1).pow(2),
        SIDE.pow(2)
    )
    .into_bytes();
    for i in 0..(SIDE + 1).pow(2) {
        let [x, z] = [i % (SIDE + 1), i / (SIDE + 1)].map(|i| i as f32 / SIDE as f32);
        bytes.extend([x, (i * 7919 % 13) as f32 * 1e-3, z].into_iter().flat_map(f32::to_le_bytes));
    }
    for i in 0..SIDE.pow(2) {
        let first = i % SIDE + i / SIDE * (SIDE + 1);
        bytes.push(4);
        let corners = [first, first + SIDE + 1, first + SIDE + 2, first + 1];
        bytes.extend(corners.into_iter().flat_map(u32::to_le_bytes));
    }
    fs::write(folder.file("large.ply"), bytes).expect("room");
    let shape = "<shape type=\"ply\"><string name=\"filename\" value=\"large.ply\"/></shape></scene>";
    folder.write("large.xml", &SCENE.replace("</scene>", shape));
}

/// A line of what the system says of a running program.
#[cfg(target_os = "linux")]
fn status(child: &mut Child, name: &str) -> String {
    assert!(child.try_wait().expect("ours").is_none(), "it ended by itself");
    let status = fs::read_to_string(format!("/proc/{}/status", child.id())).unwrap_or_default();
    let value = status.lines().find_map(|line| line.strip_prefix(name)?.strip_prefix(':'));
    value.unwrap_or_default().trim().to_owned()
}

/// Waits until the program handles SIGTERM itself: until then the system ends it at once.
#[cfg(target_os = "linux")]
fn wait_for_the_handler(child: &mut Child) {
    const SIGTERM: u32 = 15;
    let is_handled =
        |mask: String| u64::from_str_radix(&mask, 16).is_ok_and(|caught| caught >> (SIGTERM - 1) & 1 != 0);
    while !is_handled(status(child, "SigCgt")) {
        sleep(Duration::from_millis(1));
    }
}

/// Waits until the program holds so many MiB.
#[cfg(target_os = "linux")]
fn wait_for_memory(child: &mut Child, mebibytes: u64) {
    let held = |text: String| text.trim_end_matches("kB").trim().parse::<u64>().unwrap_or(0) >> 10;
    while held(status(child, "VmRSS")) < mebibytes {
        sleep(Duration::from_millis(1));
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_scene_that_is_read_or_built_is_given_up_at_the_first_signal() {
    // Once it is read it holds less than 100 MiB, and while its tree is built far more.
    const BUILDING: u64 = 200;
    let folder = Folder::new("loading");
    write_large_mesh(&folder);
    for (signal, mebibytes) in [("-TERM", 0), ("-INT", 0), ("-TERM", BUILDING)] {
        let mut command =
            folder.command("render large.xml -o x.exr --passes 1000000 --checkpoint x.ck --json");
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("starts");
        wait_for_the_handler(&mut child);
        wait_for_memory(&mut child, mebibytes);
        let status = Command::new("kill").args([signal, &child.id().to_string()]).status();
        assert!(status.expect("kill runs").success());
        let output = child.wait_with_output().expect("ends");
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{said}");
        let at = if mebibytes == BUILDING { "building the scene" } else { "" };
        assert!(said.contains(&format!("interrupted while {at}")) && !said.contains("error"), "{said}");
        assert_eq!(events(&output.stdout).last().map(|e| e["event"].clone()), Some(json!("interrupted")));
        let left: Vec<_> = folder.images().into_iter().filter(|name| !name.starts_with("large")).collect();
        assert_eq!(left, [""; 0], "nothing is written");
    }
}
