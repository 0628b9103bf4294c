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

    /// The same points in another order, in which each 4^k in a row are the same 4^k: beside the points of another sequence they pair
    /// up by chance.
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

/// Points of [`PixelSamples`] in an order of their own: each digit of an index in base 4 is permuted, by a permutation that the
/// digits above it choose. Nested like that, Owen (1998) permutes the digits of coordinates. `[OWE98]`
pub struct Shuffled {
    samples: PixelSamples,
    seed: u32,
}

impl Shuffled {
    /// The `index`-th point.
    #[must_use]
    pub fn point(&self, index: u32) -> Vec2 {
        let mut shuffled = index & (u32::MAX << (2 * DIGITS));
        for digit in 0..DIGITS {
            let (value, above) = ((index >> (2 * digit)) & 3, index >> (2 * digit) >> 2);
            shuffled |= permuted(value, self.chance(digit, above)) << (2 * digit);
        }
        self.samples.point(shuffled)
    }

    /// A number that looks like chance, of a digit and those above it. Source: the last steps of MurmurHash3.
    const fn chance(&self, digit: u32, above: u32) -> u32 {
        let mut x = self.seed ^ above.wrapping_mul(0x9e37_79b9) ^ digit.wrapping_mul(0x7feb_352d);
        x = (x ^ (x >> 16)).wrapping_mul(0x85eb_ca6b);
        x = (x ^ (x >> 13)).wrapping_mul(0xc2b2_ae35);
        x ^ (x >> 16)
    }
}

/// Digits that are permuted: the order of 4⁸ points repeats.
const DIGITS: u32 = 8;

/// What the `chance`-th of the 24 permutations of four values makes of one.
fn permuted(value: u32, chance: u32) -> u32 {
    let mut left = [0, 1, 2, 3];
    let mut rest = chance % 24;
    for (i, choices) in (0..3).zip([4u32, 3, 2]) {
        left.swap(i, i + (rest % choices) as usize);
        rest /= choices;
    }
    left[value as usize]
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
    fn shuffled_samples_are_as_even_and_pair_up_with_others_by_chance() {
        let quarter = |p: Vec2| (2.0 * p.x) as usize * 2 + (2.0 * p.y) as usize;
        let mut between = [0u32; 4];
        for pixel in 0..4000 {
            let mut stream = Stream::new(1, Purpose::Test, 0, pixel);
            let (places, lens) = (PixelSamples::new(&mut stream), PixelSamples::shuffled(&mut stream));
            for begin in [0, 4, 64] {
                let mut seen = [false; 4];
                (begin..begin + 4).for_each(|i| seen[quarter(lens.point(i))] = true);
                assert!(seen.iter().all(|&s| s), "four samples, four quarters");
            }
            // The first two places lie in opposite quarters, their points of the lens in any two.
            assert_eq!(quarter(places.point(0)) ^ quarter(places.point(1)), 3);
            between[quarter(lens.point(0)) ^ quarter(lens.point(1))] += 1;
        }
        assert!(between[1..].iter().all(|&n| n > 1200), "a third each: {between:?}");
    }

    #[test]
    fn each_permutation_of_four_is_one_of_twenty_four() {
        let all: std::collections::HashSet<_> =
            (0..24).map(|n| [0, 1, 2, 3].map(|v| permuted(v, n))).collect();
        assert_eq!(all.len(), 24);
        assert!(
            all.iter().all(|p| p.iter().sum::<u32>() == 6 && p.iter().fold(0, |bits, v| bits | 1 << v) == 15)
        );
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
