//! The converged image at some eye samples, by a run whose photons nobody else has.

use std::num::NonZeroU32;
use std::path::Path;
use std::sync::Arc;

use foton_format::Options;
use foton_integrator::{Alpha, Cancel, DirectLight, LayerKind, Ppm, RadiusScale, Settings, Variants};
use foton_scene::Scene;

pub(crate) const SIDE: u32 = 64;
pub(crate) const TILE: usize = 8;

/// Photons a pass of the truth.
const PHOTONS: u32 = 1 << 17;
/// Its radius over the first radius of what is judged.
const SCALE: f64 = 0.2;
/// Distance of its photons' seed from any other.
const OTHER_PHOTONS: u64 = 1 << 32;

/// Reflected luminance and the variance of that, by pixel; mean and variance by tile.
pub(crate) struct Truth {
    pub(crate) pixels: Vec<(f64, f64)>,
    pub(crate) tiles: Vec<(f64, f64)>,
    /// Pixels that see something reflect.
    pub(crate) seen: Vec<bool>,
    /// Mean reflected luminance over those.
    pub(crate) mean: f64,
}

/// An asset at [`SIDE`]² pixels.
pub(crate) fn open(name: &str) -> Arc<Scene> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("tests/ lies in the repository");
    let path = root.join(format!("assets/{name}/scene.xml"));
    let mut description = foton_format::open(&path, &Options::default()).expect("an asset").description;
    for sensor in &mut description.sensors {
        sensor.resize(SIDE, SIDE);
    }
    Arc::new(Scene::build(&description).expect("a sound asset"))
}

/// One eye sample a pixel.
pub(crate) fn settings(photons: u32, seed: u64) -> Settings {
    Settings {
        photons_per_pass: NonZeroU32::new(photons).expect("above 0"),
        samples_per_pixel: NonZeroU32::MIN,
        seed,
        ..Settings::default()
    }
}

/// A run whose eye samples are of the settings' seed and whose photons are of another.
pub(crate) fn start(scene: &Arc<Scene>, settings: Settings, photons: u64) -> Variants {
    let started = Variants::start(scene, &[settings], photons, &mut |_| (), &Cancel::default());
    started.expect("not cancelled").expect("one variant")
}

pub(crate) fn advance(runs: &mut Variants) {
    runs.advance(&mut |_| (), &Cancel::default()).expect("not cancelled");
}

/// Luminance without what emitters themselves show.
pub(crate) fn reflected(ppm: &Ppm) -> Vec<f64> {
    let emission = ppm.colour_layer(LayerKind::Emission).expect("always kept");
    let image = ppm.image();
    let pixels = image.pixels.iter().zip(&emission.pixels);
    pixels.map(|(all, e)| f64::from(all.luminance()) - f64::from(e.luminance())).collect()
}

pub(crate) fn seen(ppm: &Ppm) -> Vec<bool> {
    (0..(SIDE * SIDE) as usize).map(|p| !ppm.discs(p).is_empty()).collect()
}

impl Truth {
    /// Of the eye samples of `like`, by `passes` passes of small fixed radii, direct light by shadow rays.
    pub(crate) fn render(scene: &Arc<Scene>, like: &Settings, passes: u64) -> Self {
        let photons = NonZeroU32::new(PHOTONS).expect("above 0");
        let settings = Settings {
            alpha: Alpha::new(1.0).expect("in range"),
            radius_scale: RadiusScale::new(SCALE).expect("above 0"),
            direct_light: DirectLight::ShadowRays,
            photons_per_pass: photons,
            first_pass: photons,
            error: false,
            ..like.clone()
        };
        let mut runs = start(scene, settings, like.seed + OTHER_PHOTONS);
        let count = (SIDE * SIDE) as usize;
        let mut pixels = vec![(0.0, 0.0); count];
        let mut tiles = vec![(0.0, 0.0); (SIDE as usize / TILE).pow(2)];
        for _ in 0..passes {
            advance(&mut runs);
            let pass: Vec<f64> =
                runs.runs()[0].last_pass().pixels.iter().map(|p| f64::from(p.luminance())).collect();
            add(&mut pixels, &pass);
            add(&mut tiles, &tile_means(&pass));
        }
        conclude(&mut pixels, passes);
        conclude(&mut tiles, passes);
        let seen = seen(&runs.runs()[0]);
        let lit: f64 = pixels.iter().zip(&seen).filter(|(_, s)| **s).map(|(p, _)| p.0).sum();
        let mean = lit / seen.iter().filter(|s| **s).count() as f64;
        Self { pixels, tiles, seen, mean }
    }

    /// Root mean square difference over what is seen, relative to the mean; the truth's own noise taken off.
    pub(crate) fn error(&self, reflected: &[f64]) -> f64 {
        self.squares(reflected, &|_| true)[0].max(0.0).sqrt()
    }

    /// Mean square difference relative to the squared mean, the truth's own noise taken off: over all that is seen, over tiles that `picks`
    /// picks, and over the others.
    pub(crate) fn squares(&self, reflected: &[f64], picks: &dyn Fn(usize) -> bool) -> [f64; 3] {
        let picked: Vec<bool> = (0..self.tiles.len()).map(picks).collect();
        let (mut squares, mut counts) = ([0.0; 3], [0.0; 3]);
        for (i, (x, (t, variance))) in
            reflected.iter().zip(&self.pixels).enumerate().filter(|(i, _)| self.seen[*i])
        {
            let part = if picked[tile_of(i)] { 1 } else { 2 };
            for part in [0, part] {
                squares[part] += (x - t).powi(2) - variance;
                counts[part] += 1.0;
            }
        }
        [0, 1, 2].map(|part| squares[part] / f64::max(counts[part], 1.0) / (self.mean * self.mean))
    }

    /// Its own noise, relative to the mean.
    pub(crate) fn noise(&self) -> f64 {
        let picked = self.pixels.iter().zip(&self.seen).filter(|(_, s)| **s);
        let (sum, count) = picked.fold((0.0, 0.0), |(s, n), ((_, v), _)| (s + v, n + 1.0));
        (sum / count).sqrt() / self.mean
    }
}

fn add(sums: &mut [(f64, f64)], pass: &[f64]) {
    for ((sum, squares), x) in sums.iter_mut().zip(pass) {
        *sum += x;
        *squares += x * x;
    }
}

/// From sums and squares of equal passes to their mean and its variance.
fn conclude(sums: &mut [(f64, f64)], passes: u64) {
    let n = passes as f64;
    for (sum, squares) in sums {
        *sum /= n;
        *squares = ((*squares / n - *sum * *sum) / (n - 1.0)).max(0.0);
    }
}

/// The tile of a pixel.
const fn tile_of(pixel: usize) -> usize {
    let width = SIDE as usize;
    pixel / width / TILE * (width / TILE) + pixel % width / TILE
}

fn tile_means(pixels: &[f64]) -> Vec<f64> {
    let across = SIDE as usize / TILE;
    let mut tiles = vec![0.0; across * across];
    for (i, p) in pixels.iter().enumerate() {
        tiles[tile_of(i)] += p / (TILE * TILE) as f64;
    }
    tiles
}
