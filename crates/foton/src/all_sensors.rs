//! `foton render --sensor all`: one scene through each of its cameras, with photons that all of them share where the method has any.

use std::path::PathBuf;
use std::sync::Arc;

use foton_film::check_writable;
use foton_integrator::{Method, Render, RenderSettings};
use foton_scene::Scene;
use foton_session::snapshot::{self, Format};
use foton_session::{Interrupt, SceneIdentity, Session, StopRule, Views};
use serde_json::json;

use crate::args::RenderArgs;
use crate::console::{Console, Failure};
use crate::figure::percent;
use crate::interrupts::{begin_step, say_limit};
use crate::memory;
use crate::opening::refuse_beyond_memory;
use crate::writing::{Content, Output, finish};

/// Renders through all cameras, each until `rule` says stop.
pub(crate) fn render(
    args: &RenderArgs,
    (scene, identity): (&Arc<Scene>, &SceneIdentity),
    settings: &RenderSettings,
    (rule, interrupt): (&StopRule, &Interrupt),
    console: &Console,
) -> Result<(), Failure> {
    let outputs = outputs(args, scene);
    outputs.iter().try_for_each(|path| check_writable(path))?;
    let layers = if args.output.1 == Format::Exr { &args.layers[..] } else { &[] };
    let content = Content { layers, shown: args.shown(), look: args.look(), identity };
    console.of_settings(scene, settings);
    if settings.method == Method::Ppm {
        return together(args, scene, settings, (rule, interrupt), (&outputs, &content), console);
    }
    for (sensor, path) in outputs.into_iter().enumerate() {
        console.line(&format!("camera {}", scene.sensors()[sensor].name));
        let settings = RenderSettings { sensor, ..settings.clone() };
        let threads = args.settings.threads.map(usize::from);
        refuse_beyond_memory(scene, &settings, threads, args.memory)?;
        begin_step("collecting hit points");
        let mut session = Session::start(Arc::clone(scene), settings, threads, interrupt.cancel())?;
        interrupt.begin_passes();
        say_limit(session.run(rule, interrupt, &mut |progress| console.pass(progress, rule)), console);
        let output = Output { path, format: args.output.1, is_new: false };
        finish(&session, &[output], &content, Vec::new(), console)?;
        if interrupt.is_requested() {
            break;
        }
    }
    Ok(())
}

/// Renders through all of them at once, and writes what each sees.
fn together(
    args: &RenderArgs,
    scene: &Arc<Scene>,
    settings: &RenderSettings,
    (rule, interrupt): (&StopRule, &Interrupt),
    (outputs, content): (&[PathBuf], &Content<'_>),
    console: &Console,
) -> Result<(), Failure> {
    let threads = args.settings.threads.map(usize::from);
    let sensors: Vec<usize> = (0..scene.sensors().len()).collect();
    let memory = Views::estimate_memory(scene, settings, &sensors, threads);
    if let Some(why) = memory.and_then(|takes| takes.refusal(memory::limit(args.memory))) {
        return Err(Failure::Memory(why));
    }
    begin_step("collecting hit points");
    console.stage("collecting hit points");
    let interrupted = || Failure::Interrupted("rendering");
    let views = Views::start(scene, settings, &sensors, threads, interrupt.cancel())?;
    let mut views = views.ok_or_else(interrupted)?;
    interrupt.begin_passes();
    let cause = views.run(rule, interrupt, &mut |progress| console.pass(progress, rule));
    say_limit(cause, console);
    console.end();
    let Some(renders) = views.renders() else {
        let fault = views.panic().cloned();
        return Err(fault.map_or_else(interrupted, |panic| Failure::Panicked { panic, passes: None }));
    };
    // One that cannot be written does not keep the others from it.
    let mut unwritten = None;
    for (render, path) in renders.iter().zip(outputs) {
        match content.write(path, args.output.1, render) {
            Ok(()) => say(render, path, views.elapsed().as_secs_f64(), args, console),
            Err(error) => unwritten = Some(error),
        }
    }
    console.losses(&renders[0]);
    let paths: Vec<String> = outputs.iter().map(|path| path.display().to_string()).collect();
    console.event(&json!({ "event": "done", "outputs": paths }));
    unwritten.map_or(Ok(()), |error| Err(error.into()))
}

fn say(render: &Render, path: &std::path::Path, seconds: f64, args: &RenderArgs, console: &Console) {
    let (name, passes) = (&render.scene().sensors()[render.settings().sensor].name, render.passes());
    let error = render.error().map(|error| error.total);
    if args.json {
        console.event(&json!({
            "event": "view", "sensor": name, "passes": passes, "seconds": seconds, "error": error,
            "output": path.display().to_string(),
        }));
        return;
    }
    let error = error.map_or_else(String::new, |error| format!(", error {}", percent(error)));
    console.line(&format!("camera {name}: {passes} passes{error}; wrote {}", path.display()));
}

/// Where the image of each camera goes: `OUT-NAME.exr`.
pub(crate) fn outputs(args: &RenderArgs, scene: &Scene) -> Vec<PathBuf> {
    let names = file_names(scene.sensors().iter().map(|sensor| sensor.name.as_str()));
    names.iter().map(|name| snapshot::suffixed(&args.output.0, name)).collect()
}

/// Names as parts of file names, each another one, on file systems too that know no capitals.
fn file_names<'a>(names: impl Iterator<Item = &'a str>) -> Vec<String> {
    let clean = |name: &str| {
        let keep = |c: char| if c.is_alphanumeric() || matches!(c, '.' | '_' | '-') { c } else { '-' };
        let kept: String = name.chars().take(100).map(keep).collect();
        let kept = kept.trim_matches(['-', '.']).to_owned();
        if kept.is_empty() { "camera".to_owned() } else { kept }
    };
    let mut all: Vec<String> = Vec::new();
    for name in names.map(clean) {
        let is_taken = |name: &str| all.iter().any(|other| other.to_lowercase() == name.to_lowercase());
        let numbered = (2..).map(|n| format!("{name}-{n}"));
        let free = std::iter::once(name.clone()).chain(numbered).find(|name| !is_taken(name));
        all.extend(free);
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_that_are_no_file_names_are_cleaned_and_told_apart() {
        let names = ["front", "from above", "from/above", "..", "Front", "front-2", "-", "küche"];
        let cleaned = file_names(names.into_iter());
        let expected =
            ["front", "from-above", "from-above-2", "camera", "Front-2", "front-2-2", "camera-2", "küche"];
        assert_eq!(cleaned, expected);
    }
}
