//! A contact sheet: images of one size side by side, each with lines of text below it.

use font8x8::{BASIC_FONTS, UnicodeFonts};
use foton_film::Image;
use foton_math::Rgb;

/// Radiance of text: white at any exposure that shows anything else.
const INK: Rgb = Rgb::splat(1e4);

/// Side of a letter in pixels, before it is enlarged.
const LETTER: u32 = 8;

/// An image of a contact sheet.
#[derive(Clone, Debug)]
pub struct Panel<'a> {
    /// Radiance.
    pub image: &'a Image,
    /// Lines below it; letters that the font has not are left out.
    pub caption: Vec<String>,
}

/// A contact sheet of panels, as near to a square as rows of equal length are; black without any.
#[must_use]
pub fn contact_sheet(panels: &[Panel<'_>]) -> Image {
    let width = panels.iter().map(|p| p.image.width).max().unwrap_or(1);
    let height = panels.iter().map(|p| p.image.height).max().unwrap_or(1);
    let lines = panels.iter().map(|p| p.caption.len()).max().unwrap_or(0) as u32;
    let longest = panels.iter().flat_map(|p| &p.caption).map(|line| line.chars().count() as u32).max();
    let scale = letter_scale(width, longest.unwrap_or(1));
    let columns = columns(panels.len() as u32, width, height);
    let (gap, line) = (LETTER * scale, (LETTER + 2) * scale);
    let cell = [width + gap, height + lines * line + gap];
    let rows = (panels.len() as u32).div_ceil(columns).max(1);
    let mut sheet = Image::black(columns * cell[0] + gap, rows * cell[1] + gap);
    for (i, panel) in panels.iter().enumerate() {
        let (column, row) = (i as u32 % columns, i as u32 / columns);
        let corner = [gap + column * cell[0], gap + row * cell[1]];
        copy(panel.image, &mut sheet, corner);
        for (n, text) in panel.caption.iter().enumerate() {
            let top = corner[1] + panel.image.height + n as u32 * line + 2 * scale;
            write(text, &mut sheet, [corner[0], top], scale, width);
        }
    }
    sheet
}

/// How much letters are enlarged, so that the longest line of so many letters fits below an image: at most so that fifty would.
fn letter_scale(width: u32, longest: u32) -> u32 {
    (width / (LETTER * longest.max(50))).max(1)
}

/// Columns with which a sheet of so many images is as near to a square as it gets.
fn columns(images: u32, width: u32, height: u32) -> u32 {
    let lopsided = |columns: u32| {
        let (w, h) = (f64::from(columns * width), f64::from(images.div_ceil(columns) * height));
        (w / h).ln().abs()
    };
    (1..=images.max(1)).min_by(|a, b| lopsided(*a).total_cmp(&lopsided(*b))).unwrap_or(1)
}

fn copy(from: &Image, to: &mut Image, [left, top]: [u32; 2]) {
    for y in 0..from.height {
        let source = (y * from.width) as usize;
        let target = ((top + y) * to.width + left) as usize;
        let width = from.width as usize;
        to.pixels[target..target + width].copy_from_slice(&from.pixels[source..source + width]);
    }
}

/// Writes a line of at most `width` pixels.
fn write(text: &str, to: &mut Image, [left, top]: [u32; 2], scale: u32, width: u32) {
    let fits = (width / (LETTER * scale)) as usize;
    for (n, rows) in text.chars().filter_map(|c| BASIC_FONTS.get(c)).take(fits).enumerate() {
        let left = left + n as u32 * LETTER * scale;
        for (y, row) in rows.iter().enumerate() {
            for x in (0..LETTER).filter(|x| row >> x & 1 == 1) {
                dot(to, [left + x * scale, top + y as u32 * scale], scale);
            }
        }
    }
}

fn dot(to: &mut Image, [left, top]: [u32; 2], scale: u32) {
    for y in top..(top + scale).min(to.height) {
        for x in left..(left + scale).min(to.width) {
            to.pixels[(y * to.width + x) as usize] = INK;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image(width: u32, height: u32, light: f32) -> Image {
        Image { width, height, pixels: vec![Rgb::splat(light); (width * height) as usize] }
    }

    #[test]
    fn every_image_is_there_as_it_is_with_its_caption_below() {
        let images = [1.0, 2.0, 3.0].map(|light| image(120, 60, light));
        let panel = |image| Panel { image, caption: vec!["path".into(), "error 3 %".into()] };
        let panels: Vec<_> = images.iter().map(panel).collect();
        let sheet = contact_sheet(&panels);
        for light in [1.0, 2.0, 3.0] {
            let pixels = sheet.pixels.iter().filter(|p| **p == Rgb::splat(light)).count();
            assert_eq!(pixels, 120 * 60);
        }
        // As many letters' dots as three captions have.
        let dots = |text: &str| -> u32 {
            text.chars().filter_map(|c| BASIC_FONTS.get(c)).flatten().map(u8::count_ones).sum()
        };
        let ink = sheet.pixels.iter().filter(|p| **p == INK).count() as u32;
        assert_eq!(ink, 3 * (dots("path") + dots("error 3 %")));
    }

    #[test]
    fn wide_images_lie_below_each_other_and_tall_ones_beside() {
        assert_eq!(columns(4, 100, 100), 2);
        assert_eq!(columns(3, 300, 100), 1);
        assert_eq!(columns(3, 100, 300), 3);
        assert_eq!(columns(0, 100, 100), 1);
    }

    #[test]
    fn a_line_that_is_too_long_ends_at_its_image() {
        let image = image(40, 8, 0.5);
        let sheet = contact_sheet(&[Panel { image: &image, caption: vec!["W".repeat(99)] }]);
        let inked = |x: u32| (0..sheet.height).any(|y| sheet.pixels[(y * sheet.width + x) as usize] == INK);
        assert!((0..sheet.width).filter(|x| inked(*x)).max().is_some_and(|x| x < 8 + 40));
    }
}
