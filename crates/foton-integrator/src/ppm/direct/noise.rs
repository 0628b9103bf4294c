//! How noisy direct light is.

/// A pixel's direct light, and what is known of its noise.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Known {
    /// Luminance.
    pub(crate) mean: f64,
    /// Its variance; none after one visit.
    pub(super) variance: Option<f64>,
    pub(super) visits: u32,
}

impl Known {
    /// How often its pixel has been lit; at least 1.
    pub(crate) fn visits(&self) -> f64 {
        f64::from(self.visits.max(1))
    }

    /// Luminance and its variance; `per_visit` is that of a visit where the pixel's own is not known.
    pub(crate) fn mean_and_variance(&self, per_visit: f64) -> (f64, f64) {
        (self.mean, self.variance.unwrap_or(per_visit))
    }
}

/// Variances of some pixels' direct light: those after one visit have what the others say of a visit.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Noise {
    /// Sum of the known ones.
    variance: f64,
    /// Of a visit to each.
    per_visit: f64,
    known: f64,
    /// Pixels after one visit.
    once: f64,
}

impl Noise {
    pub(crate) fn add(&mut self, pixel: &Known) {
        match pixel.variance {
            Some(variance) => {
                self.variance += variance;
                self.per_visit += variance * f64::from(pixel.visits);
                self.known += 1.0;
            }
            None => self.once += 1.0,
        }
    }

    pub(crate) fn plus(self, o: Self) -> Self {
        Self {
            variance: self.variance + o.variance,
            per_visit: self.per_visit + o.per_visit,
            known: self.known + o.known,
            once: self.once + o.once,
        }
    }

    /// How many pixels' noise is known.
    pub(crate) const fn known(&self) -> f64 {
        self.known
    }

    /// The sum of all variances; `elsewhere` says what a visit's is if none of these pixels does.
    pub(crate) fn sum(&self, elsewhere: f64) -> f64 {
        self.variance + self.once * self.per_visit(elsewhere)
    }

    /// The mean variance of a visit.
    pub(crate) fn per_visit(&self, elsewhere: f64) -> f64 {
        if self.known > 0.0 { self.per_visit / self.known } else { elsewhere }
    }
}
