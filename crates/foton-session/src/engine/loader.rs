//! Opening and saving scenes: the binary hands in how; here is when. A scene is opened on a thread of its own, so that the
//! present one goes on.

use std::any::Any;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::thread;

use crossbeam_channel::{Receiver, Sender, bounded};
use foton_integrator::Settings;
use foton_scene::description::SceneDescription;
use foton_scene::{BuildError, Scene};

use super::command::Source;
use crate::metadata::SceneIdentity;
use crate::panic::contained;

/// A scene and what its file asks for.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// What to render.
    pub description: SceneDescription,
    /// Its name and hash.
    pub identity: SceneIdentity,
    /// Settings, with what the file suggests.
    pub settings: Settings,
    /// What the file says without effect, each with its place.
    pub warnings: Vec<String>,
    /// What the loader wants back when the scene is saved.
    pub origin: Arc<dyn Any + Send + Sync>,
}

/// Opens and saves scenes.
pub trait Loader: Send + Sync + 'static {
    /// Opens a scene.
    ///
    /// # Errors
    /// Everything that is wrong with it, each fault with its place, a line each.
    fn open(&self, source: &Source) -> Result<Loaded, String>;

    /// Why what was opened makes no scene: with its place, where the loader knows it.
    fn why_not_built(&self, loaded: &Loaded, cause: &BuildError) -> String {
        format!("{}: {cause}", loaded.identity.name)
    }

    /// Writes a scene as it is after edits to a file, given its [`Loaded::origin`]; returns what there is to know about it.
    ///
    /// # Errors
    /// Why it could not be written.
    fn save(
        &self,
        origin: &(dyn Any + Send + Sync),
        description: &SceneDescription,
        path: &Path,
    ) -> Result<String, String>;
}

/// A scene that is ready to render.
pub(super) struct Ready {
    pub(super) source: Source,
    pub(super) loaded: Loaded,
    pub(super) scene: Arc<Scene>,
}

/// A scene that is being opened.
pub(super) struct Opening {
    pub(super) name: String,
    pub(super) result: Receiver<Result<Box<Ready>, String>>,
}

impl Opening {
    /// Begins to open a scene.
    pub(super) fn begin(loader: &Arc<dyn Loader>, source: Source) -> Self {
        let (sender, result) = bounded(1);
        let loader = Arc::clone(loader);
        let name = source.to_string();
        let work = move || open(&*loader, source, &sender);
        if let Err(error) = thread::Builder::new().name("open".to_owned()).spawn(work) {
            let (sender, result) = bounded(1);
            let _ = sender.send(Err(format!("cannot make a thread: {error}")));
            return Self { name, result };
        }
        Self { name, result }
    }
}

fn open(loader: &dyn Loader, source: Source, sender: &Sender<Result<Box<Ready>, String>>) {
    let name = source.to_string();
    let work = || open_and_build(loader, source);
    let result =
        contained(work).unwrap_or_else(|message| Err(format!("{name}: foton has a fault: {message}")));
    // Nobody listens any more when opening was cancelled.
    let _ = sender.send(result);
}

fn open_and_build(loader: &dyn Loader, source: Source) -> Result<Box<Ready>, String> {
    loader.open(&source).and_then(|loaded| {
        let built = Scene::build(&loaded.description);
        let scene = built.map_err(|cause| loader.why_not_built(&loaded, &cause))?;
        Ok(Box::new(Ready { source, loaded, scene: Arc::new(scene) }))
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

impl std::fmt::Display for Source {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::BuiltIn(name) => f.write_str(name),
            Self::File(path) => write!(f, "{}", foton_input::shown_path(path)),
        }
    }
}
