//! Blends, bump maps and normal maps: each method sees the same light, as much as closed forms and displaced meshes say.

use std::f64::consts::PI;
use std::num::NonZeroU32;
use std::sync::Arc;

use foton_film::Image;
use foton_integrator::{Method, PpmSettings, RenderSettings};
use foton_math::Rgb;
use foton_math::glam::{DAffine2, DAffine3, DVec2, DVec3};
use foton_scene::description::{
    Bitmap, Blend, Bsdf, EmitterDescription, EmitterKind, Geometry, Mesh, Mirror, Number, Relief, ReliefKind,
    Texture, TextureKind, Wrap,
};
use foton_tests::{Sketch, grey, mean};

const ALL: [Method; 4] = [Method::Ppm, Method::Sppm, Method::Path, Method::PhotonMap];

fn number(n: u32) -> NonZeroU32 {
    NonZeroU32::new(n).expect("above 0")
}

fn settings(method: Method, photons: u32) -> RenderSettings {
    let photons = number(photons);
    let ppm = PpmSettings { photons_per_pass: photons, first_pass: photons, ..PpmSettings::default() };
    RenderSettings { method, ppm, samples_per_pixel: number(4), ..RenderSettings::default() }
}

/// Adds a picture of `size` pixels by their texture coordinates; returns its index.
fn picture(sketch: &mut Sketch, size: u32, colour: impl Fn(DVec2) -> Rgb) -> usize {
    let at = |i: u32| (f64::from(i) + 0.5) / f64::from(size);
    let pixels = (0..size)
        .flat_map(|y| (0..size).map(move |x| (x, y)))
        .map(|(x, y)| colour(DVec2::new(at(x), 1.0 - at(y))));
    let bitmap = Arc::new(Bitmap::new(size, size, pixels.collect()));
    let kind = TextureKind::Bitmap { bitmap, wrap: Wrap::Repeat, bilinear: true };
    sketch.0.textures.push(Texture { name: "picture".into(), to_uv: DAffine2::IDENTITY, kind });
    sketch.0.textures.len() - 1
}

/// The colour that a normal map has for a normal.
fn encoded(normal: DVec3) -> Rgb {
    let n = normal.normalize() * 0.5 + 0.5;
    Rgb::new(n.x as f32, n.y as f32, n.z as f32)
}

fn relief(texture: usize, kind: ReliefKind) -> Option<Relief> {
    Some(Relief { texture, kind, same_behind: false })
}

/// A square that fills the picture, under a sky of radiance 1.
fn square_under_the_sky(front: Bsdf) -> Sketch {
    let mut sketch = Sketch::default()
        .camera(DVec3::new(0.0, 0.0, 3.0), DVec3::ZERO, 20.0, 12)
        .rectangle(DVec3::ZERO, DVec3::X, DVec3::Y, front, None)
        .max_depth(2);
    let kind = EmitterKind::Constant { radiance: Rgb::WHITE };
    sketch.0.emitters.push(EmitterDescription { name: "sky".into(), kind });
    sketch
}

/// Lambert's law about a normal that leans by δ, over the hemisphere of the surface: ρ (1 + cos δ)/2 of the sky's radiance.
#[test]
fn a_leaning_normal_loses_the_light_from_below_the_surface_and_no_other() {
    for degrees in [0.0f64, 20.0, 50.0] {
        let lean = degrees.to_radians();
        let mut sketch = square_under_the_sky(grey(0.8));
        let normal = DVec3::new(lean.sin() * 0.6, lean.sin() * 0.8, lean.cos());
        let texture = picture(&mut sketch, 4, |_| encoded(normal));
        sketch.0.materials[0].relief = relief(texture, ReliefKind::Normal);
        let expected = 0.8 * (1.0 + lean.cos()) / 2.0;
        for method in ALL {
            let found = mean(&sketch.render(settings(method, 1 << 17), 8).image());
            assert!(
                (found / expected - 1.0).abs() < 0.01,
                "{method:?} at {degrees}°: {found}, not {expected}"
            );
        }
    }
}

