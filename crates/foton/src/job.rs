//! `foton render`: one scene to one image, and to more on the way.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use foton_film::{check_writable, write_spare};
use foton_format::{Opened, Options, Severity};
use foton_input::quoted;
use foton_integrator::{
    Cancel, LayerKind, MemoryEstimate, PpmSettings, Render, RenderSettings, SettingChange,
};
use foton_scene::description::SceneDescription;
use foton_scene::{BuildOptions, Scene};
use foton_session::snapshot::{self, Format};
use foton_session::{Interrupt, Preset, SceneIdentity, Session, StopCause, StopRule, checkpoint};

use crate::args::{ErrorWish, Radius, RenderArgs, Size};
use crate::console::{Console, Failure};
use crate::memory;
use crate::roles::Roles;
use crate::settings;
use crate::signals;

/// How long a render without a stop rule takes.
const DEFAULT_TIME: Duration = Duration::from_secs(60);

/// A shape that is fewer steps of single precision across is worth a warning: its outline is off by a hundredth of its size.
const MIN_STEPS: f32 = 100.0;

/// Runs `foton render`.
pub(crate) fn render(args: &RenderArgs, console: &mut Console) -> Result<(), Failure> {
    let (path, format) = &args.output;
    check_writable(path)?;
    args.checkpoint.as_deref().map_or(Ok(()), check_writable)?;
    if let Some(every) = args.every {
        check_writable(&snapshot::numbered(path, every.first()))?;
    }
    let interrupt = interrupt_on_signals(console);
    console.begin();
    let opened = open(&args.scene, &args.defines, args.memory, interrupt.cancel())?;
    refuse_two_roles(args.roles(), &opened)?;
    let name = args.scene.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let sensor = choose_sensor(&opened, args.sensor.as_deref())?;
    let suggested = opened.suggested;
    let bounds = (args.size, args.memory);
    let (scene, identity) = build(opened, &name, sensor, bounds, console, interrupt.cancel())?;
    let base = settings::base(&suggested, args.preset.map(Preset::from));
    let (radius, radius_scale) = Radius::split(args.radius, base.ppm.radius, base.ppm.radius_scale);
    let settings = RenderSettings {
        samples_per_pixel: args.spp,
        max_depth: args.max_depth,
        seed: args.seed,
        sensor,
        layers: args.layers.iter().any(|l| l.needs_classes()),
        error: args.error != Some(ErrorWish::Off) || args.layers.iter().any(|l| l.needs_error()),
        ppm: PpmSettings {
            alpha: args.alpha.unwrap_or(base.ppm.alpha),
            photons_per_pass: args.photons.unwrap_or(base.ppm.photons_per_pass),
            radius,
            radius_scale,
            radius_floor: args.radius_floor,
            radius_rule: args.radius_rule.into(),
            direct_light: args.direct.into(),
            ..base.ppm
        },
        ..base
    };
    let error = match args.error {
        Some(ErrorWish::Below(share)) => Some(share),
        Some(ErrorWish::Off) | None => None,
    };
    let mut rule = StopRule { passes: args.passes, time: args.time, error };
    if rule == StopRule::default() {
        if let Some(passes) = suggested.passes {
            rule.passes = Some(passes.into());
            console.line(&format!("no --passes, --time or --error: {passes} passes, as the scene file says"));
        } else {
            rule.time = Some(DEFAULT_TIME);
            console.line("no --passes, --time or --error: rendering for 60 s");
        }
    }
    let largest = scene.normalisation().world_length(2.0 * f64::from(scene.bounds().radius()));
    if settings.ppm.radius.is_some_and(|r| r > largest) {
        console.warning(&format!("--radius is larger than the whole scene and is cut to that, {largest:.4}"));
    }
    let threads = args.threads.map(usize::from);
    refuse_beyond_memory(&scene, &settings, threads, args.memory)?;
    console.stage("collecting hit points");
    let mut session = Session::start(scene, settings, threads, interrupt.cancel())?;
    interrupt.begin_passes();
    if args.strict {
        session.render_mut().stop_at_first_not_finite();
    }
    if let Some(path) = &args.resume {
        checkpoint::resume(path, &mut session, &identity)?;
        if args.strict && session.render().ledger().dropped > 0 {
            return Err(Failure::LeftOut { path: path.clone(), values: session.render().ledger().dropped });
        }
        go_on(args, path, &mut session, &rule, console);
        // Passes may be larger than a render from the beginning would have had them.
        refuse_beyond_memory(session.render().scene(), session.render().settings(), threads, args.memory)?;
    }
    let mut keeper = Keeper::new(args, session.elapsed());
    let layers = if *format == Format::Exr { &args.layers[..] } else { &[] };
    let mut outputs = Vec::new();
    let cause = session.run(&rule, &interrupt, &mut |progress| {
        console.pass(progress, &rule);
        if args.every.is_some_and(|e| e.is_due(progress.report.pass)) {
            let path = snapshot::numbered(path, progress.report.pass);
            match snapshot::write(&path, *format, progress.render, layers, &identity) {
                Ok(()) => outputs.push(path.display().to_string()),
                // The passes are still there for the next image.
                Err(error) => console.warning(&format!("an image on the way is missing: {error}")),
            }
        }
        if keeper.is_due(progress.elapsed) {
            keeper.keep(progress.render, progress.elapsed, progress.rays, &identity, console);
        }
    });
    say_limit(cause, console);
    // After a fault hit points may be half-way between two passes: the last checkpoint is the one to go on from.
    if session.panic().is_none() && session.not_finite().is_none() {
        keeper.keep_last(&session, &identity, console);
    }
    finish(&session, &[(path.clone(), *format)], layers, &identity, outputs, console)
}

