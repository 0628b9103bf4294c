//! Whether two descriptions are of one scene: names and the order of materials and textures do not count.

use std::collections::HashSet;
use std::sync::Arc;

use foton_math::Rgb;
use foton_math::glam::DVec3;
use foton_scene::description::{
    Bitmap, Bsdf, Coating, Colour, EmitterKind, Geometry, Mesh, Number, Relief, SceneDescription,
    SensorDescription, Texture, TextureKind,
};

/// How far normals that were made again under another scale may lie from the first ones.
const NORMALS: f64 = 1e-9;

/// The first thing that differs, in words; `None` if nothing does.
pub(super) fn difference(a: &SceneDescription, b: &SceneDescription) -> Option<String> {
    if a.max_depth != b.max_depth {
        return Some("its longest path".to_owned());
    }
    let counts = |d: &SceneDescription| (d.sensors.len(), d.shapes.len(), d.emitters.len());
    if counts(a) != counts(b) {
        return Some("how many things it has".to_owned());
    }
    if a.hidden != b.hidden {
        return Some("what is hidden".to_owned());
    }
    let names = |d: &SceneDescription| -> Vec<String> {
        let sensors = d.sensors.iter().map(|s| &s.name);
        let others = d.emitters.iter().map(|e| &e.name).chain(d.shapes.iter().map(|s| &s.name));
        sensors.chain(others).cloned().collect()
    };
    if let Some((name, _)) = names(a).into_iter().zip(names(b)).find(|(a, b)| a != b) {
        return Some(format!("the name \"{name}\""));
    }
    if let Some((a, _)) = a.sensors.iter().zip(&b.sensors).find(|(a, b)| !same_sensor(a, b)) {
        return Some(format!("sensor \"{}\"", a.name));
    }
    let mut emitters = a.emitters.iter().zip(&b.emitters);
    if let Some((emitter, _)) = emitters.find(|(x, y)| !same_emitter((a, &x.kind), (b, &y.kind))) {
        return Some(format!("emitter \"{}\"", emitter.name));
    }
    // Instances share meshes and materials: each pair is compared once.
    let (mut meshes, mut materials) = (HashSet::new(), HashSet::new());
    for (x, y) in a.shapes.iter().zip(&b.shapes) {
        let shines = match (x.radiance, y.radiance) {
            (Some(x), Some(y)) => same_colour((a, x), (b, y)),
            (x, y) => x.is_none() && y.is_none(),
        };
        let placed = (x.to_world, x.flip_normals) == (y.to_world, y.flip_normals) && shines;
        let pair = match (&x.geometry, &y.geometry) {
            (Geometry::Mesh(x), Geometry::Mesh(y)) => Some((Arc::as_ptr(x), Arc::as_ptr(y))),
            _ => None,
        };
        let is_known = pair.is_some_and(|pair| !meshes.insert(pair));
        if !placed || !(is_known || same_geometry(&x.geometry, &y.geometry)) {
            return Some(format!("shape \"{}\"", x.name));
        }
        let is_known = !materials.insert((x.material, y.material));
        if !is_known && !same_material((a, x.material), (b, y.material)) {
            return Some(format!("the material of shape \"{}\"", x.name));
        }
    }
    None
}

pub(super) fn same_sensor(a: &SensorDescription, b: &SensorDescription) -> bool {
    let film = |s: &SensorDescription| (s.width, s.height, s.filter, s.near_clip, s.far_clip);
    let view = |s: &SensorDescription| {
        (s.to_world, s.projection, s.fov_degrees, s.fov_axis, s.lens, s.principal_point_offset)
    };
    view(a) == view(b) && film(a) == film(b)
}

type EmitterOf<'a> = (&'a SceneDescription, &'a EmitterKind);

