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

#[test]
fn an_interrupt_is_answered_in_a_line_before_the_render_ends() {
    let folder = Folder::new("answer");
    let mut command = folder.command("render scene.xml -o x.exr --passes 1000000 --photons 2000 --json");
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("starts");
    let mut stdout = BufReader::new(child.stdout.take().expect("piped"));
    stdout.read_line(&mut String::new()).expect("a line");
    interrupt(&child);
    stdout.read_to_end(&mut Vec::new()).expect("lines");
    let mut said = String::new();
    child.stderr.take().expect("piped").read_to_string(&mut said).expect("lines");
    assert_eq!(child.wait().expect("ends").code(), Some(0), "{said}");
    assert!(said.contains("interrupted: the render ends after the photons under way"), "{said}");
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

#[test]
fn without_a_command_the_settings_are_those_that_the_scene_suggests_as_with_render() {
    let folder = Folder::new("suggested");
    let integrator = r#"<integrator type="ppm"><float name="alpha" value="0.4"/>
        <integer name="photon_count" value="3000"/><float name="initial_radius" value="0.25"/></integrator>
        <sensor type="perspective" id="front">"#;
    folder.write("scene.xml", &SCENE.replace(r#"<sensor type="perspective" id="front">"#, integrator));
    start_and_interrupt(&folder);
    let settings = |name: &str| folder.exr(name).1.get("foton:settings").expect("there").to_owned();
    let suggested = settings("foton-001.exr");
    for setting in ["alpha=0.4", "photons=3000", "radius=0.25"] {
        assert!(suggested.split(' ').any(|s| s == setting), "{setting}: {suggested}");
    }
    folder.done("render scene.xml -o render.exr --passes 1");
    assert_eq!(suggested, settings("render.exr"));
    // Of what is written, the PNG says how it shows light.
    let png = String::from_utf8_lossy(&folder.bytes("foton-001.png")).into_owned();
    assert!(png.contains("exposure=0 tone_map=pbr-neutral"));
}

#[test]
fn a_picture_that_somebody_put_in_the_place_meanwhile_is_left_alone() {
    let folder = Folder::new("meanwhile");
    let (mut child, mut stderr, mut said) = start(&folder, "scene.xml");
    folder.write("foton-001.exr", "somebody's");
    interrupt(&child);
    stderr.read_to_string(&mut said).expect("lines");
    assert_eq!(child.wait().expect("ends").code(), Some(1), "{said}");
    assert_eq!(folder.bytes("foton-001.exr"), b"somebody's");
    assert!(said.contains("foton-foton-001-001.exr instead"), "{said}");
    let (_, metadata) = folder.exr("foton-foton-001-001.exr");
    assert_eq!(metadata.get("foton:scene"), Some("scene.xml"));
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

#[cfg(target_os = "linux")]
const HUP: u32 = 1;
#[cfg(target_os = "linux")]
const XCPU: u32 = 24;
#[cfg(target_os = "linux")]
pub(super) const XFSZ: u32 = 25;

/// A render that only a signal ends, in its second pass or a later one, begun by a shell that has run a line before.
#[cfg(target_os = "linux")]
struct Endless {
    child: Child,
    stdout: BufReader<std::process::ChildStdout>,
}

#[cfg(target_os = "linux")]
impl Endless {
    fn start(folder: &Folder, line: &str) -> Self {
        let render = "render scene.xml -o x.exr --passes 1000000 --photons 2000 --json";
        let line = format!("{line} exec \"{}\" {render}", env!("CARGO_BIN_EXE_foton"));
        let mut command = Command::new("sh");
        command.args(["-c", &line]).current_dir(&folder.0).env("TMPDIR", &folder.0).stdin(Stdio::null());
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("starts");
        let stdout = BufReader::new(child.stdout.take().expect("piped"));
        let mut render = Self { child, stdout };
        render.passes(1);
        render
    }

    /// Waits for so many passes more.
    fn passes(&mut self, count: usize) {
        for _ in 0..count {
            let mut line = String::new();
            self.stdout.read_line(&mut line).expect("a line");
            assert!(line.starts_with('{') && line.contains("\"event\":\"pass\""), "{line}");
        }
    }

    fn send(&self, signal: &str) {
        let status = Command::new("kill").args([signal, &self.child.id().to_string()]).status();
        assert!(status.expect("kill runs").success(), "{signal}");
    }

    /// Its exit code and what it said on stderr.
    fn end(mut self) -> (Option<i32>, String) {
        std::io::copy(&mut self.stdout, &mut std::io::sink()).expect("lines");
        let mut said = String::new();
        self.child.stderr.take().expect("piped").read_to_string(&mut said).expect("text");
        (self.child.wait().expect("ends").code(), said)
    }
}

/// Whether a signal is turned off for the tests themselves, and so for what they begin.
#[cfg(target_os = "linux")]
pub(super) fn is_turned_off(number: u32) -> bool {
    let status = fs::read_to_string("/proc/self/status").expect("Linux has it");
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:")).expect("it says so");
    u64::from_str_radix(mask.trim(), 16).expect("a mask") >> (number - 1) & 1 == 1
}

/// A batch system warns by these that time, or room for a file, is up.
#[cfg(target_os = "linux")]
#[test]
fn limits_of_the_system_end_a_render_as_an_interrupt_does() {
    let signals = [
        ("-XCPU", XCPU, Some("the limit on processor time is reached (SIGXCPU, ulimit -t)")),
        ("-XFSZ", XFSZ, Some("a file has reached the limit on its size (SIGXFSZ, ulimit -f)")),
        ("-HUP", HUP, None),
    ];
    let signals = signals.into_iter().filter(|(_, number, _)| !is_turned_off(*number));
    let wishes = [("-TERM", 0, None), ("-INT", 0, None)];
    for (signal, _, why) in signals.chain(wishes) {
        let folder = Folder::new(&format!("limit{signal}"));
        let render = Endless::start(&folder, "");
        render.send(signal);
        let (code, said) = render.end();
        assert_eq!(code, Some(0), "{signal}: {said}");
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
    let mut render = Endless::start(&folder, "trap '' HUP XCPU XFSZ;");
    for signal in ["-HUP", "-XCPU", "-XFSZ"] {
        render.send(signal);
        render.passes(100);
    }
    // A person's own wish is heard.
    render.send("-TERM");
    let (code, said) = render.end();
    assert!(code == Some(0) && !said.contains("ends early"), "{code:?}: {said}");
}

/// Time of the processor: the kernel's own signal, not one that somebody sends.
#[cfg(target_os = "linux")]
#[test]
fn a_render_that_is_out_of_processor_time_leaves_its_image() {
    if is_turned_off(XCPU) {
        return;
    }
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
/// A mesh of a million triangles, which takes some processor seconds to read and build.
#[cfg(target_os = "linux")]
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

/// Steps of loading that hear nothing, as those of libraries do, end with the program.
#[cfg(target_os = "linux")]
#[test]
fn a_step_of_loading_that_hears_nothing_ends_at_the_first_signal() {
    let folder = Folder::new("deaf");
    folder.done("render scene.xml -o before.exr --passes 1 --photons 500 --checkpoint x.ck");
    for (step, signal) in [
        ("reading the scene", "-INT"),
        ("building the scene", "-TERM"),
        ("collecting hit points", "-INT"),
        ("resuming the checkpoint", "-TERM"),
    ] {
        let mut command = folder.command("render scene.xml -o x.exr --passes 2 --resume x.ck --json");
        command.env("FOTON_DEAF", step).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().expect("starts");
        let mut said = BufReader::new(child.stderr.take().expect("piped"));
        let mut line = String::new();
        while line.trim() != "deaf" {
            line.clear();
            assert_ne!(said.read_line(&mut line).expect("text"), 0, "it ended by itself");
        }
        let status = Command::new("kill").args([signal, &child.id().to_string()]).status();
        assert!(status.expect("kill runs").success());
        let mut rest = String::new();
        said.read_to_string(&mut rest).expect("text");
        let output = child.wait_with_output().expect("ends");
        assert_eq!(output.status.code(), Some(1), "{rest}");
        assert_eq!(rest.matches("interrupted while").count(), 1, "{rest}");
        assert!(rest.contains(&format!("interrupted while {step}: nothing was written")), "{rest}");
        let last = events(&output.stdout).pop().expect("an event");
        assert_eq!((&last["event"], &last["while"]), (&json!("interrupted"), &json!(step)));
    }
    assert!(!folder.file("x.exr").exists(), "nothing is written");
}