/// Says where a render goes on from. Of what is asked for by name, that which may change between passes changes with the next one;
/// all else is as in the checkpoint, or it would not have been resumed.
fn go_on(args: &RenderArgs, path: &Path, session: &mut Session, rule: &StopRule, console: &Console) {
    let passes = session.render().passes();
    console.line(&format!("going on from {} after {passes} passes", path.display()));
    let preset = args.preset.map(|preset| Preset::from(preset).apply(RenderSettings::default()));
    let alpha = args.alpha.or(preset.as_ref().map(|p| p.ppm.alpha));
    let photons = args.photons.or(preset.as_ref().map(|p| p.ppm.photons_per_pass));
    let now = session.render().settings();
    let changes = [
        alpha.filter(|&alpha| alpha != now.ppm.alpha).map(SettingChange::Alpha),
        photons.filter(|&photons| photons != now.ppm.photons_per_pass).map(SettingChange::PhotonsPerPass),
    ];
    for change in changes.into_iter().flatten() {
        session.render_mut().change(change);
        console.line(&format!("{change} from pass {} on", passes + 1));
    }
    if rule.is_reached(passes, session.elapsed(), Duration::ZERO, session.render().error().as_ref()) {
        console.warning(&format!(
            "the checkpoint has {passes} passes in {:.1} s and is past --passes, --time or --error already, which count from its \
             beginning: nothing is added",
            session.elapsed().as_secs_f64()
        ));
    }
}

/// Writes checkpoints when they are due.
struct Keeper<'a> {
    path: Option<&'a Path>,
    every: Duration,
    last: Duration,
}

impl<'a> Keeper<'a> {
    fn new(args: &'a RenderArgs, elapsed: Duration) -> Self {
        Self { path: args.checkpoint.as_deref(), every: args.checkpoint_every, last: elapsed }
    }

    fn is_due(&self, elapsed: Duration) -> bool {
        self.path.is_some() && elapsed.saturating_sub(self.last) >= self.every
    }

    /// Writes one, if they were asked for. One that cannot be written is a warning: the render goes on.
    fn keep(
        &mut self,
        render: &Render,
        elapsed: Duration,
        rays: u64,
        scene: &SceneIdentity,
        console: &Console,
    ) {
        let Some(path) = self.path.filter(|_| render.passes() > 0) else { return };
        self.last = elapsed;
        if let Err(error) = checkpoint::write(path, render, elapsed, rays, scene) {
            console.warning(&format!("no checkpoint: {error}"));
        }
    }

    /// Writes the last one, in another place if need be: there is no next one that could make up for it.
    fn keep_last(&self, session: &Session, scene: &SceneIdentity, console: &Console) {
        let Some(path) = self.path.filter(|_| session.render().passes() > 0) else { return };
        let write =
            |path: &Path| checkpoint::write(path, session.render(), session.elapsed(), session.rays(), scene);
        if let Err(error) = write(path) {
            let instead = write_spare(path, write)
                .map_or_else(String::new, |spare| format!("; the state is in {} instead", spare.display()));
            console.warning(&format!("no checkpoint: {error}{instead}"));
        }
    }
}

