//! Adding, copying, renaming, hiding and deleting things; other materials.

use super::*;

fn names(description: &SceneDescription) -> Vec<String> {
    contents(description).into_iter().map(|item| item.name).collect()
}

fn apply(description: &SceneDescription, edit: Edit) -> SceneDescription {
    edit.apply(description).unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn the_list_has_everything_once_with_its_kind() {
    let items = contents(&scene());
    let seen: Vec<_> = items.iter().map(|i| (i.name.as_str(), i.is_light)).collect();
    let lights = ["lamp", "bulb", "key", "sun", "sky"].map(|name| (name, true));
    let expected: Vec<_> = [("floor", false), ("ball", false), ("cube", false)]
        .into_iter()
        .chain(lights)
        .chain([("camera", false)])
        .collect();
    assert_eq!(seen, expected);
    assert!(items.iter().all(|i| !i.kind.is_empty() && !i.is_hidden));
}

#[test]
fn names_stay_unique() {
    let description = scene();
    let again = apply(&description, Edit::Duplicate { target: BALL, by: [1.0, 0.0, 0.0] });
    let third = apply(&again, Edit::Duplicate { target: Target::Shape(4), by: [1.0, 0.0, 0.0] });
    assert_eq!([&again.shapes[4].name, &third.shapes[5].name], ["ball-2", "ball-3"]);
    assert!(anchor(&again, Target::Shape(4)).unwrap().distance(DVec3::new(1.0, 1.0, 0.0)) < 1e-12);
    let rename = |name: &str| Edit::Rename { target: BALL, name: name.into() }.apply(&description);
    assert_eq!(rename(" pearl ").unwrap().shapes[1].name, "pearl");
    assert_eq!(rename("ball").unwrap().shapes[1].name, "ball");
    assert_eq!(rename("cube").err(), Some(EditError::NameTaken("cube".into())));
    assert_eq!(
        rename("glass").err(),
        Some(EditError::NameTaken("glass".into())),
        "materials have names, too"
    );
    assert!(matches!(rename("  ").err(), Some(EditError::BadName(_))));
    assert!(matches!(rename(&"x".repeat(201)).err(), Some(EditError::BadName(_))));
}

#[test]
fn what_is_deleted_is_gone_and_what_is_hidden_stays_hidden() {
    let hidden = apply(&scene(), Edit::Hide { target: CUBE, hide: true });
    assert!(contents(&hidden).iter().find(|i| i.name == "cube").unwrap().is_hidden);
    let deleted = apply(&hidden, Edit::Delete(BALL));
    assert!(!names(&deleted).contains(&"ball".to_owned()));
    let items = contents(&deleted);
    let is_hidden: Vec<_> = items.iter().filter(|i| i.is_hidden).map(|i| i.name.as_str()).collect();
    assert_eq!(is_hidden, ["cube"]);
    let shown = apply(&deleted, Edit::Hide { target: Target::Shape(1), hide: false });
    assert!(contents(&shown).iter().all(|i| !i.is_hidden));
    let without_light = (0..4).fold(deleted, |d, _| apply(&d, Edit::Delete(Target::Emitter(0))));
    let dark = apply(&without_light, Edit::Delete(Target::Shape(2)));
    assert!(Scene::build(&dark).is_ok(), "a scene without light is one");
    assert_eq!(Edit::Delete(Target::Sensor(0)).apply(&dark).err(), Some(EditError::LastCamera));
    assert_eq!(Edit::Delete(Target::Shape(9)).apply(&dark).err(), Some(EditError::NoTarget));
}

#[test]
fn a_hidden_shape_or_light_is_not_in_the_scene() {
    let description = scene();
    let middle = [150.0, 100.0];
    let seen = |d: &SceneDescription| pick(&Scene::build(d).unwrap(), 0, middle).map(|p| p.name);
    assert_eq!(seen(&description).as_deref(), Some("ball"));
    let hidden = apply(&description, Edit::Hide { target: BALL, hide: true });
    assert_eq!(seen(&hidden).as_deref(), Some("floor"));
    let emitters = |d: &SceneDescription| Scene::build(d).unwrap().census().emitters;
    let dim = apply(&hidden, Edit::Hide { target: Target::Emitter(0), hide: true });
    let dimmer = apply(&dim, Edit::Hide { target: LAMP, hide: true });
    assert_eq!([&hidden, &dim, &dimmer].map(emitters), [5, 4, 3]);
}

#[test]
fn what_is_added_stands_where_it_is_to_and_lights_it() {
    for up in [UpAxis::Y, UpAxis::Z] {
        let site = Site { at: [1.0, 2.0, 3.0], half: 0.5, up };
        for thing in NewThing::ALL {
            let mut description = scene();
            description.emitters.pop();
            let (next, made) = Edit::Add { thing, site }.apply_and_select(&description).unwrap();
            let made = made.unwrap();
            assert!(Scene::build(&next).is_ok(), "{thing:?}");
            let inspection = inspect(&next, made).unwrap();
            assert!(!inspection.fields.is_empty(), "{thing:?}");
            let item = contents(&next).into_iter().find(|i| i.target == made).unwrap();
            assert_eq!(item.is_light, thing.is_light(), "{thing:?}");
            if let Some(middle) = anchor(&next, made) {
                let above = up.vector().dot(middle - DVec3::from(site.at));
                assert!(above > 0.0, "{thing:?}: {above}");
            }
        }
    }
    let full = Edit::Add { thing: NewThing::Sky, site: Site { at: [0.0; 3], half: 1.0, up: UpAxis::Y } };
    assert_eq!(full.apply(&scene()).err(), Some(EditError::OneSky));
    assert_eq!(
        Edit::Duplicate { target: Target::Emitter(3), by: [0.0; 3] }.apply(&scene()).err(),
        Some(EditError::OneSky)
    );
}

#[test]
fn an_imported_model_stands_on_its_site_with_its_materials() {
    let (description, mut model) = (scene(), scene());
    model.shapes.drain(..2);
    let site = Site { at: [5.0, 1.0, 0.0], half: 1.0, up: UpAxis::Y };
    let edit = Edit::Import { name: "model.obj".into(), from: Arc::new(model), site };
    let (next, made) = edit.apply_and_select(&description).unwrap();
    assert_eq!(made, Some(Target::Shape(4)));
    assert_eq!((next.shapes[4].name.as_str(), next.shapes[5].name.as_str()), ("cube-2", "lamp-2"));
    assert_eq!(next.materials[next.shapes[4].material].name, "grey-2");
    assert!(Scene::build(&next).is_ok());
    assert_eq!(next.emitters.len(), description.emitters.len());
}

#[test]
fn another_material_has_a_name_of_its_own_and_is_for_one_shape_or_all() {
    let description = scene();
    let gold = presets().iter().position(|p| p.name == "gold").unwrap();
    let remake = |name: &str, all| {
        apply(&description, Edit::Remake { shape: 0, make: Make::Preset(gold), name: name.into(), all })
    };
    let material_of = |d: &SceneDescription, i: usize| d.materials[d.shapes[i].material].name.clone();
    let one = remake("gold", false);
    assert_eq!((material_of(&one, 0), material_of(&one, 2)), ("gold".into(), "grey".into()));
    let all = remake("gold", true);
    assert_eq!((material_of(&all, 0), material_of(&all, 2)), ("gold".into(), "gold".into()));
    assert_eq!(material_of(&remake("glass", false), 0), "glass-2");
    let mirror =
        Edit::Remake { shape: 1, make: Make::Kind(Side::Front, 4), name: "metal".into(), all: false };
    let mirror = apply(&description, mirror);
    assert!(matches!(mirror.materials[mirror.shapes[1].material].front, Bsdf::Conductor(_)));
    assert!(matches!(mirror.materials[1].front, Bsdf::Dielectric(_)), "the old one stays");
}

#[test]
fn every_preset_builds_and_has_a_name_of_its_own() {
    let all = presets();
    for (i, preset) in all.iter().enumerate() {
        assert!(all[..i].iter().all(|other| other.name != preset.name), "{}", preset.name);
        let edit = Edit::Remake { shape: 1, make: Make::Preset(i), name: preset.name.into(), all: true };
        assert!(Scene::build(&apply(&scene(), edit)).is_ok(), "{}", preset.name);
    }
    assert_eq!(all.len(), 12);
}

#[test]
fn a_camera_is_resized_and_faces_the_scene_along_the_axes() {
    let description = scene();
    let camera = Target::Sensor(0);
    let wide = set(&description, camera, FieldId::Width, Value::Number(640.0));
    assert_eq!((wide.sensors[0].width, wide.sensors[0].height), (640, 200));
    assert!(matches!(
        Edit::SetField { target: camera, field: FieldId::Height, value: Value::Number(0.0) }
            .apply(&description),
        Err(EditError::BadValue(..))
    ));
    let ways = [DVec3::NEG_Z, DVec3::NEG_X, DVec3::NEG_Y];
    for (side, way) in ViewSide::ALL.into_iter().zip(ways) {
        let mut moved = Camera::new(&description.sensors[0], 8.0);
        let (target, distance) = (DVec3::from(moved.target), moved.distance);
        moved.face(side);
        let to_world = moved.to_world();
        assert!(to_world.matrix3.z_axis.distance(way) < 1e-9, "{side:?}: {}", to_world.matrix3.z_axis);
        assert!((to_world.translation + way * distance).distance(target) < 1e-9);
    }
}
