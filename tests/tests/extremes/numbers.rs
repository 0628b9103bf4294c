//! Sizes and counts: units of length, radii beyond the scene, more photons than 32 bits count.

use foton_integrator::{Alpha, Cancel, PpmSettings, RadiusRule, Render, RenderSettings};
use foton_math::Rgb;
use foton_math::glam::{DAffine3, DVec3};
use foton_scene::description::{EmitterKind, Geometry};
use foton_tests::{Sketch, glass, grey, mean};

use super::{advance, bits, number, with_radius};

/// A lit room with a ball of glass, as large as `unit` says; radiance is the same in any unit.
fn room(unit: f64) -> Sketch {
    let mut sketch = Sketch::default()
        .camera(DVec3::new(0.0, 0.0, 0.95), DVec3::new(0.0, -0.2, -1.0), 70.0, 32)
        .room(grey(0.6), None)
        .sphere(DVec3::new(0.4, -0.6, 0.0), 0.35, glass(1.5), None)
        .rectangle(DVec3::Y * 0.9, DVec3::X * 0.3, DVec3::Z * 0.3, grey(0.0), Some(Rgb::new(9.0, 8.0, 7.0)))
        .point(DVec3::new(-0.7, 0.5, 0.3), 2.0);
    let scale = DAffine3::from_scale(DVec3::splat(unit));
    for shape in &mut sketch.0.shapes {
        shape.to_world = scale * shape.to_world;
    }
    for sensor in &mut sketch.0.sensors {
        sensor.to_world.translation *= unit;
    }
    for emitter in &mut sketch.0.emitters {
        if let EmitterKind::Point { position, intensity } = &mut emitter.kind {
            *position *= unit;
            *intensity *= (unit * unit) as f32;
        }
    }
    sketch
}

/// Units that are no powers of two round positions otherwise, and a photon on the rim of a disc may change sides: the mean
/// agrees to 10⁻⁵ and 99 % of the pixels to 10⁻⁴. Radii that adapt go by where all photons lie, and spread that: 10⁻⁴ and 90 %.
#[test]
fn a_scene_in_another_unit_gives_the_same_picture() {
    for (radius_rule, of_mean, of_pixels) in
        [(RadiusRule::Local, 1e-5, 100), (RadiusRule::Adaptive, 1e-4, 10)]
    {
        let settings = |unit: f64| RenderSettings {
            ppm: PpmSettings { radius_rule, ..with_radius(0.1 * unit, 50_000).ppm },
            ..with_radius(0.1 * unit, 50_000)
        };
        let image = |unit: f64| room(unit).render(settings(unit), 3).image();
        let original = image(1.0);
        for unit in [1e-4, 1e6] {
            let other = image(unit);
            let (a, b) = (mean(&original), mean(&other));
            assert!((a / b - 1.0).abs() < of_mean, "unit {unit}: means {a} and {b}");
            let far = original.pixels.iter().zip(&other.pixels);
            let far = far.filter(|(p, q)| (p.g - q.g).abs() > 1e-4 * p.g).count();
            let all = original.pixels.len();
            assert!(far * of_pixels <= all, "{radius_rule:?}, unit {unit}: {far} pixels of {all}");
        }
    }
}

/// The square of the unit may be no number of single precision where the intensity that it makes of a light's is one.
#[test]
fn lights_without_extent_shine_in_any_unit() {
    // Guided, the shares of the two lights would show that an intensity below the normal numbers has lost a bit.
    let settings = |unit: f64| {
        let settings = with_radius(0.1 * unit, 2000);
        RenderSettings { ppm: PpmSettings { guided: false, ..settings.ppm }, ..settings }
    };
    let image = |unit: f64| bits(&room(unit).render(settings(unit), 2).image());
    let original = image(1.0);
    for exponent in [-61, -30, 62] {
        assert!(image(2f64.powi(exponent)) == original, "units of 2^{exponent}");
    }
    // Where no intensity makes up for the size, less light is there, and not none.
    let lit = |unit: f64| {
        let mut sketch = room(unit);
        sketch.0.shapes.iter_mut().for_each(|shape| shape.radiance = None);
        for emitter in &mut sketch.0.emitters {
            if let EmitterKind::Point { intensity, .. } = &mut emitter.kind {
                *intensity = Rgb::splat(2f32.powi(80));
            }
        }
        // Squares of such light, by which radii would adapt, are no numbers.
        let settings = RenderSettings {
            ppm: PpmSettings { radius_rule: RadiusRule::Local, ..with_radius(0.1 * unit, 2000).ppm },
            ..with_radius(0.1 * unit, 2000)
        };
        sketch.render(settings, 2).image()
    };
    let (small, large) = (lit(1.0), lit(2f64.powi(90)));
    for (small, large) in small.pixels.iter().zip(&large.pixels) {
        // By the square of 2^90, which is more than the largest number.
        assert_eq!(small.g.to_bits(), (large.g * 2f32.powi(90) * 2f32.powi(90)).to_bits());
    }
}

