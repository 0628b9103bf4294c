//! Materials, emitters, included files, and whole files.

use super::*;

#[test]
fn materials_that_cannot_be_are_errors() {
    let rough = |inside: &str| format!("<bsdf type='roughconductor'>{inside}</bsdf>");
    let alpha = |name: &str, value: &str| format!("<float name='{name}' value='{value}'/>");
    let both = "s.xml:2:1: a rough surface has an \"alpha\", or both \"alpha_u\" and \"alpha_v\"";
    assert_all(&[
        (
            &rough("<string name='material' value='Agg'/>"),
            &["s.xml:2:60: no conductor called \"Agg\" is known, did you mean \"Ag\"?"],
        ),
        (
            &rough("<string name='material' value='Unobtainium'/>"),
            &["s.xml:2:60: no conductor called \"Unobtainium\" is known"],
        ),
        (
            &rough("<string name='material' value='Ag'/><float name='k' value='1'/>"),
            &["s.xml:2:60: a conductor has a \"material\" or \"eta\" and \"k\", not both"],
        ),
        (&rough("<rgb name='eta' value='1 -1 1'/>"), &["s.xml:2:52: \"eta\" must not be negative"]),
        (
            &rough("<string name='distribution' value='blinn'/>"),
            &["s.xml:2:64: no distribution \"blinn\" is known, only \"beckmann\", \"ggx\", \"phong\""],
        ),
        (
            &rough("<string name='distribution' value='gxg'/>"),
            &["s.xml:2:64: no distribution \"gxg\" is known, did you mean \"ggx\"?"],
        ),
        (&rough(&alpha("alpha", "-1")), &["s.xml:2:56: \"alpha\" must lie between 0 and 1000000"]),
        (&rough(&alpha("alpha_u", "0.1")), &[both]),
        (&rough(&(alpha("alpha", "0.1") + &alpha("alpha_u", "0.1") + &alpha("alpha_v", "0.2"))), &[both]),
        (
            &rough("<texture type='checkerboard' name='eta'/>"),
            &["s.xml:2:29: a texture as \"eta\" of \"roughconductor\" is not supported yet"],
        ),
        (
            "<bsdf type='roughplastic'><float name='alpha_u' value='0.1'/></bsdf>",
            &[
                "warning: s.xml:2:40: unknown property \"alpha_u\" of \"roughplastic\", did you mean \"alpha\"?",
            ],
        ),
    ]);
}

#[test]
fn plastics_and_what_stands_around_bsdfs_that_cannot_be_are_errors() {
    assert_all(&[
        (
            "<bsdf type='plastic'><float name='int_ior' value='-1'/></bsdf>",
            &["s.xml:2:51: an index of refraction must be above zero"],
        ),
        (
            "<bsdf type='plastic'><rgb name='diffuse_reflectance' value='2'/></bsdf>",
            &["s.xml:2:61: \"diffuse_reflectance\" of \"plastic\" must lie between 0 and 1"],
        ),
        ("<bsdf type='mask'/>", &["s.xml:2:1: a mask needs one bsdf inside, not 0"]),
        (
            "<bsdf type='mask' id='m'><ref id='m'/></bsdf>",
            &["s.xml:2:35: this bsdf is made of itself, or of too long a chain of others"],
        ),
        (
            "<bsdf type='mask'><float name='opacity' value='1.5'/><bsdf type='diffuse'/></bsdf>",
            &["s.xml:2:48: \"opacity\" of \"mask\" must lie between 0 and 1"],
        ),
        (
            "<bsdf type='mask'><texture name='opacity' type='checkerboard'/><bsdf type='mask'><bsdf type='diffuse'/></bsdf></bsdf>",
            &["s.xml:2:64: a mask with a texture inside another mask is not supported yet"],
        ),
        (
            "<bsdf type='twosided'><bsdf type='mask'><bsdf type='diffuse'/></bsdf></bsdf>",
            &["s.xml:2:23: a mask transmits light and cannot stand inside a twosided bsdf"],
        ),
        (
            "<bsdf type='twosided'><bsdf type='null'/></bsdf>",
            &["s.xml:2:23: a null transmits light and cannot stand inside a twosided bsdf"],
        ),
    ]);
}

