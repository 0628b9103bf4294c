//! Image files to linear pixels: PNG, JPEG, WebP, BMP, TGA and PNM from 8 or 16 bits of sRGB, Radiance HDR, PFM and OpenEXR as they are.
//!
//! Colours are taken as they are, whatever alpha says, as in Mitsuba 3; alpha is read only where it is asked for. A JPEG that ends too early is read as far as it goes, with a warning; the others are errors then. Every image is decoded once for each way to read it.

mod hdr;
mod pfm;

use std::collections::HashMap;
use std::io::Cursor;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use foton_input::{printable, shown_path};
use foton_math::{Cancel, CancelReader, Rgb};
use foton_scene::description::Bitmap;
use image::{ImageDecoder, ImageFormat, ImageReader};

use crate::diagnostic::Report;
use crate::files::{Absent, Files};
use crate::limits::Budget;
use crate::mitsuba::read::properties::Located;
use crate::mitsuba::read::values::srgb_to_linear;

/// Pixels of one image: 2²⁸ fill 3 GiB.
const MAX_PIXELS: u64 = 1 << 28;

/// More pixels than this no byte of a file can hold: deflate unpacks 1,032 to 1, to at most eight pixels a byte, and the other
/// formats less. A header that claims more is broken, and must not make us allocate what it claims.
const MAX_PIXELS_PER_BYTE: u64 = 8 * 1032;

/// Bytes of a pixel in a scene.
const BYTES_PER_PIXEL: u64 = size_of::<Rgb>() as u64;

/// What stands for an image that is not there.
pub(crate) const MAGENTA: Rgb = Rgb::new(1.0, 0.0, 1.0);

/// The most characters of what a library says of a file.
const MAX_REASON: usize = 160;

/// How the numbers of an image become colours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Reading {
    /// What numbers of 8 and 16 bits mean.
    pub(crate) curve: Curve,
    /// The channel that is taken, if it is one.
    pub(crate) channel: Option<Channel>,
    /// Factor on the colours.
    pub(crate) factor: Rgb,
    /// What the colours are for.
    pub(crate) purpose: Purpose,
}

impl Reading {
    /// Light as it is.
    pub(crate) const LIGHT: Self =
        Self { curve: Curve::Srgb, channel: None, factor: Rgb::WHITE, purpose: Purpose::Light };

    fn key(&self) -> (u32, Option<Channel>, [u32; 3]) {
        let curve = match self.curve {
            Curve::Srgb => 0,
            Curve::Power(exponent) => exponent.to_bits(),
        };
        (curve, self.channel, self.factor.to_array().map(f32::to_bits))
    }
}

/// What numbers of 8 and 16 bits mean, from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Curve {
    /// They are made linear by sRGB's curve.
    Srgb,
    /// They are made linear by this power, which is above zero; 1: they are linear.
    Power(f32),
}

/// A part of a colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Channel {
    /// Of linear sRGB, by number.
    Rgb(usize),
    /// The share of the pixel that is covered.
    Alpha,
    /// The same, and 1 in an image that does not say.
    Opacity,
    /// Of CIE XYZ, by number.
    Xyz(usize),
}

/// What colours are for: what they may be.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Purpose {
    /// Shares of light, cut to [0, 1] with a warning.
    Share,
    /// Light, nothing below zero: cut to that with a warning.
    Light,
    /// Any numbers.
    Number,
}

type Key = (PathBuf, (u32, Option<Channel>, [u32; 3]));

/// Images read so far, by file and by how they are read.
#[derive(Default)]
pub(crate) struct Images {
    as_they_are: HashMap<Key, Option<Arc<Bitmap>>>,
    /// The same for a purpose; one image where nothing was cut.
    fitted: HashMap<(Key, Purpose), Option<Arc<Bitmap>>>,
}

impl Images {
    /// An image.
    pub(crate) fn read(
        &mut self,
        filename: &Located<String>,
        reading: Reading,
        files: &mut Files<'_>,
        report: &mut Report,
    ) -> Option<Arc<Bitmap>> {
        let key = (Files::key(&filename.value, filename.place, report), reading.key());
        let fitted = (key.clone(), reading.purpose);
        if let Some(known) = self.fitted.get(&fitted) {
            return known.clone();
        }
        let as_it_is = match self.as_they_are.get(&key) {
            Some(known) => known.clone(),
            None => {
                let read = read(filename, reading, files, report).map(Arc::new);
                self.as_they_are.entry(key).or_insert(read).clone()
            }
        };
        let bitmap = as_it_is.map(|bitmap| fit(bitmap, filename, reading.purpose, report));
        self.fitted.entry(fitted).or_insert(bitmap).clone()
    }
}

