//! What happens when: the system's events, the engine's frames, and frames for the screen, never when nobody sees them.

use std::io::Write;
use std::path::PathBuf;
use std::time::{Duration, Instant, SystemTime};

use foton_session::Engine;
use foton_session::engine::{Command, Event, Frame, SceneEdit};
use winit::application::ApplicationHandler;
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoopProxy};
use winit::window::WindowId;

use super::error::WindowError;
use super::event::UserEvent;
use super::frame_log::FrameLog;
use super::live::Live;
use super::pace::Pace;
use super::recent::Recent;
use crate::message::Tone;
use crate::state::{Leaving, State};

/// How often to check whether the scene's file has changed.
const WATCH: Duration = Duration::from_secs(1);

/// How often to look for another adapter after one was lost: a driver that restarts takes a while.
const RETRY: Duration = Duration::from_secs(1);

pub(super) struct App {
    engine: Engine,
    proxy: EventLoopProxy<UserEvent>,
    state: State,
    log: Option<FrameLog>,
    live: Option<Live>,
    error: Option<WindowError>,
    pace: Pace,
    /// The first input that no frame has answered.
    unanswered: Option<Instant>,
    occluded: bool,
    watched: Option<(PathBuf, Option<SystemTime>)>,
    looked: Instant,
    recent: Recent,
}

impl App {
    pub(super) fn new(
        engine: Engine,
        proxy: EventLoopProxy<UserEvent>,
        state: State,
        log: Option<FrameLog>,
    ) -> Self {
        Self {
            engine,
            proxy,
            state,
            log,
            live: None,
            error: None,
            pace: Pace::new(Instant::now()),
            unanswered: None,
            occluded: false,
            watched: None,
            looked: Instant::now(),
            recent: Recent::default(),
        }
    }

    pub(super) const fn take_error(&mut self) -> Option<WindowError> {
        self.error.take()
    }

    /// What is being written is finished; a pass under way is not.
    pub(super) fn finish(&mut self) {
        self.state.preferences.save();
        self.engine.finish_writing();
        // No window is there any more to say what was not written, and where it is instead.
        while let Some(event) = self.engine.event() {
            if let Event::Failed(message) = event {
                let _ = writeln!(std::io::stderr().lock(), "error: {message}");
            }
        }
    }

    /// Takes what the engine has, and says when to show it.
    fn listen(&mut self) {
        let mut is_news = false;
        if let Some(frame) = self.engine.frame() {
            // Where a render begins or ends, the picture is due at once.
            let before = self.state.frame.as_ref();
            let place = |f: &Frame| (f.activity, f.render, f.pictured);
            is_news = before.is_none_or(|old| place(old) != place(&frame));
            self.state.show(frame);
            self.recent.mind(&mut self.state);
        }
        while let Some(event) = self.engine.event() {
            if matches!(event, Event::SceneSaved(_)) {
                self.watched = None;
            }
            self.state.hear(event);
            is_news = true;
        }
        self.pace.hear(Instant::now(), is_news);
    }

    fn draw(&mut self) {
        self.pace.begin();
        self.watch();
        let Some(live) = self.live.as_mut().filter(|l| l.is_visible() && !self.occluded) else { return };
        if live.adapter().is_none() {
            return self.recover();
        }
        let begin = Instant::now();
        let engine = &self.engine;
        let may_wait = self.pace.may_wait();
        let painted = live.draw(&mut self.state, |state| {
            let commands: Vec<_> = state.outbox.drain(..).collect();
            let waits = may_wait && commands.iter().any(answers_soon);
            for command in commands {
                if !engine.send(command) {
                    state.error("The engine does not answer");
                }
            }
            !waits
        });
        if !painted {
            return self.pace.wait(begin);
        }
        let now = Instant::now();
        self.pace.drawn(now);
        let since_input = self.unanswered.take().map(|at| now - at);
        if let Some(log) = &mut self.log {
            log.drawn(&self.state, now - begin, since_input);
            for message in self.state.messages.iter_mut().filter(|m| !m.is_logged) {
                log.message(message.tone == Tone::Error, &message.text);
                message.is_logged = true;
            }
        }
    }

    /// Looks whether the scene's file has changed since it was opened.
    fn watch(&mut self) {
        if self.looked.elapsed() < WATCH {
            return;
        }
        self.looked = Instant::now();
        let Some(file) = self.state.frame.as_ref().and_then(|f| f.scene.file.clone()) else { return };
        let changed = std::fs::metadata(&file).and_then(|m| m.modified()).ok();
        if let Some((path, before)) = &self.watched
            && *path == file
        {
            self.state.changed_on_disk |= changed.is_some() && changed != *before;
        }
        self.watched = Some((file, changed));
    }

