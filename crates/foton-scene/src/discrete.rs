//! Choosing among finitely many things with given probabilities.

/// A discrete distribution, sampled by inverting its cumulative sums.
#[derive(Clone, Debug, Default)]
pub(crate) struct Discrete {
    /// `cumulative[i]` is the sum of the first i + 1 probabilities; the last is exactly 1.
    cumulative: Vec<f64>,
}

impl Discrete {
    /// Probabilities in proportion to `weights`; negative and non-finite ones count as zero. Empty when none is above zero.
    #[must_use]
    pub(crate) fn new(weights: impl IntoIterator<Item = f64>) -> Self {
        let mut sum = 0.0;
        let mut cumulative: Vec<f64> = weights
            .into_iter()
            .map(|w| {
                sum += if w.is_finite() { w.max(0.0) } else { 0.0 };
                sum
            })
            .collect();
        if sum <= 0.0 {
            cumulative.clear();
        }
        for c in &mut cumulative {
            // Everything from the last positive weight on becomes exactly 1.
            *c = if *c >= sum { 1.0 } else { *c / sum };
        }
        Self { cumulative }
    }

    /// Whether nothing can be chosen.
    #[must_use]
    pub(crate) const fn is_empty(&self) -> bool {
        self.cumulative.is_empty()
    }

    /// The chance of `index`.
    #[must_use]
    pub(crate) fn probability(&self, index: usize) -> f64 {
        let before = index.checked_sub(1).map_or(0.0, |i| self.cumulative[i]);
        self.cumulative[index] - before
    }

    /// The index chosen by `u` in [0, 1), never one of probability zero.
    ///
    /// # Panics
    /// When the distribution is empty.
    #[must_use]
    pub(crate) fn choose(&self, u: f64) -> usize {
        self.cumulative.partition_point(|&c| c <= u).min(self.cumulative.len() - 1)
    }

    /// As [`Discrete::choose`], with what is left of `u`, uniform in [0, 1) again.
    #[must_use]
    pub(crate) fn choose_and_rest(&self, u: f64) -> (usize, f64) {
        let i = self.choose(u);
        let before = i.checked_sub(1).map_or(0.0, |i| self.cumulative[i]);
        let rest = (u - before) / self.probability(i);
        (i, rest.clamp(0.0, 1.0 - f64::EPSILON))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_index_gets_its_share_of_the_unit_interval_and_zero_weights_none() {
        let d = Discrete::new([0.0, 1.0, 0.0, 3.0, f64::NAN]);
        let n = 4000;
        let mut count = [0; 5];
        for i in 0..n {
            count[d.choose((f64::from(i) + 0.5) / f64::from(n))] += 1;
        }
        assert_eq!(count, [0, 1000, 0, 3000, 0]);
        assert!((d.probability(3) - 0.75).abs() < 1e-12);
        assert_eq!((d.choose(0.0), d.choose(1.0 - 1e-16)), (1, 3));
        assert!(Discrete::new([0.0, -1.0]).is_empty());
    }
}
