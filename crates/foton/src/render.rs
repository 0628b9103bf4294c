//! `foton render`: one scene to one image, and to more on the way.

use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use foton_film::check_writable;
use foton_integrator::{Method, RenderSettings, SettingChange};
use foton_scene::Scene;
use foton_session::checkpoint::{self, Keeper};
use foton_session::maps;
use foton_session::snapshot::{self, Format};
use foton_session::{Interrupt, Preset, SceneIdentity, Session, StopRule};

use crate::all_methods;
use crate::all_sensors;
use crate::args::{ErrorWish, RenderArgs};
use crate::console::{Console, Failure};
use crate::interrupts::{begin_step, interrupt_on_signals, say_limit};
use crate::opening::{
    Bounds, asks_for_all_sensors, build, choose_sensor, file_name, open, refuse_beyond_memory,
    refuse_two_roles,
};
use crate::settings::SettingsBuilder;
use crate::writing::{Content, Output, finish};

/// How long a render without a stop rule takes.
const DEFAULT_TIME: Duration = Duration::from_secs(60);

/// Runs `foton render`.
pub(crate) fn render(args: &RenderArgs, console: &mut Console) -> Result<(), Failure> {
    check_outputs(args)?;
    let interrupt = interrupt_on_signals(console);
    console.begin();
    let opened = open(&args.scene, &args.scene_options.read, args.memory, console, interrupt.cancel())?;
    refuse_two_roles(args.roles(), &opened)?;
    let name = file_name(&args.scene);
    let asked = args.scene_options.sensor.as_deref();
    let all_sensors = asks_for_all_sensors(&opened, asked);
    let sensor = choose_sensor(&opened, asked.filter(|_| !all_sensors))?;
    let files = opened.files.clone();
    let suggested = opened.suggested;
    let bounds = Bounds { size: args.settings.size, region: args.region, memory: args.memory };
    let (scene, identity) = build(opened, &name, sensor, bounds, console, interrupt.cancel())?;
    let settings = |method| {
        SettingsBuilder::of_scene(&suggested)
            .preset(args.preset.map(Preset::from))
            .method(method)
            .options(&args.settings)
            .photon_map(args.photon_map.settings())
            .sensor(sensor)
            .error(args.error != Some(ErrorWish::Off))
            .layers(&args.all_layers())
            .build()
    };
    let rule = stop_rule(args, suggested.passes, console);
    if args.integrator.is_all() {
        let scene = (&scene, &identity);
        return all_methods::render(args, scene, settings, (&rule, &interrupt), console);
    }
    let settings = settings(args.integrator.method().unwrap_or_else(|| chosen(&scene, sensor, console)));
    if all_sensors {
        let images = all_sensors::outputs(args, &scene);
        let roles = images.iter().fold(args.roles(), |roles, path| roles.writes("-o with its", Some(path)));
        roles.scene_reads(&files).clash().map_or(Ok(()), |clash| Err(Failure::Roles(clash)))?;
        return all_sensors::render(args, (&scene, &identity), &settings, (&rule, &interrupt), console);
    }
    console.of_settings(&scene, &settings);
    let mut session = start(args, scene, settings, &interrupt, console)?;
    if let Some(path) = &args.resume {
        begin_step("resuming the checkpoint");
        resume(args, path, &mut session, &identity, &rule, console)?;
    }
    interrupt.begin_passes();
    run(args, &mut session, &rule, &identity, &interrupt, console)
}

/// The method that suits the scene.
fn chosen(scene: &Scene, sensor: usize, console: &Console) -> Method {
    let (method, why) = Method::chosen_for(scene, sensor);
    console.line(&format!("--integrator auto: {}, because {why}", method.name()));
    method
}

/// Refuses outputs that cannot be written, before hours of rendering.
fn check_outputs(args: &RenderArgs) -> Result<(), Failure> {
    if args.integrator.is_all() {
        Method::ALL.iter().try_for_each(|m| check_writable(&args.image_of(*m)))?;
    }
    let (path, _) = &args.output;
    check_writable(path)?;
    args.checkpoint.as_deref().map_or(Ok(()), check_writable)?;
    args.photon_map.save_maps.as_deref().map_or(Ok(()), check_writable)?;
    if let Some(every) = args.every {
        check_writable(&snapshot::numbered(path, every.first()))?;
    }
    Ok(())
}

/// When to stop: as asked for, or else as the scene file says, or else after a minute.
fn stop_rule(args: &RenderArgs, suggested_passes: Option<u32>, console: &Console) -> StopRule {
    let error = match args.error {
        Some(ErrorWish::Below(share)) => Some(share),
        Some(ErrorWish::Off) | None => None,
    };
    let mut rule = StopRule { passes: args.passes, time: args.time, error };
    if rule == StopRule::default() {
        if let Some(passes) = suggested_passes {
            rule.passes = Some(passes.into());
            console.line(&format!("no --passes, --time or --error: {passes} passes, as the scene file says"));
        } else {
            rule.time = Some(DEFAULT_TIME);
            console.line("no --passes, --time or --error: rendering for 60 s");
        }
    }
    rule
}

