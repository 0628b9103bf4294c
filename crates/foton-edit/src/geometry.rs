//! Sizes and middles of shapes, and moving and scaling them, in world units.

use std::f64::consts::PI;

use foton_math::glam::{DAffine3, DVec3};
use foton_scene::description::{Colour, Geometry, Mesh, ShapeDescription};

/// The corners of a surface's bounds in object space.
pub(crate) fn object_bounds(geometry: &Geometry) -> (DVec3, DVec3) {
    match geometry {
        Geometry::Mesh(mesh) => {
            let start = (DVec3::INFINITY, DVec3::NEG_INFINITY);
            let bounds = mesh.positions.iter().fold(start, |(a, b), p| (a.min(*p), b.max(*p)));
            if mesh.positions.is_empty() { (DVec3::ZERO, DVec3::ZERO) } else { bounds }
        }
        Geometry::Sphere { centre, radius } => (centre - *radius, centre + *radius),
        Geometry::Disc => (DVec3::new(-1.0, -1.0, 0.0), DVec3::new(1.0, 1.0, 0.0)),
        Geometry::Cylinder { from, to, radius } => {
            let axis = (to - from).normalize_or_zero();
            let extent = (DVec3::ONE - axis * axis).max(DVec3::ZERO).map(f64::sqrt) * *radius;
            (from.min(*to) - extent, from.max(*to) + extent)
        }
    }
}

/// The middle of a shape's bounds.
pub(crate) fn centre(shape: &ShapeDescription) -> DVec3 {
    let (min, max) = object_bounds(&shape.geometry);
    shape.to_world.transform_point3((min + max) * 0.5)
}

/// The longest side of a shape's bounds, which turn with it.
pub(crate) fn size(shape: &ShapeDescription) -> f64 {
    let (min, max) = object_bounds(&shape.geometry);
    let m = shape.to_world.matrix3;
    let scale = DVec3::new(m.x_axis.length(), m.y_axis.length(), m.z_axis.length());
    ((max - min) * scale).max_element()
}

/// The radius of a sphere or a disc.
pub(crate) fn radius(shape: &ShapeDescription) -> Option<f64> {
    let scale = shape.to_world.matrix3.x_axis.length();
    match shape.geometry {
        Geometry::Sphere { radius, .. } => Some(radius * scale),
        Geometry::Disc => Some(scale),
        _ => None,
    }
}

/// A shape's area, one side.
pub(crate) fn area(shape: &ShapeDescription) -> f64 {
    let scale = shape.to_world.matrix3.x_axis.length();
    match &shape.geometry {
        Geometry::Mesh(mesh) => mesh_area(mesh, &shape.to_world),
        Geometry::Sphere { radius, .. } => 4.0 * PI * (radius * scale).powi(2),
        Geometry::Disc => PI * scale * scale,
        Geometry::Cylinder { from, to, radius } => 2.0 * PI * radius * from.distance(*to) * scale * scale,
    }
}

fn mesh_area(mesh: &Mesh, to_world: &DAffine3) -> f64 {
    let corner = |i: u32| mesh.positions.get(i as usize).map_or(DVec3::ZERO, |p| to_world.matrix3 * *p);
    let areas = mesh.triangles.iter().map(|t| {
        let [a, b, c] = t.map(corner);
        0.5 * (b - a).cross(c - a).length()
    });
    areas.sum()
}

/// Moves a shape. A sphere without a transform keeps none: its centre moves.
pub(crate) fn translate(shape: &mut ShapeDescription, by: DVec3) {
    match &mut shape.geometry {
        Geometry::Sphere { centre, .. } if shape.to_world == DAffine3::IDENTITY => *centre += by,
        _ => shape.to_world.translation += by,
    }
}

/// Scales a shape about its middle. Where it emits, its power stays: the radiance falls with the area. A texture stays as it is.
pub(crate) fn scale(shape: &mut ShapeDescription, factor: f64) {
    if let Geometry::Sphere { radius, .. } = &mut shape.geometry {
        *radius *= factor;
    } else {
        let c = centre(shape);
        shape.to_world.matrix3 *= factor;
        shape.to_world.translation = c + (shape.to_world.translation - c) * factor;
    }
    if let Some(Colour::Constant(radiance)) = &mut shape.radiance {
        *radiance *= (1.0 / (factor * factor)) as f32;
    }
}

/// The sides of a shape's bounds along its own axes, in world units.
pub(crate) fn extents(shape: &ShapeDescription) -> [f64; 3] {
    let (min, max) = object_bounds(&shape.geometry);
    let m = shape.to_world.matrix3;
    let scale = DVec3::new(m.x_axis.length(), m.y_axis.length(), m.z_axis.length());
    ((max - min) * scale).to_array()
}

/// Scales a mesh about its middle by factors along its own axes. Where it emits, its power stays.
pub(crate) fn stretch(shape: &mut ShapeDescription, factors: DVec3) {
    let (before, c) = (area(shape), centre(shape));
    let m = &mut shape.to_world.matrix3;
    for (axis, factor) in [&mut m.x_axis, &mut m.y_axis, &mut m.z_axis].into_iter().zip(factors.to_array()) {
        *axis *= factor;
    }
    let moved = centre(shape);
    shape.to_world.translation += c - moved;
    let after = area(shape);
    let seen = before > 0.0 && after > 0.0;
    if let Some(Colour::Constant(radiance)) = shape.radiance.as_mut().filter(|_| seen) {
        *radiance *= (before / after) as f32;
    }
}

/// The way that a flat shape faces, on average; `None` for one that is closed, or nearly.
pub(crate) fn facing(shape: &ShapeDescription) -> Option<DVec3> {
    let m = &shape.to_world.matrix3;
    let side = if shape.flip_normals { -1.0 } else { 1.0 };
    match &shape.geometry {
        Geometry::Disc => {
            let mirrored = if m.determinant() < 0.0 { -1.0 } else { 1.0 };
            (m.x_axis.cross(m.y_axis) * (side * mirrored)).try_normalize()
        }
        Geometry::Mesh(mesh) => {
            let side = if m.determinant() < 0.0 { -side } else { side };
            let corner = |i: u32| mesh.positions.get(i as usize).map_or(DVec3::ZERO, |p| *m * *p);
            let (mut sum, mut all) = (DVec3::ZERO, 0.0);
            for [a, b, c] in mesh.triangles.iter().map(|t| t.map(corner)) {
                let normal = (b - a).cross(c - a);
                sum += normal;
                all += normal.length();
            }
            (sum.length() > 0.5 * all).then(|| sum.normalize_or_zero() * side)
        }
        Geometry::Sphere { .. } | Geometry::Cylinder { .. } => None,
    }
}

/// The corners of a box in the world that holds a shape: of a mesh its own, of others their turned bounds'.
pub(crate) fn world_bounds(shape: &ShapeDescription) -> (DVec3, DVec3) {
    let start = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let widen = |(a, b): (DVec3, DVec3), p: DVec3| (a.min(p), b.max(p));
    let to_world = |p: DVec3| shape.to_world.transform_point3(p);
    if let Geometry::Mesh(mesh) = &shape.geometry {
        return mesh.positions.iter().map(|p| to_world(*p)).fold(start, widen);
    }
    let (min, max) = object_bounds(&shape.geometry);
    let corner = |i: usize| {
        let pick = |axis: usize| if i >> axis & 1 == 0 { min[axis] } else { max[axis] };
        to_world(DVec3::new(pick(0), pick(1), pick(2)))
    };
    (0..8).map(corner).fold(start, widen)
}
