//! Pixels, and smaller copies of them in which each pixel is the mean of those that it stands for.

use std::fmt;
use std::sync::{Arc, OnceLock};

use foton_math::Rgb;
use foton_math::glam::Vec2;

/// Linear pixels, row-major from the top left; texture coordinate v points up, so v = 0 is the last row's lower edge.
#[derive(Clone, Debug, Default)]
pub struct Bitmap {
    /// Width in pixels, at least 1.
    pub width: u32,
    /// Height in pixels, at least 1.
    pub height: u32,
    /// `width × height` pixels.
    pub pixels: Vec<Rgb>,
    /// Smaller copies, for lookups over more than a pixel.
    pub smaller: Smaller,
}

/// What a bitmap shows beyond the unit square.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Wrap {
    /// The same again.
    #[default]
    Repeat,
    /// The same again, mirrored each time.
    Mirror,
    /// The edge's pixels.
    Clamp,
}

/// Copies of a bitmap, each half as wide and as high as the one before, down to one pixel. They are made when they are first asked
/// for, and take a third of what the bitmap takes. A clone of a bitmap, whose pixels may be changed, makes its own.
#[derive(Default)]
pub struct Smaller(OnceLock<Arc<[Bitmap]>>);

impl Clone for Smaller {
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl fmt::Debug for Smaller {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Smaller")
    }
}

impl Bitmap {
    /// A bitmap of those pixels.
    #[must_use]
    pub fn new(width: u32, height: u32, pixels: Vec<Rgb>) -> Self {
        Self { width, height, pixels, smaller: Smaller::default() }
    }

    /// Whether there is at least one pixel, and as many as width and height say.
    #[must_use]
    pub fn is_sound(&self) -> bool {
        let pixels = u64::from(self.width) * u64::from(self.height);
        pixels > 0 && pixels == self.pixels.len() as u64
    }

    /// Smaller copies, the largest first; none of a single pixel.
    pub(crate) fn smaller(&self) -> &[Self] {
        self.smaller.0.get_or_init(|| {
            let mut all: Vec<Self> = Vec::new();
            while let last = all.last().unwrap_or(self)
                && last.width.max(last.height) > 1
            {
                all.push(last.halved());
            }
            all.into()
        })
    }

    /// Half as wide and as high, rounded down: each pixel is the mean of the area that it covers, and the mean of all stays the same.
    fn halved(&self) -> Self {
        let (width, height) = ((self.width / 2).max(1), (self.height / 2).max(1));
        if 2 * width == self.width && 2 * height == self.height {
            // Large pictures have even sides: four pixels each.
            let rows = self.pixels.chunks_exact(2 * self.width as usize);
            let of_rows = |rows: &[Rgb]| {
                let (above, below) = rows.split_at(self.width as usize);
                let pairs = above.chunks_exact(2).zip(below.chunks_exact(2));
                pairs.map(|(a, b)| (a[0] + a[1] + b[0] + b[1]) * 0.25).collect::<Vec<_>>()
            };
            return Self::new(width, height, rows.flat_map(of_rows).collect());
        }
        let across: Vec<Rgb> = (0..self.height as usize)
            .flat_map(|y| {
                let row = &self.pixels[y * self.width as usize..(y + 1) * self.width as usize];
                (0..width).map(move |x| mean(x, self.width, width, |i| row[i]))
            })
            .collect();
        let pixel =
            |x: u32, y: u32| mean(y, self.height, height, |i| across[i * width as usize + x as usize]);
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| pixel(x, y));
        Self::new(width, height, pixels.collect())
    }

    pub(crate) fn size(&self) -> Vec2 {
        Vec2::new(self.width as f32, self.height as f32)
    }

    /// The colour at a place in texture coordinates.
    pub(crate) fn at(&self, uv: Vec2, wrap: Wrap, bilinear: bool) -> Rgb {
        let p = Vec2::new(uv.x, 1.0 - uv.y) * self.size();
        let at = |x: f32, y: f32| {
            let x = wrapped(x as i64, self.width, wrap);
            let y = wrapped(y as i64, self.height, wrap);
            self.pixels[y * self.width as usize + x]
        };
        if !bilinear {
            let p = p.floor();
            return at(p.x, p.y);
        }
        let low = (p - 0.5).floor();
        let f = p - 0.5 - low;
        let row = |y: f32| at(low.x, y) * (1.0 - f.x) + at(low.x + 1.0, y) * f.x;
        row(low.y) * (1.0 - f.y) + row(low.y + 1.0) * f.y
    }
}

/// The mean of what pixel `i` of `fewer` covers of `many` in a row.
fn mean(i: u32, many: u32, fewer: u32, at: impl Fn(usize) -> Rgb) -> Rgb {
    let size = many as f32 / fewer as f32;
    let (from, to) = (u64::from(i) * u64::from(many), u64::from(i + 1) * u64::from(many));
    let fewer = u64::from(fewer);
    let covered = |k: u64| ((k + 1) * fewer).min(to) - (k * fewer).max(from);
    let share = |k: u64| covered(k) as f32 / fewer as f32;
    (from / fewer..to.div_ceil(fewer)).map(|k| at(k as usize) * share(k)).sum::<Rgb>() / size
}

/// The pixel that a coordinate beyond the picture shows.
fn wrapped(i: i64, size: u32, wrap: Wrap) -> usize {
    let n = i64::from(size);
    let inside = match wrap {
        Wrap::Repeat => i.rem_euclid(n),
        Wrap::Clamp => i.clamp(0, n - 1),
        Wrap::Mirror => {
            let m = i.rem_euclid(2 * n);
            if m < n { m } else { 2 * n - 1 - m }
        }
    };
    inside as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn smaller_copies_have_the_mean_of_the_bitmap() {
        for (width, height) in [(8, 8), (7, 5), (1, 9), (13, 2), (1, 1)] {
            let pixels = (0..width * height).map(|i| Rgb::splat((i * i % 17) as f32)).collect();
            let bitmap = Bitmap::new(width, height, pixels);
            let mean = |b: &Bitmap| b.pixels.iter().map(|p| p.r).sum::<f32>() / b.pixels.len() as f32;
            for smaller in bitmap.smaller() {
                assert!(smaller.is_sound());
                assert!((mean(smaller) / mean(&bitmap) - 1.0).abs() < 1e-5, "{width}×{height}");
            }
            let last = bitmap.smaller().last().unwrap_or(&bitmap);
            assert_eq!((last.width, last.height), (1, 1));
        }
    }
}
