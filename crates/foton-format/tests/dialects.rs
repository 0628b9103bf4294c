//! Old files, includes, paths and aliases: scenes that are not written in one file for Mitsuba 3.

use std::io;
use std::path::Path;

use foton_format::{Opened, Options, Suggested, read_str};
use foton_math::Rgb;
use foton_math::glam::DVec3;
use foton_scene::description::{Bsdf, Diffuse, EmitterKind, Geometry, Lens, Plastic};

fn files(path: &Path) -> io::Result<Vec<u8>> {
    let text = |text: &str| Ok(text.as_bytes().to_vec());
    match path.to_str() {
        Some("parts/all.xml") => text(
            "<scene version='3.0.0'>\n<default name='size' value='2'/><include filename='deeper/ball.xml'/>\n\
             <bsdf type='diffuse' id='grey'/><shape type='obj'><string name='filename' value='t.obj'/></shape></scene>",
        ),
        Some("parts/deeper/ball.xml") => text(
            "<shape version='0.5.0' type='sphere'><float name='radius' value='$size'/><ref id='grey'/></shape>",
        ),
        Some("grey.xml") => {
            text("<bsdf version='3.0.0' type='diffuse'><rgb name='reflectance' value='0.25'/></bsdf>")
        }
        Some("meshes/t.obj" | "parts/t.obj") => text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
        Some("meshes/sub/u.obj") => text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
        _ => Err(io::ErrorKind::NotFound.into()),
    }
}

fn read_version(version: &str, snippet: &str) -> Opened {
    let xml = format!("<scene version='{version}'><sensor type='perspective'/>{snippet}</scene>");
    let opened =
        read_str("s.xml", &xml, &files, &Options::default()).unwrap_or_else(|e| panic!("{snippet}: {e}"));
    assert_eq!(opened.warnings, [], "{snippet}");
    opened
}

fn read(snippet: &str) -> Opened {
    read_version("3.0.0", snippet)
}

#[test]
fn a_lens_of_an_old_file_is_read_by_its_old_names() {
    let opened = read_version(
        "0.6.0",
        "<sensor type='thinlens'><float name='apertureRadius' value='0.25'/><float name='focusDistance' value='3'/></sensor>",
    );
    let lens = Lens { aperture_radius: 0.25, focus_distance: 3.0 };
    assert_eq!(opened.description.sensors[1].lens, Some(lens));
}

#[test]
fn a_spectrum_of_one_number_is_white_light_in_old_files_alone() {
    let radiance = |version: &str| {
        let emitter = "<emitter type='constant'><spectrum name='radiance' value='2'/></emitter>";
        match read_version(version, emitter).description.emitters.pop().map(|e| e.kind) {
            Some(EmitterKind::Constant { radiance }) => radiance,
            other => panic!("{other:?}"),
        }
    };
    assert_eq!(radiance("0.5.0"), Rgb::splat(2.0));
    // The same at every wavelength, as Mitsuba 3 has it, is reddish.
    assert!(radiance("3.0.0").r > 2.4);
}

#[test]
fn what_reflects_more_than_it_gets_is_scaled_down_in_old_files() {
    let bsdf =
        "<shape type='cube'><bsdf type='diffuse'><rgb name='reflectance' value='2, 1, 0.5'/></bsdf></shape>";
    let xml = format!("<scene version='0.6.0'><sensor type='perspective'/>{bsdf}</scene>");
    let opened = read_str("s.xml", &xml, &files, &Options::default()).expect("sound");
    let Bsdf::Diffuse(Diffuse { reflectance, .. }) = opened.description.materials[0].front else {
        panic!("it is diffuse")
    };
    assert_eq!(reflectance, Rgb::new(1.0, 0.5, 0.25).into());
    let said = opened.warnings.iter().any(|w| w.message.contains("is larger than 1, and is scaled down"));
    assert!(said, "{:?}", opened.warnings);
}

#[test]
fn what_moves_in_an_old_file_is_read_with_the_shutter() {
    let animation = |at: [f64; 2]| {
        let transform = |time, x| format!("<transform time='{time}'><translate x='{x}'/></transform>");
        format!("<animation name='toWorld'>{}{}</animation>", transform(1, at[1]), transform(0, at[0]))
    };
    let opened = read_version(
        "0.6.0",
        &format!(
            "<shape type='cube'/><shape type='sphere'>{}</shape><sensor type='perspective'>{}<float name='shutterOpen' value='0.25'/>\
             <float name='shutterClose' value='0.5'/></sensor>",
            animation([2.0, 4.0]),
            animation([1.0, 0.0])
        ),
    );
    let description = opened.description;
    assert_eq!(description.shapes[1].to_world.translation.x, 2.0, "as it is at the first keyframe");
    assert_eq!(description.at(0.5).shapes[1].to_world.translation.x, 3.0);
    assert_eq!(description.at(0.5).sensors[1].to_world.translation.x, 0.5);
    assert_eq!((description.motion.shutter(1), description.motion.shutter(0)), ([0.25, 0.5], [0.0; 2]));
    assert!(description.motion.blurs(1) && !description.motion.blurs(0));
}

