//! A screen without a window: a device, a presenter, and the pixels they drew.

use super::*;

/// What is missing where nothing can be drawn.
const NO_ADAPTER: &str = "no graphics adapter: these tests need one, be it software (Debian: mesa-vulkan-drivers; cargo xtask test --install)";

/// A target of some pixels and what draws on it.
pub(super) struct Screen {
    pub(super) presenter: Presenter,
    device: wgpu::Device,
    queue: wgpu::Queue,
    target: wgpu::Texture,
    read_back: wgpu::Buffer,
}

impl Screen {
    pub(super) fn new(size: [u32; 2]) -> Self {
        Self::with_limits(size, wgpu::Limits::downlevel_defaults())
    }

    /// On a device whose textures have at most `largest` texels a side.
    pub(super) fn with_largest_texture(size: [u32; 2], largest: u32) -> Self {
        Self::with_limits(
            size,
            wgpu::Limits { max_texture_dimension_2d: largest, ..wgpu::Limits::downlevel_defaults() },
        )
    }

    fn with_limits([width, height]: [u32; 2], required_limits: wgpu::Limits) -> Self {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
        let adapter = pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default()))
            .expect(NO_ADAPTER);
        let descriptor = wgpu::DeviceDescriptor { required_limits, ..wgpu::DeviceDescriptor::default() };
        let (device, queue) =
            pollster::block_on(adapter.request_device(&descriptor)).expect("a device of modest limits");
        let format = wgpu::TextureFormat::Rgba8Unorm;
        let target = device.create_texture(&wgpu::TextureDescriptor {
            label: Some("screen"),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        let read_back = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("read back"),
            size: u64::from(padded_row(width) * height),
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let presenter = Presenter::new(&device, &queue, format);
        Self { presenter, device, queue, target, read_back }
    }

    /// The pixels of the whole target, row by row.
    pub(super) fn draw(&mut self, view: &View, picture: &Picture, pinned: Option<&Picture>) -> Vec<[u8; 3]> {
        let mut encoder = self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let area = Area { origin: [0, 0], size: [self.target.width(), self.target.height()] };
        self.presenter.upload(&self.device, &self.queue, picture, pinned);
        self.presenter.shade(&self.device, &self.queue, &mut encoder, view, area);
        let attachment = wgpu::RenderPassColorAttachment {
            view: &self.target.create_view(&wgpu::TextureViewDescriptor::default()),
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations::default(),
        };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(attachment)],
            ..wgpu::RenderPassDescriptor::default()
        });
        self.presenter.paint(&mut pass);
        drop(pass);
        self.copy_out(&mut encoder);
        self.queue.submit([encoder.finish()]);
        self.read_back.map_async(wgpu::MapMode::Read, .., |outcome| outcome.expect("a buffer to be read"));
        self.device.poll(wgpu::PollType::wait_indefinitely()).expect("the drawing ends");
        let width = self.target.width() as usize;
        let pixels = {
            let bytes = self.read_back.get_mapped_range(..).expect("a mapped buffer");
            let rows = bytes.chunks_exact(padded_row(self.target.width()) as usize);
            rows.flat_map(|row| row[..4 * width].chunks_exact(4).map(|p| [p[0], p[1], p[2]])).collect()
        };
        self.read_back.unmap();
        pixels
    }

    fn copy_out(&self, encoder: &mut wgpu::CommandEncoder) {
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(padded_row(self.target.width())),
            rows_per_image: None,
        };
        let buffer = wgpu::TexelCopyBufferInfo { buffer: &self.read_back, layout };
        encoder.copy_texture_to_buffer(self.target.as_image_copy(), buffer, self.target.size());
    }
}

/// The bytes of a row in a buffer that a texture is copied to.
fn padded_row(width: u32) -> u32 {
    (4 * width).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT)
}
