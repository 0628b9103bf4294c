//! What materials and textures of a scene file mean, against values worked out by hand or printed by Mitsuba 3.9.1.

mod blends;

use std::io::{self, Cursor};
use std::path::Path;
use std::sync::Arc;

use foton_format::{Opened, Options, open, read_str};
use foton_math::Rgb;
use foton_math::glam::DVec2;
use foton_scene::description::{
    Bitmap, Bsdf, Colour, Conductor, Dielectric, Diffuse, EmitterKind, Material, MicrofacetDistribution,
    Microfacets, Mirror, Null, Number, Plastic, Texture, TextureKind, ThinDielectric, Wrap,
};
use image::ImageFormat;

/// Two by two: red above, grey below, of 8 bits; and the same as 16 bits and as floats.
fn files(path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let mut target = Cursor::new(&mut bytes);
    let shade = |x: u32, y: u32| if y == 0 { [255, 0, 0] } else { [128, 128, x as u8] };
    let written = match path.to_str() {
        Some("t.png" | "sub/t.png") => image::RgbImage::from_fn(2, 2, |x, y| image::Rgb(shade(x, y)))
            .write_to(&mut target, ImageFormat::Png),
        Some("t16.png") => {
            type Image = image::ImageBuffer<image::Rgb<u16>, Vec<u16>>;
            Image::from_pixel(1, 1, image::Rgb([0, 32_768, 65_535])).write_to(&mut target, ImageFormat::Png)
        }
        Some("grey.jpg") => {
            image::GrayImage::from_pixel(8, 8, image::Luma([188])).write_to(&mut target, ImageFormat::Jpeg)
        }
        Some("t.hdr") => image::Rgb32FImage::from_pixel(4, 2, image::Rgb([0.5, 1.0, 3.0]))
            .write_to(&mut target, ImageFormat::Hdr),
        Some("ramp.spd") => return Ok(b"# nm value\n400 0.1\n700 0.9\n".to_vec()),
        _ => return Err(io::ErrorKind::NotFound.into()),
    };
    written.map_err(io::Error::other)?;
    Ok(bytes)
}

/// Reads a scene without a sensor; the other warnings.
fn read_with_warnings(snippet: &str) -> (Opened, Vec<String>) {
    let xml = format!("<scene version='3.0.0'>{snippet}</scene>");
    let opened =
        read_str("s.xml", &xml, &files, &Options::default()).unwrap_or_else(|e| panic!("{snippet}: {e}"));
    let warnings = opened.warnings.iter().map(|w| w.message.clone());
    let warnings = warnings.filter(|w| w != "the scene has no sensor").collect();
    (opened, warnings)
}

fn read(snippet: &str) -> Opened {
    let (opened, warnings) = read_with_warnings(snippet);
    assert!(warnings.is_empty(), "{snippet}: {warnings:?}");
    opened
}

fn material(snippet: &str) -> Material {
    read(snippet).description.materials.remove(0)
}

fn bsdf(plugin: &str, inside: &str) -> Bsdf {
    material(&format!("<bsdf type='{plugin}'>{inside}</bsdf>")).front
}

fn texture(snippet: &str) -> Texture {
    read(snippet).description.textures.remove(0)
}

const WHITE: Colour = Colour::Constant(Rgb::WHITE);

fn grey(value: f32) -> Colour {
    Rgb::splat(value).into()
}

fn beckmann(alpha: f32) -> Microfacets {
    Microfacets::isotropic(MicrofacetDistribution::Beckmann, alpha)
}

fn assert_close(found: Rgb, wanted: [f32; 3], tolerance: f32) {
    for (a, b) in found.to_array().iter().zip(wanted) {
        assert!((a - b).abs() <= tolerance, "{found:?} is not {wanted:?}");
    }
}

#[test]
fn metals_have_the_indices_of_mitsuba() {
    for (name, eta, k) in [
        ("Au", [0.143_036, 0.375_307, 1.442_045], [3.982_997, 2.385_556, 1.603_359]),
        ("Al", [1.657_501, 0.880_405, 0.521_244], [9.223_811, 6.269_502, 4.837_004]),
        ("Cu_palik", [0.213_229, 0.919_715, 1.102_411], [3.921_873, 2.457_332, 2.136_584]),
        ("Hg_palik", [2.398_939, 1.440_028, 0.909_57], [6.327_587, 4.371_925, 3.421_764]),
    ] {
        let smooth = bsdf("conductor", &format!("<string name='material' value='{name}'/>"));
        let Bsdf::Conductor(Conductor {
            eta: found_eta,
            k: found_k,
            specular_reflectance: WHITE,
            roughness: None,
        }) = smooth
        else {
            panic!("{smooth:?}")
        };
        assert_close(found_eta, eta, 1e-5);
        assert_close(found_k, k, 1e-5);
    }
}

