//! Reading an EXR image back: R, G, B of its first layer, or Y alone as grey, and the text attributes. Further channels are
//! ignored.

use std::io::Cursor;
use std::path::Path;

use exr::meta::MetaData;
use exr::prelude::{ReadChannels, ReadLayers, ReadSpecificChannel, Vec2, read};
use foton_input::shown;
use foton_math::{Cancel, CancelReader, Rgb};

use crate::image::area;
use crate::input::{self, Room};
use crate::{Image, Metadata, ReadError, exr_header};

/// More pixels than this per byte of the file no compression reaches; a header that claims more is broken.
const PIXELS_PER_BYTE: usize = 4096;

/// Channels that a message names.
const MAX_NAMES: usize = 8;

/// What a pixel takes while it is read: in the image, in the blocks that it is unpacked from, and on the way.
const BYTES_PER_PIXEL: u64 = 40;

/// Reads the channels `R`, `G`, `B` of the first layer that has them, and the file's text attributes in their order. Where no
/// layer has them, a luminance `Y` without chroma is all three.
///
/// Half floats and integers become 32-bit floats; 32-bit floats keep every bit. The image is the data window: where
/// it stands in the display window is not told.
///
/// # Errors
/// [`ReadError`] with the path: it cannot be opened, is no EXR file or a broken one, or has neither R, G, B nor Y alone.
pub fn read_exr(path: &Path) -> Result<(Image, Metadata), ReadError> {
    read_exr_within(path, None)
}

/// [`read_exr`] within that many bytes of memory; `None`: as many as there are.
///
/// # Errors
/// As [`read_exr`], and where the file or its pixels would take more.
pub fn read_exr_within(path: &Path, memory: Option<u64>) -> Result<(Image, Metadata), ReadError> {
    let bytes = input::read(path, memory)?;
    decode_exr(&bytes, path, memory, &Cancel::default())
}

/// [`read_exr_within`] for the contents of a file; `path` stands in messages. An error of some kind as well once `cancel` is requested.
///
/// # Errors
/// As [`read_exr_within`].
pub fn decode_exr(
    bytes: &[u8],
    path: &Path,
    memory: Option<u64>,
    cancel: &Cancel,
) -> Result<(Image, Metadata), ReadError> {
    let malformed = |reason: &str| ReadError::malformed(path, "EXR", reason);
    if !bytes.starts_with(&[0x76, 0x2f, 0x31, 0x01]) {
        return Err(malformed("it does not begin as one"));
    }
    let meta = MetaData::read_from_buffered(Cursor::new(bytes), false)
        .map_err(|cause| malformed(&cause.to_string()))?;
    let channels = check(&meta, bytes.len(), path, memory)?;
    let metadata = exr_header::text_attributes(bytes).ok_or_else(|| malformed("broken header"))?;
    let levels = read().no_deep_data().largest_resolution_level();
    let pixels = match channels {
        Channels::Rgb => levels
            .rgb_channels(
                |size, _| black(size),
                |image: &mut Image, at, (r, g, b): (f32, f32, f32)| set(image, at, Rgb::new(r, g, b)),
            )
            .first_valid_layer()
            .all_attributes()
            .from_buffered(CancelReader::new(Cursor::new(bytes), cancel))
            .map(|image| image.layer_data.channel_data.pixels),
        Channels::Grey => levels
            .specific_channels()
            .required("Y")
            .collect_pixels(
                |size, _| black(size),
                |image: &mut Image, at, (y,): (f32,)| set(image, at, Rgb::splat(y)),
            )
            .first_valid_layer()
            .all_attributes()
            .from_buffered(CancelReader::new(Cursor::new(bytes), cancel))
            .map(|image| image.layer_data.channel_data.pixels),
    };
    Ok((pixels.map_err(|cause| malformed(&cause.to_string()))?, metadata))
}

fn black(size: Vec2<usize>) -> Image {
    Image::black(size.x() as u32, size.y() as u32)
}

fn set(image: &mut Image, Vec2(x, y): Vec2<usize>, pixel: Rgb) {
    image.pixels[y * image.width as usize + x] = pixel;
}

/// What a file's colours are in.
#[derive(Clone, Copy)]
enum Channels {
    Rgb,
    Grey,
}

/// Refuses files without colours that are read, and files whose size cannot be true.
fn check(
    meta: &MetaData,
    file_bytes: usize,
    path: &Path,
    memory: Option<u64>,
) -> Result<Channels, ReadError> {
    let names = |header: &exr::meta::header::Header| -> Vec<String> {
        header.channels.list.iter().map(|channel| channel.name.to_string()).collect()
    };
    let any_has = |all: &[&str], none: &[&str]| {
        meta.headers.iter().map(names).any(|names| {
            let has = |wanted: &&str| names.iter().any(|name| name == wanted);
            all.iter().all(has) && !none.iter().any(has)
        })
    };
    let channels = if any_has(&["R", "G", "B"], &[]) {
        Channels::Rgb
    } else if any_has(&["Y"], &["RY", "BY"]) {
        Channels::Grey
    } else {
        let all = meta.headers.first().map(names).unwrap_or_default();
        let mut channels: Vec<String> = all.iter().take(MAX_NAMES).map(|name| shown(name)).collect();
        channels.extend((all.len() > MAX_NAMES).then(|| format!("{} more", all.len() - MAX_NAMES)));
        return Err(ReadError::NoRgb { path: path.into(), channels: channels.join(", ") });
    };
    for header in &meta.headers {
        let Vec2(width, height) = header.layer_size;
        let fits = |side: usize| u32::try_from(side).ok();
        let pixels = fits(width).zip(fits(height)).map(|(width, height)| area(width, height));
        if pixels.is_none_or(|pixels| pixels / PIXELS_PER_BYTE > file_bytes) {
            let reason = format!("{width} × {height} pixels cannot be in {file_bytes} bytes");
            return Err(ReadError::malformed(path, "EXR", &reason));
        }
        Room { memory, bytes_per_pixel: BYTES_PER_PIXEL }.check(path, width as u64, height as u64)?;
    }
    Ok(channels)
}
