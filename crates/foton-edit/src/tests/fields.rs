//! The inspector's fields: what they show, and what setting them does.

use super::*;
use foton_scene::description::Coating;

use foton_scene::description::{Colour, Conductor, Microfacets, Number, Principled};

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
    let Some(Colour::Constant(radiance)) = dim.shapes[3].radiance else { panic!("it emits") };
    let radiance = radiance.to_array();
    assert!(radiance.iter().zip([0.1, 0.2, 0.5]).all(|(a, b)| (a - b).abs() < 1e-6), "{radiance:?}");
}

#[test]
fn a_lights_size_keeps_its_power_and_its_place() {
    let description = scene();
    let small = set(&description, LAMP, FieldId::Radius, Value::Number(0.25));
    assert!(close(number(&small, LAMP, FieldId::Radius), 0.25));
    assert!(close(number(&small, LAMP, FieldId::Power), number(&description, LAMP, FieldId::Power)));
    assert!(close(number(&small, LAMP, FieldId::Brightness), 32.0));
    assert_eq!(anchor(&small, LAMP), anchor(&description, LAMP));
    let cube = set(&description, CUBE, FieldId::Size, Value::Number(4.0));
    assert!(close(number(&cube, CUBE, FieldId::Size), 4.0));
    let middles = [&cube, &description].map(|d| anchor(d, CUBE).unwrap());
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
        assert_eq!(anchor(&turned, target), anchor(&description, target));
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
                        let is_turn = matches!(field.id, FieldId::Azimuth | FieldId::Rotation(_));
                        let turn = if is_turn { (a - b).abs() % 360.0 } else { a - b };
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
    let choice = fields.iter().find(|f| f.id == field(Property::Parameter("material"))).unwrap();
    let Control::Choice(options) = &choice.control else { panic!("a choice") };
    let chosen = options.iter().position(|o| o == "silver (Ag)").unwrap();
    assert_eq!(choice.value, Value::Choice(options.iter().position(|o| o == "gold (Au)").unwrap()));
    let silver = set(&metal, BALL, field(Property::Parameter("material")), Value::Choice(chosen));
    let silver = set(&silver, BALL, field(Property::Rough), Value::Toggle(true));
    let silver = set(&silver, BALL, field(Property::Parameter("alpha")), Value::Number(0.2));
    assert!((number(&silver, BALL, field(Property::Channel("eta", 0))) - 0.155_276).abs() < 1e-6);
    let material = &silver.materials[1];
    assert_eq!(material.back, Some(material.front), "what was glass is seen from both sides");
    let custom = set(&silver, BALL, field(Property::Channel("k", 2)), Value::Number(5.0));
    let fields = inspect(&custom, BALL).unwrap().fields;
    assert_eq!(
        fields.iter().find(|f| f.id == field(Property::Parameter("material"))).unwrap().value,
        Value::Choice(0)
    );
}

#[test]
fn a_number_that_comes_from_a_texture_is_no_field_until_its_kind_changes() {
    let field = |property| FieldId::Material(Side::Front, property);
    let mut metal = set(&scene(), BALL, field(Property::Kind), Value::Choice(4));
    let textured = Microfacets { alpha_v: Number::Texture(0), ..Microfacets::PRESET };
    if let Bsdf::Conductor(Conductor { roughness, .. }) = &mut metal.materials[1].front {
        *roughness = Some(textured);
    }
    let inspection = inspect(&metal, BALL).unwrap();
    let has = |name| inspection.fields.iter().any(|f| f.id == field(Property::Parameter(name)));
    assert!(has("alpha_u") && !has("alpha_v") && has("distribution"));
    assert!(inspection.notes.iter().any(|n| n == "Values that come from textures cannot be edited here."));
    let glass = set(&metal, BALL, field(Property::Kind), Value::Choice(1));
    let Bsdf::Dielectric(glass) = glass.materials[1].front else { panic!("glass") };
    assert_eq!(glass.roughness, Some(textured), "it keeps its roughness");
}

