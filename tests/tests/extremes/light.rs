//! How much light there is, from next to none to more than single precision holds.

use std::f64::consts::PI;

use foton_film::LayerData;
use foton_integrator::{Alpha, DirectLight, LayerKind, PpmSettings, RenderSettings};
use foton_math::Rgb;
use foton_math::glam::{DAffine2, DVec3};
use foton_scene::BuildError;
use foton_scene::description::{
    Bitmap, Bsdf, Colour, Diffuse, EmitterDescription, EmitterKind, Material, Texture, TextureKind, Wrap,
};
use foton_tests::{Sketch, glass, grey, mean, seeds};

use super::{bits, with_radius};

/// A ball seen from inside with a source at its centre, far along x.
fn hollow(sketch: Sketch, x: f64, power: f64) -> Sketch {
    let centre = DVec3::X * x;
    sketch.sphere(centre, 1.0, grey(0.5), None).inside_out().point(centre, power)
}

/// Two closed rooms, one lit a hundred million times as strongly: the dim one has the irradiance Φ/(4πR²(1−ρ)) of its own
/// source all the same, because every emitter has a share of the photons that does not depend on its power.
#[test]
fn a_dim_room_beside_one_a_hundred_million_times_brighter_is_right() {
    let sketch = Sketch::default().camera(DVec3::new(0.3, 0.1, 0.0), DVec3::new(0.3, 0.4, 1.0), 80.0, 12);
    let sketch = hollow(hollow(sketch, 0.0, 1.0), 5.0, 1e8);
    let settings = RenderSettings {
        ppm: PpmSettings { alpha: Alpha::new(1.0).expect("in range"), ..with_radius(0.25, 60_000).ppm },
        ..with_radius(0.25, 60_000)
    };
    let expected = 0.5 / PI / (4.0 * PI * 0.5);
    let (got, sigma) = seeds(&sketch, &settings, 3, 6);
    assert!((got - expected).abs() < 4.0 * sigma + 1e-3 * expected, "{got} ± {sigma}, expected {expected}");
    assert!(sigma < 0.02 * expected, "the test must be able to tell: {sigma}");
}

/// Nothing is clamped in silence: 2³⁰ times the power gives 2³⁰ times each pixel, bit for bit, fireflies and all.
#[test]
fn light_is_linear_to_the_last_bit_and_no_value_is_clamped() {
    let image = |power: f64| {
        let sketch = Sketch::default()
            .camera(DVec3::new(0.0, 0.0, 0.95), DVec3::new(0.0, -0.2, -1.0), 70.0, 24)
            .room(grey(0.8), None)
            .sphere(DVec3::new(0.3, -0.5, -0.3), 0.4, glass(1.5), None)
            .point(DVec3::new(-0.3, 0.7, 0.1), power);
        sketch.render(with_radius(0.01, 3000), 2).image()
    };
    let plain = image(1.0);
    let brightest = plain.pixels.iter().map(|p| p.g).fold(0.0, f32::max);
    assert!(f64::from(brightest) > 10.0 * mean(&plain), "fireflies: {brightest}, mean {}", mean(&plain));
    for factor in [2f64.powi(30), 2f64.powi(-30)] {
        let mut expected = plain.clone();
        expected.pixels.iter_mut().for_each(|p| *p *= factor as f32);
        assert!(bits(&image(factor)) == bits(&expected), "factor {factor}");
    }
}

/// Photons of two lights that are near the largest number are heavier than any number: they are dropped, counted
/// at their light, and leave no trace in the image or the ledger.
#[test]
fn photons_too_heavy_for_a_number_are_dropped_and_counted_at_their_light() {
    let sketch = Sketch::default()
        .camera(DVec3::ZERO, DVec3::X, 60.0, 8)
        .room(grey(0.5), None)
        .point(DVec3::Y * 0.5, 5e31)
        .point(DVec3::Y * -0.5, 5e31);
    let render = sketch.render(with_radius(0.2, 2000), 2);
    let dropped: Vec<u64> = render.light_use().iter().map(|l| l.dropped).collect();
    assert!(dropped.iter().all(|&n| n > 100), "{dropped:?}");
    assert_eq!(render.ledger().dropped, dropped.iter().sum::<u64>());
    assert!(render.ledger().imbalance().is_finite() && render.image().pixels.iter().all(|p| p.is_finite()));
}

/// A source that lies on the floor is infinitely bright where it lies, and nowhere else.
#[test]
fn a_light_on_a_surface_makes_no_pixel_infinite() {
    for direct_light in [DirectLight::Photons, DirectLight::ShadowRays] {
        let sketch = Sketch::default()
            .camera(DVec3::Z, DVec3::ZERO, 20.0, 9)
            .rectangle(DVec3::ZERO, DVec3::X, DVec3::Y, grey(0.5), None)
            .point(DVec3::ZERO, 1.0);
        let render = sketch.render(
            RenderSettings {
                ppm: PpmSettings { direct_light, ..with_radius(0.1, 5000).ppm },
                ..with_radius(0.1, 5000)
            },
            2,
        );
        assert!(render.image().pixels.iter().all(|p| p.is_finite()), "{direct_light:?}");
    }
}

