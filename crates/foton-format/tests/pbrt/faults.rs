//! Files that are broken, misspelt or hostile: every fault with its place, and no more memory than there is.

use foton_format::Options;

use super::{opened, read_with, whole};

/// What is said of a file, a line each.
fn said(text: &str, options: &Options) -> Vec<String> {
    match opened(text, options) {
        Ok(opened) => opened.warnings.iter().map(ToString::to_string).collect(),
        Err(error) => error.diagnostics().iter().map(ToString::to_string).collect(),
    }
}

#[test]
fn all_faults_of_a_file_are_found_at_once_with_what_is_nearest() {
    let text = "LookAt 0 0 -4  0 0 0  0 1 0\n\
        Camera \"perspectve\"\n\
        Flim \"x\" 1 2 [3]\n\
        Film \"image\" \"integer xresolution\" 0\n\
        WorldBegin\n\
        Material \"glas\"\n\
        Shape \"sphere\"\n\
        Shape \"spere\" \"float radius\" 1\n\
        TransformEnd\n\
        ObjectInstance \"zz\"\n\
        LightSource \"infinte\"\n\
        Texture \"checks\" \"spectrum\" \"imagemap\"\n\
        Material \"matte\" \"texture Kd\" \"cheks\"\n\
        NamedMaterial \"foo\"\n\
        Shape \"trianglemesh\" \"integer indices\" [0 1 5] \"point P\" [0 0 0 1 1 1 2 2 2]\n\
        \"foo\" Shape \"sphere\" \"color radius\" [1 2 3]\n\
        Rotate 5 0 0 0\n\
        Rotate 5 a\n\
        AreaLightSource \"difuse\"\n\
        Shape \"disk\"\n\
        MediumInterface \"fog\" \"\"\n";
    let wanted = [
        "s.pbrt:2:9: unknown camera \"perspectve\", did you mean \"perspective\"?",
        "s.pbrt:3:1: unknown directive \"Flim\", did you mean \"Film\"?",
        "s.pbrt:4:36: \"xresolution\" must lie between 1 and 65536 pixels",
        "s.pbrt:6:11: unknown material \"glas\", did you mean \"glass\"?",
        "s.pbrt:8:8: unknown shape \"spere\", did you mean \"sphere\"?",
        "s.pbrt:9:1: TransformEnd closes nothing",
        "s.pbrt:10:17: there is no object \"zz\"",
        "s.pbrt:11:14: unknown light \"infinte\", did you mean \"infinite\"?",
        "s.pbrt:12:30: an imagemap needs a \"filename\"",
        "s.pbrt:13:32: there is no texture \"cheks\", did you mean \"checks\"?",
        "s.pbrt:14:16: there is no material \"foo\"",
        "s.pbrt:15:41: the index 5 is that of no point: there are 3, counted from 0",
        "s.pbrt:16:2: \"foo\" is not a type and a name, such as \"float radius\"",
        "s.pbrt:16:23: \"radius\" is a rgb here, it must be a float or integer",
        "s.pbrt:17:1: the axis of Rotate has no length",
        "s.pbrt:18:10: \"a\" stands where a number is needed",
        "s.pbrt:19:18: unknown area light \"difuse\", did you mean \"diffuse\"?",
        "s.pbrt:21:18: there is no medium \"fog\"",
    ];
    let found = said(text, &Options::default());
    assert_eq!(found, wanted);
}

#[test]
fn what_has_no_effect_is_warned_of() {
    let (_, warnings) =
        read_with("Film \"rgb\" \"float iso\" 400 \"float exposuretime\" 0.5 Camera \"perspective\"");
    let said = "s.pbrt:1:24: \"iso\" has no effect: the film makes the image 2.000 times as bright, as --exposure 1.00 does";
    assert_eq!(warnings, [said]);
    let text = whole(
        "Shape \"sphere\" \"float radus\" 2\nMakeNamedMedium \"fog\" \"string type\" \"homogeneous\"\n\
         MediumInterface \"fog\" \"\" Shape \"sphere\"\nAttributeBegin\nMaterial \"conductor\" \"rgb Kd\" [1 1 1] Shape \"disk\"",
    );
    let (_, warnings) = read_with(&text);
    let wanted = [
        "s.pbrt:2:17: the parameter \"radus\" of \"sphere\" is unused, did you mean \"radius\"?",
        "s.pbrt:4:18: media are not rendered: light goes through them as through nothing",
        "s.pbrt:5:1: this AttributeBegin has no AttributeEnd",
        "s.pbrt:6:23: the parameter \"Kd\" of \"conductor\" is unused",
    ];
    assert_eq!(warnings, wanted);
}

