//! What the program says: a progress bar on a terminal's stderr, JSON lines on stdout where asked for, findings on stderr.

use std::fmt;
use std::io::{self, ErrorKind, Write};
use std::path::PathBuf;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

use foton_film::{ReadError, WriteError};
use foton_format::{Diagnostic, OpenError, Opened, Severity};
use foton_input::{printable, quoted, shown_path};
use foton_integrator::{DirectLight, Ledger, NotFinite, Render};
use foton_measure::CompareError;
use foton_measure::sweep::SweepError;
use foton_scene::{BuildError, BuildStep};
use foton_session::checkpoint::ResumeError;
use foton_session::{Panic, Progress, Session, StartError, StopRule};
use indicatif::{ProgressBar, ProgressStyle};
use serde_json::{Value, json};

use crate::figure::{self, add_error, classes_text, error_text, upper_end_text};
use crate::memory::Confined;
use crate::roles::Clash;

/// Power that is cut off beyond this share of what is emitted is worth a warning.
const WORTH_A_WARNING: f64 = 1e-3;

/// Names that a message lists at most.
const MOST_NAMES: usize = 20;

/// Why nothing was rendered.
#[derive(Debug)]
pub(crate) enum Failure {
    Open(OpenError),
    /// Someone asked to stop before there was anything to write; what went on then.
    Interrupted(&'static str),
    /// What was read makes no scene.
    Build(Diagnostic),
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
                let known: Vec<_> = known.iter().take(MOST_NAMES).map(|name| quoted(name)).collect();
                write!(f, "the scene has no sensor {}; it has {}", quoted(asked), known.join(", "))
            }
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

/// A text for a terminal, in which lines are our own and nothing else does more than show itself.
fn harmless(text: &str) -> String {
    text.lines().map(printable).collect::<Vec<_>>().join("\n")
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
        Self::Build(opened.finding(Severity::Error, scene, cause.part(), cause.to_string()))
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

/// The program's voice.
pub(crate) struct Talk {
    json: bool,
    bar: ProgressBar,
    /// Whether it was said that the error stays above its goal.
    said_floor: AtomicBool,
    /// Why a line on stdout was lost, of the first one.
    lost: OnceLock<String>,
}

impl Talk {
    pub(crate) fn new(json: bool) -> Self {
        let (said_floor, lost) = (AtomicBool::new(false), OnceLock::new());
        Self { json, bar: ProgressBar::hidden(), said_floor, lost }
    }

    /// A line on stdout: what was asked for.
    pub(crate) fn out(&self, text: &str) {
        let mut stdout = io::stdout().lock();
        let written = writeln!(stdout, "{}", text).and_then(|()| stdout.flush());
        drop(stdout);
        match written {
            Ok(()) => {}
            // A reader that has gone away has read all that it wanted, and is no reason to stop rendering.
            Err(cause) if cause.kind() == ErrorKind::BrokenPipe => {}
            Err(cause) if self.lost.get().is_none() => {
                self.line(&format!("warning: standard output cannot be written: {cause}"));
                let _ = self.lost.set(cause.to_string());
            }
            Err(_) => {}
        }
    }

    /// Why something that belongs on stdout is not there, if it is not.
    pub(crate) fn lost(&self) -> Option<&str> {
        self.lost.get().map(String::as_str)
    }

    /// A line of JSON, if any was asked for.
    pub(crate) fn event(&self, event: &Value) {
        if self.json {
            self.out(&foton_input::json(&event.to_string()));
        }
    }

    /// A line on stderr, above the bar.
    pub(crate) fn line(&self, text: &str) {
        self.bar.suspend(|| {
            let _ = writeln!(io::stderr().lock(), "{}", harmless(text));
        });
    }

    /// Something to know that does not stop the render.
    pub(crate) fn warning(&self, message: &str) {
        self.event(&json!({ "event": "warning", "message": message }));
        self.line(&format!("warning: {message}"));
    }

    /// Something that a picture does not show of itself.
    pub(crate) fn note(&self, message: &str) {
        self.event(&json!({ "event": "note", "message": message }));
        self.line(&format!("note: {message}"));
    }

    /// A finding in a scene file that does not stop the render.
    pub(crate) fn finding(&self, d: &Diagnostic) {
        self.event(&located("warning", d));
        self.line(&format!("warning: {d}"));
    }

    /// Why nothing was rendered.
    pub(crate) fn failure(&mut self, failure: &Failure) {
        self.bar.finish_and_clear();
        let found = match failure {
            Failure::Open(cause) => cause.diagnostics(),
            Failure::Build(diagnostic) => std::slice::from_ref(diagnostic),
            _ => &[],
        };
        if !found.is_empty() {
            for d in found {
                let severity = match d.severity {
                    Severity::Warning => "warning",
                    Severity::Error => "error",
                };
                self.event(&located(severity, d));
                self.line(&format!("{severity}: {d}"));
            }
            if found.iter().any(|d| d.message.ends_with("MiB may be used"))
                && let Some(confined) = Confined::of_system()
            {
                self.line(&confined.to_string());
            }
            return;
        }
        if let Failure::Interrupted(at) = failure {
            self.event(&json!({ "event": "interrupted", "while": at }));
            self.line(&failure.to_string());
            return;
        }
        if let Failure::NotFinite { place, .. } = failure {
            self.event(&not_finite(place));
        }
        if let Failure::Roles(clash) = failure {
            self.json &= !clash.is_standard_output;
        }
        let message = failure.to_string();
        self.event(&json!({ "event": "error", "message": message }));
        self.line(&format!("error: {message}"));
    }

    /// Starts the bar; it shows only on a terminal.
    pub(crate) fn begin(&mut self) {
        self.bar = ProgressBar::new(1000);
        let style = ProgressStyle::with_template("{bar:32} {elapsed}  {msg}");
        self.bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        self.bar.set_message("reading the scene");
    }

    /// Says what is done next, from its beginning.
    pub(crate) fn stage(&self, what: &'static str) {
        self.bar.set_position(0);
        self.bar.set_message(what);
    }

    /// Says how far building a scene is, from any thread.
    pub(crate) fn building(&self) -> impl Fn(BuildStep, f64) + Sync + use<> {
        let bar = self.bar.clone();
        move |step, share| {
            bar.set_position((share * 1000.0) as u64);
            bar.set_message(step.text());
        }
    }

    /// Says how far something is, from 0 to 1, and what it is at.
    pub(crate) fn progress(&self, fraction: f64, what: String) {
        self.bar.set_position((fraction * 1000.0) as u64);
        self.bar.set_message(what);
    }

    /// Ends the bar.
    pub(crate) fn end(&self) {
        self.bar.finish_and_clear();
    }

    /// Says how a render stands after a pass.
    pub(crate) fn pass(&self, p: &Progress<'_>, rule: &StopRule) {
        let seconds = p.elapsed.as_secs_f64();
        let rate = |n: u64| n as f64 / seconds.max(1e-9);
        let r = &p.report;
        let error = p.render.error();
        if self.json {
            let mut event = json!({
                "event": "pass",
                "pass": r.pass,
                "photons": r.photons,
                "seconds": seconds,
                "photons_per_s": rate(r.photons),
                "rays_per_s": rate(p.rays),
                "radius_median": p.render.radii().median,
                "no_photon_share": r.no_photon_share,
                "bytes": p.render.bytes(),
                "stored": r.stored,
                "candidates": r.candidates,
                "accepted": r.accepted,
                "radii_at_floor": r.floored,
            });
            add_error(&mut event, error.as_ref());
            self.event(&event);
        }
        let too_high =
            rule.error.zip(error).and_then(|(goal, e)| figure::out_of_reach(goal, &e, r, p.render));
        if let Some(why) = too_high.filter(|_| !self.said_floor.swap(true, Ordering::Relaxed)) {
            self.warning(&why);
        }
        if let Some(fraction) = rule.fraction(r.pass, p.elapsed, error.as_ref()) {
            self.bar.set_position((fraction * 1000.0) as u64);
        }
        self.bar.set_message(format!(
            "pass {}, {:.1} M photons, {:.2} M/s, {:.1} % of hit points without a photon{}",
            r.pass,
            r.photons as f64 / 1e6,
            rate(r.photons) / 1e6,
            r.no_photon_share * 100.0,
            error.map_or_else(String::new, |e| format!(", {}", error_text(&e)))
        ));
    }

    /// Says that a render is done, what it wrote, and where its light went.
    pub(crate) fn done(&self, session: &Session, outputs: &[String]) {
        self.bar.finish_and_clear();
        let render = session.render();
        let seconds = session.elapsed().as_secs_f64();
        let stages: serde_json::Map<_, _> =
            session.stages().iter().map(|(s, t)| (s.name().to_owned(), json!(t.as_secs_f64()))).collect();
        let mut done = json!({
            "event": "done",
            "passes": render.passes(),
            "photons": render.photons_emitted(),
            "seconds": seconds,
            "outputs": outputs,
            "ledger": ledger_json(render.ledger(), render.photons_emitted(), render.scene().normalisation().scale()),
            "hit_points": render.start_report().hit_points,
            "eye_rays": render.start_report().eye_rays,
            "stages": stages,
            "lights": lights_json(render),
        });
        add_error(&mut done, render.error().as_ref());
        self.event(&done);
        if self.json {
            return;
        }
        let shares: Vec<String> = session
            .stages()
            .iter()
            .filter(|(_, t)| !t.is_zero())
            .map(|(s, t)| format!("{} {:.2} s", s.name().replace('_', " "), t.as_secs_f64()))
            .collect();
        self.line(&format!(
            "{} passes, {:.1} M photons in {seconds:.1} s ({:.2} M/s): {}",
            render.passes(),
            render.photons_emitted() as f64 / 1e6,
            render.photons_emitted() as f64 / 1e6 / seconds.max(1e-9),
            shares.join(", ")
        ));
        if let Some(error) = render.error() {
            self.line(&format!(
                "{}{}; 90 % confidence {:.2} to {:.2} %, {}; without what eye samples miss and what no photon has found",
                error_text(&error),
                classes_text(&error),
                100.0 * error.low,
                100.0 * error.high,
                upper_end_text(&error)
            ));
        }
        for path in outputs {
            self.line(&format!("wrote {path}"));
        }
    }

    /// Warns of emitters that most photons leave in vain.
    pub(crate) fn check_lights(&self, render: &Render) {
        // With shadow rays the photons of a light need not reach anything that it lights directly.
        if render.settings().ppm.direct_light == DirectLight::ShadowRays {
            return;
        }
        let photons = render.photons_emitted();
        for (emitter, light) in render.scene().emitters().iter().zip(render.light_use()) {
            if light.is_starved(photons) {
                self.warning(&format!(
                    "{} takes {:.0} % of the photons, and {:.2} % of those come near anything that is seen: what it lights \
                     converges slowly",
                    quoted(&emitter.name),
                    100.0 * light.emitted as f64 / photons as f64,
                    100.0 * light.hit_rate()
                ));
            }
        }
    }

    /// Warns of light that went missing, and says where.
    pub(crate) fn check_ledger(&self, render: &Render) {
        let ledger = render.ledger();
        let materials =
            || render.scene().materials().iter().map(|m| m.name.as_str()).zip(render.material_losses());
        let share = ledger.truncated / ledger.emitted.max(f64::MIN_POSITIVE);
        if share > WORTH_A_WARNING {
            let most = materials().max_by(|a, b| a.1.truncated.total_cmp(&b.1.truncated));
            let place = most.map_or_else(String::new, |(name, loss)| {
                format!(", {:.0} % of that at {}", 100.0 * loss.truncated / ledger.truncated, quoted(name))
            });
            self.warning(&format!(
                "{:.1} % of the emitted power was cut off at the longest path{place}; --max-depth sets it",
                share * 100.0
            ));
        }
        let eye_paths = render.start_report().dropped;
        if eye_paths > 0 {
            self.warning(&format!("{eye_paths} eye paths were dropped because their weight was not finite"));
        }
        if ledger.dropped > 0 {
            let lights = render.scene().emitters().iter().zip(render.light_use());
            let lights = lights.map(|(emitter, light)| (emitter.name.as_str(), light.dropped));
            let all: Vec<_> = lights.chain(materials().map(|(name, loss)| (name, loss.dropped))).collect();
            let gathered = ledger.dropped - all.iter().map(|(_, n)| n).sum::<u64>().min(ledger.dropped);
            let named =
                all.iter().filter(|(_, n)| *n > 0).map(|(name, n)| format!("{n} at {}", quoted(name)));
            let gathered = (gathered > 0).then(|| format!("{gathered} where light was gathered"));
            let places: Vec<String> = named.take(MOST_NAMES).chain(gathered).collect();
            self.warning(&format!(
                "{} photons or sums of them were dropped because they were not finite: {}",
                ledger.dropped,
                places.join(", ")
            ));
        }
        if let Some(place) = render.first_not_finite() {
            self.event(&not_finite(place));
            self.line(&format!("the first of those: {place}; --strict stops there"));
        }
    }
}

fn not_finite(place: &NotFinite) -> Value {
    let [shape, material] = place.surface.clone().map_or([None, None], |names| names.map(Some));
    json!({
        "event": "not_finite", "pass": place.pass, "quantity": place.quantity.name(), "light": place.light,
        "shape": shape, "material": material, "position": place.position.to_array(),
    })
}

fn located(event: &str, d: &Diagnostic) -> Value {
    json!({ "event": event, "message": d.message, "file": d.file, "line": d.line, "column": d.column })
}

/// What each emitter's photons were good for.
fn lights_json(render: &Render) -> Value {
    let lights = render.scene().emitters().iter().zip(render.light_use());
    lights
        .map(|(emitter, light)| {
            json!({
                "name": emitter.name, "photons": light.emitted, "reached": light.reached,
                "hit_rate": light.hit_rate(),
            })
        })
        .collect()
}

/// The ledger in watts: per photon, and back from scene units, in which areas carry the squared scale.
fn ledger_json(ledger: &Ledger, photons: u64, scale: f64) -> Value {
    let watts = |sum: f64| sum / (photons.max(1) as f64 * scale * scale);
    json!({
        "emitted": watts(ledger.emitted),
        "absorbed": watts(ledger.absorbed),
        "escaped": watts(ledger.escaped),
        "roulette": watts(ledger.roulette),
        "truncated": watts(ledger.truncated),
        "shading_normals": watts(ledger.shading_normals),
        "shading_normals_gain": watts(ledger.shading_gain),
        "lost": watts(ledger.lost),
        "dropped_photons": ledger.dropped,
        "imbalance": ledger.imbalance(),
    })
}
