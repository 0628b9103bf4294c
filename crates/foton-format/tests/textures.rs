//! Textures of all kinds, as files of both dialects state them.

use std::io::{self, Cursor};
use std::path::Path;

use foton_format::{Options, read_str};
use foton_math::Rgb;
use foton_math::glam::DVec2;
use foton_scene::description::{Bsdf, Colour, Diffuse, SceneDescription, Texture, TextureKind, Wrap};
use image::ImageFormat;

fn png() -> Vec<u8> {
    let mut bytes = Vec::new();
    let pixel = |x, _| image::Rgba([x as u8 * 255, 128, 0, 64]);
    image::RgbaImage::from_fn(2, 1, pixel).write_to(&mut Cursor::new(&mut bytes), ImageFormat::Png).unwrap();
    bytes
}

/// Two by two grey numbers, the lower row first.
fn pfm(big: bool) -> Vec<u8> {
    let numbers = [1.0, 2.0, 3.0, 0.25f32];
    let bytes = |x: &f32| if big { x.to_be_bytes() } else { x.to_le_bytes() };
    let header = if big { "Pf\n2 2\n1.0\n" } else { "Pf 2 2 -1.0\n" };
    header.bytes().chain(numbers.iter().flat_map(bytes)).collect()
}

fn read(version: &str, inside: &str) -> (SceneDescription, Vec<String>) {
    let files = |path: &Path| match path.to_str() {
        Some("t.png") => Ok(png()),
        Some("little.pfm") => Ok(pfm(false)),
        Some("big.pfm") => Ok(pfm(true)),
        _ => Err(io::ErrorKind::NotFound.into()),
    };
    let xml = format!("<scene version='{version}'><sensor type='perspective'/>{inside}</scene>");
    let opened = read_str("s.xml", &xml, &files, &Options::default()).unwrap_or_else(|e| panic!("{e}"));
    (opened.description, opened.warnings.iter().map(ToString::to_string).collect())
}

/// The textures of a diffuse surface whose reflectance is the given one.
fn textures(version: &str, texture: &str) -> Vec<Texture> {
    let (description, warnings) = read(version, &format!("<bsdf type='diffuse'>{texture}</bsdf>"));
    assert!(warnings.is_empty(), "{warnings:?}");
    let last = description.textures.len() - 1;
    let reflectance = Colour::Texture(last);
    assert_eq!(description.materials[0].front, Bsdf::Diffuse(Diffuse { reflectance }));
    description.textures
}

fn pixels(texture: &Texture) -> &[Rgb] {
    let TextureKind::Bitmap { bitmap, .. } = &texture.kind else { panic!("{texture:?}") };
    &bitmap.pixels
}

fn bitmap(inside: &str) -> String {
    format!(
        "<texture name='reflectance' type='bitmap'><string name='filename' value='t.png'/>{inside}</texture>"
    )
}

#[test]
fn a_picture_has_the_channel_and_the_curve_that_an_old_file_asks_for() {
    let first = |inside: &str| pixels(&textures("0.6.0", &bitmap(inside))[0])[0];
    let channel =
        |c: &str| first(&format!("<string name='channel' value='{c}'/><float name='gamma' value='1'/>")).g;
    let grey = 128.0 / 255.0;
    assert_eq!([channel("r"), channel("g"), channel("b")], [0.0, grey, 0.0]);
    assert!((channel("a") - 64.0 / 255.0).abs() < 1e-6, "alpha is no colour");
    assert!((channel("Y") - 0.715_169 * grey).abs() < 1e-6);
    assert!((first("<float name='gamma' value='2.2'/>").g - grey.powf(2.2)).abs() < 1e-6);
    assert!((first("<float name='gamma' value='-1'/>").g - 0.215_86).abs() < 1e-4);
    assert!((first("").g - 0.215_86).abs() < 1e-4, "colours stay as they are, whatever alpha is");
}