pub(super) fn same_emitter((in_a, a): EmitterOf<'_>, (in_b, b): EmitterOf<'_>) -> bool {
    use EmitterKind::{Constant, Directional, Environment, Goniometric, Point, Projector, Spot};
    match (a, b) {
        (
            Environment { to_world: m, bitmap: x, scale: s },
            Environment { to_world: n, bitmap: y, scale: t },
        )
        | (
            Goniometric { to_world: m, bitmap: x, scale: s },
            Goniometric { to_world: n, bitmap: y, scale: t },
        ) => m == n && s == t && same_bitmap(x, y),
        (
            Spot { to_world: m, intensity: i, cutoff_degrees: c, beam_degrees: w, texture: t },
            Spot { to_world: n, intensity: j, cutoff_degrees: d, beam_degrees: x, texture: u },
        ) => {
            let same_texture = match (t, u) {
                (Some(t), Some(u)) => same_colour((in_a, Colour::Texture(*t)), (in_b, Colour::Texture(*u))),
                (t, u) => t == u,
            };
            (m, i, c, w) == (n, j, d, x) && same_texture
        }
        (
            Projector { to_world: m, irradiance: x, scale: s, fov_degrees: f, fov_axis: g },
            Projector { to_world: n, irradiance: y, scale: t, fov_degrees: h, fov_axis: k },
        ) => (m, s, f, g) == (n, t, h, k) && same_colour((in_a, *x), (in_b, *y)),
        (Point { position: p, intensity: i }, Point { position: q, intensity: j }) => (p, i) == (q, j),
        (Constant { radiance: r }, Constant { radiance: s }) => r == s,
        (Directional { direction: d, irradiance: i }, Directional { direction: e, irradiance: j }) => {
            (d, i) == (e, j)
        }
        _ => false,
    }
}

pub(super) fn same_geometry(a: &Geometry, b: &Geometry) -> bool {
    match (a, b) {
        (Geometry::Mesh(a), Geometry::Mesh(b)) => Arc::ptr_eq(a, b) || same_mesh(a, b),
        (Geometry::Sphere { centre: c, radius: r }, Geometry::Sphere { centre: d, radius: s }) => {
            (c, r) == (d, s)
        }
        (Geometry::Disc, Geometry::Disc) => true,
        (
            Geometry::Cylinder { from: a, to: b, radius: r },
            Geometry::Cylinder { from: c, to: d, radius: s },
        ) => (a, b, r) == (c, d, s),
        _ => false,
    }
}

fn same_mesh(a: &Mesh, b: &Mesh) -> bool {
    let near = |(a, b): (&DVec3, &DVec3)| a.distance(*b) <= NORMALS;
    a.triangles == b.triangles
        && a.positions == b.positions
        && a.texture_coordinates == b.texture_coordinates
        && a.attributes == b.attributes
        && a.normals.len() == b.normals.len()
        && a.normals.iter().zip(&b.normals).all(near)
}

type MaterialOf<'a> = (&'a SceneDescription, usize);

fn same_material((a, i): MaterialOf<'_>, (b, j): MaterialOf<'_>) -> bool {
    let (Some(x), Some(y)) = (a.materials.get(i), b.materials.get(j)) else { return false };
    let white = Colour::Constant(Rgb::WHITE);
    let opacities = [x.opacity.unwrap_or(white), y.opacity.unwrap_or(white)];
    let sides = [(Some(x.front), Some(y.front)), (x.back, y.back)];
    same_colour((a, opacities[0]), (b, opacities[1]))
        && same_relief((a, x.relief), (b, y.relief))
        && x.coatings.iter().zip(&y.coatings).all(|(x, y)| match (x, y) {
            (Some(x), Some(y)) => same_coating((a, x), (b, y)),
            (x, y) => x.is_none() && y.is_none(),
        })
        && x.mixture.len() == y.mixture.len()
        && x.mixture.iter().zip(&y.mixture).all(|(x, y)| {
            same_number((a, x.weight), (b, y.weight)) && same_material((a, x.material), (b, y.material))
        })
        && sides.iter().all(|(x, y)| match (x, y) {
            (Some(x), Some(y)) => same_bsdf((a, x), (b, y)),
            (x, y) => x.is_none() && y.is_none(),
        })
}

