//! A window that is open: its egui, what draws it, and one drawing of it.

use std::sync::Arc;

use egui::{ViewportId, accesskit};
use egui_winit::accesskit_winit;
use winit::dpi::LogicalSize;
use winit::event_loop::{ActiveEventLoop, EventLoopProxy};
use winit::window::{Window, WindowAttributes};

use super::adapter::Adapter;
use super::error::{WindowError, reason};
use super::event::UserEvent;
use crate::panels;
use crate::state::State;
use crate::themes;
use crate::turns::first_turn;

pub(super) struct Live {
    pub(super) window: Arc<Window>,
    pub(super) egui: egui_winit::State,
    context: egui::Context,
    /// `None` from when it was lost until there is another.
    adapter: Option<Adapter>,
    /// Counts adapters.
    adapters: u64,
    /// What egui wants the adapter to know, each thing once.
    textures: egui::TexturesDelta,
    title: String,
}

impl Drop for Live {
    fn drop(&mut self) {
        // egui minds if it is not handed over.
        self.textures.clear();
    }
}

impl Live {
    /// Opens the window.
    pub(super) fn open(
        event_loop: &ActiveEventLoop,
        proxy: &EventLoopProxy<UserEvent>,
        state: &State,
    ) -> Result<Self, WindowError> {
        let [width, height] = state.preferences.window;
        let attributes = WindowAttributes::default()
            .with_title("foton")
            .with_visible(false)
            .with_inner_size(LogicalSize::new(width, height))
            .with_min_inner_size(LogicalSize::new(480.0, 360.0));
        let window = event_loop.create_window(attributes);
        let window = Arc::new(window.map_err(|cause| WindowError::NoDisplay(reason(&cause)))?);
        let context = egui::Context::default();
        themes::dress(&context);
        let adapter = Adapter::open(0, &context, &window, proxy)?;
        let mut egui = egui_winit::State::new(
            context.clone(),
            ViewportId::ROOT,
            &window,
            Some(window.scale_factor() as f32),
            window.theme(),
            Some(adapter.largest_texture as usize),
        );
        // Before the window is shown, as screen readers need it: after a loss of the adapter this cannot be done again.
        egui.init_accesskit(event_loop, &window, proxy.clone());
        let repaint = proxy.clone();
        context.set_request_repaint_callback(move |info| {
            let _ = repaint.send_event(UserEvent::Repaint(info.delay));
        });
        window.set_visible(true);
        let textures = egui::TexturesDelta::default();
        Ok(Self {
            window,
            egui,
            context,
            adapter: Some(adapter),
            adapters: 1,
            textures,
            title: String::new(),
        })
    }

    /// What draws, unless it is lost.
    pub(super) const fn adapter(&self) -> Option<&Adapter> {
        self.adapter.as_ref()
    }

    /// Gives the adapter of a number up, if it is the one that draws; whether it was.
    pub(super) fn lose(&mut self, number: u64) -> bool {
        self.adapter.take_if(|adapter| adapter.number == number).is_some()
    }

    /// Finds another adapter after one was lost.
    pub(super) fn recover(&mut self, proxy: &EventLoopProxy<UserEvent>) -> Result<(), WindowError> {
        let adapter = Adapter::open(self.adapters, &self.context, &self.window, proxy)?;
        self.adapters += 1;
        adapter.restore(&self.context);
        self.textures.clear();
        self.egui.set_max_texture_side(adapter.largest_texture as usize);
        self.adapter = Some(adapter);
        Ok(())
    }

    /// What a screen reader wants.
    pub(super) fn hear_a_screen_reader(&mut self, wish: accesskit_winit::WindowEvent) {
        if let Some(request) = heed(&self.context, wish) {
            self.egui.on_accesskit_action_request(request);
        }
    }

    pub(super) fn resize(&mut self, width: u32, height: u32) {
        if let Some(adapter) = &mut self.adapter {
            adapter.resize(width, height);
        }
    }

    /// Whether there is anything to see.
    pub(super) fn is_visible(&self) -> bool {
        let size = self.window.inner_size();
        size.width > 0 && size.height > 0 && self.window.is_minimized() != Some(true)
    }

    /// Draws the state. What was asked of the panels goes to `ask` before anything is painted, so that the engine works on it
    /// meanwhile. If that returns `false`, nothing is painted: something better follows at once. Returns whether it was.
    pub(super) fn draw(&mut self, state: &mut State, mut ask: impl FnMut(&mut State) -> bool) -> bool {
        let theme = if state.preferences.dark { egui::Theme::Dark } else { egui::Theme::Light };
        if self.context.theme() != theme {
            self.context.set_theme(theme);
        }
        let title = state.title();
        if title != self.title {
            self.window.set_title(&title);
            self.title = title;
        }
        let mut input = self.egui.take_egui_input(&self.window);
        let mut waiting = std::mem::take(&mut input.events);
        let mut is_worth_it = true;
        let mut output = loop {
            input.events = first_turn(&mut waiting);
            let mut output = self.context.run_ui(input, |ui| panels::show(ui, state));
            is_worth_it &= ask(state);
            let platform = std::mem::take(&mut output.platform_output);
            self.egui.handle_platform_output(&self.window, platform);
            self.textures.append(std::mem::take(&mut output.textures_delta));
            if waiting.is_empty() {
                break output;
            }
            input = self.egui.take_egui_input(&self.window);
        };
        if !is_worth_it {
            return false;
        }
        let Some(adapter) = &mut self.adapter else { return false };
        adapter.inject_fault(state.frame.as_ref().map_or(0, |frame| frame.stats.passes));
        let shapes = std::mem::take(&mut output.shapes);
        let ground = panels::ground(&self.context.style_of(theme).visuals);
        let pixels_per_point = output.pixels_per_point;
        let primitives = self.context.tessellate(shapes, pixels_per_point);
        adapter.paint(&self.window, ground, &primitives, pixels_per_point, &mut self.textures)
    }
}

/// Tells a screen reader what is there from the next frame on, or not any more; what it wants done is returned.
fn heed(context: &egui::Context, wish: accesskit_winit::WindowEvent) -> Option<accesskit::ActionRequest> {
    match wish {
        accesskit_winit::WindowEvent::InitialTreeRequested => context.enable_accesskit(),
        accesskit_winit::WindowEvent::ActionRequested(request) => return Some(request),
        accesskit_winit::WindowEvent::AccessibilityDeactivated => context.disable_accesskit(),
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::preferences::Preferences;

    #[test]
    fn a_screen_reader_is_told_what_is_there_once_it_asks() {
        let context = egui::Context::default();
        let mut state = State::new(Preferences::default(), Vec::new());
        let mut told = || {
            let mut output = context.run_ui(egui::RawInput::default(), |ui| panels::show(ui, &mut state));
            output.textures_delta.clear();
            let nodes = output.platform_output.accesskit_update?.nodes;
            Some(
                nodes.into_iter().filter_map(|(_, node)| node.label().map(str::to_owned)).collect::<Vec<_>>(),
            )
        };
        assert_eq!(told(), None);
        assert!(heed(&context, accesskit_winit::WindowEvent::InitialTreeRequested).is_none());
        let names = told().expect("a tree");
        for name in ["foton", "Pause", "Rendered image"] {
            assert!(names.iter().any(|n| n == name), "{name} is not among {names:?}");
        }
        assert!(heed(&context, accesskit_winit::WindowEvent::AccessibilityDeactivated).is_none());
        assert_eq!(told(), None);
    }
}
