//! Textures: pictures with their sampler and transform, read for what a material wants of them.
//!
//! Texture coordinates begin at a picture's top left, as in Mitsuba; in a description v points up, and a texture's transform ends with
//! the turn. Of `KHR_texture_transform` the rotation turns as its examples do: u to −v.

use std::path::Path;
use std::rc::Rc;
use std::sync::Arc;

use foton_input::shown_path;
use foton_math::Rgb;
use foton_math::glam::{DAffine2, DMat2, DVec2};
use foton_scene::description::{Bitmap, Texture, TextureKind, Wrap};

use super::buffers::contents;
use super::json::At;
use super::reader::Reader;
use super::wanted::Wanted;
use crate::image::{MAGENTA, decode, is_cut_jpeg};
use crate::mitsuba::read::textures::TURN;

/// What pictures in formats that only other programs read are called.
const OTHER_IMAGES: [(&str, &str); 2] = [("KHR_texture_basisu", "KTX2"), ("EXT_texture_avif", "AVIF")];

/// What a picture says for a purpose.
#[derive(Clone, Copy, Debug)]
pub(super) enum Looked {
    /// The same everywhere.
    Constant(Rgb),
    /// The index of a texture.
    Texture(usize),
}

impl<'a> Reader<'a> {
    /// Which set of texture coordinates a texture takes.
    pub(super) fn set_of(&mut self, info: &At<'_>) -> usize {
        let transformed = info.extension("KHR_texture_transform");
        let changed = transformed.and_then(|t| t.index("texCoord", &mut self.report));
        changed.or_else(|| info.index("texCoord", &mut self.report)).unwrap_or(0)
    }

    /// A texture, read for a purpose; `None` where there is none or where it cannot be read, which is said.
    pub(super) fn texture(&mut self, info: &At<'a>, wanted: Wanted, name: &str) -> Option<Looked> {
        let root = self.root.clone();
        let (_, texture) = info.named("index", "textures", &root, &mut self.report)?;
        let (image, at) = self.image_of(&texture)?;
        if self.made.set != self.set_of(info) {
            self.notice("takes other texture coordinates than the material's first texture: left out", info);
            return None;
        }
        let bitmap = self.bitmap(image, &at, wanted)?;
        if let Some(first) = bitmap.pixels.first()
            && bitmap.pixels.iter().all(|p| p == first)
        {
            return Some(Looked::Constant(*first));
        }
        let (wrap, bilinear) = self.sampler(&texture);
        let to_uv = TURN * self.transform(info);
        let code = match wrap {
            Wrap::Repeat => 0,
            Wrap::Mirror => 1,
            Wrap::Clamp => 2,
        };
        let key = (Arc::as_ptr(&bitmap), code, bilinear, to_uv.to_cols_array().map(f64::to_bits));
        if let Some(known) = self.made.textures.get(&key) {
            return Some(Looked::Texture(*known));
        }
        let index = self.description.textures.len();
        let kind = TextureKind::Bitmap { bitmap, wrap, bilinear };
        self.description.textures.push(Texture { name: name.to_owned(), to_uv, kind });
        self.made.textures.insert(key, index);
        Some(Looked::Texture(index))
    }

    /// The image of a texture: one in a format of its own, if that is read, or the one that stands beside it.
    fn image_of(&mut self, texture: &At<'a>) -> Option<(usize, At<'a>)> {
        let root = self.root.clone();
        if let Some(webp) = texture.extension("EXT_texture_webp") {
            return webp.named("source", "images", &root, &mut self.report);
        }
        if texture.get("source").is_some() {
            return texture.named("source", "images", &root, &mut self.report);
        }
        let other = OTHER_IMAGES.iter().find(|(extension, _)| texture.extension(extension).is_some());
        match other {
            Some((extension, format)) => {
                let message = format!("its image is {format} ({extension}), which is not read");
                texture.error(&mut self.report, message);
                self.report.help("convert the images of the file to PNG or JPEG");
            }
            None => texture.error(&mut self.report, "needs a \"source\""),
        }
        None
    }

    fn bitmap(&mut self, image: usize, at: &At<'a>, wanted: Wanted) -> Option<Arc<Bitmap>> {
        if let Some(known) = self.made.bitmaps.get(&(image, wanted)) {
            return known.clone();
        }
        let bitmap = self.read_bitmap(at, wanted).map(Arc::new);
        self.made.bitmaps.insert((image, wanted), bitmap.clone());
        bitmap
    }

