//! Emitters that are not surfaces, as files state them.

use super::*;

#[test]
fn emitters_are_read_with_their_defaults() {
    let emitter = |text: &str| read(text).description.emitters.remove(0).kind;
    let EmitterKind::Point { position, intensity } = emitter(
        "<emitter type='point'><point name='position' value='1, 2, 3'/><rgb name='intensity' value='4 5 6'/></emitter>",
    ) else {
        panic!("not a point")
    };
    assert_eq!((position, intensity), (DVec3::new(1.0, 2.0, 3.0), Rgb::new(4.0, 5.0, 6.0)));
    let moved = "<emitter type='point'><transform name='to_world'><translate y='2'/></transform></emitter>";
    assert!(
        matches!(emitter(moved), EmitterKind::Point { position, intensity: Rgb::WHITE } if position.y == 2.0)
    );
    let spot = emitter("<emitter type='spot'><float name='cutoff_angle' value='30'/></emitter>");
    assert!(matches!(spot, EmitterKind::Spot { cutoff_degrees: 30.0, beam_degrees: 22.5, .. }), "{spot:?}");
    // Mitsuba prints [1.20479, 0.948291, 0.908916] for a flat spectrum of 1.
    let flat = emitter("<emitter type='constant'><spectrum name='radiance' value='2'/></emitter>");
    let EmitterKind::Constant { radiance } = flat else { panic!("{flat:?}") };
    assert_eq!(radiance, Rgb::new(2.409_588, 1.896_582, 1.817_832));
}

fn light(text: &str) -> (EmitterKind, Vec<String>) {
    let mut opened = read_with(&format!("<sensor type='perspective'/>{text}"), &[]);
    let warnings = opened.warnings.iter().map(ToString::to_string).collect();
    (opened.description.emitters.remove(0).kind, warnings)
}

fn refused(text: &str) -> String {
    let xml = format!("<scene version='3.0.0'><sensor type='perspective'/>{text}</scene>");
    match read_str("s.xml", &xml, &files, &Options::default()) {
        Ok(_) => panic!("{text}"),
        Err(error) => error.to_string(),
    }
}

#[test]
fn a_projector_has_the_view_of_a_camera_and_its_scale_is_a_factor_on_its_light() {
    let (kind, warnings) = light("<emitter type='projector'/>");
    assert_eq!(warnings, [""; 0]);
    let EmitterKind::Projector { irradiance, scale, fov_degrees, fov_axis, .. } = kind else {
        panic!("{kind:?}")
    };
    assert_eq!((irradiance, scale, fov_axis), (Rgb::WHITE.into(), 1.0, FovAxis::Diagonal));
    // Mitsuba prints x_fov = 34.0221 for a square.
    let [half, _] = foton_scene::description::projected_half(fov_degrees, fov_axis, [1.0; 2]);
    assert!((2.0 * half.atan().to_degrees() - 34.0221).abs() < 1e-4);
    let (kind, _) = light(
        "<emitter type='projector'><texture type='checkerboard' name='irradiance'/><float name='scale' value='3'/>\
         <float name='fov' value='60'/><string name='fov_axis' value='y'/>\
         <transform name='to_world'><scale value='2'/><translate y='7'/></transform></emitter>",
    );
    let EmitterKind::Projector { to_world, irradiance, scale, fov_degrees, fov_axis } = kind else {
        panic!("{kind:?}")
    };
    assert_eq!((irradiance, fov_degrees, fov_axis), (Colour::Texture(0), 60.0, FovAxis::Y));
    // Mitsuba's light is twice as strong where its transform doubles lengths.
    assert_eq!((scale, to_world.matrix3, to_world.translation.y), (6.0, DMat3::IDENTITY, 7.0));
    let said =
        refused("<emitter type='projector'><transform name='to_world'><scale x='2'/></transform></emitter>");
    assert!(said.contains("the picture of a projector can be turned"), "{said}");
    let said = refused("<emitter type='projector'><float name='scale' value='-1'/></emitter>");
    assert!(said.contains("\"scale\" must not be negative"), "{said}");
}

#[test]
fn a_spot_may_have_a_texture_or_a_colour_in_its_place() {
    let spot = |inside: &str| light(&format!("<emitter type='spot'>{inside}</emitter>"));
    let (kind, _) = spot("<texture type='checkerboard' name='texture'/>");
    assert!(matches!(kind, EmitterKind::Spot { texture: Some(0), intensity: Rgb::WHITE, .. }), "{kind:?}");
    let (kind, _) = spot("<rgb name='texture' value='0.5'/><rgb name='intensity' value='4'/>");
    let EmitterKind::Spot { texture, intensity, .. } = kind else { panic!("{kind:?}") };
    assert_eq!((texture, intensity), (None, Rgb::splat(2.0)));
    let opened = read_with(
        "<sensor type='perspective'/><emitter type='spot'><texture type='mesh_attribute' name='texture'>\
         <string name='name' value='vertex_color'/></texture></emitter>",
        &[],
    );
    let error = foton_scene::Scene::build(&opened.description).err().map(|e| e.to_string());
    assert!(error.as_ref().is_some_and(|e| e.contains("spot")), "{error:?}");
}

#[test]
fn a_measured_lamp_is_read_from_its_profile() {
    let lamp = |file: &str| {
        format!(
            "<emitter type='goniometric'><string name='filename' value='{file}'/><float name='scale' value='2'/></emitter>"
        )
    };
    let (kind, warnings) = light(&lamp("t.IES"));
    assert_eq!(warnings, [""; 0]);
    let EmitterKind::Goniometric { bitmap, scale, .. } = kind else { panic!("{kind:?}") };
    assert_eq!((scale, bitmap.width, bitmap.height, bitmap.pixels[0].g), (2.0, 1, 361, 10.0));
    assert!(refused(&lamp("none.ies")).contains("cannot read none.ies"));
    let said = refused("<emitter type='goniometric'/>");
    assert!(said.contains("a goniometric emitter needs a \"filename\""), "{said}");
    let said = refused(&lamp("broken.ies"));
    assert!(said.contains("cannot read broken.ies as an IES profile: it ends too early"), "{said}");
}
