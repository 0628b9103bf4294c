//! Sizes and middles of shapes, and moving and scaling them, in world units.

use std::f64::consts::PI;

use foton_math::glam::{DAffine3, DVec3};
use foton_scene::description::{Geometry, Mesh, ShapeDescription};

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

/// Scales a shape about its middle. Where it emits, its power stays: the radiance falls with the area.
pub(crate) fn scale(shape: &mut ShapeDescription, factor: f64) {
    if let Geometry::Sphere { radius, .. } = &mut shape.geometry {
        *radius *= factor;
    } else {
        let c = centre(shape);
        shape.to_world.matrix3 *= factor;
        shape.to_world.translation = c + (shape.to_world.translation - c) * factor;
    }
    if let Some(radiance) = &mut shape.radiance {
        *radiance *= (1.0 / (factor * factor)) as f32;
    }
}
