//! Picking, outlines, drags, fields and cameras on a small scene.

use std::sync::Arc;

use foton_math::Rgb;
use foton_math::glam::{DAffine3, DMat3, DVec2, DVec3};
use foton_scene::Scene;
use foton_scene::description::{
    Bsdf, Dielectric, Diffuse, EmitterDescription, EmitterKind, Filter, FovAxis, Geometry, Material, Mesh,
    SceneDescription, SensorDescription, ShapeDescription,
};

use super::view::View;
use super::*;

fn looking(from: DVec3, to: DVec3, up: DVec3) -> DAffine3 {
    let forward = (to - from).normalize();
    let left = up.cross(forward).normalize();
    DAffine3::from_cols(left, forward.cross(left), forward, from)
}

fn sensor(to_world: DAffine3) -> SensorDescription {
    SensorDescription {
        name: "camera".into(),
        to_world,
        fov_degrees: 50.0,
        fov_axis: FovAxis::X,
        width: 300,
        height: 200,
        crop: None,
        filter: Filter::Box { radius: 0.5 },
        near_clip: None,
        far_clip: None,
    }
}

fn shape(name: &str, geometry: Geometry, to_world: DAffine3, material: usize) -> ShapeDescription {
    ShapeDescription { name: name.into(), geometry, to_world, flip_normals: false, material, radiance: None }
}

/// A floor, a ball, a cube and a small lamp of one grey and one glass; four lights without surfaces.
fn scene() -> SceneDescription {
    let grey = Bsdf::Diffuse(Diffuse { reflectance: Rgb::splat(0.5).into() });
    let white = Rgb::WHITE.into();
    let glass = Bsdf::Dielectric(Dielectric {
        int_ior: 1.5,
        ext_ior: 1.0,
        specular_reflectance: white,
        specular_transmittance: white,
        roughness: None,
    });
    let material = |name: &str, front| Material { name: name.into(), front, back: None, opacity: None };
    let flat = DMat3::from_cols(DVec3::X * 20.0, DVec3::NEG_Z * 20.0, DVec3::Y);
    let floor = DAffine3::from_mat3(flat);
    let mut lamp = shape("lamp", Geometry::Disc, DAffine3::from_translation(DVec3::new(-2.0, 3.0, -2.0)), 0);
    lamp.radiance = Some(Rgb::new(2.0, 1.0, 0.5));
    let light = |name: &str, kind| EmitterDescription { name: name.into(), kind };
    SceneDescription {
        sensors: vec![sensor(looking(DVec3::new(1.0, 3.0, 8.0), DVec3::new(0.0, 0.5, 0.0), DVec3::Y))],
        materials: vec![material("grey", grey), material("glass", glass)],
        shapes: vec![
            shape("floor", Geometry::Mesh(Arc::new(Mesh::rectangle())), floor, 0),
            shape(
                "ball",
                Geometry::Sphere { centre: DVec3::new(0.0, 1.0, 0.0), radius: 1.0 },
                DAffine3::IDENTITY,
                1,
            ),
            shape(
                "cube",
                Geometry::Mesh(Arc::new(Mesh::cube())),
                DAffine3::from_translation(DVec3::new(3.0, 1.0, 0.0)) * DAffine3::from_rotation_y(0.3),
                0,
            ),
            lamp,
        ],
        emitters: vec![
            light(
                "bulb",
                EmitterKind::Point { position: DVec3::new(-2.0, 2.0, 0.0), intensity: Rgb::splat(3.0) },
            ),
            light(
                "key",
                EmitterKind::Spot {
                    to_world: looking(DVec3::new(2.0, 2.5, 2.0), DVec3::ZERO, DVec3::Y),
                    intensity: Rgb::new(4.0, 3.0, 2.0),
                    cutoff_degrees: 25.0,
                    beam_degrees: 15.0,
                },
            ),
            light(
                "sun",
                EmitterKind::Directional {
                    direction: DVec3::new(0.1, 0.1, 1.0),
                    irradiance: Rgb::splat(1.0),
                },
            ),
            light("sky", EmitterKind::Constant { radiance: Rgb::splat(0.1) }),
        ],
        ..SceneDescription::default()
    }
}

const BALL: Target = Target::Shape(1);
const CUBE: Target = Target::Shape(2);
const LAMP: Target = Target::Shape(3);