#[test]
fn a_coating_has_fields_of_its_own_and_both_sides_keep_it_alike() {
    let bare = set(&scene(), BALL, FieldId::Material(Side::Front, Property::Kind), Value::Choice(0));
    let coat = FieldId::Material(Side::Coating, Property::Coated);
    let coated = set(&bare, BALL, coat, Value::Toggle(true));
    assert_eq!(coated.materials[1].coatings, [Some(Coating::default(false)); 2]);
    let uncoated = set(&coated, BALL, coat, Value::Toggle(false));
    assert!(!uncoated.materials[1].scatters_differently(&bare.materials[1]));
    let thickness = FieldId::Material(Side::Coating, Property::Parameter("thickness"));
    let index = FieldId::Material(Side::Coating, Property::Parameter("int_ior"));
    let thick = set(&coated, BALL, thickness, Value::Number(2.5));
    let thick = set(&thick, BALL, index, Value::Number(1.7));
    let [Some(front), back] = thick.materials[1].coatings else { panic!("a coating") };
    assert_eq!((front.thickness, front.int_ior, back), (2.5.into(), 1.7, Some(front)));
    assert_eq!(thick.materials[1].front, coated.materials[1].front);
    // No two fields have one label.
    let rough = set(&thick, BALL, FieldId::Material(Side::Coating, Property::Rough), Value::Toggle(true));
    let rough = set(&rough, BALL, FieldId::Material(Side::Front, Property::Kind), Value::Choice(3));
    let mut labels: Vec<_> = inspect(&rough, BALL).unwrap().fields.iter().map(|f| f.label).collect();
    let all = labels.len();
    labels.sort_unstable();
    labels.dedup();
    assert_eq!(labels.len(), all, "{labels:?}");
    // Glass has one coating, that of its front.
    let glass = set(&bare, BALL, FieldId::Material(Side::Front, Property::Kind), Value::Choice(1));
    let coated = set(&glass, BALL, coat, Value::Toggle(true));
    assert!(coated.materials[1].coatings[0].is_some() && coated.materials[1].coatings[1].is_none());
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
    let red = set(
        &own,
        CUBE,
        FieldId::Material(Side::Front, Property::Parameter("reflectance")),
        Value::Colour([0.7, 0.1, 0.1]),
    );
    assert_eq!(format!("{:?}", red.materials[0]), format!("{:?}", description.materials[0]));
}

#[test]
fn index_roughness_and_colour_come_first_and_what_physicists_set_is_advanced() {
    let property = |f: &Field| match f.id {
        FieldId::Material(Side::Front, Property::Parameter(name)) => Some(name),
        FieldId::Material(Side::Front, Property::Channel(name, _)) => Some(name),
        FieldId::Material(Side::Front, Property::Rough) => Some("rough"),
        _ => None,
    };
    let parted = |d: &SceneDescription| {
        let fields = inspect(d, BALL).unwrap().fields;
        let of = |advanced: bool| {
            let mut names: Vec<_> =
                fields.iter().filter(|f| f.is_advanced == advanced).filter_map(property).collect();
            names.dedup();
            names
        };
        (of(false), of(true))
    };
    let kind =
        |kind| set(&scene(), BALL, FieldId::Material(Side::Front, Property::Kind), Value::Choice(kind));
    assert_eq!(
        parted(&scene()),
        (vec!["int_ior", "rough", "specular_transmittance"], vec!["ext_ior", "specular_reflectance"])
    );
    let (plain, advanced) = parted(&kind(4));
    assert_eq!(
        (plain, advanced.first(), advanced.last()),
        (vec!["material", "rough"], Some(&"eta"), Some(&"specular_reflectance"))
    );
    assert_eq!(parted(&kind(5)).0, ["int_ior", "rough", "diffuse_reflectance"]);
    assert_eq!(parted(&kind(3)).0, ["specular_reflectance"], "the colour of a mirror");
}