/// An image with nothing in it that its purpose does not allow.
fn fit(
    bitmap: Arc<Bitmap>,
    filename: &Located<String>,
    purpose: Purpose,
    report: &mut Report,
) -> Arc<Bitmap> {
    let (most, what) = match purpose {
        Purpose::Share => (1.0, "pixels outside 0 to 1, they are cut to that"),
        Purpose::Light => (f32::INFINITY, "negative pixels, they are black"),
        Purpose::Number => return bitmap,
    };
    let is_fit = |p: &Rgb| p.to_array().iter().all(|c| (0.0..=most).contains(c));
    if bitmap.pixels.iter().all(is_fit) {
        return bitmap;
    }
    let path = Files::key(&filename.value, filename.place, report);
    report.warning(filename.place, format!("{} has {what}", shown_path(&path)));
    let pixels = bitmap.pixels.iter().map(|p| p.map(|c| c.clamp(0.0, most))).collect();
    Arc::new(Bitmap::new(bitmap.width, bitmap.height, pixels))
}

fn read(
    filename: &Located<String>,
    reading: Reading,
    files: &mut Files<'_>,
    report: &mut Report,
) -> Option<Bitmap> {
    let place = filename.place;
    let (path, bytes) =
        match files.read_or_do_without(&filename.value, place, "magenta stands for it", report)? {
            Ok((path, bytes)) => (path, hdr::named(bytes)),
            Err(Absent) => return Some(Bitmap::new(1, 1, vec![MAGENTA])),
        };
    let cancel = files.cancel();
    let mut bitmap = match decode(&path, &bytes, reading, &mut files.budget, cancel) {
        Ok(bitmap) => bitmap,
        Err(message) => {
            report.error(place, format!("cannot read {}: {message}", shown_path(&path)));
            return None;
        }
    };
    if is_cut_jpeg(&bytes) {
        let message =
            format!("{} ends before its picture does: what is missing has no detail", shown_path(&path));
        report.warning(place, message);
    }
    if reading.factor != Rgb::WHITE {
        bitmap.pixels.iter_mut().for_each(|p| *p *= reading.factor);
    }
    if bitmap.pixels.iter().any(|p| !p.is_finite()) {
        report.error(place, format!("{} has pixels that are not finite numbers", shown_path(&path)));
        return None;
    }
    Some(bitmap)
}

/// The pixels of an image file. Factor and purpose of the reading are the caller's.
///
/// # Errors
/// What is wrong with it.
pub(crate) fn decode(
    path: &Path,
    bytes: &[u8],
    reading: Reading,
    budget: &mut Budget,
    cancel: &Cancel,
) -> Result<Bitmap, String> {
    let is_exr = bytes.starts_with(&[0x76, 0x2f, 0x31, 0x01]);
    if is_exr || pfm::is_pfm(bytes) {
        if matches!(reading.channel, Some(Channel::Alpha | Channel::Opacity)) {
            return Err("alpha is not read from EXR and PFM files".to_owned());
        }
        let read = if is_exr { decode_exr(path, bytes, budget, cancel) } else { decode_pfm(bytes, budget) };
        return read.map(|bitmap| of_channel(bitmap, reading.channel));
    }
    let Some(format) = format(path, bytes) else {
        return Err("it is no PNG, JPEG, WebP, BMP, TGA, PNM, PFM, Radiance HDR or EXR image".to_owned());
    };
    let mut reader = ImageReader::with_format(CancelReader::new(Cursor::new(bytes), cancel), format);
    let mut limits = image::Limits::no_limits();
    limits.max_alloc = Some(budget.left());
    reader.limits(limits);
    let decoder = reader.into_decoder().map_err(said)?;
    let (width, height) = decoder.dimensions();
    check_size(width, height)?;
    if u64::from(width) * u64::from(height) / MAX_PIXELS_PER_BYTE > bytes.len() as u64 {
        return Err(format!("{width} × {height} pixels cannot be in {} bytes", bytes.len()));
    }
    // As it is stored, and as we keep it; for some formats once more, as numbers of another kind.
    let pixels = u64::from(width) * u64::from(height);
    let colour = decoder.color_type();
    let as_rgb = 3 * u64::from(colour.bytes_per_pixel() / colour.channel_count());
    budget.check(pixels.saturating_mul(BYTES_PER_PIXEL + as_rgb).saturating_add(decoder.total_bytes()))?;
    budget.take(pixels * BYTES_PER_PIXEL)?;
    let image = image::DynamicImage::from_decoder(decoder).map_err(said)?;
    if matches!(reading.channel, Some(Channel::Alpha | Channel::Opacity)) {
        if !colour.has_alpha() && reading.channel == Some(Channel::Alpha) {
            return Err("it has no alpha channel".to_owned());
        }
        let pixels = image.into_rgba32f().pixels().map(|p| Rgb::splat(p.0[3])).collect();
        return Ok(Bitmap::new(width, height, pixels));
    }
    let bitmap = Bitmap::new(width, height, linear(image, reading.curve));
    Ok(of_channel(bitmap, reading.channel))
}

