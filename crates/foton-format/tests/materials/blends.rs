//! Materials that stand around others: blends, mixtures, two sides, holes, bump maps and normal maps.

use foton_scene::description::{Bsdf, Colour, Material, Number, Relief, ReliefKind, TextureKind};

use super::{Opened, assert_close, grey, read, read_with_warnings};

/// Weights of the materials that a material is blended of, with what their front reflects.
fn blended(opened: &Opened) -> Vec<(f32, Bsdf)> {
    let materials = &opened.description.materials;
    let mut found = vec![(1.0, materials[0].front)];
    for blend in &materials[0].mixture {
        let weight = blend.weight.constant().expect("the same everywhere");
        found.iter_mut().for_each(|(w, _)| *w *= 1.0 - weight);
        found.push((weight, materials[blend.material].front));
    }
    found
}

#[test]
fn blends_and_mixtures_have_their_weights() {
    let grey_bsdf =
        |value: f32| format!("<bsdf type='diffuse'><rgb name='reflectance' value='{value}'/></bsdf>");
    let of = |snippet: &str| -> Vec<(f32, f32)> {
        let all = blended(&read(snippet));
        let reflectance = |bsdf: &Bsdf| match bsdf.lambertian() {
            Some(Colour::Constant(c)) => c.r,
            other => panic!("{other:?}"),
        };
        all.iter().map(|(weight, bsdf)| ((weight * 1e4).round() / 1e4, reflectance(bsdf))).collect()
    };
    let (a, b, c) = (grey_bsdf(0.1), grey_bsdf(0.2), grey_bsdf(0.3));
    let blend = |weight: &str, inside: &str| format!("<bsdf type='blendbsdf'>{weight}{inside}</bsdf>");
    let quarter = "<float name='weight' value='0.25'/>";
    assert_eq!(of(&blend(quarter, &format!("{a}{b}"))), [(0.75, 0.1), (0.25, 0.2)]);
    assert_eq!(of(&blend("", &format!("{a}{b}"))), [(0.5, 0.1), (0.5, 0.2)]);
    let nested = blend(quarter, &format!("{}{c}", blend("", &format!("{a}{b}"))));
    assert_eq!(of(&nested), [(0.375, 0.1), (0.375, 0.2), (0.25, 0.3)]);
    let mixture = |weights: &str| {
        format!("<bsdf type='mixturebsdf'><string name='weights' value='{weights}'/>{a}{b}{c}</bsdf>")
    };
    assert_eq!(of(&mixture("0.2, 0.3, 0.5")), [(0.2, 0.1), (0.3, 0.2), (0.5, 0.3)]);
    // What is missing is absorbed, what is too much is scaled.
    assert_eq!(of(&mixture("0.2 0.3 0.1")), [(0.2, 0.1), (0.3, 0.2), (0.1, 0.3), (0.4, 0.0)]);
    assert_eq!(of(&mixture("2 3 5")), [(0.2, 0.1), (0.3, 0.2), (0.5, 0.3)]);
    assert_eq!(of(&mixture("0 0 1")), [(0.0, 0.1), (0.0, 0.2), (1.0, 0.3)]);
    let textured = read(&blend("<texture name='weight' type='checkerboard'/>", &format!("{a}{b}")));
    assert_eq!(textured.description.materials[0].mixture[0].weight, Number::Texture(0));
}

#[test]
fn what_stands_around_a_blend_holds_for_all_of_it() {
    let blend = "<bsdf type='blendbsdf'><bsdf type='diffuse'/><bsdf type='conductor'/></bsdf>";
    let masked = read(&format!("<bsdf type='mask'><float name='opacity' value='0.25'/>{blend}</bsdf>"));
    assert!(masked.description.materials.iter().all(|m| m.opacity == Some(grey(0.25))));
    let both = read(&format!("<bsdf type='twosided'>{blend}</bsdf>")).description.materials;
    assert_eq!(both.len(), 2);
    assert!(both.iter().all(|m| m.back == Some(m.front)));
    let two = read(&format!("<bsdf type='twosided'>{blend}{blend}</bsdf>")).description.materials;
    let kinds = |m: &Material| [Some(m.front), m.back].map(|b| b.map(|b| b.plugin()));
    let (diffuse, mirror) = (Some("diffuse"), Some("conductor"));
    let mut found: Vec<_> = two.iter().map(kinds).collect();
    found.sort();
    assert_eq!(found, [[mirror, mirror], [mirror, diffuse], [diffuse, mirror], [diffuse, diffuse]]);
    let bumped = "<bsdf type='bumpmap'><texture type='checkerboard'/><float name='scale' value='3'/>";
    let bumped = read(&format!("{bumped}{blend}</bsdf>")).description;
    let relief = |same_behind| Relief { texture: 0, kind: ReliefKind::Bump { scale: 3.0 }, same_behind };
    assert!(bumped.materials.iter().all(|m| m.relief == Some(relief(false))));
}

#[test]
fn normal_maps_name_a_texture_or_a_file_and_know_their_sides() {
    let diffuse = "<bsdf type='diffuse'/>";
    let bitmap = |name: &str| {
        format!("<texture type='bitmap'{name}><string name='filename' value='t.png'/></texture>")
    };
    for inside in [bitmap(" name='normalmap'"), bitmap(""), "<string name='filename' value='t.png'/>".into()]
    {
        let map = format!("<bsdf type='normalmap'>{inside}{diffuse}</bsdf>");
        for (snippet, same_behind) in
            [(map.clone(), false), (format!("<bsdf type='twosided'>{map}</bsdf>"), true)]
        {
            let description = read(&snippet).description;
            let relief = Some(Relief { texture: 0, kind: ReliefKind::Normal, same_behind });
            assert_eq!(description.materials[0].relief, relief, "{snippet}");
            assert_eq!(description.textures.len(), 1);
        }
    }
    let bitmap_texture = bitmap("");
    // A file of normals holds numbers, not colours.
    let file =
        read(&format!("<bsdf type='normalmap'><string name='filename' value='t.png'/>{diffuse}</bsdf>"));
    let TextureKind::Bitmap { bitmap, .. } = &file.description.textures[0].kind else { panic!() };
    assert_close(bitmap.pixels[2], [128.0 / 255.0, 128.0 / 255.0, 0.0], 1e-6);
    let (_, warnings) = read_with_warnings(&format!(
        "<bsdf type='normalmap'>{0}<bsdf type='bumpmap'>{0}{diffuse}</bsdf></bsdf>",
        bitmap_texture
    ));
    assert_eq!(
        warnings,
        ["of a bump or normal map inside another the inner one counts, the outer one is left out"]
    );
}