    fn close(&mut self, event_loop: &ActiveEventLoop) {
        if event_loop.exiting() {
            return;
        }
        if let Some(log) = &mut self.log {
            log.closing();
        }
        event_loop.exit();
    }

    fn open_window(&mut self, event_loop: &ActiveEventLoop) {
        match Live::open(event_loop, &self.proxy, &self.state) {
            Ok(live) => {
                self.live = Some(live);
                self.introduce();
            }
            Err(error) => {
                self.error = Some(error);
                event_loop.exit();
            }
        }
    }

    /// Says what draws from here on, and lets it.
    fn introduce(&mut self) {
        let Some((live, adapter)) = self.live.as_ref().and_then(|l| Some((l, l.adapter()?))) else { return };
        if let Some(log) = &mut self.log {
            log.adapter(&adapter.words, adapter.is_software);
        }
        self.state.adapter.clone_from(&adapter.words);
        self.state.largest_texture = adapter.largest_texture;
        self.pace.is_software = adapter.is_software;
        live.window.request_redraw();
    }

    /// Finds another adapter, now or later. The engine does not know of it: passes go on.
    fn recover(&mut self) {
        let Some(live) = &mut self.live else { return };
        match live.recover(&self.proxy) {
            Ok(()) => {
                self.state.notice("The graphics adapter was lost and is back; the render went on");
                self.introduce();
            }
            Err(_) => self.pace.draw_at(Instant::now() + RETRY),
        }
    }
}

/// Whether a small picture follows at once, so that a frame without it is not worth its time.
const fn answers_soon(command: &Command) -> bool {
    matches!(command, Command::Camera { moving: true, .. } | Command::Edit(SceneEdit::DragTo { .. }))
}

impl ApplicationHandler<UserEvent> for App {
    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        if self.live.is_none() {
            self.open_window(event_loop);
        }
    }

    fn user_event(&mut self, event_loop: &ActiveEventLoop, event: UserEvent) {
        match event {
            UserEvent::Close => self.close(event_loop),
            UserEvent::Wake => {
                self.listen();
                // What was to be saved first is saved.
                if self.state.wants_to_close {
                    self.close(event_loop);
                }
            }
            UserEvent::Repaint(delay) => self.pace.repaint(Instant::now(), delay),
            UserEvent::DeviceLost(number) => {
                if self.live.as_mut().is_some_and(|live| live.lose(number)) {
                    self.recover();
                }
            }
            UserEvent::AccessKit(event) => {
                if let Some(live) = &mut self.live {
                    live.hear_a_screen_reader(event.window_event);
                    live.window.request_redraw();
                }
            }
        }
    }

    fn window_event(&mut self, event_loop: &ActiveEventLoop, _id: WindowId, event: WindowEvent) {
        let Some(live) = &mut self.live else { return };
        let response = live.egui.on_window_event(&live.window, &event);
        match event {
            // Some close windows without asking.
            WindowEvent::Destroyed => return self.close(event_loop),
            WindowEvent::CloseRequested => {
                self.state.leave(Leaving::Close);
                if self.state.wants_to_close {
                    return self.close(event_loop);
                }
                self.pace.draw_at(Instant::now());
            }
            WindowEvent::RedrawRequested => {
                self.draw();
                if self.state.wants_to_close {
                    self.close(event_loop);
                }
                return;
            }
            WindowEvent::Resized(size) => {
                live.resize(size.width, size.height);
                let size = size.to_logical(live.window.scale_factor());
                self.state.preferences.window = [size.width, size.height];
            }
            WindowEvent::Occluded(occluded) => {
                self.occluded = occluded;
                // What was not drawn meanwhile.
                self.pace.draw_at(Instant::now());
            }
            WindowEvent::DroppedFile(path) => self.state.open(path),
            WindowEvent::KeyboardInput { .. }
            | WindowEvent::MouseInput { .. }
            | WindowEvent::MouseWheel { .. }
            | WindowEvent::CursorMoved { .. } => {
                let now = Instant::now();
                self.unanswered.get_or_insert(now);
                self.pace.input(now);
            }
            _ => {}
        }
        if response.repaint {
            self.pace.draw_at(Instant::now());
        }
    }

    fn about_to_wait(&mut self, event_loop: &ActiveEventLoop) {
        let Some(due) = self.pace.due() else {
            event_loop.set_control_flow(ControlFlow::Wait);
            return;
        };
        if due > Instant::now() {
            event_loop.set_control_flow(ControlFlow::WaitUntil(due));
        } else if let Some(live) = &self.live {
            self.pace.begin();
            live.window.request_redraw();
            event_loop.set_control_flow(ControlFlow::Wait);
        }
    }
}
