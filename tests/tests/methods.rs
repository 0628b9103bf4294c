//! Methods see the same light, each as far as it sees any: their converged means agree, and where one is blind it is blind to just that.

use std::num::NonZeroU32;
use std::path::Path;
use std::sync::Arc;

use foton_format::{Options, open};
use foton_integrator::{Cancel, LayerKind, Method, PpmSettings, Render, RenderSettings};
use foton_math::glam::DVec3;
use foton_scene::Scene;
use foton_tests::{Sketch, glass, grey};

/// Pixels along the side of a tile.
const TILE: usize = 8;

fn number(n: u32) -> NonZeroU32 {
    NonZeroU32::new(n).expect("above 0")
}

fn scene(name: &str) -> Arc<Scene> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../{name}.xml"));
    let mut description = open(&path, &Options::default()).expect("a sound file").description;
    for sensor in &mut description.sensors {
        let (width, height) = (f64::from(sensor.width), f64::from(sensor.height));
        sensor.resize((48.0 * (width / height).max(1.0)) as u32, (48.0 * (height / width).max(1.0)) as u32);
    }
    Arc::new(Scene::build(&description).expect("a sound scene"))
}

/// A render that has about converged, with the settings that a person would not change.
fn converged(scene: &Arc<Scene>, method: Method, seed: u64) -> Render {
    let photons = number(1 << 16);
    let (samples, passes) = match method {
        Method::Ppm => (number(16), 24),
        Method::Sppm => (number(4), 24),
        Method::Path | Method::Whitted | Method::PhotonMap => (number(8), 24),
    };
    let ppm = PpmSettings { photons_per_pass: photons, first_pass: photons, ..PpmSettings::default() };
    let settings = RenderSettings {
        method,
        seed,
        samples_per_pixel: samples,
        layers: true,
        ppm,
        ..RenderSettings::default()
    };
    render(scene, settings, passes)
}

fn render(scene: &Arc<Scene>, settings: RenderSettings, passes: u32) -> Render {
    let cancel = Cancel::default();
    let mut render = Render::start(Arc::clone(scene), settings, &mut |_| (), &cancel).expect("started");
    for _ in 0..passes {
        render.advance(&mut |_| (), &cancel).expect("a pass");
    }
    render
}

/// Luminance of reflected light, by tile.
fn tiles(render: &Render) -> Vec<f64> {
    let kinds = [LayerKind::Direct, LayerKind::Caustic, LayerKind::Indirect];
    let layers = kinds.iter().map(|kind| render.colour_layer(*kind).expect("summed"));
    let mut tiles = Vec::new();
    for image in layers {
        let across = (image.width as usize).div_ceil(TILE);
        tiles.resize(across * (image.height as usize).div_ceil(TILE), 0.0);
        for (pixel, light) in image.pixels.iter().enumerate() {
            let (x, y) = (pixel % image.width as usize, pixel / image.width as usize);
            tiles[y / TILE * across + x / TILE] += f64::from(light.luminance());
        }
    }
    tiles
}

/// Two renders by a method.
struct Pair {
    reflected: [Vec<f64>; 2],
}

impl Pair {
    fn of(scene: &Arc<Scene>, method: Method) -> Self {
        let renders = [1, 2].map(|seed| converged(scene, method, seed));
        Self { reflected: [0, 1].map(|i| tiles(&renders[i])) }
    }

    fn mean(&self, tile: usize) -> f64 {
        0.5 * (self.reflected[0][tile] + self.reflected[1][tile])
    }

    /// Whether the two hardly differ.
    fn is_smooth(&self, tile: usize) -> bool {
        let difference = (self.reflected[0][tile] - self.reflected[1][tile]).abs();
        self.mean(tile) > 0.0 && difference < 0.04 * self.mean(tile)
    }
}

