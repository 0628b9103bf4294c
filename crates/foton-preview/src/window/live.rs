//! A window that is open: its surface, its egui, and one drawing of it.

use std::num::NonZeroU32;
use std::sync::Arc;

use egui::ViewportId;
use egui_wgpu::winit::Painter;
use egui_wgpu::{RendererOptions, WgpuConfiguration};
use winit::dpi::LogicalSize;
use winit::event_loop::{ActiveEventLoop, EventLoopProxy};
use winit::window::{Window, WindowAttributes};

use super::{UserEvent, WindowError, reason};
use crate::panels;
use crate::present::Presenter;
use crate::state::State;

pub(super) struct Live {
    pub(super) window: Arc<Window>,
    pub(super) egui: egui_winit::State,
    context: egui::Context,
    painter: Painter,
    /// Drawing costs the same cores that render.
    pub(super) is_software: bool,
    pub(super) adapter: String,
    pub(super) largest_texture: u32,
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
        let live = Self::draw_into(window, event_loop, proxy)?;
        live.window.set_visible(true);
        Ok(live)
    }

    /// Sets up everything that draws into a window: the first time, and after the adapter was lost.
    pub(super) fn draw_into(
        window: Arc<Window>,
        event_loop: &ActiveEventLoop,
        proxy: &EventLoopProxy<UserEvent>,
    ) -> Result<Self, WindowError> {
        let context = egui::Context::default();
        let configuration = WgpuConfiguration::default();
        let painter = Painter::new(context.clone(), configuration, false, RendererOptions::default());
        let mut painter = pollster::block_on(painter);
        pollster::block_on(painter.set_window(ViewportId::ROOT, Some(Arc::clone(&window))))
            .map_err(|cause| WindowError::NoAdapter(cause.to_string()))?;
        let Some(render) = painter.render_state() else {
            return Err(WindowError::NoAdapter("there is none".to_owned()));
        };
        let presenter = Presenter::new(&render.device, &render.queue, render.target_format);
        render.renderer.write().callback_resources.insert(presenter);
        let lost = proxy.clone();
        render.device.set_device_lost_callback(move |reason, _| {
            // A device that we drop ourselves is lost, too.
            if reason != wgpu::DeviceLostReason::Destroyed {
                let _ = lost.send_event(UserEvent::DeviceLost);
            }
        });
        let largest_texture = render.device.limits().max_texture_dimension_2d;
        let info = render.adapter.get_info();
        let is_software = info.device_type == wgpu::DeviceType::Cpu;
        let mut egui = egui_winit::State::new(
            context.clone(),
            ViewportId::ROOT,
            &window,
            Some(window.scale_factor() as f32),
            window.theme(),
            painter.max_texture_side(),
        );
        egui.init_accesskit(event_loop, &window, proxy.clone());
        let repaint = proxy.clone();
        context.set_request_repaint_callback(move |info| {
            let _ = repaint.send_event(UserEvent::Repaint(info.delay));
        });
        let adapter = if is_software {
            format!(
                "Drawn in software ({}): fewer frames a second, to leave the cores to the render",
                info.name
            )
        } else {
            format!("Drawn by {}", info.name)
        };
        Ok(Self { window, egui, context, painter, is_software, adapter, largest_texture })
    }

    pub(super) fn resize(&mut self, width: u32, height: u32) {
        if let (Some(width), Some(height)) = (NonZeroU32::new(width), NonZeroU32::new(height)) {
            self.painter.on_window_resized(ViewportId::ROOT, width, height);
        }
    }

    /// Whether there is anything to see.
    pub(super) fn is_visible(&self) -> bool {
        let size = self.window.inner_size();
        size.width > 0 && size.height > 0 && self.window.is_minimized() != Some(true)
    }

    /// Draws the state. What was asked of the panels goes to `ask` before anything is painted, so that the engine works on it
    /// meanwhile. If that returns `false`, nothing is painted: something better follows at once. Returns whether it was.
    pub(super) fn draw(&mut self, state: &mut State, ask: impl FnOnce(&mut State) -> bool) -> bool {
        let theme = if state.preferences.dark { egui::Theme::Dark } else { egui::Theme::Light };
        if self.context.theme() != theme {
            self.context.set_theme(theme);
        }
        let input = self.egui.take_egui_input(&self.window);
        let mut output = self.context.run_ui(input, |ui| panels::show(ui, state));
        let is_worth_it = ask(state);
        let platform = std::mem::take(&mut output.platform_output);
        self.egui.handle_platform_output(&self.window, platform);
        // Textures are handed over once.
        if !is_worth_it && output.textures_delta.is_empty() {
            return false;
        }
        let shapes = std::mem::take(&mut output.shapes);
        let ground = panels::ground(&self.context.style_of(theme).visuals);
        let primitives = self.context.tessellate(shapes, output.pixels_per_point);
        self.painter.paint_and_update_textures(
            ViewportId::ROOT,
            output.pixels_per_point,
            ground.to_normalized_gamma_f32(),
            &primitives,
            &mut output.textures_delta,
            Vec::new(),
            &self.window,
        );
        true
    }
}
