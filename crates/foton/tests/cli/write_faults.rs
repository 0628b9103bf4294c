//! Files that cannot be written: full disks, folders in which nothing can be made, folders that vanish. The render goes on where
//! there is something left to do; what could not be written is named; nothing half-written has the name of a whole file.
//!
//! The system is asked for its faults as any user may ask: `/dev/full` has no room, a limit on the size of files stops a write
//! in its middle, `/proc` takes no files from anybody. So they are there on Linux alone, for root too.

use std::io::{BufRead, BufReader, Read};
use std::os::unix::fs::symlink;
use std::process::{Child, ChildStdout};

use super::*;

pub(super) const RENDER: &str = "render scene.xml --photons 500 --threads 2 --json";

/// Runs the program where no file may grow beyond so many halves of a kibibyte.
fn run_within(folder: &Folder, blocks: u32, arguments: &str) -> Output {
    let program = env!("CARGO_BIN_EXE_foton");
    // Ignored, the signal that comes with the limit leaves an error of the write, as a full disk does.
    let line = format!("trap '' XFSZ; ulimit -f {blocks}; exec \"{program}\" {arguments}");
    Command::new("sh")
        .args(["-c", &line])
        .current_dir(&folder.0)
        .env("TMPDIR", &folder.0)
        .output()
        .expect("a shell")
}

/// The events of a run by their kind.
pub(super) fn of_kind(events: &[Value], kind: &str) -> Vec<String> {
    let chosen = events.iter().filter(|e| e["event"] == kind);
    chosen.map(|e| e["message"].as_str().unwrap_or_default().to_owned()).collect()
}

#[test]
fn a_full_disk_is_an_error_with_the_path_and_the_old_image_stays() {
    let folder = Folder::new("full");
    for name in ["x.exr", "x.png"] {
        folder.write(name, "the image before");
        let output = run_within(&folder, 1, &format!("{RENDER} --passes 2 -o {name}"));
        assert_eq!(output.status.code(), Some(1), "{}", text(&output.stderr));
        let events = events(&output.stdout);
        let said = format!("cannot write {name}: File too large (os error 27)");
        assert_eq!(of_kind(&events, "error"), [said]);
        // What the render found is said all the same.
        let done = events.iter().find(|e| e["event"] == "done").expect("it went to its end");
        assert_eq!((&done["passes"], &done["outputs"]), (&json!(2), &json!([])));
        assert_eq!(folder.bytes(name), b"the image before");
    }
    symlink("/dev/full", folder.file("device.exr")).expect("a link");
    let said = folder.fails(1, "render scene.xml --photons 500 --passes 1 -o device.exr");
    assert!(said.contains("cannot write device.exr: No space left on device"), "{said}");
    // Where there is room for temporary files, it is there.
    let expected = ["device.exr", "foton-device-001.exr", "x.exr", "x.png"];
    assert_eq!(folder.images(), expected, "nothing else is left");
    assert!(folder.exr("foton-device-001.exr").0.width > 0);
}

#[test]
fn a_full_disk_costs_a_checkpoint_but_not_the_render() {
    let folder = Folder::new("full-checkpoint");
    folder.done(&format!("{RENDER} --passes 3 -o whole.exr"));
    folder.done(&format!("{RENDER} --passes 1 -o one.exr --checkpoint x.ck"));
    let before = folder.bytes("x.ck");
    // The image has room in 64 KiB, hit points have not.
    let goes_on = "--passes 3 -o x.exr --size 48x32 --spp 64 --checkpoint-every 1ms";
    let output = run_within(&folder, 128, &format!("{RENDER} {goes_on} --checkpoint x.ck"));
    assert!(output.status.success(), "{}", text(&output.stderr));
    let warnings = of_kind(&events(&output.stdout), "warning");
    let said = "no checkpoint: cannot write x.ck: File too large (os error 27)";
    assert!(warnings.len() >= 3 && warnings.iter().all(|w| w == said), "{warnings:?}");
    assert!(folder.bytes("x.ck") == before, "the checkpoint before is whole");
    // It is still one that can be resumed.
    folder.done(&format!("{RENDER} --passes 3 -o resumed.exr --resume x.ck"));
    assert!(folder.exr("resumed.exr").0 == folder.exr("whole.exr").0);
    symlink("/dev/full", folder.file("device.ck")).expect("a link");
    let output = folder.done(&format!("{RENDER} --passes 3 -o device.exr --checkpoint device.ck"));
    let warnings = of_kind(&events(&output.stdout), "warning");
    let said = "no checkpoint: cannot write device.ck: No space left on device (os error 28); the state is in \
                foton-device-001.ck instead";
    assert_eq!(warnings, [said]);
    assert!(folder.exr("device.exr").0 == folder.exr("whole.exr").0);
    let mut expected = ["device.ck", "device.exr", "foton-device-001.ck", "one.exr"].to_vec();
    expected.extend(["resumed.exr", "whole.exr", "x.ck", "x.exr"]);
    assert_eq!(folder.images(), expected, "nothing else is left");
    folder.done(&format!("{RENDER} --passes 3 -o rescued.exr --resume foton-device-001.ck"));
    assert!(folder.exr("rescued.exr").0 == folder.exr("whole.exr").0);
}