#[test]
fn emitters_and_shapes_that_cannot_be_are_errors() {
    assert_all(&[
        (
            "<emitter type='directional'><vector name='direction' value='0'/></emitter>",
            &["s.xml:2:61: \"direction\" must not be zero"],
        ),
        (
            "<emitter type='directional'><vector name='direction' value='1 2 3'/><transform name='to_world'/></emitter>",
            &["s.xml:2:61: a directional emitter has a \"direction\" or a \"to_world\", not both"],
        ),
        ("<emitter type='envmap'/>", &["s.xml:2:1: an envmap needs a \"filename\""]),
        (
            "<emitter type='envmap'><string name='filename' value='red.png'/><float name='scale' value='-1'/></emitter>",
            &["s.xml:2:92: \"scale\" must not be negative or above 1e30"],
        ),
        (
            "<emitter type='envmap'><string name='filename' value='red.png'/><transform name='to_world'><scale x='2'/></transform></emitter>",
            &["s.xml:2:65: the transform of an envmap must not stretch or shear"],
        ),
        (
            "<emitter type='constant'/><emitter type='envmap'><string name='filename' value='red.png'/></emitter>",
            &["s.xml:2:27: a scene has only one emitter around it"],
        ),
        (
            "<shape type='cylinder'><float name='radius' value='0'/></shape>",
            &["s.xml:2:52: \"radius\" must be above zero"],
        ),
        (
            "<shape type='cylinder'><point name='p1' value='0 0 0'/></shape>",
            &["s.xml:2:1: the ends \"p0\" and \"p1\" of a cylinder are the same point"],
        ),
        (
            "<shape type='cylinder'><transform name='to_world'><scale x='2'/></transform></shape>",
            &["s.xml:2:24: a cylinder must stay round: its transform stretches or shears it"],
        ),
        (
            "<shape type='serialized'><string name='filename' value='good.obj'/><integer name='shape_index' value='-1'/></shape>",
            &["s.xml:2:103: \"shape_index\" must not be negative", "good.obj: this is not a serialized mesh"],
        ),
        ("<shape type='ply'/>", &["s.xml:2:1: a ply shape needs a \"filename\""]),
    ]);
}

#[test]
fn includes_that_cannot_be_are_errors() {
    let include = |name: &str| format!("<include filename='{name}'/>");
    assert_all(&[
        (&include("gone.xml"), &["s.xml:2:20: cannot read gone.xml: no such file"]),
        (&include("loop.xml"), &["loop.xml:3:20: loop.xml includes itself"]),
        (&include("open.xml"), &["open.xml:2:1: the file ends inside an element"]),
        (
            &(include("sub/bad.xml") + "<bsdf type='diffus'/>"),
            &[
                "warning: s.xml:2:46: unknown bsdf \"diffus\", did you mean \"diffuse\"? (nothing uses it)",
                "warning: sub/bad.xml:3:34: \"x\" is not a number (nothing uses it)",
                "sub/bad.xml:5:14: unknown shape \"spere\", did you mean \"sphere\"?",
            ],
        ),
        (
            &(include("twice.xml") + "<bsdf type='diffuse' id='a'/>"),
            &["twice.xml:2:26: the id \"a\" is taken since line 2 of s.xml"],
        ),
        ("<include/>", &["s.xml:2:1: <include> needs the attribute \"filename\""]),
        ("<include file='a'/>", &["s.xml:2:10: unknown attribute \"file\" of <include>"]),
        (
            "<bsdf type='diffuse'><path value='a'/></bsdf>",
            &["s.xml:2:22: <path> can only stand directly inside the scene"],
        ),
        ("<alias id='b' as='c'/>", &["s.xml:2:12: unknown id \"b\""]),
        (
            "<bsdf type='diffuse' id='a'/><alias id='a' as='a'/>",
            &["s.xml:2:48: the id \"a\" is taken since line 2"],
        ),
        ("<alias id='b'/>", &["s.xml:2:1: <alias> needs the attribute \"as\""]),
    ]);
}

