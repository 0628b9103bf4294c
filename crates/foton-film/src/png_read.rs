//! Reading a PNG picture back as linear colours. What a tone map or clipping took away stays away; metadata is ignored.

use std::io::Cursor;
use std::path::Path;

use foton_math::Rgb;
use png::{BitDepth, ColorType, Decoder, Limits, Transformations};

use crate::image::area;
use crate::input::{self, Room};
use crate::{Image, ReadError, tone_map};

/// More pixels than this per byte of the file deflate cannot reach (1,032 to 1, eight pixels a byte); a header that
/// claims more is broken.
const PIXELS_PER_BYTE: usize = 8 * 1032;

/// What a pixel takes while it is read: its samples as they are stored and as numbers, and in the image.
const BYTES_PER_PIXEL: u64 = 36;

/// What else than pixels a file may unpack, such as a colour profile, of which nothing is read.
const MAX_BESIDE: usize = 64 << 20;

/// Reads a PNG of any colour type and depth as linear colours in [0, 1]³.
///
/// Values are taken as sRGB whatever the file says of its colour space, grey fills all channels, and transparency is
/// ignored.
///
/// # Errors
/// [`ReadError`] with the path: it cannot be opened, is no PNG file or a broken one.
pub fn read_png(path: &Path) -> Result<Image, ReadError> {
    read_png_within(path, None)
}

/// [`read_png`] within that many bytes of memory; `None`: as many as there are.
///
/// # Errors
/// As [`read_png`], and where the file or its pixels would take more.
pub fn read_png_within(path: &Path, memory: Option<u64>) -> Result<Image, ReadError> {
    decode_png(&input::read(path, memory)?, path, memory)
}

/// [`read_png_within`] for the contents of a file; `path` stands in messages.
///
/// # Errors
/// As [`read_png_within`].
pub fn decode_png(bytes: &[u8], path: &Path, memory: Option<u64>) -> Result<Image, ReadError> {
    let malformed = |reason: String| ReadError::malformed(path, "PNG", &reason);
    if !bytes.starts_with(b"\x89PNG") {
        return Err(malformed("it does not begin as one".into()));
    }
    let mut decoder = Decoder::new_with_limits(Cursor::new(bytes), Limits { bytes: MAX_BESIDE });
    decoder.set_transformations(Transformations::EXPAND);
    let mut reader = decoder.read_info().map_err(|cause| malformed(cause.to_string()))?;
    let (width, height) = (reader.info().width, reader.info().height);
    let too_large = || malformed(format!("{width} × {height} pixels cannot be in {} bytes", bytes.len()));
    if area(width, height) / PIXELS_PER_BYTE > bytes.len() {
        return Err(too_large());
    }
    Room { memory, bytes_per_pixel: BYTES_PER_PIXEL }.check(path, width.into(), height.into())?;
    let mut values = vec![0; reader.output_buffer_size().ok_or_else(too_large)?];
    reader.next_frame(&mut values).map_err(|cause| malformed(cause.to_string()))?;
    let (color, depth) = reader.output_color_type();
    let encoded: Vec<f32> = match depth {
        BitDepth::Sixteen => {
            values.as_chunks().0.iter().map(|&pair| f32::from(u16::from_be_bytes(pair)) / 65535.0).collect()
        }
        _ => values.iter().map(|&v| f32::from(v) / 255.0).collect(),
    };
    let pixels = encoded.chunks_exact(color.samples()).map(|samples| rgb(color, samples)).collect();
    Ok(Image { width, height, pixels })
}

/// The linear colour of one pixel's encoded samples.
fn rgb(color: ColorType, samples: &[f32]) -> Rgb {
    let encoded = match (color, samples) {
        (ColorType::Rgb | ColorType::Rgba, &[r, g, b, ..]) => Rgb::new(r, g, b),
        _ => Rgb::splat(samples[0]),
    };
    encoded.map(tone_map::srgb_decode)
}