#[test]
fn conductors_are_mirrors_only_without_indices() {
    assert_eq!(bsdf("conductor", ""), Bsdf::Mirror(Mirror { reflectance: WHITE }));
    let conductor = |eta: f32, k: f32, roughness| {
        Bsdf::Conductor(Conductor {
            eta: Rgb::splat(eta),
            k: Rgb::splat(k),
            specular_reflectance: WHITE,
            roughness,
        })
    };
    assert_eq!(bsdf("conductor", "<float name='eta' value='1.5'/>"), conductor(1.5, 1.0, None));
    assert_eq!(
        bsdf(
            "conductor",
            "<rgb name='eta' value='3'/><rgb name='k' value='6'/><float name='ext_eta' value='1.5'/>"
        ),
        conductor(2.0, 4.0, None)
    );
    let water =
        "<string name='ext_eta' value='vacuum'/><rgb name='eta' value='3'/><float name='k' value='0'/>";
    assert_eq!(bsdf("conductor", water), conductor(3.0, 0.0, None));
    assert_eq!(bsdf("roughconductor", ""), conductor(0.0, 1.0, Some(beckmann(0.1))));
}

#[test]
fn roughness_is_one_alpha_or_two() {
    let of = |inside: &str| match bsdf("roughconductor", inside) {
        Bsdf::Conductor(Conductor { roughness: Some(roughness), .. }) => roughness,
        other => panic!("{other:?}"),
    };
    assert_eq!(
        of("<float name='alpha' value='0.02'/><boolean name='sample_visible' value='true'/>"),
        beckmann(0.02)
    );
    assert_eq!(of("<float name='alpha' value='0'/>"), beckmann(1e-4));
    let two = of(
        "<string name='distribution' value='ggx'/><float name='alpha_u' value='0.1'/><float name='alpha_v' value='0.3'/>",
    );
    let ggx = MicrofacetDistribution::Ggx;
    assert_eq!(two, Microfacets { distribution: ggx, alpha_u: 0.1.into(), alpha_v: 0.3.into() });
    // A texture may stand for each, inside or by reference.
    let board = "<texture type='checkerboard' name='alpha'/>";
    let textured = Microfacets { alpha_u: Number::Texture(0), alpha_v: Number::Texture(0), ..beckmann(0.1) };
    assert_eq!(of(board), textured);
    let along_v = "<float name='alpha_u' value='0.1'/><texture type='checkerboard' name='alpha_v'/>";
    assert_eq!(of(along_v), Microfacets { alpha_v: Number::Texture(0), ..beckmann(0.1) });
    let shared = read(
        "<texture type='checkerboard' id='t'/><bsdf type='roughplastic'><ref name='alpha' id='t'/></bsdf>",
    );
    let Bsdf::Plastic(plastic) = shared.description.materials[0].front else { panic!("plastic") };
    assert_eq!(plastic.roughness, Some(textured));
}

#[test]
fn glass_may_be_rough_or_thin() {
    let rough =
        bsdf("roughdielectric", "<string name='int_ior' value='water'/><float name='alpha' value='0.2'/>");
    let rough_water = Bsdf::Dielectric(Dielectric {
        int_ior: 1.333,
        ext_ior: 1.000_277,
        specular_reflectance: WHITE,
        specular_transmittance: WHITE,
        roughness: Some(beckmann(0.2)),
    });
    assert_eq!(rough, rough_water);
    let thin = bsdf("thindielectric", "<rgb name='specular_transmittance' value='0.5'/>");
    let pane = Bsdf::ThinDielectric(ThinDielectric {
        int_ior: 1.5046,
        ext_ior: 1.000_277,
        specular_reflectance: WHITE,
        specular_transmittance: grey(0.5),
    });
    assert_eq!(thin, pane);
    assert_eq!(bsdf("null", ""), Bsdf::Null(Null));
}

#[test]
fn plastic_has_mitsubas_defaults() {
    let plastic = |nonlinear, roughness| {
        Bsdf::Plastic(Plastic {
            int_ior: 1.49,
            ext_ior: 1.000_277,
            diffuse_reflectance: grey(0.5),
            specular_reflectance: WHITE,
            nonlinear,
            roughness,
        })
    };
    assert_eq!(bsdf("plastic", ""), plastic(false, None));
    assert_eq!(
        bsdf("roughplastic", "<boolean name='nonlinear' value='true'/>"),
        plastic(true, Some(beckmann(0.1)))
    );
}