#[test]
fn a_folder_that_takes_no_file_or_is_not_there_is_refused_before_rendering() {
    let folder = Folder::new("no-place");
    folder.write("kept.ck", "not ours");
    let mut permissions = fs::metadata(folder.file("kept.ck")).expect("there").permissions();
    permissions.set_readonly(true);
    fs::set_permissions(folder.file("kept.ck"), permissions).expect("ours");
    for (arguments, said) in [
        ("-o /proc/x.exr", "cannot write /proc/x.exr: "),
        ("-o x.exr --checkpoint /proc/x.ck", "cannot write /proc/x.ck: "),
        ("-o no/x.exr", "cannot write no/x.exr: the folder no does not exist"),
        ("-o x.exr --checkpoint no/x.ck", "cannot write no/x.ck: the folder no does not exist"),
        ("-o x.exr --checkpoint kept.ck", "cannot write kept.ck: the file is read-only"),
    ] {
        let output = folder.run(&format!("{RENDER} --passes 1 {arguments}"));
        assert_eq!(output.status.code(), Some(1), "{arguments}");
        let events = events(&output.stdout);
        assert!(
            events.len() == 1 && of_kind(&events, "error")[0].starts_with(said),
            "{arguments}: {events:?}"
        );
    }
    assert_eq!(folder.images(), ["kept.ck"]);
}

#[test]
fn an_image_on_the_way_that_cannot_be_written_is_a_warning_and_the_last_one_comes() {
    let folder = Folder::new("on-the-way");
    fs::create_dir(folder.file("x-000002.exr")).expect("a folder in the way");
    let output = folder.done(&format!("{RENDER} --passes 3 --every 1 -o x.exr"));
    let events = events(&output.stdout);
    let warnings = of_kind(&events, "warning");
    assert_eq!(warnings, ["an image on the way is missing: cannot write x-000002.exr: is a directory"]);
    let outputs = &events.last().expect("an event")["outputs"];
    assert_eq!(outputs, &json!(["x-000001.exr", "x-000003.exr", "x.exr"]));
    assert!(folder.exr("x.exr").0 == folder.exr("x-000003.exr").0);
}

/// A render that only an interrupt ends, with its files in a folder of their own.
struct Endless {
    child: Child,
    stdout: BufReader<ChildStdout>,
}

impl Endless {
    fn start(folder: &Folder) -> Self {
        fs::create_dir(folder.file("sub")).expect("a folder");
        let files = "-o sub/x.exr --checkpoint sub/x.ck --checkpoint-every 1ms";
        let mut command = folder.command(&format!("{RENDER} --passes 100000000 {files}"));
        let mut child =
            command.stdout(Stdio::piped()).stderr(Stdio::null()).spawn().expect("the program starts");
        let stdout = BufReader::new(child.stdout.take().expect("piped"));
        Self { child, stdout }
    }

    /// Reads on to the first event of a kind.
    #[track_caller]
    fn until(&mut self, kind: &str) -> Value {
        loop {
            let mut line = String::new();
            assert_ne!(self.stdout.read_line(&mut line).expect("a line"), 0, "it ended before a {kind}");
            let event = events(line.as_bytes()).remove(0);
            if event["event"] == kind {
                return event;
            }
        }
    }

    /// Interrupts it and gives its exit code and the message of its last error.
    fn end(mut self) -> (Option<i32>, Option<String>) {
        signals::interrupt(&self.child);
        let mut rest = Vec::new();
        self.stdout.read_to_end(&mut rest).expect("lines");
        let code = self.child.wait().expect("ends").code();
        (code, of_kind(&events(&rest), "error").pop())
    }
}

/// Removes a folder that somebody writes into.
fn remove(path: &Path) {
    while path.exists() {
        let _ = fs::remove_dir_all(path);
    }
}

#[test]
fn a_folder_that_vanishes_costs_its_files_and_nothing_that_was_rendered() {
    let folder = Folder::new("vanishes");
    let mut render = Endless::start(&folder);
    render.until("pass");
    remove(&folder.file("sub"));
    let said = render.until("warning")["message"].as_str().expect("a message").to_owned();
    assert!(said.starts_with("no checkpoint: cannot write sub/x.ck: "), "{said}");
    // It goes on, in memory.
    let pass = number(&render.until("pass"), "pass");
    assert!(number(&render.until("pass"), "pass") > pass);
    let (code, error) = render.end();
    assert_eq!(code, Some(1));
    assert_eq!(error.as_deref(), Some("cannot write sub/x.exr: the folder sub does not exist"));
    // Image and state are rescued.
    assert_eq!(folder.images(), ["foton-x-001.ck", "foton-x-001.exr"]);
    let passes = folder.exr("foton-x-001.exr").1.get("foton:passes").and_then(|p| p.parse::<f64>().ok());
    assert!(passes > Some(pass));
}

