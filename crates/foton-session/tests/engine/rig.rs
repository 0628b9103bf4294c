//! An engine over scenes made in code, and the patience to wait for what it says: on its channels, never on time.

use std::any::Any;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use crossbeam_channel::Receiver;
use foton_film::Image;
use foton_integrator::{Cancel, PpmSettings, RenderSettings};
use foton_math::Rgb;
use foton_math::glam::{DAffine3, DMat3, DVec3};
use foton_scene::Scene;
use foton_scene::description::{
    Bsdf, Dielectric, Diffuse, EmitterDescription, EmitterKind, Filter, FovAxis, Geometry, Material, Mesh,
    SceneDescription, SensorDescription, ShapeDescription,
};
use foton_session::engine::{
    Activity, Command, Event, Frame, Loaded, Loader, Picture, Reopened, SavedScene, Setup, Source,
    TellReading,
};
use foton_session::{Engine, SceneIdentity, Session, StopRule};

/// What takes longer has hung.
const PATIENCE: Duration = Duration::from_secs(120);

/// More pixels than a small picture has.
pub(crate) const SIZE: [u32; 2] = [180, 120];

/// Where the ball is seen, in pixels.
pub(crate) const BALL: [f64; 2] = [90.0, 60.0];

/// A grey floor, a glass ball in the middle of the picture, and a bulb.
pub(crate) fn room() -> SceneDescription {
    let looking = |from: DVec3, to: DVec3| {
        let forward = (to - from).normalize();
        let left = DVec3::Y.cross(forward).normalize();
        DAffine3::from_cols(left, forward.cross(left), forward, from)
    };
    let white = Rgb::WHITE.into();
    let grey = Bsdf::Diffuse(Diffuse { reflectance: Rgb::splat(0.5).into() });
    let glass = Bsdf::Dielectric(Dielectric {
        int_ior: 1.5,
        ext_ior: 1.0,
        specular_reflectance: white,
        specular_transmittance: white,
        roughness: None,
    });
    let material =
        |name: &str, front| Material { name: name.into(), front, back: None, ..Material::default() };
    let shape = |name: &str, geometry, to_world, material| ShapeDescription {
        name: name.into(),
        geometry,
        to_world,
        flip_normals: false,
        material,
        radiance: None,
    };
    let flat = DAffine3::from_mat3(DMat3::from_cols(DVec3::X * 6.0, DVec3::NEG_Z * 6.0, DVec3::Y));
    let ball = Geometry::Sphere { centre: DVec3::new(0.0, 1.0, 0.0), radius: 1.0 };
    SceneDescription {
        sensors: vec![SensorDescription {
            name: "camera".into(),
            to_world: looking(DVec3::new(1.0, 3.0, 8.0), DVec3::new(0.0, 1.0, 0.0)),
            fov_degrees: 50.0,
            fov_axis: FovAxis::X,
            width: SIZE[0],
            height: SIZE[1],
            filter: Filter::Box { radius: 0.5 },
            ..SensorDescription::default()
        }],
        materials: vec![material("grey", grey), material("glass", glass)],
        shapes: vec![
            shape("floor", Geometry::Mesh(Arc::new(Mesh::rectangle())), flat, 0),
            shape("ball", ball, DAffine3::IDENTITY, 1),
        ],
        emitters: vec![EmitterDescription {
            name: "bulb".into(),
            kind: EmitterKind::Point { position: DVec3::new(-2.0, 3.0, 1.0), intensity: Rgb::splat(9.0) },
        }],
        ..SceneDescription::default()
    }
}

/// The same with a heap of flat triangles beside it, more than are moved live.
fn heap() -> SceneDescription {
    let corner = |i: u32| {
        let [x, z] = [[0.0, 0.0], [0.0, 0.3], [0.3, 0.0]][i as usize % 3];
        DVec3::new(2.0 + x, 0.01, 2.0 + z + f64::from(i / 3) * 1e-6)
    };
    let mesh = Mesh {
        positions: (0..330_000).map(corner).collect(),
        normals: Vec::new(),
        texture_coordinates: Vec::new(),
        triangles: (0..110_000).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
        ..Mesh::default()
    };
    let mut description = room();
    let heap = ShapeDescription {
        name: "heap".into(),
        geometry: Geometry::Mesh(Arc::new(mesh)),
        ..description.shapes[0].clone()
    };
    description.shapes.push(ShapeDescription { to_world: DAffine3::IDENTITY, ..heap });
    description
}

