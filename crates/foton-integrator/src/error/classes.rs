//! What direct, caustic and indirect light contribute to the error: passes take turns with the classes, so that a hit
//! point stores a single number for them.
//!
//! **Noise.** Photons are independent, so those of a class add the sum of their squared contributions to the variance, up to
//! what is common to all classes. A photon reaches all hit points of a pixel about alike, so their roots are added first.
//! **Bias.** B = Σ B_c makes B² = Σ B B_c: a class's part is what its bias has in common with all of it. The mean over earlier
//! passes times what this pass says of the class has no noise in its expectation.
//!
//! Both give shares of the figures for the whole image, whose squares then add up to the whole.

use foton_transport::photon_map::PathClass;

use super::moments::Weights;

const CLASSES: usize = PathClass::ALL.len();

/// Which moment a pass sums over the photons of one class.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Question {
    pub(crate) class: usize,
    /// Its noise, or else its bias.
    pub(crate) noise: bool,
}

impl Question {
    /// That of the pass after `passes` others: noise of the three classes, then bias. The first pass has no bias to compare with.
    pub(crate) const fn after(passes: u64) -> Self {
        let turn = (passes % (2 * CLASSES as u64)) as usize;
        Self { class: turn % CLASSES, noise: turn < CLASSES }
    }
}

/// A class's part of the error, relative to the mean reflected luminance of the whole image.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ClassError {
    /// Its part of the noise.
    pub noise: f64,
    /// Its part of the bias.
    pub bias: f64,
}

impl ClassError {
    /// √(noise² + bias²).
    #[must_use]
    pub fn total(&self) -> f64 {
        self.noise.hypot(self.bias)
    }
}

/// Answers so far, by class.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Classes {
    /// Variance per photon in the last pass that summed it, over all pixels.
    rates: [f64; CLASSES],
    /// Σ over passes of photons times that rate: the variance of the image, times all photons squared.
    noise: [f64; CLASSES],
    /// Σ over pixels and passes of the bias so far times the class's.
    bias: [f64; CLASSES],
    /// Photons of the passes that summed the bias.
    bias_photons: [f64; CLASSES],
}

impl Classes {
    /// Takes the answer of a pass of `photons`, summed over pixels.
    pub(super) fn add(&mut self, question: Question, answer: f64, photons: f64, before: f64) {
        let class = question.class;
        if question.noise {
            let rate = answer / photons;
            if self.rates[class] == 0.0 {
                self.noise[class] = before * rate;
            }
            self.rates[class] = rate;
        } else {
            self.bias[class] += answer;
            self.bias_photons[class] += photons;
        }
        for (sum, rate) in self.noise.iter_mut().zip(self.rates) {
            *sum += photons * rate;
        }
    }

    /// Splits squares of noise and bias; `None` until both are known of each class. `trust` is the share of what is seen of the
    /// bias that is not its own noise: for the rest of it the split is that of the noise. `shadow_rays` is the sum over pixels of
    /// that of direct light by shadow rays, if it is that.
    pub(super) fn split(
        &self,
        (noise2, bias2): (f64, f64),
        trust: f64,
        shadow_rays: Option<f64>,
        weights: &Weights,
    ) -> Option<[ClassError; CLASSES]> {
        if self.bias_photons.contains(&0.0) {
            return None;
        }
        let mut noise = self.noise;
        if let Some(variance) = shadow_rays {
            noise[PathClass::Direct as usize] = variance * weights.photons * weights.photons;
        }
        let rates = [0, 1, 2].map(|c| (self.bias[c] / self.bias_photons[c]).max(0.0));
        // By chance no class's bias may be seen to have anything in common with all of it: then it is split as the noise is.
        let noise = shares(noise);
        let trust = if rates == [0.0; CLASSES] { 0.0 } else { trust };
        let seen = shares(rates);
        let bias = [0, 1, 2].map(|c| trust * seen[c] + (1.0 - trust) * noise[c]);
        Some(
            [0, 1, 2]
                .map(|c| ClassError { noise: (noise2 * noise[c]).sqrt(), bias: (bias2 * bias[c]).sqrt() }),
        )
    }

    /// The variance that photons explain.
    pub(super) fn noise_of_photons(&self, weights: &Weights) -> f64 {
        self.noise.iter().sum::<f64>() / (weights.photons * weights.photons).max(f64::MIN_POSITIVE)
    }

    pub(super) fn numbers(&self) -> [f64; 4 * CLASSES] {
        let mut all = [self.rates, self.noise, self.bias, self.bias_photons].into_iter().flatten();
        [(); 4 * CLASSES].map(|()| all.next().unwrap_or(0.0))
    }

    pub(super) fn of(numbers: [f64; 4 * CLASSES]) -> Self {
        let part = |i: usize| [0, 1, 2].map(|c| numbers[i * CLASSES + c]);
        Self { rates: part(0), noise: part(1), bias: part(2), bias_photons: part(3) }
    }
}

/// Each over the sum of all; nothing where that is zero.
fn shares(values: [f64; CLASSES]) -> [f64; CLASSES] {
    let sum: f64 = values.iter().sum();
    values.map(|v| if sum > 0.0 { v / sum } else { 0.0 })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Noise of equal parts; all bias is seen in caustics, of which there may be more noise than bias.
    #[test]
    fn bias_that_may_be_noise_is_split_as_the_noise_is() {
        let classes =
            Classes { rates: [1.0; 3], noise: [1.0; 3], bias: [0.0, 5.0, 0.0], bias_photons: [1.0; 3] };
        let split = |trust: f64| {
            let parts = classes.split((3.0, 12.0), trust, None, &Weights::default()).expect("all are known");
            parts.map(|c| (c.bias * c.bias).round())
        };
        assert_eq!(split(1.0), [0.0, 12.0, 0.0]);
        assert_eq!(split(0.0), [4.0, 4.0, 4.0]);
        assert_eq!(split(0.5), [2.0, 8.0, 2.0]);
    }
}
