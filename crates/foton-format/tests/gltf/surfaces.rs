//! Materials and textures.

use super::*;

#[test]
fn metal_and_roughness_are_numbers_or_channels_of_a_picture() {
    let opened = opened("metallic-roughness.glb");
    let dull = principled(&opened, "m0r1.0");
    assert_eq!((dull.roughness, dull.metallic, dull.eta), (1.0.into(), 0.0.into(), 1.5));
    assert_eq!(dull.base_color, Rgb::new(0.9, 0.5, 0.2).into());
    let material = material(&opened, "m1r0.2");
    assert_eq!(material.back, Some(material.front), "both sides are seen");
    let mixed = principled(&opened, "mixed");
    let (Number::Texture(roughness), Number::Texture(metallic)) = (mixed.roughness, mixed.metallic) else {
        panic!("{mixed:?}")
    };
    // Green is 0.3 + 0.7 v times 0.9, blue is 1 in every other column of two.
    let (_, rough) = texture(&opened, roughness);
    let v = 12.5 / 16.0;
    assert_near(rough.pixels[12 * 16].g.into(), 0.9 * (0.3 + 0.7 * v), 0.003);
    assert!(rough.pixels.iter().all(|p| p.r == p.g && p.g == p.b));
    let (_, metal) = texture(&opened, metallic);
    assert_eq!([0, 1, 2, 3].map(|i| metal.pixels[i].r), [1.0, 1.0, 0.0, 0.0]);
}

#[test]
fn pictures_are_wrapped_filtered_and_placed() {
    let opened = opened("textures.gltf");
    let of = |name: &str| {
        let Colour::Texture(index) = principled(&opened, name).base_color else { panic!("{name}") };
        texture(&opened, index).0
    };
    let sampling = |name: &str| {
        let TextureKind::Bitmap { wrap, bilinear, .. } = of(name).kind else { panic!() };
        (wrap, bilinear)
    };
    assert_eq!(sampling("plain"), (Wrap::Repeat, true));
    assert_eq!(sampling("nearest"), (Wrap::Repeat, false));
    assert_eq!(sampling("mirrored"), (Wrap::Mirror, true));
    assert_eq!(sampling("clamped"), (Wrap::Clamp, true));
    // A description's v points up, a file's down.
    let at = |name: &str, u: f64, v: f64| of(name).to_uv.transform_point2((u, v).into()).to_array();
    assert_eq!(at("plain", 0.25, 0.125), [0.25, 0.875]);
    assert_eq!(at("offset", 0.25, 0.125), [0.5, 0.375]);
    let [u, v] = at("quadrant", 1.0, 0.0);
    assert!(u.abs() < 1e-9 && (v - 0.5).abs() < 1e-9, "{u} {v}: the middle of the left side");
    // The same picture for all, made linear: the first pixel has u = v = 1/16.
    let Colour::Texture(index) = principled(&opened, "plain").base_color else { panic!() };
    let (_, bitmap) = texture(&opened, index);
    let byte = (255.0_f64 / 16.0).round() / 255.0;
    assert_near(bitmap.pixels[0].r.into(), ((byte + 0.055) / 1.055).powf(2.4), 1e-6);
}

#[test]
fn masks_are_there_or_not_and_veils_are_shares() {
    let opened = opened("alpha.glb");
    let of = |name: &str| {
        let Some(Colour::Texture(index)) = material(&opened, name).opacity else { panic!("{name}") };
        texture(&opened, index).1.pixels.iter().map(|p| p.r).collect::<Vec<_>>()
    };
    let mask = of("mask");
    assert!(mask.iter().all(|a| *a == 0.0 || *a == 1.0));
    let there = mask.iter().filter(|a| **a == 1.0).count() as f64 / mask.len() as f64;
    assert_near(there, 1.0 - std::f64::consts::PI * 0.09 * 0.09 * 16.0, 0.04);
    assert_near(of("blend")[4].into(), 4.5 / 16.0, 0.002);
    assert_eq!(material(&opened, "veil").opacity, Some(Rgb::splat(0.4).into()));
    assert_eq!(material(&opened, "opaque").opacity, None);
}

#[test]
fn normal_maps_are_scaled_and_turned_where_coordinates_are_mirrored() {
    let opened = opened("normal-map.glb");
    let of = |name: &str| {
        let relief = material(&opened, name).relief.expect("a relief");
        assert!(relief.same_behind);
        &texture(&opened, relief.texture).1.pixels
    };
    let (full, half, mirrored) = (of("full"), of("half"), of("mirrored"));
    // Above the middle of a bump the normal leans upwards, which is green above a half.
    assert!(full[4 * 48 + 8].g > 0.7 && full[12 * 48 + 8].g < 0.3);
    for ((full, half), mirrored) in full.iter().zip(half).zip(mirrored) {
        assert_near((half.r - 0.5).into(), (0.4 * (full.r - 0.5)).into(), 1e-6);
        assert_near((half.g - 0.5).into(), (0.4 * (full.g - 0.5)).into(), 1e-6);
        assert_near((mirrored.g - 0.5).into(), (0.5 - full.g).into(), 1e-6);
        assert_eq!((half.b, mirrored.r, mirrored.b), (full.b, full.r, full.b));
    }
}

