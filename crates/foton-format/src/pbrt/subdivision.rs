//! Loop's subdivision of triangles, with the vertices on its limit surface. `[LOOP87]`

use std::collections::HashMap;

use foton_math::Cancel;
use foton_math::glam::DVec3;

/// Triangles over points.
pub(crate) struct Surface {
    pub(crate) points: Vec<DVec3>,
    pub(crate) triangles: Vec<[u32; 3]>,
}

/// Who is next to a vertex.
#[derive(Clone, Default)]
struct Neighbours {
    all: Vec<u32>,
    /// Those at the other ends of edges that have one triangle.
    at_rim: Vec<u32>,
}

/// The corners opposite of an edge, and what becomes of its middle.
#[derive(Default)]
struct Edge {
    opposite: Vec<u32>,
    middle: u32,
}

fn key(a: u32, b: u32) -> (u32, u32) {
    (a.min(b), a.max(b))
}

fn edges(triangles: &[[u32; 3]]) -> HashMap<(u32, u32), Edge> {
    let mut edges: HashMap<(u32, u32), Edge> = HashMap::new();
    for t in triangles {
        for i in 0..3 {
            let edge = edges.entry(key(t[i], t[(i + 1) % 3])).or_default();
            edge.opposite.push(t[(i + 2) % 3]);
        }
    }
    edges
}

fn neighbours(points: usize, edges: &HashMap<(u32, u32), Edge>) -> Vec<Neighbours> {
    let mut all = vec![Neighbours::default(); points];
    let mut sorted: Vec<_> = edges.iter().map(|(key, edge)| (*key, edge.opposite.len() == 1)).collect();
    // Sums are taken in one order, whatever the map's is.
    sorted.sort_unstable();
    for ((a, b), at_rim) in sorted {
        for (of, other) in [(a, b), (b, a)] {
            all[of as usize].all.push(other);
            if at_rim {
                all[of as usize].at_rim.push(other);
            }
        }
    }
    all
}

impl Surface {
    /// So many times four triangles for one, and then the points that they tend to. Once cancelled it is whatever it is by then.
    pub(crate) fn subdivided(mut self, levels: u32, cancel: &Cancel) -> Self {
        for _ in 0..levels {
            if cancel.is_requested() {
                return self;
            }
            self = self.refined();
        }
        let around = neighbours(self.points.len(), &edges(&self.triangles));
        let limit = |i: usize| {
            let n = around[i].all.len() as f64;
            moved(&self.points, i, &around[i], 1.0 / (n + 3.0 / (8.0 * inner_weight(n))), 0.2)
        };
        self.points = (0..self.points.len()).map(limit).collect();
        self
    }

    fn refined(&self) -> Self {
        let mut edges = edges(&self.triangles);
        let around = neighbours(self.points.len(), &edges);
        let old =
            |i: usize| moved(&self.points, i, &around[i], inner_weight(around[i].all.len() as f64), 0.125);
        let mut points: Vec<DVec3> = (0..self.points.len()).map(old).collect();
        let at = |i: u32| self.points[i as usize];
        let mut sorted: Vec<_> = edges.iter_mut().collect();
        sorted.sort_unstable_by_key(|(key, _)| **key);
        for ((a, b), edge) in sorted {
            edge.middle = points.len() as u32;
            let ends = at(*a) + at(*b);
            points.push(match edge.opposite[..] {
                [c, d] => ends * 0.375 + (at(c) + at(d)) * 0.125,
                _ => ends * 0.5,
            });
        }
        let mut triangles = Vec::with_capacity(4 * self.triangles.len());
        for &[a, b, c] in &self.triangles {
            let [ab, bc, ca] = [(a, b), (b, c), (c, a)].map(|(x, y)| edges[&key(x, y)].middle);
            triangles.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        Self { points, triangles }
    }
}

/// Weight of each neighbour of an inner vertex.
fn inner_weight(neighbours: f64) -> f64 {
    if neighbours == 3.0 { 3.0 / 16.0 } else { 3.0 / (8.0 * neighbours.max(1.0)) }
}

/// A vertex between its neighbours: with a weight for each inside, and one for those along the rim.
fn moved(points: &[DVec3], i: usize, around: &Neighbours, inside: f64, rim: f64) -> DVec3 {
    let sum = |of: &[u32]| of.iter().map(|&j| points[j as usize]).sum::<DVec3>();
    match around.at_rim.len() {
        0 if !around.all.is_empty() => {
            points[i] * (1.0 - inside * around.all.len() as f64) + sum(&around.all) * inside
        }
        2 => points[i] * (1.0 - 2.0 * rim) + sum(&around.at_rim) * rim,
        _ => points[i],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flat_grid_stays_flat_and_an_octahedron_becomes_nearly_a_ball() {
        let cancel = Cancel::default();
        let flat = Surface {
            points: vec![DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
        };
        let flat = flat.subdivided(3, &cancel);
        assert_eq!((flat.triangles.len(), flat.points.len()), (2 * 64, 81));
        assert!(flat.points.iter().all(|p| p.z == 0.0));
        let axes = [DVec3::X, DVec3::Y, DVec3::NEG_X, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z];
        let triangles =
            vec![[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4], [1, 0, 5], [2, 1, 5], [3, 2, 5], [0, 3, 5]];
        let ball = Surface { points: axes.to_vec(), triangles }.subdivided(3, &cancel);
        let radii: Vec<f64> = ball.points.iter().map(|p| p.length()).collect();
        let (low, high) = radii.iter().fold((f64::MAX, 0.0_f64), |(a, b), r| (a.min(*r), b.max(*r)));
        assert!(low > 0.4 && high / low < 1.25, "{low} {high}");
        // A vertex of four neighbours tends to (1 − 4γ) p + γ Σ, where γ = 1/8 here and the sum of the four is zero.
        let first = ball.points[0].length();
        assert!((first - 0.5).abs() < 1e-12, "{first}");
    }
}
