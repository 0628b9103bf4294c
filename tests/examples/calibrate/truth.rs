//! The converged image at some eye samples, by runs whose photons nobody else has.
//!
//! Two runs of their own photons, a and b: then (x − a)(x − b) has neither's noise in its mean, whatever that is. Each comes in
//! discs of two radii, of which squares are extrapolated to none (`foton_measure::sweep::reference`).

use std::path::Path;
use std::sync::Arc;

use foton_format::Options;
use foton_integrator::{Cancel, LayerKind, Render, RenderSettings, Variants};
use foton_measure::sweep::reference::{OwnRun, Reference, extrapolated, luminance};
use foton_scene::Scene;

pub(crate) const TILE: usize = 8;

/// Its radius over the first radius of what is judged.
const SCALE: f64 = 0.07;
/// Distance of its photons' seed from any other.
const OTHER_PHOTONS: u64 = 1 << 32;

/// What is true.
pub(crate) struct Truth {
    halves: [Reference; 2],
    /// Mean and variance of the mean of each tile's luminance, reflected.
    pub(crate) tiles: Vec<(f64, f64)>,
    width: usize,
}

/// A figure and its standard deviation.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Figure {
    pub(crate) value: f64,
    pub(crate) deviation: f64,
}

impl Figure {
    /// Of a mean square.
    pub(crate) fn root(self) -> Self {
        let value = self.value.max(0.0).sqrt();
        Self { value, deviation: 0.5 * self.deviation / value.max(1e-12) }
    }
}

/// An asset, or a scene that was hard to tell of, at `side`² pixels.
pub(crate) fn open(name: &str, side: u32) -> Arc<Scene> {
    if let Some(sketch) = crate::scenes::of(name, side) {
        return sketch.build().expect("a sound scene");
    }
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("tests/ lies in the repository");
    let path = root.join(format!("assets/{name}/scene.xml"));
    let mut description = foton_format::open(&path, &Options::default()).expect("an asset").description;
    for sensor in &mut description.sensors {
        sensor.resize(side, side);
    }
    Arc::new(Scene::build(&description).expect("a sound asset"))
}

/// A run whose eye samples are of the settings' seed and whose photons are of another.
pub(crate) fn start(scene: &Arc<Scene>, settings: RenderSettings, photons: u64) -> Variants {
    let started = Variants::start(scene, &[settings], photons, &mut |_| (), &Cancel::default());
    started.expect("not cancelled").expect("one variant")
}

pub(crate) fn advance(runs: &mut Variants) {
    runs.advance(&mut |_| (), &Cancel::default()).expect("not cancelled");
}

/// Luminance without what emitters themselves show.
pub(crate) fn reflected(render: &Render) -> Vec<f64> {
    let emission = render.colour_layer(LayerKind::Emission).expect("always summed");
    luminance(&render.image()).iter().zip(luminance(&emission)).map(|(all, e)| all - e).collect()
}

impl Truth {
    /// Of the eye samples of `like`, by `passes` passes of small fixed radii, direct light by shadow rays.
    pub(crate) fn render(scene: &Arc<Scene>, like: &RenderSettings, passes: u64) -> Self {
        let cancel = Cancel::default();
        let width = scene.sensors()[like.sensor].width as usize;
        let mut tiles = vec![(0.0, 0.0); (width / TILE).pow(2)];
        let mut direct = tiles.clone();
        let halves = [0, 1].map(|half| {
            let photons = (SCALE, like.seed + (1 + half) * OTHER_PHOTONS);
            let mut run = OwnRun::start(scene, like, photons, &cancel).expect("not cancelled");
            for _ in 0..passes / 2 {
                let [fine, wide] = run.advance(&cancel).expect("not cancelled");
                let least_blurred: Vec<f64> = fine.iter().zip(wide).map(|(f, w)| 2.0 * f - w).collect();
                for ((sum, squares), x) in tiles.iter_mut().zip(tile_means(&least_blurred, width)) {
                    *sum += x;
                    *squares += x * x;
                }
            }
            for (pixel, (light, variance)) in run.direct_light().into_iter().enumerate() {
                let tile = pixel / width / TILE * (width / TILE) + pixel % width / TILE;
                direct[tile].0 += 0.5 * light / (TILE * TILE) as f64;
                direct[tile].1 += 0.25 * variance / ((TILE * TILE) as f64).powi(2);
            }
            run.conclude().expect("an asset has light")
        });
        let n = (passes / 2 * 2) as f64;
        for ((sum, squares), (light, variance)) in tiles.iter_mut().zip(direct) {
            *sum /= n;
            *squares = ((*squares / n - *sum * *sum) / (n - 1.0)).max(0.0) + variance;
            *sum += light;
        }
        Self { halves, tiles, width }
    }

