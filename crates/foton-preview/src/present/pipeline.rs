//! The presenter: the shader, its buffers and the textures of the picture and the pinned picture.

use super::texture::{Shown, create_texture, write_rows};
use super::{Picture, View, colour_map, uniforms};

/// Draws pictures with `shaders/present.wgsl`. Kept among egui's `CallbackResources`; a lost device needs a new one, which
/// uploads what it is next asked to show.
pub(crate) struct Presenter {
    pipeline: wgpu::RenderPipeline,
    layout: wgpu::BindGroupLayout,
    view: wgpu::Buffer,
    colour_map: wgpu::Texture,
    picture: Option<Shown>,
    pinned: Option<Shown>,
    /// Made anew when a texture is.
    bindings: Option<wgpu::BindGroup>,
}

impl Presenter {
    /// For a target of gamma-encoded bytes (see [`egui_wgpu::preferred_framebuffer_format`]) with one sample a pixel.
    pub(crate) fn new(device: &wgpu::Device, queue: &wgpu::Queue, target: wgpu::TextureFormat) -> Self {
        let layout = bind_group_layout(device);
        let colours: Vec<u8> =
            colour_map::table().iter().flat_map(|&[red, green, blue]| [red, green, blue, 255]).collect();
        let entries = colour_map::ENTRIES as u32;
        let colour_map = create_texture(device, wgpu::TextureFormat::Rgba8Unorm, entries, 1);
        write_rows(queue, &colour_map, 0, 1, &colours);
        let view = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("view"),
            size: uniforms::BYTES,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let pipeline = create_pipeline(device, &layout, target);
        Self { pipeline, layout, view, colour_map, picture: None, pinned: None, bindings: None }
    }

    /// Uploads what is not there yet. A picture without pixels leaves what was shown before.
    pub(crate) fn show(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        picture: &Picture,
        pinned: Option<&Picture>,
    ) {
        let is_new = |shown: &Option<Shown>, picture: &Picture| {
            !shown.as_ref().is_some_and(|shown| shown.is_of(picture)) && !picture.size().contains(&0)
        };
        if is_new(&self.picture, picture) {
            self.picture = Some(Shown::new(device, queue, picture, self.picture.take()));
            self.bindings = None;
        }
        match pinned {
            Some(picture) if is_new(&self.pinned, picture) => {
                self.pinned = Some(Shown::new(device, queue, picture, self.pinned.take()));
                self.bindings = None;
            }
            None if self.pinned.is_some() => {
                self.pinned = None;
                self.bindings = None;
            }
            _ => {}
        }
        if self.bindings.is_none() {
            self.bindings = self.bind(device);
        }
    }

    /// What the next [`Presenter::paint`] shows.
    pub(crate) fn set_view(&self, queue: &wgpu::Queue, view: &View) {
        let extents = [&self.picture, &self.pinned].map(|shown| shown.as_ref().map(Shown::extent));
        queue.write_buffer(&self.view, 0, bytemuck::cast_slice(&uniforms::pack(view, extents)));
    }

    /// Covers the viewport of the pass. Draws nothing before there is a picture.
    pub(crate) fn paint(&self, pass: &mut wgpu::RenderPass<'_>) {
        if let Some(bindings) = &self.bindings {
            pass.set_pipeline(&self.pipeline);
            pass.set_bind_group(0, bindings, &[]);
            pass.draw(0..3, 0..1);
        }
    }

    fn bind(&self, device: &wgpu::Device) -> Option<wgpu::BindGroup> {
        let view = |texture: &wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
        let picture = self.picture.as_ref()?;
        let pinned = self.pinned.as_ref().unwrap_or(picture);
        let textures = [&self.colour_map, picture.texture(), pinned.texture()].map(view);
        let texture = |i: usize| wgpu::BindingResource::TextureView(&textures[i]);
        let resources = [self.view.as_entire_binding(), texture(0), texture(1), texture(2)];
        let entries: Vec<_> = (0..)
            .zip(resources)
            .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource })
            .collect();
        let descriptor =
            wgpu::BindGroupDescriptor { label: Some("present"), layout: &self.layout, entries: &entries };
        Some(device.create_bind_group(&descriptor))
    }
}

/// A uniform buffer, then the colour map, the picture and the pinned picture.
fn bind_group_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let uniform = wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Uniform,
        has_dynamic_offset: false,
        min_binding_size: None,
    };
    let texture = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable: false },
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    };
    let entries: Vec<_> = (0..)
        .zip([uniform, texture, texture, texture])
        .map(|(binding, ty)| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty,
            count: None,
        })
        .collect();
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("present"),
        entries: &entries,
    })
}

fn create_pipeline(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    target: wgpu::TextureFormat,
) -> wgpu::RenderPipeline {
    let source = include_str!("../../../../shaders/present.wgsl");
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("present.wgsl"),
        source: wgpu::ShaderSource::Wgsl(source.into()),
    });
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("present"),
        bind_group_layouts: &[Some(layout)],
        immediate_size: 0,
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("present"),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("cover"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: None,
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("shade"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(target.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}
