//! What the radii of a pixel's hit points go by where they adapt: the moments of `ppm/adaptive.rs`, of all passes.
//!
//! There what tells bias, a Laplacian and an offset, is noisy by its photons alone. Here it is so by where in the pixel each pass looks,
//! too: near a filament of light it has one sign, beside it the other, and bias is what stays of it in the mean over the pixel. So its
//! noise is known from passes: the squares of single ones, which are independent, add up to it, and to a little of its own.

use foton_transport::codec::{Reader, StateError, Writer};

use crate::ppm::adaptive::RadiusStatistics;
use crate::ppm::settings::Alpha;

/// Moments of a pixel's light over all passes.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct PixelRadius {
    sums: RadiusStatistics,
    /// Σ over passes of the squares of what tells bias.
    noise: [f64; 2],
}

impl PixelRadius {
    /// Takes a pass.
    pub(super) fn add(&mut self, pass: &RadiusStatistics) {
        let squares = pass.squares();
        // Sums that are no finite numbers are left out.
        if squares.iter().all(|square| square.is_finite()) {
            self.sums.add_pass(pass);
            self.noise.iter_mut().zip(squares).for_each(|(sum, square)| *sum += square);
        }
    }

    /// The share of new photons to retain, which is `alpha` where bias and noise are in balance.
    pub(super) fn alpha(&self, alpha: Alpha) -> Alpha {
        self.sums.alpha_beside(alpha, self.noise)
    }

    /// All passes' sums.
    pub(crate) const fn sums(&self) -> &RadiusStatistics {
        &self.sums
    }

    pub(super) fn write(&self, out: &mut Writer) {
        self.sums.write(out);
        self.noise.iter().for_each(|&sum| out.f64(sum));
    }

    pub(super) fn read(input: &mut Reader<'_>) -> Result<Self, StateError> {
        Ok(Self { sums: RadiusStatistics::read(input)?, noise: [input.finite()?, input.finite()?] })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of_pass(laplacian: f64) -> RadiusStatistics {
        RadiusStatistics::of_laplacian(1.0, 0.01, laplacian)
    }

    #[test]
    fn a_bias_that_turns_with_the_place_in_the_pixel_shrinks_nothing_and_one_that_stays_does() {
        let alpha = Alpha::default();
        let (mut turns, mut stays) = (PixelRadius::default(), PixelRadius::default());
        for pass in 0..32 {
            turns.add(&of_pass(if pass % 2 == 0 { 0.5 } else { -0.4 }));
            stays.add(&of_pass(0.5));
        }
        assert!(turns.alpha(alpha).get() > 0.99, "{:?}", turns.alpha(alpha));
        assert!(stays.alpha(alpha).get() < alpha.get(), "{:?}", stays.alpha(alpha));
        // By its photons alone the first seems to have bias, too.
        assert!(turns.sums().alpha(alpha).get() < alpha.get());
    }
}
