//! Kills renders at random moments and checks what is left: every checkpoint can be resumed, no image is half of one, and a
//! chain of killed renders ends in the bits of one that nobody killed.
//!
//! `cargo xtask kills [N]` runs it with the dev build, and docs/robustness.md records what it printed. A killed process leaves what
//! it has handed to the system: this says nothing of power cuts, for which files are synced before they are renamed.
#![allow(clippy::print_stdout, reason = "a program that prints figures")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};
use std::time::Duration;

use foton_film::read_exr;
use foton_math::{Purpose, Stream};
use serde_json::Value;

/// After so many kills a chain is compared with a render that nobody killed, and the next one begins.
const CHAIN: u32 = 20;
/// The latest moment of a kill, in seconds from the start. A checkpoint takes some milliseconds and comes every ten.
const LATEST: f32 = 0.4;
const CHECKPOINT: &str = "x.ck";

/// What was seen.
#[derive(Debug, Default)]
struct Counts {
    kills: u32,
    /// Checkpoints that were there after a kill; each was taken up.
    taken_up: u32,
    /// Kills before the first checkpoint of a chain.
    none_yet: u32,
    /// Files left beside a checkpoint that would have become the next: by their bytes no checkpoint, and whole ones.
    halves_refused: u32,
    whole_beside: u32,
    /// Halves of images, under a name that says so.
    other_leftovers: u32,
    /// Images on the way, all whole.
    images: u32,
    chains: u32,
    passes: u64,
}

struct Rig {
    foton: PathBuf,
    scene: PathBuf,
    folder: PathBuf,
}

impl Rig {
    /// `foton render` with what all renders of a chain have in common.
    fn render(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(&self.foton);
        command.arg("render").arg(&self.scene).args(["--size", "64x64", "--photons", "500", "--json"]);
        command.args(arguments).current_dir(&self.folder).stdin(Stdio::null());
        command
    }

    /// Starts a render that would never end, from the checkpoint if there is one, and kills it.
    fn kill_after(&self, moment: Duration) -> Result<(), String> {
        let mut command = self.render(&["-o", "x.exr", "--passes", "1000000000", "--every", "8"]);
        command.args(["--checkpoint", CHECKPOINT, "--checkpoint-every", "10ms"]);
        if self.folder.join(CHECKPOINT).exists() {
            command.args(["--resume", CHECKPOINT]);
        }
        let mut child = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().map_err(text)?;
        std::thread::sleep(moment);
        if let Some(status) = child.try_wait().map_err(text)? {
            return Err(format!("it ended before it was killed: {status}"));
        }
        child.kill().and_then(|()| child.wait()).map(drop).map_err(text)
    }

    /// Takes a checkpoint up and ends at once; how many passes it has.
    fn passes(&self, checkpoint: &str) -> Result<u64, String> {
        let mut command = self.render(&["-o", "resumed.exr", "--passes", "1", "--resume", checkpoint]);
        let output = command.output().map_err(text)?;
        let said = String::from_utf8_lossy(&output.stdout).into_owned();
        let last: Value =
            said.lines().last().map(serde_json::from_str).transpose().map_err(text)?.unwrap_or_default();
        if !output.status.success() {
            return Err(last["message"].as_str().unwrap_or("it says nothing").to_owned());
        }
        last["passes"].as_u64().ok_or_else(|| format!("no passes: {said}"))
    }

    /// Checks everything that a kill left, and removes it all but the checkpoint; returns the passes of that.
    fn check(&self, counts: &mut Counts) -> Result<u64, String> {
        for entry in fs::read_dir(&self.folder).map_err(text)? {
            let path = entry.map_err(text)?.path();
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            if name == CHECKPOINT {
                continue;
            } else if name.starts_with(&format!(".{CHECKPOINT}.tmp-")) {
                match self.passes(&name) {
                    Ok(_) => counts.whole_beside += 1,
                    Err(said) if said.contains("damaged") || said.contains("no checkpoint") => {
                        counts.halves_refused += 1;
                    }
                    Err(said) => return Err(said),
                }
            } else if name.starts_with('.') && name.contains(".tmp-") {
                counts.other_leftovers += 1;
            } else if name.starts_with("x-") {
                read_exr(&path).map_err(text)?;
                counts.images += 1;
            } else if name != "resumed.exr" {
                return Err(format!("{name} was left"));
            }
            // What was just looked at may be gone with "resumed.exr", which is written anew.
            let _ = fs::remove_file(path);
        }
        if !self.folder.join(CHECKPOINT).exists() {
            counts.none_yet += 1;
            return Ok(0);
        }
        let passes = self.passes(CHECKPOINT)?;
        counts.taken_up += 1;
        Ok(passes)
    }

    /// Whether the chain's checkpoint has the image of a render that nobody killed.
    fn compare(&self, passes: u64) -> Result<(), String> {
        self.passes(CHECKPOINT)?;
        let status = self
            .render(&["-o", "straight.exr", "--passes", &passes.to_string()])
            .output()
            .map_err(text)?
            .status;
        let [resumed, straight] =
            ["resumed.exr", "straight.exr"].map(|name| read_exr(&self.folder.join(name)).map(|read| read.0));
        let same = status.success() && resumed.map_err(text)? == straight.map_err(text)?;
        if same { Ok(()) } else { Err(format!("another image than without kills, after {passes} passes")) }
    }

    fn chain(&self, kills: std::ops::Range<u32>, counts: &mut Counts) -> Result<(), String> {
        let mut before = 0;
        for kill in kills {
            let mut stream = Stream::new(2008, Purpose::Test, 0, u64::from(kill));
            let moment = Duration::from_secs_f32(LATEST * stream.next_1d());
            self.kill_after(moment)?;
            counts.kills += 1;
            let passes = self.check(counts)?;
            if passes < before {
                return Err(format!("{passes} passes, after {before} before kill {kill}"));
            }
            before = passes;
        }
        if before > 0 {
            self.compare(before)?;
            counts.chains += 1;
            counts.passes += before;
        }
        Ok(())
    }
}

fn text(error: impl ToString) -> String {
    error.to_string()
}

fn main() -> ExitCode {
    let mut arguments = std::env::args().skip(1);
    let (Some(foton), Some(kills)) = (arguments.next(), arguments.next().and_then(|n| n.parse::<u32>().ok()))
    else {
        println!("kills FOTON N");
        return ExitCode::from(2);
    };
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).with_file_name("assets/cornell-spheres/scene.xml");
    let folder = std::env::temp_dir().join(format!("foton-kills-{}", std::process::id()));
    let rig = Rig { foton: foton.into(), scene, folder };
    let mut counts = Counts::default();
    let outcome = (0..kills).step_by(CHAIN as usize).try_for_each(|first| {
        fs::create_dir_all(&rig.folder).map_err(text)?;
        rig.chain(first..kills.min(first + CHAIN), &mut counts)?;
        fs::remove_dir_all(&rig.folder).map_err(text)
    });
    println!("{counts:#?}");
    if let Err(why) = outcome {
        println!("{why}; see {}", rig.folder.display());
        return ExitCode::FAILURE;
    }
    ExitCode::SUCCESS
}
