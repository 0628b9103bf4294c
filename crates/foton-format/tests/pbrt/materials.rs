//! Materials and textures of both versions, as blends of foton's BSDFs.

use foton_math::Rgb;
use foton_scene::bsdf::MicrofacetDistribution;
use foton_scene::description::{
    Bsdf, Colour, Conductor, Dielectric, Diffuse, Material, Mirror, Number, Plastic, ReliefKind,
    SceneDescription, TextureKind, Wrap,
};

use super::{read, read_with, whole};

fn scene_of(material: &str) -> SceneDescription {
    read(&whole(&format!("Material {material} Shape \"sphere\"")))
}

fn material(material: &str) -> Material {
    scene_of(material).materials.swap_remove(0)
}

/// The same in a file of version 3.
fn old(text: &str) -> SceneDescription {
    read(&format!("Film \"image\" Camera \"perspective\" WorldBegin Material {text} Shape \"sphere\""))
}

fn colour(c: Colour) -> Rgb {
    if let Colour::Constant(c) = c { c } else { panic!("{c:?} is a texture") }
}

fn alphas(roughness: Option<foton_scene::bsdf::Microfacets>) -> [f32; 2] {
    let facets = roughness.expect("is rough");
    assert_eq!(facets.distribution, MicrofacetDistribution::Ggx);
    [facets.alpha_u, facets.alpha_v].map(|n| n.constant().expect("is a number"))
}

#[test]
fn defaults_are_those_of_pbrt() {
    let Bsdf::Diffuse(Diffuse { reflectance }) = material("\"diffuse\"").front else { panic!("not diffuse") };
    assert_eq!(reflectance, Rgb::splat(0.5).into());
    let glass = material("\"dielectric\"").front;
    let Bsdf::Dielectric(Dielectric { int_ior, ext_ior, roughness, .. }) = glass else { panic!("{glass:?}") };
    assert_eq!((int_ior, ext_ior, roughness), (1.5, 1.0, None));
    let metal = material("\"conductor\"").front;
    let Bsdf::Conductor(Conductor { eta, k, roughness, .. }) = metal else { panic!("{metal:?}") };
    assert!(eta.g > 0.5 && k.r > 3.0 && roughness.is_none(), "{metal:?}");
    let Bsdf::Mirror(Mirror { reflectance }) = old("\"mirror\"").materials[0].front else {
        panic!("no mirror")
    };
    assert_eq!(reflectance, Rgb::splat(0.9).into());
    // Of a shape without a material.
    assert!(matches!(read(&whole("Shape \"sphere\"")).materials[0].front, Bsdf::Diffuse(_)));
}

#[test]
fn roughness_is_remapped_by_version() {
    let rough = |text: &str| match material(text).front {
        Bsdf::Conductor(Conductor { roughness, .. }) => alphas(roughness),
        other => panic!("{other:?}"),
    };
    assert_eq!(rough("\"conductor\" \"float roughness\" 0.25"), [0.5; 2]);
    assert_eq!(rough("\"conductor\" \"float roughness\" 0.25 \"bool remaproughness\" false"), [0.25; 2]);
    assert_eq!(rough("\"conductor\" \"float uroughness\" 0.04 \"float vroughness\" 0.09"), [0.2, 0.3]);
    let Bsdf::Conductor(Conductor { roughness, .. }) =
        old("\"metal\" \"float roughness\" 1").materials[0].front
    else {
        panic!("no metal")
    };
    assert!((alphas(roughness)[0] - 1.62142).abs() < 1e-5);
}

#[test]
fn a_plastic_of_version_3_is_an_exact_sum_of_its_lobes() {
    let scene = old("\"plastic\" \"rgb Kd\" [0.4 0.2 0.1] \"rgb Ks\" [0.2 0.1 0.1]");
    let [base, gloss] = [0, 1].map(|i| scene.materials[i].front);
    let Bsdf::Diffuse(Diffuse { reflectance }) = base else { panic!("{base:?}") };
    let Bsdf::Conductor(Conductor { eta, k, specular_reflectance, .. }) = gloss else { panic!("{gloss:?}") };
    let [blend] = scene.materials[0].mixture[..] else { panic!("no blend") };
    let Number::Constant(weight) = blend.weight else { panic!("no number") };
    assert_eq!((blend.material, eta, k), (1, Rgb::splat(1.5), Rgb::BLACK));
    let [diffuse, glossy] = [colour(reflectance) * (1.0 - weight), colour(specular_reflectance) * weight];
    for (found, wanted) in [(diffuse, [0.4, 0.2, 0.1]), (glossy, [0.2, 0.1, 0.1])] {
        let error = (found - Rgb::from_array(wanted)).map(f32::abs).max_component();
        assert!(error < 1e-6, "{found:?} is not {wanted:?}");
    }
    assert!(scene.materials.iter().all(|m| m.back == Some(m.front)));
}

