//! The variance of a mean over passes, from the passes alone.
//!
//! Passes are independent, hit points are not: neighbours share photons. So a pass's estimate of a quantity (of a
//! pixel, of a tile) is summed first and squared then; variances of neighbours are never added.

/// The photons nⱼ of all passes so far, by which the mean L = Σ wⱼ xⱼ, wⱼ = nⱼ/N weighs their estimates xⱼ.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Weights {
    /// N = Σ nⱼ.
    pub(crate) photons: f64,
    /// Σ nⱼ².
    squares: f64,
}

impl Weights {
    pub(super) const fn numbers(&self) -> [f64; 2] {
        [self.photons, self.squares]
    }

    pub(super) const fn of([photons, squares]: [f64; 2]) -> Self {
        Self { photons, squares }
    }

    pub(crate) fn add(&mut self, photons: f64) {
        self.photons += photons;
        self.squares += photons * photons;
    }

    /// Σ wⱼ²: one over the number of equal passes that would be worth as much.
    pub(crate) fn concentration(&self) -> f64 {
        self.squares / (self.photons * self.photons).max(f64::MIN_POSITIVE)
    }

    /// What means and variances need of these weights, computed once for all pixels: most of the time went into divisions.
    pub(crate) fn shares(&self) -> Shares {
        let rest = 1.0 - self.concentration();
        let scale = if rest > 0.0 { 1.0 / (self.photons * self.photons * rest) } else { 0.0 };
        Shares { per_photon: 1.0 / self.photons.max(1.0), squares: self.squares, scale }
    }
}

/// Of [`Weights`]: 1/N, Σ nⱼ², and 1/(N² (1 − Σ wⱼ²)), which is zero when there is one pass.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shares {
    pub(crate) per_photon: f64,
    squares: f64,
    scale: f64,
}

impl Shares {
    /// Var L from Σ aⱼ² and Σ nⱼ aⱼ, where aⱼ = nⱼ xⱼ and L is the mean: Σ wⱼ² (xⱼ − L)² / (1 − Σ wⱼ²).
    ///
    /// Unbiased if Var xⱼ ∝ 1/nⱼ, which holds while radii stand still, and for equal passes whatever their variances are.
    /// Zero when there is one pass.
    pub(crate) fn variance(&self, mean: f64, squares: f64, cross: f64) -> f64 {
        let sum = squares - 2.0 * mean * cross + mean * mean * self.squares;
        (sum * self.scale).max(0.0)
    }
}

/// The photons of the passes of each of two sequences, in which the eye samples and shadow rays of a pass are points (see
/// `camera_paths/pixel_samples.rs`). Each sequence is stratified, so its passes scatter by more than their mean is noisy; but the two are
/// independent, and so the difference of their means tells the noise of both.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Halves {
    photons: [f64; 2],
    /// The sequence of the last pass.
    last: u64,
}

impl Halves {
    pub(super) const fn numbers(&self) -> [f64; 2] {
        self.photons
    }

    pub(super) const fn of(photons: [f64; 2]) -> Self {
        Self { photons, last: 0 }
    }

    /// Takes a pass of `photons` that follows so many others.
    pub(crate) fn add(&mut self, passes: u64, photons: f64) {
        self.last = passes % 2;
        self.photons[self.last as usize] += photons;
    }

    /// What the last pass counts by in the difference.
    pub(crate) const fn sign(&self) -> f64 {
        if self.last == 0 { 1.0 } else { -1.0 }
    }

    /// Var L from L and Σ ± aⱼ, as well as one difference tells. Unbiased if Var xⱼ ∝ 1/nⱼ, and for sequences of equally many photons.
    pub(crate) fn variance(&self, mean: f64, difference: f64) -> f64 {
        let [first, second] = self.photons;
        if first == 0.0 || second == 0.0 {
            return 0.0;
        }
        // With σ²/n the variance of a mean over n photons, that of the difference of two is σ² (1/a + 1/b).
        let sum = mean * (first + second);
        let off = 0.5 * ((sum + difference) / first - (sum - difference) / second);
        off * off * first * second / ((first + second) * (first + second))
    }
}

/// What a mean over passes and its variance need.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Moments {
    /// Σ aⱼ.
    sum: f64,
    /// Σ aⱼ².
    squares: f64,
    /// Σ nⱼ aⱼ.
    cross: f64,
}

impl Moments {
    pub(super) const fn numbers(&self) -> [f64; 3] {
        [self.sum, self.squares, self.cross]
    }

    pub(super) const fn of([sum, squares, cross]: [f64; 3]) -> Self {
        Self { sum, squares, cross }
    }

    /// Takes a pass of `photons` whose estimate, times its photons, is `addend`.
    pub(crate) fn add(&mut self, addend: f64, photons: f64) {
        self.sum += addend;
        self.squares += addend * addend;
        self.cross += photons * addend;
    }