#[test]
fn suggestions_out_of_range_are_errors() {
    let sppm = |tag: &str, name: &str, value: &str| {
        format!("<integrator type='sppm'><{tag} name='{name}' value='{value}'/></integrator>")
    };
    assert_all(&[
        (&sppm("float", "alpha", "0"), &["s.xml:2:52: \"alpha\" must be above 0 and at most 1"]),
        (
            &sppm("integer", "photon_count", "0"),
            &["s.xml:2:61: \"photon_count\" must lie between 1 and 4294967295"],
        ),
        (
            &sppm("float", "initial_radius", "-1"),
            &["s.xml:2:61: \"initial_radius\" must be above zero, or zero for a good guess"],
        ),
    ]);
}

#[test]
fn meshes_are_reported_in_their_own_file() {
    let obj = |name: &str| format!("<shape type='obj'><string name='filename' value='{name}'/></shape>");
    let bad = "bad.obj:4:7: there is no vertex 4, the file has 3";
    assert_all(&[
        (&obj("bad.obj"), &[bad]),
        (&(obj("bad.obj") + &obj("bad.obj")), &[bad]),
        (&obj("gone.obj"), &["s.xml:2:50: cannot read gone.obj: no such file"]),
        ("<shape type='obj'/>", &["s.xml:2:1: an obj shape needs a \"filename\""]),
    ]);
}

#[test]
fn files_that_are_not_scenes_are_refused() {
    let deep =
        format!("{}{}", "<scene version='3.0.0'>".to_owned() + &"<bsdf>".repeat(70), "</bsdf>".repeat(70));
    let deep = deep + "</scene>";
    for (xml, wanted) in [
        ("<scene>", "s.xml:1:8: the file ends inside an element"),
        ("<scene></bsdf>", "s.xml:1:8: not well-formed XML: expected 'scene' tag, not 'bsdf'"),
        ("<scene version='three'/>", "s.xml:1:17: \"three\" is not a version such as 3.0.0"),
        ("<scene version='0.6.0'/>", "warning: s.xml:1:1: the scene has no sensor"),
        ("<mesh version='3.0.0'/>", "s.xml:1:1: the outermost element is <mesh>, not <scene>"),
        ("<scene version='3.0.0'/>", "warning: s.xml:1:1: the scene has no sensor"),
        ("", "s.xml:1:1: not well-formed XML: the document does not have a root node"),
        (
            "<!DOCTYPE a [<!ENTITY b 'ha'><!ENTITY c '&b;&b;&b;&b;'>]><scene version='3.0.0'>&c;</scene>",
            "s.xml:1:1: document type definitions are not read",
        ),
        (
            "<scene version='3.0.0'>&c;</scene>",
            "s.xml:1:24: not well-formed XML: unknown entity reference \"c\"",
        ),
        (&deep, "s.xml:1:402: elements are nested deeper than 64 levels"),
        ("<!DOCTYPE a><scene version='3.0.0'/>", "warning: s.xml:1:13: the scene has no sensor"),
    ] {
        assert_eq!(found(xml, &Options::default()), [wanted], "of {xml}");
    }
}

/// Scenes and included files of versions that no Mitsuba had so far render all the same, and say so; what is no version is refused.
#[test]
fn versions_that_are_not_known_are_said() {
    let newer = |version: &str| {
        format!(
            "version {version} is newer than 3, the newest that foton knows, and the file is read as version 3; \
             if it is one, write version=\"3.0.0\""
        )
    };
    let scene = |version: &str| {
        found(
            &format!("<scene version='{version}'><sensor type='perspective'/></scene>"),
            &Options::default(),
        )
    };
    for version in ["99", "4.0.0", "4294967295", " 4.1 "] {
        let wanted = format!("warning: s.xml:1:17: {}", newer(version.trim()));
        assert_eq!(scene(version), [wanted], "of {version}");
    }
    for version in ["3", "3.99.99", "2.1.0", "1.0.0", "0.6.0", "0.0.0"] {
        assert_eq!(scene(version), [""; 0], "of {version}");
    }
    for version in ["", "3.0.0.0", "-1", "+3", "3,0", "three", "3.x", "4294967296", "1e1"] {
        let wanted = format!("s.xml:1:17: \"{version}\" is not a version such as 3.0.0");
        assert_eq!(scene(version), [wanted], "of {version}");
    }
    let included = "<include filename='future.xml'/>";
    assert_all(&[(included, &[&format!("warning: future.xml:1:16: {}", newer("7.0.0"))])]);
}

