//! PNG files: 8-bit sRGB as [`tone_map::display`] makes it, marked as sRGB, with metadata as text chunks.

use std::io::Write;
use std::path::Path;

use png::text_metadata::{ITXtChunk, TEXtChunk};
use png::{BitDepth, ColorType, Compression, Encoder, EncodingError, ScaledFloat, SrgbRenderingIntent};

use crate::{ContentError, Image, Metadata, ToneMap, WriteError, atomic_write, tone_map};

/// Writes `image` as an 8-bit sRGB PNG, exposed by `stops` and mapped by `tone_map`; same input, same bytes.
///
/// A pixel with a NaN or infinite channel becomes [`tone_map::NOT_FINITE`]. Metadata goes into one text chunk per
/// key in its order: `tEXt` where the value is Latin-1, `iTXt` (UTF-8) otherwise.
///
/// # Errors
/// [`WriteError`] with the path; the file that was there is then untouched.
pub fn write_png(
    path: &Path,
    image: &Image,
    tone_map: ToneMap,
    stops: f32,
    metadata: &Metadata,
) -> Result<(), WriteError> {
    let to_error = WriteError::content(path);
    image.check().map_err(&to_error)?;
    metadata.check().map_err(ContentError::from).map_err(&to_error)?;
    let pixels: Vec<u8> = image.pixels.iter().flat_map(|&c| tone_map::display(c, tone_map, stops)).collect();
    let bytes = encode(image.width, image.height, &pixels, metadata)
        .map_err(|cause| to_error(ContentError::Encoder(cause.to_string())))?;
    atomic_write(path, |file| file.write_all(&bytes))
}

/// The bytes of the file.
fn encode(width: u32, height: u32, rgb8: &[u8], metadata: &Metadata) -> Result<Vec<u8>, EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, width, height);
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(Compression::Balanced);
    encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
    // 1/2.2 in units of 1e-5: what the PNG specification asks for beside sRGB, for readers that know only gAMA.
    encoder.set_source_gamma(ScaledFloat::from_scaled(45455));
    let mut writer = encoder.write_header()?;
    for (key, value) in metadata.iter() {
        let is_latin1 = value.chars().all(|c| u32::from(c) < 256);
        if is_latin1 {
            writer.write_text_chunk(&TEXtChunk::new(key, value))?;
        } else {
            writer.write_text_chunk(&ITXtChunk::new(key, value))?;
        }
    }
    writer.write_image_data(rgb8)?;
    writer.finish()?;
    Ok(bytes)
}