/// The pixels of an image, those of 8 and 16 bits made linear.
fn linear(image: image::DynamicImage, curve: Curve) -> Vec<Rgb> {
    let linear = |encoded: f32| match curve {
        Curve::Srgb => srgb_to_linear(f64::from(encoded)) as f32,
        Curve::Power(exponent) => encoded.powf(exponent),
    };
    match image.color() {
        image::ColorType::Rgb32F | image::ColorType::Rgba32F => {
            image.into_rgb32f().pixels().map(|p| Rgb::from_array(p.0)).collect()
        }
        c if c.bytes_per_pixel() == c.channel_count() => {
            let table: [f32; 256] = std::array::from_fn(|i| linear(i as f32 / 255.0));
            let pixel = |p: &image::Rgb<u8>| Rgb::from_array(p.0.map(|c| table[usize::from(c)]));
            image.into_rgb8().pixels().map(pixel).collect()
        }
        _ => {
            let pixel = |p: &image::Rgb<u16>| Rgb::from_array(p.0.map(|c| linear(f32::from(c) / 65_535.0)));
            image.into_rgb16().pixels().map(pixel).collect()
        }
    }
}

/// Grey of one channel, where one is asked for.
fn of_channel(mut bitmap: Bitmap, channel: Option<Channel>) -> Bitmap {
    /// CIE XYZ of linear sRGB (IEC 61966-2-1).
    const XYZ: [[f32; 3]; 3] = [
        [0.412_391, 0.357_584, 0.180_481],
        [0.212_639, 0.715_169, 0.072_192],
        [0.019_331, 0.119_195, 0.950_532],
    ];
    let of = |p: Rgb| match channel {
        Some(Channel::Rgb(i)) => Rgb::splat(p.to_array()[i]),
        Some(Channel::Xyz(i)) => Rgb::splat(XYZ[i].iter().zip(p.to_array()).map(|(a, b)| a * b).sum()),
        Some(Channel::Alpha | Channel::Opacity) | None => p,
    };
    bitmap.pixels.iter_mut().for_each(|p| *p = of(*p));
    bitmap
}

fn decode_pfm(bytes: &[u8], budget: &mut Budget) -> Result<Bitmap, String> {
    let header = pfm::Header::parse(bytes)?;
    check_size(header.width, header.height)?;
    budget.take(u64::from(header.width) * u64::from(header.height) * BYTES_PER_PIXEL)?;
    Ok(Bitmap::new(header.width, header.height, header.pixels(bytes)?))
}

/// The format of an image that is no EXR image. TGA files have no mark at their beginning, and older ones none at all.
fn format(path: &Path, bytes: &[u8]) -> Option<ImageFormat> {
    use ImageFormat::{Bmp, Hdr, Jpeg, Png, Pnm, Tga, WebP};
    let guessed =
        image::guess_format(bytes).ok().filter(|f| matches!(f, Bmp | Hdr | Jpeg | Png | Pnm | WebP));
    let is_tga = || {
        path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("tga"))
            || bytes.ends_with(b"TRUEVISION-XFILE.\0")
    };
    guessed.or_else(|| is_tga().then_some(Tga))
}

const JPEG_START: [u8; 2] = [0xff, 0xd8];

