//! What runs are compared with: an image that someone gives, or a long run of the sweep's own.
//!
//! A run of its own sees the same eye samples as what is judged: neither side then has the other's antialiasing error. It shrinks
//! its radii within some passes, leaves them there (α 0.2, then 1), takes direct light by shadow rays and keeps the mean of the
//! later passes, whose scatter says how noisy it is. An image that is given has no noise of its own known, and differs by what
//! few eye samples miss.

use std::sync::Arc;

use foton_film::{Image, LayerData};
use foton_integrator::{
    Alpha, Cancel, Cancelled, Change, DirectLight, LayerKind, Ppm, RadiusScale, Settings,
};
use foton_scene::Scene;

use super::masks::{self, Masks};

/// Passes that shrink radii.
const SHRINKING: u64 = 48;
/// Passes at least that are kept: fewer say too little of their own noise.
const KEPT: u64 = 24;
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
        is_enough: &mut dyn FnMut() -> bool,
        is_stopped: &dyn Fn() -> Result<(), Cancelled>,
        cancel: &Cancel,
    ) -> Result<Option<Self>, Cancelled> {
        let scale = RadiusScale::new(0.5 * base.radius_scale.get()).unwrap_or_default();
        let settings = Settings {
            alpha: Alpha::new(0.2).unwrap_or_default(),
            radius_scale: scale,
            direct_light: DirectLight::ShadowRays,
            layers: true,
            error: false,
            photons_per_pass: base.first_pass.max(base.photons_per_pass),
            ..base.clone()
        };
        let mut own = OwnRun::start(scene, settings, cancel)?;
        while !(is_enough() && own.kept >= KEPT) {
            is_stopped()?;
            own.advance(cancel)?;
        }
        Ok(own.conclude())
    }
}

/// A reference under way.
struct OwnRun {
    ppm: Ppm,
    sums: Vec<f64>,
    squares: Vec<f64>,
    colours: Vec<[f64; 3]>,
    classes: [Vec<f64>; 3],
    kept: u64,
}

impl OwnRun {
    fn start(scene: &Arc<Scene>, settings: Settings, cancel: &Cancel) -> Result<Self, Cancelled> {
        let ppm = Ppm::start(Arc::clone(scene), settings, &mut |_| (), cancel)?;
        let pixels = ppm.image().pixels.len();
        let zeros = || vec![0.0; pixels];
        Ok(Self {
            ppm,
            sums: zeros(),
            squares: zeros(),
            colours: vec![[0.0; 3]; pixels],
            classes: [zeros(), zeros(), zeros()],
            kept: 0,
        })
    }

    fn advance(&mut self, cancel: &Cancel) -> Result<(), Cancelled> {
        if self.ppm.passes() == SHRINKING {
            let one = Alpha::new(1.0).unwrap_or_default();
            self.ppm.change(Change::Alpha(one));
        }
        let before: Option<Vec<Vec<f64>>> = (self.ppm.passes() == SHRINKING).then(|| self.class_sums());
        if let Some(before) = before {
            for (class, before) in self.classes.iter_mut().zip(before) {
                class.iter_mut().zip(before).for_each(|(c, b)| *c = -b);
            }
        }
        self.ppm.advance(&mut |_| (), cancel)?;
        if self.ppm.passes() > SHRINKING {
            self.kept += 1;
            let pass = self.ppm.last_pass();
            for (i, pixel) in pass.pixels.iter().enumerate() {
                let l = f64::from(pixel.luminance());
                self.sums[i] += l;
                self.squares[i] += l * l;
                for (sum, c) in self.colours[i].iter_mut().zip(pixel.to_array()) {
                    *sum += f64::from(c);
                }
            }
        }
        Ok(())
    }

    /// Luminance of each class times the photons emitted so far.
    fn class_sums(&self) -> Vec<Vec<f64>> {
        let photons = self.ppm.photons_emitted() as f64;
        let of = |kind| self.ppm.colour_layer(kind).map(|image| luminance(&image)).unwrap_or_default();
        CLASSES.into_iter().map(|kind| of(kind).into_iter().map(|l| l * photons).collect()).collect()
    }

    fn conclude(mut self) -> Option<Reference> {
        let n = self.kept as f64;
        let photons = n * f64::from(self.ppm.settings().photons_per_pass.get());
        let after = self.class_sums();
        for (class, after) in self.classes.iter_mut().zip(after) {
            class.iter_mut().zip(after).for_each(|(c, a)| *c = (*c + a) / photons);
        }
        let emission = self.ppm.colour_layer(LayerKind::Emission)?;
        let mut image = emission;
        for (pixel, sum) in image.pixels.iter_mut().zip(&self.colours) {
            *pixel += foton_math::Rgb::from_array(sum.map(|s| (s / n) as f32));
        }
        let variance = self.sums.iter().zip(&self.squares);
        let variance = variance.map(|(s, q)| ((q / n - (s / n) * (s / n)) / (n - 1.0)).max(0.0)).collect();
        let radius = self.ppm.radii().median;
        let origin = format!(
            "a run of its own of the same eye samples: {SHRINKING} passes that shrink radii (to a median of {radius:.4}), then the \
             mean of {} at fixed radii, {:.0} M photons; direct light by shadow rays",
            self.kept,
            photons / 1e6,
        );
        Reference::new(&self.ppm, image, Some(self.classes), Some(variance), origin)
    }
}

/// Luminance by pixel.
pub(crate) fn luminance(image: &Image) -> Vec<f64> {
    image.pixels.iter().map(|p| f64::from(p.luminance())).collect()
}