/// Small passes that grow once.
pub(crate) fn settings() -> RenderSettings {
    let n = |n| std::num::NonZeroU32::new(n).expect("not zero");
    RenderSettings {
        samples_per_pixel: n(1),
        ppm: PpmSettings { photons_per_pass: n(8192), first_pass: n(4096), ..PpmSettings::default() },
        ..RenderSettings::default()
    }
}

pub(crate) fn identity() -> SceneIdentity {
    SceneIdentity { name: "room.xml".into(), hash: 7 }
}

/// What a session without an engine makes: `change` is called before each pass with the number of passes so far.
pub(crate) fn headless(
    passes: u64,
    settings: RenderSettings,
    mut change: impl FnMut(u64, &mut Session),
) -> Session {
    let scene = Arc::new(Scene::build(&room()).expect("builds"));
    let cancel = Cancel::default();
    let mut session = Session::start(scene, settings, None, &cancel).expect("starts");
    for pass in 0..passes {
        change(pass, &mut session);
        session.advance(&cancel).expect("nobody cancels");
    }
    session
}

fn vast() -> SceneDescription {
    let mut room = room();
    room.sensors[0].resize(1 << 15, 1 << 15);
    room
}

/// The file that all scenes are said to be read from.
pub(crate) fn scene_file() -> PathBuf {
    std::env::temp_dir().join(format!("foton-engine-{}-scene.txt", std::process::id()))
}

/// Opens "room", "vast", which is a room of 32,768² pixels, "heap", "slow", which waits until it is let go, and "endless", which is
/// read until that is given up; "faulty" panics, and "sensorless" makes the engine panic.
pub(crate) struct Shelf {
    settings: RenderSettings,
    go: Mutex<Receiver<()>>,
    given_up: crossbeam_channel::Sender<()>,
}

impl Loader for Shelf {
    fn open(&self, source: &Source, cancel: &Cancel, tell: TellReading) -> Result<Loaded, String> {
        let name = source.to_string();
        tell(0.5);
        match name.as_str() {
            "room" | "vast" | "heap" | "sensorless" => {}
            "faulty" => panic!("this loader has a fault"),
            "slow" => {
                let _ = self.go.lock().expect("whole").recv_timeout(PATIENCE);
            }
            "endless" => {
                while !cancel.is_requested() {
                    std::thread::sleep(Duration::from_millis(1));
                }
                let _ = self.given_up.send(());
            }
            _ => return Err(format!("{name}:3:7: there is no such scene")),
        }
        Ok(Loaded {
            description: match name.as_str() {
                "heap" => heap(),
                "vast" => vast(),
                _ => room(),
            },
            identity: identity(),
            // A sensor that is not there is a fault of whoever asks for it.
            settings: RenderSettings {
                sensor: if name == "sensorless" { 9 } else { 0 },
                ..self.settings.clone()
            },
            warnings: vec!["room.xml:1:1: a warning".into()],
            files: vec![scene_file()],
            origin: Arc::new(42_u8),
        })
    }

    fn save(
        &self,
        origin: &(dyn Any + Send + Sync),
        scene: &SceneDescription,
        path: &Path,
    ) -> Result<SavedScene, String> {
        let text = format!("{:?} {}", origin.downcast_ref::<u8>(), scene.shapes.len());
        std::fs::write(path, text).map_err(|e| e.to_string())?;
        let name = path.file_name().expect("a file").to_string_lossy().into_owned();
        let identity = SceneIdentity { name, hash: 77 };
        let reopened = Reopened { identity, files: vec![path.to_owned()], origin: Arc::new(43_u8) };
        Ok(SavedScene { note: "a note".into(), reopened: Some(reopened) })
    }

    fn import(&self, path: &Path, _: &Cancel) -> Result<SceneDescription, String> {
        if path.ends_with("heap.ply") { Ok(heap()) } else { Err(format!("{}: no mesh", path.display())) }
    }
}

/// An engine, and what it has said.
pub(crate) struct Rig {
    pub(crate) engine: Engine,
    /// Lets "slow" go.
    pub(crate) go: crossbeam_channel::Sender<()>,
    /// Told when "endless" is given up.
    pub(crate) given_up: Receiver<()>,
    /// Whose other end the engine's thread holds: when that is gone, so is the thread.
    pub(crate) thread: Receiver<()>,
}

