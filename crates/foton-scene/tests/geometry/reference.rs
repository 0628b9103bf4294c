//! The tree and its single-precision tests against every primitive in turn in double precision.

use foton_math::Ray;
use foton_math::glam::{DAffine3, DQuat, DVec3};
use foton_scene::Normalisation;
use foton_scene::description::{Geometry, ShapeDescription};

use crate::{ball, build, direction, in_cube, log_uniform, shape, stream, triangle};

/// A primitive in scene units, its vertices and centres rounded as the scene's own.
enum Exact {
    Triangle([DVec3; 3]),
    Sphere { centre: DVec3, radius: f64 },
    Disc { centre: DVec3, normal: DVec3, radius: f64 },
}

/// A primitive with a ball around it, outside which a ray need not look.
struct Bounded {
    primitive: Exact,
    around: (DVec3, f64),
}

/// Where a ray meets a primitive.
#[derive(Clone, Copy, Debug)]
struct Crossing {
    t: f64,
    /// How far inside the primitive's outline, over its size; below zero outside.
    margin: f64,
    shape: u32,
}

/// Nearer to an outline or to the next crossing than this, relatively, a ray is left out.
const UNCLEAR: (f64, f64) = (1e-6, 1e-5);

impl Exact {
    /// A ball around the primitive, with room to spare: its centre and squared radius.
    fn around(&self) -> (DVec3, f64) {
        let (centre, radius) = match *self {
            Self::Triangle([a, b, c]) => (a, a.distance(b).max(a.distance(c))),
            Self::Sphere { centre, radius } | Self::Disc { centre, radius, .. } => (centre, radius),
        };
        (centre, 1.1 * radius * radius)
    }

    /// Calls `found` with the distance and margin of each crossing of the primitive, of its plane outside the outline too.
    /// Triangles as in Möller and Trumbore (1997).
    fn crossings(&self, origin: DVec3, d: DVec3, mut found: impl FnMut(f64, f64)) {
        match *self {
            Self::Triangle([a, b, c]) => {
                let (e1, e2, from_a) = (b - a, c - a, origin - a);
                let (p, q) = (d.cross(e2), from_a.cross(e1));
                let determinant = e1.dot(p);
                let (v, w) = (from_a.dot(p) / determinant, d.dot(q) / determinant);
                found(e2.dot(q) / determinant, v.min(w).min(1.0 - v - w));
            }
            Self::Sphere { centre, radius } => {
                let f = origin - centre;
                let b = f.dot(d);
                let passes2 = (f - d * b).length_squared() / (radius * radius);
                let half = radius * (1.0 - passes2).max(0.0).sqrt();
                found(-b - half, 1.0 - passes2);
                found(-b + half, 1.0 - passes2);
            }
            Self::Disc { centre, normal, radius } => {
                let t = (centre - origin).dot(normal) / d.dot(normal);
                found(t, 1.0 - (origin + d * t).distance(centre) / radius);
            }
        }
    }
}

/// 2000 triangles, 50 spheres and 50 discs of all sizes in a cube, each a shape of its own.
fn soup() -> Vec<ShapeDescription> {
    let mut stream = stream(50);
    let triangles = (0..2000).map(|_| {
        let (middle, size) = (in_cube(&mut stream), log_uniform([0.02, 0.3], &mut stream));
        triangle([(); 3].map(|()| middle + in_cube(&mut stream) * size))
    });
    let mut shapes: Vec<_> = triangles.collect();
    for i in 0..100 {
        let (centre, size) = (in_cube(&mut stream), log_uniform([0.01, 0.2], &mut stream));
        let turned = DQuat::from_rotation_arc(DVec3::Z, in_cube(&mut stream).normalize());
        let to_world = DAffine3::from_scale_rotation_translation(DVec3::splat(size), turned, centre);
        shapes.push(if i < 50 { ball(centre, size) } else { shape(Geometry::Disc, to_world) });
    }
    shapes
}

fn exact(shape: &ShapeDescription, units: &Normalisation) -> Exact {
    let (point, length) = (|p| units.point(p).as_dvec3(), |l| f64::from(units.length(l)));
    match &shape.geometry {
        Geometry::Mesh(mesh) => Exact::Triangle([0, 1, 2].map(|i| point(mesh.positions[i]))),
        Geometry::Sphere { centre, radius } => {
            Exact::Sphere { centre: point(*centre), radius: length(*radius) }
        }
        Geometry::Disc => {
            let (x, z) = (shape.to_world.matrix3.x_axis, shape.to_world.matrix3.z_axis);
            let normal = z.normalize().as_vec3().as_dvec3();
            Exact::Disc { centre: point(shape.to_world.translation), normal, radius: length(x.length()) }
        }
        Geometry::Cylinder { .. } => unreachable!("the soup holds no tubes"),
    }
}

/// All crossings ahead that are inside an outline or nearly so, the nearest first.
fn all_crossings(exact: &[Bounded], ray: Ray) -> Vec<Crossing> {
    let (origin, d) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let mut crossings = Vec::new();
    for (shape, Bounded { primitive, around: (centre, radius2) }) in (0..).zip(exact) {
        let to_centre = centre - origin;
        if (to_centre - d * to_centre.dot(d)).length_squared() > *radius2 {
            continue;
        }
        primitive.crossings(origin, d, |t, margin| {
            if t > 0.0 && margin > -UNCLEAR.0 {
                crossings.push(Crossing { t, margin, shape });
            }
        });
    }
    crossings.sort_by(|a, b| a.t.total_cmp(&b.t));
    crossings
}

#[test]
fn nearest_and_occluded_agree_with_every_primitive_in_double_precision() {
    let soup = soup();
    let scene = build(soup.clone());
    let exact = soup.iter().map(|shape| exact(shape, scene.normalisation()));
    let exact: Vec<_> = exact.map(|primitive| Bounded { around: primitive.around(), primitive }).collect();
    let mut stream = stream(51);
    let (mut met, mut unclear) = (0, 0);
    for _ in 0..200_000 {
        let ray = Ray::new(scene.normalisation().point(in_cube(&mut stream)), direction(&mut stream));
        let crossings = all_crossings(&exact, ray);
        let hit = scene.nearest(ray);
        let Some(first) = crossings.first() else {
            assert!(hit.is_none() && !scene.occluded(ray), "{ray:?} meets nothing, not {hit:?}");
            continue;
        };
        let alone = crossings.get(1).is_none_or(|next| next.t > first.t * (1.0 + UNCLEAR.1));
        if first.margin < UNCLEAR.0 || !alone {
            unclear += 1;
            continue;
        }
        met += 1;
        let hit = hit.filter(|hit| hit.shape == first.shape);
        let hit = hit.unwrap_or_else(|| panic!("{ray:?} meets {first:?}, not {:?}", scene.nearest(ray)));
        let t = (hit.position.as_dvec3() - ray.origin.as_dvec3()).dot(ray.direction.as_dvec3());
        // Positions are rounded to multiples of 2⁻¹³ and more, so short distances are no better.
        let tolerance = 1e-5 * first.t + 5e-4;
        assert!((t - first.t).abs() < tolerance, "{ray:?} meets {first:?}, not at {t}");
        let within = |t_max: f64| scene.occluded(Ray { t_max: t_max as f32, ..ray });
        assert!(!within(first.t - tolerance) && within(first.t + tolerance), "{ray:?}: {first:?}");
    }
    assert!(met > 100_000 && unclear < 100, "{met} {unclear}");
}