#[test]
fn where_no_photon_lands_the_image_is_black_and_counted_as_unknown() {
    // A light that shines away from everything.
    let sketch = Sketch::default()
        .camera(DVec3::Z, DVec3::ZERO, 40.0, 8)
        .rectangle(DVec3::ZERO, DVec3::X, DVec3::Y, grey(0.5), None)
        .rectangle(DVec3::Z * 2.0, DVec3::X * 0.1, DVec3::Y * 0.1, grey(0.0), Some(Rgb::WHITE));
    let scene = sketch.build().expect("sound");
    let cancel = foton_integrator::Cancel::default();
    let mut render =
        foton_integrator::Render::start(scene, with_radius(0.1, 500), &mut |_| (), &cancel).expect("starts");
    let before = render.image();
    assert!(before.pixels.iter().all(|&p| p == Rgb::BLACK), "before the first pass, too");
    let report = render.advance(&mut |_| (), &cancel).expect("not cancelled");
    assert_eq!((report.no_photon_share, report.accepted), (1.0, 0));
    assert!(render.image().pixels.iter().all(|&p| p == Rgb::BLACK));
    let Some(LayerData::F32(radii)) = render.layer(LayerKind::Radius).map(|l| l.channels) else {
        panic!("radii are numbers")
    };
    assert!(radii.values.iter().all(|r| r.is_finite() && *r > 0.0), "radii stay as they were");
}

/// The error of a plain room after something in it was spoilt.
fn refusal(spoil: impl FnOnce(&mut Sketch)) -> Option<BuildError> {
    let mut sketch = Sketch::default()
        .camera(DVec3::ZERO, DVec3::X, 60.0, 4)
        .room(grey(0.5), None)
        .point(DVec3::ZERO, 1.0);
    let pixels = vec![Rgb::splat(0.5); 6];
    sketch.0.textures.push(Texture {
        name: "brick".into(),
        to_uv: DAffine2::IDENTITY,
        kind: TextureKind::Bitmap {
            bitmap: Bitmap::new(3, 2, pixels).into(),
            wrap: Wrap::Repeat,
            bilinear: true,
        },
    });
    sketch.0.materials[0].front = Bsdf::Diffuse(Diffuse { reflectance: Colour::Texture(0) });
    spoil(&mut sketch);
    sketch.build().err()
}

fn texel(sketch: &mut Sketch, value: f32) {
    let TextureKind::Bitmap { bitmap, .. } = &mut sketch.0.textures[0].kind else { panic!("it is one") };
    std::sync::Arc::make_mut(bitmap).pixels[4].g = value;
}

/// One texel that is not a number would be all that is left of the image: it is refused by name before anything is rendered.
#[test]
fn one_texel_that_is_not_a_number_is_refused_by_name() {
    assert_eq!(refusal(|_| ()), None, "the room itself is sound");
    for value in [f32::NAN, f32::INFINITY, -0.1, 1.001] {
        assert_eq!(refusal(|s| texel(s, value)), Some(BuildError::BadTexture("brick".into())), "{value}");
    }
    let stretched = refusal(|s| s.0.textures[0].to_uv.matrix2.x_axis.x = f64::NAN);
    assert_eq!(stretched, Some(BuildError::BadTexture("brick".into())));
}

/// At the poles, in the corners, in the middle: no pixel's weight is so small that it would be left out of what is checked.
#[test]
fn environments_with_a_pixel_that_is_not_a_number_are_refused_by_name() {
    let (width, height) = (3, 3);
    let sky = |spoilt: Option<usize>, value: f32, scale: f32| {
        refusal(|s: &mut Sketch| {
            let mut pixels = vec![Rgb::WHITE; (width * height) as usize];
            if let Some(pixel) = spoilt {
                pixels[pixel].g = value;
            }
            let bitmap = Bitmap::new(width, height, pixels).into();
            let kind = EmitterKind::Environment { to_world: Default::default(), bitmap, scale };
            s.0.emitters.push(EmitterDescription { name: "sky".into(), kind });
        })
    };
    let refused = Some(BuildError::NotFinite("sky".into()));
    assert_eq!(sky(None, 1.0, 1.0), None);
    for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        for pixel in 0..(width * height) as usize {
            assert_eq!(sky(Some(pixel), value, 1.0), refused, "{value} in pixel {pixel}");
        }
        assert_eq!(sky(None, 1.0, value), refused, "a scale of {value}");
    }
    assert_eq!(sky(Some(4), f32::INFINITY, 0.0), refused, "infinity times nothing");
}

/// Albedo above 1 would grow for ever, and an index of refraction of 0 or NaN has no law of refraction.
#[test]
fn materials_that_no_surface_has_are_refused_by_name() {
    let with = |front: Bsdf| {
        refusal(|s| {
            s.0.materials[0] = Material { name: "odd".into(), front, back: None, ..Material::default() }
        })
    };
    let bad = Some(BuildError::BadMaterial("odd".into()));
    for reflectance in [f32::NAN, f32::INFINITY, -0.01, 1.01] {
        assert_eq!(with(grey(reflectance)), bad, "{reflectance}");
    }
    for ior in [0.0, -1.5, f32::NAN, f32::INFINITY] {
        assert_eq!(with(glass(ior)), bad, "{ior}");
    }
    assert_eq!((with(grey(1.0)), with(glass(1e3))), (None, None));
}
