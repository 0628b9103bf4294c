//! What runs are compared with: an image that someone gives, or a long run of the sweep's own.
//!
//! A run of its own sees the same eye samples as what is judged: neither side then has the other's antialiasing error. Its
//! radius is small and stays the same (α = 1), so that all its passes are independent and their scatter says how noisy it is, and
//! takes direct light by shadow rays. Its radius falls with its time as n^(−1/6), as a run's at α = 2/3 does: its noise and what is
//! left of its bias stay in proportion. An image that is given has no noise of its own known, and differs by what few eye
//! samples miss.
//!
//! **What is left of its bias.** Across an edge of light even a small disc blurs, over a width that goes with its radius r, and the
//! squared difference from what is judged falls short by as much: by half of it where r is a fifth of the judged one's. So the
//! same photons are gathered in discs of twice the radius too, and squares are extrapolated to none: 2 E²(r) − E²(2r). What is
//! judged may be as sharp as the reference itself, in the focus of a caustic; then E²(2r) is the larger one, and E²(r) is all
//! that can be said.

use std::num::NonZeroU32;
use std::sync::Arc;
use std::time::Duration;

use foton_film::{Image, LayerData};
use foton_integrator::{
    Alpha, Cancel, Cancelled, DirectLight, LayerKind, PpmSettings, RadiusFloor, RadiusScale, Render,
    RenderSettings, Variants,
};
use foton_scene::Scene;

use super::masks::{self, Masks};

/// The smallest number of passes: fewer say too little about their own noise.
const FEWEST: u64 = 16;
/// The largest number of photons per pass.
const MAX_PHOTONS: NonZeroU32 = NonZeroU32::new(1 << 16).expect("above 0");
/// Radius over the centre's first radius at `TIME` seconds of rendering.
const SCALE: f64 = 0.15;
const TIME: f64 = 180.0;
/// Path classes: direct, caustic, indirect.
pub const CLASSES: [LayerKind; 3] = [LayerKind::Direct, LayerKind::Caustic, LayerKind::Indirect];

/// The truth as far as it is known.
pub struct Reference {
    /// Radiance.
    pub image: Image,
    /// Luminance of direct, caustic and indirect light by pixel; none of an image that is given.
    pub classes: Option<[Vec<f64>; 3]>,
    /// Luminance of `image` by pixel.
    pub fine: Known,
    /// The same photons in discs of twice the radius; none of an image that is given.
    pub wide: Option<Known>,
    /// Luminance by pixel that emitters themselves show.
    pub emission: Vec<f64>,
    /// Which pixels count.
    pub masks: Masks,
    /// Mean reflected luminance of the seen pixels, which shares are relative to (W/m²/sr).
    pub mean: f64,
    /// In words.
    pub origin: String,
}

/// Luminance by pixel and its variance, zero where nothing is known of that (W/m²/sr).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Known {
    /// The mean.
    pub luminance: Vec<f64>,
    /// Its variance.
    pub variance: Vec<f64>,
}

impl Reference {
    /// Root mean square noise over the seen pixels, relative to their mean.
    #[must_use]
    pub fn noise(&self) -> f64 {
        masks::mean(&self.masks.seen, self.fine.variance.iter().copied()).sqrt() / self.mean
    }

    /// The mean squared error over `mask` of pixels of the luminance that `x` says: the reference's own noise taken off, its bias
    /// extrapolated to none. By chance it may be below zero.
    #[must_use]
    pub fn mean_square(&self, mask: &[bool], x: impl Fn(usize) -> f64) -> f64 {
        let mean = |of: &Known| {
            let square = |(pixel, (y, v)): (usize, (&f64, &f64))| (x(pixel) - y).powi(2) - v;
            masks::mean(mask, of.luminance.iter().zip(&of.variance).enumerate().map(square))
        };
        let fine = mean(&self.fine);
        self.wide.as_ref().map_or(fine, |wide| extrapolated(fine, mean(wide)))
    }