#[test]
fn masks_stand_around_two_sides_and_multiply() {
    let diffuse = "<bsdf type='diffuse'/>";
    let mask = |opacity: &str, inside: &str| format!("<bsdf type='mask'>{opacity}{inside}</bsdf>");
    assert_eq!(material(&mask("", diffuse)).opacity, Some(grey(0.5)));
    let two = material(&mask(
        "<float name='opacity' value='0.25'/>",
        &format!("<bsdf type='twosided'>{diffuse}</bsdf>"),
    ));
    assert_eq!((two.opacity, two.back.is_some()), (Some(grey(0.25)), true));
    let twice = material(&mask("<float name='opacity' value='0.25'/>", &mask("", diffuse)));
    assert_eq!(twice.opacity, Some(grey(0.125)));
    let textured = material(&mask("<texture name='opacity' type='checkerboard'/>", diffuse));
    assert_eq!(textured.opacity, Some(Colour::Texture(0)));
}

#[test]
fn bitmaps_are_linear_and_upside_down_as_in_mitsuba() {
    let file = |name: &str, more: &str| {
        let texture = texture(&format!(
            "<texture type='bitmap'><string name='filename' value='{name}'/>{more}</texture>"
        ));
        let TextureKind::Bitmap { bitmap, wrap, bilinear } = texture.kind else { panic!("{texture:?}") };
        (texture.to_uv, bitmap, wrap, bilinear)
    };
    let (to_uv, bitmap, wrap, bilinear) = file("t.png", "");
    assert_eq!((bitmap.width, bitmap.height, wrap, bilinear), (2, 2, Wrap::Repeat, true));
    assert_eq!(bitmap.pixels[0], Rgb::new(1.0, 0.0, 0.0));
    assert_close(bitmap.pixels[2], [0.215_86, 0.215_86, 0.0], 1e-5);
    // Mitsuba's (0, 0) is the first pixel, which is v = 1 in a description.
    assert_eq!(to_uv.transform_point2(DVec2::new(0.25, 0.0)), DVec2::new(0.25, 1.0));
    let raw = file("t.png", "<boolean name='raw' value='true'/><string name='wrap_mode' value='mirror'/>");
    assert_close(raw.1.pixels[2], [0.501_96, 0.501_96, 0.0], 1e-5);
    assert_eq!(raw.2, Wrap::Mirror);
    let nearest = "<string name='filter_type' value='nearest'/><string name='wrap_mode' value='clamp'/>";
    let (_, deep, wrap, bilinear) = file("t16.png", nearest);
    assert_close(deep.pixels[0], [0.0, 0.213_99, 1.0], 1e-4);
    assert_eq!((wrap, bilinear), (Wrap::Clamp, false));
    assert_close(file("grey.jpg", "").1.pixels[9], [0.502_89; 3], 0.01);
    let scaled = "<transform name='to_uv'><scale x='2' y='2'/><translate x='0.5'/></transform>";
    let (to_uv, ..) = file("t.png", scaled);
    assert_eq!(to_uv.transform_point2(DVec2::new(0.25, 0.25)), DVec2::new(1.0, 0.5));
}

#[test]
fn factors_beyond_one_are_cut_with_a_warning() {
    let snippet = "<texture type='bitmap'><string name='filename' value='t.hdr'/></texture>";
    let (opened, warnings) = read_with_warnings(snippet);
    assert_eq!(warnings, ["t.hdr has pixels outside 0 to 1, they are cut to that"]);
    let TextureKind::Bitmap { bitmap, .. } = &opened.description.textures[0].kind else { panic!() };
    assert_close(bitmap.pixels[0], [0.5, 1.0, 1.0], 0.01);
}

#[test]
fn every_material_makes_a_scene() {
    let leaves =
        ["conductor", "roughconductor", "dielectric", "roughdielectric", "thindielectric", "plastic"];
    for plugin in leaves.into_iter().chain(["roughplastic", "null", "diffuse"]) {
        let opened = read(&format!(
            "<sensor type='perspective'/><emitter type='envmap'><string name='filename' value='t.hdr'/></emitter>\
             <shape type='rectangle'><bsdf type='mask'><texture name='opacity' type='checkerboard'/>\
             <bsdf type='{plugin}'/></bsdf></shape><shape type='cylinder'/>"
        ));
        let built = foton_scene::Scene::build(&opened.description);
        assert!(built.is_ok(), "{plugin}: {:?}", built.err());
    }
}

