//! One picture on the graphics adapter: uploaded in bands, made smaller where the adapter's textures are too small for it.

use super::Picture;

/// Texels are expanded and handed over in pieces of about this many bytes, so that a large image needs no second copy.
const BAND_BYTES: usize = 8 << 20;

/// Red, green, blue, and whether the pixel is finite.
const TEXEL_BYTES: usize = 16;

/// How many pixels along each axis become one texel on an adapter whose textures have at most `largest` texels a side; 1 means
/// that the picture is drawn as it is.
#[must_use]
pub(crate) fn reduction(size: [u32; 2], largest: u32) -> u32 {
    size[0].max(size[1]).div_ceil(largest.max(1)).max(1)
}

/// A picture and its texture.
pub(super) struct Uploaded {
    picture: Picture,
    texture: wgpu::Texture,
    /// The pixels along each axis that became one texel.
    reduction: u32,
}

impl Uploaded {
    /// Uploads a picture with at least one pixel, into the texture of `last` where it fits.
    pub(super) fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        picture: &Picture,
        last: Option<Self>,
    ) -> Self {
        let size = picture.size();
        let reduction = reduction(size, device.limits().max_texture_dimension_2d);
        let [width, height] = size.map(|pixels| pixels.div_ceil(reduction));
        let fits = |uploaded: &Self| (uploaded.texture.width(), uploaded.texture.height()) == (width, height);
        let texture = match last {
            Some(last) if fits(&last) => last.texture,
            _ => {
                let usage = wgpu::TextureUsages::COPY_DST;
                create_texture(device, wgpu::TextureFormat::Rgba32Float, [width, height], usage)
            }
        };
        let rows_in_band = (BAND_BYTES / (TEXEL_BYTES * width as usize)).clamp(1, height as usize) as u32;
        let mut band = Vec::with_capacity((rows_in_band * width) as usize);
        for first in (0..height).step_by(rows_in_band as usize) {
            let rows = first..height.min(first + rows_in_band);
            band.clear();
            for y in rows.clone() {
                picture.push_row(y, reduction, &mut band);
            }
            write_rows(queue, &texture, first, rows.len() as u32, bytemuck::cast_slice(&band));
        }
        Self { picture: picture.clone(), texture, reduction }
    }

    /// Whether this shows `picture`.
    pub(super) fn is_of(&self, picture: &Picture) -> bool {
        self.picture.is(picture)
    }

    /// The size in texels, a fraction where the last texel stands for fewer pixels than the others.
    pub(super) fn extent(&self) -> [f32; 2] {
        self.picture.size().map(|pixels| (f64::from(pixels) / f64::from(self.reduction)) as f32)
    }

    /// What the shader reads.
    pub(super) fn texture(&self) -> &wgpu::Texture {
        &self.texture
    }
}

impl Picture {
    /// The texel of a pixel: what is not finite is black with a fourth channel of 0, since shaders need not keep NaN.
    fn texel(&self, i: usize) -> [f32; 4] {
        let [r, g, b] = match self {
            Self::Rgb(image) => image.pixels[i].to_array(),
            Self::Scalar(plane) => [plane.values[i]; 3],
        };
        if r.is_finite() && g.is_finite() && b.is_finite() { [r, g, b, 1.0] } else { [0.0; 4] }
    }

    /// Appends the texels of row `y` of this picture reduced `by`: means over squares, not finite if any pixel is not.
    fn push_row(&self, y: u32, by: u32, band: &mut Vec<[f32; 4]>) {
        let [width, height] = self.size();
        let at = |x: u32, y: u32| self.texel(y as usize * width as usize + x as usize);
        if by == 1 {
            band.extend((0..width).map(|x| at(x, y)));
            return;
        }
        let rows = y * by..height.min((y + 1) * by);
        band.extend((0..width).step_by(by as usize).map(|left| {
            let columns = left..width.min(left + by);
            let share = 1.0 / (rows.len() * columns.len()) as f32;
            let mut mean = [0.0, 0.0, 0.0, 1.0f32];
            for [r, g, b, finite] in rows.clone().flat_map(|y| columns.clone().map(move |x| at(x, y))) {
                mean = [mean[0] + share * r, mean[1] + share * g, mean[2] + share * b, mean[3].min(finite)];
            }
            mean
        }));
    }
}

/// A texture that shaders read texel by texel.
pub(super) fn create_texture(
    device: &wgpu::Device,
    format: wgpu::TextureFormat,
    [width, height]: [u32; 2],
    filled_by: wgpu::TextureUsages,
) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some("picture"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | filled_by,
        view_formats: &[],
    })
}

/// Fills whole rows of a texture.
pub(super) fn write_rows(queue: &wgpu::Queue, texture: &wgpu::Texture, first: u32, rows: u32, bytes: &[u8]) {
    let mut target = texture.as_image_copy();
    target.origin.y = first;
    let layout = wgpu::TexelCopyBufferLayout {
        offset: 0,
        bytes_per_row: Some((bytes.len() / rows as usize) as u32),
        rows_per_image: None,
    };
    let size = wgpu::Extent3d { width: texture.width(), height: rows, depth_or_array_layers: 1 };
    queue.write_texture(target, bytes, layout, size);
}
