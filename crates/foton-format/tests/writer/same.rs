//! Whether two descriptions say the same.

use super::*;

/// Panics where two descriptions differ, but for names, zeros of either sign, and the order of materials and textures.
pub(super) fn assert_same(a: &SceneDescription, b: &SceneDescription) {
    assert_eq!(a.hidden, b.hidden);
    assert_eq!(a.motion.shutters, b.motion.shutters);
    for time in [-1.0, 0.0, 0.25, 1.0, 3.0] {
        let at =
            |scene: &SceneDescription| scene.at(time).shapes.iter().map(|s| s.to_world).collect::<Vec<_>>();
        let apart = at(a).into_iter().zip(at(b)).filter(|(x, y)| !x.abs_diff_eq(*y, 1e-9)).count();
        assert_eq!(apart, 0, "at {time}");
    }
    assert_eq!(a.max_depth, b.max_depth);
    assert_eq!(a.sensors.len(), b.sensors.len());
    for (a, b) in a.sensors.iter().zip(&b.sensors) {
        assert_eq!(a.to_world, b.to_world);
        assert_eq!((a.projection, a.filter), (b.projection, b.filter));
        if a.projection == Projection::Perspective {
            assert_eq!((a.fov_degrees, a.fov_axis), (b.fov_degrees, b.fov_axis));
        }
        assert_eq!(a.principal_point_offset, b.principal_point_offset);
        assert_eq!(
            (a.width, a.height, a.near_clip, a.far_clip, a.lens),
            (b.width, b.height, b.near_clip, b.far_clip, b.lens)
        );
    }
    assert_eq!(a.emitters.len(), b.emitters.len());
    for (x, y) in a.emitters.iter().zip(&b.emitters) {
        assert_eq!(emitter(a, &x.kind), emitter(b, &y.kind));
    }
    assert_eq!(a.shapes.len(), b.shapes.len());
    for (x, y) in a.shapes.iter().zip(&b.shapes) {
        assert_eq!(
            (x.flip_normals, light(a, x.radiance), x.to_world),
            (y.flip_normals, light(b, y.radiance), y.to_world),
            "{}",
            x.name
        );
        assert_same_geometry(&x.geometry, &y.geometry);
        assert_eq!(material(a, x.material), material(b, y.material), "{}", x.name);
    }
}

fn assert_same_geometry(a: &Geometry, b: &Geometry) {
    match (a, b) {
        (Geometry::Mesh(a), Geometry::Mesh(b)) => {
            assert_eq!(a.positions, b.positions);
            assert_eq!(a.normals, b.normals);
            assert_eq!(a.texture_coordinates, b.texture_coordinates);
            assert_eq!(a.triangles, b.triangles);
            assert_eq!(a.attributes, b.attributes);
        }
        _ => assert_eq!(format!("{a:?}"), format!("{b:?}")),
    }
}

/// What an emitter is, textures included, with numbers to all digits.
fn emitter(scene: &SceneDescription, kind: &EmitterKind) -> String {
    let (mut kind, of_spot) = (kind.clone(), kind.texture().map(Colour::Texture));
    match &mut kind {
        EmitterKind::Spot { texture, .. } => *texture = None,
        EmitterKind::Environment { to_world, bitmap, scale }
        | EmitterKind::Goniometric { to_world, bitmap, scale } => {
            let to_world = to_world.to_cols_array().map(|x| x + 0.0);
            return format!("{to_world:?} {scale} {}", bitmap_text(bitmap));
        }
        _ => {}
    }
    with_textures(scene, format!("{kind:?} {of_spot:?}"))
}

fn bitmap_text(bitmap: &Bitmap) -> String {
    format!("{} × {}: {:?}", bitmap.width, bitmap.height, bitmap.pixels)
}

/// What a material is, textures included, with numbers to all digits.
fn material(scene: &SceneDescription, index: usize) -> String {
    let Material { front, back, coatings, opacity, relief, mixture, .. } = &scene.materials[index];
    let relief = relief.map(|r| format!("{:?} {} {:?}", r.kind, r.same_behind, Colour::Texture(r.texture)));
    let mut text = format!("{front:?} {back:?} {coatings:?} {opacity:?} {relief:?}");
    for Blend { material: other, weight } in mixture {
        text += &format!(" {weight:?} of ({})", material(scene, *other));
    }
    with_textures(scene, text)
}

/// What a surface emits, the same way.
fn light(scene: &SceneDescription, radiance: Option<Colour>) -> String {
    with_textures(scene, format!("{radiance:?}"))
}

/// With what textures are in the place of their numbers.
fn with_textures(scene: &SceneDescription, mut text: String) -> String {
    while let Some(at) = text.find("Texture(") {
        let end = at + text[at..].find(')').unwrap();
        let Texture { to_uv, kind, .. } = &scene.textures[text[at + 8..end].parse::<usize>().unwrap()];
        let kind = match kind {
            TextureKind::Bitmap { bitmap, wrap, bilinear } => {
                format!("{wrap:?} {bilinear} {}", bitmap_text(bitmap))
            }
            TextureKind::Checkerboard { colours } => format!("{colours:?}"),
            TextureKind::Attribute { name, scale, most } => format!("{name} {scale} {most}"),
        };
        text.replace_range(at..=end, &format!("{:?} {kind}", to_uv.to_cols_array().map(|x| x + 0.0)));
    }
    text
}
