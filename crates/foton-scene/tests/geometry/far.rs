//! What is too far away or too large for single precision: said by name where a scene can be rendered all the same, refused where no
//! number holds it.

use std::sync::Arc;

use foton_math::Rgb;
use foton_math::glam::{DAffine3, DMat3, DVec3};
use foton_scene::description::{
    Bitmap, EmitterDescription, EmitterKind, Mesh, SceneDescription, ShapeDescription,
};
use foton_scene::{BuildError, FarKind, Scene};

use crate::{ball, describe, mesh};

fn named(name: &str, shape: ShapeDescription) -> ShapeDescription {
    ShapeDescription { name: name.into(), ..shape }
}

/// A ball of half a metre on a square of six, seen from four metres away.
fn still_life(others: Vec<ShapeDescription>) -> SceneDescription {
    let floor = mesh(Mesh::rectangle(), DAffine3::from_scale(DVec3::splat(3.0)));
    let mut shapes = vec![named("floor", floor), named("ball", ball(DVec3::Z * 0.5, 0.5))];
    shapes.extend(others);
    let mut description = describe(shapes);
    description.sensors[0].to_world.translation = DVec3::new(0.0, -4.0, 1.0);
    description
}

fn square(name: &str, size: f64, radiance: Option<Rgb>) -> ShapeDescription {
    let to_world = DAffine3::from_scale(DVec3::splat(size));
    ShapeDescription { radiance: radiance.map(Into::into), ..named(name, mesh(Mesh::rectangle(), to_world)) }
}

fn light(name: &str, kind: EmitterKind) -> SceneDescription {
    let mut description = still_life(Vec::new());
    description.emitters.push(EmitterDescription { name: name.into(), kind });
    description
}

fn point(position: DVec3, intensity: f32) -> SceneDescription {
    light("lamp", EmitterKind::Point { position, intensity: Rgb::splat(intensity) })
}

fn far(description: &SceneDescription) -> Vec<(String, FarKind, f64)> {
    let scene = Scene::build(description).expect("what is far is no error");
    scene.far_things(0).into_iter().map(|f| (f.name, f.kind, f.times)).collect()
}

#[test]
fn what_leaves_the_rest_without_coordinates_is_named() {
    assert_eq!(far(&still_life(Vec::new())), []);
    for size in [1e15, 1e8, 1e30, 1e300] {
        let found = far(&still_life(vec![square("ground", size, None)]));
        let [(name, FarKind::Surfaces(0), times)] = &found[..] else { panic!("{size}: {found:?}") };
        // The floor's farthest side is seven metres from the camera, along y. Of numbers beyond all others nothing is left.
        assert!(name == "ground" && (size > 1e20 || (times / (size / 7.0) - 1.0).abs() < 0.2), "{times}");
    }
    let dome =
        ShapeDescription { radiance: Some(Rgb::WHITE.into()), ..named("dome", ball(DVec3::ZERO, 1e20)) };
    let wall = square("wall", 2e20, None);
    let [(name, FarKind::Surfaces(1), _)] = &far(&still_life(vec![wall, dome]))[..] else { panic!("both") };
    assert_eq!(name, "dome");
    // A ground of ten thousand times the view, or a dome alone, is nothing to warn of.
    assert_eq!(far(&still_life(vec![square("ground", 1e5, None)])), []);
    let mut alone = describe(vec![ball(DVec3::ZERO, 1e20)]);
    alone.shapes[0].radiance = Some(Rgb::WHITE.into());
    assert_eq!(far(&alone), []);
}

#[test]
fn lamps_that_hardly_a_photon_leaves_for_the_scene_are_named() {
    let lamp = |size: f64| far(&still_life(vec![square("panel", size, Some(Rgb::WHITE))]));
    assert_eq!(lamp(100.0), []);
    let found = lamp(1e5);
    assert!(matches!(&found[..], [(name, FarKind::Lamp, _)] if name == "panel"), "{found:?}");
    // Something small before the lens is no scene beside which the room is far.
    let speck = named("speck", ball(DVec3::new(0.0, -3.9999, 1.0), 1e-5));
    assert_eq!(far(&still_life(vec![speck, square("panel", 2.0, Some(Rgb::WHITE))])), []);
}

