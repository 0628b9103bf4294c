//! Errors of an image, and how they fall over processor seconds.

use std::fmt;

use foton_film::Image;

/// What is measured: of luminance, over the reference's mean; the last relative in each pixel.
pub(super) const MEASURES: [&str; 3] = ["trimmed RMSE", "RMSE", "relative RMSE"];

/// Pixels that the trimmed error leaves out: those that are brightest in the reference.
const TRIMMED: f64 = 0.005;
/// Added to a pixel's luminance where it divides, in means: dark pixels do not outweigh all others.
const DARK: f64 = 0.1;

/// [`MEASURES`] of an image.
pub(super) fn errors(image: &Image, reference: &Image) -> [f64; MEASURES.len()] {
    let luminance = |image: &Image| image.pixels.iter().map(|p| f64::from(p.luminance())).collect::<Vec<_>>();
    let (image, reference) = (luminance(image), luminance(reference));
    assert_eq!(image.len(), reference.len(), "images of one size");
    let n = reference.len() as f64;
    let mean = reference.iter().sum::<f64>() / n;
    let mut sorted = reference.clone();
    sorted.sort_by(f64::total_cmp);
    let kept = sorted[((1.0 - TRIMMED) * n) as usize];
    let [mut trimmed, mut left, mut all, mut relative] = [0.0; 4];
    for (x, y) in image.iter().zip(&reference) {
        let square = (x - y).powi(2);
        all += square;
        relative += square / (y * y + (DARK * mean).powi(2));
        if *y <= kept {
            (trimmed, left) = (trimmed + square, left + 1.0);
        }
    }
    [(trimmed / left).sqrt() / mean, (all / n).sqrt() / mean, (relative / n).sqrt()]
}

/// Errors after processor seconds, in the order of time.
pub(super) struct Curve(pub(super) Vec<(f64, [f64; MEASURES.len()])>);

/// When an error was reached.
#[derive(Clone, Copy)]
pub(super) enum Reached {
    /// With the first image or before.
    By(f64),
    At(f64),
    /// Not within the run.
    After(f64),
}

impl Curve {
    /// The error after so many seconds, straight between neighbours in logarithms; that of an end beyond it.
    pub(super) fn at(&self, seconds: f64, measure: usize) -> f64 {
        let after = self.0.iter().position(|point| point.0 >= seconds).unwrap_or(self.0.len() - 1);
        let [a, b] = [&self.0[after.saturating_sub(1)], &self.0[after]];
        let share = (seconds / a.0).ln() / (b.0 / a.0).ln();
        let share = if share.is_finite() { share.clamp(0.0, 1.0) } else { 1.0 };
        (a.1[measure].ln() * (1.0 - share) + b.1[measure].ln() * share).exp()
    }

    /// From when on the error stays at or below a goal.
    pub(super) fn reaches(&self, goal: f64, measure: usize) -> Reached {
        let Some(above) = self.0.iter().rposition(|point| point.1[measure] > goal) else {
            return Reached::By(self.0[0].0);
        };
        let a = &self.0[above];
        let Some(b) = self.0.get(above + 1) else { return Reached::After(a.0) };
        let share = (goal / a.1[measure]).ln() / (b.1[measure] / a.1[measure]).ln();
        Reached::At(a.0 * (b.0 / a.0).powf(share))
    }

    /// That of root mean squares over several curves, at the times of the first as far as all go.
    pub(super) fn of_all(curves: &[Self]) -> Self {
        let end = curves.iter().map(|c| c.0[c.0.len() - 1].0).fold(f64::INFINITY, f64::min);
        let begin = curves.iter().map(|c| c.0[0].0).fold(0.0, f64::max);
        let inside = curves[0].0.iter().map(|point| point.0).filter(|t| *t > begin && *t < end);
        let times: Vec<f64> = std::iter::once(begin).chain(inside).chain([end]).collect();
        let mean = |t: f64, measure| {
            let squares = curves.iter().map(|curve| curve.at(t, measure).powi(2));
            (squares.sum::<f64>() / curves.len() as f64).sqrt()
        };
        Self(times.into_iter().map(|t| (t, std::array::from_fn(|measure| mean(t, measure)))).collect())
    }
}

impl Reached {
    /// Seconds.
    pub(super) const fn seconds(self) -> f64 {
        let (Self::By(seconds) | Self::At(seconds) | Self::After(seconds)) = self;
        seconds
    }

    /// The sign before a number that is a bound.
    pub(super) const fn sign(self) -> &'static str {
        match self {
            Self::By(_) => "≤ ",
            Self::At(_) => "",
            Self::After(_) => "> ",
        }
    }
}

impl fmt::Display for Curve {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|(seconds, errors)| write!(f, "{seconds:.2} s {:.4}  ", errors[0]))
    }
}
