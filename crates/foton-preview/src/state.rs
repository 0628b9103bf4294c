//! What the window knows and what a person has set in it. Panels are functions of this; what they ask of the engine goes into
//! the outbox, so that tests drive them without an engine.

use std::borrow::Cow;
use std::collections::VecDeque;
use std::path::PathBuf;

use foton_film::ToneMap;
use foton_session::SettingChange;
use foton_session::engine::{Command, Configuration, Event, Frame, Picture, Source, ViewMode};
use foton_session::snapshot::Look;

use crate::editing::Editing;
use crate::files::FileDialog;
use crate::looking::{BuiltIn, Looking};
use crate::message::{self, Message, Tone};
use crate::preferences::Preferences;

/// Points of a plot at most; older ones are thinned.
const PLOT_POINTS: usize = 512;

/// A picture to compare with.
#[derive(Clone, Debug)]
pub(crate) struct Pinned {
    pub(crate) picture: Picture,
    pub(crate) label: String,
    /// The number of the pass in the history, if it is from there.
    pub(crate) entry: Option<u64>,
}

/// How the image lies in the window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Placement {
    /// Points of the window per pixel of the image; `None`: as large as fits.
    pub(crate) zoom: Option<f32>,
    /// The middle of the view, as shares of the image.
    pub(crate) centre: [f32; 2],
}

impl Placement {
    pub(crate) const FIT: Self = Self { zoom: None, centre: [0.5, 0.5] };
}

/// What a file dialog is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum DialogPurpose {
    OpenScene,
    SaveScene,
    ImportMesh,
    KeepCheckpoint,
    ResumeCheckpoint,
}

/// What ends the scene that is open.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Leaving {
    /// Another scene is opened.
    Open(Source),
    /// The window is closed.
    Close,
}

/// What the pointer does with the scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Grip {
    #[default]
    None,
    /// Turning the camera.
    Orbit,
    /// Moving the camera across.
    Pan,
    /// Moving the image in the window.
    Image,
    /// Dragging a handle of what is selected.
    Object,
    /// Moving the line of the wipe.
    Wipe,
}

/// A value over time.
#[derive(Clone, Debug, Default)]
pub(crate) struct Trace {
    pub(crate) points: VecDeque<[f64; 2]>,
}

impl Trace {
    pub(crate) fn push(&mut self, seconds: f64, value: f64) {
        if !value.is_finite() {
            return;
        }
        self.points.push_back([seconds, value]);
        if self.points.len() > PLOT_POINTS {
            // The shape stays, at half the detail.
            let mut keep = false;
            self.points.retain(|_| {
                keep = !keep;
                keep
            });
        }
    }
}

/// The pass that traces end at.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Traced {
    pub(crate) render: u64,
    pub(crate) pass: u64,
}