    /// Of an image with the pixels of `render`, which knows what is seen. `None` where nothing is, or all is dark.
    pub(crate) fn new(
        render: &Render,
        image: Image,
        classes: Option<[Vec<f64>; 3]>,
        (variance, wide): (Option<Vec<f64>>, Option<Known>),
        origin: String,
    ) -> Option<Self> {
        let emission = luminance(&render.colour_layer(LayerKind::Emission)?);
        let pixels = emission.len();
        let of_image = luminance(&image);
        let reflected =
            |all: &[f64]| -> Vec<f64> { all.iter().zip(&emission).map(|(l, e)| (l - e).max(0.0)).collect() };
        let seen: Vec<bool> = (0..pixels).map(|p| !render.discs(p).is_empty()).collect();
        let shapes = match render.layer(LayerKind::ShapeId)?.channels {
            LayerData::U32(plane) => plane.values,
            LayerData::Rgb(_) | LayerData::F32(_) => return None,
        };
        // The less noisy of the two says where light is smooth.
        let calm = wide.as_ref().map_or(&of_image, |wide| &wide.luminance);
        let masks = Masks::new(seen, &shapes, &reflected(calm), image.width as usize);
        let mean = masks::mean(&masks.seen, reflected(&of_image).into_iter());
        let variance = variance.unwrap_or_else(|| vec![0.0; pixels]);
        let fine = Known { luminance: of_image, variance };
        (mean > 0.0).then_some(Self { image, classes, fine, wide, emission, masks, mean, origin })
    }

    /// A run of its own, until `is_enough` says so.
    pub(crate) fn render(
        scene: &Arc<Scene>,
        base: &RenderSettings,
        time: Duration,
        is_enough: &mut dyn FnMut() -> bool,
        is_stopped: &dyn Fn() -> Result<(), Cancelled>,
        cancel: &Cancel,
    ) -> Result<Option<Self>, Cancelled> {
        let scale = SCALE * (time.as_secs_f64().max(1e-3) / TIME).powf(-1.0 / 6.0);
        let mut own = OwnRun::start(scene, base, (scale.min(0.5), base.seed), cancel)?;
        while !(is_enough() && own.passes() >= FEWEST) {
            is_stopped()?;
            own.advance(cancel)?;
        }
        Ok(own.conclude())
    }
}

/// A mean square without what a reference's bias has taken from it, from those against it and against the one of twice its radius.
#[must_use]
pub fn extrapolated(fine: f64, wide: f64) -> f64 {
    fine + (fine - wide).max(0.0)
}

/// A reference under way.
pub struct OwnRun {
    runs: Variants,
    /// Σ and Σ² of passes' luminance by photons, fine and wide.
    sums: [Known; 2],
    /// Radius over the centre's first.
    scale: f64,
}

impl OwnRun {
    /// With the eye samples of `base`, radii of `scale` times its first, and photons of the seed `photons`.
    ///
    /// # Errors
    /// When cancelled.
    pub fn start(
        scene: &Arc<Scene>,
        base: &RenderSettings,
        (scale, photons): (f64, u64),
        cancel: &Cancel,
    ) -> Result<Self, Cancelled> {
        let photons_per_pass = base.ppm.photons_per_pass.min(MAX_PHOTONS);
        let of_radius = |scale: f64, layers| RenderSettings {
            layers,
            error: false,
            ppm: PpmSettings {
                alpha: Alpha::new(1.0).unwrap_or_default(),
                radius_scale: RadiusScale::new(scale * base.ppm.radius_scale.get()).unwrap_or_default(),
                radius_floor: RadiusFloor::NONE, // Equal passes, whose scatter is that of equals.
                photons_per_pass,
                first_pass: photons_per_pass,
                direct_light: DirectLight::ShadowRays,
                ..base.ppm
            },
            ..base.clone()
        };
        let settings = [of_radius(scale, true), of_radius(2.0 * scale, false)];
        let runs = Variants::start(scene, &settings, photons, &mut |_| (), cancel)?.ok_or(Cancelled)?;
        let zeros = vec![0.0; runs.runs()[0].image().pixels.len()];
        let sums = Known { luminance: zeros.clone(), variance: zeros };
        Ok(Self { runs, sums: [sums.clone(), sums], scale })
    }

