//! The presenter: the shader's pipelines, its buffer, the textures of the picture and the pinned picture, and what was last seen
//! of them.

use super::texture::{Uploaded, create_texture, write_rows};
use super::uniforms::{self, Kind};
use super::{Area, Picture, View, colour_map};

/// Pipelines that are retained, of the thirty that there can be: adapters in software hold megabytes of machine code for each.
const MAX_PIPELINES: usize = 4;

/// Encoded bytes, as they go to the screen.
const SHADED: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// Draws pictures with `shaders/present.wgsl`. Stored among egui's `CallbackResources`; a lost device needs a new one, which
/// uploads what it is next asked to show.
pub(crate) struct Presenter {
    module: wgpu::ShaderModule,
    /// For the colour map and the pictures, and for what was made of them.
    layouts: [wgpu::BindGroupLayout; 2],
    /// The last used first.
    shade: Vec<(Kind, wgpu::RenderPipeline)>,
    copy: wgpu::RenderPipeline,
    view: wgpu::Buffer,
    colour_map: wgpu::Texture,
    picture: Option<Uploaded>,
    pinned: Option<Uploaded>,
    /// Replaced when a texture is.
    bindings: Option<wgpu::BindGroup>,
    shaded: Option<Shaded>,
}

/// What was seen of the pictures.
struct Shaded {
    texture: wgpu::TextureView,
    bindings: wgpu::BindGroup,
    area: Area,
    /// `None` where a picture has changed since.
    view: Option<View>,
}

impl Presenter {
    /// For a target of gamma-encoded bytes (see [`egui_wgpu::preferred_framebuffer_format`]) with one sample a pixel.
    pub(crate) fn new(device: &wgpu::Device, queue: &wgpu::Queue, target: wgpu::TextureFormat) -> Self {
        let layouts = [&[0, 1, 2, 3][..], &[0, 4]].map(|bindings| bind_group_layout(device, bindings));
        let colours: Vec<u8> =
            colour_map::table().iter().flat_map(|&[red, green, blue]| [red, green, blue, 255]).collect();
        let entries = colour_map::ENTRIES as u32;
        let usage = wgpu::TextureUsages::COPY_DST;
        let colour_map = create_texture(device, wgpu::TextureFormat::Rgba8Unorm, [entries, 1], usage);
        write_rows(queue, &colour_map, 0, 1, &colours);
        let view = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("view"),
            size: uniforms::BYTES,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let source = include_str!("../../../../shaders/present.wgsl");
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("present.wgsl"),
            source: wgpu::ShaderSource::Wgsl(source.into()),
        });
        let copy = create_pipeline(device, &module, &layouts[1], "copy", &[], target);
        Self {
            module,
            layouts,
            shade: Vec::new(),
            copy,
            view,
            colour_map,
            picture: None,
            pinned: None,
            bindings: None,
            shaded: None,
        }
    }

    /// Uploads what is not there yet. A picture without pixels leaves what was drawn before.
    pub(crate) fn upload(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        picture: &Picture,
        pinned: Option<&Picture>,
    ) {
        let is_new = |uploaded: &Option<Uploaded>, picture: &Picture| {
            !uploaded.as_ref().is_some_and(|uploaded| uploaded.is_of(picture)) && !picture.size().contains(&0)
        };
        if is_new(&self.picture, picture) {
            self.picture = Some(Uploaded::new(device, queue, picture, self.picture.take()));
            self.bindings = None;
        }
        match pinned {
            Some(picture) if is_new(&self.pinned, picture) => {
                self.pinned = Some(Uploaded::new(device, queue, picture, self.pinned.take()));
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
            if let Some(shaded) = &mut self.shaded {
                shaded.view = None;
            }
        }
    }

    /// Draws what the next [`Presenter::paint`] brings to `area`, unless it is there from before.
    pub(crate) fn shade(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        view: &View,
        area: Area,
    ) {
        let Some(bindings) = &self.bindings else { return };
        if area.size.contains(&0) {
            return;
        }
        let shaded = match self.shaded.take() {
            Some(shaded) if shaded.area.size == area.size => shaded,
            _ => Shaded::new(device, &self.layouts[1], &self.view, area),
        };
        let shaded = self.shaded.insert(shaded);
        if shaded.view.as_ref() == Some(view) && shaded.area == area {
            return;
        }
        (shaded.view, shaded.area) = (Some(*view), area);
        let extents = [&self.picture, &self.pinned].map(|uploaded| uploaded.as_ref().map(Uploaded::extent));
        queue.write_buffer(&self.view, 0, bytemuck::cast_slice(&uniforms::pack(view, area.origin, extents)));
        let kind = Kind::of(view, extents);
        match self.shade.iter().position(|(made_for, _)| *made_for == kind) {
            Some(index) => self.shade[..=index].rotate_right(1),
            None => {
                let constants = kind.constants();
                let made =
                    create_pipeline(device, &self.module, &self.layouts[0], "shade", &constants, SHADED);
                self.shade.insert(0, (kind, made));
                self.shade.truncate(MAX_PIPELINES);
            }
        }
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("shade"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &shaded.texture,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations::default(),
            })],
            ..wgpu::RenderPassDescriptor::default()
        });
        pass.set_pipeline(&self.shade[0].1);
        pass.set_bind_group(0, bindings, &[]);
        pass.draw(0..3, 0..1);
    }

    #[cfg(test)]
    pub(super) const fn kept_pipelines(&self) -> usize {
        self.shade.len()
    }

    /// Covers the viewport of the pass, which is the area that was shaded. Draws nothing before there is a picture.
    pub(crate) fn paint(&self, pass: &mut wgpu::RenderPass<'_>) {
        if let Some(shaded) = &self.shaded {
            pass.set_pipeline(&self.copy);
            pass.set_bind_group(0, &shaded.bindings, &[]);
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
            wgpu::BindGroupDescriptor { label: Some("shade"), layout: &self.layouts[0], entries: &entries };
        Some(device.create_bind_group(&descriptor))
    }
}