#[test]
fn what_is_no_motion_is_refused_at_its_place() {
    let sphere = |inside: &str| {
        format!("<shape type='sphere'><animation name='to_world'>{inside}</animation></shape>")
    };
    let turn = "<transform time='0'><translate x='1'/></transform>";
    for (inside, why) in [
        (String::new(), "an <animation> needs a <transform time="),
        ("<translate x='1'/>".into(), "an <animation> holds <transform time="),
        ("<transform><translate x='1'/></transform>".into(), "<transform> needs the attribute \"time\""),
        (format!("{turn}{turn}"), "times that differ"),
        (format!("{turn}<transform time='1'><scale x='-1'/></transform>"), "neither shear nor mirror"),
        (format!("{turn}<transform time='1'><scale x='2'/></transform>"), "scaled evenly on all of its way"),
    ] {
        let xml = format!("<scene version='3.0.0'><sensor type='perspective'/>\n{}</scene>", sphere(&inside));
        let error = read_str("s.xml", &xml, &files, &Options::default()).expect_err("no motion").to_string();
        assert!(error.contains(why) && error.contains("s.xml:2:"), "{inside}: {error}");
    }
    let late = "<scene version='3.0.0'><sensor type='perspective'><float name='shutter_open' value='1'/><float name='shutter_close' value='0.5'/></sensor></scene>";
    let error = read_str("s.xml", late, &files, &Options::default()).expect_err("closed").to_string();
    assert!(error.contains("a shutter closes before it opens"), "{error}");
}

#[test]
fn names_of_old_files_are_renewed() {
    let opened = read_version(
        "0.5.0",
        "<integrator type='path'><integer name='maxDepth' value='4'/></integrator>\
         <sensor type='perspective'><string name='fovAxis' value='y'/><float name='fov' value='30'/>\
         <transform name='toWorld'><lookAt origin='0,0,4' target='0,0,0' up='0,1,0'/></transform>\
         <film type='ldrfilm'><integer name='width' value='7'/><boolean name='highQualityEdges' value='true'/></film></sensor>\
         <shape type='sphere'><bsdf type='roughplastic'><float name='intIOR' value='1.6'/>\
         <srgb name='diffuseReflectance' value='#ff8000'/></bsdf></shape>\
         <shape type='rectangle'><bsdf type='diffuse'><rgb name='diffuseReflectance' value='#ff8000'/></bsdf>\
         <transform name='toWorld'><translate x='1'/></transform></shape>\
         <emitter type='spot'><float name='cutoffAngle' value='30'/></emitter>",
    );
    let description = &opened.description;
    assert_eq!(description.max_depth, Some(4));
    let camera = &description.sensors[1];
    assert_eq!((camera.to_world.translation, camera.width), (DVec3::new(0.0, 0.0, 4.0), 7));
    let Bsdf::Plastic(Plastic { int_ior, diffuse_reflectance, .. }) = description.materials[0].front else {
        panic!()
    };
    let foton_scene::description::Colour::Constant(orange) = diffuse_reflectance else { panic!() };
    assert_eq!((int_ior, orange.r, orange.b), (1.6, 1.0, 0.0));
    assert!((orange.g - 0.215_86).abs() < 1e-5, "sRGB is made linear: {orange:?}");
    let half = 128.0 / 255.0;
    assert_eq!(
        description.materials[1].front,
        Bsdf::Diffuse(Diffuse { reflectance: Rgb::new(1.0, half, 0.0).into() })
    );
    assert_eq!(description.shapes[1].to_world.translation, DVec3::X);
    assert!(matches!(description.emitters[0].kind, EmitterKind::Spot { cutoff_degrees: 30.0, .. }));
}

#[test]
fn old_names_in_new_files_are_read_with_a_warning() {
    let xml = "<scene version='2.0.0'><sensor type='perspective'/><shape type='sphere'><transform name='toWorld'/></shape></scene>";
    let opened = read_str("s.xml", xml, &files, &Options::default()).unwrap();
    let warning = "unknown property \"toWorld\" of \"sphere\" is read as \"to_world\"";
    assert_eq!(opened.warnings[0].message, warning);
}