fn number(description: &SceneDescription, target: Target, id: FieldId) -> f64 {
    let fields = inspect(description, target).unwrap().fields;
    match fields.iter().find(|f| f.id == id).map(|f| f.value) {
        Some(Value::Number(x)) => x,
        other => panic!("{id:?} is {other:?}"),
    }
}

fn set(description: &SceneDescription, target: Target, field: FieldId, value: Value) -> SceneDescription {
    Edit::SetField { target, field, value }.apply(description).unwrap()
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-5 * a.abs().max(b.abs())
}

#[test]
fn the_view_projects_as_the_scenes_camera_looks() {
    let mut description = scene();
    for (axis, near_clip) in [(FovAxis::X, None), (FovAxis::Diagonal, Some(0.5)), (FovAxis::Smaller, None)] {
        description.sensors[0].fov_axis = axis;
        description.sensors[0].near_clip = near_clip;
        let built = Scene::build(&description).unwrap();
        let view = View::new(&description.sensors[0]);
        for film in [DVec2::new(3.0, 7.0), DVec2::new(150.0, 100.0), DVec2::new(299.0, 150.5)] {
            let ray = built.sensors()[0].ray(film.as_vec2());
            let there = built.normalisation().world_point(ray.at(500.0));
            assert!(view.project(there).unwrap().distance(film) < 1e-2);
            assert!(view.direction(film).distance(ray.direction.as_dvec3()) < 1e-6);
        }
    }
}

#[test]
fn picking_meets_what_stands_there() {
    let description = scene();
    let built = Scene::build(&description).unwrap();
    let view = View::new(&description.sensors[0]);
    for (index, name, material) in [(1, "ball", "glass"), (2, "cube", "grey")] {
        let middle = geometry::centre(&description.shapes[index]);
        let picked = pick(&built, 0, view.project(middle).unwrap().to_array()).unwrap();
        assert_eq!((picked.target, picked.name.as_str()), (Target::Shape(index), name));
        assert_eq!(picked.material, material);
        let position = DVec3::from(picked.position);
        assert!(close(picked.distance, position.distance(view.origin)));
        assert!(DVec3::from(picked.normal).dot(view.origin - position) > 0.0);
    }
    let picked = pick(&built, 0, view.project(DVec3::new(0.0, 1.0, 0.0)).unwrap().to_array()).unwrap();
    assert!(close(DVec3::from(picked.position).distance(DVec3::Y), 1.0), "on the ball");
    assert_eq!(pick(&built, 0, [150.0, 0.0]), None);
    assert_eq!(pick(&built, 7, [150.0, 100.0]), None);
}

#[test]
fn lights_without_surfaces_are_picked_by_their_markers() {
    let description = scene();
    let view = View::new(&description.sensors[0]);
    let bulb = view.project(DVec3::new(-2.0, 2.0, 0.0)).unwrap();
    let near = |d: f64| pick_light(&description, 0, (bulb + DVec2::new(d, 0.0)).to_array());
    assert_eq!(near(9.9).map(|p| p.target), Some(Target::Emitter(0)));
    assert_eq!(near(10.1), None);
    let built = Scene::build(&description).unwrap();
    let picked = pick_any(&built, &description, 0, bulb.to_array()).unwrap();
    assert_eq!((picked.name.as_str(), picked.position), ("bulb", [-2.0, 2.0, 0.0]));
    let shown: Vec<Target> = markers(&description, 0).iter().map(|(target, _)| *target).collect();
    assert_eq!(shown, [0, 1, 2].map(Target::Emitter), "the sky has no place");
    assert!(Outline::new(&description, Target::Emitter(3)).segments(&description, 0).is_empty());
}

#[test]
fn a_spheres_outline_is_where_lines_of_sight_touch_it() {
    let description = scene();
    let built = Scene::build(&description).unwrap();
    let outline = Outline::new(&description, BALL).segments(&description, 0);
    assert_eq!(outline.len(), 64);
    let middle = View::new(&description.sensors[0]).project(DVec3::Y).unwrap();
    for [a, _] in outline {
        let a = DVec2::new(f64::from(a[0]), f64::from(a[1]));
        let hits =
            |share: f64| pick(&built, 0, middle.lerp(a, share).to_array()).map(|p| p.target) == Some(BALL);
        assert!(hits(0.99) && !hits(1.01), "{a}");
    }
}

