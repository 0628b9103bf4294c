//! `cargo xtask bench`: whole runs of the release build on the benchmark box, stage by stage.
//!
//! Beside each rate stand the image's hash and its error, so that no speed is bought with a wrong picture. Not part of any
//! test: what it prints is this machine's, and goes to docs/performance.md by hand.

use std::env;
use std::fs;
use std::path::Path;
use std::process::Command;

use serde_json::Value;

use crate::tools::{self, Trouble};

const SCENE: &str = "assets/box-spheres/scene.xml";
/// World units, as the peers in the table of targets start.
const RADIUS: &str = "0.455";
const PHOTONS: u64 = 262_144;
const PASSES: u64 = 48;
/// Passes before rates are steady: radii shrink fastest in the first.
const WARM_UP: u64 = 16;
/// Passes of the run that errors are measured against, of another seed.
const REFERENCE_PASSES: u64 = 256;
/// Stages that each pass goes through.
const PER_PASS: [&str; 5] = ["trace", "sort", "gather", "shadow_rays", "radiance"];

/// One render, as its JSON lines tell it.
struct Run {
    passes: Vec<Value>,
    done: Value,
}

/// Builds, renders and prints. Takes minutes.
///
/// # Errors
/// What could not be built or rendered.
pub(crate) fn all() -> Result<(), Trouble> {
    tools::run(&mut tools::cargo(&["build", "--release", "--package", "foton"]))?;
    let foton = tools::target_dir().join("release").join(format!("foton{}", env::consts::EXE_SUFFIX));
    let folder = tools::target_dir().join("bench");
    fs::create_dir_all(&folder).map_err(|cause| Trouble::Failed(format!("{}: {cause}", folder.display())))?;
    let reference = folder.join("reference.exr");
    let passes = REFERENCE_PASSES.to_string();
    render(&foton, &reference, &["--seed", "99", "--passes", &passes])?;
    for threads in ["2", "1"] {
        let image = folder.join("image.exr");
        let passes = PASSES.to_string();
        let settings = ["--threads", threads, "--passes", &passes];
        let run = render(&foton, &image, &settings)?;
        // One pixel touches next to no cell: the same photon paths without deposits, lookups and sorting.
        let bare = render(&foton, &folder.join("bare.exr"), &[&settings[..], &["--size", "1x1"]].concat())?;
        println!(
            "\n{SCENE}, 512x512, radius {RADIUS}, {PASSES} passes of {PHOTONS} photons, {threads} threads"
        );
        report(&run, &bare);
        let error = Command::new(&foton).arg("compare").args([&image, &reference]).output();
        let error = error.map_err(|cause| Trouble::Failed(cause.to_string()))?;
        println!("image {:016x}", hash(&fs::read(&image).unwrap_or_default()));
        println!(
            "against {REFERENCE_PASSES} passes of another seed:\n{}",
            String::from_utf8_lossy(&error.stdout)
        );
    }
    Ok(())
}

fn render(foton: &Path, output: &Path, settings: &[&str]) -> Result<Run, Trouble> {
    let photons = PHOTONS.to_string();
    let mut command = Command::new(foton);
    command.current_dir(tools::root()).args(["render", SCENE, "-o"]).arg(output);
    command.args(["--json", "--spp", "1", "--radius", RADIUS, "--photons", &photons]).args(settings);
    let result = command.output().map_err(|cause| Trouble::Failed(cause.to_string()))?;
    if !result.status.success() {
        return Err(Trouble::Failed(String::from_utf8_lossy(&result.stderr).into_owned()));
    }
    let lines = String::from_utf8_lossy(&result.stdout).into_owned();
    let events: Vec<Value> = lines.lines().filter_map(|line| serde_json::from_str(line).ok()).collect();
    let of = |kind: &str| events.iter().filter(|e| e["event"] == kind).cloned().collect::<Vec<_>>();
    let done =
        of("done").pop().ok_or_else(|| Trouble::Failed("the render did not say it was done".into()))?;
    Ok(Run { passes: of("pass"), done })
}

impl Run {
    fn stage(&self, name: &str) -> f64 {
        self.done["stages"][name].as_f64().unwrap_or(0.0)
    }

    /// Seconds in passes.
    fn in_passes(&self) -> f64 {
        PER_PASS.iter().map(|stage| self.stage(stage)).sum()
    }

    /// Sum of a number that each pass reports.
    fn sum(&self, name: &str) -> f64 {
        self.passes.iter().filter_map(|p| p[name].as_f64()).sum()
    }

    /// How fast a running total grew after the warm-up, a second.
    fn steady(&self, name: &str) -> f64 {
        let (Some(from), Some(to)) = (self.passes.get(WARM_UP as usize - 1), self.passes.last()) else {
            return 0.0;
        };
        let number = |p: &Value, n: &str| p[n].as_f64().unwrap_or(0.0);
        (number(to, name) - number(from, name)) / (number(to, "seconds") - number(from, "seconds"))
    }
}

fn report(run: &Run, bare: &Run) {
    let whole = run.in_passes();
    println!("stage         seconds   share   ns a photon");
    let photons = run.done["photons"].as_f64().unwrap_or(1.0);
    for stage in PER_PASS {
        let seconds = run.stage(stage);
        println!(
            "{stage:<12} {seconds:>8.3} {:>6.1} % {:>10.1}",
            100.0 * seconds / whole,
            1e9 * seconds / photons
        );
    }
    let rays = run
        .passes
        .last()
        .map_or(0.0, |p| p["rays_per_s"].as_f64().unwrap_or(0.0) * p["seconds"].as_f64().unwrap_or(0.0));
    let (hit_points, eye) = (run.done["hit_points"].as_f64().unwrap_or(0.0), run.stage("eye_pass"));
    println!("after pass {WARM_UP}: {:.3} M photons/s", run.steady("photons") / 1e6);
    println!(
        "{:.2} rays a photon, {:.2} M rays/s while tracing",
        rays / photons,
        rays / run.stage("trace") / 1e6
    );
    println!("{:.1} tests of a packet a photon stored", run.sum("candidates") / run.sum("stored"));
    println!("{:.2} hit points found a test", run.sum("accepted") / run.sum("candidates"));
    println!(
        "efficiency {:.1} %: tracing alone takes {:.3} s",
        100.0 * bare.stage("trace") / whole,
        bare.stage("trace")
    );
    println!("eye pass {eye:.3} s, {:.2} M rays/s", run.done["eye_rays"].as_f64().unwrap_or(0.0) / eye / 1e6);
    let bytes = run.passes.last().and_then(|p| p["bytes"].as_f64()).unwrap_or(0.0);
    println!("{:.1} MiB held, {hit_points} hit points", bytes / f64::from(1 << 20));
}

/// FNV-1a.
fn hash(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |h, &b| (h ^ u64::from(b)).wrapping_mul(0x0100_0000_01b3))
}