#[test]
fn what_shines_has_its_strength() {
    let opened = opened("emissive.glb");
    let strong = shape(&opened, "strong").radiance;
    let Some(Colour::Constant(strong)) = strong else { panic!("{strong:?}") };
    strong.to_array().iter().zip([6.0, 4.8, 3.6]).for_each(|(a, b)| assert_near((*a).into(), b, 1e-5));
    let Some(Colour::Texture(cells)) = shape(&opened, "cells").radiance else { panic!() };
    assert!(texture(&opened, cells).1.pixels.iter().any(|p| p.r == 1.0));
    assert!(matches!(shape(&opened, "unlit").radiance, Some(Colour::Texture(_))));
    let black = Bsdf::Diffuse(foton_scene::description::Diffuse { reflectance: Rgb::BLACK.into() });
    assert_eq!(material(&opened, "unlit").front, black);
    assert_eq!(shape(&opened, "floor").radiance, None);
}

#[test]
fn glass_is_glass() {
    let opened = opened("glass.glb");
    let Bsdf::Dielectric(clear) = material(&opened, "clear").front else { panic!() };
    assert_eq!((clear.int_ior, clear.ext_ior, clear.roughness), (1.5, 1.0, None));
    assert_eq!(clear.specular_transmittance, Rgb::WHITE.into());
    let Bsdf::Dielectric(Dielectric { roughness: Some(facets), .. }) = material(&opened, "rough").front
    else {
        panic!()
    };
    assert_near(facets.alpha_u.constant().expect("a number").into(), 0.16, 1e-6);
    // Both crossings together take what light loses on its way through 1, where 0.7 leave a share.
    let Bsdf::Dielectric(tinted) = material(&opened, "tinted").front else { panic!() };
    let Colour::Constant(share) = tinted.specular_transmittance else { panic!() };
    for (share, left) in share.to_array().into_iter().zip([0.2_f64, 0.6, 0.9]) {
        assert_near(f64::from(share * share), left.powf(1.0 / 0.7), 1e-6);
    }
    assert_eq!(tinted.int_ior, 1.33);
    let half = principled(&opened, "half");
    assert_eq!((half.spec_trans, half.metallic), (0.5.into(), 0.0.into()));
    let pane = material(&opened, "pane").front;
    let colour = Rgb::new(0.6, 0.9, 0.6).into();
    assert!(
        matches!(pane, Bsdf::ThinDielectric(ThinDielectric { specular_transmittance, .. }) if specular_transmittance == colour)
    );
    let rough = material(&opened, "rough-pane").front;
    let Bsdf::PrincipledThin(PrincipledThin { spec_trans, roughness, .. }) = rough else {
        panic!("{rough:?}")
    };
    assert_eq!((spec_trans, roughness), (1.0.into(), 0.4.into()));
}

#[test]
fn coats_and_reflections_are_those_of_the_principled_model() {
    let opened = opened("coats.glb");
    let coated = principled(&opened, "coated");
    assert_eq!(coated.clearcoat, 1.0.into());
    // α is 0.01, between 0.1 at a gloss of 0 and 0.001 at 1.
    let gloss = coated.clearcoat_gloss.constant().expect("a number");
    assert_near(f64::from(0.1 + gloss * (0.001 - 0.1)), 0.01, 1e-6);
    assert_near(principled(&opened, "no-highlight").eta.into(), 1.001, 1e-6);
    assert_eq!(principled(&opened, "high-index").eta, 2.2);
    assert_eq!(principled(&opened, "sheen").sheen, 0.8.into());
    assert_eq!(principled(&opened, "plain").clearcoat, 0.0.into());
}

#[test]
fn vertices_have_colours_and_pictures_other_coordinates() {
    let opened = opened("colours.glb");
    let attribute = |shape: &str, name: &str| {
        mesh(&opened, shape).attributes.iter().find(|a| a.name == name).map(|a| a.values.to_vec())
    };
    let shown = |colour: Colour| match colour {
        Colour::Texture(index) => match &opened.description.textures[index].kind {
            TextureKind::Attribute { name, .. } => name.clone(),
            _ => "a picture".to_owned(),
        },
        Colour::Constant(c) => format!("{c:?}"),
    };
    assert_eq!(shown(principled(&opened, "vertices").base_color), "vertex_color");
    let colours = attribute("vertices", "vertex_color").expect("colours");
    assert_near(colours[1].into(), 40.0 / 255.0, 1e-6);
    assert_eq!(attribute("vertices", "vertex_opacity"), None, "opaque");
    assert_eq!(material(&opened, "fading").opacity.map(shown).as_deref(), Some("vertex_opacity"));
    assert_eq!(attribute("fading", "vertex_opacity"), Some(vec![1.0, 1.0, 1.0, 0.0]));
    // One colour of all vertices is that of the material.
    let Colour::Texture(tinted) = principled(&opened, "tinted").base_color else { panic!() };
    let Colour::Texture(plain) = principled(&opened, "second-set").base_color else { panic!() };
    let [tinted, plain] = [tinted, plain].map(|index| texture(&opened, index).1.pixels[0]);
    assert_near((tinted.r / plain.r).into(), 0.4, 1e-5);
    assert_near((tinted.b / plain.b).into(), 1.0, 1e-5);
    let uv = mesh(&opened, "second-set").texture_coordinates[2];
    assert_eq!(uv.to_array(), [0.5, 0.5]);
}
