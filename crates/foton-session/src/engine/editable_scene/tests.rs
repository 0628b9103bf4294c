//! Edits of a scene that takes long to build.

use std::sync::Arc;

use foton_edit::DragMode;
use foton_integrator::RenderSettings;
use foton_math::Rgb;
use foton_math::glam::{DAffine3, DVec3};
use foton_scene::Scene;
use foton_scene::description::{
    Bsdf, Diffuse, EmitterDescription, EmitterKind, Filter, FovAxis, Geometry, Material, Mesh,
    SceneDescription, SensorDescription, ShapeDescription,
};

use super::{EditableScene, Effect};
use crate::engine::cancels::Cancels;
use crate::engine::command::Source;
use crate::engine::loader::{Loaded, Ready};
use crate::metadata::SceneIdentity;

/// A wall of many triangles before the camera, and a lamp.
fn wall() -> SceneDescription {
    const SIDE: u32 = 80;
    let corner = |i: u32| {
        DVec3::new(f64::from(i % (SIDE + 1)), f64::from(i / (SIDE + 1)), 0.0) / f64::from(SIDE) - 0.5
    };
    let square = |i: u32| {
        let first = i % SIDE + i / SIDE * (SIDE + 1);
        [[first, first + 1, first + SIDE + 2], [first, first + SIDE + 2, first + SIDE + 1]]
    };
    let mesh = Mesh {
        positions: (0..(SIDE + 1).pow(2)).map(corner).collect(),
        triangles: (0..SIDE * SIDE).flat_map(square).collect(),
        ..Mesh::default()
    };
    let grey = Bsdf::Diffuse(Diffuse { reflectance: Rgb::splat(0.5).into() });
    SceneDescription {
        sensors: vec![SensorDescription {
            name: "camera".into(),
            to_world: DAffine3::from_translation(DVec3::new(0.0, 0.0, -3.0)),
            fov_degrees: 40.0,
            fov_axis: FovAxis::X,
            width: 64,
            height: 64,
            filter: Filter::Box { radius: 0.5 },
            ..SensorDescription::default()
        }],
        materials: vec![Material {
            name: "grey".into(),
            front: grey,
            back: Some(grey),
            ..Material::default()
        }],
        shapes: vec![ShapeDescription {
            name: "wall".into(),
            geometry: Geometry::Mesh(Arc::new(mesh)),
            to_world: DAffine3::IDENTITY,
            flip_normals: false,
            material: 0,
            radiance: None,
        }],
        emitters: vec![EmitterDescription {
            name: "lamp".into(),
            kind: EmitterKind::Point { position: DVec3::new(0.0, 9.0, -2.0), intensity: Rgb::WHITE },
        }],
        ..SceneDescription::default()
    }
}

/// A scene in which the wall is chosen, and what gives up its builds.
fn wall_scene() -> (EditableScene, Cancels) {
    let description = wall();
    let scene = Arc::new(Scene::build(&description).expect("sound"));
    let loaded = Loaded {
        files: Vec::new(),
        description,
        identity: SceneIdentity { name: "wall".into(), hash: 1 },
        settings: RenderSettings::default(),
        warnings: Vec::new(),
        origin: Arc::new(()),
    };
    let cancels = Cancels::default();
    let ready = Ready { source: Source::BuiltIn("wall".into()), loaded, scene, findings: Vec::new() };
    let mut scene = EditableScene::new(ready, cancels.clone());
    scene.choose(0, Some([32.0, 32.0]));
    assert!(scene.selection(0).is_some(), "the wall is in the middle");
    (scene, cancels)
}

/// How high the wall stands.
fn height(scene: &EditableScene) -> f64 {
    let built = scene.scene();
    built.normalisation().world_point(built.bounds().centre()).y
}

#[test]
fn an_edit_whose_build_is_given_up_is_built_later() {
    let (mut scene, cancels) = wall_scene();
    let before = height(&scene);
    cancels.work.request();
    let effect = scene.nudge(0, [0.0, 20.0], DragMode::Vertical);
    assert_eq!(effect, Ok(Effect::Restart));
    assert!(scene.is_stale() && scene.facts().undo.is_some(), "the edit is there, its scene is not");
    assert_eq!(scene.freshen(), Ok(false), "given up again");
    cancels.work.rearm();
    assert_eq!(scene.freshen(), Ok(true));
    assert!(!scene.is_stale() && (height(&scene) - before).abs() > 0.01, "{before} {}", height(&scene));
    // A step back is built as the step was.
    cancels.work.request();
    assert_eq!(scene.undo(), Ok(Effect::Restart));
    assert!(scene.is_stale());
    cancels.work.rearm();
    assert_eq!(scene.freshen(), Ok(true));
    assert!((height(&scene) - before).abs() < 1e-6);
}

#[test]
fn an_edit_of_which_no_scene_can_be_made_is_taken_back_when_it_is_built_later() {
    let (mut scene, cancels) = wall_scene();
    let before = height(&scene);
    cancels.work.request();
    assert_eq!(scene.nudge(0, [0.0, 20.0], DragMode::Vertical), Ok(Effect::Restart));
    // Fields refuse this; the builder does, too.
    let mut wrong = SceneDescription::clone(scene.history.current());
    wrong.shapes[0].material = 7;
    scene.history.record("a material that is not there", wrong);
    scene.refresh();
    cancels.work.rearm();
    assert!(scene.freshen().is_err_and(|message| message.contains("material")));
    assert_eq!(scene.freshen(), Ok(true));
    assert!(!scene.is_stale() && (height(&scene) - before).abs() < 1e-6);
    assert!(scene.is_as_opened());
}

#[test]
fn a_click_is_for_the_scene_as_it_is_edited() {
    let (mut scene, cancels) = wall_scene();
    cancels.work.request();
    // By more than its height: nothing is in the middle any more.
    assert_eq!(scene.nudge(0, [0.0, 64.0], DragMode::Vertical), Ok(Effect::Restart));
    assert!(scene.is_stale());
    scene.choose(0, Some([32.0, 32.0]));
    assert!(!scene.is_stale() && scene.selection(0).is_none(), "built for the click");
    // Unless the window is closed.
    cancels.work.request();
    assert_eq!(scene.undo(), Ok(Effect::Restart));
    cancels.quit.request();
    scene.choose(0, Some([32.0, 32.0]));
    assert!(scene.is_stale());
}
