//! BSDFs beyond the common ones: the principled models, and what stands in for plugins that are not modelled.

use std::io;

use foton_format::{Opened, Options, read_str};
use foton_math::Rgb;
use foton_scene::bsdf::index_of_specular;
use foton_scene::description::{Bsdf, Diffuse, Null, Number, Plastic, Principled, ThinDielectric};
use foton_scene::plugins::stand_ins;

fn open(scene: &str) -> Result<Opened, String> {
    let xml = format!("<scene version='3.0.0'><sensor type='perspective'/>{scene}</scene>");
    let no_files = |_: &std::path::Path| Err(io::ErrorKind::NotFound.into());
    read_str("s.xml", &xml, &no_files, &Options::default()).map_err(|e| e.to_string())
}

fn bsdf(plugin: &str, inside: &str) -> (Bsdf, Vec<String>) {
    let opened = open(&format!("<bsdf type='{plugin}'>{inside}</bsdf>")).unwrap();
    let warnings = opened.warnings.iter().map(ToString::to_string).collect();
    (opened.description.materials[0].front, warnings)
}

#[test]
fn principled_reads_numbers_textures_and_either_way_of_stating_its_index() {
    let inside = "<rgb name='base_color' value='0.8, 0.4, 0.1'/><float name='metallic' value='0.7'/>
        <texture type='checkerboard' name='roughness'/><float name='specular' value='0.25'/>
        <float name='clearcoat' value='2'/><float name='clearcoat_sampling_rate' value='1'/>";
    let (Bsdf::Principled(found), warnings) = bsdf("principled", inside) else { panic!("principled") };
    assert!(warnings.is_empty(), "{warnings:?}");
    assert_eq!(found.base_color, Rgb::new(0.8, 0.4, 0.1).into());
    assert_eq!((found.roughness, found.metallic), (Number::Texture(0), 0.7.into()));
    assert_eq!((found.eta, found.clearcoat), (index_of_specular(0.25), 2.0.into()));
    let (Bsdf::Principled(mean), _) = bsdf("principled", "<rgb name='roughness' value='0.2, 0.3, 0.7'/>")
    else {
        panic!()
    };
    assert!((mean.roughness.constant().unwrap() - 0.4).abs() < 1e-6, "{mean:?}");
    // What Mitsuba says of specular 0.5 is its default of 1.5 for eta.
    assert!((index_of_specular(0.5) - 1.5).abs() < 1e-6);
    let (Bsdf::Principled(plain), _) = bsdf("principled", "<float name='eta' value='1.7'/>") else {
        panic!()
    };
    assert_eq!((plain.eta, plain.roughness), (1.7, 0.5.into()));
    for (inside, error) in [
        ("<float name='eta' value='1.5'/><float name='specular' value='0.5'/>", "not both"),
        ("<texture type='checkerboard' name='specular'/>", "texture"),
    ] {
        let message = open(&format!("<bsdf type='principled'>{inside}</bsdf>")).unwrap_err();
        assert!(message.contains(error), "{message}");
    }
    let (Bsdf::Principled(cut), warnings) =
        bsdf("principled", "<float name='metallic' value='1.5'/><float name='roughness' value='-0.5'/>")
    else {
        panic!()
    };
    assert_eq!((cut.metallic, cut.roughness), (1.0.into(), 0.0.into()));
    assert!(
        warnings[0].contains("\"metallic\" must lie between 0 and 1, and is cut to that"),
        "{warnings:?}"
    );
}

#[test]
fn thin_sheets_have_two_sides_whatever_passes_through() {
    let (sheet, warnings) = bsdf("principledthin", "<texture type='checkerboard' name='eta'/>");
    assert!(warnings.is_empty() && sheet.has_two_sides() && !sheet.transmits(), "{sheet:?} {warnings:?}");
    let (leaf, _) = bsdf("principledthin", "<float name='diff_trans' value='1.2'/>");
    assert!(leaf.transmits());
    let (glass, _) = bsdf("principled", "<texture type='checkerboard' name='spec_trans'/>");
    assert!(glass.transmits() && glass.has_two_sides());
}

