//! Stratified points of the unit square for eye samples.

use foton_math::glam::Vec2;
use foton_math::sobol::reordered;
use foton_math::{Purpose, Stream};
use rand::Rng;

/// The (0, 2)-sequence of Sobol' in two dimensions, scrambled by XOR for each pixel: the first 2^k points have one point in
/// each elementary interval, any other number is nearly as even. Source: Kollig and Keller (2002). `[KK02]`
pub struct PixelSamples {
    scramble: [u32; 2],
    /// The order in which points are drawn; `None` for that of the sequence.
    order: Option<u32>,
}

/// The points of the samples of a pixel.
pub(super) struct OfPixel {
    places: PixelSamples,
    facets: PixelSamples,
    emitters: PixelSamples,
    lens: PixelSamples,
    /// The place in the sequences of the first sample.
    first: u32,
    /// What streams of single samples are keyed by.
    pass: u64,
}

impl OfPixel {
    /// Those of the samples that a method follows once and for all or, of one that follows `samples` new ones in each pass, those of the
    /// pass after so many others. Passes take turns with two sequences that are independent of each other: by their difference the
    /// noise of both is known. The points of a sequence for one thing are drawn in another order than those for the next, so that
    /// all pairs are, in the end.
    pub(super) fn new((seed, purpose): (u64, Purpose), pixel: u32, pass: Option<u64>, samples: u32) -> Self {
        let (sequence, turn) = pass.map_or((0, 0), |pass| (pass % 2, pass / 2));
        let key = if sequence == 0 { 0 } else { u64::MAX };
        let mut stream = Stream::new(seed, purpose, key, u64::from(pixel));
        let [places, facets, emitters] = [(); 3].map(|()| PixelSamples::new(&mut stream));
        let lens = PixelSamples::shuffled(&mut stream);
        let mut in_order = |samples| PixelSamples { order: pass.map(|_| stream.next_u32()), ..samples };
        Self {
            places,
            facets: in_order(facets),
            emitters: in_order(emitters),
            lens,
            first: (turn as u32).wrapping_mul(samples),
            pass: pass.unwrap_or(0),
        }
    }

    /// The points of one of them.
    pub(super) fn points(&self, sample: u32) -> SamplePoints {
        let index = self.first.wrapping_add(sample);
        SamplePoints {
            place: self.places.point(index),
            lens: self.lens.point(index),
            facet: self.facets.point(index),
            emitter: self.emitters.point(index),
        }
    }

    /// What its stream is keyed by beside the sample.
    pub(super) const fn stream_pass(&self) -> u64 {
        self.pass + 1
    }
}

impl PixelSamples {
    /// Those of a pixel.
    pub fn new(stream: &mut Stream) -> Self {
        Self { scramble: [stream.next_u32(), stream.next_u32()], order: None }
    }

    /// The same points in another order, in which each 4^k in a row are the same 4^k: beside the points of another sequence they pair
    /// up by chance.
    #[must_use]
    pub fn shuffled(stream: &mut Stream) -> Self {
        let samples = Self::new(stream);
        Self { order: Some(stream.next_u32()), ..samples }
    }

    /// The `index`-th point.
    #[must_use]
    pub fn point(&self, index: u32) -> Vec2 {
        let index = self.order.map_or(index, |order| reordered(index, order));
        let unit = |bits: u32| (bits >> 8) as f32 / (1 << 24) as f32;
        Vec2::new(unit(index.reverse_bits() ^ self.scramble[0]), unit(sobol(index) ^ self.scramble[1]))
    }
}

/// Points of the unit square, stratified over the samples of a pixel.
pub(super) struct SamplePoints {
    /// Where in the pixel.
    pub(super) place: Vec2,
    /// Where on the lens; anywhere where there is none.
    pub(super) lens: Vec2,
    /// For the first rough specular lobe.
    pub(super) facet: Vec2,
    /// For the point on an area emitter that is sampled from there.
    pub(super) emitter: Vec2,
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

    #[test]
    fn the_samples_of_passes_are_stratified_in_two_sequences_and_all_pairs_of_points_come() {
        let of_pass = |pass| OfPixel::new((1, Purpose::Test), 7, Some(pass), 1).points(0);
        let cell = |p: Vec2, n: f32| (p.x * n) as usize * n as usize + (p.y * n) as usize;
        for sequence in [0, 1] {
            let mut seen = [false; 16];
            (0..16).for_each(|turn| seen[cell(of_pass(2 * turn + sequence).place, 4.0)] = true);
            assert!(seen.iter().all(|seen| *seen), "sequence {sequence}");
        }
        // Quarters of the places by quarters of the facets: a facet that followed from the place would leave most of them out.
        let mut pairs = [0; 16];
        for pass in 0..512 {
            let points = of_pass(pass);
            pairs[cell(points.place, 2.0) * 4 + cell(points.facet, 2.0)] += 1;
        }
        assert!(pairs.iter().all(|n| (16..=56).contains(n)), "{pairs:?}");
    }

    #[test]
    fn samples_that_are_followed_once_are_those_of_the_first_sequence() {
        let [once, first] = [None, Some(0)].map(|pass| OfPixel::new((1, Purpose::Test), 7, pass, 4));
        assert_eq!(once.points(3).place, first.points(3).place);
        assert_eq!(once.stream_pass(), first.stream_pass());
    }
}
