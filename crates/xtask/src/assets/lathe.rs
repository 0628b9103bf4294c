//! Bodies of revolution: a curve, drawn from lines, arcs and Bézier curves, turned about the y axis.
//!
//! Not a general sweep: the axis is y, and a curve that does not close must begin and end on it.

use std::f64::consts::TAU;

use super::mesh::Mesh;

/// A curve in the half-plane of (distance from the axis, height), drawn so that the outside of the solid is on its right.
pub(super) struct Profile {
    points: Vec<[f64; 2]>,
    /// The normals at the two ends of the span that begins at each point; they differ along a bend.
    normals: Vec<[[f64; 2]; 2]>,
}

impl Profile {
    pub(super) fn start(point: [f64; 2]) -> Self {
        Self { points: vec![point], normals: Vec::new() }
    }

    pub(super) fn end(&self) -> [f64; 2] {
        self.points[self.points.len() - 1]
    }

    /// Follows `point(t)` with direction `tangent(t)` for t in (0, 1].
    fn follow(
        mut self,
        steps: u32,
        point: impl Fn(f64) -> [f64; 2],
        tangent: impl Fn(f64) -> [f64; 2],
    ) -> Self {
        let right_of = |[r, y]: [f64; 2]| [y / r.hypot(y), -r / r.hypot(y)];
        let t = |step: u32| f64::from(step) / f64::from(steps);
        for step in 0..steps {
            self.points.push(point(t(step + 1)));
            self.normals.push([right_of(tangent(t(step))), right_of(tangent(t(step + 1)))]);
        }
        self
    }

    pub(super) fn line(self, to: [f64; 2]) -> Self {
        let from = self.end();
        self.follow(1, |_| to, |_| [to[0] - from[0], to[1] - from[1]])
    }

    /// Turns counter-clockwise around `centre`.
    pub(super) fn arc(self, centre: [f64; 2], degrees: f64, steps: u32) -> Self {
        let [r, y] = [self.end()[0] - centre[0], self.end()[1] - centre[1]];
        let turn = move |t: f64| {
            let (sin, cos) = (degrees.to_radians() * t).sin_cos();
            [r * cos - y * sin, r * sin + y * cos]
        };
        let point = |t| [centre[0] + turn(t)[0], centre[1] + turn(t)[1]];
        self.follow(steps, point, |t| [-turn(t)[1], turn(t)[0]])
    }

    /// A cubic Bézier curve with the control points `c1` and `c2`.
    pub(super) fn bezier(self, c1: [f64; 2], c2: [f64; 2], to: [f64; 2], steps: u32) -> Self {
        let from = self.end();
        let weigh = move |w: [f64; 4]| {
            [0, 1].map(|axis| w[0] * from[axis] + w[1] * c1[axis] + w[2] * c2[axis] + w[3] * to[axis])
        };
        let point = move |t: f64| {
            let s = 1.0 - t;
            weigh([s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t])
        };
        let tangent = move |t: f64| {
            let s = 1.0 - t;
            weigh([-s * s, s * s - 2.0 * s * t, 2.0 * s * t - t * t, t * t])
        };
        self.follow(steps, point, tangent)
    }

    /// Where two spans meet at less than this angle, the surface is smooth across them; else it has an edge.
    const CREASE_DEGREES: f64 = 25.0;

    /// The normals, with the two at each smooth joint replaced by their mean.
    fn smooth_normals(&self) -> Vec<[[f64; 2]; 2]> {
        let mut smooth = self.normals.clone();
        for joint in 1..smooth.len() {
            let ([a, b], [c, d]) = (smooth[joint - 1][1], smooth[joint][0]);
            if a * c + b * d > Self::CREASE_DEGREES.to_radians().cos() {
                let length = (a + c).hypot(b + d);
                let mean = [(a + c) / length, (b + d) / length];
                (smooth[joint - 1][1], smooth[joint][0]) = (mean, mean);
            }
        }
        smooth
    }

    /// Turns the curve about the y axis. It must begin and end on the axis, or end where it began.
    pub(super) fn revolve(&self, segments: usize) -> Mesh {
        let mut mesh = Mesh::default();
        let mut circles: Vec<_> =
            self.points.iter().map(|&p| Circle::push(&mut mesh.positions, p, segments)).collect();
        let last = circles.len() - 1;
        if self.points[last][0] > 0.0 {
            mesh.positions.truncate(circles[last].first);
            circles[last] = circles[0];
        }
        let mut previous = None;
        for (i, [start, end]) in self.smooth_normals().into_iter().enumerate() {
            let from = match previous {
                Some((normal, circle)) if normal == start => circle,
                _ => Circle::push(&mut mesh.normals, start, segments),
            };
            let to = Circle::push(&mut mesh.normals, end, segments);
            previous = Some((end, to));
            for k in 0..segments {
                let corner = |j: usize, normals: Circle, k| [circles[j].at(k), normals.at(k)];
                let mut face = vec![
                    corner(i, from, k),
                    corner(i + 1, to, k),
                    corner(i + 1, to, k + 1),
                    corner(i, from, k + 1),
                ];
                face.dedup_by_key(|c| c[0]);
                if face[0][0] == face[face.len() - 1][0] {
                    face.pop();
                }
                mesh.faces.push(face);
            }
        }
        mesh
    }
}

/// The vectors that one point of a profile becomes: a run of them around the axis, or a single one on it.
#[derive(Clone, Copy)]
struct Circle {
    first: usize,
    count: usize,
}

impl Circle {
    fn push(list: &mut Vec<[f64; 3]>, [r, y]: [f64; 2], segments: usize) -> Self {
        let circle = Self { first: list.len(), count: if r.abs() < 1e-9 { 1 } else { segments } };
        list.extend((0..circle.count).map(|k| around(r, y, TAU * k as f64 / segments as f64)));
        circle
    }

    fn at(self, k: usize) -> usize {
        self.first + k % self.count
    }
}

pub(super) fn around(r: f64, y: f64, angle: f64) -> [f64; 3] {
    [r * angle.cos(), y, r * angle.sin()]
}