    /// Pixels away from edges of shapes and of light.
    pub(crate) fn smooth(&self) -> &[bool] {
        &self.halves[0].masks.smooth
    }

    fn seen(&self) -> &[bool] {
        &self.halves[0].masks.seen
    }

    /// Share of the seen pixels that are smooth.
    pub(crate) fn smooth_share(&self) -> f64 {
        self.halves[0].masks.smooth_share()
    }

    /// Mean reflected luminance of the seen pixels.
    pub(crate) fn mean(&self) -> f64 {
        0.5 * (self.halves[0].mean + self.halves[1].mean)
    }

    /// Whether all of a tile is smooth.
    pub(crate) fn is_smooth(&self, tile: usize) -> bool {
        let across = self.width / TILE;
        let corner = tile / across * TILE * self.width + tile % across * TILE;
        (0..TILE * TILE).all(|i| self.smooth()[corner + i / TILE * self.width + i % TILE])
    }

    /// Root mean square difference over what is seen, relative to the mean.
    pub(crate) fn error(&self, render: &Render) -> Figure {
        self.squares(&reflected(render))[0].root()
    }

    /// Mean square difference of reflected luminance relative to the squared mean: over all that is seen, over what is smooth of
    /// it, and over the rest.
    pub(crate) fn squares(&self, reflected: &[f64]) -> [Figure; 3] {
        let (mut squares, mut variances, mut counts) = ([[0.0; 2]; 3], [0.0; 3], [0.0; 3]);
        for (pixel, x) in reflected.iter().enumerate().filter(|(pixel, _)| self.seen()[*pixel]) {
            let [a, b] = [0, 1].map(|half| {
                let reference = &self.halves[half];
                let wide = reference.wide.as_ref().expect("a run of its own");
                [&reference.fine, wide].map(|of| of.luminance[pixel] - reference.emission[pixel])
            });
            let product = |i: usize| (x - a[i]) * (x - b[i]);
            // A product of two halves, each off by its own noise, whose variance is v; doubled where it is extrapolated.
            let v = 0.5 * (a[0] - b[0]).powi(2);
            let variance = 4.0 * (2.0 * product(0).max(0.0) * v + v * v);
            for part in [0, if self.smooth()[pixel] { 1 } else { 2 }] {
                squares[part][0] += product(0);
                squares[part][1] += product(1);
                variances[part] += variance;
                counts[part] += 1.0;
            }
        }
        let scale = |part: usize| f64::max(counts[part], 1.0) * self.mean() * self.mean();
        [0, 1, 2].map(|part| Figure {
            value: extrapolated(squares[part][0], squares[part][1]) / scale(part),
            deviation: f64::sqrt(variances[part]) / scale(part),
        })
    }

    /// What direct, caustic and indirect light have of the squared error: Σ (x − t)(x_c − t_c), each over their sum. `render` keeps
    /// them apart.
    pub(crate) fn class_shares(&self, render: &Render) -> [f64; 3] {
        let image = reflected(render);
        let kinds = [LayerKind::Direct, LayerKind::Caustic, LayerKind::Indirect];
        let layers =
            kinds.map(|kind| luminance(&render.colour_layer(kind).expect("classes are summed separately")));
        let of = |class: usize| -> f64 {
            let pixels = (0..image.len()).filter(|pixel| self.seen()[*pixel]);
            let off = |half: usize, pixel: usize| {
                let half = &self.halves[half];
                image[pixel] + half.emission[pixel] - half.fine.luminance[pixel]
            };
            let of_class = |half: usize, pixel: usize| {
                let truth = &self.halves[half].classes.as_ref().expect("a run of its own")[class];
                layers[class][pixel] - truth[pixel]
            };
            pixels.map(|p| off(0, p) * of_class(1, p) + off(1, p) * of_class(0, p)).sum()
        };
        let parts = [0, 1, 2].map(of);
        parts.map(|part| part / parts.iter().sum::<f64>())
    }

    /// Its own noise, relative to the mean.
    pub(crate) fn noise(&self) -> f64 {
        let [a, b] = &self.halves;
        let difference = |pixel: usize| a.fine.luminance[pixel] - b.fine.luminance[pixel];
        let pixels: Vec<usize> = (0..self.seen().len()).filter(|pixel| self.seen()[*pixel]).collect();
        let squares: f64 = pixels.iter().map(|pixel| (0.5 * difference(*pixel)).powi(2)).sum();
        (squares / pixels.len() as f64).sqrt() / self.mean()
    }
}

fn tile_means(pixels: &[f64], width: usize) -> Vec<f64> {
    let across = width / TILE;
    let mut tiles = vec![0.0; across * across];
    for (i, p) in pixels.iter().enumerate() {
        tiles[i / width / TILE * across + i % width / TILE] += p / (TILE * TILE) as f64;
    }
    tiles
}
