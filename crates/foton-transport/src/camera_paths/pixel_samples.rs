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

    /// The `index`-th point.
    #[must_use]
    pub fn point(&self, index: u32) -> Vec2 {
        let unit = |bits: u32| (bits >> 8) as f32 / (1 << 24) as f32;
        Vec2::new(unit(index.reverse_bits() ^ self.scramble[0]), unit(sobol(index) ^ self.scramble[1]))
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
