//! `foton measure`: what accuracy costs in a scene, as tables and a page in a folder.

use foton_film::read_exr_within;
use foton_measure::sweep::{Event, Outcome, Sweep};
use foton_session::{Session, StartError, StopCause};
use serde_json::json;

use crate::args::Measure;
use crate::console::{Console, Failure};
use crate::interrupts::{interrupt_on_signals, say_limit};
use crate::memory;
use crate::opening::{Bounds, build, choose_sensor, file_name, open, refuse_two_roles};
use crate::settings::SettingsBuilder;

/// Runs `foton measure`.
pub(crate) fn run(args: &Measure, console: &mut Console) -> Result<(), Failure> {
    let memory = memory::limit(None).map(|bytes| bytes as u64);
    let given = args.reference.as_deref().map(|path| read_exr_within(path, memory)).transpose()?;
    let interrupt = interrupt_on_signals(console);
    console.begin();
    let opened = open(&args.scene, &args.scene_options.read, None, console, interrupt.cancel())?;
    refuse_two_roles(args.roles(), &opened)?;
    let name = file_name(&args.scene);
    let sensor = choose_sensor(&opened, args.scene_options.sensor.as_deref())?;
    let suggested = opened.suggested;
    let bounds = Bounds { size: args.settings.size, ..Bounds::default() };
    let (scene, identity) = build(opened, &name, sensor, bounds, console, interrupt.cancel())?;
    let centre = SettingsBuilder::of_scene(&suggested).options(&args.settings).sensor(sensor).build();
    let given = given.map(|(image, _)| {
        let path = args.reference.as_deref().unwrap_or(&args.scene);
        (image, format!("the image {}", path.display()))
    });
    let sweep = Sweep {
        scene,
        name: scene_name(args),
        hash: identity.hash,
        centre,
        seeds: args.seeds,
        budget: args.budget,
        given,
        folder: args.output.clone(),
    };
    let pool = Session::pool(args.settings.threads.map(usize::from)).map_err(StartError::from)?;
    let needed = sweep.memory(pool.current_num_threads());
    let refusal = needed.and_then(|needed| needed.refusal(memory::limit(None)));
    if let Some(why) = refusal {
        return Err(Failure::Memory(why));
    }
    console.stage("collecting hit points");
    interrupt.begin_work();
    // What a part found is stored when it is done: one that is interrupted may as well end at once.
    let outcome = {
        let mut tell = |event: &Event| say(event, console);
        pool.install(|| sweep.run(&|| interrupt.is_requested(), interrupt.cancel(), &mut tell))
    };
    console.end();
    if interrupt.is_requested() {
        say_limit(StopCause::Interrupted, console);
    }
    conclude(&outcome?, interrupt.is_requested(), console);
    Ok(())
}

/// What headings call the scene: its folder's name where the file is one of many called `scene.xml`.
fn scene_name(args: &Measure) -> String {
    let stem = args.scene.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let folder = args.scene.parent().and_then(|folder| folder.file_name());
    folder.filter(|_| stem == "scene").map_or(stem, |folder| folder.to_string_lossy().into_owned())
}

fn say(event: &Event, console: &Console) {
    match event {
        Event::Progress { what, fraction } => console.progress(*fraction, what.clone()),
        Event::Reference { origin, noise, smooth_share } => {
            console.event(&json!({
                "event": "reference", "origin": origin, "noise": noise, "smooth_share": smooth_share,
            }));
            console.line(&format!("reference: {origin}; noise {:.2} %", 100.0 * noise));
        }
        Event::Job { photons, configurations, passes, least_error, is_old } => {
            console.event(&json!({
                "event": "job", "photons_per_pass": photons, "configurations": configurations, "passes": passes,
                "least_error": least_error, "was_finished": is_old,
            }));
            let old = if *is_old { " (finished before)" } else { "" };
            console.line(&format!(
                "{photons} photons a pass: {configurations} configurations, {passes} passes, least error {:.2} %{old}",
                100.0 * least_error
            ));
        }
        Event::Note(message) => console.note(message),
    }
}

fn conclude(outcome: &Outcome, interrupted: bool, console: &Console) {
    let outputs: Vec<String> = outcome.outputs.iter().map(|path| path.display().to_string()).collect();
    let (done, all) = outcome.jobs;
    console.event(&json!({
        "event": "done", "outputs": outputs, "recommendation": outcome.recommendation,
        "jobs_done": done, "jobs": all, "interrupted": interrupted,
    }));
    if interrupted {
        console
            .line(&format!("interrupted after {done} of {all} parts; the same command goes on from there"));
    }
    for path in &outputs {
        console.line(&format!("wrote {path}"));
    }
    if let Some(sentence) = &outcome.recommendation {
        console.line(sentence);
    }
}
