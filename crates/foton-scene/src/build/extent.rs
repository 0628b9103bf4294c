//! How far a mesh reaches under a transform, without transforming all of its vertices each time.

use std::ops::Range;

use foton_math::glam::{DAffine3, DVec3};

use crate::description::Mesh;

/// Vertices in a leaf, and boxes in a box.
const GROUP: usize = 16;

/// Rounding of a transformed box, as a share of its coordinates; generous.
const ROUNDING: f64 = 1e-12;

/// Centre and half-size of a box.
type Box = [DVec3; 2];

/// The vertices of a mesh that triangles with an area have, in boxes of boxes.
pub(super) struct Extent {
    /// In an order in which neighbours are close.
    points: Vec<DVec3>,
    /// Around so many points each, and around so many of those; the last level has few.
    levels: Vec<Vec<Box>>,
    /// The box around all vertices, those of no triangle too: not finite where any of them is not.
    all: Box,
}

impl Extent {
    pub(super) fn new(mesh: &Mesh) -> Self {
        let mut is_used = vec![false; mesh.positions.len()];
        for triangle in mesh.triangles.iter().filter(|t| mesh.has_area(**t)) {
            triangle.iter().for_each(|&i| is_used[i as usize] = true);
        }
        let used = mesh.positions.iter().zip(is_used).filter(|(_, is_used)| *is_used);
        let mut points: Vec<DVec3> = used.map(|(p, _)| *p).collect();
        let all = around(&mesh.positions);
        points.sort_by_cached_key(|&p| along_curve(p, all));
        let mut levels = vec![points.chunks(GROUP).map(around).collect::<Vec<_>>()];
        while let Some(last) = levels.last().filter(|level| level.len() > 2 * GROUP) {
            let next = last.chunks(GROUP).map(around_boxes).collect();
            levels.push(next);
        }
        Self { points, levels, all }
    }

    /// The box around the mesh in its own space; empty where it has no triangle.
    pub(super) fn bounds(&self) -> (DVec3, DVec3) {
        self.under(&DAffine3::IDENTITY)
    }

    /// The corners of the transformed mesh, as transforming each vertex gives them; not finite where any is not.
    pub(super) fn under(&self, to_world: &DAffine3) -> (DVec3, DVec3) {
        let m = to_world.matrix3;
        let mut corners = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let [centre, half] = self.all;
        let farthest = m.x_axis.abs() * half.x + m.y_axis.abs() * half.y + m.z_axis.abs() * half.z;
        if !(to_world.transform_point3(centre).is_finite() && farthest.is_finite()) {
            return (DVec3::NAN, DVec3::NAN);
        }
        if self.points.is_empty() {
            return corners;
        }
        for axis in 0..3 {
            let row = DVec3::new(m.x_axis[axis], m.y_axis[axis], m.z_axis[axis]);
            for sign in [-1.0, 1.0] {
                let mut search = Search { to_world, axis, sign, row: row * sign, most: f64::NEG_INFINITY };
                let top = self.levels.len() - 1;
                self.enter(top, 0..self.levels[top].len(), &mut search);
                let corner = if sign < 0.0 { &mut corners.0 } else { &mut corners.1 };
                corner[axis] = search.most * sign;
            }
        }
        corners
    }

    /// Looks at the boxes of a level from the one that reaches farthest on, until none reaches as far as what was found.
    fn enter(&self, level: usize, boxes: Range<usize>, search: &mut Search<'_>) {
        let mut reaches = [f64::NEG_INFINITY; 2 * GROUP];
        for (reach, i) in reaches.iter_mut().zip(boxes.clone()) {
            *reach = search.reach(&self.levels[level][i]);
        }
        loop {
            let farthest =
                (0..boxes.len()).fold(0, |best, i| if reaches[i] > reaches[best] { i } else { best });
            if reaches[farthest] <= search.most {
                return;
            }
            reaches[farthest] = f64::NEG_INFINITY;
            let i = boxes.start + farthest;
            let first = i * GROUP;
            if level == 0 {
                let end = (first + GROUP).min(self.points.len());
                self.points[first..end].iter().for_each(|&p| search.add(p));
            } else {
                self.enter(level - 1, first..(first + GROUP).min(self.levels[level - 1].len()), search);
            }
        }
    }
}

