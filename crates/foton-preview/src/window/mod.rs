//! The window itself: the system's events in, frames out, and when to draw.

mod adapter;
mod app;
mod frame_log;
mod live;
mod pace;

use std::path::PathBuf;
use std::sync::Arc;

use foton_session::Engine;
use foton_session::engine::{Command, Loader, Setup, Source};
use thiserror::Error;
use winit::event_loop::EventLoop;

use crate::preferences::Preferences;
use crate::state::State;

/// What to open, and with what.
pub struct Options {
    /// The scene to begin with.
    pub scene: Source,
    /// How scenes are opened and saved.
    pub loader: Arc<dyn Loader>,
    /// Names of the scenes that ship with the program.
    pub built_in: Vec<String>,
    /// Renders beyond this many bytes are refused.
    pub memory_limit: Option<f64>,
    /// Where to write a line for each frame drawn.
    pub frame_log: Option<PathBuf>,
}

/// Why there is no window. The render can go on without one.
#[derive(Debug, Error)]
pub enum WindowError {
    /// No display, or no libraries to talk to it.
    #[error("no window can be opened: {0}")]
    NoDisplay(String),
    /// Nothing that can draw.
    #[error("no graphics adapter can draw a window: {0}")]
    NoAdapter(String),
    /// The log cannot be written.
    #[error("{path}: {cause}", path = foton_input::shown_path(path))]
    Log {
        /// Its path.
        path: PathBuf,
        /// What the system says.
        cause: std::io::Error,
    },
}

/// What wakes the event loop.
#[derive(Debug)]
enum UserEvent {
    /// The engine has a frame or an event.
    Wake,
    /// egui wants to be drawn again after a while.
    Repaint(std::time::Duration),
    /// The adapter of a number is gone.
    DeviceLost(u64),
    /// A screen reader asks.
    AccessKit(egui_winit::accesskit_winit::Event),
}

impl From<egui_winit::accesskit_winit::Event> for UserEvent {
    fn from(event: egui_winit::accesskit_winit::Event) -> Self {
        Self::AccessKit(event)
    }
}

/// What the system says, without the place in a library's source.
fn reason(error: &impl std::fmt::Display) -> String {
    let text = error.to_string();
    match text.strip_prefix("os error at ").and_then(|rest| rest.split_once(": ")) {
        Some((_, reason)) => reason.to_owned(),
        None => text,
    }
}

/// Opens the window and stays until it is closed.
///
/// # Errors
/// When there can be no window; see [`WindowError`]. Nothing was rendered then.
pub fn run(options: Options) -> Result<(), WindowError> {
    let create =
        |path: PathBuf| frame_log::FrameLog::create(&path).map_err(|cause| WindowError::Log { path, cause });
    let log = options.frame_log.map(create).transpose()?;
    let events = EventLoop::<UserEvent>::with_user_event().build();
    let events = events.map_err(|cause| WindowError::NoDisplay(reason(&cause)))?;
    let proxy = events.create_proxy();
    let wake = proxy.clone();
    let setup = Setup {
        loader: options.loader,
        wake: Box::new(move || {
            // The loop is gone when the window is closed.
            let _ = wake.send_event(UserEvent::Wake);
        }),
        memory_limit: options.memory_limit,
    };
    let engine = Engine::spawn(setup).map_err(|cause| WindowError::NoDisplay(cause.to_string()))?;
    engine.send(Command::Open(options.scene));
    let state = State::new(Preferences::load(), options.built_in);
    let mut app = app::App::new(engine, proxy, state, log);
    let ended = events.run_app(&mut app);
    app.finish();
    match (app.take_error(), ended) {
        (Some(error), _) => Err(error),
        (None, Err(cause)) => Err(WindowError::NoDisplay(reason(&cause))),
        (None, Ok(())) => Ok(()),
    }
}
