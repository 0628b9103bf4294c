//! One render by a program, watched from outside: its images, and the processor seconds after which it had them.

use std::fs;
use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};

use foton_film::{Image, read_exr};
use serde_json::Value;

use super::options::{Options, Program};
use super::scenes::SceneFile;
use crate::rig;

/// Renders until so many processor seconds have gone by. Images are those after powers of two of passes, and the last.
pub(super) fn course(
    program: &Program,
    scene: &SceneFile,
    options: &Options,
    photon_seed: u64,
    seconds: f64,
) -> Result<Vec<(f64, Image)>, String> {
    let folder = rig::target().join(format!("bench/to-error-{}", std::process::id()));
    fs::create_dir_all(&folder).map_err(text)?;
    let [width, height] = scene.size(options.width);
    let mut command = Command::new(&program.path);
    command.arg("render").arg(&scene.path).arg("-o").arg(folder.join("x.exr"));
    command.args(["--json", "--every", "pow2", "--passes", "1000000000"]);
    command.args(["--size", &format!("{width}x{height}"), "--spp", &options.samples.to_string()]);
    command.args(program.seeds(photon_seed)).args(&program.options);
    let spent = watch(&mut command, seconds)?;
    let mut points = Vec::new();
    for (i, (pass, seconds)) in spent.iter().enumerate() {
        let on_the_way = folder.join(format!("x-{pass:06}.exr"));
        let path = if i + 1 == spent.len() { folder.join("x.exr") } else { on_the_way };
        if path.exists() {
            points.push((*seconds, read_exr(&path).map_err(text)?.0));
        }
    }
    fs::remove_dir_all(&folder).map_err(text)?;
    if points.is_empty() {
        return Err(format!("{}: no image of {}", program.path.display(), scene.path.display()));
    }
    Ok(points)
}

/// Runs a render and interrupts it; the passes that it told of, and the processor seconds up to each.
fn watch(command: &mut Command, limit: f64) -> Result<Vec<(u64, f64)>, String> {
    let mut child =
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::null()).spawn().map_err(text)?;
    let id = child.id();
    let mut spent = Vec::new();
    let (mut interrupted, mut error) = (false, None);
    for line in BufReader::new(child.stdout.take().expect("it is piped")).lines() {
        let event: Value = serde_json::from_str(&line.map_err(text)?).map_err(text)?;
        match (event["event"].as_str(), event["pass"].as_u64()) {
            (Some("pass"), Some(pass)) => {
                let Some(seconds) = rig::processor_seconds(id) else { continue };
                spent.push((pass, seconds));
                if seconds >= limit && !interrupted {
                    interrupted = true;
                    Command::new("kill").args(["-INT", &id.to_string()]).status().map_err(text)?;
                }
            }
            (Some("error"), _) => error = event["message"].as_str().map(str::to_owned),
            _ => {}
        }
    }
    child.wait().map_err(text)?;
    error.map_or(Ok(spent), Err)
}

pub(super) fn text(error: impl ToString) -> String {
    error.to_string()
}
