//! Parts that do not matter, files that are not there, and what findings come with.

use super::*;

#[test]
fn media_are_left_out_with_a_warning() {
    let opened = read_as(
        "2.1.0",
        "<medium type='homogeneous' id='fog'><float name='density' value='1'/></medium>\
         <shape type='cube'><emitter type='area'><float name='sampling_weight' value='2'/></emitter><ref name='interior' id='fog'/><medium name='exterior' type='heterogeneous'/></shape>",
        &Options::default(),
    );
    assert_eq!(opened.description.shapes.len(), 1);
    let said = opened.warnings.iter().filter(|w| w.message.ends_with("is left out: there are no media yet"));
    assert_eq!((opened.warnings.len(), said.count()), (3, 3), "{:?}", warnings(&opened));
}

#[test]
fn faults_of_what_nothing_uses_are_warnings() {
    let bad = "<bsdf type='velvet' id='a'/>";
    let shape = |inside: &str| format!("<shape type='cube'>{inside}</shape>");
    let said = "s.xml:2:13: unknown bsdf \"velvet\"";
    let unused = read_as("3.0.0", &format!("{bad}{}", shape("")), &Options::default());
    assert_eq!(warnings(&unused), [format!("{said} (nothing uses it)")]);
    assert_eq!(errors(&format!("{bad}{}", shape("<ref id='a'/>"))), [said]);
    // By way of others, and without any shape: then the file may be one that others include.
    assert_eq!(
        errors(&format!("{bad}<bsdf type='twosided' id='b'><ref id='a'/></bsdf>{}", shape("<ref id='b'/>"))),
        [said]
    );
    assert_eq!(errors(bad), [said]);
    // A use that is not used itself is none.
    let unused = read_as(
        "3.0.0",
        &format!("{bad}<bsdf type='twosided' id='b'><ref id='a'/></bsdf>{}", shape("")),
        &Options::default(),
    );
    assert_eq!(unused.warnings.len(), 1);
    let texture = "<texture type='bitmap' id='t'><string name='filename' value='gone.png'/></texture>";
    assert_eq!(read_as("3.0.0", &format!("{texture}{}", shape("")), &Options::default()).warnings.len(), 1);
}

#[test]
fn missing_files_are_named_in_one_go_or_allowed() {
    let snippet = "<shape type='obj'><string name='filename' value='gone.obj'/></shape>\n\
                   <shape type='ply'><string name='filename' value='away/gone.ply'/></shape>\n\
                   <shape type='obj'><string name='filename' value='t.obj'/><bsdf type='diffuse'>\n\
                   <texture name='reflectance' type='bitmap'><string name='filename' value='gone.png'/></texture></bsdf></shape>";
    let places = ["s.xml:2:50", "s.xml:3:50", "s.xml:5:74"];
    let said = errors(snippet);
    assert_eq!(said.len(), 3);
    for ((said, place), name) in said.iter().zip(places).zip(["gone.obj", "away/gone.ply", "gone.png"]) {
        assert!(said.starts_with(&format!("{place}: cannot read {name}: ")), "{said}");
    }
    let allowing = Options { allow_missing: true, ..Options::default() };
    let opened = read_as("3.0.0", snippet, &allowing);
    assert_eq!(
        warnings(&opened),
        [
            "s.xml:2:50: gone.obj is missing: the shape is left out",
            "s.xml:3:50: away/gone.ply is missing: the shape is left out",
            "s.xml:5:74: gone.png is missing: magenta stands for it"
        ]
    );
    assert_eq!(opened.description.shapes.len(), 1);
    let TextureKind::Bitmap { bitmap, .. } = &opened.description.textures[0].kind else { panic!() };
    assert_eq!((bitmap.width, bitmap.height, bitmap.pixels.clone()), (1, 1, vec![Rgb::new(1.0, 0.0, 1.0)]));
    // What a scene cannot do without stays an error.
    let include = "<scene version='3.0.0'><include filename='gone.xml'/></scene>";
    assert!(read_str("s.xml", include, &files, &allowing).is_err());
}

#[test]
fn findings_come_with_their_line_and_with_what_there_is() {
    let xml = "<scene version='3.0.0'>\n  <shape type='spere'/>\n  <shape type='sphere'><float name='radus' value='2'/></shape>\n</scene>";
    let error = read_str("s.xml", xml, &files, &Options::default()).expect_err("an error");
    let [no_sensor, plugin, parameter] = error.diagnostics() else { panic!("{error:?}") };
    assert_eq!(no_sensor.excerpt.as_ref().map(|e| e.line.as_str()), Some("<scene version='3.0.0'>"));
    let excerpt = plugin.excerpt.as_ref().unwrap();
    assert_eq!((excerpt.line.as_str(), excerpt.column, excerpt.length), ("  <shape type='spere'/>", 15, 5));
    assert!(plugin.help.as_ref().is_some_and(|help| help.contains(" sphere")), "{plugin:?}");
    assert_eq!(
        parameter.help.as_deref(),
        Some("\"sphere\" takes center, flip_normals, radius, silhouette_sampling_weight, to_world")
    );
    // Of a file that is no scene nothing is shown.
    let error =
        read_str("s.xml", "<secret>\n<token>abc</token>", &files, &Options::default()).expect_err("an error");
    assert!(error.diagnostics().iter().all(|d| d.excerpt.is_none()), "{error:?}");
}
