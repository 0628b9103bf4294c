//! The order in which pixels are lit: evenly spread at any time, so that a picture gets better everywhere at once.
//!
//! Of each square of 8 × 8 pixels one is lit before the next of any. Which one starts differs from square to square; from there
//! on they follow each other as far apart as can be. Places beyond the image's right and lower edge have no pixel.

use foton_math::{Purpose, Stream};

/// Pixels along the side of a square.
const SIDE: u64 = 8;

/// Places of all pixels of an image.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Order {
    width: u64,
    height: u64,
    squares: u64,
    /// Squares from one to the next: it has no factor in common with their number.
    stride: u64,
}

impl Order {
    pub(crate) fn new(width: usize, height: usize) -> Self {
        let (width, height) = (width as u64, height as u64);
        let squares = (width.div_ceil(SIDE) * height.div_ceil(SIDE)).max(1);
        // Near the golden section, so that squares which follow each other are far apart.
        let mut stride = (squares as f64 * 0.618) as u64 | 1;
        while greatest_common_divisor(stride, squares) > 1 {
            stride += 2;
        }
        Self { width, height, squares, stride }
    }

    /// Places in all.
    pub(crate) const fn places(&self) -> u64 {
        self.squares * SIDE * SIDE
    }

    /// Squares of 8 × 8 pixels.
    pub(crate) const fn squares(&self) -> u64 {
        self.squares
    }

    /// The pixel of a place; they repeat after all of them.
    pub(crate) fn pixel(&self, place: u64) -> Option<usize> {
        let place = place % self.places();
        let square = place % self.squares * self.stride % self.squares;
        let first = u64::from(Stream::new(0, Purpose::ShadowRay, u64::MAX, square).next_bits());
        let turn = (place / self.squares) ^ first;
        // The lowest digits of the turn say in which half, quarter and eighth.
        let bit = |i: u32| (turn >> i) & 1;
        let x = (bit(0) ^ bit(1)) << 2 | (bit(2) ^ bit(3)) << 1 | (bit(4) ^ bit(5));
        let y = bit(0) << 2 | bit(2) << 1 | bit(4);
        let across = self.width.div_ceil(SIDE);
        let (x, y) = (square % across * SIDE + x, square / across * SIDE + y);
        (x < self.width && y < self.height).then_some((y * self.width + x) as usize)
    }
}

const fn greatest_common_divisor(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { greatest_common_divisor(b, a % b) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_pixel_has_one_place() {
        for (width, height) in [(1, 1), (8, 8), (13, 21), (160, 90), (7, 300)] {
            let order = Order::new(width, height);
            let mut lit = vec![0; width * height];
            (0..2 * order.places()).filter_map(|p| order.pixel(p)).for_each(|pixel| lit[pixel] += 1);
            assert!(lit.iter().all(|n| *n == 2), "{width} × {height}");
        }
    }

    #[test]
    fn any_quarter_of_the_places_has_one_pixel_of_each_four() {
        let order = Order::new(64, 64);
        let mut blocks = vec![0; 32 * 32];
        for pixel in (0..order.places() / 4).filter_map(|p| order.pixel(p)) {
            blocks[pixel / 64 / 2 * 32 + pixel % 64 / 2] += 1;
        }
        assert!(blocks.iter().all(|n| *n == 1));
    }
}