#[test]
fn lights_and_cameras_far_away_are_named_with_the_light_that_would_do() {
    assert_eq!(far(&point(DVec3::new(3.0, -40.0, 100.0), 9.0)), []);
    let found = far(&point(DVec3::new(0.0, 0.0, 1e5), 3e10));
    let [(name, FarKind::Light { chance, irradiance, direction }, times)] = &found[..] else {
        panic!("{found:?}")
    };
    // Half the diagonal of 6 x 6 x 1; the middle is half a metre up.
    let radius = 73f64.sqrt() / 2.0;
    assert_eq!(name, "lamp");
    assert!((times / (1e5 / radius) - 1.0).abs() < 1e-3, "{times}");
    assert!((chance / (0.25 * (radius / 1e5).powi(2)) - 1.0).abs() < 1e-3, "{chance}");
    assert!(
        (irradiance.g / 3.0 - 1.0).abs() < 1e-3 && direction.z < -0.999_999,
        "{irradiance:?} {direction}"
    );
    // A narrow beam may hit from there, but not from where its directions are metres apart.
    let spot = |distance: f64, cutoff_degrees: f64| {
        let turn = DMat3::from_cols(DVec3::X, DVec3::NEG_Y, DVec3::NEG_Z);
        let to_world = DAffine3::from_mat3_translation(turn, DVec3::Z * distance);
        let intensity = Rgb::splat(1e12);
        far(&light(
            "spot",
            EmitterKind::Spot { to_world, intensity, cutoff_degrees, beam_degrees: 0.0, texture: None },
        ))
    };
    assert_eq!(spot(1e4, 0.1), []);
    assert!(matches!(&spot(1e4, 60.0)[..], [(name, FarKind::Light { .. }, _)] if name == "spot"));
    assert!(matches!(&spot(1e7, 1e-4)[..], [(name, FarKind::Light { .. }, _)] if name == "spot"));
    let mut distant = still_life(Vec::new());
    distant.sensors[0].to_world.translation.x = 1e7;
    assert!(matches!(&far(&distant)[..], [(name, FarKind::Camera, _)] if name == "camera"));
}

fn refused(description: &SceneDescription) -> BuildError {
    Scene::build(description).err().expect("no number holds that")
}

#[test]
fn what_no_number_holds_is_refused_by_name_and_with_what_would_do() {
    // Each light as bright as a number can be; what may be emitted is a millionth of what has the largest number's power.
    let up = DVec3::Z;
    let bright = Rgb::splat(3e38);
    let sky = Bitmap::new(4, 2, vec![Rgb::splat(3e8); 8]);
    let kinds = [
        EmitterKind::Point { position: up, intensity: bright },
        EmitterKind::Constant { radiance: bright },
        EmitterKind::Directional { direction: -up, irradiance: bright },
        EmitterKind::Spot {
            to_world: DAffine3::from_translation(up),
            intensity: bright,
            cutoff_degrees: 40.0,
            beam_degrees: 20.0,
            texture: None,
        },
        EmitterKind::Environment { to_world: DAffine3::IDENTITY, bitmap: Arc::new(sky), scale: 1e30 },
    ];
    let mut scenes: Vec<_> = kinds.into_iter().map(|kind| light("lamp", kind)).collect();
    scenes.push(still_life(vec![square("lamp", 0.5, Some(bright))]));
    for description in scenes {
        let BuildError::TooBright { name, emission, most } = refused(&description) else {
            panic!("{:?}", description.emitters)
        };
        assert!(name == "lamp" && (emission / 3e38 - 1.0).abs() < 1e-6, "{emission}");
        // What is said to do does, and ten million times as much does not.
        for (factor, sound) in [(1.0, true), (1e7, false)] {
            let fit = (most * factor / emission) as f32;
            let mut fitted = description.clone();
            if let Some(shape) = fitted.shapes.get_mut(2) {
                shape.radiance = Some((bright * fit).into());
            }
            for emitter in &mut fitted.emitters {
                match &mut emitter.kind {
                    EmitterKind::Point { intensity: e, .. }
                    | EmitterKind::Spot { intensity: e, .. }
                    | EmitterKind::Constant { radiance: e }
                    | EmitterKind::Directional { irradiance: e, .. } => *e *= fit,
                    EmitterKind::Environment { scale, .. } => *scale *= fit,
                    other => panic!("{other:?}"),
                }
            }
            assert_eq!(Scene::build(&fitted).is_ok(), sound, "{most} of {:?}", fitted.emitters);
        }
    }
    // A watt in a scene of ten to the thirty metres.
    let mut vast = point(DVec3::Z * 2e30, 1.0);
    vast.shapes[0].to_world = DAffine3::from_scale(DVec3::splat(1e30));
    assert!(
        matches!(refused(&vast), BuildError::TooDim { name, least, .. } if name == "lamp" && least > 1e15)
    );
    for far in [1e25, 1e60, 1e300] {
        let refusal = refused(&point(DVec3::X * far, 1.0));
        assert!(matches!(refusal, BuildError::TooFar { name, times } if name == "lamp" && times > 1e20));
        let mut distant = still_life(Vec::new());
        distant.sensors[0].to_world.translation.x = far;
        assert!(matches!(refused(&distant), BuildError::TooFar { name, .. } if name == "camera"));
    }
}