impl Shaded {
    fn new(device: &wgpu::Device, layout: &wgpu::BindGroupLayout, view: &wgpu::Buffer, area: Area) -> Self {
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT;
        let texture = create_texture(device, SHADED, area.size, usage);
        let texture = texture.create_view(&wgpu::TextureViewDescriptor::default());
        let entries = [
            wgpu::BindGroupEntry { binding: 0, resource: view.as_entire_binding() },
            wgpu::BindGroupEntry { binding: 4, resource: wgpu::BindingResource::TextureView(&texture) },
        ];
        let descriptor = wgpu::BindGroupDescriptor { label: Some("copy"), layout, entries: &entries };
        let bindings = device.create_bind_group(&descriptor);
        Self { texture, bindings, area, view: None }
    }
}

/// Of a uniform buffer at 0 and textures elsewhere.
fn bind_group_layout(device: &wgpu::Device, bindings: &[u32]) -> wgpu::BindGroupLayout {
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
    let entries: Vec<_> = bindings
        .iter()
        .map(|&binding| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty: if binding == 0 { uniform } else { texture },
            count: None,
        })
        .collect();
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("present"),
        entries: &entries,
    })
}

/// One triangle through the fragment shader `entry`.
fn create_pipeline(
    device: &wgpu::Device,
    module: &wgpu::ShaderModule,
    layout: &wgpu::BindGroupLayout,
    entry: &str,
    constants: &[(&str, f64)],
    target: wgpu::TextureFormat,
) -> wgpu::RenderPipeline {
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(entry),
        bind_group_layouts: &[Some(layout)],
        immediate_size: 0,
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(entry),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("cover"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: None,
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some(entry),
            compilation_options: wgpu::PipelineCompilationOptions { constants, ..Default::default() },
            targets: &[Some(target.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}