/// Where both hardly have any noise, the means of each method agree with those of progressive photon mapping to 1 %. Path tracing is left
/// out where the lamp is so small that it misses light through glass for long, and where a spot or a sun casts caustics.
#[test]
fn methods_agree_in_what_they_converge_to() {
    for (name, is_for_paths) in [
        ("assets/box-spheres/scene", false),
        ("assets/cornell-diffuse/scene", true),
        ("assets/cornell-spheres/scene", true),
        ("assets/furnace/scene", true),
        ("assets/ring/scene", false),
        ("tests/scenes/wide-ground", true),
    ] {
        let scene = scene(name);
        let photons = Pair::of(&scene, Method::Ppm);
        // Maps of photons are for any camera: over a ground without end their photons are far apart.
        let is_for_maps = is_for_paths && name.starts_with("assets");
        let compared = |m: &Method| match m {
            Method::Ppm => false,
            Method::Path => is_for_paths,
            Method::PhotonMap => is_for_maps,
            other => other.finds_all_light(),
        };
        for method in Method::ALL.into_iter().filter(compared) {
            let other = Pair::of(&scene, method);
            let all = 0..photons.reflected[0].len();
            let lit = all.clone().filter(|&t| photons.mean(t) > 0.0).count();
            let compared: Vec<usize> = all.filter(|&t| photons.is_smooth(t) && other.is_smooth(t)).collect();
            let sum = |pair: &Pair| compared.iter().map(|&t| pair.mean(t)).sum::<f64>();
            let ratio = sum(&other) / sum(&photons);
            assert!(3 * compared.len() > lit, "{name} {}: {} of {lit}", method.name(), compared.len());
            assert!((ratio - 1.0).abs() < 0.01, "{name} {}: {ratio}", method.name());
        }
    }
}

/// A floor, a glass ball over it, and light.
fn under_glass() -> Sketch {
    Sketch::default()
        .camera(DVec3::new(0.0, 3.0, 2.5), DVec3::new(0.0, 0.0, 0.0), 40.0, 32)
        .rectangle(DVec3::ZERO, DVec3::new(0.0, 0.0, 2.0), DVec3::new(2.0, 0.0, 0.0), grey(0.7), None)
        .sphere(DVec3::new(0.0, 0.7, 0.0), 0.4, glass(1.5), None)
}

fn light_of(render: &Render, kind: LayerKind) -> f64 {
    render.colour_layer(kind).expect("summed").pixels.iter().map(|c| f64::from(c.luminance())).sum()
}

/// A point is met by no path: what glass throws of its light is seen by photons alone. Of a lamp, paths see that as well.
#[test]
fn paths_see_no_light_of_a_point_through_glass_but_that_of_a_lamp() {
    let at = DVec3::new(0.0, 2.0, 0.0);
    let point = under_glass().point(at, 10.0);
    let lamp = under_glass().sphere(at, 0.6, grey(0.0), Some(foton_math::Rgb::splat(4.0)));
    for (sketch, is_seen) in [(point, false), (lamp, true)] {
        let scene = Arc::new(Scene::build(&sketch.0).expect("a sound scene"));
        let caustic = |method| light_of(&converged(&scene, method, 1), LayerKind::Caustic);
        let (by_photons, by_paths) = (caustic(Method::Ppm), caustic(Method::Path));
        assert!(by_photons > 0.0);
        if is_seen {
            assert!((by_paths / by_photons - 1.0).abs() < 0.05, "{by_paths} {by_photons}");
        } else {
            assert_eq!(by_paths, 0.0);
        }
    }
}

/// Whitted's ray tracing sees emitters, direct light and both in mirrors and glass; no caustics, and no light from wall to wall.
#[test]
fn whitted_sees_direct_light_alone_and_all_of_it() {
    let scene = scene("assets/cornell-diffuse/scene");
    let (whitted, photons) = (converged(&scene, Method::Whitted, 1), converged(&scene, Method::Ppm, 1));
    assert_eq!(light_of(&whitted, LayerKind::Caustic) + light_of(&whitted, LayerKind::Indirect), 0.0);
    // The lamp is seen by few pixels, half of them at its edge.
    for (kind, bound) in [(LayerKind::Direct, 0.01), (LayerKind::Emission, 0.03)] {
        let ratio = light_of(&whitted, kind) / light_of(&photons, kind);
        assert!((ratio - 1.0).abs() < bound, "{kind:?} {ratio}");
    }
}