/// How far a transformed mesh is known to reach to one side along an axis.
struct Search<'a> {
    to_world: &'a DAffine3,
    axis: usize,
    /// To which side.
    sign: f64,
    /// What a coordinate there takes of a point.
    row: DVec3,
    most: f64,
}

impl Search<'_> {
    /// How far a transformed box reaches, or a little farther.
    fn reach(&self, [centre, half]: &Box) -> f64 {
        let by_box = self.row.abs().dot(*half);
        let shift = self.to_world.translation[self.axis] * self.sign;
        let at = self.row.dot(*centre) + shift;
        at + by_box + (self.row.abs().dot(centre.abs()) + by_box + shift.abs()) * ROUNDING
    }

    fn add(&mut self, p: DVec3) {
        self.most = self.most.max(self.to_world.transform_point3(p)[self.axis] * self.sign);
    }
}

/// Place of a point along Morton's curve through a box.
fn along_curve(p: DVec3, [centre, half]: Box) -> u32 {
    let share = (p - centre) / (2.0 * half.max_element().max(f64::MIN_POSITIVE)) + 0.5;
    let cells = (share * 1023.0).to_array().map(|c| c as u32);
    (0..30).fold(0, |code, bit| code | (cells[bit as usize % 3] >> (bit / 3) & 1) << bit)
}

fn around_boxes(boxes: &[Box]) -> Box {
    let corners: Vec<DVec3> =
        boxes.iter().flat_map(|[centre, half]| [centre - half, centre + half]).collect();
    let [centre, half] = around(&corners);
    // Halving and adding again may lose a digit.
    [centre, half + (centre.abs() + half) * ROUNDING]
}

/// Centre and half-size of the box around points.
fn around(points: &[DVec3]) -> Box {
    let (min, max) =
        points.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(min, max), &p| (min.min(p), max.max(p)));
    // A sum has what is no number; a minimum does not.
    let sound = points.iter().all(|p| p.is_finite());
    let centre = if points.is_empty() { DVec3::ZERO } else { min * 0.5 + max * 0.5 };
    let half = if points.is_empty() { DVec3::ZERO } else { max * 0.5 - min * 0.5 };
    if sound { [centre, half] } else { [DVec3::NAN; 2] }
}

#[cfg(test)]
mod tests {
    use foton_math::{Purpose, Stream, warp};

    use super::*;

    #[test]
    fn a_transformed_mesh_reaches_exactly_as_far_as_its_vertices() {
        let mut stream = Stream::new(22, Purpose::Test, 0, 0);
        let mut points = |count: usize| -> Vec<DVec3> {
            (0..count).map(|_| warp::square_to_sphere(stream.next_2d()).as_dvec3() * 3.0 + 0.5).collect()
        };
        let triangles = (0..3000u32).map(|i| [i, (i * 7 + 1) % 3000, (i * 13 + 5) % 3000]).collect();
        let mesh = Mesh { positions: points(3000), triangles, ..Mesh::default() };
        let extent = Extent::new(&mesh);
        for axes in points(60).chunks(4) {
            let [x, y, z, t] = [0, 1, 2, 3].map(|i| axes[i] * [1.0, 1e-3, 40.0, 1e4][i]);
            let to_world = DAffine3::from_cols(x, y, z, t);
            let all = mesh.positions.iter().map(|&p| to_world.transform_point3(p));
            let by_vertices =
                all.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(a, b), p| (a.min(p), b.max(p)));
            assert_eq!(extent.under(&to_world), by_vertices);
        }
        let far = DAffine3::from_scale(DVec3::splat(1e308));
        assert!(extent.under(&far).0.is_nan());
    }
}
