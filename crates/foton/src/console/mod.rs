//! What the program says: a progress bar on a terminal's stderr, JSON lines on stdout where asked for, findings on stderr.

mod checks;
mod failure;
mod json;
pub(crate) mod located;

use std::io::{self, ErrorKind, Write};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use foton_format::{Diagnostic, Severity};
use foton_input::printable;
use foton_integrator::RenderSettings;
use foton_scene::{BuildStep, Scene};
use foton_session::findings::{self, Finding, SettingNames};
use foton_session::{Progress, Session, StopRule};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use serde_json::{Value, json};

use crate::figure::{add_error, classes_text, error_text, limits_text};
use crate::memory::Confined;

pub(crate) use failure::Failure;
use json::{ledger_json, lights_json, located, not_finite};

/// A text for a terminal, in which lines are our own and nothing else does more than show itself.
fn harmless(text: &str) -> String {
    text.lines().map(printable).collect::<Vec<_>>().join("\n")
}

fn write_above(bar: &ProgressBar, text: &str) {
    bar.suspend(|| {
        let _ = writeln!(io::stderr().lock(), "{}", harmless(text));
    });
}

/// So many findings are shown with the line that they are about.
const MAX_LINES: usize = 20;

/// The program's voice.
pub(crate) struct Console {
    json: bool,
    bar: ProgressBar,
    /// Whether it was said that the error stays above its goal.
    said_floor: AtomicBool,
    /// Why a line on stdout was lost, of the first one.
    lost: OnceLock<String>,
    /// How many findings were shown with the line that they are about.
    shown_lines: AtomicUsize,
}

impl Console {
    pub(crate) fn new(json: bool) -> Self {
        let (said_floor, lost) = (AtomicBool::new(false), OnceLock::new());
        // Hidden until it begins; others have it by then.
        let bar = ProgressBar::with_draw_target(Some(1000), ProgressDrawTarget::hidden());
        Self { json, bar, said_floor, lost, shown_lines: AtomicUsize::new(0) }
    }

    /// Whether it says things in JSON.
    pub(crate) const fn is_json(&self) -> bool {
        self.json
    }

    /// A line on stdout: what was asked for.
    pub(crate) fn out(&self, text: &str) {
        let mut stdout = io::stdout().lock();
        let written = writeln!(stdout, "{}", harmless(text)).and_then(|()| stdout.flush());
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
        write_above(&self.bar, text);
    }

    /// What writes such a line from another thread.
    pub(crate) fn teller(&self) -> impl Fn(&str) + Send + 'static + use<> {
        let bar = self.bar.clone();
        move |text| write_above(&bar, text)
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

    /// A finding in a scene or a render.
    pub(crate) fn finding(&self, finding: &Finding) {
        if finding.kind.is_note() {
            self.note(&finding.text);
        } else {
            self.warning(&finding.text);
        }
    }

    /// What does not fit together in a scene and the settings of its render.
    pub(crate) fn of_settings(&self, scene: &Scene, settings: &RenderSettings) {
        let found = findings::of_settings(scene, settings, &SettingNames::OPTIONS);
        found.iter().for_each(|finding| self.finding(finding));
    }

    /// What is odd in a scene file, and does not stop the render.
    pub(crate) fn diagnostic(&self, d: &Diagnostic) {
        self.event(&located("warning", d));
        self.located(d);
    }

    /// A finding with the line that it is about, for the first of them.
    fn located(&self, d: &Diagnostic) {
        let has_line = self.shown_lines.fetch_add(1, Ordering::Relaxed) < MAX_LINES;
        let text = located::for_terminal(d, has_line);
        // It is printable as it is, and has colours on a terminal.
        self.bar.suspend(|| {
            let _ = writeln!(io::stderr().lock(), "{text}");
        });
    }

    /// Why nothing was rendered.
    pub(crate) fn failure(&mut self, failure: &Failure) {
        self.bar.finish_and_clear();
        let found = match failure {
            Failure::Open(cause) => cause.diagnostics(),
            Failure::Build(diagnostic) => std::slice::from_ref(&**diagnostic),
            _ => &[],
        };
        if !found.is_empty() {
            for d in found {
                let severity = match d.severity {
                    Severity::Warning => "warning",
                    Severity::Error => "error",
                };
                self.event(&located(severity, d));
                self.located(d);
            }
            if found.iter().any(|d| d.message.ends_with("MiB may be used"))
                && let Some(confined) = Confined::of_system()
            {
                self.line(&confined.to_string());
            }
            return;
        }
        if let Failure::Interrupted(at) = failure {
            static SAID: AtomicBool = AtomicBool::new(false);
            if SAID.swap(true, Ordering::SeqCst) {
                return;
            }
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
    pub(crate) fn begin(&self) {
        self.bar.set_draw_target(ProgressDrawTarget::stderr());
        let style = ProgressStyle::with_template("{bar:32} {elapsed}  {msg}");
        self.bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        self.bar.set_message("reading the scene");
    }

    /// Says what is done next, from its beginning.
    pub(crate) fn stage(&self, what: &'static str) {
        self.bar.set_position(0);
        self.bar.set_message(what);
    }

    /// Says how far reading a scene is.
    pub(crate) fn reading(&self) -> impl Fn(f64) + Send + Sync + 'static + use<> {
        let bar = self.bar.clone();
        move |share| bar.set_position((share * 1000.0) as u64)
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
        let names = &SettingNames::OPTIONS;
        let above_goal = rule.error.and_then(|goal| findings::above_goal(p.render, goal, r.floored, names));
        if let Some(finding) = above_goal.filter(|_| !self.said_floor.swap(true, Ordering::Relaxed)) {
            self.finding(&finding);
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
        let (passes, method) = (render.passes(), render.settings().method);
        let work = if method.has_photons() {
            let millions = render.photons_emitted() as f64 / 1e6;
            format!(
                "{passes} passes, {millions:.1} M photons in {seconds:.1} s ({:.2} M/s)",
                millions / seconds.max(1e-9)
            )
        } else {
            let samples = passes * u64::from(render.settings().samples_per_pixel.get());
            format!("{passes} passes, {samples} samples a pixel in {seconds:.1} s")
        };
        self.line(&format!("{work}: {}", shares.join(", ")));
        if let Some(error) = render.error() {
            self.line(&format!(
                "{}{}; 90 % confidence {:.2} to {:.2} %{}",
                error_text(&error),
                classes_text(&error),
                100.0 * error.low,
                100.0 * error.high,
                limits_text(&error, method)
            ));
        }
        for path in outputs {
            self.line(&format!("wrote {path}"));
        }
    }
}