#[test]
fn every_plugin_that_is_not_modelled_has_a_stand_in_or_is_refused() {
    for it in stand_ins::ALL {
        let scene = format!("<bsdf type='{}'/>", it.name);
        match (open(&scene), it.instead) {
            (Ok(opened), Some(instead)) => {
                let front = opened.description.materials[0].front;
                // A filter that takes nothing is none.
                assert!(front.plugin() == instead || front == Bsdf::Null(Null), "{}: {front:?}", it.name);
                let [warning] = &opened.warnings[..] else { panic!("{}: {:?}", it.name, opened.warnings) };
                assert!(warning.line == 1 && warning.message.contains(it.help), "{warning}");
            }
            (Err(error), None) => assert!(error.contains(it.help) && error.contains("s.xml:1:"), "{error}"),
            (found, _) => panic!("{}: {:?}", it.name, found.map(|o| o.warnings)),
        }
    }
    let xml = "<scene version='3.0.0'><bsdf type='measured'/></scene>";
    let no_files = |_: &std::path::Path| Err(io::ErrorKind::NotFound.into());
    let options = Options { allow_missing: true, ..Options::default() };
    let opened = read_str("s.xml", xml, &no_files, &options).unwrap();
    let magenta = Rgb::new(0.8, 0.0, 0.8).into();
    assert_eq!(opened.description.materials[0].front, Bsdf::Diffuse(Diffuse { reflectance: magenta }));
    let twice = open("<bsdf type='pplastic'/><bsdf type='pplastic' id='b'/><bsdf type='hair'/>").unwrap();
    assert_eq!(twice.warnings.len(), 2, "{:?}", twice.warnings);
}

#[test]
fn stand_ins_keep_what_they_can() {
    let (Bsdf::Plastic(plastic), warnings) = bsdf(
        "pplastic",
        "<rgb name='diffuse_reflectance' value='0.1, 0.27, 0.36'/><float name='alpha_u' value='0.06'/>
         <float name='alpha_v' value='0.06'/><float name='int_ior' value='1.6'/>",
    ) else {
        panic!("plastic")
    };
    assert_eq!(plastic.diffuse_reflectance, Rgb::new(0.1, 0.27, 0.36).into());
    assert_eq!((plastic.int_ior, plastic.roughness.unwrap().alpha_u), (1.6, 0.06.into()));
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    let (Bsdf::ThinDielectric(filter), _) = bsdf(
        "polarizer",
        "<rgb name='transmittance' value='0.8, 0.6, 0.4'/><float name='theta' value='30'/>",
    ) else {
        panic!("a filter")
    };
    let ThinDielectric { int_ior, ext_ior, specular_transmittance, .. } = filter;
    assert_eq!((int_ior, ext_ior), (1.0, 1.0));
    assert_eq!(specular_transmittance, Rgb::new(0.4, 0.3, 0.2).into());
    let cloth = bsdf(
        "irawan",
        "<string name='filename' value='silk.wv'/><rgb name='warp_kd' value='0.1, 0.2, 0.3'/>
        <rgb name='weft_kd' value='0.3, 0.4, 0.5'/>",
    );
    let Bsdf::Diffuse(Diffuse { reflectance }) = cloth.0 else { panic!("diffuse") };
    assert_eq!(reflectance, Rgb::new(0.2, 0.3, 0.4).into());
    let (Bsdf::PrincipledThin(sheet), _) = bsdf(
        "hk",
        "<rgb name='sigma_s' value='3, 1, 0'/>
        <rgb name='sigma_a' value='1, 1, 1'/><phase type='hg'/>",
    ) else {
        panic!("a sheet")
    };
    assert_eq!((sheet.base_color, sheet.diff_trans), (Rgb::new(0.75, 0.5, 0.0).into(), 1.0.into()));
}

#[test]
fn light_that_scatters_below_a_surface_is_seen_on_it() {
    let marble = "<shape type='sphere'><bsdf type='dielectric'/>
        <subsurface type='dipole'><string name='material' value='marble'/></subsurface></shape>";
    let opened = open(marble).unwrap();
    let material = &opened.description.materials[opened.description.shapes[0].material];
    let Bsdf::Plastic(Plastic { diffuse_reflectance, .. }) = material.front else { panic!("plastic") };
    assert_eq!(diffuse_reflectance, Rgb::new(0.83, 0.79, 0.75).into());
    assert!(opened.warnings.iter().any(|w| w.message.contains("\"dipole\"")), "{:?}", opened.warnings);
}

#[test]
fn a_principled_default_is_mitsubas() {
    let (found, _) = bsdf("principled", "");
    let Bsdf::Principled(Principled { base_color, roughness, eta, metallic, spec_trans, clearcoat, .. }) =
        found
    else {
        panic!("principled")
    };
    assert_eq!((base_color, roughness, eta), (Rgb::splat(0.5).into(), 0.5.into(), 1.5));
    assert!([metallic, spec_trans, clearcoat].iter().all(|n| *n == 0.0.into()));
}