/// All of it.
pub(crate) struct State {
    pub(crate) frame: Option<Frame>,
    /// What is asked of the engine, in order.
    pub(crate) outbox: Vec<Command>,
    pub(crate) messages: Vec<Message>,
    pub(crate) preferences: Preferences,
    pub(crate) placement: Placement,
    pub(crate) exposure_stops: f32,
    pub(crate) tone_map: ToneMap,
    /// How PNGs show radiance, as the engine was told.
    told_look: Look,
    /// Whether the scene that is being opened is the present one, read again.
    pub(crate) reloads: bool,
    pub(crate) view: ViewMode,
    pub(crate) show_photons: bool,
    /// Whether the paths of photons to the pixel under the pointer are drawn.
    pub(crate) show_paths: bool,
    pub(crate) auto_snapshots: bool,
    pub(crate) pinned: Option<Pinned>,
    pub(crate) looking: Looking,
    /// Where the wipe's line is, as a share of the view's width.
    pub(crate) wipe: f32,
    pub(crate) show_help: bool,
    pub(crate) dialog: Option<(DialogPurpose, FileDialog)>,
    pub(crate) grip: Grip,
    pub(crate) editing: Editing,
    /// When the camera last moved by wheel or key: a while after, the whole picture is due.
    pub(crate) moved_at: Option<f64>,
    /// The pixel under the pointer, as last told to the engine.
    pub(crate) probed: Option<[u32; 2]>,
    /// Total error in per cent, the upper end of its interval, and its parts.
    pub(crate) error: Trace,
    pub(crate) upper_error: Trace,
    pub(crate) noise: Trace,
    pub(crate) bias: Trace,
    /// Where the traces end.
    pub(crate) traced: Traced,
    /// The scene's file changed on the disk.
    pub(crate) changed_on_disk: bool,
    pub(crate) built_in: Vec<BuiltIn>,
    /// Where controls are, in points, by name: for scripts that drive the window.
    pub(crate) places: Vec<(Cow<'static, str>, egui::Rect)>,
    /// What there is to say of the adapter.
    pub(crate) adapter: String,
    /// Texels along the side of the adapter's largest texture.
    pub(crate) largest_texture: u32,
    /// Someone asked for the end.
    pub(crate) wants_to_close: bool,
    /// What waits until a person says what becomes of unsaved edits.
    pub(crate) leaving: Option<Leaving>,
    /// The question about them takes the keyboard in the next frame.
    pub(crate) wants_focus_on_save: bool,
    /// What follows once the scene is saved.
    pub(crate) after_save: Option<Leaving>,
    /// A configuration that was not applied yet, and the one that it was made from.
    pub(crate) draft: Option<(Configuration, Configuration)>,
    /// The numbers of stop rules that are off: passes, seconds, per cent.
    pub(crate) stop_values: [f64; 3],
    /// Whether the picture has the window to itself.
    pub(crate) hides_panels: bool,
    /// Whether someone typed into a field in the last frame.
    pub(crate) is_typing: bool,
    /// Whether a control, and not the picture, had the keyboard's focus in the last frame.
    pub(crate) has_focused_control: bool,
    /// The widget that is the picture.
    pub(crate) canvas: Option<egui::Id>,
}

impl State {
    pub(crate) fn new(preferences: Preferences, built_in: Vec<BuiltIn>) -> Self {
        Self {
            frame: None,
            outbox: Vec::new(),
            messages: Vec::new(),
            preferences,
            placement: Placement::FIT,
            exposure_stops: 0.0,
            tone_map: ToneMap::default(),
            told_look: Look::default(),
            reloads: false,
            view: ViewMode::Radiance,
            show_photons: false,
            show_paths: false,
            auto_snapshots: false,
            pinned: None,
            looking: Looking::default(),
            wipe: 0.5,
            show_help: false,
            dialog: None,
            grip: Grip::None,
            editing: Editing::default(),
            moved_at: None,
            probed: None,
            error: Trace::default(),
            upper_error: Trace::default(),
            noise: Trace::default(),
            bias: Trace::default(),
            traced: Traced::default(),
            changed_on_disk: false,
            built_in,
            places: Vec::new(),
            adapter: String::new(),
            largest_texture: 8192,
            wants_to_close: false,
            leaving: None,
            wants_focus_on_save: false,
            after_save: None,
            draft: None,
            stop_values: [64.0, 60.0, 2.0],
            hides_panels: false,
            is_typing: false,
            has_focused_control: false,
            canvas: None,
        }
    }

    /// Takes the newest frame.
    pub(crate) fn show(&mut self, frame: Frame) {
        let now = Traced { render: frame.render, pass: frame.stats.passes };
        let traces = [&mut self.error, &mut self.upper_error, &mut self.noise, &mut self.bias];
        if frame.render != self.traced.render {
            traces.into_iter().for_each(|trace| *trace = Trace::default());
        } else if now != self.traced
            && let Some(e) = &frame.stats.error
        {
            let seconds = frame.stats.elapsed.as_secs_f64();
            for (trace, share) in traces.into_iter().zip([e.total, e.high, e.noise, e.bias]) {
                trace.push(seconds, 100.0 * share);
            }
        }
        self.traced = now;
        self.frame = Some(frame);
    }