/// A blend reflects what its parts reflect by their shares; what a texture says of the shares is taken where the light is.
#[test]
fn a_blend_is_the_sum_of_its_parts() {
    for (textured, nested) in [(false, false), (true, false), (false, true)] {
        let mut sketch = square_under_the_sky(grey(0.8));
        sketch = sketch.rectangle(DVec3::Z * -9.0, DVec3::X, DVec3::Y, grey(0.2), None);
        sketch = sketch.rectangle(DVec3::Z * -9.0, DVec3::X, DVec3::Y, grey(0.5), None);
        let weight = if textured {
            let ramp = |uv: DVec2| Rgb::splat(if uv.x < 0.5 { 0.1 } else { 0.7 });
            Number::Texture(picture(&mut sketch, 64, ramp))
        } else {
            Number::Constant(0.4)
        };
        sketch.0.materials[0].mixture.push(Blend { material: 1, weight });
        // 0.8 · 0.6 + 0.2 · 0.4, for both weights.
        let mut expected = 0.56;
        if nested {
            // A quarter of the second is the third, and then a half of all.
            sketch.0.materials[1].mixture.push(Blend { material: 2, weight: Number::Constant(0.25) });
            sketch.0.materials[0].mixture.push(Blend { material: 2, weight: Number::Constant(0.5) });
            expected = 0.5 * (0.8 * 0.6 + 0.4 * (0.75 * 0.2 + 0.25 * 0.5)) + 0.5 * 0.5;
        }
        for method in ALL {
            // Paths choose a part at random for each sample.
            let passes = if method == Method::Path { 128 } else { 8 };
            let found = mean(&sketch.render(settings(method, 1 << 17), passes).image());
            assert!((found / expected - 1.0).abs() < 0.01, "{method:?}: {found}, not {expected}");
        }
    }
}

/// A room all of whose walls lean and are blended, so that light goes by both many times.
#[test]
fn methods_agree_where_light_goes_by_blends_and_leaning_normals_many_times() {
    let mut sketch = Sketch::default()
        .camera(DVec3::new(-0.9, 0.8, 0.9), DVec3::new(0.3, -0.4, -0.3), 80.0, 24)
        .room(grey(0.7), None)
        .rectangle(DVec3::Y * 0.98, DVec3::X * 0.4, DVec3::Z * 0.4, grey(0.0), Some(Rgb::splat(5.0)))
        .rectangle(DVec3::Z * 9.0, DVec3::X * 0.1, DVec3::Y * 0.1, grey(0.3), None);
    let waves = picture(&mut sketch, 64, |uv| {
        encoded(DVec3::new(0.5 * (6.0 * PI * uv.x).sin(), 0.4 * (4.0 * PI * uv.y).cos(), 1.0))
    });
    let heights = picture(&mut sketch, 64, |uv| {
        Rgb::splat((0.5 + 0.4 * (6.0 * PI * uv.x).sin() * (4.0 * PI * uv.y).sin()) as f32)
    });
    for (i, material) in sketch.0.materials[..6].iter_mut().enumerate() {
        let kind = if i % 2 == 0 { ReliefKind::Normal } else { ReliefKind::Bump { scale: 0.1 } };
        material.relief = relief(if i % 2 == 0 { waves } else { heights }, kind);
        material.mixture.push(Blend { material: 7, weight: Number::Texture(heights) });
    }
    let mut plain = sketch.clone();
    plain
        .0
        .materials
        .iter_mut()
        .for_each(|material| (material.relief, material.mixture) = (None, Vec::new()));
    // Discs over the room's edges cost photons a percent of their light, whatever the walls are made of.
    let by_paths = |sketch: &Sketch, method| {
        let light = |method, passes| mean(&sketch.render(settings(method, 1 << 17), passes).image());
        light(method, 16) / light(Method::Path, 192)
    };
    for method in [Method::Ppm, Method::Sppm, Method::PhotonMap] {
        let [found, expected] = [by_paths(&sketch, method), by_paths(&plain, method)];
        assert!((found / expected - 1.0).abs() < 0.01, "{method:?}: {found}, without: {expected}");
    }
}

const WAVE: f64 = 0.015;