#[test]
fn photon_mapping_integrators_suggest_settings() {
    let old = read_version(
        "0.6.0",
        "<integrator type='sppm'><integer name='photonCount' value='100000'/><float name='initialRadius' value='0.5'/>\
         <float name='alpha' value='0.7'/><integer name='maxPasses' value='20'/><integer name='maxDepth' value='-1'/></integrator>",
    );
    let all =
        Suggested { photons_per_pass: Some(100_000), radius: Some(0.5), alpha: Some(0.7), passes: Some(20) };
    assert_eq!((old.suggested, old.description.max_depth), (all, None));
    let automatic = read(
        "<integrator type='ppm'><float name='initial_radius' value='0'/><integer name='max_passes' value='-1'/></integrator>",
    );
    assert_eq!(automatic.suggested, Suggested::default());
    let path = read("<integrator type='path'><float name='alpha' value='7'/></integrator>");
    assert_eq!(path.suggested, Suggested::default());
}

#[test]
fn included_files_stand_where_they_are_named() {
    let opened = read(
        "<shape type='cube'/><include filename='parts/all.xml'/><shape type='sphere'><float name='radius' value='$size'/></shape>",
    );
    let shapes = &opened.description.shapes;
    let radius = |i: usize| match shapes[i].geometry {
        Geometry::Sphere { radius, .. } => radius,
        ref other => panic!("{other:?}"),
    };
    assert_eq!((shapes.len(), radius(1), radius(3)), (4, 2.0, 2.0));
    let scene = opened.origin.mitsuba().expect("a Mitsuba scene");
    let tags: Vec<_> =
        scene.nodes.shapes.iter().map(|n| scene.document.element(*n).unwrap().name.as_str()).collect();
    assert_eq!(tags, ["shape", "include", "include", "shape"]);
}

#[test]
fn a_plugin_may_be_a_file() {
    let opened = read("<shape type='cube'><include filename='grey.xml'/></shape>");
    assert_eq!(
        opened.description.materials[0].front,
        Bsdf::Diffuse(Diffuse { reflectance: Rgb::splat(0.25).into() })
    );
}

#[test]
fn files_are_found_in_further_folders_and_with_backslashes() {
    let obj = |name: &str| format!("<shape type='obj'><string name='filename' value='{name}'/></shape>");
    let opened = read(&format!("<path value='meshes'/>{}{}", obj("t.obj"), obj("sub\\u.obj")));
    assert_eq!(opened.description.shapes.len(), 2);
}

#[test]
fn an_alias_is_a_second_id() {
    let opened =
        read("<bsdf type='diffuse' id='a'/><alias id='a' as='b'/><shape type='cube'><ref id='b'/></shape>");
    assert_eq!((opened.description.materials.len(), opened.description.shapes[0].material), (1, 0));
}

#[test]
fn included_files_count_for_the_hash() {
    let xml = "<scene version='3.0.0'><include filename='a.xml'/></scene>";
    let hash = |content: &'static str| {
        let files = move |_: &Path| Ok(content.as_bytes().to_vec());
        read_str("s.xml", xml, &files, &Options::default()).unwrap().source_hash
    };
    assert_ne!(hash("<scene version='3.0.0'/>"), hash("<scene version='3.0.0'> </scene>"));
}

#[test]
fn includes_that_double_at_every_level_end() {
    let files = |path: &Path| {
        let level: u32 = path.to_string_lossy().trim_end_matches(".xml").parse().unwrap_or(0);
        let next = format!("<include filename='{}.xml'/>", level + 1);
        Ok(format!("<scene version='3.0.0'>{next}{next}</scene>").into_bytes())
    };
    let error = read_str(
        "s.xml",
        "<scene version='3.0.0'><include filename='0.xml'/></scene>",
        &files,
        &Options::default(),
    );
    let text = error.unwrap_err().to_string();
    assert!(text.contains("files are included deeper than 15 levels"), "{text}");
    assert!(text.contains("more than 1000 files are included"), "{text}");
}

#[test]
fn cylinders_are_tubes_with_mitsubas_outside() {
    let tube = |inside: &str| {
        let shape = read(&format!("<shape type='cylinder'>{inside}</shape>")).description.shapes.remove(0);
        match shape.geometry {
            Geometry::Cylinder { from, to, radius } => {
                (from, to, radius, shape.to_world.translation, shape.flip_normals)
            }
            other => panic!("{other:?}"),
        }
    };
    assert_eq!(tube(""), (DVec3::ZERO, DVec3::Z, 1.0, DVec3::ZERO, false));
    let stated = "<point name='p0' x='1' y='0' z='0'/><point name='p1' value='1 2 0'/><float name='radius' value='0.5'/>\
                  <boolean name='flip_normals' value='true'/><transform name='to_world'><scale x='-1'/><translate x='3'/></transform>";
    let (p0, p1) = (DVec3::X, DVec3::new(1.0, 2.0, 0.0));
    assert_eq!(tube(stated), (p0, p1, 0.5, DVec3::new(3.0, 0.0, 0.0), true));
    let long = "<transform name='to_world'><scale x='2' y='2' z='3'/><translate z='1'/></transform>";
    assert_eq!(tube(long), (DVec3::Z, DVec3::new(0.0, 0.0, 4.0), 2.0, DVec3::ZERO, false));
}
