//! A scene that ships is opened, edited, saved and opened again; a camera is copied as text.

use std::path::{Path, PathBuf};

use foton_edit::{
    Camera, Edit, FieldId, Make, NewThing, Property, Side, Site, Target, UpAxis, Value, camera_xml, contents,
    focus_distance, inspect, presets,
};
use foton_format::{Options, Saved, open, read_str, save_edited};
use foton_scene::Scene;
use foton_scene::description::{EmitterKind, Filter, FovAxis, SceneDescription};

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

fn find(description: &SceneDescription, name: &str) -> Target {
    contents(description)
        .into_iter()
        .find(|item| item.name == name)
        .unwrap_or_else(|| panic!("no {name}"))
        .target
}

const SITE: Site = Site { at: [0.5, 0.0, 0.25], half: 0.3, up: UpAxis::Y };

/// Saves an edited scene, checks that it reads back as what it is and as an edit of its file, and returns the text.
#[track_caller]
fn saved_as_an_edit(opened: &foton_format::Opened, edited: &SceneDescription, name: &str) -> String {
    let folder = std::env::temp_dir().join(format!("foton-editing-{name}-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let path = folder.join("edited.xml");
    let how = save_edited(opened, edited, &path);
    let (again, text) = (read(&path), std::fs::read_to_string(&path).expect("there"));
    std::fs::remove_dir_all(&folder).expect("removed");
    assert_eq!(how.expect("written"), Saved::Changed, "{text}");
    assert_eq!(again.warnings, []);
    assert_eq!(contents(&again.description), contents(edited));
    let inspected =
        |d: &SceneDescription| contents(d).iter().map(|item| inspect(d, item.target)).collect::<Vec<_>>();
    assert_eq!(inspected(&again.description), inspected(edited));
    assert!(text.contains("<!--"), "comments stay");
    text
}

/// Things that come and go are written where the file has its own, with everything else as it was.
#[test]
fn things_that_come_go_and_have_other_names_are_saved_as_edits() {
    let opened = read(&assets().join("glass-and-ring/scene.xml"));
    let original = &opened.description;
    let ring = find(original, "ring");
    let has_sky = original.emitters.iter().any(|e| matches!(e.kind, EmitterKind::Constant { .. }));
    let things = NewThing::ALL.into_iter().filter(|thing| *thing != NewThing::Sky || !has_sky);
    let edits = [
        Edit::Rename { target: ring, name: "band $5 & co".into() },
        Edit::Hide { target: ring, hide: true },
        Edit::Duplicate { target: ring, by: [1.0, 0.0, 0.0] },
        Edit::Delete(ring),
        Edit::Duplicate { target: Target::Sensor(0), by: [0.0; 3] },
    ];
    for edit in edits.into_iter().chain(things.map(|thing| Edit::Add { thing, site: SITE })) {
        saved_as_an_edit(&opened, &apply(original, &[edit]), "one");
    }
}

#[test]
fn many_edits_are_saved_together_and_a_new_material_once() {
    let opened = read(&assets().join("glass-and-ring/scene.xml"));
    let gold = presets().iter().position(|p| p.name == "gold").expect("a preset");
    let edits = [
        Edit::Delete(find(&opened.description, "ring")),
        Edit::Add { thing: NewThing::Cube, site: SITE },
        Edit::Add { thing: NewThing::SpotLight, site: SITE },
        Edit::Hide { target: Target::Emitter(0), hide: true },
    ];
    let added = apply(&opened.description, &edits);
    let cube = find(&added, "cube");
    let Target::Shape(shape) = cube else { panic!("a shape") };
    let edits = [
        Edit::Duplicate { target: cube, by: [0.0, 0.0, 1.0] },
        Edit::Remake { shape, make: Make::Preset(gold), name: "gold".into(), all: true },
        Edit::Turn { target: cube, axis: [0.0, 1.0, 0.0], radians: 0.3 },
        Edit::Scale { target: cube, factors: [1.0, 2.0, 3.0] },
        Edit::Rename { target: cube, name: "block".into() },
    ];
    let text = saved_as_an_edit(&opened, &apply(&added, &edits), "many");
    assert_eq!(
        text.matches("id=\"gold-2\"").count(),
        2,
        "one material, to which the other cube refers: {text}"
    );
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
