//! What draws the window: a graphics adapter with a painter of its own. It may be lost and another made; the window, and what egui
//! knows of it, stay.

use std::num::NonZeroU32;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use egui::epaint::ImageDelta;
use egui::{TextureId, TextureOptions, ViewportId};
use egui_wgpu::winit::Painter;
use egui_wgpu::{RenderState, RendererOptions, WgpuConfiguration};
use winit::event_loop::EventLoopProxy;
use winit::window::Window;

use super::error::WindowError;
use super::event::UserEvent;
use crate::present::Presenter;

pub(super) struct Adapter {
    painter: Painter,
    device: wgpu::Device,
    is_lost: Arc<AtomicBool>,
    /// Which one it is: news of the loss of an earlier one comes late.
    pub(super) number: u64,
    /// Drawing costs the same cores that render.
    pub(super) is_software: bool,
    /// What there is to say of it.
    pub(super) words: String,
    pub(super) largest_texture: u32,
}

impl Adapter {
    /// Finds one for a window.
    pub(super) fn open(
        number: u64,
        context: &egui::Context,
        window: &Arc<Window>,
        proxy: &EventLoopProxy<UserEvent>,
    ) -> Result<Self, WindowError> {
        let configuration = WgpuConfiguration::default();
        let painter = Painter::new(context.clone(), configuration, false, RendererOptions::default());
        let mut painter = pollster::block_on(painter);
        pollster::block_on(painter.set_window(ViewportId::ROOT, Some(Arc::clone(window))))
            .map_err(|cause| WindowError::NoAdapter(cause.to_string()))?;
        let Some(render) = painter.render_state() else {
            return Err(WindowError::NoAdapter("there is none".to_owned()));
        };
        let presenter = Presenter::new(&render.device, &render.queue, render.target_format);
        render.renderer.write().callback_resources.insert(presenter);
        let is_lost = Arc::new(AtomicBool::new(false));
        let (flag, news) = (Arc::clone(&is_lost), proxy.clone());
        // A device that we drop ourselves is lost, too: the number tells.
        render.device.set_device_lost_callback(move |_, _| {
            flag.store(true, Ordering::SeqCst);
            let _ = news.send_event(UserEvent::DeviceLost(number));
        });
        let largest_texture = render.device.limits().max_texture_dimension_2d;
        let info = render.adapter.get_info();
        let is_software = info.device_type == wgpu::DeviceType::Cpu;
        let words = if is_software {
            format!(
                "Drawn in software ({}): fewer frames a second, to leave the cores to the render",
                info.name
            )
        } else {
            format!("Drawn by {}", info.name)
        };
        Ok(Self { painter, device: render.device, is_lost, number, is_software, words, largest_texture })
    }

    /// Hands over the letters that egui has drawn before: it tells an adapter of them once.
    pub(super) fn restore(&self, context: &egui::Context) {
        let Some(RenderState { device, queue, renderer, .. }) = self.painter.render_state() else { return };
        let letters = ImageDelta::full(context.fonts(|fonts| fonts.image()), TextureOptions::LINEAR);
        renderer.write().update_texture(&device, &queue, TextureId::default(), &letters);
    }

    pub(super) fn resize(&mut self, width: u32, height: u32) {
        if let (Some(width), Some(height)) = (NonZeroU32::new(width), NonZeroU32::new(height)) {
            self.painter.on_window_resized(ViewportId::ROOT, width, height);
        }
    }

    /// Draws what egui made. A surface that is lost or outdated is made again by the painter, which then asks for another frame.
    /// Returns whether there still was a device to draw with.
    ///
    /// # Panics
    /// If the painter does and its device is still there.
    pub(super) fn paint(
        &mut self,
        window: &Arc<Window>,
        ground: egui::Color32,
        primitives: &[egui::ClippedPrimitive],
        pixels_per_point: f32,
        textures: &mut egui::TexturesDelta,
    ) -> bool {
        let (painter, ground) = (&mut self.painter, ground.to_normalized_gamma_f32());
        let id = ViewportId::ROOT;
        let painted = catch_unwind(AssertUnwindSafe(|| {
            painter.paint_and_update_textures(
                id,
                pixels_per_point,
                ground,
                primitives,
                textures,
                Vec::new(),
                window,
            );
        }));
        // egui's renderer takes it for granted that its device gives buffers; one that is lost does not.
        let Err(panic) = painted else { return true };
        let _ = self.device.poll(wgpu::PollType::Poll);
        if !self.is_lost.load(Ordering::SeqCst) {
            resume_unwind(panic);
        }
        false
    }

    /// Takes the device away once pass N is shown, where the environment variable `FOTON_FAULT` says `device:N`, so that tests
    /// see what comes of it. Programs that people get do not have this.
    #[cfg(debug_assertions)]
    pub(super) fn inject_fault(&self, pass: u64) {
        let is_due = |fault: String| fault.strip_prefix("device:")?.parse().ok().map(|due: u64| pass >= due);
        if self.number == 0 && std::env::var("FOTON_FAULT").ok().and_then(is_due) == Some(true) {
            self.device.destroy();
        }
    }

    #[cfg(not(debug_assertions))]
    pub(super) const fn inject_fault(&self, _: u64) {}
}