#[test]
fn all_problems_are_reported_in_one_go_in_the_order_of_the_file() {
    let xml = "<scene version='3.0.0'>
  <integrator type='path'><integer name='max_depth' value='deep'/></integrator>
  <shape type='obj'><string name='filename' value='bad.obj'/><float name='size' value='2'/></shape>
  <bsdf type='diffus'/>
  <shape type='cylnder'><bsdf type='plastc'/></shape>
  <shape type='sphere'>
    <float name='radius' value='$r'/>
    <transform name='to_world'><scale x='a' y='b'/></transform>
  </shape>
  <sensor type='perspective'/>
</scene>";
    let options = Options { defines: vec![("R".to_owned(), "1".to_owned())], ..Options::default() };
    assert_eq!(
        found(xml, &options),
        [
            "s.xml: -D R=1: the scene has no such parameter",
            "s.xml:2:60: \"deep\" is not a whole number",
            "warning: s.xml:3:75: unknown property \"size\" of \"obj\"",
            "warning: s.xml:4:15: unknown bsdf \"diffus\", did you mean \"diffuse\"? (nothing uses it)",
            "s.xml:5:16: unknown shape \"cylnder\", did you mean \"cylinder\"?",
            "s.xml:5:37: unknown bsdf \"plastc\", did you mean \"plastic\"?",
            "s.xml:7:33: unknown parameter \"$r\", did you mean \"$R\"?",
            "s.xml:8:42: \"a\" is not a number",
            "s.xml:8:48: \"b\" is not a number",
            "bad.obj:4:7: there is no vertex 4, the file has 3",
        ]
    );
    let error = read_str("s.xml", xml, &files, &options).unwrap_err();
    assert_eq!(error.to_string().lines().count(), 8, "the message holds the errors only");
}

/// Everything at once, to be broken.
const WHOLE: &str = "<scene version='0.6.0'><default name='r' value='2'/><path value='.'/>
<integrator type='sppm'><integer name='photonCount' value='9'/></integrator>
<texture type='bitmap' id='t'><string name='filename' value='red.png'/><float name='uscale' value='2'/></texture>
<bsdf type='mask' id='m'><ref id='t' name='opacity'/><bsdf type='twosided'><bsdf type='roughplastic'>
<spectrum name='diffuseReflectance' value='400:0.1 500:0.2'/><float name='alpha' value='$r'/></bsdf></bsdf></bsdf>
<alias id='m' as='n'/><include filename='sub/bad.xml'/><include filename='loop.xml'/>
<shape type='cylinder'><ref id='n'/><transform name='toWorld'><lookAt origin='0 0 1' target='0 0 0'/></transform></shape>
<shape type='obj'><string name='filename' value='good.obj'/><emitter type='area'><srgb name='radiance' value='#ff0000'/></emitter></shape>
<emitter type='envmap'><string name='filename' value='red.png'/></emitter><sensor type='perspective'><film type='ldrfilm'/></sensor></scene>";

#[test]
fn any_text_is_read_or_refused_without_panic() {
    let mut state = 7_u64;
    let mut random = |below: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (state >> 33) as usize % below
    };
    for _ in 0..5000 {
        let mut text = WHOLE.to_owned();
        for _ in 0..=random(3) {
            let (from, length) = (random(text.len()), random(30));
            let to = (from + length).min(text.len());
            let piece = text[from..to].repeat(random(3));
            text.replace_range(from..to, &piece);
        }
        let _ = read_str("s.xml", &text, &files, &Options::default());
    }
}

#[test]
fn any_bytes_of_an_image_are_read_or_refused_without_panic() {
    let scene =
        "<scene version='3.0.0'><texture type='bitmap'><string name='filename' value='t'/></texture></scene>";
    let whole = png(1);
    for i in 0..whole.len() {
        for change in [0x01, 0xff] {
            let mut bytes = whole.clone();
            bytes[i] ^= change;
            let read = move |_: &Path| Ok(bytes.clone());
            let _ = read_str("s.xml", scene, &read, &Options::default());
        }
        let short = whole[..i].to_vec();
        let read = move |_: &Path| Ok(short.clone());
        let opened = read_str("s.xml", scene, &read, &Options::default());
        // The checksum of the last chunk is not missed.
        assert!(opened.is_err() || i + 12 > whole.len(), "the first {i} bytes");
    }
}
