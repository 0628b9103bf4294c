//! How soon the engine answers within a pass of ten million photons: from a command to the frame that shows what it did.

use std::any::Any;
use std::num::NonZeroU32;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use foton_edit::DragMode;
use foton_integrator::{Alpha, Cancel, PpmSettings, RenderSettings, SettingChange};
use foton_scene::Scene;
use foton_scene::description::SceneDescription;
use foton_session::engine::{
    Activity, Command, Event, Frame, Loaded, Loader, SavedScene, SceneEdit, Setup, Source, TellReading,
    ViewMode,
};
use foton_session::{Engine, SceneIdentity, Session};

use crate::rig;

const PHOTONS: u32 = 10_000_000;
const ROUNDS: usize = 10;
const PATIENCE: Duration = Duration::from_secs(600);

/// The default scene, with passes of so many photons, whatever is asked for.
pub(crate) struct DefaultScene(pub(crate) PpmSettings);

impl DefaultScene {
    pub(crate) fn settings(&self) -> RenderSettings {
        let samples_per_pixel = NonZeroU32::new(4).expect("not zero");
        RenderSettings { error: true, samples_per_pixel, ppm: self.0, ..RenderSettings::default() }
    }
}

impl Loader for DefaultScene {
    fn open(&self, _: &Source, _: &Cancel, _: TellReading) -> Result<Loaded, String> {
        let opened = opened()?;
        Ok(Loaded {
            description: opened.description.clone(),
            identity: SceneIdentity { name: "glass-and-ring".into(), hash: opened.source_hash },
            settings: self.settings(),
            warnings: Vec::new(),
            files: Vec::new(),
            origin: Arc::new(()),
        })
    }

    fn save(
        &self,
        _: &(dyn Any + Send + Sync),
        _: &SceneDescription,
        _: &Path,
    ) -> Result<SavedScene, String> {
        Err("nothing is saved here".into())
    }
}

fn opened() -> Result<foton_format::Opened, String> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../assets/glass-and-ring/scene.xml");
    foton_format::open(&path, &foton_format::Options::default()).map_err(|error| error.to_string())
}

pub(crate) fn built() -> Arc<Scene> {
    Arc::new(Scene::build(&opened().expect("it ships with foton").description).expect("sound"))
}

/// From the scene to its first whole pass: the engine with its previews, and a session without.
fn first_pass() -> [f64; 2] {
    let loader = DefaultScene(PpmSettings::default());
    let (settings, cancel) = (loader.settings(), Cancel::default());
    let scene = built();
    let begin = Instant::now();
    let mut session = Session::start(scene, settings, None, &cancel).expect("starts");
    session.advance(&cancel).expect("a pass");
    let alone = begin.elapsed().as_secs_f64();
    drop(session);
    let engine = Engine::spawn(Setup::new(Arc::new(loader), Box::new(|| ()), None));
    let engine = engine.expect("a thread");
    engine.send(Command::Open(Source::File(PathBuf::new())));
    until(&engine, &mut |f| f.activity == Activity::Collecting);
    let begin = Instant::now();
    until(&engine, &mut |f| f.stats.passes > 0);
    [begin.elapsed().as_secs_f64(), alone]
}

pub(crate) fn until(engine: &Engine, is_it: &mut dyn FnMut(&Frame) -> bool) -> Frame {
    loop {
        let frame = engine.frames().recv_timeout(PATIENCE).expect("the engine answers");
        while let Some(event) = engine.event() {
            assert!(!matches!(event, Event::Failed(_)), "{event:?}");
        }
        if is_it(&frame) {
            return frame;
        }
    }
}

/// Waits until passes have gone on for a while, at another place in a pass each time.
fn let_it_work(round: usize) {
    std::thread::sleep(Duration::from_millis(150 + 47 * round as u64));
}

pub(crate) fn print() {
    let runs: Vec<[f64; 2]> = (0..3).map(|_| first_pass()).collect();
    let [engine, alone] = [0, 1].map(|i| rig::median(runs.iter().map(|run| run[i])));
    println!("first whole pass: {engine:.2} s with previews, {alone:.2} s without\n");
    let photons = NonZeroU32::new(PHOTONS).expect("not zero");
    let long = PpmSettings { photons_per_pass: photons, first_pass: photons, ..PpmSettings::default() };
    let setup = Setup::new(Arc::new(DefaultScene(long)), Box::new(|| ()), None);
    let engine = Engine::spawn(setup).expect("a thread");
    engine.send(Command::Open(Source::File(PathBuf::new())));
    until(&engine, &mut |f| f.activity == Activity::Rendering && f.pass_share > 0.0);
    let mut rows: Vec<(&str, Vec<f64>)> = Vec::new();
    let mut time = |name: &'static str, command: Command, is_it: &dyn Fn(&Frame) -> bool| {
        let begin = Instant::now();
        engine.send(command);
        let frame = until(&engine, &mut |f| is_it(f));
        let took = 1e3 * begin.elapsed().as_secs_f64();
        match rows.iter_mut().find(|(n, _)| *n == name) {
            Some((_, all)) => all.push(took),
            None => rows.push((name, vec![took])),
        }
        frame
    };
    for round in 0..ROUNDS {
        until(&engine, &mut |f| f.selection.is_none() && f.stats.passes > 0 && f.pass_share > 0.0);
        let_it_work(round);
        let middle = [480.0, 400.0];
        time("select", Command::Choose(Some(middle)), &|f| f.selection.is_some());
        let_it_work(round);
        time("deselect", Command::Choose(None), &|f| f.selection.is_none());
        let_it_work(round);
        let alpha = Alpha::new(0.3 + 0.02 * round as f64).expect("in range");
        let steered = move |f: &Frame| f.settings.ppm.alpha == alpha;
        time("α", Command::Steer(SettingChange::Alpha(alpha)), &steered);
        let_it_work(round);
        time("pause", Command::Pause, &|f| f.activity == Activity::Paused);
        time("resume", Command::Resume, &|f| f.activity == Activity::Rendering);
        let_it_work(round);
        time("view", Command::SetView(ViewMode::Luminance), &|f| f.view == ViewMode::Luminance);
        let_it_work(round);
        time("view back", Command::SetView(ViewMode::Radiance), &|f| f.view == ViewMode::Radiance);
        let_it_work(round);
        engine.send(Command::Choose(Some(middle)));
        let before = until(&engine, &mut |f| f.selection.is_some());
        let nudge = SceneEdit::Nudge { steps: [1.0, 0.0], mode: DragMode::Horizontal };
        let shown = move |f: &Frame| f.render > before.render && f.pictured == f.render;
        let edited = time("edit, its preview", Command::Edit(nudge), &shown);
        let back = move |f: &Frame| f.render > edited.render && f.pictured == f.render;
        time("undo, the render from before", Command::Edit(SceneEdit::Undo), &back);
        engine.send(Command::Choose(None));
    }
    println!("| command | median ms | largest ms |\n|---|---|---|");
    for (name, all) in rows {
        let largest = all.iter().copied().fold(0.0, f64::max);
        println!("| {name} | {:.0} | {largest:.0} |", rig::median(all.iter().copied()));
    }
}