#[test]
fn colour_roughness_and_index_survive_a_change_to_the_principled_model_and_back() {
    let field = |property| FieldId::Material(Side::Front, property);
    let kind = |d: &SceneDescription, kind| set(d, BALL, field(Property::Kind), Value::Choice(kind));
    let plastic = set(&kind(&scene(), 5), BALL, field(Property::Rough), Value::Toggle(true));
    let plastic = set(&plastic, BALL, field(Property::Parameter("alpha")), Value::Number(0.25));
    let plastic = set(&plastic, BALL, field(Property::Parameter("int_ior")), Value::Number(1.7));
    let red = Value::Colour([0.7, 0.1, 0.1]);
    let plastic = set(&plastic, BALL, field(Property::Parameter("diffuse_reflectance")), red);
    let principled = kind(&plastic, 6);
    let Bsdf::Principled(Principled { base_color, roughness, eta, .. }) = principled.materials[1].front
    else {
        panic!("principled")
    };
    assert_eq!(base_color, Rgb::new(0.7, 0.1, 0.1).into());
    assert_eq!((roughness, eta), (Number::Constant(0.5), 1.7));
    let smoother = set(&principled, BALL, field(Property::Parameter("roughness")), Value::Number(0.4));
    let Bsdf::Plastic(back) = kind(&smoother, 5).materials[1].front else { panic!("plastic") };
    let Some(Microfacets { alpha_u: Number::Constant(alpha), .. }) = back.roughness else { panic!("rough") };
    assert!((alpha - 0.16).abs() < 1e-6 && back.int_ior == 1.7 && back.diffuse_reflectance == base_color);
    // The window shows what most people set.
    let fields = inspect(&principled, BALL).unwrap().fields;
    let plain = fields.iter().filter(|f| !f.is_advanced).filter_map(|f| match f.id {
        FieldId::Material(_, Property::Parameter(name)) => Some(name),
        _ => None,
    });
    assert_eq!(
        plain.collect::<Vec<_>>(),
        ["roughness", "metallic", "spec_trans", "eta", "clearcoat", "base_color"]
    );
}

#[test]
fn a_projector_moves_turns_and_has_a_brightness_and_a_field_of_view() {
    let mut description = scene();
    let to_world = looking(DVec3::new(2.0, 2.5, 2.0), DVec3::ZERO, DVec3::Y);
    let slide = |irradiance| EmitterKind::Projector {
        to_world,
        irradiance,
        scale: 3.0,
        fov_degrees: 30.0,
        fov_axis: FovAxis::X,
    };
    let target = Target::Emitter(1);
    description.emitters[1].kind = slide(Rgb::new(0.5, 0.25, 0.0).into());
    assert!(close(number(&description, target, FieldId::Brightness), 1.5));
    let changed = set(&description, target, FieldId::Brightness, Value::Number(4.0));
    assert!(close(number(&changed, target, FieldId::Brightness), 4.0));
    let wide = set(&changed, target, FieldId::Cutoff, Value::Number(55.0));
    assert!(close(number(&wide, target, FieldId::Cutoff), 55.0));
    // A picture keeps its colours.
    description.emitters[1].kind = slide(Colour::Texture(0));
    let changed = set(&description, target, FieldId::Brightness, Value::Number(4.0));
    let EmitterKind::Projector { irradiance, scale, .. } = &changed.emitters[1].kind else {
        panic!("a projector")
    };
    assert_eq!((*irradiance, *scale), (Colour::Texture(0), 4.0));
    let turned = set(&changed, target, FieldId::Elevation, Value::Number(60.0));
    assert!(close(number(&turned, target, FieldId::Elevation), 60.0));
    let by = [1.0, 0.0, -0.5];
    let moved = Edit::Move { target, by }.apply(&turned).unwrap();
    let [from, to] = [&turned, &moved].map(|d| anchor(d, target).unwrap());
    assert!((to - from).distance(by.into()) < 1e-12);
    assert!(Gizmo::new(&moved, target, 0, None).is_some_and(|g| g.has(Tool::Move) && g.has(Tool::Rotate)));
}