    /// Passes so far.
    #[must_use]
    pub fn passes(&self) -> u64 {
        self.runs.runs()[0].passes()
    }

    /// One more pass. Returns its own estimates of what photons bring, in luminance by pixel: in discs of the radius, and of twice that.
    ///
    /// # Errors
    /// When cancelled.
    pub fn advance(&mut self, cancel: &Cancel) -> Result<[Vec<f64>; 2], Cancelled> {
        self.runs.advance(&mut |_| (), cancel)?;
        let passes = [0, 1].map(|i| luminance(&self.runs.runs()[i].last_pass()));
        for (sums, pass) in self.sums.iter_mut().zip(&passes) {
            for ((sum, square), l) in sums.luminance.iter_mut().zip(&mut sums.variance).zip(pass) {
                *sum += l;
                *square += l * l;
            }
        }
        Ok(passes)
    }

    /// Luminance of direct light by pixel, and its variance.
    #[must_use]
    pub fn direct_light(&self) -> Vec<(f64, f64)> {
        self.runs.runs()[0].direct_light().unwrap_or_default()
    }

    /// The reference; `None` where nothing is seen, or all is dark.
    #[must_use]
    pub fn conclude(&self) -> Option<Reference> {
        let [fine, wide] = self.runs.runs() else { return None };
        let n = fine.passes() as f64;
        let direct = self.direct_light();
        let variances = |sums: &Known| -> Vec<f64> {
            let of = |(s, q): (&f64, &f64)| ((q / n - (s / n) * (s / n)) / (n - 1.0)).max(0.0);
            let of_photons = sums.luminance.iter().zip(&sums.variance).map(of);
            of_photons.zip(&direct).map(|(photons, (_, direct))| photons + direct).collect()
        };
        let class = |kind| fine.colour_layer(kind).map(|image| luminance(&image));
        let [direct, caustic, indirect] = CLASSES.map(class);
        let classes = direct.zip(caustic).zip(indirect).map(|((d, c), i)| [d, c, i]);
        let origin = format!(
            "a run of its own of the same eye samples: the mean of {n} passes, {:.1} M photons, at radii fixed at {:.2} of the \
             centre's first and at twice that, of which squared errors are extrapolated to none; direct light by shadow rays",
            fine.photons_emitted() as f64 / 1e6,
            self.scale,
        );
        let wide = Known { luminance: luminance(&wide.image()), variance: variances(&self.sums[1]) };
        Reference::new(fine, fine.image(), classes, (Some(variances(&self.sums[0])), Some(wide)), origin)
    }
}

/// Luminance by pixel.
#[must_use]
pub fn luminance(image: &Image) -> Vec<f64> {
    image.pixels.iter().map(|p| f64::from(p.luminance())).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A share of a disc of radius 1 beyond a straight line at a distance from its middle: what an edge looks like through it.
    fn beyond(x: f64) -> f64 {
        let x = x.clamp(-1.0, 1.0);
        (x.acos() - x * (1.0 - x * x).sqrt()) / std::f64::consts::PI
    }

    #[test]
    fn an_edge_is_judged_as_against_one_that_nothing_blurs() {
        let pixels: Vec<f64> = (0..4000).map(|i| (f64::from(i) - 1999.5) / 1000.0).collect();
        let edge = |r: f64| pixels.iter().map(|x| beyond(x / r)).collect::<Vec<_>>();
        let square = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>();
        let judged = edge(1.0);
        let truth = square(&judged, &edge(1e-9));
        let (fine, wide) = (square(&judged, &edge(0.1)), square(&judged, &edge(0.2)));
        assert!(fine < 0.85 * truth, "a tenth of the radius hides {}", 1.0 - fine / truth);
        assert!(
            (extrapolated(fine, wide) / truth - 1.0).abs() < 0.05,
            "{}",
            extrapolated(fine, wide) / truth
        );
        // As sharp as the reference: nothing is extrapolated.
        assert_eq!(extrapolated(0.0, square(&edge(0.1), &edge(0.2))), 0.0);
    }
}
