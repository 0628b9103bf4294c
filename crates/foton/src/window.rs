//! `foton [SCENE]` with a window: what the window needs of scene files is handed in from here.

use std::any::Any;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use foton_format::{
    OpenError, Opened, Options, Origin, Progress, Saved, Severity, beyond_mitsuba_3, save_edited,
};
use foton_input::printable;
use foton_integrator::Cancel;
use foton_preview::{BuiltIn, Close, WindowError};
use foton_scene::BuildError;
use foton_scene::description::SceneDescription;
use foton_session::SceneIdentity;
use foton_session::engine::{Loaded, Loader, Reopened, SavedScene, Source, TellReading};

use crate::args::{Args, ReadOptions};
use crate::console::located;
use crate::embedded::{self, Embedded};
use crate::opening::{how_to_read, refuse_to_build};
use crate::settings::SettingsBuilder;
use crate::{memory, signals};

/// Opens the window on the scene of the arguments, or the first of the embedded ones, and stays until it is closed.
pub(crate) fn show(args: &Args) -> Result<(), WindowError> {
    let first = || Source::BuiltIn(embedded::ALL[0].name.to_owned());
    let outcome = foton_preview::run(foton_preview::Options {
        scene: args.scene.clone().map_or_else(first, Source::File),
        loader: Arc::new(Files { first: args.scene.clone(), read: args.read.clone() }),
        built_in: embedded::ALL
            .iter()
            .map(|scene| BuiltIn { name: scene.name.to_owned(), thumbnail: scene.thumbnail })
            .collect(),
        memory_limit: memory::limit(None),
        frame_log: args.frame_log.clone(),
        closes: close_on_signals,
    });
    IS_OPEN.store(false, Ordering::Relaxed);
    outcome
}

/// So many findings are shown with the line that they are about.
const MAX_LINES: usize = 20;

/// Whether there is a window that signals may close.
static IS_OPEN: AtomicBool = AtomicBool::new(true);

/// Ctrl-C, SIGTERM and the limits of the system close the window, so that the checkpoint of the render has the last pass. Asked again,
/// nothing is waited for. Elsewhere than on Unix only one may listen, and that is the render that goes on where there is no window.
fn close_on_signals(close: Close) {
    if cfg!(unix) {
        let mut asked = false;
        // Unheard, they end the program as they always did.
        let _ = signals::on_end(move || {
            if !IS_OPEN.load(Ordering::Relaxed) {
                return;
            }
            if std::mem::replace(&mut asked, true) {
                std::process::exit(1);
            }
            close();
        });
    }
}

/// Scene files for the window.
struct Files {
    /// The scene of the command line, to which its parameters belong.
    first: Option<PathBuf>,
    read: ReadOptions,
}

impl Files {
    /// How a file is read for the window.
    fn options(&self, path: Option<&Path>, cancel: &Cancel) -> Options {
        let options = how_to_read(&self.read, None, cancel);
        let has_parameters = path.is_some() && path == self.first.as_deref();
        if has_parameters { options } else { Options { defines: Vec::new(), ..options } }
    }

    /// The scene of a file that was just written; `None` where it has already gone again.
    fn reopened(&self, path: &Path) -> Option<Reopened> {
        let options = Options { defines: Vec::new(), ..self.options(None, &Cancel::default()) };
        let opened = foton_format::open(path, &options).ok()?;
        let identity = SceneIdentity { name: name_of(path), hash: opened.source_hash };
        Some(Reopened { identity, files: opened.files.clone(), origin: Arc::new(opened) })
    }
}

impl Loader for Files {
    fn open(&self, source: &Source, cancel: &Cancel, tell: TellReading) -> Result<Loaded, String> {
        let progress = Progress::new(tell);
        let options = |path| Options { progress, ..self.options(path, cancel) };
        let (opened, name) = match source {
            Source::File(path) => (foton_format::open(path, &options(Some(path))), name_of(path)),
            Source::BuiltIn(name) => {
                let scene =
                    Embedded::named(name).ok_or_else(|| format!("no scene \"{name}\" ships with foton"))?;
                (scene.open(&options(None)), name.clone())
            }
        };
        let opened = opened.map_err(|error| lines(&error))?;
        refuse_to_build(&opened.description, None).map_err(|failure| failure.to_string())?;
        Ok(Loaded {
            description: opened.description.clone(),
            identity: SceneIdentity { name, hash: opened.source_hash },
            settings: SettingsBuilder::of_scene(&opened.suggested).error(true).build(),
            files: opened.files.clone(),
            warnings: opened.warnings.iter().map(ToString::to_string).collect(),
            origin: Arc::new(opened),
        })
    }

    fn why_not_built(&self, loaded: &Loaded, cause: &BuildError) -> String {
        let name = &loaded.identity.name;
        let located = loaded
            .origin
            .downcast_ref::<Opened>()
            .map(|opened| opened.finding(Severity::Error, name, cause.part(), cause.to_string()).to_string());
        located.unwrap_or_else(|| format!("{name}: {cause}"))
    }

    fn save(
        &self,
        origin: &(dyn Any + Send + Sync),
        edited: &SceneDescription,
        path: &Path,
    ) -> Result<SavedScene, String> {
        let opened = origin.downcast_ref::<Opened>().ok_or("the scene was opened by another loader")?;
        let saved = save_edited(opened, edited, path).map_err(|cause| cause.to_string())?;
        // What stands in the file already a person knows.
        let (mut notes, known) = match saved {
            Saved::Changed => (Vec::new(), beyond_mitsuba_3(&opened.description)),
            Saved::Anew { why } => (written_anew(opened, &why), Vec::new()),
        };
        let beyond = beyond_mitsuba_3(edited).into_iter().filter(|note| !known.contains(note));
        notes.extend(beyond.map(|note| capitalised(&note)));
        Ok(SavedScene { note: notes.join("\n"), reopened: self.reopened(path) })
    }

    fn import(&self, path: &Path, cancel: &Cancel) -> Result<SceneDescription, String> {
        foton_format::import(path, &self.options(None, cancel)).map_err(|error| lines(&error))
    }
}

/// What to say of a scene that has a new file.
fn written_anew(opened: &Opened, why: &str) -> Vec<String> {
    let mut notes = match &opened.origin {
        Origin::Mitsuba(_) => {
            vec![format!("The whole scene was rewritten, with its meshes beside it: {why}")]
        }
        Origin::Foreign(of) => {
            let kind = of.kind;
            vec![format!(
                "What was {kind} is saved as a Mitsuba scene, with its meshes and pictures beside it"
            )]
        }
    };
    if opened.warnings.iter().any(|warning| warning.line > 0) {
        notes.push(
            "What the warnings in the scene name is not in the new file, or as foton renders it".to_owned(),
        );
    }
    notes
}

fn capitalised(sentence: &str) -> String {
    let mut letters = sentence.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// Everything that is wrong with a file, each with the line that it is about.
fn lines(error: &OpenError) -> String {
    let found = error.diagnostics().iter().enumerate();
    let lines: Vec<String> = found.map(|(i, d)| located::text(d, i < MAX_LINES)).collect();
    lines.join("\n")
}

fn name_of(path: &Path) -> String {
    printable(&path.file_name().unwrap_or_default().to_string_lossy()).into_owned()
}