/// Collects hit points.
fn start(
    args: &RenderArgs,
    scene: Arc<Scene>,
    settings: RenderSettings,
    interrupt: &Interrupt,
    console: &Console,
) -> Result<Session, Failure> {
    let threads = args.settings.threads.map(usize::from);
    refuse_beyond_memory(&scene, &settings, threads, args.memory)?;
    begin_step("collecting hit points");
    console.stage("collecting hit points");
    let mut session = match &args.photon_map.maps {
        Some(path) => {
            let maps = maps::read(path, &scene, settings.max_depth_in(&scene))?;
            Session::start_with_maps(scene, settings, &maps, threads, interrupt.cancel())?
        }
        None => Session::start(scene, settings, threads, interrupt.cancel())?,
    };
    if args.strict {
        session.render_mut().stop_at_first_not_finite();
    }
    if let (Some(path), Some(kept)) = (&args.photon_map.save_maps, session.render().maps()) {
        maps::write(path, &kept, session.render().scene())?;
        console.line(&format!(
            "wrote {}: maps of {} and {} photons",
            path.display(),
            kept.global_photons(),
            kept.caustic_photons()
        ));
    }
    Ok(session)
}

/// Goes on from a checkpoint.
fn resume(
    args: &RenderArgs,
    path: &Path,
    session: &mut Session,
    identity: &SceneIdentity,
    rule: &StopRule,
    console: &Console,
) -> Result<(), Failure> {
    checkpoint::resume(path, session, identity, session.render().settings().layers)?;
    if args.strict && session.render().ledger().dropped > 0 {
        return Err(Failure::LeftOut { path: path.to_owned(), values: session.render().ledger().dropped });
    }
    change_on_resume(args, path, session, rule, console);
    // Passes may be larger than a render from the beginning would have had them.
    let (render, threads) = (session.render(), args.settings.threads.map(usize::from));
    refuse_beyond_memory(render.scene(), render.settings(), threads, args.memory)
}

/// Renders until the stop rule, with images and checkpoints on the way and at the end.
fn run(
    args: &RenderArgs,
    session: &mut Session,
    rule: &StopRule,
    identity: &SceneIdentity,
    interrupt: &Interrupt,
    console: &Console,
) -> Result<(), Failure> {
    let (path, format) = &args.output;
    let layers = if *format == Format::Exr { &args.layers[..] } else { &[] };
    let content = Content { layers, shown: args.shown(), look: args.look(), identity };
    let elapsed = session.elapsed();
    let keeper = |path| Keeper::new(path, identity.clone(), args.checkpoint_every, elapsed);
    let mut keeper = args.checkpoint.as_deref().map(keeper);
    let mut outputs = Vec::new();
    let cause = session.run(rule, interrupt, &mut |progress| {
        console.pass(progress, rule);
        if args.every.is_some_and(|e| e.is_due(progress.report.pass)) {
            let path = snapshot::numbered(path, progress.report.pass);
            match content.write(&path, *format, progress.render) {
                Ok(()) => outputs.push(path.display().to_string()),
                // The passes are still there for the next image.
                Err(error) => console.warning(&format!("an image on the way is missing: {error}")),
            }
        }
        if let Some(keeper) = keeper.as_mut().filter(|keeper| keeper.is_due(progress.elapsed))
            && let Err(error) = keeper.write(progress.render, progress.elapsed, progress.rays)
        {
            console.warning(&format!("no checkpoint: {error}"));
        }
    });
    say_limit(cause, console);
    if let Some(keeper) = &mut keeper
        && let Err(unwritten) = keeper.write_last(session)
    {
        let instead = unwritten.spare.map(|spare| format!("; the state is in {} instead", spare.display()));
        console.warning(&format!("no checkpoint: {}{}", unwritten.cause, instead.unwrap_or_default()));
    }
    let output = Output { path: path.clone(), format: *format, is_new: false };
    finish(session, &[output], &content, outputs, console)
}

/// Says where a resumed render goes on from. Settings that are asked for by name and may change between passes change with the
/// next one; all others are as in the checkpoint, or it would not have been resumed.
fn change_on_resume(
    args: &RenderArgs,
    path: &Path,
    session: &mut Session,
    rule: &StopRule,
    console: &Console,
) {
    let passes = session.render().passes();
    console.line(&format!("going on from {} after {passes} passes", path.display()));
    let preset = args.preset.map(|preset| Preset::from(preset).apply(RenderSettings::default()));
    let alpha = args.settings.alpha.or(preset.as_ref().map(|p| p.ppm.alpha));
    let photons = args.settings.photons.or(preset.as_ref().map(|p| p.ppm.photons_per_pass));
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
