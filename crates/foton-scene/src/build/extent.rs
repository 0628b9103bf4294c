//! How far a mesh reaches under a transform, without transforming all of its vertices each time.

use foton_math::glam::{DAffine3, DVec3};

use crate::description::Mesh;

/// Vertices that are looked at together.
const GROUP: usize = 128;

/// Rounding of a transformed box, as a share of its coordinates; generous.
const ROUNDING: f64 = 1e-12;

/// The vertices of a mesh that triangles with an area have, in groups with a box around each.
pub(super) struct Extent {
    points: Vec<DVec3>,
    /// Centre and half-size of the box around each group.
    boxes: Vec<[DVec3; 2]>,
    /// The box around all vertices, those of no triangle too: not finite where any of them is not.
    all: [DVec3; 2],
}

impl Extent {
    pub(super) fn new(mesh: &Mesh) -> Self {
        let mut is_used = vec![false; mesh.positions.len()];
        for triangle in mesh.triangles.iter().filter(|t| mesh.has_area(**t)) {
            triangle.iter().for_each(|&i| is_used[i as usize] = true);
        }
        let used = mesh.positions.iter().zip(is_used).filter(|(_, is_used)| *is_used);
        let points: Vec<DVec3> = used.map(|(p, _)| *p).collect();
        Self { boxes: points.chunks(GROUP).map(around).collect(), points, all: around(&mesh.positions) }
    }

    /// The box around the mesh in its own space; empty where it has no triangle.
    pub(super) fn bounds(&self) -> (DVec3, DVec3) {
        self.under(&DAffine3::IDENTITY)
    }

    /// The corners of the transformed mesh, as transforming each vertex gives them; not finite where any is not.
    pub(super) fn under(&self, to_world: &DAffine3) -> (DVec3, DVec3) {
        let m = to_world.matrix3;
        let [x, y, z] = [m.x_axis, m.y_axis, m.z_axis].map(DVec3::abs);
        let reach = |half: DVec3| x * half.x + y * half.y + z * half.z;
        let [centre, half] = self.all;
        if !(to_world.transform_point3(centre).is_finite() && reach(half).is_finite()) {
            return (DVec3::NAN, DVec3::NAN);
        }
        let (mut min, mut max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for (points, [centre, half]) in self.points.chunks(GROUP).zip(&self.boxes) {
            let (at, reach) = (to_world.transform_point3(*centre), reach(*half));
            let reach = reach + (at.abs() + reach + to_world.translation.abs()) * ROUNDING;
            if (at - reach).cmpge(min).all() && (at + reach).cmple(max).all() {
                continue;
            }
            for &p in points {
                let p = to_world.transform_point3(p);
                (min, max) = (min.min(p), max.max(p));
            }
        }
        (min, max)
    }
}

/// Centre and half-size of the box around points.
fn around(points: &[DVec3]) -> [DVec3; 2] {
    let (min, max) = points
        .iter()
        .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(min, max), &p| (min.min(p), max.max(p)));
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
            let by_vertices = all.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(a, b), p| (a.min(p), b.max(p)));
            assert_eq!(extent.under(&to_world), by_vertices);
        }
        let far = DAffine3::from_scale(DVec3::splat(1e308));
        assert!(extent.under(&far).0.is_nan());
    }
}