/// Whether a file is JPEG and lacks the mark of its end: going from segment to segment, since pictures within, as cameras write
/// them, have marks of their own.
pub(crate) fn is_cut_jpeg(bytes: &[u8]) -> bool {
    if !bytes.starts_with(&JPEG_START) {
        return false;
    }
    let mut at = JPEG_START.len();
    // A byte of 255 is a mark's beginning; behind it more of them may fill up, or there is the kind of mark.
    while let Some(offset) = bytes.get(at..).and_then(|rest| rest.iter().position(|&b| b == 0xff)) {
        at += offset;
        let Some(kind) = bytes[at..].iter().position(|&b| b != 0xff) else { return true };
        at += kind;
        match bytes[at] {
            0xd9 => return false,
            // A byte of 255 in the picture, and marks without anything behind.
            0 | 1 | 0xd0..=0xd8 => at += 1,
            _ => match bytes.get(at + 1..at + 3) {
                Some(&[high, low]) => at += 1 + usize::from(u16::from_be_bytes([high, low])),
                _ => return true,
            },
        }
    }
    true
}

/// What a library says of a file: it may quote that.
fn said(error: impl std::fmt::Display) -> String {
    printable(&error.to_string()).chars().take(MAX_REASON).collect()
}

fn decode_exr(path: &Path, bytes: &[u8], budget: &mut Budget, cancel: &Cancel) -> Result<Bitmap, String> {
    let image = match foton_film::decode_exr(bytes, path, Some(budget.left()), cancel) {
        Ok((image, _)) => image,
        Err(foton_film::ReadError::Malformed { reason, .. }) => return Err(reason),
        Err(foton_film::ReadError::TooLarge { takes, .. }) => {
            return Err(budget.check(takes).err().unwrap_or_default());
        }
        Err(foton_film::ReadError::NoRgb { channels, .. }) => {
            return Err(format!("it has no channels R, G and B, nor Y alone, only {channels}"));
        }
        Err(other) => return Err(other.to_string()),
    };
    check_size(image.width, image.height)?;
    budget.take(image.pixels.len() as u64 * BYTES_PER_PIXEL)?;
    Ok(Bitmap::new(image.width, image.height, image.pixels))
}

fn check_size(width: u32, height: u32) -> Result<(), String> {
    let pixels = u64::from(width) * u64::from(height);
    if pixels == 0 || pixels > MAX_PIXELS {
        return Err(format!("{width} × {height} pixels are none or too many"));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn webp_images_have_their_colours_and_opacities() {
        let mut bytes = Vec::new();
        let shades = image::RgbaImage::from_fn(8, 4, |x, y| {
            image::Rgba([x as u8 * 30, y as u8 * 60, 7, x as u8 * 20])
        });
        shades.write_to(&mut Cursor::new(&mut bytes), ImageFormat::WebP).unwrap();
        let linear = Reading { curve: Curve::Power(1.0), purpose: Purpose::Number, ..Reading::LIGHT };
        let read = |channel| {
            let reading = Reading { channel, ..linear };
            decode(Path::new("a"), &bytes, reading, &mut Budget::new(None), &Cancel::default()).unwrap()
        };
        let (colours, opacities) = (read(None), read(Some(Channel::Opacity)));
        assert_eq!((colours.width, colours.height), (8, 4));
        assert_eq!(colours.pixels[8 * 2 + 3], Rgb::new(90.0, 120.0, 7.0) / 255.0);
        assert_eq!(opacities.pixels[8 * 2 + 3], Rgb::splat(60.0 / 255.0));
        for length in 0..bytes.len() / 2 {
            let cut = &bytes[..length];
            assert!(decode(Path::new("a"), cut, linear, &mut Budget::new(None), &Cancel::default()).is_err());
        }
    }

    #[test]
    fn a_jpeg_is_cut_wherever_it_ends_before_its_mark() {
        let mut bytes = Vec::new();
        let shades =
            image::RgbImage::from_fn(40, 30, |x, y| image::Rgb([x as u8 * 6, y as u8 * 8, (x * y) as u8]));
        shades.write_to(&mut Cursor::new(&mut bytes), ImageFormat::Jpeg).unwrap();
        assert!(!is_cut_jpeg(&bytes));
        assert!(!is_cut_jpeg(&[&bytes[..], b"and more"].concat()));
        for length in 2..bytes.len() {
            assert!(is_cut_jpeg(&bytes[..length]), "{length} of {}", bytes.len());
        }
        // A picture in a segment has an end of its own.
        let inner = [&[0xff, 0xe1][..], &(bytes.len() as u16 + 2).to_be_bytes(), &bytes].concat();
        let outer = [&bytes[..2], &inner, &bytes[2..]].concat();
        assert!(!is_cut_jpeg(&outer) && is_cut_jpeg(&outer[..outer.len() - 2]));
    }
}
