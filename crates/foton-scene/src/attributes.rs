//! What meshes state of their vertices or faces, at points of surfaces.

use std::sync::Arc;

use foton_math::Rgb;
use foton_math::glam::Vec2;

use crate::description::Attribute;

/// A place on a mesh.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Corner {
    /// Index of the shape.
    pub(crate) shape: u32,
    /// Index of the primitive, in the order in which shapes state them.
    pub(crate) primitive: u32,
    /// Weights of a triangle's second and third vertex.
    pub(crate) weights: Vec2,
    /// Whether those two are the other way around among the shape's corners.
    pub(crate) is_turned: bool,
}

/// An attribute of all shapes that have it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Attributes(Vec<OfShape>);

#[derive(Clone, Debug)]
struct OfShape {
    shape: u32,
    /// Index of the shape's first primitive.
    first: u32,
    /// What each of its triangles takes at its corners.
    corners: Arc<[[u32; 3]]>,
    /// One or three numbers each.
    channels: usize,
    values: Arc<[f32]>,
}

impl Attributes {
    /// Those of a shape whose first primitive has that index; shapes come in order.
    pub(crate) fn add(&mut self, shape: u32, first: u32, attribute: &Attribute, corners: Arc<[[u32; 3]]>) {
        let Attribute { channels, values, .. } = attribute;
        self.0.push(OfShape { shape, first, corners, channels: *channels, values: Arc::clone(values) });
    }

    /// Bytes of corners; values are the description's.
    pub(crate) fn bytes(&self) -> usize {
        self.0.iter().map(|of| of.corners.len() * size_of::<[u32; 3]>()).sum()
    }

    /// The value at a place, interpolated; black where the shape has none.
    pub(crate) fn at(&self, place: &Corner) -> Rgb {
        let Ok(i) = self.0.binary_search_by_key(&place.shape, |of| of.shape) else { return Rgb::BLACK };
        let of = &self.0[i];
        let Some(&[a, b, c]) = of.corners.get(place.primitive.wrapping_sub(of.first) as usize) else {
            return Rgb::BLACK;
        };
        let value = |i: u32| {
            let values = &of.values[i as usize * of.channels..];
            if of.channels == 1 { Rgb::splat(values[0]) } else { Rgb::new(values[0], values[1], values[2]) }
        };
        let [a, b, c] = if place.is_turned { [a, c, b] } else { [a, b, c] }.map(value);
        let (v, w) = (place.weights.x, place.weights.y);
        a * (1.0 - v - w) + b * v + c * w
    }
}