#[test]
fn a_meshs_outline_is_its_silhouette_and_its_rim() {
    let description = scene();
    let lines = |target| Outline::new(&description, target).segments(&description, 0).len();
    // Of a cube with three faces in sight six edges lie between seen and unseen ones; a diagonal never does.
    assert_eq!(lines(CUBE), 6);
    // The floor's fourth edge is behind the camera.
    assert_eq!(lines(Target::Shape(0)), 3);
    // Vertices split at creases, as files have them, are one.
    let mut split = scene();
    let cube = Mesh::cube();
    let positions = cube.triangles.iter().flatten().map(|i| cube.positions[*i as usize]).collect();
    let triangles = (0..12).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
    split.shapes[2].geometry = Geometry::Mesh(Arc::new(Mesh { positions, triangles, ..Mesh::default() }));
    assert_eq!(Outline::new(&split, CUBE).segments(&split, 0).len(), 6);
}

#[test]
fn outlines_across_the_cameras_plane_are_cut_and_finite() {
    let mut description = scene();
    for step in 0..200 {
        let t = f64::from(step) * 0.1;
        description.sensors[0] = sensor(looking(
            DVec3::new(t.sin() * 3.0, 0.2 + 0.02 * t, t.cos()),
            DVec3::new(t, 0.0, -t),
            DVec3::Y,
        ));
        for i in 0..description.shapes.len() {
            for line in Outline::new(&description, Target::Shape(i)).segments(&description, 0) {
                for [x, y] in line {
                    assert!((-301.0..=601.0).contains(&x) && (-201.0..=401.0).contains(&y), "{line:?}");
                }
            }
        }
    }
    let floor = Outline::new(&description, Target::Shape(0));
    assert!(!floor.segments(&description, 0).is_empty());
}

#[test]
fn a_drag_keeps_the_point_under_the_pointer_and_at_its_height() {
    let description = scene();
    let view = View::new(&description.sensors[0]);
    let picked = DVec3::new(0.3, 0.7, 1.0);
    let from = view.project(picked).unwrap();
    for to in [DVec2::new(20.0, 150.0), DVec2::new(250.0, 190.0), DVec2::new(150.0, 120.0)] {
        let drag = |mode| {
            let plane = DragPlane::new(&description.sensors[0], UpAxis::Y, picked.to_array(), mode);
            DVec3::from(plane.translation(from.to_array(), to.to_array()))
        };
        let by = drag(DragMode::Horizontal);
        assert!(by.y.abs() < 1e-12, "{by}");
        assert!(view.project(picked + by).unwrap().distance(to) < 1e-9);
        let by = drag(DragMode::Vertical);
        assert_eq!((by.x, by.z), (0.0, 0.0));
        assert!((view.project(picked + by).unwrap().y - to.y).abs() < 12.0, "follows up and down");
    }
}

#[test]
fn drags_are_bounded_wherever_the_pointer_and_the_camera_are() {
    let picked = DVec3::new(0.0, 0.5, 0.0);
    let height = [8.0, 0.51, 0.5, 0.0, -3.0];
    let places = height.map(|y| DVec3::new(0.0, y, 6.0)).into_iter().chain([DVec3::new(0.0, 9.0, 0.0)]);
    for from in places {
        let up = if from.z == 0.0 { DVec3::Z } else { DVec3::Y };
        let sensor = sensor(looking(from, picked, up));
        for mode in [DragMode::Horizontal, DragMode::Vertical] {
            let plane = DragPlane::new(&sensor, UpAxis::Y, picked.to_array(), mode);
            let mut furthest: f64 = 0.0;
            for to in
                [[150.0, 100.0], [150.0, -1e9], [-1e9, 99.9], [1e300, 1e300], [f64::NAN, 0.0], [150.0, 40.0]]
            {
                let by = DVec3::from(plane.translation([150.0, 100.0], to));
                assert!(by.is_finite(), "{from} {mode:?} {to:?}: {by}");
                if to[0].abs() < 1e6 && to[1].abs() < 1e6 {
                    assert!(by.length() < 62.0 * from.distance(picked), "{from} {mode:?} {to:?}: {by}");
                    furthest = furthest.max(by.length());
                }
            }
            assert!(furthest > 0.1, "{from} {mode:?}: nothing moves");
        }
    }
    let blind = DragPlane::new(&sensor(DAffine3::IDENTITY), UpAxis::Z, [0.0; 3], DragMode::Horizontal);
    assert_eq!(blind.translation([0.0, 0.0], [9.0, 9.0]), [0.0; 3]);
}

