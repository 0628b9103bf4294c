//! When to draw: at once on input, on new frames as often as drawing is cheap, never when nothing changed or nobody looks.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant, SystemTime};

use foton_session::Engine;
use foton_session::engine::{Change, Command, Frame};
use winit::application::ApplicationHandler;
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoopProxy};
use winit::window::WindowId;

use super::frame_log::FrameLog;
use super::live::Live;
use super::{UserEvent, WindowError};
use crate::state::{State, Tone};

/// Between frames that only new passes ask for, where drawing takes the cores that render.
const SOFTWARE_GAP: Duration = Duration::from_millis(330);

/// The same while a person acts, and between frames that only egui asks for: a frame that shows nothing new to the person would
/// hold up the render of one that does.
const SOFTWARE_ATTENTIVE_GAP: Duration = Duration::from_millis(120);

/// The same where a graphics card draws.
const HARDWARE_GAP: Duration = Duration::from_millis(33);

/// For so long after an input a person is taken to be waiting for the picture.
const ATTENTION: Duration = Duration::from_millis(500);

/// So long a frame waits for the picture of a move, where drawing would take the cores that make it.
const PATIENCE: Duration = Duration::from_millis(70);

/// Between looks at whether the scene's file has changed.
const WATCH: Duration = Duration::from_secs(1);

pub(super) struct App {
    engine: Engine,
    proxy: EventLoopProxy<UserEvent>,
    state: State,
    log: Option<FrameLog>,
    live: Option<Live>,
    error: Option<WindowError>,
    /// When the next frame is due.
    due: Option<Instant>,
    drawn: Instant,
    /// The first input that no frame has answered, and the last one.
    unanswered: Option<Instant>,
    last_input: Option<Instant>,
    occluded: bool,
    /// Whether the last frame was left to the picture that follows.
    waited: bool,
    watched: Option<(PathBuf, Option<SystemTime>)>,
    looked: Instant,
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
            due: None,
            drawn: Instant::now(),
            unanswered: None,
            last_input: None,
            occluded: false,
            waited: false,
            watched: None,
            looked: Instant::now(),
        }
    }

    pub(super) const fn take_error(&mut self) -> Option<WindowError> {
        self.error.take()
    }

    /// What is being written is finished; a pass under way is not.
    pub(super) fn finish(&mut self) {
        self.state.preferences.save();
        self.engine.finish_writing();
    }

    fn draw_at(&mut self, when: Instant) {
        self.due = Some(self.due.map_or(when, |due| due.min(when)));
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
        }
        while let Some(event) = self.engine.event() {
            self.state.hear(event);
            is_news = true;
        }
        let attentive = self.last_input.is_some_and(|at| at.elapsed() < ATTENTION);
        let gap = match (self.is_software(), is_news, attentive) {
            (false, ..) | (_, true, _) => HARDWARE_GAP,
            (true, false, true) => SOFTWARE_ATTENTIVE_GAP,
            (true, false, false) => SOFTWARE_GAP,
        };
        self.draw_at(self.drawn + gap);
    }

    /// Whether drawing takes the cores that render.
    fn is_software(&self) -> bool {
        self.live.as_ref().is_some_and(|l| l.is_software)
    }

    fn draw(&mut self) {
        self.due = None;
        self.watch();
        let Some(live) = self.live.as_mut().filter(|l| l.is_visible() && !self.occluded) else { return };
        let begin = Instant::now();
        let engine = &self.engine;
        // Not twice in a row: a hand that never rests would see nothing.
        let may_wait = live.is_software && !self.waited;
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
        self.waited = !painted;
        if !painted {
            self.draw_at(begin + PATIENCE);
            return;
        }
        self.drawn = Instant::now();
        let since_input = self.unanswered.take().map(|at| self.drawn - at);
        if let Some(log) = &mut self.log {
            log.drawn(&self.state, self.drawn - begin, since_input);
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
        let opened = match self.live.take() {
            None => Live::open(event_loop, &self.proxy, &self.state),
            Some(live) => {
                let window = Arc::clone(&live.window);
                drop(live);
                Live::draw_into(window, event_loop, &self.proxy)
            }
        };
        match opened {
            Ok(live) => {
                if let Some(log) = &mut self.log {
                    log.adapter(&live.adapter, live.is_software);
                }
                self.state.adapter.clone_from(&live.adapter);
                self.state.largest_texture = live.largest_texture;
                live.window.request_redraw();
                self.live = Some(live);
            }
            Err(error) => {
                self.error = Some(error);
                event_loop.exit();
            }
        }
    }
}

/// Whether a small picture follows at once, so that a frame without it is not worth its time.
const fn answers_soon(command: &Command) -> bool {
    matches!(command, Command::Camera { moving: true, .. } | Command::Edit(Change::DragTo(_)))
}

impl ApplicationHandler<UserEvent> for App {
    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        if self.live.is_none() {
            self.open_window(event_loop);
        }
    }

    fn user_event(&mut self, event_loop: &ActiveEventLoop, event: UserEvent) {
        match event {
            UserEvent::Wake => self.listen(),
            UserEvent::Repaint(delay) => {
                if let Some(when) = Instant::now().checked_add(delay) {
                    let soonest = self.drawn + SOFTWARE_ATTENTIVE_GAP;
                    self.draw_at(if self.is_software() { when.max(soonest) } else { when });
                }
            }
            UserEvent::DeviceLost => {
                self.state.notice("The graphics adapter was lost and is back; the render went on");
                self.open_window(event_loop);
            }
            UserEvent::AccessKit(event) => {
                if let (Some(live), egui_winit::accesskit_winit::WindowEvent::ActionRequested(request)) =
                    (&mut self.live, event.window_event)
                {
                    live.egui.on_accesskit_action_request(request);
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
            WindowEvent::CloseRequested | WindowEvent::Destroyed => return self.close(event_loop),
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
            WindowEvent::Occluded(occluded) => self.occluded = occluded,
            WindowEvent::DroppedFile(path) => self.state.open(path),
            WindowEvent::KeyboardInput { .. }
            | WindowEvent::MouseInput { .. }
            | WindowEvent::MouseWheel { .. }
            | WindowEvent::CursorMoved { .. } => {
                let now = Instant::now();
                self.unanswered.get_or_insert(now);
                self.last_input = Some(now);
            }
            _ => {}
        }
        if response.repaint {
            self.draw_at(Instant::now());
        }
    }

    fn about_to_wait(&mut self, event_loop: &ActiveEventLoop) {
        let Some(due) = self.due else {
            event_loop.set_control_flow(ControlFlow::Wait);
            return;
        };
        if due > Instant::now() {
            event_loop.set_control_flow(ControlFlow::WaitUntil(due));
        } else if let Some(live) = &self.live {
            self.due = None;
            live.window.request_redraw();
            event_loop.set_control_flow(ControlFlow::Wait);
        }
    }
}
