//! Opening and saving scenes: the binary hands in how; here is when. A scene is opened on a thread of its own, so that the
//! present one goes on.

use std::any::Any;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;

use crossbeam_channel::{Receiver, bounded};
use foton_integrator::{Cancel, RenderSettings};
use foton_scene::description::SceneDescription;
use foton_scene::{BuildError, BuildOptions, Scene};

use super::command::Source;
use super::frame::BuildProgress;
use crate::findings::{self, Finding};
use crate::metadata::SceneIdentity;
use crate::panic::catch_panic;

/// A scene and what its file asks for.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// What to render.
    pub description: SceneDescription,
    /// Its name and hash.
    pub identity: SceneIdentity,
    /// Settings, with what the file suggests.
    pub settings: RenderSettings,
    /// What the file says without effect, each with its place.
    pub warnings: Vec<String>,
    /// Files that it was read from: nothing is written over them but the scene itself, when it is saved.
    pub files: Vec<PathBuf>,
    /// What the loader wants back when the scene is saved.
    pub origin: Arc<dyn Any + Send + Sync>,
}

/// Is told which share of a file is read.
pub type TellReading = Box<dyn Fn(f64) + Send + Sync>;

/// Opens and saves scenes.
pub trait Loader: Send + Sync + 'static {
    /// Opens a scene, unless cancelled: nobody sees the outcome then. `tell` is told how far reading is, from 0 to 1.
    ///
    /// # Errors
    /// Everything that is wrong with it, each fault with its place, a line each.
    fn open(&self, source: &Source, cancel: &Cancel, tell: TellReading) -> Result<Loaded, String>;

    /// Why what was opened makes no scene: with its place, where the loader knows it.
    fn why_not_built(&self, loaded: &Loaded, cause: &BuildError) -> String {
        format!("{}: {cause}", loaded.identity.name)
    }

    /// Writes a scene as it is after edits to a file, given its [`Loaded::origin`].
    ///
    /// # Errors
    /// Why it could not be written.
    fn save(
        &self,
        origin: &(dyn Any + Send + Sync),
        description: &SceneDescription,
        path: &Path,
    ) -> Result<SavedScene, String>;

    /// Reads the shapes of a mesh file, with their materials, to add them to a scene.
    ///
    /// # Errors
    /// Why it cannot be read.
    fn import(&self, path: &Path, _cancel: &Cancel) -> Result<SceneDescription, String> {
        Err(format!("{} cannot be imported", foton_input::shown_path(path)))
    }
}

/// A scene that was saved.
#[derive(Clone, Debug)]
pub struct SavedScene {
    /// What there is to know about it; empty where that is nothing.
    pub note: String,
    /// The scene of the file that was written, as opening it gives it; `None` where that could not be found out.
    pub reopened: Option<Reopened>,
}

/// What a file that was saved is when it is opened.
#[derive(Clone, Debug)]
pub struct Reopened {
    /// Its name and hash.
    pub identity: SceneIdentity,
    /// Files that it is read from.
    pub files: Vec<PathBuf>,
    /// As [`Loaded::origin`].
    pub origin: Arc<dyn Any + Send + Sync>,
}

/// A scene that is ready to render.
pub(super) struct Ready {
    pub(super) source: Source,
    pub(super) loaded: Loaded,
    pub(super) scene: Arc<Scene>,
    /// What a person should know of the scene.
    pub(super) findings: Vec<Finding>,
}

impl Ready {
    /// What a person should know of the scene and its file, in words.
    pub(super) fn warnings(&self) -> Vec<String> {
        let findings = self.findings.iter().map(|finding| finding.text.clone());
        self.loaded.warnings.iter().cloned().chain(findings).collect()
    }
}

/// What was asked for of a file.
pub(super) enum Arrival {
    /// A scene, to take the place of the present one.
    Scene(Box<Ready>),
    /// A model, to be added to the present scene, by the name of its file.
    Model(String, Arc<SceneDescription>),
}

/// A scene that is being opened, or a model; dropped it is given up.
pub(super) struct Opening {
    pub(super) name: String,
    pub(super) result: Receiver<Result<Arrival, String>>,
    at: Arc<Mutex<Option<BuildProgress>>>,
    cancel: Cancel,
}

impl Drop for Opening {
    fn drop(&mut self) {
        self.cancel.request();
    }
}

