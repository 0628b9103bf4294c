//! What other readers take, or what can only mean one thing, with a warning where it is not what was written.

use std::fs;

use super::*;

fn read_file_of(xml: &str) -> (Opened, Vec<String>) {
    let opened = read_str("s.xml", xml, &files, &Options::default()).unwrap_or_else(|e| panic!("{xml}: {e}"));
    let warnings = opened.warnings.iter().map(ToString::to_string).collect();
    (opened, warnings)
}

#[test]
fn a_file_without_a_version_is_read_by_its_words() {
    let sensor = "<sensor type='perspective'/>";
    let (_, said) = read_file_of(&format!("<scene>{sensor}</scene>"));
    assert!(
        said[0].starts_with("s.xml:1:1: this file states no version") && said[0].contains("3.0.0"),
        "{said:?}"
    );
    // In files of version 0 a spectrum of one number is white.
    let light = "<emitter type='constant'><spectrum name='radiance' value='2'/></emitter>";
    let old = format!(
        "<scene>{sensor}{light}<shape type='obj'><string name='filename' value='t.obj'/><boolean name='faceNormals' value='true'/></shape></scene>"
    );
    let (opened, said) = read_file_of(&old);
    assert!(said[0].contains("version 0.6.0"), "{said:?}");
    assert!(
        matches!(opened.description.emitters[0].kind, EmitterKind::Constant { radiance } if radiance == Rgb::splat(2.0))
    );
}

#[test]
fn a_document_type_that_declares_nothing_is_passed_over() {
    let (opened, said) = read_file_of(
        "<?xml version='1.0'?>\n<!DOCTYPE scene SYSTEM 'scene.dtd'>\n<scene version='3.0.0'><sensor type='perspective'/><shape type='cube'/></scene>",
    );
    assert_eq!((opened.description.shapes.len(), said.len()), (1, 0), "{said:?}");
}

#[test]
fn whole_numbers_and_words_are_taken_as_old_programs_write_them() {
    let opened = read_with(
        "<sensor type='perspective'><film type='hdrfilm'><integer name='width' value='32.0'/></film></sensor>\
         <shape type='cube'><bsdf type='ward'><string name='variant' value='wardDuer'/></bsdf></shape>",
        &[],
    );
    assert_eq!((opened.description.sensors[0].width, opened.warnings.len()), (32, 0));
    let material = &opened.description.materials[opened.description.shapes[0].material];
    assert!(format!("{:?}", material.front).contains("variant: 2"), "{:?}", material.front);
}

#[test]
fn a_stretched_sphere_stays_round_and_a_stretched_disk_is_an_ellipse() {
    let on = |shape: &str, inside: &str, steps: &str| {
        let xml = format!(
            "<sensor type='perspective'/><shape type='{shape}'>{inside}<transform name='to_world'>{steps}</transform></shape>"
        );
        let mut opened = read_with(&xml, &[]);
        let said: Vec<String> = opened.warnings.iter().map(ToString::to_string).collect();
        foton_scene::Scene::build(&opened.description).unwrap_or_else(|e| panic!("{xml}: {e}"));
        (opened.description.shapes.remove(0), said)
    };
    // Mitsuba 3.9 bounds it by 1, 2, 4 and 3, 4, 6.
    let centre = "<point name='center' x='1' y='1' z='1'/><float name='radius' value='0.5'/>";
    let (sphere, said) = on("sphere", centre, "<scale x='2' y='3' z='5'/>");
    assert!(said[0].contains("a sphere stays round"), "{said:?}");
    let Geometry::Sphere { centre, radius } = sphere.geometry else { panic!("a sphere") };
    assert!(sphere.to_world.transform_point3(centre).distance(DVec3::new(2.0, 3.0, 5.0)) < 1e-12);
    assert!((radius * sphere.to_world.matrix3.z_axis.length() - 1.0).abs() < 1e-12);
    let (disk, said) = on("disk", "", "<scale x='2' y='3'/>");
    assert!(said[0].contains("made of 512 triangles"), "{said:?}");
    let mesh = mesh(&disk.geometry);
    let area: f64 = mesh
        .triangles
        .iter()
        .map(|t| {
            let [a, b, c] = t.map(|i| disk.to_world.transform_point3(mesh.positions[i as usize]));
            let normal = 0.5 * (b - a).cross(c - a);
            assert!(normal.z > 0.0);
            normal.z
        })
        .sum();
    assert!((area / (6.0 * std::f64::consts::PI) - 1.0).abs() < 1e-9, "{area}");
    assert_eq!(on("disk", "", "<scale z='7'/>").1, [""; 0], "its height is none");
}

#[test]
fn a_file_whose_name_has_letters_of_another_case_is_found_where_it_is_the_only_one() {
    let folder = std::env::temp_dir().join(format!("foton-scenes-case-{}", std::process::id()));
    fs::create_dir_all(folder.join("Meshes")).unwrap();
    fs::write(folder.join("Meshes/T.OBJ"), TRIANGLE).unwrap();
    let xml = "<scene version='3.0.0'><sensor type='perspective'/><shape type='obj'><string name='filename' value='meshes\\t.obj'/></shape></scene>";
    fs::write(folder.join("s.xml"), xml).unwrap();
    let opened = open(&folder.join("s.xml"), &Options::default()).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(opened.description.shapes.len(), 1);
    // A disk that does not tell them apart has nothing to say.
    if !folder.join("meshes").exists() {
        let said = opened.warnings[0].to_string();
        assert!(said.contains("whose letters differ by their case alone"), "{said}");
        assert_eq!(opened.files[1], folder.join("Meshes/T.OBJ"));
    }
    fs::remove_dir_all(folder).unwrap();
}
