//! Edits of a scene that takes long to build.

use std::sync::Arc;

use foton_edit::DragMode;
use foton_integrator::{Cancel, RenderSettings};
use foton_math::Rgb;
use foton_math::glam::{DAffine3, DVec3};
use foton_scene::Scene;
use foton_scene::description::{
    Bsdf, Diffuse, EmitterDescription, EmitterKind, Filter, FovAxis, Geometry, Material, Mesh,
    SceneDescription, SensorDescription, ShapeDescription,
};

use super::super::command::Source;
use super::super::loader::{Loaded, Ready};
use super::{Effect, Stage};
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
            crop: None,
            filter: Filter::Box { radius: 0.5 },
            near_clip: None,
            far_clip: None,
        }],
        materials: vec![Material { name: "grey".into(), front: grey, back: Some(grey), opacity: None }],
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

/// A stage on which the wall is chosen, and what gives up its builds.
fn stage() -> (Stage, [Cancel; 2]) {
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
    let cancels = [Cancel::default(), Cancel::default()];
    let ready = Ready { source: Source::BuiltIn("wall".into()), loaded, scene, findings: Vec::new() };
    let mut stage = Stage::new(ready, cancels.clone());
    stage.choose(0, Some([32.0, 32.0]));
    assert!(stage.selection(0).is_some(), "the wall is in the middle");
    (stage, cancels)
}

/// How high the wall stands.
fn height(stage: &Stage) -> f64 {
    let scene = stage.scene();
    scene.normalisation().world_point(scene.bounds().centre()).y
}

#[test]
fn an_edit_whose_build_is_given_up_is_built_later() {
    let (mut stage, [cancel, _]) = stage();
    let before = height(&stage);
    cancel.request();
    let effect = stage.nudge(0, [0.0, 20.0], DragMode::Vertical);
    assert_eq!(effect, Ok(Effect::Anew));
    assert!(stage.is_stale() && stage.facts().undo.is_some(), "the edit is there, its scene is not");
    assert_eq!(stage.freshen(), Ok(false), "given up again");
    cancel.rearm();
    assert_eq!(stage.freshen(), Ok(true));
    assert!(!stage.is_stale() && (height(&stage) - before).abs() > 0.01, "{before} {}", height(&stage));
    // A step back is built as the step was.
    cancel.request();
    assert_eq!(stage.undo(), Ok(Effect::Anew));
    assert!(stage.is_stale());
    cancel.rearm();
    assert_eq!(stage.freshen(), Ok(true));
    assert!((height(&stage) - before).abs() < 1e-6);
}

#[test]
fn an_edit_of_which_no_scene_can_be_made_is_taken_back_when_it_is_built_later() {
    let (mut stage, [cancel, _]) = stage();
    let before = height(&stage);
    cancel.request();
    assert_eq!(stage.nudge(0, [0.0, 20.0], DragMode::Vertical), Ok(Effect::Anew));
    // Fields refuse this; the builder does, too.
    let mut wrong = SceneDescription::clone(stage.history.current());
    wrong.shapes[0].material = 7;
    stage.history.record("a material that is not there", wrong);
    stage.refresh();
    cancel.rearm();
    assert!(stage.freshen().is_err_and(|message| message.contains("material")));
    assert_eq!(stage.freshen(), Ok(true));
    assert!(!stage.is_stale() && (height(&stage) - before).abs() < 1e-6);
    assert!(stage.is_as_opened());
}

#[test]
fn a_click_is_for_the_scene_as_it_is_edited() {
    let (mut stage, [cancel, quit]) = stage();
    cancel.request();
    // By more than its height: nothing is in the middle any more.
    assert_eq!(stage.nudge(0, [0.0, 64.0], DragMode::Vertical), Ok(Effect::Anew));
    assert!(stage.is_stale());
    stage.choose(0, Some([32.0, 32.0]));
    assert!(!stage.is_stale() && stage.selection(0).is_none(), "built for the click");
    // Unless the window is closed.
    cancel.request();
    assert_eq!(stage.undo(), Ok(Effect::Anew));
    quit.request();
    stage.choose(0, Some([32.0, 32.0]));
    assert!(stage.is_stale());
}
