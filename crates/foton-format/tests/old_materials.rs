//! Materials that Mitsuba 0.6 has and Mitsuba 3 does not: their defaults, and how old files name their parameters.

use std::io;
use std::path::Path;

use foton_format::{Options, read_str};
use foton_math::Rgb;
use foton_scene::description::{
    Bsdf, Coating, Colour, DiffuseTransmitter, Material, MicrofacetDistribution, Number, Phong, RoughDiffuse,
    Ward,
};

fn no_files(_: &Path) -> io::Result<Vec<u8>> {
    Err(io::ErrorKind::NotFound.into())
}

fn bsdf(plugin: &str, inside: &str) -> Bsdf {
    let xml = format!("<scene version='3.0.0'><bsdf type='{plugin}'>{inside}</bsdf></scene>");
    let opened = read_str("s.xml", &xml, &no_files, &Options::default()).expect("a scene");
    opened.description.materials[0].front
}

fn grey(value: f32) -> Colour {
    Rgb::splat(value).into()
}

#[test]
fn plugins_of_mitsuba_0_6_are_read_with_their_defaults_and_old_names() {
    let board = "<texture name='exponent' type='checkerboard'/>";
    let phong = |exponent| {
        Bsdf::Phong(Phong { exponent, specular_reflectance: grey(0.2), diffuse_reflectance: grey(0.5) })
    };
    assert_eq!(bsdf("phong", ""), phong(30.0.into()));
    assert_eq!(bsdf("phong", board), phong(Number::Texture(0)));
    let ward = |variant, u: f32, v: f32| {
        let (specular_reflectance, diffuse_reflectance) = (grey(0.2), grey(0.5));
        Bsdf::Ward(Ward {
            variant,
            alpha_u: u.into(),
            alpha_v: v.into(),
            specular_reflectance,
            diffuse_reflectance,
        })
    };
    assert_eq!(bsdf("ward", ""), ward(0, 0.1, 0.1));
    let stretched = "<string name='variant' value='ward-duer'/><float name='alpha_u' value='0.3'/>";
    assert_eq!(bsdf("ward", stretched), ward(2, 0.3, 0.1));
    let rough = |alpha: f32, use_fast_approx| {
        Bsdf::RoughDiffuse(RoughDiffuse { reflectance: grey(0.5), alpha: alpha.into(), use_fast_approx })
    };
    assert_eq!(bsdf("roughdiffuse", ""), rough(0.2, false));
    let transmittance = grey(0.5);
    assert_eq!(bsdf("difftrans", ""), Bsdf::DiffuseTransmitter(DiffuseTransmitter { transmittance }));
    // As files of version 0 say it.
    let old = "<scene version='0.6.0'><bsdf type='roughdiffuse'><float name='alpha' value='0.7'/>\
               <boolean name='useFastApprox' value='true'/><rgb name='diffuseReflectance' value='0.5'/></bsdf>\
               <bsdf type='roughconductor'><string name='distribution' value='as'/>\
               <float name='alphaU' value='0.1'/><float name='alphaV' value='0.2'/></bsdf></scene>";
    let opened = read_str("s.xml", old, &no_files, &Options::default()).expect("an old scene");
    let materials = opened.description.materials;
    assert_eq!(materials[0].front, rough(0.7, true));
    let Some(facets) = materials[1].front.roughness() else { panic!("a rough metal") };
    assert_eq!((facets.distribution, facets.alpha_v), (MicrofacetDistribution::Phong, 0.2.into()));
}

/// The first material of a scene, and its warnings.
fn material(inside: &str) -> (Material, Vec<String>) {
    let xml = format!("<scene version='0.6.0'>{inside}</scene>");
    let opened = read_str("s.xml", &xml, &no_files, &Options::default()).expect("a scene");
    let warnings = opened.warnings.iter().map(|w| w.message.clone());
    let of_coatings = warnings.filter(|w| w.contains("coating")).collect();
    (opened.description.materials[0].clone(), of_coatings)
}

#[test]
fn coatings_lie_over_each_side_and_over_each_of_a_blend() {
    let of = |rough, sigma_a: Rgb, thickness: f32| Coating {
        sigma_a: sigma_a.into(),
        thickness: thickness.into(),
        ..Coating::default(rough)
    };
    let amber = "<rgb name='sigmaA' value='0.1, 0.5, 4'/><float name='thickness' value='2'/>";
    let diffuse = "<bsdf type='diffuse'/>";
    let smooth = of(false, Rgb::new(0.1, 0.5, 4.0), 2.0);
    let (it, warnings) = material(&format!("<bsdf type='coating'>{amber}{diffuse}</bsdf>"));
    assert_eq!((it.coatings, it.back, warnings.len()), ([Some(smooth), None], None, 0));
    // Inside a twosided one, and around it.
    let rough = "<bsdf type='roughcoating'><float name='alpha' value='0.1'/><bsdf type='diffuse'/></bsdf>";
    let (it, _) = material(&format!("<bsdf type='twosided'>{rough}{diffuse}</bsdf>"));
    assert_eq!(it.coatings, [Some(Coating::default(true)), None]);
    let (it, _) =
        material(&format!("<bsdf type='coating'>{amber}<bsdf type='twosided'>{diffuse}</bsdf></bsdf>"));
    assert_eq!(it.coatings, [Some(smooth), Some(smooth)]);
    // The outer one counts, and a warning says so.
    let (it, warnings) = material(&format!("<bsdf type='coating'>{amber}{rough}</bsdf>"));
    assert_eq!((it.coatings[0], warnings.len()), (Some(smooth), 1));
    let blend = format!("<bsdf type='blendbsdf'><float name='weight' value='0.3'/>{diffuse}{diffuse}</bsdf>");
    let xml = format!("<scene version='3.0.0'><bsdf type='coating'>{blend}</bsdf></scene>");
    let opened = read_str("s.xml", &xml, &no_files, &Options::default()).expect("a scene");
    assert_eq!(opened.description.materials.len(), 2);
    assert!(opened.description.materials.iter().all(|m| m.coatings[0] == Some(Coating::default(false))));
}