/// Refuses to write to a file that the scene was read from.
pub(crate) fn refuse_two_roles(roles: Roles, opened: &Opened) -> Result<(), Failure> {
    roles.scene_reads(&opened.files).clash().map_or(Ok(()), |clash| Err(Failure::Roles(clash)))
}

/// Says that a limit of the system ended a render, if one did.
pub(crate) fn say_limit(cause: StopCause, console: &Console) {
    if let Some(why) = signals::limit().filter(|_| cause == StopCause::Interrupted) {
        console.warning(&format!("the render ends early: {why}"));
    }
}

/// Reads a scene within that many bytes, or what the system leaves.
pub(crate) fn open(
    scene: &Path,
    defines: &[(String, String)],
    memory: Option<u64>,
    cancel: &Cancel,
) -> Result<Opened, Failure> {
    let memory = memory::limit(memory).map(|b| b as u64);
    let options = Options { defines: defines.to_vec(), memory, cancel: cancel.clone() };
    foton_format::open(scene, &options).map_err(Failure::of_open)
}

/// Builds the scene, at another size if one is asked for and within that many bytes, and says what its file got wrong and what is
/// too far away for it, seen from a sensor.
pub(crate) fn build(
    mut opened: Opened,
    name: &str,
    sensor: usize,
    (size, memory): (Option<Size>, Option<u64>),
    console: &Console,
    cancel: &Cancel,
) -> Result<(Arc<Scene>, SceneIdentity), Failure> {
    for finding in &opened.warnings {
        console.finding(finding);
    }
    let identity = SceneIdentity { name: name.to_owned(), hash: opened.source_hash };
    if let Some(Size { width, height }) = size {
        for sensor in &mut opened.description.sensors {
            sensor.resize(width, height);
        }
    }
    refuse_to_build(&opened.description, memory)?;
    let tell = console.building();
    let options = BuildOptions { cancel: cancel.clone(), tell: Some(&tell), ..BuildOptions::default() };
    let scene = Scene::build_with(&opened.description, &options)
        .map_err(|cause| Failure::of_build(&opened, name, &cause))?;
    let census = scene.census();
    if census.degenerate_triangles > 0 {
        console.warning(&format!("left out {} triangles without area", census.degenerate_triangles));
    }
    for shape in scene.shapes().iter().filter(|s| s.steps_across < MIN_STEPS) {
        console.warning(&format!(
            "{} is only {:.0} steps of single precision across, so small is it where it stands: its shape is rounded to those",
            quoted(&shape.name),
            shape.steps_across
        ));
    }
    for far in scene.far_things(sensor) {
        console.finding(&opened.finding(Severity::Warning, name, Some(&far.name), far.to_string()));
    }
    for [over, under] in scene.hidden_shapes() {
        let [over, under] = [over, under].map(|shape| quoted(&scene.shapes()[shape as usize].name));
        console.warning(&format!(
            "{under} lies exactly in {over}, which hides it there: what is opaque counts before masks, then the first in the file"
        ));
    }
    let lobes = lobe_use(&scene);
    if lobes.specular_gloss {
        console.note("gloss of roughness up to 0.1 is followed in directions chosen once: its noise stays; --spp lowers it");
    }
    if lobes.highlights_by_photons {
        console.note(
            "light of points, spots and suns that mirrors or glass throw on such gloss comes as photons: the narrower, the noisier",
        );
    }
    if census.emitters == 0 {
        console.warning("nothing in the scene emits light: the image will be black");
    }
    Ok((Arc::new(scene), identity))
}

/// The index of the sensor of that name; the first without one.
pub(crate) fn choose_sensor(opened: &Opened, name: Option<&str>) -> Result<usize, Failure> {
    let Some(name) = name else { return Ok(0) };
    let sensors = &opened.description.sensors;
    sensors.iter().position(|s| s.name == name).ok_or_else(|| Failure::Sensor {
        asked: name.to_owned(),
        known: sensors.iter().map(|s| s.name.clone()).collect(),
    })
}

