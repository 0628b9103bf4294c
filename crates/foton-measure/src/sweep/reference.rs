//! What runs are compared with: an image that someone gives, or a long run of the sweep's own.
//!
//! A run of its own sees the same eye samples as what is judged: neither side then has the other's antialiasing error. It keeps
//! a small radius from first to last (α 1), so that all its passes are independent and their scatter says how noisy it is, and
//! takes direct light by shadow rays. Its radius falls with its time as n^(−1/6), as a run's at α = 2/3 does: its noise and what is
//! left of its blur stay in proportion. An image that is given has no noise of its own known, and differs by what few eye
//! samples miss.

use std::num::NonZeroU32;
use std::sync::Arc;
use std::time::Duration;

use foton_film::{Image, LayerData};
use foton_integrator::{Alpha, Cancel, Cancelled, DirectLight, LayerKind, Ppm, RadiusScale, Settings};
use foton_scene::Scene;

use super::masks::{self, Masks};

/// Passes at least: fewer say too little of their own noise.
const FEWEST: u64 = 16;
/// Photons a pass at most.
const MOST_PHOTONS: NonZeroU32 = NonZeroU32::new(1 << 16).expect("above 0");
/// Radius over the centre's first radius at `TIME` seconds of rendering.
const SCALE: f64 = 0.25;
const TIME: f64 = 180.0;
/// Path classes: direct, caustic, indirect.
pub(crate) const CLASSES: [LayerKind; 3] = [LayerKind::Direct, LayerKind::Caustic, LayerKind::Indirect];

/// The truth as far as it is known.
pub(crate) struct Reference {
    pub(crate) image: Image,
    /// Luminance of direct, caustic and indirect light by pixel; none of an image that is given.
    pub(crate) classes: Option<[Vec<f64>; 3]>,
    /// Variance of luminance by pixel; zero where nothing is known.
    pub(crate) variance: Vec<f64>,
    pub(crate) masks: Masks,
    /// Mean reflected luminance of the seen pixels, which shares are relative to (W/m²/sr).
    pub(crate) mean: f64,
    /// In words.
    pub(crate) origin: String,
}

impl Reference {
    /// Root mean square noise over the seen pixels, relative to their mean.
    pub(crate) fn noise(&self) -> f64 {
        masks::mean(&self.masks.seen, self.variance.iter().copied()).sqrt() / self.mean
    }

    /// Of an image with the pixels of `ppm`, which knows what is seen. `None` where nothing is, or all is dark.
    pub(crate) fn new(
        ppm: &Ppm,
        image: Image,
        classes: Option<[Vec<f64>; 3]>,
        variance: Option<Vec<f64>>,
        origin: String,
    ) -> Option<Self> {
        let emission = luminance(&ppm.colour_layer(LayerKind::Emission)?);
        let pixels = emission.len();
        let reflected: Vec<f64> =
            luminance(&image).iter().zip(&emission).map(|(l, e)| (l - e).max(0.0)).collect();
        let seen: Vec<bool> = (0..pixels).map(|p| !ppm.discs(p).is_empty()).collect();
        let shapes = match ppm.layer(LayerKind::ShapeId)?.channels {
            LayerData::U32(plane) => plane.values,
            LayerData::Rgb(_) | LayerData::F32(_) => return None,
        };
        let masks = Masks::new(seen, &shapes, &reflected, image.width as usize);
        let mean = masks::mean(&masks.seen, reflected.into_iter());
        let variance = variance.unwrap_or_else(|| vec![0.0; pixels]);
        (mean > 0.0).then_some(Self { image, classes, variance, masks, mean, origin })
    }

    /// A run of its own, until `is_enough` says so.
    pub(crate) fn render(
        scene: &Arc<Scene>,
        base: &Settings,
        time: Duration,
        is_enough: &mut dyn FnMut() -> bool,
        is_stopped: &dyn Fn() -> Result<(), Cancelled>,
        cancel: &Cancel,
    ) -> Result<Option<Self>, Cancelled> {
        let scale = SCALE * (time.as_secs_f64().max(1e-3) / TIME).powf(-1.0 / 6.0);
        let scale = scale.min(1.0) * base.radius_scale.get();
        let settings = Settings {
            alpha: Alpha::new(1.0).unwrap_or_default(),
            radius_scale: RadiusScale::new(scale).unwrap_or_default(),
            // Equal passes, whose scatter is that of equals; many, since each has one shadow ray a hit point.
            photons_per_pass: base.photons_per_pass.min(MOST_PHOTONS),
            first_pass: base.photons_per_pass.min(MOST_PHOTONS),
            direct_light: DirectLight::ShadowRays,
            layers: true,
            error: false,
            ..base.clone()
        };
        let mut own = OwnRun::start(scene, settings, scale / base.radius_scale.get(), cancel)?;
        while !(is_enough() && own.ppm.passes() >= FEWEST) {
            is_stopped()?;
            own.advance(cancel)?;
        }
        Ok(own.conclude())
    }
}

/// A reference under way: Σ and Σ² of its passes' luminance.
struct OwnRun {
    ppm: Ppm,
    sums: Vec<f64>,
    squares: Vec<f64>,
    /// Radius over the centre's first.
    scale: f64,
}

impl OwnRun {
    fn start(scene: &Arc<Scene>, settings: Settings, scale: f64, cancel: &Cancel) -> Result<Self, Cancelled> {
        let ppm = Ppm::start(Arc::clone(scene), settings, &mut |_| (), cancel)?;
        let zeros = vec![0.0; ppm.image().pixels.len()];
        Ok(Self { ppm, sums: zeros.clone(), squares: zeros, scale })
    }

    fn advance(&mut self, cancel: &Cancel) -> Result<(), Cancelled> {
        self.ppm.advance(&mut |_| (), cancel)?;
        for (i, pixel) in self.ppm.last_pass().pixels.iter().enumerate() {
            let l = f64::from(pixel.luminance());
            self.sums[i] += l;
            self.squares[i] += l * l;
        }
        Ok(())
    }

    fn conclude(self) -> Option<Reference> {
        let n = self.ppm.passes() as f64;
        let of = |(s, q): (&f64, &f64)| ((q / n - (s / n) * (s / n)) / (n - 1.0)).max(0.0);
        let variance = self.sums.iter().zip(&self.squares).map(of).collect();
        let class = |kind| self.ppm.colour_layer(kind).map(|image| luminance(&image));
        let [direct, caustic, indirect] = CLASSES.map(class);
        let classes = direct.zip(caustic).zip(indirect).map(|((d, c), i)| [d, c, i]);
        let origin = format!(
            "a run of its own of the same eye samples: the mean of {n} passes, {:.1} M photons, at radii fixed at {:.2} of the \
             centre's first; direct light by shadow rays",
            self.ppm.photons_emitted() as f64 / 1e6,
            self.scale,
        );
        Reference::new(&self.ppm, self.ppm.image(), classes, Some(variance), origin)
    }
}

/// Luminance by pixel.
pub(crate) fn luminance(image: &Image) -> Vec<f64> {
    image.pixels.iter().map(|p| f64::from(p.luminance())).collect()
}