/// A disc larger than the scene is as large as the scene: finite, and it finds what is there.
#[test]
fn a_radius_beyond_the_scene_is_cut_to_it() {
    for radius in [1e3, 1e30, 1e300] {
        let render = room(1.0).render(with_radius(radius, 500), 2);
        assert!(render.image().pixels.iter().all(|p| p.is_finite() && !p.is_black()), "{radius}");
        assert!(render.radii().largest.is_finite() && render.radii().largest < 10.0, "{:?}", render.radii());
    }
}

/// Numbers of photons beyond 2³² are counted, and the image is the mean over all of them.
#[test]
fn photons_beyond_two_to_the_32_are_counted_and_shared_by_the_image() {
    let mut render = room(1.0).render(with_radius(0.1, 1000), 1);
    let (one, mut many) = (render.image(), render.save());
    // The second number of a state is that of photons emitted so far.
    let before = 1u64 << 33;
    many[8..16].copy_from_slice(&before.to_le_bytes());
    render.restore(&many).expect("a state of this render");
    assert_eq!(render.photons_emitted(), before);
    let emission = render.colour_layer(foton_integrator::LayerKind::Emission).expect("summed").pixels;
    for ((a, b), e) in one.pixels.iter().zip(&render.image().pixels).zip(&emission) {
        let (reflected, shared) = (f64::from(a.g - e.g), f64::from(b.g - e.g));
        assert!((shared - reflected * 1000.0 / before as f64).abs() <= 1e-6 * f64::from(a.g), "{a:?} {b:?}");
    }
    advance(&mut render, 1);
    assert_eq!(render.photons_emitted(), before + 1000);
}

/// States with numbers that no render has are refused, although their checksum may be right.
#[test]
fn a_state_with_impossible_numbers_is_refused() {
    let mut render = room(1.0).render(with_radius(0.1, 1000), 2);
    let state = render.save();
    assert_eq!(render.restore(&state), Ok(()));
    let mut refused = 0;
    for at in (0..state.len() / 8).step_by(7) {
        let mut bad = state.clone();
        bad[8 * at..8 * at + 8].copy_from_slice(&f64::NAN.to_bits().to_le_bytes());
        refused += u32::from(render.restore(&bad).is_err());
    }
    // Whole numbers take any bits.
    let all = (state.len() / 8).div_ceil(7) as u32;
    assert!(2 * refused > all, "{refused} of {all}");
    render.restore(&state).expect("sound");
    advance(&mut render, 1);
    assert!(render.image().pixels.iter().all(|p| p.is_finite()));
}

#[test]
fn alpha_of_a_thousandth_and_of_one_render_finite_images() {
    for alpha in [1e-3, 1.0] {
        let settings = RenderSettings {
            ppm: PpmSettings { alpha: Alpha::new(alpha).expect("in range"), ..with_radius(0.1, 2000).ppm },
            ..with_radius(0.1, 2000)
        };
        let render = room(1.0).render(settings, 20);
        let (largest, smallest) = (render.radii().largest, render.radii().smallest);
        assert!(render.image().pixels.iter().all(|p| p.is_finite()) && smallest > 0.0, "α {alpha}");
        assert!(alpha < 1.0 || (largest - 0.1).abs() < 1e-6, "α = 1 never shrinks the radius: {largest}");
    }
}

/// A thing of a millimetre ten kilometres from the middle of the scene has hardly any coordinates left, and the scene says so.
#[test]
fn a_small_thing_far_away_says_how_few_coordinates_it_has() {
    let steps = |x: f64, size: f64| {
        let sketch = Sketch::default()
            .camera(DVec3::new(0.0, 5.0, 0.0), DVec3::ZERO, 40.0, 2)
            .rectangle(DVec3::ZERO, DVec3::Z * 1e4, DVec3::X * 1e4, grey(0.5), None)
            .shape(
                Geometry::Sphere { centre: DVec3::new(x, size, 0.0), radius: size },
                DAffine3::IDENTITY,
                grey(0.5),
                None,
            );
        sketch.build().expect("sound").shapes()[1].steps_across
    };
    assert!(steps(0.0, 1e-3) > 1e6, "in the middle every digit is there");
    assert!(steps(9.99e3, 1e-3) < 3.0, "{}", steps(9.99e3, 1e-3));
    assert!(steps(9.99e3, 1.0) > 1000.0);
}

/// Any number of threads, more than there are cores too: a render ends, and has the bits of one thread.
#[test]
fn sixty_four_threads_on_few_cores_give_the_bits_of_one() {
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| {
            let scene = room(1.0).build().expect("sound");
            let settings = RenderSettings {
                ppm: PpmSettings { photons_per_pass: number(9000), ..with_radius(0.1, 9000).ppm },
                ..with_radius(0.1, 9000)
            };
            let cancel = Cancel::default();
            let mut render = Render::start(scene, settings, &mut |_| (), &cancel).expect("starts");
            advance(&mut render, 2);
            bits(&render.image())
        })
    };
    let one = run(1);
    assert!([3, 16, 64].into_iter().all(|threads| run(threads) == one));
}
