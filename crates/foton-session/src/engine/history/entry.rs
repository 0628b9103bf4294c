//! A pass that was kept, as a window sees it.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use foton_film::{Image, tone_map};
use foton_integrator::{Render, RenderSettings};
use foton_math::Rgb;

use crate::engine::command::Region;
use crate::snapshot::Look;

/// Pixels of the longer side of a thumbnail.
const SIDE: u32 = 128;

/// A small picture, as it was shown: rows of red, green and blue from the top left.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Thumbnail {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Three bytes a pixel.
    pub rgb: Vec<u8>,
}

impl Thumbnail {
    /// Of a picture, through exposure and tone map.
    #[must_use]
    pub fn of(image: &Image, look: Look) -> Self {
        let small = shrunk(image);
        let shown = |&c: &Rgb| tone_map::display(c, look.tone_map, look.exposure_stops);
        Self { size: [small.width, small.height], rgb: small.pixels.iter().flat_map(shown).collect() }
    }
}

/// A picture made small: means of squares of its pixels.
#[must_use]
pub fn shrunk(image: &Image) -> Image {
    let shrink = (image.width.max(image.height)).div_ceil(SIDE).max(1);
    let [width, height] = [image.width, image.height].map(|side| side.div_ceil(shrink));
    let places = (0..height).flat_map(|y| (0..width).map(move |x| [x * shrink, y * shrink]));
    Image { width, height, pixels: places.map(|at| mean(image, at, shrink)).collect() }
}

/// The mean of a square of pixels, as far as it is inside; pixels that are not finite count as black.
fn mean(image: &Image, [left, top]: [u32; 2], side: u32) -> Rgb {
    let (mut sum, mut count) = (Rgb::BLACK, 0.0);
    for y in top..(top + side).min(image.height) {
        for x in left..(left + side).min(image.width) {
            let c = image.pixels[y as usize * image.width as usize + x as usize];
            sum += if c.is_finite() { c.map(|v| v.clamp(0.0, tone_map::BRIGHTEST)) } else { Rgb::BLACK };
            count += 1.0;
        }
    }
    sum / f32::max(count, 1.0)
}

/// A pass that was kept.
#[derive(Clone, Debug)]
pub struct HistoryEntry {
    /// Its number, which no other has.
    pub id: u64,
    /// The number of its render.
    pub render: u64,
    /// Passes.
    pub passes: u64,
    /// Photons emitted.
    pub photons: u64,
    /// Time of rendering.
    pub elapsed: Duration,
    /// Total error, where it was known.
    pub error: Option<f64>,
    /// What a person calls the scene.
    pub scene: String,
    /// Settings in words.
    pub settings: String,
    /// The part of the image that was rendered.
    pub window: Region,
    /// What it looked like.
    pub thumbnail: Arc<Thumbnail>,
    /// The file of its picture, an EXR, once that is written.
    pub picture: PathBuf,
}

/// Settings as a person compares them.
pub(crate) fn in_words(settings: &RenderSettings, render: &Render) -> String {
    let (ppm, sensor) = (&settings.ppm, &render.scene().sensors()[settings.sensor]);
    let photons = if settings.method.has_photons() {
        format!("α {}, {} photons/pass, radii {}, ", ppm.alpha, ppm.photons_per_pass, ppm.radius_rule.name())
    } else {
        String::new()
    };
    format!(
        "{}, {photons}{} samples/pixel, seed {}, {} x {} pixels",
        settings.method.name(),
        settings.samples_per_pixel,
        settings.seed,
        sensor.width,
        sensor.height
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_thumbnail_is_small_and_shows_what_was_shown() {
        let mut image = Image::black(400, 200);
        image.pixels.fill(Rgb::new(0.5, 0.25, 0.125));
        image.pixels[0] = Rgb::splat(f32::NAN);
        let look = Look { exposure_stops: 1.0, ..Look::default() };
        let thumbnail = Thumbnail::of(&image, look);
        assert_eq!(thumbnail.size, [100, 50]);
        assert_eq!(thumbnail.rgb.len(), 3 * 5000);
        let shown = tone_map::display(image.pixels[1], look.tone_map, 1.0);
        assert_eq!(thumbnail.rgb[3 * 4999..], shown);
        assert!(thumbnail.rgb[0] > 100, "one pixel that is no number does not blacken the rest");
        assert_eq!(Thumbnail::of(&Image::black(1, 1), look).size, [1, 1]);
    }
}
