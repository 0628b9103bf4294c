//! `foton render --integrator all`: one scene by each method for the same time, as a contact sheet and a table.

use std::path::PathBuf;
use std::sync::Arc;

use foton_film::{Image, Metadata, read_exr_within, write_exr, write_png};
use foton_integrator::{LayerKind, Method, RenderSettings};
use foton_measure::{CompareError, Pair, Panel, contact_sheet, without_bright_emitters};
use foton_scene::Scene;
use foton_session::snapshot::Format;
use foton_session::{Interrupt, SceneIdentity, Session, Shown, StopCause, StopRule};
use serde_json::json;

use crate::args::RenderArgs;
use crate::console::{Console, Failure};
use crate::figure::percent;
use crate::interrupts::begin_step;
use crate::memory;
use crate::opening::refuse_beyond_memory;
use crate::writing::Content;

/// What one method came to.
struct Outcome {
    method: Method,
    image: Image,
    /// What is seen of emitters.
    emission: Option<Image>,
    passes: u64,
    seconds: f64,
    /// Its own estimate.
    error: Option<f64>,
    output: PathBuf,
}

/// Renders a scene by each method, one after the other, each until `rule` says stop.
pub(crate) fn render(
    args: &RenderArgs,
    (scene, identity): (&Arc<Scene>, &SceneIdentity),
    settings: impl Fn(Method) -> RenderSettings,
    (rule, interrupt): (&StopRule, &Interrupt),
    console: &Console,
) -> Result<(), Failure> {
    let reference =
        args.reference.as_deref().map(|path| read_exr_within(path, memory_of_an_image())).transpose()?;
    if let Some((image, _)) = &reference {
        check_size(image, scene, settings(Method::default()).sensor)?;
    }
    let mut outcomes = Vec::new();
    for method in Method::ALL {
        console.line(&format!("{} ({})", method.title(), method.name()));
        let outcome = by(args, method, (scene, identity), settings(method), (rule, interrupt), console)?;
        outcomes.extend(outcome);
        if interrupt.is_requested() {
            break;
        }
    }
    let errors = differences(&outcomes, reference.as_ref().map(|(image, _)| image))?;
    report(&outcomes, &errors, args, console);
    write_sheet(&outcomes, &errors, args)?;
    Ok(())
}

/// Refuses a reference of another size before anything is rendered.
fn check_size(reference: &Image, scene: &Scene, sensor: usize) -> Result<(), Failure> {
    let sensor = &scene.sensors()[sensor];
    let (a, b) = ((sensor.width, sensor.height), (reference.width, reference.height));
    if a == b {
        return Ok(());
    }
    Err(Failure::Compare {
        a: "the render".to_owned(),
        b: "the reference".to_owned(),
        cause: CompareError::Sizes { a, b },
    })
}

fn memory_of_an_image() -> Option<u64> {
    memory::limit(None).map(|bytes| (bytes * 0.25) as u64)
}

/// Renders by one method and writes its image; `None` if it was interrupted before the first pass.
fn by(
    args: &RenderArgs,
    method: Method,
    (scene, identity): (&Arc<Scene>, &SceneIdentity),
    settings: RenderSettings,
    (rule, interrupt): (&StopRule, &Interrupt),
    console: &Console,
) -> Result<Option<Outcome>, Failure> {
    let threads = args.settings.threads.map(usize::from);
    refuse_beyond_memory(scene, &settings, threads, args.memory)?;
    console.of_settings(scene, &settings);
    begin_step("collecting hit points");
    let mut session = Session::start(Arc::clone(scene), settings, threads, interrupt.cancel())?;
    interrupt.begin_passes();
    let cause = session.run(rule, interrupt, &mut |progress| console.pass(progress, rule));
    let render = session.render();
    if render.passes() == 0 {
        return match cause {
            StopCause::Interrupted => Ok(None),
            _ => Err(Failure::Method { method: method.name() }),
        };
    }
    let output = args.image_of(method);
    Content { layers: &[], shown: Shown::All, look: args.look(), identity }.write(
        &output,
        Format::Exr,
        render,
    )?;
    Ok(Some(Outcome {
        method,
        image: render.image(),
        emission: render.colour_layer(LayerKind::Emission),
        passes: render.passes(),
        seconds: session.elapsed().as_secs_f64(),
        error: render.error().map(|error| error.total),
        output,
    }))
}

