//! Renders in as little memory as `--memory` accepts, under a hard limit from outside: whether what the estimate says is enough.
//!
//! `cargo xtask limits` runs it with the dev build, and docs/robustness.md records its table. The system limits address space, which
//! has the program's file and its threads' stacks in it too; with the window in the file there are some 20 MiB more than the 16
//! that the estimate has for the program. The C library is told to keep no heaps a thread, which would be mostly address space.
#![allow(clippy::print_stdout, reason = "a program that prints figures")]

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};
use std::time::Duration;

/// Scenes of `assets`, and what they are asked for beside two passes.
const CASES: &[(&str, &str)] = &[
    ("box-spheres", "--size 64x64 --photons 1000 --threads 1"),
    ("box-spheres", "--size 512x512 --threads 2"),
    ("box-spheres", "--size 512x512 --threads 16"),
    ("cornell-diffuse", "--size 1024x1024 --photons 65536 --threads 2"),
    ("cornell-diffuse", "--size 512x512 --direct shadow-rays --threads 2"),
    ("cornell-spheres", "--size 512x512 --spp 4 --layers direct,caustic,indirect --threads 2"),
    ("cornell-spheres", "--size 512x512 --spp 4 --radius-rule local --threads 2"),
    ("cornell-spheres", "--size 512x512 --error off --threads 2"),
    ("cornell-spheres", "--size 1024x768 --spp 4 --photons 1048576 --threads 2"),
    ("cornell-spheres", "--size 1024x768 --spp 4 --photons 4194304 --threads 2"),
    ("furnace", "--size 256x256 --spp 8 --photons 1048576 --threads 2"),
    ("glass-and-ring", "--size 960x640 --spp 4 --threads 2"),
    ("pool", "--size 480x320 --spp 4 --threads 2"),
    ("ring", "--size 480x320 --spp 16 --threads 4"),
];

struct Rig {
    foton: PathBuf,
    out: PathBuf,
}

impl Rig {
    fn arguments(&self, scene: &str, wishes: &str, memory: u64) -> Vec<String> {
        let assets = Path::new(env!("CARGO_MANIFEST_DIR")).with_file_name("assets");
        let scene = assets.join(scene).join("scene.xml").display().to_string();
        let out = self.out.display().to_string();
        let fixed = ["render".to_owned(), scene, "-o".into(), out, "--passes".into(), "2".into()];
        let memory = ["--memory".to_owned(), format!("{memory}M")];
        fixed.into_iter().chain(wishes.split(' ').map(str::to_owned)).chain(memory).collect()
    }

    /// The smallest value that `--memory` accepts, in MiB, by what its refusals say.
    fn estimate(&self, scene: &str, wishes: &str) -> Result<u64, String> {
        let mut memory = 1;
        loop {
            let output = Command::new(&self.foton).args(self.arguments(scene, wishes, memory)).output();
            let output = output.map_err(|e| e.to_string())?;
            if output.status.success() {
                return Ok(memory);
            }
            let said = String::from_utf8_lossy(&output.stderr).into_owned();
            // "takes about 17 MiB", "needs about 155 MiB", "takes up to 14 MiB", rounded.
            let named = said
                .split_once(" MiB")
                .and_then(|(before, _)| before.rsplit(' ').next()?.parse::<u64>().ok());
            memory = named.filter(|&n| n >= memory).ok_or(said)? + 1;
        }
    }

    /// Whether it ends, and the largest address space and memory that it had, in KiB.
    fn run(&self, scene: &str, wishes: &str, memory: u64) -> Result<(bool, u64, u64), String> {
        let line = format!("ulimit -v {}; exec \"$0\" \"$@\"", memory << 10);
        let mut command = Command::new("sh");
        command.args(["-c", &line]).arg(&self.foton).args(self.arguments(scene, wishes, memory));
        command.env("MALLOC_ARENA_MAX", "1").stdout(Stdio::null()).stderr(Stdio::null());
        let mut child = command.spawn().map_err(|e| e.to_string())?;
        let status = format!("/proc/{}/status", child.id());
        let (mut space, mut resident) = (0, 0);
        loop {
            let now = std::fs::read_to_string(&status).unwrap_or_default();
            let peak = |name: &str| {
                let line = now.lines().find(|line| line.starts_with(name));
                line.and_then(|line| line.split_whitespace().nth(1)?.parse::<u64>().ok()).unwrap_or(0)
            };
            (space, resident) = (peak("VmPeak:").max(space), peak("VmHWM:").max(resident));
            if let Some(status) = child.try_wait().map_err(|e| e.to_string())? {
                return Ok((status.success(), space, resident));
            }
            std::thread::sleep(Duration::from_millis(2));
        }
    }

    /// Prints a line of the table; whether the case ended.
    fn case(&self, scene: &str, wishes: &str) -> Result<bool, String> {
        let memory = self.estimate(scene, wishes)?;
        let (ended, space, resident) = self.run(scene, wishes, memory)?;
        let (space, resident) = (space >> 10, resident >> 10);
        let outcome = if ended { "ended" } else { "DID NOT END" };
        println!("| {scene} | `{wishes}` | {memory} | {space} | {resident} | {outcome} |");
        Ok(ended)
    }
}

fn main() -> ExitCode {
    let Some(foton) = std::env::args().nth(1) else {
        println!("limits FOTON");
        return ExitCode::from(2);
    };
    let out = std::env::temp_dir().join(format!("foton-limits-{}.exr", std::process::id()));
    let rig = Rig { foton: foton.into(), out };
    println!("| scene | | `--memory` and limit | address space, peak | memory, peak | |");
    println!("|---|---|---|---|---|---|");
    let results: Vec<_> = CASES.iter().map(|(scene, wishes)| rig.case(scene, wishes)).collect();
    let _ = std::fs::remove_file(&rig.out);
    for why in results.iter().filter_map(|r| r.as_ref().err()) {
        println!("{why}");
    }
    if results.iter().all(|r| *r == Ok(true)) { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