#[test]
fn lobes_that_reflect_too_much_become_a_coat() {
    let text = "Film \"image\" Camera \"perspective\" WorldBegin Material \"plastic\" \"rgb Kd\" [.9 .9 .9] Shape \"sphere\"";
    let (scene, warnings) = read_with(text);
    let Bsdf::Plastic(Plastic { int_ior, diffuse_reflectance, .. }) = scene.materials[0].front else {
        panic!("no coat")
    };
    assert_eq!((int_ior, diffuse_reflectance), (1.5, Rgb::splat(0.9).into()));
    assert!(warnings[0].contains("may reflect more than all light"), "{warnings:?}");
}

#[test]
fn uber_has_all_of_its_lobes_and_holes() {
    let scene = old(
        "\"uber\" \"rgb Kd\" [.2 .2 .2] \"rgb Kr\" [.1 .1 .1] \"rgb Kt\" [.3 .3 .3] \"rgb opacity\" [.5 .5 .5]",
    );
    let plugins: Vec<&str> = scene.materials.iter().map(|m| m.front.plugin()).collect();
    assert_eq!(plugins, ["diffuse", "roughconductor", "conductor", "dielectric"]);
    assert!(scene.materials.iter().all(|m| m.opacity == Some(Rgb::splat(0.5).into())));
    // Each blend takes its share of what is left to it: of four in turn, all of the sum.
    let weights: Vec<f32> =
        scene.materials[0].mixture.iter().map(|b| b.weight.constant().expect("a number")).collect();
    let total = 0.85;
    let share = |before: f32, bound: f32| bound / (before + bound);
    let wanted = [share(0.2, 0.25), share(0.45, 0.1), share(0.55, 0.3)];
    assert!(weights.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-6), "{weights:?} {total}");
}

#[test]
fn a_mix_gives_its_amount_to_the_second_or_in_version_3_to_the_first() {
    let named = "MakeNamedMaterial \"a\" \"string type\" \"mirror\" MakeNamedMaterial \"b\" \"string type\" \"matte\"";
    let parts = |text: &str| {
        let scene = read(text);
        let weight = scene.materials[0].mixture[0].weight;
        (scene.materials[0].front.plugin(), scene.materials[1].front.plugin(), weight)
    };
    let new = format!(
        "{named} Material \"mix\" \"string materials\" [\"a\" \"b\"] \"float amount\" 0.3 Shape \"sphere\""
    );
    assert_eq!(parts(&whole(&new)), ("conductor", "diffuse", 0.3.into()));
    let before = format!(
        "Film \"image\" Camera \"perspective\" {named} Material \"mix\" \"string namedmaterial1\" \"a\" \
         \"string namedmaterial2\" \"b\" \"rgb amount\" [0.3 0.3 0.3] Shape \"sphere\""
    );
    assert_eq!(parts(&before), ("diffuse", "conductor", 0.3.into()));
}

#[test]
fn metals_and_glasses_are_known_by_name() {
    let metal = |text: &str| match material(text).front {
        Bsdf::Conductor(Conductor { eta, k, .. }) => (eta, k),
        other => panic!("{other:?}"),
    };
    let (eta, k) = metal("\"conductor\" \"spectrum eta\" \"metal-Au-eta\" \"spectrum k\" \"metal-Au-k\"");
    assert!((eta.b - 1.44205).abs() < 1e-5 && (k.r - 3.983).abs() < 1e-5);
    let (eta, k) = metal("\"conductor\" \"rgb reflectance\" [0.5 0 0.9]");
    let reflected = |k: f32| k * k / (4.0 + k * k);
    assert_eq!(eta, Rgb::WHITE);
    assert!(
        (reflected(k.r) - 0.5).abs() < 1e-5 && reflected(k.g) == 0.0 && (reflected(k.b) - 0.9).abs() < 1e-5
    );
    let glass = material("\"dielectric\" \"spectrum eta\" \"glass-SF11\"").front;
    assert!(matches!(glass, Bsdf::Dielectric(Dielectric { int_ior, .. }) if int_ior == 1.7847));
    let coated = scene_of("\"coatedconductor\" \"float interface.roughness\" 0.04").materials.swap_remove(0);
    let [Some(over), Some(_)] = coated.coatings else { panic!("no coat") };
    assert_eq!((over.int_ior, alphas(over.roughness)), (1.5, [0.2; 2]));
}