#[test]
fn moves_change_one_place_and_leave_the_rest_shared() {
    let before = scene();
    for target in [BALL, CUBE, Target::Emitter(0), Target::Emitter(1)] {
        let old = middle(&before, target).unwrap();
        let after = Edit::Move { target, by: [0.5, -0.25, 2.0] }.apply(&before).unwrap();
        let new = middle(&after, target).unwrap();
        assert!(new.distance(old + DVec3::new(0.5, -0.25, 2.0)) < 1e-12);
        let same = set(&before, target, FieldId::Position(2), Value::Number(old.z + 2.0));
        assert!(close(middle(&same, target).unwrap().z, new.z));
        let meshes = [&before, &after].map(|d| match &d.shapes[2].geometry {
            Geometry::Mesh(mesh) => Arc::as_ptr(mesh),
            _ => panic!("a mesh"),
        });
        assert_eq!(meshes[0], meshes[1]);
    }
    let fails = |target, by| Edit::Move { target, by }.apply(&before).err();
    assert_eq!(fails(Target::Emitter(3), [1.0; 3]), Some(EditError::CannotMove("sky".into())));
    assert_eq!(fails(Target::Shape(9), [1.0; 3]), Some(EditError::NoTarget));
    assert_eq!(fails(BALL, [f64::NAN, 0.0, 0.0]), Some(EditError::NotFinite));
    assert_eq!(Edit::Move { target: BALL, by: [0.0; 3] }.name(&before), "move ball");
}

#[test]
fn powers_are_those_by_which_the_scene_shares_its_photons() {
    let description = scene();
    let built = Scene::build(&description).unwrap();
    let scale2 = built.normalisation().scale().powi(2);
    for (name, target) in [("lamp", LAMP), ("bulb", Target::Emitter(0)), ("key", Target::Emitter(1))] {
        let emitter = built.emitters().iter().find(|e| e.name == name).unwrap();
        let power = f64::from(emitter.power().mean()) / scale2;
        let shown = number(&description, target, FieldId::Power);
        assert!(close(shown, power), "{name}: {shown} {power}");
        let doubled = set(&description, target, FieldId::Power, Value::Number(2.0 * shown));
        assert!(close(number(&doubled, target, FieldId::Power), 2.0 * shown));
    }
}

#[test]
fn colour_and_brightness_of_a_light_are_apart() {
    let description = scene();
    let blue = set(&description, LAMP, FieldId::LightColour, Value::Colour([0.1, 0.2, 0.5]));
    assert!(close(number(&blue, LAMP, FieldId::Brightness), 2.0));
    let dim = set(&blue, LAMP, FieldId::Brightness, Value::Number(0.5));
    let radiance = dim.shapes[3].radiance.unwrap().to_array();
    assert!(radiance.iter().zip([0.1, 0.2, 0.5]).all(|(a, b)| (a - b).abs() < 1e-6), "{radiance:?}");
}

#[test]
fn a_lights_size_keeps_its_power_and_its_place() {
    let description = scene();
    let small = set(&description, LAMP, FieldId::Radius, Value::Number(0.25));
    assert!(close(number(&small, LAMP, FieldId::Radius), 0.25));
    assert!(close(number(&small, LAMP, FieldId::Power), number(&description, LAMP, FieldId::Power)));
    assert!(close(number(&small, LAMP, FieldId::Brightness), 32.0));
    assert_eq!(middle(&small, LAMP), middle(&description, LAMP));
    let cube = set(&description, CUBE, FieldId::Size, Value::Number(4.0));
    assert!(close(number(&cube, CUBE, FieldId::Size), 4.0));
    let middles = [&cube, &description].map(|d| middle(d, CUBE).unwrap());
    assert!(middles[0].distance(middles[1]) < 1e-12);
}

#[test]
fn a_light_turns_to_where_its_angles_say() {
    let description = scene();
    for target in [Target::Emitter(1), Target::Emitter(2)] {
        let turned = set(&description, target, FieldId::Elevation, Value::Number(60.0));
        let turned = set(&turned, target, FieldId::Azimuth, Value::Number(-30.0));
        assert!(close(number(&turned, target, FieldId::Elevation), 60.0));
        assert!(close(number(&turned, target, FieldId::Azimuth), -30.0));
        assert_eq!(middle(&turned, target), middle(&description, target));
    }
}