/// Index of the outcome that the others are compared with where there is no reference: of the methods that find all light, the one
/// that says its error is the smallest.
fn best(outcomes: &[Outcome]) -> Option<usize> {
    let known = outcomes.iter().enumerate().filter(|(_, o)| o.method.finds_all_light());
    let error = |o: &Outcome| o.error.unwrap_or(f64::INFINITY);
    known.min_by(|a, b| error(a.1).total_cmp(&error(b.1))).map(|(i, _)| i)
}

/// Relative root mean square difference of each outcome from the reference, or from the best; `None` for that one.
fn differences(outcomes: &[Outcome], reference: Option<&Image>) -> Result<Vec<Option<f64>>, Failure> {
    let best = if reference.is_some() { None } else { best(outcomes) };
    let Some(truth) = reference.or_else(|| best.map(|i| &outcomes[i].image)) else {
        return Ok(vec![None; outcomes.len()]);
    };
    let emission = outcomes.iter().find_map(|outcome| outcome.emission.as_ref());
    let emission = emission.filter(|emission| emission.pixels.len() == truth.pixels.len());
    let counts = emission.map(|emission| without_bright_emitters(emission, truth));
    let of = |(i, outcome): (usize, &Outcome)| {
        if best == Some(i) {
            return Ok(None);
        }
        let pair = Pair::new(&outcome.image, truth).map_err(|cause| Failure::Compare {
            a: outcome.method.name().to_owned(),
            b: "the reference".to_owned(),
            cause,
        })?;
        Ok(Some(pair.trimmed_rmse(|pixel| counts.as_ref().is_none_or(|counts| counts[pixel]))))
    };
    outcomes.iter().enumerate().map(of).collect()
}

fn shown(value: Option<f64>) -> String {
    value.map_or_else(|| "-".to_owned(), percent)
}

fn report(outcomes: &[Outcome], errors: &[Option<f64>], args: &RenderArgs, console: &Console) {
    if args.json {
        for (outcome, error) in outcomes.iter().zip(errors) {
            console.event(&json!({
                "event": "method", "integrator": outcome.method.name(), "passes": outcome.passes, "seconds": outcome.seconds,
                "error": outcome.error, "difference": error, "output": outcome.output.display().to_string(),
            }));
        }
        let images = outcomes.iter().map(|o| &o.output).chain([&args.output.0]);
        let outputs: Vec<String> = images.map(|path| path.display().to_string()).collect();
        console.event(&json!({ "event": "done", "outputs": outputs }));
        return;
    }
    let reference = match (&args.reference, best(outcomes)) {
        (Some(path), _) => path.display().to_string(),
        (None, Some(i)) => outcomes[i].method.name().to_owned(),
        (None, None) => "nothing".to_owned(),
    };
    console.line(&format!(
        "{:<12}{:>8}{:>10}{:>16}   differs from {reference} by",
        "method", "passes", "seconds", "own estimate"
    ));
    for (outcome, error) in outcomes.iter().zip(errors) {
        console.line(&format!(
            "{:<12}{:>8}{:>10.1}{:>16}   {}",
            outcome.method.name(),
            outcome.passes,
            outcome.seconds,
            shown(outcome.error),
            shown(*error)
        ));
    }
    console.line(&format!("wrote {} and an EXR for each method beside it", args.output.0.display()));
}

fn write_sheet(outcomes: &[Outcome], errors: &[Option<f64>], args: &RenderArgs) -> Result<(), Failure> {
    let panels: Vec<Panel<'_>> = outcomes.iter().zip(errors).map(|(o, error)| panel(o, *error)).collect();
    let (sheet, (path, format), look) = (contact_sheet(&panels), &args.output, args.look());
    let metadata = Metadata::default();
    match format {
        Format::Exr => write_exr(path, &sheet, &[], &metadata)?,
        Format::Png => write_png(path, &sheet, look.tone_map, look.exposure_stops, &metadata)?,
    }
    Ok(())
}

fn panel(outcome: &Outcome, difference: Option<f64>) -> Panel<'_> {
    let error = match difference {
        Some(difference) => format!("differs by {}", percent(difference)),
        None => format!("error {}", shown(outcome.error)),
    };
    let figures = format!("{:.1} s, {} passes, {error}", outcome.seconds, outcome.passes);
    Panel { image: &outcome.image, caption: vec![outcome.method.title().to_owned(), figures] }
}