    fn read_bitmap(&mut self, image: &At<'a>, wanted: Wanted) -> Option<Bitmap> {
        let root = self.root.clone();
        let mut bitmap = if let Some(uri) = image.text("uri", &mut self.report) {
            let read = contents(uri, image, "magenta stands for it", &mut self.files, &mut self.report);
            let Some((path, bytes)) = read else {
                return self.files.allows_missing().then(|| Bitmap::new(1, 1, vec![MAGENTA]));
            };
            self.decoded(image, &path, &bytes, wanted)?
        } else if image.get("bufferView").is_some() {
            let (_, view) = image.named("bufferView", "bufferViews", &root, &mut self.report)?;
            let buffers = Rc::clone(&self.buffers);
            let bytes = buffers.view(&view, &root, &mut self.report)?.bytes;
            self.decoded(image, Path::new(""), bytes, wanted)?
        } else {
            image.error(&mut self.report, "needs a \"uri\" or a \"bufferView\"");
            return None;
        };
        wanted.apply(&mut bitmap);
        Some(bitmap)
    }

    fn decoded(&mut self, image: &At<'_>, path: &Path, bytes: &[u8], wanted: Wanted) -> Option<Bitmap> {
        let is_file = !path.as_os_str().is_empty();
        let of = if is_file { format!("{}: ", shown_path(path)) } else { String::new() };
        let Self { files, report, .. } = self;
        if is_cut_jpeg(bytes) {
            let message =
                format!("{of}the image ends before its picture does: what is missing has no detail");
            image.warn(report, message);
        }
        let cancel = files.cancel();
        match decode(path, bytes, wanted.reading(), &mut files.budget, cancel) {
            Ok(bitmap) => Some(bitmap),
            Err(message) => {
                image.error(report, format!("{of}the image cannot be read: {message}"));
                None
            }
        }
    }

    /// How a texture goes on beyond its picture, and whether pixels are interpolated.
    fn sampler(&mut self, texture: &At<'a>) -> (Wrap, bool) {
        let root = self.root.clone();
        let Some((_, sampler)) = texture.named("sampler", "samplers", &root, &mut self.report) else {
            return (Wrap::Repeat, true);
        };
        let mut wrap = |key: &str| match sampler.index(key, &mut self.report) {
            Some(33_071) => Wrap::Clamp,
            Some(33_648) => Wrap::Mirror,
            Some(10_497) | None => Wrap::Repeat,
            Some(other) => {
                let message = format!("there is no {key} {other}: the texture repeats");
                sampler.warn(&mut self.report, message);
                Wrap::Repeat
            }
        };
        let (along_u, along_v) = (wrap("wrapS"), wrap("wrapT"));
        if along_u != along_v {
            self.notice("textures wrap along v as they do along u", &sampler);
        }
        (along_u, sampler.index("magFilter", &mut self.report) != Some(9728))
    }

    fn transform(&mut self, info: &At<'_>) -> DAffine2 {
        let Some(transform) = info.extension("KHR_texture_transform") else { return DAffine2::IDENTITY };
        let report = &mut self.report;
        let offset = transform.numbers("offset", report).map_or(DVec2::ZERO, DVec2::from_array);
        let scale = transform.numbers("scale", report).map_or(DVec2::ONE, DVec2::from_array);
        uv_transform(offset, transform.number("rotation", report).unwrap_or(0.0), scale)
    }
}

fn uv_transform(offset: DVec2, rotation: f64, scale: DVec2) -> DAffine2 {
    let (sin, cos) = rotation.sin_cos();
    let turn = DMat2::from_cols(DVec2::new(cos, -sin), DVec2::new(sin, cos));
    DAffine2::from_mat2_translation(turn * DMat2::from_diagonal(scale), offset)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The first example of `KHR_texture_transform`: the lower left quadrant, turned clockwise.
    #[test]
    fn the_first_example_of_the_extension_takes_the_lower_left_quadrant() {
        let to_uv = uv_transform(DVec2::Y, std::f64::consts::FRAC_PI_2, DVec2::splat(0.5));
        for (uv, wanted) in [((0.0, 0.0), (0.0, 1.0)), ((1.0, 0.0), (0.0, 0.5)), ((1.0, 1.0), (0.5, 0.5))] {
            let found = to_uv.transform_point2(DVec2::from(uv));
            assert!((found - DVec2::from(wanted)).length() < 1e-12, "{uv:?}: {found}");
        }
    }
}