#[test]
fn old_names_of_filters_and_wraps_are_read() {
    for filter in ["ewa", "trilinear", "bilinear"] {
        let old =
            format!("<string name='filterType' value='{filter}'/><string name='wrapMode' value='clamp'/>");
        let all = textures("0.5.0", &bitmap(&old));
        assert!(
            matches!(all[0].kind, TextureKind::Bitmap { wrap: Wrap::Clamp, bilinear: true, .. }),
            "{filter}"
        );
    }
    let (description, warnings) = read(
        "0.6.0",
        "<bsdf type='diffuse'><texture name='reflectance' type='bitmap'><string name='filename' value='t.png'/>\
         <string name='wrapModeU' value='mirror'/><string name='wrapModeV' value='repeat'/></texture></bsdf>",
    );
    assert!(matches!(description.textures[0].kind, TextureKind::Bitmap { wrap: Wrap::Mirror, .. }));
    assert_eq!(warnings.len(), 1, "{warnings:?}");
}

#[test]
fn float_maps_are_read_in_both_orders_of_bytes() {
    for name in ["little.pfm", "big.pfm"] {
        let text = format!("<emitter type='envmap'><string name='filename' value='{name}'/></emitter>");
        let (description, _) = read("3.0.0", &text);
        let foton_scene::description::EmitterKind::Environment { bitmap, .. } = &description.emitters[0].kind
        else {
            panic!("{name}")
        };
        assert_eq!(bitmap.pixels, [3.0, 0.25, 1.0, 2.0].map(Rgb::splat), "{name}");
    }
}

#[test]
fn checkerboards_hold_textures() {
    let inner = "<texture type='bitmap' name='color1'><string name='filename' value='t.png'/></texture>";
    let board = |inside: &str| format!("<texture type='checkerboard' name='reflectance'>{inside}</texture>");
    let all = textures("3.0.0", &board(inner));
    let TextureKind::Checkerboard { colours } = all[1].kind else { panic!("{all:?}") };
    assert_eq!(colours, [Colour::Constant(Rgb::splat(0.4)), Colour::Texture(0)]);
    assert_eq!(pixels(&all[0]).len(), 2);
}

#[test]
fn a_factor_is_put_into_the_colours() {
    let scaled = |inside: &str| {
        format!(
            "<texture type='scale' name='reflectance'><float name='scale' value='0.5'/>{inside}</texture>"
        )
    };
    let all = textures("0.6.0", &scaled(&bitmap("")));
    assert_eq!((all.len(), pixels(&all[0])[1].r), (1, 0.5));
    let all = textures("0.6.0", &scaled(&scaled("<texture type='checkerboard'/>")));
    let TextureKind::Checkerboard { colours } = all[0].kind else { panic!("{all:?}") };
    assert_eq!(colours, [0.1, 0.05].map(|c| Colour::Constant(Rgb::splat(c))));
    let (description, warnings) = read(
        "0.6.0",
        &format!(
            "<bsdf type='diffuse'>{}</bsdf>",
            scaled("<texture type='checkerboard'><rgb name='color0' value='1'/></texture>")
                .replace("0.5", "3")
        ),
    );
    let TextureKind::Checkerboard { colours } = description.textures[0].kind else { panic!() };
    assert_eq!(colours[0], Colour::Constant(Rgb::WHITE));
    assert_eq!(warnings.len(), 1, "{warnings:?}");
}

#[test]
fn a_grid_has_lines_along_whole_coordinates() {
    let all = textures(
        "0.6.0",
        "<texture type='gridtexture' name='reflectance'><rgb name='color1' value='1'/>\
         <float name='lineWidth' value='0.05'/><float name='uscale' value='4'/></texture>",
    );
    let TextureKind::Bitmap { bitmap, wrap: Wrap::Repeat, bilinear: false } = &all[0].kind else {
        panic!("{all:?}")
    };
    assert_eq!(bitmap.width, bitmap.height);
    let white = bitmap.pixels.iter().filter(|p| **p == Rgb::WHITE).count() as f64;
    assert!((white / bitmap.pixels.len() as f64 - (1.0 - 0.81)).abs() < 1e-6);
    assert_eq!(bitmap.pixels[bitmap.pixels.len() / 2 + bitmap.width as usize / 2], Rgb::splat(0.2));
    assert_eq!(all[0].to_uv.transform_vector2(DVec2::X), DVec2::X * 4.0);
}

#[test]
fn what_a_mesh_states_is_named_as_in_both_dialects() {
    for (version, plugin, inside, wanted) in [
        (
            "3.0.0",
            "mesh_attribute",
            "<string name='name' value='face_w'/><float name='scale' value='2'/>",
            ("face_w", 2.0),
        ),
        ("0.6.0", "vertexcolors", "", ("vertex_color", 1.0)),
    ] {
        let all =
            textures(version, &format!("<texture type='{plugin}' name='reflectance'>{inside}</texture>"));
        let TextureKind::Attribute { name, scale, most } = &all[0].kind else { panic!("{all:?}") };
        assert_eq!((name.as_str(), *scale, *most), (wanted.0, wanted.1, 1.0));
    }
}

