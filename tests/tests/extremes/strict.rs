//! The first value that is not finite: where it is said to be, and what a render that stops there leaves.

use std::sync::Arc;

use foton_integrator::{Cancel, DirectLight, NotFinite, PpmSettings, Quantity, Render, RenderSettings};
use foton_math::Rgb;
use foton_math::glam::{DAffine3, DVec3};
use foton_scene::description::{
    Bsdf, Colour, Conductor, Geometry, Mesh, MicrofacetDistribution, Microfacets,
};
use foton_session::{Interrupt, PassError, Session, StopCause, StopRule};
use foton_tests::{Sketch, grey};

use super::{bits, number, with_radius};

/// A square floor seen from above.
fn floor(front: Bsdf) -> Sketch {
    Sketch::default()
        .camera(DVec3::Z, DVec3::ZERO, 60.0, 16)
        .rectangle(DVec3::ZERO, DVec3::X, DVec3::Y, front, None)
        .rectangle(DVec3::Z * 1.9, DVec3::X, DVec3::Y, grey(0.0), None)
}

/// A render of up to `passes` that stops at the first value that is not finite, on so many threads.
fn strict(sketch: &Sketch, settings: &RenderSettings, passes: u64, threads: usize) -> (Session, StopCause) {
    let interrupt = Interrupt::default();
    let scene = sketch.build().expect("a sound scene");
    let mut session =
        Session::start(scene, settings.clone(), Some(threads), interrupt.cancel()).expect("starts");
    session.render_mut().stop_at_first_not_finite();
    let cause = session.run(&StopRule::passes(passes), &interrupt, &mut |_| ());
    (session, cause)
}

/// The place where it stops, the same on any number of threads; what it leaves is the image of the passes before, bit for bit, and a
/// render that goes on leaves the same value out.
#[track_caller]
fn first(sketch: &Sketch, settings: &RenderSettings, quantity: Quantity) -> NotFinite {
    let (session, cause) = strict(sketch, settings, 200, 1);
    assert_eq!(cause, StopCause::NotFinite);
    let place = session.not_finite().expect("a place").clone();
    assert_eq!(place.quantity, quantity, "{place}");
    let complete = session.render().passes();
    assert_eq!(place.pass.saturating_sub(1), complete, "{place}");
    for threads in [2, 7] {
        let (mut other, _) = strict(sketch, settings, 200, threads);
        assert_eq!(other.not_finite(), Some(&place), "{threads} threads");
        assert!(bits(&other.render().image()) == bits(&session.render().image()));
        let again = other.advance(&Cancel::default());
        assert_eq!(again.err(), Some(PassError::NotFinite(Box::new(place.clone()))), "no pass follows");
    }
    let before = sketch.render(settings.clone(), complete as u32);
    assert!(bits(&session.render().image()) == bits(&before.image()));
    assert_eq!(before.first_not_finite().is_some(), place.pass == 0, "nothing but at the start");
    let on = sketch.render(settings.clone(), complete as u32 + 1);
    assert_eq!(on.first_not_finite(), Some(&place), "left out, and noted all the same");
    assert!(on.image().pixels.iter().all(|p| p.is_finite()));
    place
}

/// Metal of a roughness.
fn metal(alpha: f32) -> Bsdf {
    Bsdf::Conductor(Conductor {
        eta: Rgb::splat(0.2),
        k: Rgb::splat(3.0),
        specular_reflectance: Colour::Constant(Rgb::WHITE),
        roughness: Some(Microfacets::isotropic(MicrofacetDistribution::Ggx, alpha)),
    })
}

/// The same from another place.
fn seen_from(place: DVec3, mut sketch: Sketch) -> Sketch {
    sketch.0.sensors[0].to_world.translation = place;
    sketch
}

fn at(name: &str) -> Option<[String; 2]> {
    Some([name.to_owned(), name.to_owned()])
}

#[test]
fn a_photon_that_leaves_its_light_with_no_number() {
    let mut sketch = floor(grey(0.5)).point(DVec3::new(0.25, 0.5, 1.5), 5e31).point(DVec3::Z * 1.5, 5e31);
    sketch.0.emitters[0].name = "first".into();
    // Five chunks of photons: the first ones are of the first light.
    let place = first(&sketch, &with_radius(0.2, 20_000), Quantity::EmittedPower);
    assert_eq!((place.light.as_deref(), place.surface.clone(), place.pass), (Some("first"), None, 1));
    assert!((place.position - DVec3::new(0.25, 0.5, 1.5)).length() < 1e-3, "{place}");
    let words = "in pass 1 the power of a photon that leaves its light is not finite (NaN or infinite), from the light \"first\", \
                 at the point 0.25";
    assert!(place.to_string().starts_with(words), "{place}");
}

