//! Files that are none, limits that the system sets, and names that a terminal would obey.

use super::*;

impl Folder {
    /// Runs a line of the shell, in which `$FOTON` is the program; where it hangs it is killed and has no exit code.
    fn shell(&self, line: &str, environment: &[(&str, &str)]) -> Output {
        let mut command = Command::new("timeout");
        command.args(["-s", "KILL", "120", "bash", "-c", line]).current_dir(&self.0).stdin(Stdio::null());
        command
            .env("FOTON", env!("CARGO_BIN_EXE_foton"))
            .env("RUST_BACKTRACE", "0")
            .envs(environment.iter().copied());
        command.output().expect("a shell")
    }
}

/// A small and short render.
const RENDER: &str = "$FOTON render scene.xml -o x.exr --passes 1 --photons 1000 -D width=8";

#[test]
fn no_command_reads_what_is_no_file() {
    let folder = Folder::new("no-files");
    assert!(
        folder
            .shell(
                "mkfifo pipe.exr && ln -s /dev/zero zero.exr && ln -s /dev/zero zero.png && mkdir dir.exr",
                &[]
            )
            .status
            .success()
    );
    folder.done("render scene.xml -o a.exr --passes 1 --photons 1000 -D width=8");
    for (line, kind) in [
        ("$FOTON info /dev/zero", "it is a device"),
        ("$FOTON convert /dev/zero y.xml", "it is a device"),
        ("$FOTON info .", "it is a folder"),
        ("$FOTON info /proc/self/environ", "it is a file of the kernel"),
        ("$FOTON compare zero.exr a.exr", "it is a device"),
        ("$FOTON compare a.exr zero.png", "it is a device"),
        ("$FOTON compare a.exr pipe.exr", "it is a pipe"),
        ("$FOTON compare a.exr dir.exr", "it is a folder"),
        ("$FOTON measure scene.xml -o m --reference zero.exr", "it is a device"),
        (&format!("{RENDER} --resume /dev/zero"), "it is a device"),
        (&format!("{RENDER} --resume pipe.exr"), "it is a pipe"),
        (&format!("{RENDER} --resume /proc/self/environ"), "it is a file of the kernel"),
    ] {
        let output = folder.shell(line, &[]);
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{line}: {said}");
        assert!(said.contains(kind), "{line}: {said}");
    }
}

#[test]
fn a_scene_may_come_from_a_pipe_and_then_names_files_beside_it_by_their_whole_path() {
    let folder = Folder::new("from-pipes");
    let whole = format!("sed s,gem.obj,{}/gem.obj, scene.xml", folder.0.display());
    for line in [format!("$FOTON info <({whole})"), format!("{whole} | $FOTON info /dev/stdin")] {
        let output = folder.shell(&line, &[]);
        assert!(output.status.success(), "{line}: {}", text(&output.stderr));
        assert!(text(&output.stdout).contains("4 shapes"), "{line}: {}", text(&output.stdout));
    }
}

#[test]
fn a_limit_on_address_space_refuses_with_the_numbers_and_never_aborts() {
    let folder = Folder::new("address-space");
    let mut refused = 0;
    for mebibytes in [60, 100, 150, 200, 300, 400, 600, 1000] {
        for (size, wish) in [("64x48", ""), ("640x480", ""), ("640x480", "--memory 8G")] {
            let line = format!("ulimit -v {}; {RENDER} --size {size} {wish}", mebibytes << 10);
            let output = folder.shell(&line, &[]);
            let said = text(&output.stderr);
            match output.status.code() {
                Some(0) => {}
                Some(1) => {
                    refused += 1;
                    let numbers = format!("confines the program to {mebibytes} MiB (ulimit -v)");
                    assert!(
                        said.contains(&numbers) || said.contains("cannot make render threads"),
                        "{line}: {said}"
                    );
                }
                // The program is not even loaded.
                Some(127) if mebibytes < 100 => {}
                code => panic!("{line}: {code:?} {said}"),
            }
        }
    }
    assert!(refused >= 3, "{refused}");
}

#[test]
fn threads_that_cannot_be_are_refused_or_left_to_the_machine() {
    let folder = Folder::new("threads");
    let said = folder.fails(2, "render scene.xml -o x.exr --threads 1000000000");
    assert!(said.contains("1024"), "{said}");
    let output = folder.shell(RENDER, &[("RAYON_NUM_THREADS", "1000000000")]);
    let said = text(&output.stderr);
    assert!(output.status.success(), "{said}");
    let warning =
        "warning: RAYON_NUM_THREADS is \"1000000000\", which is no number of threads from 1 to 1024";
    assert!(said.contains(warning), "{said}");
    // There is no room for the stacks of so many.
    let output = folder.shell(&format!("ulimit -v 400000; {RENDER}"), &[("RAYON_NUM_THREADS", "1024")]);
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("cannot make render threads"), "{said}");
}

#[test]
fn what_is_printed_does_nothing_to_a_terminal() {
    let folder = Folder::new("terminals");
    let nasty = "a\u{9b}31m\u{202e}\u{200b}z";
    folder.write(
        "nasty.xml",
        &SCENE
            .replace("id=\"front\"", &format!("id=\"{nasty}\""))
            .replace("gem.obj", &format!("{nasty}.obj")),
    );
    folder.write("g.obj", "v 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl \u{1b}[2J\u{1b}]0;x\u{7}\nf 1 2 3\n");
    folder.write(&format!("{nasty}.xml"), "<scene version=\"3.0.0\"/>");
    folder.done("render scene.xml -o x.exr --passes 1 --photons 1000 -D width=8");
    fs::copy(folder.file("x.exr"), folder.file(&format!("{nasty}.exr"))).expect("copied");
    for arguments in [
        format!("compare x.exr {nasty}.exr"),
        format!("compare x.exr {nasty}.bmp"),
        format!("render {nasty} --{nasty}"),
        format!("render scene.xml -o x.exr -D {nasty}"),
        "info nasty.xml".to_owned(),
        "render nasty.xml -o x.exr --passes 1 --json".to_owned(),
        format!("info scene.xml -D x={nasty}"),
        format!("info scene.xml --sensor {nasty}"),
        format!("info {nasty}.xml"),
        format!("info {nasty}.xml --json"),
        "info g.obj".to_owned(),
        "info g.obj --json".to_owned(),
    ] {
        let output = folder.run(&arguments);
        let said = text(&output.stdout) + &text(&output.stderr);
        let bad = said.chars().find(|c| *c != '\n' && !foton_input::is_printable(*c));
        assert_eq!(bad, None, "{arguments}: {said:?}");
    }
    // JSON says what it is, for a program to read.
    let output = folder.run(&format!("info {nasty}.xml --json"));
    let event: Value =
        serde_json::from_str(text(&output.stdout).lines().next().expect("a line")).expect("JSON");
    assert!(event["file"].as_str().is_some_and(|file| file.contains('\u{202e}')), "{event}");
}