#[test]
fn textures_stand_once_and_pixels_too() {
    let file = "<string name='filename' value='t.png'/>";
    let opened = read(&format!(
        "<texture type='bitmap' id='wood'>{file}</texture>\
         <bsdf type='diffuse'><ref id='wood' name='reflectance'/></bsdf>\
         <bsdf type='plastic'><ref id='wood' name='diffuse_reflectance'/></bsdf>\
         <bsdf type='diffuse'><texture name='reflectance' type='bitmap'>{file}</texture></bsdf>"
    ));
    let description = &opened.description;
    assert_eq!(
        description.textures.iter().map(|t| t.name.as_str()).collect::<Vec<_>>(),
        ["wood", "bitmap-2"]
    );
    let fronts: Vec<_> = description.materials.iter().map(|m| m.front).collect();
    assert_eq!(fronts[0], Bsdf::Diffuse(Diffuse { reflectance: Colour::Texture(0) }));
    assert!(matches!(fronts[1], Bsdf::Plastic(Plastic { diffuse_reflectance: Colour::Texture(0), .. })));
    assert_eq!(fronts[2], Bsdf::Diffuse(Diffuse { reflectance: Colour::Texture(1) }));
    let pixels = |texture: &Texture| match &texture.kind {
        TextureKind::Bitmap { bitmap, .. } => Arc::clone(bitmap),
        other => panic!("{other:?}"),
    };
    assert!(Arc::ptr_eq(&pixels(&description.textures[0]), &pixels(&description.textures[1])));
}

#[test]
fn checkerboards_have_mitsubas_defaults_and_the_scales_of_old_files() {
    let plain = texture("<texture type='checkerboard'/>");
    let TextureKind::Checkerboard { colours } = plain.kind else { panic!("{plain:?}") };
    assert_eq!(colours, [0.4, 0.2].map(|c| Colour::Constant(Rgb::splat(c))));
    let scaled = texture(
        "<texture type='checkerboard'><float name='uscale' value='3'/><float name='uoffset' value='0.25'/></texture>",
    );
    // Mitsuba prints the matrix 3 0 0.75, 0 1 0.
    assert_eq!(scaled.to_uv.transform_point2(DVec2::new(1.0, 1.0)), DVec2::new(3.75, 1.0));
}

#[test]
fn spectra_become_colours() {
    let reflectance = |tag: &str| match bsdf("diffuse", tag) {
        Bsdf::Diffuse(Diffuse { reflectance: Colour::Constant(colour) }) => colour,
        other => panic!("{other:?}"),
    };
    let ramp = [0.742_853, 0.481_14, 0.208_325];
    assert_close(reflectance("<spectrum name='reflectance' value='400:0.1, 700:0.9'/>"), ramp, 2e-3);
    assert_close(reflectance("<spectrum name='reflectance' filename='ramp.spd'/>"), ramp, 2e-3);
    let white = reflectance("<spectrum name='reflectance' value='300:1, 900:1'/>");
    assert_close(white, [1.0; 3], 1e-3);
    let sun = read(
        "<emitter type='directional'><vector name='direction' value='0 -2 0'/>\
         <spectrum name='irradiance' value='400:0.1, 700:0.9'/></emitter>",
    );
    let EmitterKind::Directional { direction, irradiance } = &sun.description.emitters[0].kind else {
        panic!()
    };
    assert_eq!(direction.y, -2.0);
    assert_close(*irradiance, [0.872_215, 0.458_728, 0.181_301], 2e-3);
}

#[test]
fn an_environment_keeps_its_radiance_and_place() {
    let opened = read(
        "<emitter type='envmap'><string name='filename' value='t.hdr'/><float name='scale' value='2'/>\
         <transform name='to_world'><rotate y='1' angle='90'/></transform></emitter>",
    );
    let EmitterKind::Environment { to_world, bitmap, scale } = &opened.description.emitters[0].kind else {
        panic!()
    };
    assert_eq!((bitmap.width, bitmap.height, *scale), (4, 2, 2.0));
    assert_close(bitmap.pixels[7], [0.5, 1.0, 3.0], 0.02);
    assert!((to_world.matrix3.z_axis.x - 1.0).abs() < 1e-12);
}

#[test]
fn exr_images_are_read_from_the_disk() {
    let folder = std::env::temp_dir().join(format!("foton-format-exr-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let mut image = foton_film::Image::black(2, 1);
    image.pixels[1] = Rgb::new(0.25, 0.5, 0.75);
    foton_film::write_exr(&folder.join("t.exr"), &image, &[], &foton_film::Metadata::default()).unwrap();
    let scene = "<scene version='3.0.0'><sensor type='perspective'/><texture type='bitmap'>\
                 <string name='filename' value='t.exr'/></texture></scene>";
    std::fs::write(folder.join("s.xml"), scene).unwrap();
    let opened = open(&folder.join("s.xml"), &Options::default());
    std::fs::remove_dir_all(&folder).unwrap();
    let opened = opened.unwrap();
    let TextureKind::Bitmap { bitmap, .. } = &opened.description.textures[0].kind else { panic!() };
    let Bitmap { width, height, pixels, .. } = &**bitmap;
    assert_eq!((*width, *height, pixels[1]), (2, 1, Rgb::new(0.25, 0.5, 0.75)));
}
