//! How a picture gets on the screen: linear pixels become textures, and a shader shows them below the panels.
//!
//! The panels say what is to be seen ([`View`]) and of what ([`Picture`]); the [`Presenter`] lives among the resources of
//! egui's renderer and uploads a picture when it is not the one it has. Not here: who picks exposure, zoom and range.

pub(crate) mod colour_map;
mod pipeline;
mod texture;
mod uniforms;

#[cfg(test)]
mod tests;

use std::sync::Arc;

use egui::epaint::ViewportInPixels;
use egui_wgpu::{CallbackResources, CallbackTrait, ScreenDescriptor};
use foton_film::{Image, Plane, ToneMap};

pub(crate) use pipeline::Presenter;
pub(crate) use texture::reduction;

/// Pixels to be drawn, shared with whoever made them.
#[derive(Clone, Debug)]
pub(crate) enum Picture {
    /// Linear radiance.
    Rgb(Arc<Image>),
    /// A measure of each pixel, such as a radius; drawn as grey where a view asks for radiance.
    Scalar(Arc<Plane<f32>>),
}

impl Picture {
    /// Width and height in pixels.
    pub(crate) fn size(&self) -> [u32; 2] {
        match self {
            Self::Rgb(image) => [image.width, image.height],
            Self::Scalar(plane) => [plane.width, plane.height],
        }
    }

    /// Whether both are the same allocation, which then has the same pixels, since shared pixels do not change.
    fn is(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Rgb(a), Self::Rgb(b)) => Arc::ptr_eq(a, b),
            (Self::Scalar(a), Self::Scalar(b)) => Arc::ptr_eq(a, b),
            _ => false,
        }
    }
}

/// What a pixel's colour says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Mode {
    /// Radiance, through exposure and tone map.
    Radiance,
    /// The measure, or the luminance, by the [`colour_map`].
    FalseColour {
        /// What has the first colour, and everything below it.
        low: f32,
        /// What has the last colour, and everything above it.
        high: f32,
        /// Whether equal ratios, not equal differences, are equal steps of colour.
        logarithmic: bool,
    },
}

/// What is to be seen of the pictures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct View {
    /// Each stop doubles the light.
    pub(crate) exposure_stops: f32,
    /// How radiance is brought into the range of the screen.
    pub(crate) tone_map: ToneMap,
    /// Radiance or false colour.
    pub(crate) mode: Mode,
    /// Whether pixels of radiance are marked that are black, or as bright as a byte gets.
    pub(crate) marks_clipping: bool,
    /// Where the whole image lies, in physical pixels of the window; zoom and pan move it beyond the view.
    pub(crate) image_rect: egui::Rect,
    /// Where the pinned picture takes over, as a part of the width of the view. Without a pinned picture it has no effect.
    pub(crate) wipe: Option<f32>,
    /// What is seen around the image.
    pub(crate) background: egui::Color32,
}

/// Draws pictures into a rectangle of egui, by [`egui_wgpu::Callback::new_paint_callback`]. One in a frame, for there is one
/// [`Presenter`].
#[derive(Clone, Debug)]
pub(crate) struct PresentCallback {
    /// What is to be seen.
    pub(crate) view: View,
    /// The newest picture.
    pub(crate) picture: Picture,
    /// What it is compared with, right of the wipe.
    pub(crate) pinned: Option<Picture>,
    /// The rectangle of the callback, in points.
    pub(crate) rect: egui::Rect,
}

/// A part of the target in whole pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Area {
    /// The left and the upper edge.
    pub(crate) origin: [u32; 2],
    /// Width and height.
    pub(crate) size: [u32; 2],
}

impl CallbackTrait for PresentCallback {
    fn prepare(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        screen: &ScreenDescriptor,
        encoder: &mut wgpu::CommandEncoder,
        resources: &mut CallbackResources,
    ) -> Vec<wgpu::CommandBuffer> {
        let presenter =
            resources.get_mut::<Presenter>().expect("the window puts a Presenter beside egui's renderer");
        // As egui rounds the viewport that it sets for us.
        let viewport =
            ViewportInPixels::from_points(&self.rect, screen.pixels_per_point, screen.size_in_pixels);
        let pixels = |a: i32, b: i32| [a, b].map(|v| v.max(0) as u32);
        let area = Area {
            origin: pixels(viewport.left_px, viewport.top_px),
            size: pixels(viewport.width_px, viewport.height_px),
        };
        presenter.upload(device, queue, &self.picture, self.pinned.as_ref());
        presenter.shade(device, queue, encoder, &self.view, area);
        Vec::new()
    }

    fn paint(
        &self,
        _info: egui::PaintCallbackInfo,
        render_pass: &mut wgpu::RenderPass<'static>,
        resources: &CallbackResources,
    ) {
        if let Some(presenter) = resources.get::<Presenter>() {
            presenter.paint(render_pass);
        }
    }
}