#[test]
fn textures_are_composed_and_multiplied() {
    let scene = read(&whole(
        "Texture \"image\" \"spectrum\" \"imagemap\" \"string filename\" \"two.hdr\" \"float scale\" 0.25 \"string wrap\" \"clamp\"\n\
         Texture \"half\" \"spectrum\" \"scale\" \"texture tex\" \"image\" \"float scale\" 0.5\n\
         Texture \"board\" \"spectrum\" \"checkerboard\" \"texture tex1\" \"half\" \"rgb tex2\" [.1 .2 .3] \"float uscale\" 4\n\
         Material \"diffuse\" \"texture reflectance\" \"board\"\n\
         Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"point2 uv\" [0 0 1 0 0 1]",
    ));
    let TextureKind::Checkerboard { colours: [Colour::Texture(inner), second] } = &scene.textures[1].kind
    else {
        panic!("{:?}", scene.textures)
    };
    let TextureKind::Bitmap { bitmap, wrap, .. } = &scene.textures[*inner].kind else { panic!("no picture") };
    assert_eq!((bitmap.pixels[1].g, *wrap, *second), (0.25, Wrap::Clamp, Rgb::new(0.1, 0.2, 0.3).into()));
    // Two squares to the unit for foton, one for pbrt.
    assert_eq!(scene.textures[1].to_uv.matrix2.x_axis.x, 2.0);
}

#[test]
fn mixed_textures_become_one_picture() {
    let (scene, warnings) = read_with(&whole(
        "Texture \"board\" \"float\" \"checkerboard\" \"float uscale\" 2 \"float vscale\" 2\n\
         Texture \"mixed\" \"spectrum\" \"mix\" \"rgb tex1\" [.2 .4 .6] \"rgb tex2\" [.8 0 0] \"texture amount\" \"board\"\n\
         Material \"diffuse\" \"texture reflectance\" \"mixed\"\n\
         Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"point2 uv\" [0 0 1 0 0 1]",
    ));
    let TextureKind::Bitmap { bitmap, .. } = &scene.textures[0].kind else { panic!("no picture") };
    let pixel = |x: u32, y: u32| bitmap.pixels[(y * bitmap.width + x) as usize];
    let last = bitmap.height - 1;
    // The square at the origin has the first number, 1, so that the mixture is the second colour there.
    assert_eq!((pixel(0, last), pixel(0, 0)), (Rgb::new(0.8, 0.0, 0.0), Rgb::new(0.2, 0.4, 0.6)));
    assert!(warnings[0].contains("become one picture"), "{warnings:?}");
}

#[test]
fn heights_normals_and_holes_are_those_of_the_material_and_the_shape() {
    let picture = "Texture \"f\" \"float\" \"imagemap\" \"string filename\" \"two.hdr\" \"float scale\" 0.5";
    let scene = read(&whole(&format!(
        "{picture} Material \"diffuse\" \"texture displacement\" \"f\" Shape \"sphere\" \"float alpha\" 0.25\n\
         Material \"diffuse\" \"string normalmap\" \"two.hdr\" Shape \"sphere\" \"texture alpha\" \"f\""
    )));
    let [bumps, normals] = [0, 1].map(|i| scene.materials[i].relief.expect("a relief").kind);
    assert!(matches!(bumps, ReliefKind::Bump { scale: 1.0 }) && normals == ReliefKind::Normal);
    assert_eq!(scene.materials[0].opacity, Some(Rgb::splat(0.25).into()));
    assert!(matches!(scene.materials[1].opacity, Some(Colour::Texture(_))));
}

#[test]
fn what_is_not_modelled_has_a_stand_in_that_is_said_once() {
    for name in ["hair", "subsurface", "kdsubsurface"] {
        let text = whole(&format!(
            "Material \"{name}\" Shape \"sphere\" Shape \"sphere\" Material \"{name}\" Shape \"disk\""
        ));
        let (scene, warnings) = read_with(&text);
        assert!(matches!(scene.materials[0].front, Bsdf::Plastic(_)), "{name}");
        assert!(warnings.len() == 1 && warnings[0].contains("stands in for"), "{warnings:?}");
    }
}