#[test]
fn a_folder_that_comes_back_has_all_files_again() {
    let folder = Folder::new("comes-back");
    let mut render = Endless::start(&folder);
    render.until("pass");
    remove(&folder.file("sub"));
    render.until("warning");
    let pass = number(&render.until("pass"), "pass");
    fs::create_dir(folder.file("sub")).expect("a folder");
    // The interrupt may come before another pass has begun.
    render.until("pass");
    assert_eq!(render.end(), (Some(0), None));
    let passes = |name: &str| folder.exr(name).1.get("foton:passes").and_then(|p| p.parse::<f64>().ok());
    assert!(passes("sub/x.exr") > Some(pass));
    folder.done(&format!("{RENDER} --passes 1 -o y.exr --resume sub/x.ck"));
    assert_eq!(passes("y.exr"), passes("sub/x.exr"), "the checkpoint has the last pass");
    assert!(folder.exr("y.exr").0 == folder.exr("sub/x.exr").0);
}

/// The limit as a shell sets it, with the signal that comes with it as the system has it.
#[test]
fn the_limit_on_the_size_of_files_ends_a_render_with_its_image_and_not_in_the_middle() {
    if signals::is_turned_off(signals::XFSZ) {
        return;
    }
    let folder = Folder::new("file-limit");
    folder.write("x.exr", "the image before");
    let program = env!("CARGO_BIN_EXE_foton");
    let within = |blocks: u32, arguments: &str| {
        let line = format!("ulimit -f {blocks}; exec \"{program}\" {arguments}");
        let mut command = Command::new("sh");
        command.args(["-c", &line]).current_dir(&folder.0).env("TMPDIR", &folder.0);
        command.output().expect("a shell")
    };
    // No room for the image: as on a full disk.
    for arguments in ["--passes 2 -o x.exr", "--passes 2 -o x.exr --every 1"] {
        let output = within(1, &format!("{RENDER} {arguments}"));
        assert_eq!(output.status.code(), Some(1), "{}: {}", output.status, text(&output.stderr));
        let said = "cannot write x.exr: File too large (os error 27)";
        assert_eq!(of_kind(&events(&output.stdout), "error"), [said], "{arguments}");
        assert_eq!(folder.bytes("x.exr"), b"the image before");
    }
    // No room for the checkpoint, which is larger: the signal ends the render after its pass, and its image comes.
    let goes_on =
        "--passes 100000000 -o y.exr --size 48x32 --spp 64 --checkpoint y.ck --checkpoint-every 1ms";
    let output = within(128, &format!("{RENDER} {goes_on}"));
    assert_eq!(output.status.code(), Some(0), "{}: {}", output.status, text(&output.stderr));
    let events = events(&output.stdout);
    let warnings = of_kind(&events, "warning");
    assert_eq!(warnings[0], "no checkpoint: cannot write y.ck: File too large (os error 27)");
    let why = "the render ends early: a file has reached the limit on its size (SIGXFSZ, ulimit -f)";
    assert!(warnings.iter().any(|w| w == why), "{warnings:?}");
    assert!(folder.exr("y.exr").1.get("foton:passes").is_some());
    // Other commands do not die of it either.
    for arguments in ["compare y.exr y.exr -o d.exr", "convert scene.xml out.xml"] {
        let output = within(1, arguments);
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "foton {arguments}: {}: {said}", output.status);
        assert!(said.contains("File too large (os error 27)") && said.contains("cannot write "), "{said}");
    }
    let left = folder.images();
    assert!(left.iter().all(|name| !name.contains(".tmp-")), "{left:?}");
    assert_eq!(left, ["meshes", "x.exr", "y.exr"]);
}

/// What cannot be an image any more where it was to be.
#[test]
fn an_image_whose_name_has_become_a_folder_is_beside_it() {
    let folder = Folder::new("became-folder");
    let mut render = Endless::start(&folder);
    render.until("pass");
    fs::create_dir(folder.file("sub/x.exr")).expect("a folder in the way");
    let (code, error) = render.end();
    assert_eq!((code, error.as_deref()), (Some(1), Some("cannot write sub/x.exr: is a directory")));
    assert!(folder.exr("sub/foton-x-001.exr").0.width > 0);
    // The checkpoint had its place.
    assert!(folder.file("sub/x.ck").exists() && !folder.file("sub/foton-x-001.ck").exists());
}
