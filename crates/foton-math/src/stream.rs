//! Keyed random streams: the n-th number of a stream is a hash of (seed, purpose, pass, index, n).
//!
//! A stream has no history, so results do not depend on which thread asks, or when. Neighbouring keys are hashed apart
//! before use: neighbouring stream numbers of a PCG32, say, correlate visibly.

use std::convert::Infallible;

use glam::Vec2;
use rand::{RngExt, TryRng};

/// What a stream's numbers are for. Each purpose has numbers of its own: switching a feature on shifts no other's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u64)]
pub enum Purpose {
    /// Positions of eye samples on the film and choices along eye paths.
    Eye = 1,
    /// Emission and choices along photon paths.
    Photon = 2,
    /// Points on emitters for shadow rays.
    ShadowRay = 3,
    /// The pilot that estimates memory.
    Pilot = 4,
    /// Numbers for tests.
    Test = 5,
    /// Choices along paths from the camera that meet emitters by themselves.
    Path = 6,
    /// When passes see a scene that moves.
    Shutter = 7,
    /// Maps of photons that stay: rounding, and looking around them.
    PhotonMap = 20,
}

/// The increment of SplitMix64: 2^64 divided by the golden ratio, odd.
const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

/// The finaliser of SplitMix64 (Stafford's variant 13 of MurmurHash3's): every bit of `z` reaches every bit out. `[SLF14]`
#[inline]
const fn mix(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// A stream of random numbers, keyed by what it is for. It is a [`rand::Rng`], so rand's distributions work on it.
#[derive(Clone, Debug)]
pub struct Stream {
    state: u64,
}

impl Stream {
    /// The stream of one photon, eye sample or hit point (`index`) in one `pass`.
    #[must_use]
    #[inline]
    pub const fn new(seed: u64, purpose: Purpose, pass: u64, index: u64) -> Self {
        let key = mix(seed.wrapping_add(GOLDEN)) ^ purpose as u64;
        let key = mix(key.wrapping_add(GOLDEN)) ^ pass;
        let key = mix(key.wrapping_add(GOLDEN)) ^ index;
        Self { state: mix(key.wrapping_add(GOLDEN)) }
    }

    /// The stream from its `dimension`-th number on, whatever was drawn before.
    #[must_use]
    #[inline]
    pub const fn from_dimension(&self, dimension: u64) -> Self {
        Self { state: self.state.wrapping_add(dimension.wrapping_mul(GOLDEN)) }
    }

    /// Uniform in [0, 1).
    #[inline]
    pub fn next_1d(&mut self) -> f32 {
        self.random()
    }

    /// 32 random digits.
    #[inline]
    pub fn next_bits(&mut self) -> u32 {
        self.random()
    }

    /// Uniform in [0, 1)².
    #[inline]
    pub fn next_2d(&mut self) -> Vec2 {
        Vec2::new(self.next_1d(), self.next_1d())
    }
}

impl TryRng for Stream {
    type Error = Infallible;

    #[inline]
    fn try_next_u32(&mut self) -> Result<u32, Infallible> {
        Ok((self.try_next_u64()? >> 32) as u32)
    }

    #[inline]
    fn try_next_u64(&mut self) -> Result<u64, Infallible> {
        self.state = self.state.wrapping_add(GOLDEN);
        Ok(mix(self.state))
    }

    #[inline]
    fn try_fill_bytes(&mut self, out: &mut [u8]) -> Result<(), Infallible> {
        for chunk in out.chunks_mut(8) {
            chunk.copy_from_slice(&self.try_next_u64()?.to_le_bytes()[..chunk.len()]);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cases;

    /// Correlation of two equally long series.
    fn correlation(a: &[f32], b: &[f32]) -> f64 {
        let n = a.len() as f64;
        let mean = |s: &[f32]| s.iter().map(|&x| f64::from(x)).sum::<f64>() / n;
        let (ma, mb) = (mean(a), mean(b));
        let cov: f64 = a.iter().zip(b).map(|(&x, &y)| (f64::from(x) - ma) * (f64::from(y) - mb)).sum();
        cov / n * 12.0
    }

    #[test]
    fn neighbouring_keys_are_uncorrelated_in_every_coordinate() {
        let n = u64::from(cases(200_000));
        let first = |seed, pass, index| Stream::new(seed, Purpose::Test, pass, index).next_1d();
        let base: Vec<f32> = (0..n).map(|i| first(7, 0, i)).collect();
        let bound = 4.5 / (n as f64).sqrt();
        for lag in [1, 2, 16, 256] {
            let by_index: Vec<f32> = (0..n).map(|i| first(7, 0, i + lag)).collect();
            let by_pass: Vec<f32> = (0..n).map(|i| first(7, lag, i)).collect();
            let by_seed: Vec<f32> = (0..n).map(|i| first(7 + lag, 0, i)).collect();
            for (name, other) in [("index", by_index), ("pass", by_pass), ("seed", by_seed)] {
                let c = correlation(&base, &other);
                assert!(c.abs() < bound, "{name} lag {lag}: correlation {c}, bound {bound}");
            }
        }
    }

    #[test]
    fn numbers_of_one_stream_are_uniform() {
        let mut stream = Stream::new(0, Purpose::Test, 0, 0);
        let mut bins = [0u32; 64];
        let n = cases(640_000);
        for _ in 0..n {
            bins[(stream.next_1d() * 64.0) as usize] += 1;
        }
        let expected = f64::from(n) / 64.0;
        let chi2: f64 = bins.iter().map(|&b| (f64::from(b) - expected).powi(2) / expected).sum();
        assert!(chi2 < 110.0, "χ² of 63 degrees of freedom: {chi2}");
    }

    #[test]
    fn a_dimension_can_be_reached_without_drawing_those_before_it() {
        let stream = Stream::new(3, Purpose::Test, 1, 4);
        let mut walked = stream.clone();
        for _ in 0..5 {
            walked.next_1d();
        }
        assert_eq!(walked.next_1d(), stream.from_dimension(5).next_1d());
    }
}