impl Opening {
    /// Begins to open a scene.
    pub(super) fn begin(loader: &Arc<dyn Loader>, source: Source) -> Self {
        let loader = Arc::clone(loader);
        let name = source.to_string();
        Self::of(name, move |at, cancel| open_and_build(&*loader, source, at, cancel).map(Arrival::Scene))
    }

    /// Begins to read a model.
    pub(super) fn import(loader: &Arc<dyn Loader>, path: PathBuf) -> Self {
        let loader = Arc::clone(loader);
        let name =
            foton_input::printable(&path.file_name().unwrap_or_default().to_string_lossy()).into_owned();
        let of = name.clone();
        Self::of(name, move |_, cancel| Ok(Arrival::Model(of, Arc::new(loader.import(&path, &cancel)?))))
    }

    /// Work on a file of that name, on a thread of its own.
    fn of(
        name: String,
        work: impl FnOnce(&Arc<Mutex<Option<BuildProgress>>>, Cancel) -> Result<Arrival, String> + Send + 'static,
    ) -> Self {
        let (sender, result) = bounded(1);
        let (cancel, at) = (Cancel::default(), Arc::new(Mutex::new(None)));
        let (told, asked, of) = (Arc::clone(&at), cancel.clone(), name.clone());
        let guarded = move || {
            let result = catch_panic(|| work(&told, asked));
            let result = result.unwrap_or_else(|message| Err(format!("{of}: foton has a fault: {message}")));
            // Nobody listens any more when it was given up.
            let _ = sender.send(result);
        };
        if let Err(error) = thread::Builder::new().name("open".to_owned()).spawn(guarded) {
            let (sender, result) = bounded(1);
            let _ = sender.send(Err(format!("cannot make a thread: {error}")));
            return Self { name, result, at, cancel };
        }
        Self { name, result, at, cancel }
    }

    /// How far opening is; `None` before that is known.
    pub(super) fn building(&self) -> Option<BuildProgress> {
        *self.at.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

fn open_and_build(
    loader: &dyn Loader,
    source: Source,
    at: &Arc<Mutex<Option<BuildProgress>>>,
    cancel: Cancel,
) -> Result<Box<Ready>, String> {
    let place = |at: &Mutex<Option<BuildProgress>>, step, share| {
        *at.lock().unwrap_or_else(PoisonError::into_inner) = Some(BuildProgress { step, share });
    };
    let reading = Arc::clone(at);
    let tell_reading = Box::new(move |share| place(&reading, None, share));
    loader.open(&source, &cancel, tell_reading).and_then(|loaded| {
        let tell = |step, share| place(at, Some(step), share);
        let options = BuildOptions { cancel, tell: Some(&tell), ..BuildOptions::default() };
        let built = Scene::build_with(&loaded.description, &options);
        let scene = built.map_err(|cause| loader.why_not_built(&loaded, &cause))?;
        // A sensor that is not there is found where it is used.
        let sensor = loaded.settings.sensor.min(scene.sensors().len().saturating_sub(1));
        let findings = findings::of_scene(&scene, sensor);
        Ok(Box::new(Ready { source, loaded, scene: Arc::new(scene), findings }))
    })
}

impl Source {
    /// The file, if it is one.
    #[must_use]
    pub fn file(&self) -> Option<&PathBuf> {
        match self {
            Self::File(path) => Some(path),
            Self::BuiltIn(_) => None,
        }
    }
}

impl Source {
    /// Its name for people: that of its folder where the file is called `scene.xml`.
    #[must_use]
    pub fn title(&self) -> String {
        let Self::File(path) = self else { return self.to_string() };
        let name = |part: Option<&std::ffi::OsStr>| part.map(|p| p.to_string_lossy().into_owned());
        let is_scene = path.file_stem().is_some_and(|stem| stem.eq_ignore_ascii_case("scene"));
        let absolute = std::path::absolute(path).unwrap_or_else(|_| path.clone());
        let folder = absolute.parent().filter(|_| is_scene).and_then(|folder| name(folder.file_name()));
        let title = folder.or_else(|| name(path.file_name())).unwrap_or_default();
        foton_input::printable(&title).into_owned()
    }
}

impl std::fmt::Display for Source {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::BuiltIn(name) => f.write_str(name),
            Self::File(path) => write!(f, "{}", foton_input::shown_path(path)),
        }
    }
}
