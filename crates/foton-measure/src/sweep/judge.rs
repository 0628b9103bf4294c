//! One image against the reference, and the images of several seeds: bias² and variance apart.

use foton_film::Image;
use foton_integrator::Render;

use super::masks::mean;
use super::reference::{CLASSES, Reference, luminance};
use crate::{CompareError, Pair};

/// How far one image is off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Judged {
    /// Root mean square error of luminance over the mean reflected luminance, the reference's noise and bias taken off: of all
    /// that is seen, of its smooth part, of the rest.
    pub(crate) error: [f64; 3],
    /// In units of radiance, over all pixels and channels.
    pub(crate) rmse: f64,
    pub(crate) rel_mse: f64,
    pub(crate) flip: f64,
}

/// Mean squares relative to the squared mean of the reference.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Squares {
    /// What differs from seed to seed.
    pub(crate) variance: f64,
    /// What does not; below zero where there is none, by chance.
    pub(crate) bias2: f64,
}

/// What several seeds say.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Spread {
    /// Of all that is seen, of its smooth part, of the rest.
    pub(crate) masks: [Squares; 3],
    /// Of direct, caustic and indirect light over all that is seen.
    pub(crate) classes: Option<[Squares; 3]>,
}

/// Σ (x − y) and Σ (x − y)² by pixel over seeds.
struct Sums {
    errors: Vec<f64>,
    squares: Vec<f64>,
}

impl Sums {
    fn new(pixels: usize) -> Self {
        Self { errors: vec![0.0; pixels], squares: vec![0.0; pixels] }
    }

    fn add(&mut self, x: &[f64], y: &[f64]) {
        for ((e, q), (x, y)) in self.errors.iter_mut().zip(&mut self.squares).zip(x.iter().zip(y)) {
            *e += x - y;
            *q += (x - y) * (x - y);
        }
    }

    /// bias² = mean((x̄ − y)²) − Var/K, relative to `scale`²; `off` says that mean from each pixel's x̄ − y.
    fn squares(&self, seeds: f64, mask: &[bool], off: &dyn Fn(&[f64]) -> f64, scale: f64) -> Squares {
        let of = |(e, q): (&f64, &f64)| (q - e * e / seeds) / (seeds - 1.0);
        let variance = mean(mask, self.errors.iter().zip(&self.squares).map(of));
        let errors: Vec<f64> = self.errors.iter().map(|e| e / seeds).collect();
        let bias2 = off(&errors) - variance / seeds;
        Squares { variance: variance / (scale * scale), bias2: bias2 / (scale * scale) }
    }
}

/// Sums of one configuration at one pass over seeds.
pub(crate) struct Judge {
    seeds: f64,
    whole: Sums,
    classes: Option<[Sums; 3]>,
}

impl Judge {
    pub(crate) fn new(reference: &Reference, by_class: bool) -> Self {
        let pixels = reference.image.pixels.len();
        let by_class = by_class && reference.classes.is_some();
        Self {
            seeds: 0.0,
            whole: Sums::new(pixels),
            classes: by_class.then(|| CLASSES.map(|_| Sums::new(pixels))),
        }
    }

    /// Takes one seed's image.
    pub(crate) fn add(
        &mut self,
        render: &Render,
        image: &Image,
        reference: &Reference,
    ) -> Result<Judged, CompareError> {
        let x = luminance(image);
        self.whole.add(&x, &reference.fine.luminance);
        self.seeds += 1.0;
        if let (Some(sums), Some(truth)) = (&mut self.classes, &reference.classes) {
            for ((sum, truth), kind) in sums.iter_mut().zip(truth).zip(CLASSES) {
                if let Some(layer) = render.colour_layer(kind) {
                    sum.add(&luminance(&layer), truth);
                }
            }
        }
        let pair = Pair::new(image, &reference.image)?;
        let error = reference
            .masks
            .all()
            .map(|mask| reference.mean_square(mask, |pixel| x[pixel]).max(0.0).sqrt() / reference.mean);
        let (rmse, rel_mse) = (pair.rmse().all, pair.rel_mse().all);
        Ok(Judged { error, rmse, rel_mse, flip: pair.flip().mean })
    }

    /// What all seeds say.
    pub(crate) fn spread(&self, reference: &Reference) -> Spread {
        let y = &reference.fine.luminance;
        let masks = reference.masks.all().map(|mask| {
            let off = |errors: &[f64]| reference.mean_square(mask, |pixel| errors[pixel] + y[pixel]);
            self.whole.squares(self.seeds, mask, &off, reference.mean)
        });
        // A class's share of the reference's noise and bias is not known: it is left in.
        let seen = &reference.masks.seen;
        let off = |errors: &[f64]| mean(seen, errors.iter().map(|e| e * e));
        let classes = self.classes.as_ref().map(|all| {
            [&all[0], &all[1], &all[2]].map(|sums| sums.squares(self.seeds, seen, &off, reference.mean))
        });
        Spread { masks, classes }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bias_and_variance_come_apart() {
        // Seeds scatter by ±2 about a truth missed by 3: variance 4·K/(K−1), bias² 9, whatever K.
        let seeds = 6;
        let mut sums = Sums::new(2);
        for seed in 0..seeds {
            let off = if seed % 2 == 0 { 2.0 } else { -2.0 };
            sums.add(&[13.0 + off, 50.0], &[10.0, 50.0]);
        }
        let k = f64::from(seeds);
        let got = sums.squares(k, &[true, false], &|e| e[0] * e[0], 10.0);
        let variance = 4.0 * k / (k - 1.0);
        assert!((got.variance - variance / 100.0).abs() < 1e-12, "{got:?}");
        assert!((got.bias2 - (9.0 - variance / k) / 100.0).abs() < 1e-12, "{got:?}");
        let noisy_truth = sums.squares(k, &[true, false], &|e| e[0] * e[0] - 1.0, 10.0);
        assert!(
            (got.bias2 - noisy_truth.bias2 - 0.01).abs() < 1e-12,
            "the reference's own noise is taken off"
        );
    }
}