/// How far the mirror of the next test stands out.
fn height(uv: DVec2) -> f64 {
    WAVE * (0.5 + 0.25 * (6.0 * PI * uv.x).sin() + 0.25 * (4.0 * PI * uv.y).cos())
}

/// A mirror of side 2, a mesh that is displaced or a square with a bump map, which the sun mirrors on a screen in front of it.
fn mirrored_sun(displaced: bool) -> Image {
    const STEPS: u32 = 96;
    let mut sketch = Sketch::default()
        .camera(DVec3::new(0.0, 2.6, -1.2), DVec3::new(0.0, 1.5, 1.5), 48.0, 32)
        .rectangle(DVec3::new(0.0, 1.5, 1.5), DVec3::X * 1.5, DVec3::NEG_Y * 1.1, grey(0.8), None);
    let mirror = Bsdf::Mirror(Mirror { reflectance: Rgb::WHITE.into() });
    if displaced {
        let point = |uv: DVec2| DVec3::new(2.0 * uv.x - 1.0, 2.0 * uv.y - 1.0, height(uv));
        let row = STEPS + 1;
        let at = |i: u32| DVec2::new(f64::from(i % row), f64::from(i / row)) / f64::from(STEPS);
        let normal = |uv: DVec2| {
            let step = 1e-4;
            let along = |step: DVec2| point(uv + step) - point(uv - step);
            along(DVec2::X * step).cross(along(DVec2::Y * step)).normalize()
        };
        let corners = (0..STEPS * STEPS).map(|i| i / STEPS * row + i % STEPS);
        let mesh = Mesh {
            positions: (0..row * row).map(|i| point(at(i))).collect(),
            normals: (0..row * row).map(|i| normal(at(i))).collect(),
            triangles: corners.flat_map(|i| [[i, i + 1, i + row + 1], [i, i + row + 1, i + row]]).collect(),
            ..Mesh::default()
        };
        sketch = sketch.shape(Geometry::Mesh(Arc::new(mesh)), DAffine3::IDENTITY, mirror, None);
    } else {
        sketch = sketch.rectangle(DVec3::ZERO, DVec3::X, DVec3::Y, mirror, None);
        let texture = picture(&mut sketch, 256, |uv| Rgb::splat((height(uv) / WAVE) as f32));
        let kind = ReliefKind::Bump { scale: WAVE as f32 };
        sketch.0.materials[1].relief = relief(texture, kind);
    }
    let kind =
        EmitterKind::Directional { direction: DVec3::new(0.0, 1.0, -1.0), irradiance: Rgb::splat(3.0) };
    sketch.0.emitters.push(EmitterDescription { name: "sun".into(), kind });
    sketch.0.max_depth = Some(3);
    sketch.render(settings(Method::Ppm, 1 << 18), 8).image()
}

#[test]
fn a_bumped_mirror_throws_the_caustic_of_a_displaced_one() {
    let (bumped, displaced) = (mirrored_sun(false), mirrored_sun(true));
    let blocks = |image: &Image| -> Vec<f64> {
        let of = |block: usize| {
            let (x, y) = (block % 8 * 4, block / 8 * 4);
            let rows = (y..y + 4).flat_map(|y| (x..x + 4).map(move |x| y * 32 + x));
            rows.map(|i| f64::from(image.pixels[i].g)).sum()
        };
        (0..64).map(of).collect()
    };
    let (bumped, displaced) = (blocks(&bumped), blocks(&displaced));
    let mean = displaced.iter().sum::<f64>() / 64.0;
    let spread = (displaced.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / 64.0).sqrt();
    let difference = bumped.iter().zip(&displaced).map(|(b, d)| (b - d).powi(2)).sum::<f64>() / 64.0;
    assert!(spread > 0.3 * mean, "the caustic has structure: {spread} about {mean}");
    assert!(difference.sqrt() < 0.05 * mean, "{} of {mean}", difference.sqrt());
    let total = bumped.iter().sum::<f64>() / displaced.iter().sum::<f64>();
    assert!((total - 1.0).abs() < 0.01, "{total}");
}
