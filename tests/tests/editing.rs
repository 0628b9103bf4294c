//! A scene that ships is opened, edited, saved and opened again; a camera is copied as text.

use std::path::{Path, PathBuf};

use foton_edit::{Camera, Edit, FieldId, Property, Side, Target, Value, camera_xml, focus_distance, inspect};
use foton_format::{Options, Saved, open, read_str, save_edited};
use foton_scene::Scene;
use foton_scene::description::{Filter, FovAxis, SceneDescription};

fn assets() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../assets")
}

fn read(path: &Path) -> foton_format::Opened {
    open(path, &Options::default()).unwrap_or_else(|e| panic!("{e}"))
}

fn apply(description: &SceneDescription, edits: &[Edit]) -> SceneDescription {
    edits
        .iter()
        .fold(description.clone(), |d, edit| edit.apply(&d).unwrap_or_else(|e| panic!("{edit:?}: {e}")))
}

#[test]
fn the_scene_that_ships_is_edited_and_saved() {
    let opened = read(&assets().join("glass-and-ring/scene.xml"));
    let find = |name: &str| {
        Target::Shape(opened.description.shapes.iter().position(|s| s.name == name).expect("it is there"))
    };
    let scene = Scene::build(&opened.description).expect("builds");
    let mut camera = Camera::new(&opened.description.sensors[0], focus_distance(&scene, 0));
    camera.orbit(0.3, -0.1);
    let field = |p| FieldId::Material(Side::Front, p);
    let set = |target, field, value| Edit::SetField { target, field, value };
    let Target::Shape(ball) = find("ball") else { panic!("a shape") };
    let edited = apply(
        &opened.description,
        &[
            Edit::Move { target: find("ring"), by: [0.25, 0.0, -1.0 / 3.0] },
            Edit::Move { target: find("ball"), by: [0.1, 0.2, 0.3] },
            set(find("ball"), FieldId::Radius, Value::Number(0.6)),
            Edit::OwnMaterial { shape: ball },
            set(find("ball"), field(Property::Parameter("int_ior")), Value::Number(2.42)),
            set(find("ring"), field(Property::Kind), Value::Choice(4)),
            set(
                find("gem"),
                field(Property::Parameter("specular_transmittance")),
                Value::Colour([0.4, 0.6, 1.0]),
            ),
            set(find("lamp"), FieldId::Radius, Value::Number(0.1)),
            set(find("overhead"), FieldId::Power, Value::Number(10.0)),
            set(Target::Emitter(0), FieldId::Cutoff, Value::Number(25.0)),
            Edit::Look { sensor: 0, camera: Box::new(camera) },
        ],
    );
    let folder = std::env::temp_dir().join(format!("foton-editing-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let path = folder.join("edited.xml");
    let saved = save_edited(&opened, &edited, &path);
    let again = read(&path);
    std::fs::remove_dir_all(&folder).expect("removed");
    assert_eq!(saved.expect("written"), Saved::Changed);
    assert_eq!(again.warnings, []);
    let inspections = |d: &SceneDescription| {
        let shapes = (0..d.shapes.len()).map(Target::Shape);
        shapes.chain([Target::Emitter(0)]).map(|t| inspect(d, t)).collect::<Vec<_>>()
    };
    assert_eq!(inspections(&again.description), inspections(&edited));
    assert_eq!(again.description.sensors[0].to_world, edited.sensors[0].to_world);
}

#[test]
fn a_copied_camera_reads_back_to_the_last_bit() {
    let scene = read(&assets().join("ring/scene.xml")).description;
    let mut sensor = scene.sensors[0].clone();
    let mut camera = Camera::new(&sensor, 3.0);
    camera.orbit(0.123, 0.0456);
    camera.pan(&sensor, 1e-7, 3e5);
    sensor = camera.applied_to(&sensor);
    let filters =
        [Filter::Box { radius: 0.5 }, Filter::Tent { radius: 1.1 }, Filter::Gaussian { stddev: 0.3 }];
    let axes = [FovAxis::X, FovAxis::Smaller, FovAxis::Diagonal];
    for ((filter, fov_axis), near_clip) in filters.into_iter().zip(axes).zip([None, Some(0.1), Some(1e-9)]) {
        sensor.filter = filter;
        sensor.fov_axis = fov_axis;
        sensor.near_clip = near_clip;
        let xml = format!("<scene version=\"3.0.0\">{}</scene>", camera_xml(&sensor));
        let none = |_: &Path| Err(std::io::ErrorKind::NotFound.into());
        let opened = read_str("copied", &xml, &none, &Options::default()).expect("reads back");
        assert_eq!(opened.warnings, []);
        let mut again = opened.description.sensors[0].clone();
        again.name.clone_from(&sensor.name);
        assert_eq!(format!("{again:?}"), format!("{sensor:?}"));
    }
}