fn same_relief(
    (a, x): (&SceneDescription, Option<Relief>),
    (b, y): (&SceneDescription, Option<Relief>),
) -> bool {
    let (Some(x), Some(y)) = (x, y) else { return x == y };
    (x.kind, x.same_behind) == (y.kind, y.same_behind)
        && same_colour((a, Colour::Texture(x.texture)), (b, Colour::Texture(y.texture)))
}

fn same_coating((a, x): (&SceneDescription, &Coating), (b, y): (&SceneDescription, &Coating)) -> bool {
    let values = |coating: &Coating| {
        let (mut colours, mut numbers) = (Vec::new(), Vec::new());
        let rest = coating.map(|c| colours.push(c), |n, _| numbers.push(n));
        (colours, numbers, rest)
    };
    let ((colours, numbers, x), (its_colours, its_numbers, y)) = (values(x), values(y));
    x == y
        && colours.iter().zip(&its_colours).all(|(x, y)| same_colour((a, *x), (b, *y)))
        && numbers.iter().zip(&its_numbers).all(|(x, y)| same_number((a, *x), (b, *y)))
}

fn same_bsdf((a, x): (&SceneDescription, &Bsdf), (b, y): (&SceneDescription, &Bsdf)) -> bool {
    let values = |bsdf: &Bsdf| {
        let (mut colours, mut numbers) = (Vec::new(), Vec::new());
        let rest = bsdf.map(
            |c| {
                colours.push(c);
                Rgb::BLACK
            },
            |n, _| {
                numbers.push(n);
                0.0
            },
        );
        (colours, numbers, rest)
    };
    let ((colours, numbers, x), (its_colours, its_numbers, y)) = (values(x), values(y));
    x == y
        && (colours.len(), numbers.len()) == (its_colours.len(), its_numbers.len())
        && colours.iter().zip(&its_colours).all(|(x, y)| same_colour((a, *x), (b, *y)))
        && numbers.iter().zip(&its_numbers).all(|(x, y)| same_number((a, *x), (b, *y)))
}

fn same_number((a, x): (&SceneDescription, Number), (b, y): (&SceneDescription, Number)) -> bool {
    match (x, y) {
        (Number::Texture(x), Number::Texture(y)) => {
            same_colour((a, Colour::Texture(x)), (b, Colour::Texture(y)))
        }
        _ => x == y,
    }
}

fn same_colour((a, x): (&SceneDescription, Colour), (b, y): (&SceneDescription, Colour)) -> bool {
    match (x, y) {
        (Colour::Constant(x), Colour::Constant(y)) => x == y,
        (Colour::Texture(x), Colour::Texture(y)) => {
            a.textures.get(x).zip(b.textures.get(y)).is_some_and(|(x, y)| same_texture((a, x), (b, y)))
        }
        _ => false,
    }
}

type TextureOf<'a> = (&'a SceneDescription, &'a Texture);

fn same_texture((in_a, a): TextureOf<'_>, (in_b, b): TextureOf<'_>) -> bool {
    let kind = match (&a.kind, &b.kind) {
        (TextureKind::Checkerboard { colours: x }, TextureKind::Checkerboard { colours: y }) => {
            x.iter().zip(y).all(|(x, y)| same_colour((in_a, *x), (in_b, *y)))
        }
        (
            TextureKind::Attribute { name: x, scale: s, most: m },
            TextureKind::Attribute { name: y, scale: t, most: n },
        ) => (x, s, m) == (y, t, n),
        (
            TextureKind::Bitmap { bitmap: x, wrap: v, bilinear: s },
            TextureKind::Bitmap { bitmap: y, wrap: w, bilinear: t },
        ) => (v, s) == (w, t) && same_bitmap(x, y),
        _ => false,
    };
    kind && a.to_uv == b.to_uv
}

fn same_bitmap(a: &Arc<Bitmap>, b: &Arc<Bitmap>) -> bool {
    Arc::ptr_eq(a, b) || (a.width, a.height, &a.pixels) == (b.width, b.height, &b.pixels)
}