/// Looks before it leaps: a render that would not fit is refused with the numbers.
pub(crate) fn refuse_beyond_memory(
    scene: &Scene,
    settings: &RenderSettings,
    threads: Option<usize>,
    asked: Option<u64>,
) -> Result<(), Failure> {
    let refusal = Session::estimate_memory(scene, settings, threads).refusal(memory::limit(asked));
    refusal.map_or(Ok(()), |why| Err(Failure::Memory(why)))
}

/// Refuses a scene whose building alone would take more than may be used: bytes asked for, or the system's.
pub(crate) fn refuse_to_build(description: &SceneDescription, asked: Option<u64>) -> Result<(), Failure> {
    let takes = description.build_bytes() as f64 + MemoryEstimate::PROGRAM_BYTES;
    match memory::limit(asked) {
        Some(limit) if takes > limit => Err(Failure::BuildMemory { takes, limit }),
        _ => Ok(()),
    }
}

/// Ctrl-C, SIGTERM and the limits of the system end the render after its pass; a second one discards the pass. Before there are passes
/// one is enough.
pub(crate) fn interrupt_on_signals(console: &Console) -> Interrupt {
    let interrupt = Interrupt::while_loading();
    let handler = interrupt.clone();
    if let Err(error) = signals::on_end(move || handler.request()) {
        console.warning(&format!("Ctrl-C will not be handled: {error}"));
    }
    interrupt
}

/// Writes the last images and says so.
pub(crate) fn finish(
    session: &Session,
    files: &[(PathBuf, Format)],
    layers: &[LayerKind],
    identity: &SceneIdentity,
    mut outputs: Vec<String>,
    console: &Console,
) -> Result<(), Failure> {
    let fault = |passes: Option<u64>| {
        let panic = session.panic().cloned().map(|panic| Failure::Panicked { panic, passes });
        panic.or_else(|| {
            session.not_finite().cloned().map(|place| Failure::NotFinite { place: Box::new(place), passes })
        })
    };
    if session.render().passes() == 0 {
        // Without a fault it was interrupted twice in the first pass: there is no picture yet.
        return Err(fault(None).unwrap_or(Failure::Interrupted("rendering the first pass")));
    }
    if let Some(panic) = session.panic().filter(|p| !p.leaves_the_image_whole()) {
        return Err(Failure::Panicked { panic: panic.clone(), passes: None });
    }
    // One that cannot be written does not keep the others from it.
    let mut unwritten = None;
    for (path, format) in files {
        match snapshot::write(path, *format, session.render(), layers, identity) {
            Ok(()) => outputs.push(path.display().to_string()),
            Err(error) => {
                match rescue(path, *format, session, layers, identity) {
                    Some((what, spare)) => {
                        console.warning(&format!("{error}; the {what} is {} instead", spare.display()));
                        outputs.push(spare.display().to_string());
                    }
                    None => console.warning(&format!("{error}; nor can it be written anywhere else")),
                }
                if let Some(earlier) = unwritten.replace(error) {
                    console.warning(&earlier.to_string());
                }
            }
        }
    }
    console.check_ledger(session.render());
    console.check_lights(session.render());
    console.done(session, &outputs);
    if let Some(error) = unwritten {
        return Err(error.into());
    }
    fault(Some(session.render().passes())).map_or(Ok(()), Err)
}

/// Writes an image that cannot be written where it was asked for beside that place, or into the system's folder for temporary files:
/// hours of rendering are not lost with a folder. What an image cannot hold is left out; the state of the render comes last. Says what
/// was written and where; `None` where there is no room for any.
fn rescue(
    path: &Path,
    format: Format,
    session: &Session,
    layers: &[LayerKind],
    identity: &SceneIdentity,
) -> Option<(&'static str, PathBuf)> {
    let render = session.render();
    let image = write_spare(path, |path| snapshot::write(path, format, render, layers, identity));
    let image = image.or_else(|| {
        let path = path.with_extension("exr");
        write_spare(&path, |path| snapshot::write(path, Format::Exr, render, &[], identity))
    });
    let state = || {
        let path = path.with_extension("checkpoint");
        write_spare(&path, |path| {
            checkpoint::write(path, render, session.elapsed(), session.rays(), identity)
        })
    };
    image.map(|image| ("image", image)).or_else(|| Some(("state of the render", state()?)))
}
