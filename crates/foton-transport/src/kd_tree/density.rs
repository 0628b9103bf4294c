//! How densely photons lie, from the nearest ones: filters over the disc, and which photons count in it. `[JEN01]`
//!
//! Of k nearest photons the k-th decides how large the disc is, and does not count in it: k − 1 photons in the disc of the k-th is
//! the unbiased estimate, k would be too much by a factor of k/(k − 1). Where fewer than k are near enough, all of them count in the
//! largest disc. Both together are unbiased, too: the expectation over evenly spread photons is their density, whatever the radii.

use foton_math::Rgb;

use super::nearest::{Found, Nearest};

/// Of the cone filter: its rim is this many times as far out as the disc. 1 is the narrowest. `[JEN01]`
const CONE: f32 = 1.1;

/// Of the Gaussian filter. `[JEN01]`
const BETA: f32 = 1.953;

/// How much photons count by their distance. Each filter's mean over the disc is 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum KernelFilter {
    /// All alike.
    Box,
    /// Falling off evenly towards the rim.
    #[default]
    Cone,
    /// Falling off like a bell.
    Gaussian,
}

impl KernelFilter {
    /// All filters.
    pub const ALL: [Self; 3] = [Self::Box, Self::Cone, Self::Gaussian];

    /// The name in files and on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Box => "box",
            Self::Cone => "cone",
            Self::Gaussian => "gaussian",
        }
    }

    /// The weight of a photon at a squared distance, in squared radii of the disc.
    #[must_use]
    #[inline]
    pub fn weight(self, distance2: f32) -> f32 {
        match self {
            Self::Box => 1.0,
            // w = 1 − d/(k r), over its mean 1 − 2/(3 k).
            Self::Cone => (1.0 - distance2.sqrt() / CONE) / (1.0 - 2.0 / (3.0 * CONE)),
            Self::Gaussian => gaussian(distance2) / GAUSSIAN_MEAN,
        }
    }
}

/// Jensen's bell but for its factor: 1 − (1 − e^(−β s/2)) / (1 − e^(−β)), s in squared radii. He gives a factor of 0.918 and no other
/// norm, which makes a mean of 0.53 over the disc; here its mean is taken instead.
fn gaussian(s: f32) -> f32 {
    1.0 - (1.0 - (-0.5 * BETA * s).exp()) / (1.0 - E_BETA)
}

/// e^(−β).
const E_BETA: f32 = 0.141_847_9;

/// The mean of [`gaussian`] over the disc: 1 − (1 − (1 − e^(−β/2)) 2/β) / (1 − e^(−β)).
const GAUSSIAN_MEAN: f32 = 1.0 - (1.0 - (1.0 - 0.376_627) * 2.0 / BETA) / (1.0 - E_BETA);

/// What the nearest photons of a point say.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Estimate {
    /// Power per area (W/m²), each photon weighed by the filter and by what was asked for.
    pub per_area: Rgb,
    /// The squared radius of the disc.
    pub radius2: f32,
    /// Photons that count in it.
    pub photons: u32,
}

impl Estimate {
    /// The estimate of a search within `distance2`. `light` gives what a photon brings.
    #[inline]
    pub fn of(
        nearest: &Nearest,
        distance2: f32,
        filter: KernelFilter,
        light: impl Fn(&Found) -> Rgb,
    ) -> Self {
        let farthest = nearest.farthest();
        let radius2 = farthest.map_or(distance2, |f| f.distance2);
        if radius2 <= 0.0 {
            return Self::default();
        }
        let (mut sum, mut photons) = (Rgb::BLACK, 0);
        for found in nearest.found() {
            if Some(found.index) != farthest.map(|f| f.index) {
                sum += light(found) * filter.weight(found.distance2 / radius2);
                photons += 1;
            }
        }
        Self { per_area: sum / (std::f32::consts::PI * radius2), radius2, photons }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_of_each_filter_over_the_disc_is_1_and_none_is_negative() {
        const STEPS: u32 = 20_000;
        for filter in KernelFilter::ALL {
            // Evenly spread over the disc, squared distances are evenly spread, too.
            let mean: f64 = (0..STEPS)
                .map(|i| f64::from(filter.weight((i as f32 + 0.5) / STEPS as f32)) / f64::from(STEPS))
                .sum();
            assert!((mean - 1.0).abs() < 1e-4, "{filter:?}: {mean}");
            assert!((0..=100).all(|i| filter.weight(i as f32 / 100.0) >= 0.0));
        }
    }
}
