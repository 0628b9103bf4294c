//! Where emitted power goes: each event is counted where it happens, and the sum must come out.

use std::num::NonZeroU32;
use std::sync::Arc;

use foton_integrator::{Method, PpmSettings, RenderSettings};
use foton_math::Rgb;
use foton_math::glam::{DAffine3, DVec3};
use foton_scene::description::{Geometry, Mesh};
use foton_tests::{Sketch, glass, grey};

fn settings() -> RenderSettings {
    RenderSettings {
        samples_per_pixel: NonZeroU32::MIN,
        ppm: PpmSettings {
            photons_per_pass: NonZeroU32::new(400_000).expect("above 0"),
            first_pass: NonZeroU32::new(400_000).expect("above 0"),
            ..PpmSettings::default()
        },
        ..RenderSettings::default()
    }
}

/// 400,000 photons bounce 360,000 times here, and an absorbing bounce takes 0.3 to 1 of a photon: losing a single one shifts the
/// balance by 7·10⁻⁷ or more; rounding leaves 10⁻⁸.
const ONE_BOUNCE: f64 = 2e-7;

fn open_box() -> Sketch {
    Sketch::default()
        .camera(DVec3::new(0.0, 0.0, 3.0), DVec3::ZERO, 40.0, 8)
        .rectangle(-DVec3::Y, DVec3::Z, DVec3::X, grey(0.7), None)
        .rectangle(DVec3::Y, DVec3::X, DVec3::Z, grey(0.7), None)
        .rectangle(-DVec3::Z, DVec3::X, DVec3::Y, grey(0.4), None)
        .sphere(DVec3::new(0.1, -0.5, 0.1), 0.4, glass(1.5), None)
        .sphere(DVec3::new(0.0, 0.6, 0.0), 0.1, grey(0.0), Some(Rgb::new(9.0, 7.0, 2.0)))
}

#[test]
fn no_bounce_in_a_million_is_lost() {
    // Ten times the photons: nearly four million bounces, of which a million to one loses more than three.
    let photons = NonZeroU32::new(4_000_000).expect("above 0");
    let many = RenderSettings {
        ppm: PpmSettings { photons_per_pass: photons, first_pass: photons, ..settings().ppm },
        ..settings()
    };
    let ledger = *open_box().render(many, 1).ledger();
    assert!(ledger.imbalance().abs() < 0.1 * ONE_BOUNCE, "{}: {ledger:?}", ledger.imbalance());
    assert!(ledger.absorbed > 0.1 * ledger.emitted && ledger.escaped > 0.1 * ledger.emitted);
    assert_eq!(ledger.dropped, 0);
    assert!((ledger.roulette / ledger.emitted).abs() < 5e-3, "roulette is fair: {ledger:?}");
}

#[test]
fn what_a_short_depth_cuts_off_is_reported_at_its_material() {
    for method in [Method::Ppm, Method::Sppm] {
        let settings = || RenderSettings { method, ..settings() };
        let long = *open_box().render(settings(), 1).ledger();
        let render = open_box().max_depth(3).render(settings(), 1);
        let short = *render.ledger();
        assert!(short.imbalance().abs() < ONE_BOUNCE, "{short:?}");
        assert!(long.truncated < 1e-6 * long.emitted);
        assert!(short.truncated > 0.05 * short.emitted);
        let losses: Vec<f64> = render.material_losses().iter().map(|l| l.truncated).collect();
        assert!((losses.iter().sum::<f64>() / short.truncated - 1.0).abs() < 1e-9, "{losses:?}");
        // Three walls and the glass pass light on; the emitter is black.
        assert!(losses[..4].iter().all(|&l| l > 0.0) && losses[4] == 0.0, "{losses:?}");
    }
}

#[test]
fn a_closed_white_room_ends_by_the_depth_cap_and_says_so() {
    let sketch = Sketch::default()
        .camera(DVec3::ZERO, DVec3::X, 60.0, 4)
        .room(grey(1.0), None)
        .point(DVec3::ZERO, 1.0);
    let few = RenderSettings {
        ppm: PpmSettings { photons_per_pass: NonZeroU32::new(2000).expect("above 0"), ..settings().ppm },
        ..settings()
    };
    let ledger = *sketch.render(few, 1).ledger();
    assert!((ledger.truncated / ledger.emitted - 1.0).abs() < 1e-5, "{ledger:?}");
    assert_eq!(ledger.escaped, 0.0, "a closed room leaks nothing");
}

/// A tent whose normals lean over: photons gain at some angles and lose at others, and the ledger says both.
#[test]
fn what_photons_gain_at_interpolated_normals_is_a_line_of_its_own() {
    let mut tent = Mesh::rectangle();
    tent.normals = tent.positions.iter().map(|p| DVec3::new(0.5 * p.x, 0.5 * p.y, 0.5)).collect();
    let sketch = open_box().shape(
        Geometry::Mesh(Arc::new(tent)),
        DAffine3::from_scale(DVec3::splat(0.5)),
        grey(0.8),
        None,
    );
    let leaning = *sketch.render(settings(), 1).ledger();
    assert!(leaning.shading_gain > 1e-3 * leaning.emitted, "{leaning:?}");
    assert!(leaning.shading_normals > -leaning.shading_gain && leaning.imbalance().abs() < ONE_BOUNCE);
    let flat = *open_box().render(settings(), 1).ledger();
    assert_eq!((flat.shading_normals, flat.shading_gain), (0.0, 0.0));
}

#[test]
fn without_light_the_image_is_black_and_the_ledger_empty() {
    let sketch = Sketch::default().camera(DVec3::ZERO, DVec3::X, 60.0, 4).room(grey(0.5), None);
    let render = sketch.render(settings(), 1);
    assert!(render.image().pixels.iter().all(|&p| p == Rgb::BLACK));
    assert_eq!((render.ledger().emitted, render.ledger().imbalance()), (0.0, 0.0));
}