/// Interpolated normals that lean over weigh what they scatter by up to a hundred. The triangle is met by one photon in thousands, in a
/// cellar that the camera does not see; what it does see is lit by a modest lamp.
#[test]
fn a_photon_that_a_surface_scatters_in_a_later_pass() {
    let side = 0.05;
    let leaning = Mesh {
        positions: vec![DVec3::ZERO, DVec3::X * side, DVec3::Y * side],
        normals: vec![DVec3::new(0.98, 0.0, 0.2); 3],
        triangles: vec![[0, 1, 2]],
        ..Mesh::default()
    };
    let cellar = DVec3::new(0.0, 0.0, -1.0);
    let to_world = DAffine3::from_translation(cellar);
    let sketch = floor(grey(0.5))
        .shape(Geometry::Mesh(Arc::new(leaning)), to_world, grey(0.9), None)
        .point(cellar + DVec3::new(0.5, 0.0, 0.05), 1e32)
        .rectangle(DVec3::Z * 1.8, DVec3::X * 0.2, DVec3::NEG_Y * 0.2, grey(0.0), Some(Rgb::splat(5.0)));
    let place = first(&sketch, &with_radius(0.2, 2000), Quantity::ScatteredPower);
    assert!(place.pass > 1, "{place}");
    assert_eq!((place.light.as_deref(), place.surface.clone()), (Some("point"), at("shape-3")));
    let within = place.position - cellar;
    assert!(within.min_element() > -1e-3 && within.max_element() < side + 1e-3, "{place}");
    assert!(sketch.render(with_radius(0.2, 2000), 1).image().pixels.iter().any(|p| !p.is_black()));
}

#[test]
fn what_a_photon_brings_to_gloss() {
    // As heavy as photons can be; in the mirror's direction such gloss weighs them by more than one.
    let sketch = floor(metal(0.12)).point(DVec3::Z * 1.05, 7e31);
    let place = first(&sketch, &with_radius(0.05, 2000), Quantity::GatheredLight);
    assert_eq!((place.light.clone(), place.surface.clone()), (None, at("shape-1")));
    assert!(place.position.z.abs() < 1e-6 && place.position.length() < 1.0, "{place}");
}

#[test]
fn what_all_photons_together_bring_to_a_hit_point() {
    let sketch = floor(grey(0.5)).point(DVec3::Z * 1.5, 7e31);
    let place = first(&sketch, &with_radius(0.3, 2000), Quantity::Irradiance);
    assert_eq!((place.light.clone(), place.surface.clone(), place.pass), (None, at("shape-1"), 1));
    assert!(place.position.z.abs() < 1e-6 && place.position.length() < 1.0, "{place}");
}

#[test]
fn what_a_shadow_ray_brings() {
    let settings = RenderSettings {
        ppm: PpmSettings { direct_light: DirectLight::ShadowRays, ..with_radius(0.2, 2000).ppm },
        ..with_radius(0.2, 2000)
    };
    let under = DVec3::new(0.1, 0.1, 0.0);
    let lit = floor(grey(0.5)).point(under + DVec3::Z * 1e-5, 7e31);
    let sketch = seen_from(under + DVec3::Z * 2e-4, lit);
    let place = first(&sketch, &settings, Quantity::DirectLight);
    assert_eq!((place.light.as_deref(), place.surface.clone()), (Some("point"), at("shape-1")));
    assert!((place.position - under).length() < 0.02, "{place}");
}

/// Before the first pass: there is no image then.
#[test]
fn what_an_eye_path_sees() {
    // Each sample of the lamp is as bright as numbers go, and their sum is brighter.
    let tiny = DVec3::new(1e-4, 1e-4, 0.1);
    let lamp = Some(Rgb::splat(3e38));
    let sketch =
        floor(grey(0.5)).rectangle(DVec3::Z * tiny.z, DVec3::X * tiny.x, DVec3::Y * tiny.y, grey(0.0), lamp);
    let settings = RenderSettings { samples_per_pixel: number(64), ..with_radius(0.2, 2000) };
    let from = DVec3::Z * 0.1002;
    let place = first(&seen_from(from, sketch), &settings, Quantity::SeenEmission);
    assert_eq!((place.pass, &place.light, &place.surface), (0, &None, &None));
    assert!((place.position - from).length() < 1e-3, "{place}");
    assert!(place.to_string().starts_with("before the first pass the emitted light"), "{place}");
    // The highlight of a light that all but lies on smooth metal.
    let sketch = floor(metal(0.05)).point(DVec3::Z * 2e-4, 7e31);
    let mut close = seen_from(DVec3::Z * 1e-3, sketch);
    close.0.sensors[0].fov_degrees = 5.0;
    let place = first(&close, &with_radius(0.2, 2000), Quantity::SeenEmission);
    assert_eq!((place.pass, place.surface.clone()), (0, at("shape-1")));
    assert!(place.position.length() < 1e-3, "{place}");
}

/// Values that are left out leave no trace in a render that goes on; nothing is noted where there are none.
#[test]
fn a_sound_render_notes_nothing_and_strictness_changes_no_bit() {
    let sketch = floor(grey(0.5)).point(DVec3::Z * 1.5, 1.0);
    let settings = with_radius(0.2, 2000);
    let (session, cause) = strict(&sketch, &settings, 3, 2);
    assert_eq!((cause, session.render().passes()), (StopCause::Rule, 3));
    let plain: Render = sketch.render(settings, 3);
    assert!(plain.first_not_finite().is_none() && session.not_finite().is_none());
    assert!(bits(&plain.image()) == bits(&session.render().image()));
}