#[test]
fn files_that_include_themselves_or_are_none_are_refused_without_their_text() {
    let all = said(
        &whole("Include \"circle.pbrt\"\nInclude \"other.pbrt\"\nInclude \"gone.pbrt\""),
        &Options::default(),
    );
    assert_eq!(all[0], "s.pbrt:3:10: other.pbrt is no scene of pbrt: it begins with none of its directives");
    assert!(all[1].starts_with("s.pbrt:4:10: cannot read gone.pbrt"), "{all:?}");
    assert_eq!(all[2], "circle.pbrt:1:10: circle.pbrt includes itself");
    let Err(error) = opened("secret 1", &Options::default()) else { panic!("is no scene") };
    assert!(error.diagnostics().iter().all(|d| d.excerpt.is_none()), "{error:?}");
}

#[test]
fn an_excerpt_shows_the_line_of_a_fault() {
    let Err(error) = opened(&whole("Shape \"spere\""), &Options::default()) else { panic!("no such shape") };
    let excerpt = error.diagnostics()[0].excerpt.as_ref().expect("a line");
    assert_eq!((excerpt.line.as_str(), excerpt.column, excerpt.length), ("Shape \"spere\"", 7, 5));
}

#[test]
fn what_is_left_out_is_left_out_where_it_is_asked_for() {
    let text = whole(
        "Shape \"curve\" Material \"fourier\" Shape \"sphere\" Shape \"plymesh\" \"string filename\" \"gone.ply\"",
    );
    let all = said(&text, &Options::default());
    assert_eq!(all.len(), 3, "{all:?}");
    assert!(
        all[0].ends_with("the shape \"curve\" is not rendered") && all[1].contains("\"fourier\""),
        "{all:?}"
    );
    let opened = opened(&text, &Options { allow_missing: true, ..Options::default() }).expect("opens");
    assert_eq!((opened.description.shapes.len(), opened.warnings.len()), (1, 3));
}

#[test]
fn hostile_files_are_refused() {
    let little = Options { memory: Some(16 << 20), ..Options::default() };
    let instances = format!(
        "ObjectBegin \"o\" {} ObjectEnd {}",
        "Shape \"disk\" ".repeat(1000),
        "ObjectInstance \"o\" ".repeat(1000)
    );
    let mixed: String = (1..20)
        .map(|i| format!("MakeNamedMaterial \"m{i}\" \"string type\" \"mix\" \"string materials\" [\"m{0}\" \"m{0}\"]\n", i - 1))
        .collect();
    let textures: String = (1..64)
        .map(|i| format!("Texture \"t{i}\" \"float\" \"mix\" \"texture tex1\" \"t{0}\" \"texture tex2\" \"t{0}\" \"float amount\" .3\n", i - 1))
        .collect();
    for (text, part) in [
        (instances, "16 MiB may be used"),
        ("AttributeBegin ".repeat(3000), "more than 1000 blocks stand inside one another"),
        (
            format!(
                "MakeNamedMaterial \"m0\" \"string type\" \"diffuse\" {mixed} NamedMaterial \"m19\" Shape \"sphere\""
            ),
            "mixed of more than 64",
        ),
        (
            format!(
                "Texture \"t0\" \"float\" \"checkerboard\" {textures} Material \"conductor\" \"texture roughness\" \"t63\" Shape \"disk\""
            ),
            "textures stand inside one another",
        ),
        (
            "Shape \"loopsubdiv\" \"integer levels\" 10 \"point3 P\" [0 0 0 1 0 0 0 1 0]".to_owned(),
            "16 MiB may be used",
        ),
        (
            "ObjectBegin \"o\" ObjectInstance \"o\" ObjectEnd".to_owned(),
            "cannot have instances of others inside",
        ),
        (
            "Shape \"trianglemesh\" \"integer indices\" [4294967296 0 0] \"point3 P\" [0 0 0]".to_owned(),
            "whole numbers from 0",
        ),
        ("Scale 1e300 1e300 1e300 Scale 1e300 1 1".to_owned(), "has no inverse"),
    ] {
        let all = said(&whole(&text), &little);
        assert!(all.iter().any(|m| m.contains(part)), "{part}: {:?}", all.first());
    }
}
