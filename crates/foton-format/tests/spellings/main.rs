//! One meaning in many spellings: what files of all versions write, with the values that their authors meant.

mod parts;
mod skies;

use std::io;
use std::path::Path;

use foton_format::{Opened, Options, Severity, open, read_str};
use foton_math::Rgb;
use foton_math::glam::DVec3;
use foton_scene::description::{
    Bsdf, Colour, Conductor, Diffuse, EmitterKind, Filter, Geometry, Mirror, TextureKind,
};

fn files(path: &Path) -> io::Result<Vec<u8>> {
    match path.to_str() {
        Some("t.obj") => Ok(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n".to_vec()),
        Some("ramp.spd") => Ok(b"# nm value\n400 0.1\n700 0.9\n".to_vec()),
        Some("own/Au.eta.spd") => Ok(b"300 2\n900 2\n".to_vec()),
        _ => Err(io::ErrorKind::NotFound.into()),
    }
}

fn read_as(version: &str, snippet: &str, options: &Options) -> Opened {
    let xml = format!("<scene version='{version}'><sensor type='perspective'/>\n{snippet}</scene>");
    read_str("s.xml", &xml, &files, options).unwrap_or_else(|e| panic!("{snippet}: {e}"))
}

fn read(snippet: &str) -> Opened {
    let opened = read_as("2.1.0", snippet, &Options::default());
    assert_eq!(opened.warnings, [], "{snippet}");
    opened
}

fn warnings(opened: &Opened) -> Vec<String> {
    opened.warnings.iter().map(ToString::to_string).collect()
}

fn errors(snippet: &str) -> Vec<String> {
    let xml = format!("<scene version='3.0.0'><sensor type='perspective'/>\n{snippet}</scene>");
    let error = read_str("s.xml", &xml, &files, &Options::default()).expect_err("an error");
    let errors = error.diagnostics().iter().filter(|d| d.severity == Severity::Error);
    errors.map(ToString::to_string).collect()
}

/// What a spelling of a radiance means.
fn radiance(spelling: &str) -> Rgb {
    let opened = read(&format!("<shape type='cube'><emitter type='area'>{spelling}</emitter></shape>"));
    let Some(Colour::Constant(radiance)) = opened.description.shapes[0].radiance else { panic!("it emits") };
    radiance
}

/// What a spelling of a reflectance means.
fn reflectance(spelling: &str) -> Rgb {
    let opened = read(&format!("<shape type='cube'><bsdf type='diffuse'>{spelling}</bsdf></shape>"));
    match opened.description.materials[0].front {
        Bsdf::Diffuse(Diffuse { reflectance: Colour::Constant(colour) }) => colour,
        ref other => panic!("{other:?}"),
    }
}

fn assert_close(found: Rgb, wanted: [f32; 3], what: &str) {
    let is_close = |(a, b): (&f32, f32)| (a - b).abs() <= 2e-3 * b.abs().max(1.0);
    assert!(found.to_array().iter().zip(wanted).all(is_close), "{what}: {found:?} is not {wanted:?}");
}

#[test]
fn three_numbers_of_a_spectrum_are_red_green_and_blue() {
    for value in ["0.1, 0.2, 0.3", "0.1 0.2 0.3", "0.1,0.2,0.3", " .1  2e-1 ,0.3, "] {
        for intent in ["", "intent='illuminant'", "intent='reflectance'"] {
            let colour = Rgb::new(0.1, 0.2, 0.3);
            assert_eq!(radiance(&format!("<spectrum name='radiance' {intent} value='{value}'/>")), colour);
            assert_eq!(
                reflectance(&format!("<spectrum {intent} value='{value}' name='reflectance'/>")),
                colour
            );
            assert_eq!(reflectance(&format!("<rgb value='{value}' name='reflectance' {intent}/>")), colour);
        }
    }
    let count = "s.xml:2:63: a spectrum has one number, three (red, green and blue) or wavelengths with their values, such as \
                 400:0.1 700:0.2, not 2 numbers";
    let two =
        "<shape type='cube'><bsdf type='diffuse'><spectrum value='1 2' name='reflectance'/></bsdf></shape>";
    assert_eq!(errors(two), [count.replace(":63:", ":58:")]);
}

#[test]
fn a_spectrum_of_one_number_is_that_of_mitsuba() {
    // Printed by Mitsuba 3.9.1.
    assert_close(
        radiance("<spectrum name='radiance' value='0.5'/>"),
        [0.602_397, 0.474_146, 0.454_458],
        "light",
    );
    assert_eq!(reflectance("<spectrum name='reflectance' value='0.5'/>"), Rgb::splat(0.5));
}

#[test]
fn wavelengths_are_those_of_mitsuba_in_every_spelling() {
    // Printed by Mitsuba 3.9.1.
    for value in ["400:0.1 700:0.2", "400:0.1, 700:0.2", "400:0.1,700:0.2", " 400 : 0.1 , 700: .2"] {
        let light = radiance(&format!("<spectrum name='radiance' value='{value}'/>"));
        assert_close(light, [0.214, 0.140_424, 0.101_714], value);
        let share =
            reflectance(&format!("<spectrum name='reflectance' value='{value}' intent='reflectance'/>"));
        assert_close(share, [0.179_949, 0.147_621, 0.113_095], value);
    }
    let of_file = reflectance("<spectrum name='reflectance' filename='ramp.spd'/>");
    assert_close(of_file, [0.742_853, 0.481_140, 0.208_325], "a file");
}

#[test]
fn colours_of_srgb_and_hexadecimal_ones_are_read_wherever_colours_stand() {
    let half = 128.0 / 255.0;
    for (spelling, wanted) in [
        ("<rgb name='reflectance' value='#ff8000'/>", [1.0, half, 0.0]),
        ("<spectrum name='reflectance' value='#FF8000'/>", [1.0, half, 0.0]),
        ("<srgb name='reflectance' value='#ff8000'/>", [1.0, 0.215_86, 0.0]),
        ("<srgb name='reflectance' value='1, 0.5, 0' intent='reflectance'/>", [1.0, 0.214_041, 0.0]),
        ("<float name='reflectance' value='.25'/>", [0.25; 3]),
        ("<integer name='reflectance' value='1'/>", [1.0; 3]),
    ] {
        assert_close(reflectance(spelling), wanted, spelling);
    }
}

#[test]
fn black_bodies_glow_by_plancks_law() {
    // Integrals over what Mitsuba 3.9.1 says of a black body of 5000 K.
    let light = [15_263.054, 12_082.584, 9_592.587];
    for (spelling, scale) in [
        ("<blackbody name='radiance' temperature='5000'/>", 1.0),
        ("<blackbody temperature='5000K' scale='1e-3' name='radiance'/>", 1e-3),
        (
            "<spectrum type='blackbody' name='radiance'><float name='temperature' value='5000'/></spectrum>",
            1.0,
        ),
    ] {
        assert_close(radiance(spelling), light.map(|c| c * scale), spelling);
    }
    let cold = "<shape type='cube'><emitter type='area'><blackbody name='radiance' temperature='-3K'/></emitter></shape>";
    assert_eq!(errors(cold), ["s.xml:2:81: \"-3K\" is no temperature above zero"]);
}

#[test]
fn plugins_of_spectra_are_colours() {
    let plugin = |name: &str, kind: &str, inside: &str| {
        format!("<spectrum type='{kind}' name='{name}'>{inside}</spectrum>")
    };
    let colour = "<rgb name='color' value='0.2 0.4 0.6'/>";
    // As Mitsuba 3.9.1 evaluates them in RGB.
    for (kind, inside, wanted) in [
        ("uniform", "<float name='value' value='0.5'/>", [0.5; 3]),
        ("d65", "<float name='scale' value='0.5'/>", [0.5; 3]),
        ("d65", colour, [0.2, 0.4, 0.6]),
        ("srgb", colour, [0.2, 0.4, 0.6]),
        ("rawconstant", "<vector name='value' value='0.2 0.4 0.6'/>", [0.2, 0.4, 0.6]),
        ("rawconstant", "<float name='value' value='0.5'/>", [0.5; 3]),
    ] {
        assert_close(radiance(&plugin("radiance", kind, inside)), wanted, kind);
        assert_close(reflectance(&plugin("reflectance", kind, inside)), wanted, kind);
    }
    // As a spectrum of the same wavelengths.
    let regular = "<float name='wavelength_min' value='400'/><float name='wavelength_max' value='700'/><string name='values' value='0.1, 0.3, 0.2'/>";
    let irregular =
        "<string name='wavelengths' value='400 550 700'/><string name='values' value='0.1, 0.3, 0.2'/>";
    for (kind, inside) in [("regular", regular), ("irregular", irregular)] {
        for (name, read) in [("radiance", radiance as fn(&str) -> Rgb), ("reflectance", reflectance)] {
            let plain = read(&format!("<spectrum name='{name}' value='400:0.1 550:0.3 700:0.2'/>"));
            assert_eq!(read(&plugin(name, kind, inside)), plain, "{kind}");
        }
    }
    // One that refers to itself ends.
    let itself = "<shape type='cube'><bsdf type='diffuse'><spectrum type='srgb' id='a' name='reflectance'><ref id='a' name='color'/></spectrum></bsdf></shape>";
    assert_eq!(errors(itself).len(), 1);
}

#[test]
fn metals_of_mitsuba_are_known_without_their_files() {
    let metal = |inside: &str| match read(&format!(
        "<shape type='cube'><bsdf type='conductor'>{inside}</bsdf></shape>"
    ))
    .description
    .materials[0]
        .front
    {
        Bsdf::Conductor(Conductor { eta, k, .. }) => (eta, k),
        ref other => panic!("{other:?}"),
    };
    let files = |folder: &str| {
        format!(
            "<spectrum name='eta' filename='{folder}Au.eta.spd'/><spectrum name='k' filename='{folder}Au.k.spd'/>"
        )
    };
    let gold = metal("<string name='material' value='Au'/>");
    assert_eq!((metal(&files("")), metal(&files("data/ior/"))), (gold, gold));
    // A file that is there counts.
    let (eta, k) = metal(&files("own/"));
    assert_close(eta, [2.0; 3], "a flat spectrum");
    assert_eq!(k, gold.1);
}

#[test]
fn what_lies_a_little_outside_the_gamut_is_cut_and_said() {
    let opened = read_as(
        "3.0.0",
        "<shape type='cube'><bsdf type='roughconductor'><rgb name='eta' value='1.6 0.9 -0.05'/><rgb name='k' value='9 6 5'/></bsdf></shape>\
         <shape type='cube'><bsdf type='diffuse'><rgb name='reflectance' value='1.02 0.5 -0.01'/></bsdf><emitter type='area'>\
         <rgb name='radiance' value='10 2 -0.3'/></emitter></shape>",
        &Options::default(),
    );
    let Bsdf::Conductor(Conductor { eta, .. }) = opened.description.materials[0].front else { panic!() };
    assert_eq!(eta, Rgb::new(1.6, 0.9, 0.0));
    let grey = Bsdf::Diffuse(Diffuse { reflectance: Rgb::new(1.0, 0.5, 0.0).into() });
    assert_eq!(
        (opened.description.materials[1].front, opened.description.shapes[1].radiance),
        (grey, Some(Rgb::new(10.0, 2.0, 0.0).into()))
    );
    assert_eq!(opened.warnings.len(), 3);
    assert!(opened.warnings.iter().all(|w| w.message.contains("outside sRGB")), "{:?}", opened.warnings);
}

#[test]
fn comments_may_hold_hyphens() {
    let opened = read("<!-- <shape type='cube'/> -- off ---><shape type='sphere'/><!---->");
    assert_eq!(opened.description.shapes.len(), 1);
}

#[test]
fn files_of_windows_are_read() {
    let folder = std::env::temp_dir().join(format!("foton-spellings-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let xml = "\u{feff}<?xml version='1.0' encoding='utf-8'?>\r\n<scene version='2.0.0'>\r\n<sensor type='perspective'/>\r\n<shape type='sphere' id='größe'>\r\n<float name='radus' value='2'/></shape>\r\n</scene>\r\n";
    let latin_1: Vec<u8> =
        xml.replace('\u{feff}', "").replace("utf-8", "ISO-8859-1").chars().map(|c| c as u8).collect();
    let utf16: Vec<u8> = xml.encode_utf16().flat_map(u16::to_le_bytes).collect();
    for (name, bytes) in [("utf8.xml", xml.as_bytes()), ("latin1.xml", &latin_1), ("utf16.xml", &utf16)] {
        let path = folder.join(name);
        std::fs::write(&path, bytes).unwrap();
        let opened = open(&path, &Options::default()).unwrap();
        assert_eq!(opened.description.shapes[0].name, "größe");
        let warning = &opened.warnings[0];
        assert_eq!((warning.line, warning.column), (5, 14), "{name}");
        let excerpt = warning.excerpt.clone().unwrap();
        assert_eq!(
            (excerpt.line.as_str(), excerpt.column, excerpt.length),
            ("<float name='radus' value='2'/></shape>", 13, 5)
        );
    }
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn films_filters_and_samplers_may_stand_anywhere() {
    let film =
        "<film type='hdrfilm'><integer name='width' value='7'/><integer name='height' value='5'/></film>";
    let filter = "<rfilter type='box'/>";
    let opened = read_as("0.6.0", &format!("{film}{filter}<sampler type='sobol'/>"), &Options::default());
    let camera = &opened.description.sensors[0];
    assert_eq!((camera.width, camera.height, camera.filter), (7, 5, Filter::Box { radius: 0.5 }));
    let said = ["film", "rfilter"]
        .map(|tag| format!("this {tag} stands in no sensor; sensors that have none take it"));
    assert_eq!(opened.warnings.iter().map(|w| w.message.clone()).collect::<Vec<_>>(), said);
    let beside = read(&format!("<sensor type='perspective'>{film}{filter}<sampler type='any'/></sensor>"));
    let camera = &beside.description.sensors[1];
    assert_eq!((camera.width, camera.filter), (7, Filter::Box { radius: 0.5 }));
    // A film of its own stays.
    let own = format!(
        "{film}<sensor type='perspective'><film type='hdrfilm'><integer name='width' value='3'/></film></sensor>"
    );
    assert_eq!(read_as("3.0.0", &own, &Options::default()).description.sensors[1].width, 3);
}

#[test]
fn films_and_filters_that_are_not_known_are_replaced() {
    let opened = read_as(
        "3.0.0",
        "<sensor type='perspective'><film type='specfilm'><integer name='width' value='7'/><rfilter type='lanczos'><integer name='lobes' value='3'/></rfilter></film></sensor>",
        &Options::default(),
    );
    let camera = &opened.description.sensors[1];
    assert_eq!((camera.width, camera.filter), (7, Filter::Gaussian { stddev: 0.5 }));
    assert_eq!(
        warnings(&opened),
        [
            "s.xml:2:40: film \"specfilm\" is not supported, \"hdrfilm\" stands for it",
            "s.xml:2:98: rfilter \"lanczos\" is not supported, \"gaussian\" stands for it"
        ]
    );
}

#[test]
fn names_are_read_in_any_case() {
    for name in ["toWorld", "to_world", "ToWorld", "TOWORLD", "toworld"] {
        for version in ["0.6.0", "2.0.0", "3.0.0"] {
            let snippet = format!(
                "<shape type='sphere'><transform name='{name}'><lookAt origin='1 0 0' target='0 0 0' up='0 1 0'/></transform></shape>"
            );
            let opened = read_as(version, &snippet, &Options::default());
            assert_eq!(opened.description.shapes[0].to_world.translation, DVec3::X, "{name}");
        }
    }
    let opened = read_as(
        "3.0.0",
        "<integrator type='sppm'><integer name='photonCount' value='9'/><float name='initialRadius' value='0.5'/><integer name='maxDepth' value='4'/></integrator>",
        &Options::default(),
    );
    let suggested =
        (opened.suggested.photons_per_pass, opened.suggested.radius, opened.description.max_depth);
    assert_eq!(suggested, (Some(9), Some(0.5), Some(4)));
    assert_eq!(
        warnings(&opened)[0],
        "s.xml:2:40: unknown property \"photonCount\" of \"integrator\" is read as \"photon_count\""
    );
    // The exact name comes first.
    let two = read_as(
        "3.0.0",
        "<shape type='sphere'><float name='Radius' value='3'/><float name='radius' value='2'/></shape>",
        &Options::default(),
    );
    assert!(matches!(two.description.shapes[0].geometry, Geometry::Sphere { radius: 2.0, .. }));
    assert_eq!(two.warnings.len(), 1);
}

#[test]
fn the_words_of_the_oldest_files_are_renewed() {
    let opened = read_as(
        "0.2.0",
        "<camera type='perspective'><transform name='toWorld'><lookAt ox='0' oy='0' oz='4' tx='0' ty='0' tz='0' ux='0' uy='1' uz='0'/></transform>\
         <film type='exrfilm'><integer name='width' value='7'/></film></camera>\
         <shape type='cube'><bsdf type='lambertian'><rgb name='reflectance' value='.25'/></bsdf>\
         <luminaire type='area'><rgb name='intensity' value='3'/></luminaire></shape>\
         <shape type='cube'><bsdf type='mirror'/></shape>\
         <luminaire type='constant'><spectrum name='intensity' value='1, 2, 3'/></luminaire>",
        &Options::default(),
    );
    assert_eq!(warnings(&opened), [""; 0]);
    let description = &opened.description;
    let camera = &description.sensors[1];
    assert_eq!((camera.to_world.translation, camera.width), (DVec3::new(0.0, 0.0, 4.0), 7));
    assert_eq!(
        description.materials[0].front,
        Bsdf::Diffuse(Diffuse { reflectance: Rgb::splat(0.25).into() })
    );
    assert_eq!(description.shapes[0].radiance, Some(Rgb::splat(3.0).into()));
    assert_eq!(description.materials[1].front, Bsdf::Mirror(Mirror { reflectance: Rgb::WHITE.into() }));
    assert!(
        matches!(&description.emitters[0].kind, EmitterKind::Constant { radiance } if *radiance == Rgb::new(1.0, 2.0, 3.0))
    );
}