#[test]
fn every_field_takes_what_it_offers_and_builds() {
    let description = scene();
    let targets = (0..4).map(Target::Shape).chain((0..4).map(Target::Emitter));
    for target in targets {
        for field in inspect(&description, target).unwrap().fields {
            let tried = match &field.control {
                Control::Number { min, max, .. } => {
                    assert!(
                        !field.accepts(Value::Number(f64::NAN)) && !field.accepts(Value::Number(max * 2.0))
                    );
                    vec![Value::Number(*min), Value::Number(*max)]
                }
                Control::Colour => vec![Value::Colour([0.2, 0.4, 0.6])],
                Control::Choice(options) => (0..options.len()).map(Value::Choice).collect(),
                Control::Toggle => vec![Value::Toggle(true), Value::Toggle(false)],
            };
            for value in tried {
                let after = set(&description, target, field.id, value);
                Scene::build(&after).unwrap_or_else(|e| panic!("{:?} {value:?}: {e}", field.id));
                let now = inspect(&after, target).unwrap();
                let now = now.fields.into_iter().find(|f| f.id == field.id).unwrap().value;
                match (now, value) {
                    (Value::Number(a), Value::Number(b)) => {
                        // West of south is east of it.
                        let turn = if field.id == FieldId::Azimuth { (a - b).abs() % 360.0 } else { a - b };
                        assert!(turn.abs() < 1e-3 * b.abs().max(1.0), "{:?}: {a}, not {b}", field.id);
                    }
                    (Value::Colour(_), Value::Colour(_)) => {}
                    _ => assert_eq!(now, value, "{:?}", field.id),
                }
                let wrong = Edit::SetField { target, field: field.id, value: Value::Choice(999) };
                assert!(wrong.apply(&description).is_err());
            }
        }
    }
}

#[test]
fn a_kind_of_material_offers_its_own_fields() {
    let field = |property| FieldId::Material(Side::Front, property);
    let metal = set(&scene(), BALL, field(Property::Kind), Value::Choice(4));
    let fields = inspect(&metal, BALL).unwrap().fields;
    let choice = fields.iter().find(|f| f.id == field(Property::Metal)).unwrap();
    let Control::Choice(options) = &choice.control else { panic!("a choice") };
    let chosen = options.iter().position(|o| o == "silver (Ag)").unwrap();
    assert_eq!(choice.value, Value::Choice(options.iter().position(|o| o == "gold (Au)").unwrap()));
    let silver = set(&metal, BALL, field(Property::Metal), Value::Choice(chosen));
    let silver = set(&silver, BALL, field(Property::Rough), Value::Toggle(true));
    let silver = set(&silver, BALL, field(Property::Roughness), Value::Number(0.2));
    assert!((number(&silver, BALL, field(Property::Eta(0))) - 0.155_276).abs() < 1e-6);
    let material = &silver.materials[1];
    assert_eq!(material.back, Some(material.front), "what was glass is seen from both sides");
    let custom = set(&silver, BALL, field(Property::K(2)), Value::Number(5.0));
    let fields = inspect(&custom, BALL).unwrap().fields;
    assert_eq!(fields.iter().find(|f| f.id == field(Property::Metal)).unwrap().value, Value::Choice(0));
}

#[test]
fn a_shared_material_says_so_and_can_be_made_ones_own() {
    let description = scene();
    let shared = inspect(&description, CUBE).unwrap();
    assert_eq!(shared.material, Some(MaterialUse { name: "grey".into(), shapes: 3 }));
    assert_eq!(shared.notes, ["The material \"grey\" is shared by 3 shapes."]);
    let own = Edit::OwnMaterial { shape: 2 }.apply(&description).unwrap();
    let inspection = inspect(&own, CUBE).unwrap();
    assert_eq!(inspection.material, Some(MaterialUse { name: "grey of cube".into(), shapes: 1 }));
    assert!(inspection.notes.is_empty());
    let red =
        set(&own, CUBE, FieldId::Material(Side::Front, Property::Colour), Value::Colour([0.7, 0.1, 0.1]));
    assert_eq!(format!("{:?}", red.materials[0]), format!("{:?}", description.materials[0]));
}