    /// Takes an event.
    pub(crate) fn hear(&mut self, event: Event) {
        match event {
            Event::Opened { name, warnings } => {
                self.placement = Placement::FIT;
                self.pinned = None;
                self.draft = None;
                self.changed_on_disk = false;
                if !std::mem::take(&mut self.reloads) {
                    self.reset_view();
                }
                self.notice(format!("Opened {name}"));
                for warning in warnings {
                    self.notice(warning);
                }
            }
            Event::Saved(paths) => {
                for path in paths {
                    self.notice(format!("Saved {}", foton_input::shown_path(&path)));
                }
            }
            Event::SceneSaved(path) => {
                self.changed_on_disk = false;
                self.notice(format!("Saved {}", foton_input::shown_path(&path)));
                if let Some(to) = self.after_save.take() {
                    self.go(to);
                }
            }
            Event::Notice(text) => self.notice(text),
            Event::Failed(text) => {
                self.reloads = false;
                // What could not be saved is not left.
                self.after_save = None;
                self.error(text);
            }
        }
    }

    pub(crate) fn notice(&mut self, text: impl Into<String>) {
        message::tell(&mut self.messages, Tone::Notice, text.into());
    }

    pub(crate) fn error(&mut self, text: impl Into<String>) {
        message::tell(&mut self.messages, Tone::Error, text.into());
    }

    pub(crate) fn ask(&mut self, command: Command) {
        self.outbox.push(command);
    }

    pub(crate) fn steer(&mut self, change: SettingChange) {
        self.ask(Command::Steer(change));
    }

    pub(crate) fn open(&mut self, path: PathBuf) {
        self.leave(Leaving::Open(Source::File(path)));
    }

    /// Leaves the scene that is open, or asks what becomes of its unsaved edits first.
    pub(crate) fn leave(&mut self, to: Leaving) {
        if self.frame.as_ref().is_some_and(|f| f.scene.is_unsaved) {
            self.leaving = Some(to);
            self.wants_focus_on_save = true;
        } else {
            self.go(to);
        }
    }

    /// Leaves the scene that is open, edits and all.
    pub(crate) fn go(&mut self, to: Leaving) {
        match to {
            Leaving::Open(source) => self.ask(Command::Open(source)),
            Leaving::Close => self.wants_to_close = true,
        }
    }

    /// What the window is called.
    pub(crate) fn title(&self) -> String {
        let scene = self.frame.as_ref().map(|f| &f.scene).filter(|s| !s.title.is_empty());
        scene.map_or_else(
            || "foton".to_owned(),
            |scene| format!("{}{} – foton", scene.title, if scene.is_unsaved { " (edited)" } else { "" }),
        )
    }

    /// Remembers where a control is.
    pub(crate) fn place(&mut self, name: impl Into<Cow<'static, str>>, response: &egui::Response) {
        self.places.push((name.into(), response.rect));
    }

    /// What frames should carry, told to the engine.
    pub(crate) fn choose_view(&mut self, view: ViewMode) {
        if self.view != view {
            self.view = view;
            self.ask(Command::SetView(view));
        }
    }

    /// Shows the next scene as it is: exposure, tone map and kinds of light were chosen for the one before.
    fn reset_view(&mut self) {
        self.exposure_stops = 0.0;
        self.tone_map = ToneMap::default();
        self.choose_view(ViewMode::Radiance);
    }

    /// Where snapshots go.
    pub(crate) fn snapshot_folder(&self) -> PathBuf {
        let folder = &self.preferences.snapshot_folder;
        if folder.as_os_str().is_empty() { foton_session::folders::pictures() } else { folder.clone() }
    }

    /// Tells the engine how PNGs are to show radiance, as a person last saw it, where that has changed.
    pub(crate) fn tell_look(&mut self) {
        let look = if self.preferences.png_as_shown {
            Look { tone_map: self.tone_map, exposure_stops: self.exposure_stops }
        } else {
            Look::default()
        };
        if look != self.told_look {
            self.told_look = look;
            self.ask(Command::SetLook(look));
        }
    }
}
