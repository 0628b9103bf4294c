//! The window itself: the system's events in, frames out, and when to draw.

mod adapter;
mod app;
mod error;
mod event;
mod frame_log;
mod live;
mod pace;
mod recent;

use std::path::PathBuf;
use std::sync::Arc;

use foton_session::Engine;
use foton_session::engine::{Command, Loader, Setup, Source};
use winit::event_loop::EventLoop;

use app::App;
pub use error::WindowError;
use error::reason;
use event::UserEvent;
use frame_log::FrameLog;

use crate::looking::BuiltIn;
use crate::preferences::Preferences;
use crate::state::State;

/// What to open, and with what.
pub struct Options {
    /// The scene to begin with.
    pub scene: Source,
    /// How scenes are opened and saved.
    pub loader: Arc<dyn Loader>,
    /// Scenes that ship with the program.
    pub built_in: Vec<BuiltIn>,
    /// Renders beyond this many bytes are refused.
    pub memory_limit: Option<f64>,
    /// Where to write a line for each frame drawn.
    pub frame_log: Option<PathBuf>,
    /// Is given what closes the window from another thread, as its own button does.
    pub closes: fn(Close),
}

/// Closes the window.
pub type Close = Box<dyn Fn() + Send>;

/// Opens the window and stays until it is closed.
///
/// # Errors
/// When there can be no window; see [`WindowError`]. Nothing was rendered then.
pub fn run(options: Options) -> Result<(), WindowError> {
    let log = options.frame_log.as_deref().map(FrameLog::create).transpose()?;
    let events = EventLoop::<UserEvent>::with_user_event().build();
    let events = events.map_err(|cause| WindowError::NoDisplay(reason(&cause)))?;
    let proxy = events.create_proxy();
    let wake = proxy.clone();
    let wake = Box::new(move || {
        // The loop is gone when the window is closed.
        let _ = wake.send_event(UserEvent::Wake);
    });
    let setup = Setup::new(options.loader, wake, options.memory_limit);
    let close = events.create_proxy();
    (options.closes)(Box::new(move || {
        let _ = close.send_event(UserEvent::Close);
    }));
    let engine = Engine::spawn(setup).map_err(|cause| WindowError::NoDisplay(cause.to_string()))?;
    engine.send(Command::Open(options.scene));
    let mut preferences = Preferences::load();
    preferences.starts = preferences.starts.saturating_add(1);
    let state = State::new(preferences, options.built_in);
    let mut app = App::new(engine, proxy, state, log);
    let ended = events.run_app(&mut app);
    app.finish();
    match (app.take_error(), ended) {
        (Some(error), _) => Err(error),
        (None, Err(cause)) => Err(WindowError::NoDisplay(reason(&cause))),
        (None, Ok(())) => Ok(()),
    }
}
