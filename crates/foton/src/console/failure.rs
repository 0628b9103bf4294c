//! Why nothing was rendered, in the words of the program.

use std::fmt;
use std::path::PathBuf;

use foton_film::{ReadError, WriteError};
use foton_format::{Diagnostic, OpenError, Opened, Severity};
use foton_input::{quoted, shown_path};
use foton_integrator::NotFinite;
use foton_measure::CompareError;
use foton_measure::sweep::SweepError;
use foton_scene::BuildError;
use foton_session::checkpoint::ResumeError;
use foton_session::maps::MapsError;
use foton_session::{Panic, StartError};

use crate::memory::Confined;
use crate::roles::Clash;

/// Names that a message lists at most.
const MAX_NAMES: usize = 20;

/// Why nothing was rendered.
#[derive(Debug)]
pub(crate) enum Failure {
    Open(OpenError),
    /// Someone asked to stop before there was anything to write; what went on then.
    Interrupted(&'static str),
    /// What was read makes no scene.
    Build(Box<Diagnostic>),
    Memory(String),
    /// Bytes.
    BuildMemory {
        takes: f64,
        limit: f64,
    },
    Sensor {
        asked: String,
        known: Vec<String>,
    },
    /// A method of several that did not finish its first pass.
    Method {
        method: &'static str,
    },
    /// A part of the image that is none, in words.
    Region(String),
    Start(StartError),
    /// A fault of our own in a pass, and the complete passes that the written image has, if one was written.
    Panicked {
        panic: Panic,
        passes: Option<u64>,
    },
    /// A value that is not finite, where the render is to stop at the first of those, and the passes that the written image has.
    NotFinite {
        place: Box<NotFinite>,
        passes: Option<u64>,
    },
    /// A checkpoint whose passes have left out values already.
    LeftOut {
        path: PathBuf,
        values: u64,
    },
    Resume(ResumeError),
    Maps(MapsError),
    Sweep(SweepError),
    Write(WriteError),
    /// Files in two roles, as known once the scene was read.
    Roles(Clash),
    /// Results that standard output did not take.
    StandardOutput(String),
    Read(ReadError),
    #[cfg(feature = "window")]
    Window(String),
    Compare {
        a: String,
        b: String,
        cause: CompareError,
    },
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Open(cause) => cause.fmt(f),
            Self::Interrupted(at) => write!(f, "interrupted while {at}: nothing was written"),
            Self::Build(cause) => cause.fmt(f),
            Self::Memory(why) => {
                write!(
                    f,
                    "{why}. A smaller --size, --spp or --photons needs less; --memory sets the limit{Hint}"
                )
            }
            Self::BuildMemory { takes, limit } => write!(
                f,
                "building this scene takes about {:.0} MiB; {:.0} MiB may be used. --memory sets the limit{Hint}",
                takes / f64::from(1 << 20),
                limit / f64::from(1 << 20)
            ),
            Self::Sensor { asked, known } => {
                let known: Vec<_> = known.iter().take(MAX_NAMES).map(|name| quoted(name)).collect();
                write!(f, "the scene has no sensor {}; it has {}", quoted(asked), known.join(", "))
            }
            Self::Method { method } => {
                write!(
                    f,
                    "--integrator {method} did not finish its first pass; --integrator {method} alone says why"
                )
            }
            Self::Region(why) => f.write_str(why),
            Self::Start(cause) => cause.fmt(f),
            Self::Panicked { panic, passes: Some(passes) } => {
                write!(f, "{panic}. What was written is the image after {passes} complete passes")
            }
            Self::Panicked { panic, passes: None } => write!(f, "{panic}. No image was written"),
            Self::NotFinite { place, passes: Some(passes) } => {
                write!(
                    f,
                    "stopped by --strict: {place}. What was written is the image after {passes} complete passes"
                )
            }
            Self::NotFinite { place, passes: None } => {
                write!(f, "stopped by --strict: {place}. No image was written")
            }
            Self::LeftOut { path, values } => write!(
                f,
                "{}: the passes of this checkpoint have left out {values} values that were not finite, and it does not say where: \
                 --strict finds the first in a render from its beginning",
                shown_path(path)
            ),
            Self::Resume(cause) => cause.fmt(f),
            Self::Maps(cause) => cause.fmt(f),
            Self::Sweep(cause) => cause.fmt(f),
            Self::Write(cause) => cause.fmt(f),
            Self::Roles(clash) => f.write_str(&clash.message),
            Self::StandardOutput(cause) => write!(f, "cannot write standard output: {cause}"),
            Self::Read(cause) => cause.fmt(f),
            #[cfg(feature = "window")]
            Self::Window(cause) => cause.fmt(f),
            Self::Compare { a, b, cause } => write!(f, "A is {a}, B is {b}: {cause}"),
        }
    }
}

/// What the system's own limit has to do with a refusal for memory, if there is one.
struct Hint;

impl fmt::Display for Hint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        Confined::of_system().map_or(Ok(()), |confined| write!(f, ". Beside it, {confined}"))
    }
}

impl Failure {
    /// Why a scene was not opened.
    pub(crate) fn of_open(cause: OpenError) -> Self {
        match cause {
            OpenError::Cancelled(_) => Self::Interrupted("reading the scene"),
            OpenError::Faults(_) => Self::Open(cause),
        }
    }

    /// Why the scene of that name cannot be built, with its place.
    pub(crate) fn of_build(opened: &Opened, scene: &str, cause: &BuildError) -> Self {
        if let BuildError::Cancelled(_) = cause {
            return Self::Interrupted("building the scene");
        }
        Self::Build(Box::new(opened.finding(Severity::Error, scene, cause.part(), cause.to_string())))
    }
}

impl From<WriteError> for Failure {
    fn from(cause: WriteError) -> Self {
        Self::Write(cause)
    }
}

impl From<ReadError> for Failure {
    fn from(cause: ReadError) -> Self {
        Self::Read(cause)
    }
}

impl From<SweepError> for Failure {
    fn from(cause: SweepError) -> Self {
        match cause {
            SweepError::Cancelled(_) => Self::Interrupted("making the reference"),
            other => Self::Sweep(other),
        }
    }
}

impl From<MapsError> for Failure {
    fn from(cause: MapsError) -> Self {
        Self::Maps(cause)
    }
}

impl From<ResumeError> for Failure {
    fn from(cause: ResumeError) -> Self {
        Self::Resume(cause)
    }
}

impl From<StartError> for Failure {
    fn from(cause: StartError) -> Self {
        match cause {
            StartError::Cancelled(_) => Self::Interrupted("collecting hit points"),
            other => Self::Start(other),
        }
    }
}
