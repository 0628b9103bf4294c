//! Stratified points of the unit square for eye samples.

use foton_math::Stream;
use foton_math::glam::Vec2;
use rand::Rng;

/// The (0, 2)-sequence of Sobol' in two dimensions, scrambled by XOR for each pixel: the first 2^k points have one point in
/// each elementary interval, any other number is nearly as even. Source: Kollig and Keller (2002). `[KK02]`
pub struct PixelSamples {
    scramble: [u32; 2],
}

impl PixelSamples {
    /// Those of a pixel.
    pub fn new(stream: &mut Stream) -> Self {
        Self { scramble: [stream.next_u32(), stream.next_u32()] }
    }

    /// The same points in another order, in which each 2^k in a row are the same 2^k: beside the points of another sequence they pair
    /// up by chance. Source: Burley (2020), with the permutation of Laine and Karras (2011). `[BUR20]` `[LK11]`
    #[must_use]
    pub fn shuffled(stream: &mut Stream) -> Shuffled {
        Shuffled { samples: Self::new(stream), seed: stream.next_u32() }
    }

    /// The `index`-th point.
    #[must_use]
    pub fn point(&self, index: u32) -> Vec2 {
        let unit = |bits: u32| (bits >> 8) as f32 / (1 << 24) as f32;
        Vec2::new(unit(index.reverse_bits() ^ self.scramble[0]), unit(sobol(index) ^ self.scramble[1]))
    }
}

/// Points of [`PixelSamples`] in an order of their own.
pub struct Shuffled {
    samples: PixelSamples,
    seed: u32,
}

impl Shuffled {
    /// The `index`-th point.
    #[must_use]
    pub fn point(&self, index: u32) -> Vec2 {
        // Each binary digit is flipped or not by those above it.
        let mut x = index.reverse_bits().wrapping_add(self.seed);
        for factor in [0x6c50_b47c, 0xb82f_1e52, 0xc7af_e638, 0x8d22_f6e6] {
            x ^= x.wrapping_mul(factor);
        }
        self.samples.point(x.reverse_bits())
    }
}

/// Second dimension of Sobol's sequence: its direction numbers are rows of Pascal's triangle modulo 2.
fn sobol(mut index: u32) -> u32 {
    let mut direction = 1u32 << 31;
    let mut result = 0;
    while index != 0 {
        if index & 1 != 0 {
            result ^= direction;
        }
        index >>= 1;
        direction ^= direction >> 1;
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;
    use foton_math::Purpose;

    #[test]
    fn shuffled_samples_are_as_even_and_pair_up_otherwise_in_each_pixel() {
        // Quarters of the square by quarters of another, over pixels: all pairs are about as common.
        let mut pairs = [[0u32; 4]; 4];
        for pixel in 0..4000 {
            let mut stream = Stream::new(1, Purpose::Test, 0, pixel);
            let (places, lens) = (PixelSamples::new(&mut stream), PixelSamples::shuffled(&mut stream));
            let quarter = |p: Vec2| (2.0 * p.x) as usize * 2 + (2.0 * p.y) as usize;
            let mut seen = [false; 4];
            for i in 0..4 {
                seen[quarter(lens.point(i))] = true;
            }
            assert!(seen.iter().all(|&s| s), "four samples, four quarters");
            // The third goes with the first by a rule that differs from pixel to pixel.
            let flip = |a: Vec2, b: Vec2| quarter(a) ^ quarter(b);
            pairs[flip(places.point(0), places.point(1))][flip(lens.point(0), lens.point(1))] += 1;
        }
        let flips: Vec<u32> = (1..4).map(|k| pairs.iter().map(|row| row[k]).sum()).collect();
        assert!(flips.iter().all(|&n| n > 1100), "a third each: {flips:?}");
    }

    #[test]
    fn sixteen_samples_fall_into_sixteen_strata_of_every_shape() {
        for pixel in 0..50 {
            let samples = PixelSamples::new(&mut Stream::new(1, Purpose::Test, 0, pixel));
            for (nx, ny) in [(1, 16), (2, 8), (4, 4), (8, 2), (16, 1)] {
                let mut seen = [false; 16];
                for i in 0..16 {
                    let p = samples.point(i);
                    seen[(p.x * nx as f32) as usize * ny + (p.y * ny as f32) as usize] = true;
                }
                assert!(seen.iter().all(|&s| s), "{nx}×{ny}");
            }
        }
    }
}