impl Rig {
    pub(crate) fn new(settings: RenderSettings, memory_limit: Option<f64>) -> Self {
        Self::with(settings, memory_limit, |setup| setup)
    }

    /// The same with other folders and limits.
    pub(crate) fn with(
        settings: RenderSettings,
        memory_limit: Option<f64>,
        change: impl FnOnce(Setup) -> Setup,
    ) -> Self {
        let (go, wait) = crossbeam_channel::bounded(1);
        let (held, thread) = crossbeam_channel::bounded::<()>(0);
        let (told, given_up) = crossbeam_channel::unbounded();
        let loader = Arc::new(Shelf { settings, go: Mutex::new(wait), given_up: told });
        // The sender does nothing but die with the thread.
        let wake = Box::new(move || {
            let _ = held.try_send(());
        });
        let setup = Setup { history_folder: None, ..Setup::new(loader, wake, memory_limit) };
        let engine = Engine::spawn(change(setup)).expect("a thread");
        Self { engine, go, given_up, thread }
    }

    /// An engine that has rendered the room for some passes and waits.
    pub(crate) fn at_pass(passes: u64) -> (Self, Frame) {
        let rig = Self::new(settings(), None);
        rig.send(Command::StopAt(StopRule::passes(passes)));
        rig.open("room");
        let frame = rig.done(passes);
        (rig, frame)
    }

    pub(crate) fn send(&self, command: Command) {
        assert!(self.engine.send(command.clone()), "no room for {command:?}");
    }

    pub(crate) fn open(&self, name: &str) {
        self.send(Command::Open(Source::BuiltIn(name.into())));
    }

    /// The first frame that is as it should be.
    #[track_caller]
    pub(crate) fn until(&self, what: &str, is_it: impl Fn(&Frame) -> bool) -> Frame {
        let begin = Instant::now();
        let mut last = None;
        while let Some(left) = PATIENCE.checked_sub(begin.elapsed()) {
            match self.engine.frames().recv_timeout(left) {
                Ok(frame) if is_it(&frame) => return frame,
                Ok(frame) => last = Some((frame.number, frame.render, frame.activity, frame.stats.passes)),
                Err(_) => break,
            }
        }
        panic!("never saw {what}; the last frame's number, render, activity and pass: {last:?}");
    }

    /// The frame at which the stop rule of so many passes is reached.
    #[track_caller]
    pub(crate) fn done(&self, passes: u64) -> Frame {
        self.until("the end", |f| f.activity == Activity::Done && f.stats.passes == passes)
    }

    /// The first event that is as it should be.
    #[track_caller]
    pub(crate) fn hear<T>(&self, what: &str, mut is_it: impl FnMut(&Event) -> Option<T>) -> T {
        let begin = Instant::now();
        let mut heard = Vec::new();
        while let Some(left) = PATIENCE.checked_sub(begin.elapsed()) {
            let Ok(event) = self.engine.events().recv_timeout(left) else { break };
            if let Some(found) = is_it(&event) {
                return found;
            }
            heard.push(event);
        }
        panic!("never heard {what}, but {heard:?}");
    }

    #[track_caller]
    pub(crate) fn saved(&self) -> Vec<PathBuf> {
        self.hear("of files", |event| match event {
            Event::Saved(paths) => Some(paths.clone()),
            _ => None,
        })
    }

    #[track_caller]
    pub(crate) fn scene_saved(&self) -> PathBuf {
        self.hear("of the scene's file", |event| match event {
            Event::SceneSaved(path) => Some(path.clone()),
            _ => None,
        })
    }

    #[track_caller]
    pub(crate) fn failure(&self) -> String {
        self.hear("of a failure", |event| match event {
            Event::Failed(text) => Some(text.clone()),
            _ => None,
        })
    }
}

/// The pixels of a frame's picture.
#[track_caller]
pub(crate) fn image(frame: &Frame) -> Arc<Image> {
    match &frame.picture {
        Some(Picture::Colour(image)) => Arc::clone(image),
        other => panic!("no colours: {other:?}"),
    }
}

/// A folder that goes with the test.
pub(crate) struct Folder(pub(crate) PathBuf);

impl Folder {
    pub(crate) fn new(name: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("foton-engine-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        Self(folder)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}