#[test]
fn textures_inside_themselves_are_errors() {
    let files = |_: &Path| Err(io::ErrorKind::NotFound.into());
    let scene = |texture: &str| {
        let xml = format!("<scene version='3.0.0'><sensor type='perspective'/>{texture}</scene>");
        read_str("s.xml", &xml, &files, &Options::default()).expect_err("no scene").to_string()
    };
    for texture in [
        "<texture type='scale' id='a'><ref id='a'/></texture>",
        "<texture type='checkerboard' id='a'><ref name='color0' id='b'/></texture>\
         <texture type='checkerboard' id='b'><ref name='color0' id='a'/></texture>",
        &format!("{}{}", "<texture type='scale'>".repeat(12), "</texture>".repeat(12)),
    ] {
        let said = scene(texture);
        assert!(
            said.contains("made of itself, or of too many") || said.contains("one texture inside"),
            "{said}"
        );
    }
    let said = scene("<texture type='mesh_attribute'><string name='name' value='colour'/></texture>");
    assert!(said.contains("begins with \"vertex_\" or \"face_\""), "{said}");
}

#[test]
fn a_surface_emits_a_picture_and_no_more_than_the_picture_has() {
    let (description, warnings) = read(
        "3.0.0",
        "<texture type='bitmap' id='hdr'><string name='filename' value='little.pfm'/></texture>\
         <shape type='rectangle'><emitter type='area'><ref id='hdr' name='radiance'/></emitter></shape>\
         <bsdf type='diffuse'><ref id='hdr' name='reflectance'/></bsdf>",
    );
    let Some(Colour::Texture(light)) = description.shapes[0].radiance else { panic!("no texture") };
    let Bsdf::Diffuse(Diffuse { reflectance: Colour::Texture(share) }) = description.materials[0].front
    else {
        panic!("no texture")
    };
    let brightest = |i: usize| pixels(&description.textures[i]).iter().fold(0.0, |m: f32, p| m.max(p.r));
    assert_eq!([brightest(light), brightest(share)], [3.0, 1.0]);
    assert_eq!(warnings.len(), 1, "as a share of light it is cut, and that is said: {warnings:?}");
}

/// What a mesh lacks is said once, where the texture asks for it, with the file of the mesh and what it has.
#[test]
fn a_mesh_without_the_attribute_of_its_texture_is_an_error_at_the_texture() {
    const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
        property float r\nproperty float g\nproperty float b\nelement face 1\nproperty list uchar int vertex_indices\n\
        end_header\n0 0 0 1 0 0\n1 0 0 0 1 0\n0 1 0 0 0 1\n3 0 1 2\n";
    let said = |name: &str, shape: &str| {
        let texture = format!(
            "<texture type='mesh_attribute' name='reflectance'><string name='name' value='{name}'/></texture>"
        );
        let xml = format!(
            "<scene version='3.0.0'><sensor type='perspective'/><bsdf type='diffuse' id='paint'>\n{texture}\n</bsdf>\
             <shape type='{shape}'><string name='filename' value='leaf.ply'/><ref id='paint'/></shape>\
             <shape type='ply'><string name='filename' value='leaf.ply'/><ref id='paint'/></shape></scene>"
        );
        let files = |_: &Path| Ok(PLY.into());
        match read_str("s.xml", &xml, &files, &Options::default()) {
            Ok(opened) => opened.warnings.iter().map(ToString::to_string).collect::<Vec<_>>(),
            Err(error) => error.diagnostics().iter().map(ToString::to_string).collect(),
        }
    };
    assert!(said("vertex_color", "ply").is_empty());
    let message = "s.xml:2:1: the shape \"shape-1\" of leaf.ply has no attribute \"vertex_colr\", did you mean \"vertex_color\"?";
    assert_eq!(said("vertex_colr", "ply"), [message]);
    assert!(said("vertex_color", "sphere").iter().any(|m| m.starts_with("s.xml:2:1: the shape \"shape-1\"")));
}
