//! Triangles and the vertices that they use: what comes of a primitive's numbers. Nothing of materials is known here.

use std::sync::Arc;

use foton_math::Cancel;
use foton_math::glam::{DVec2, DVec3};
use foton_scene::description::{Attribute, Mesh};

use super::accessor::Accessor;
use super::pose::Movers;

/// Bytes that a vertex and a triangle take at most while they are read.
pub(super) const VERTEX: u64 = (3 * size_of::<DVec3>() + size_of::<DVec2>() + 6 * size_of::<f32>()) as u64;
pub(super) const TRIANGLE: u64 = 3 * size_of::<[u32; 3]>() as u64;

/// Numbers of vertices are looked up in a table that has at most so many entries for each corner.
const TABLE: usize = 16;

/// What the vertices of a primitive have.
pub(super) struct Vertices<'b> {
    pub(super) positions: Accessor<'b>,
    pub(super) normals: Option<Accessor<'b>>,
    pub(super) coordinates: Option<Accessor<'b>>,
    pub(super) colours: Option<Accessor<'b>>,
    pub(super) movers: Movers<'b>,
}

/// The triangles of a list (mode 4), a strip (5) or a fan (6) of so many corners.
pub(super) fn triangles(
    mode: usize,
    corners: usize,
    corner: impl Fn(usize) -> u32,
    cancel: &Cancel,
) -> Vec<[u32; 3]> {
    let count = if mode == 4 { corners / 3 } else { corners.saturating_sub(2) };
    let of = |i: usize| match mode {
        4 => [3 * i, 3 * i + 1, 3 * i + 2],
        5 => [i, i + 1 + i % 2, i + 2 - i % 2],
        _ => [i + 1, i + 2, 0],
    };
    let go_on = |i: &usize| cancel.check_at(*i).is_ok();
    (0..count).take_while(go_on).map(|i| of(i).map(&corner)).collect()
}

/// The vertices that triangles use, in their order; then the triangles go by their place in that list.
pub(super) fn used(triangles: &mut [[u32; 3]]) -> Vec<u32> {
    let corners = || triangles.iter().flatten().copied();
    let (Some(low), Some(high)) = (corners().min(), corners().max()) else { return Vec::new() };
    let range = (high - low) as usize + 1;
    if range > 3 * TABLE * triangles.len() {
        let mut used: Vec<u32> = corners().collect();
        used.sort_unstable();
        used.dedup();
        for corner in triangles.iter_mut().flatten() {
            *corner = used.binary_search(corner).map_or(0, |place| place as u32);
        }
        return used;
    }
    let mut places = vec![0_u32; range];
    corners().for_each(|corner| places[(corner - low) as usize] = 1);
    let mut used = Vec::new();
    for (place, vertex) in places.iter_mut().zip(low..) {
        if *place > 0 {
            *place = used.len() as u32;
            used.push(vertex);
        }
    }
    for corner in triangles.iter_mut().flatten() {
        *corner = places[(*corner - low) as usize];
    }
    used
}

impl Vertices<'_> {
    /// A mesh of those vertices; the number of one whose position is no number, where there is one. Once cancelled it is cut short.
    pub(super) fn mesh(&self, used: &[u32], triangles: Vec<[u32; 3]>, cancel: &Cancel) -> Result<Mesh, u32> {
        let mut mesh = Mesh { triangles, ..Mesh::default() };
        mesh.positions.reserve_exact(used.len());
        for (i, &vertex) in used.iter().enumerate() {
            if cancel.check_at(i).is_err() {
                return Ok(Mesh::default());
            }
            let place = vertex as usize;
            let mut position = DVec3::from_array(self.positions.read(place));
            let mut normal = self.normals.as_ref().map(|of| DVec3::from_array(of.read(place)));
            if !self.movers.is_still() {
                let (moved, turned) = self.movers.moved(place, position, normal.unwrap_or(DVec3::Z));
                position = moved;
                normal = normal.map(|_| turned);
            }
            if !position.is_finite() {
                return Err(vertex);
            }
            mesh.positions.push(position);
            mesh.normals.extend(normal);
            let coordinate = self.coordinates.as_ref().map(|of| DVec2::from_array(of.read(place)));
            mesh.texture_coordinates.extend(coordinate);
        }
        Ok(mesh)
    }

    /// The colour and the opacity of a vertex; white where there are none.
    pub(super) fn colour(&self, vertex: u32) -> [f32; 4] {
        let Some(colours) = &self.colours else { return [1.0; 4] };
        let share = |x: f64| if x.is_finite() { x.clamp(0.0, 1.0) as f32 } else { 0.0 };
        let [r, g, b, a] = colours.read(vertex as usize).map(share);
        [r, g, b, if colours.width > 3 { a } else { 1.0 }]
    }

    /// Numbers for each of some vertices, made of their colours.
    pub(super) fn attribute<const N: usize>(
        &self,
        name: &str,
        used: &[u32],
        of: impl Fn([f32; 4]) -> [f32; N],
    ) -> Attribute {
        let values: Arc<[f32]> = used.iter().flat_map(|vertex| of(self.colour(*vertex))).collect();
        Attribute { name: name.to_owned(), channels: N, values }
    }

    /// The colour that all corners share, if they do.
    pub(super) fn shared_colour(&self, triangles: &[[u32; 3]]) -> Option<[f32; 4]> {
        let mut corners = triangles.iter().flatten();
        let first = corners.next().map_or([1.0; 4], |vertex| self.colour(*vertex));
        corners.all(|vertex| self.colour(*vertex) == first).then_some(first)
    }

    /// The triangles, those apart on which texture coordinates are mirrored: which turn to the left seen from outside, where v points
    /// down.
    pub(super) fn by_side(&self, triangles: Vec<[u32; 3]>) -> [Vec<[u32; 3]>; 2] {
        let Some(coordinates) = &self.coordinates else { return [triangles, Vec::new()] };
        let is_mirrored = |corners: &[u32; 3]| {
            let [a, b, c] = corners.map(|i| DVec2::from_array(coordinates.read(i as usize)));
            (b - a).perp_dot(c - a) > 0.0
        };
        let (mirrored, others) = triangles.into_iter().partition(is_mirrored);
        [others, mirrored]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_turn_every_other_triangle_and_fans_share_their_first_corner() {
        let cancel = Cancel::default();
        let of = |mode, corners| triangles(mode, corners, |i| i as u32, &cancel);
        assert_eq!(of(4, 7), [[0, 1, 2], [3, 4, 5]]);
        // The formulas of glTF 2.0, 3.7.2.1.
        assert_eq!(of(5, 5), [[0, 1, 2], [1, 3, 2], [2, 3, 4]]);
        assert_eq!(of(6, 5), [[1, 2, 0], [2, 3, 0], [3, 4, 0]]);
        assert!(of(5, 1).is_empty());
    }

    #[test]
    fn vertices_that_no_triangle_uses_are_left_out() {
        for far in [7, 4_000_000_000] {
            let mut triangles = [[5, 3, far], [3, 5, 4]];
            assert_eq!(used(&mut triangles), [3, 4, 5, far]);
            assert_eq!(triangles, [[2, 0, 3], [0, 2, 1]]);
        }
        assert!(used(&mut []).is_empty());
    }
}
