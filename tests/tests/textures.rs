//! Textures in whole renders: lamps whose radiance is a picture.

use std::num::NonZeroU32;
use std::sync::Arc;

use foton_film::Image;
use foton_integrator::{Method, PpmSettings, RenderSettings};
use foton_math::Rgb;
use foton_math::glam::{DAffine2, DVec2, DVec3};
use foton_scene::description::{Bitmap, Colour, Texture, TextureKind, Wrap};
use foton_tests::{Sketch, grey};

fn settings(method: Method, samples: u32) -> RenderSettings {
    let number = |n| NonZeroU32::new(n).expect("above 0");
    let photons = number(1 << 18);
    RenderSettings {
        method,
        samples_per_pixel: number(samples),
        ppm: PpmSettings { photons_per_pass: photons, first_pass: photons, ..PpmSettings::default() },
        ..RenderSettings::default()
    }
}

/// Means of tiles of 8 by 8 pixels.
fn tiles(image: &Image) -> Vec<f64> {
    let across = image.width as usize / 8;
    let mut tiles = vec![0.0; across * (image.height as usize / 8)];
    for (i, pixel) in image.pixels.iter().enumerate() {
        let (x, y) = (i % image.width as usize / 8, i / image.width as usize / 8);
        tiles[y * across + x] += f64::from(pixel.luminance()) / 64.0;
    }
    tiles
}

/// A picture with a bright quarter, and a room that a rectangle, a ball and a tube which show it light from its walls.
fn room_with_pictures() -> Sketch {
    let mut sketch = Sketch::default()
        .camera(DVec3::new(0.0, 0.0, -0.95), DVec3::ZERO, 80.0, 32)
        .room(grey(0.6), None)
        .rectangle(DVec3::new(-0.2, 0.99, 0.0), DVec3::X * 0.6, DVec3::Z * 0.4, grey(0.0), Some(Rgb::WHITE))
        .sphere(DVec3::new(0.6, 0.3, 0.5), 0.2, grey(0.0), Some(Rgb::WHITE));
    let pixels =
        (0..64).map(|i: u32| if i % 8 > 4 && i > 40 { Rgb::splat(9.0) } else { Rgb::new(0.3, 0.2, 0.1) });
    let bitmap = Arc::new(Bitmap::new(8, 8, pixels.collect()));
    let kind = TextureKind::Bitmap { bitmap, wrap: Wrap::Repeat, bilinear: true };
    let to_uv = DAffine2::from_translation(DVec2::new(0.1, 0.2));
    sketch.0.textures.push(Texture { name: "picture".into(), to_uv, kind });
    for shape in &mut sketch.0.shapes {
        shape.radiance = shape.radiance.map(|_| Colour::Texture(0));
    }
    sketch
}

#[test]
fn all_methods_see_a_picture_that_shines_and_the_light_that_it_throws() {
    let sketch = room_with_pictures();
    let renders = [(Method::Path, 64, 4), (Method::Ppm, 64, 8), (Method::PhotonMap, 16, 6)];
    let images = renders.map(|(method, samples, passes)| {
        let render = sketch.render(settings(method, samples), passes);
        if method == Method::Ppm {
            assert!(render.ledger().imbalance().abs() < 2e-7, "{:?}", render.ledger());
            assert!(render.ledger().absorbed > 0.5 * render.ledger().emitted);
        }
        tiles(&render.image())
    });
    for other in &images[1..] {
        for (tile, (a, b)) in images[0].iter().zip(other).enumerate() {
            assert!((b / a - 1.0).abs() < 0.04, "tile {tile}: {a} {b}");
        }
        let mean = |tiles: &[f64]| tiles.iter().sum::<f64>();
        assert!((mean(other) / mean(&images[0]) - 1.0).abs() < 0.01);
    }
}