    /// The mean and its variance.
    pub(crate) fn mean_and_variance(&self, weights: &Weights) -> (f64, f64) {
        self.mean_and_variance_by(&weights.shares())
    }

    /// The same for many, whose passes are the same.
    pub(super) fn mean_and_variance_by(&self, shares: &Shares) -> (f64, f64) {
        let mean = self.sum * shares.per_photon;
        (mean, shares.variance(mean, self.squares, self.cross))
    }
}

/// How much the squared error of single passes scatters: it says on how many independent parts of the image a figure rests.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Scatter {
    last: Option<f64>,
    count: f64,
    sum: f64,
    differences: f64,
}

impl Scatter {
    /// There is a last value once any were counted.
    pub(super) fn numbers(&self) -> [f64; 4] {
        [self.last.unwrap_or(0.0), self.count, self.sum, self.differences]
    }

    pub(super) fn of([last, count, sum, differences]: [f64; 4]) -> Self {
        Self { last: (count > 0.0).then_some(last), count, sum, differences }
    }

    /// Takes nⱼ times the mean squared deviation of a pass from the image, which about stays the same from pass to pass.
    pub(crate) fn add(&mut self, deviation: f64) {
        if let Some(last) = self.last {
            self.differences += 0.5 * (deviation - last) * (deviation - last);
        }
        self.last = Some(deviation);
        self.count += 1.0;
        self.sum += deviation;
    }

    /// Whether after three passes none has scattered at all.
    pub(crate) fn is_at_rest(&self) -> bool {
        self.count >= 3.0 && self.sum == 0.0
    }

    /// ρ²: variance over squared mean, from differences of neighbours in time, so that the slow rise as radii shrink does not
    /// count. A mean of K independent squares of normal variables has ρ² = 2/K. `None` before the third pass.
    pub(crate) fn relative_variance(&self) -> Option<f64> {
        let mean = self.sum / self.count;
        (self.count >= 3.0 && mean > 0.0).then(|| self.differences / (self.count - 1.0) / (mean * mean))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use foton_math::{Purpose, Stream};

    /// Passes double and stay, as those of a render; each estimate is the mean of its photons' values.
    #[test]
    fn the_variance_of_passes_of_unequal_size_is_that_of_many_runs() {
        let photons = [4.0, 8.0, 16.0, 32.0, 32.0, 32.0, 32.0, 32.0];
        let (mut estimated, mut means, runs) = (0.0, Moments::default(), 4000);
        let mut runs_weights = Weights::default();
        for run in 0..runs {
            let mut stream = Stream::new(5, Purpose::Test, 0, run);
            let (mut weights, mut moments) = (Weights::default(), Moments::default());
            for n in photons {
                let sum: f64 = (0..n as u32).map(|_| f64::from(stream.next_1d()).powi(3)).sum();
                moments.add(sum, n);
                weights.add(n);
            }
            let (mean, variance) = moments.mean_and_variance(&weights);
            estimated += variance / f64::from(runs as u32);
            means.add(mean, 1.0);
            runs_weights.add(1.0);
        }
        let (_, of_the_mean) = means.mean_and_variance(&runs_weights);
        let truth = of_the_mean * f64::from(runs as u32);
        // The estimated variance of 4,000 runs is good to 3 %.
        assert!((estimated / truth - 1.0).abs() < 0.1, "{estimated} {truth}");
    }

    #[test]
    fn one_pass_says_nothing_and_equal_passes_have_the_textbook_variance() {
        let (mut weights, mut moments) = (Weights::default(), Moments::default());
        moments.add(30.0, 10.0);
        weights.add(10.0);
        assert_eq!(moments.mean_and_variance(&weights), (3.0, 0.0));
        for x in [5.0, 1.0] {
            moments.add(10.0 * x, 10.0);
            weights.add(10.0);
        }
        let (mean, variance) = moments.mean_and_variance(&weights);
        // Values 3, 5, 1: sample variance 4, of the mean 4/3.
        assert!((mean - 3.0).abs() < 1e-12 && (variance - 4.0 / 3.0).abs() < 1e-12, "{mean} {variance}");
    }

    #[test]
    fn scatter_ignores_a_slow_rise() {
        let mut scatter = Scatter::default();
        for i in 0..1000 {
            scatter.add(1.0 + 0.001 * f64::from(i) + if i % 2 == 0 { 0.1 } else { -0.1 });
        }
        // Differences of 0.2: ½ · 0.04, over a mean of 1.5.
        let rho2 = scatter.relative_variance().expect("enough passes");
        assert!((rho2 / (0.02 / 2.25) - 1.0).abs() < 0.05, "{rho2}");
    }
}
