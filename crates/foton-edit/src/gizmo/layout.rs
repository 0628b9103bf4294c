//! Where handles are on the film.

use std::f64::consts::TAU;

use foton_math::glam::{DVec2, DVec3};

use super::handle::{Handle, Tool};
use super::place::Gizmo;
use crate::outline::Segment;

/// An axis this near to the line of sight (as a sine), or a plane this near to being seen edge-on, cannot be dragged well and has no
/// handle.
pub(super) const EDGE_ON: f64 = 0.25;

/// Lines of a ring.
const RING: usize = 64;

/// Where along the axes the corners of planes are, as shares of the reach.
const PLANE: (f64, f64) = (0.35, 0.6);

/// Half the size of boxes, as a share of the reach.
const BOX: f64 = 0.09;

/// A handle as it is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct HandleShape {
    /// Which one it is.
    pub handle: Handle,
    /// Its lines, in pixels of the film.
    pub lines: Vec<Segment>,
    /// The corners of what is filled, in pixels of the film.
    pub area: Vec<[f32; 2]>,
}

impl Gizmo {
    /// Whether a tool can do anything here.
    #[must_use]
    pub fn has(&self, tool: Tool) -> bool {
        match tool {
            Tool::Move => self.can_move,
            Tool::Rotate => self.can_turn,
            Tool::Scale => self.can_scale,
        }
    }

    /// A tool's handles, `reach` pixels from the middle to their ends. Later ones lie over earlier ones.
    #[must_use]
    pub fn handles(&self, tool: Tool, reach: f64) -> Vec<HandleShape> {
        if !self.has(tool) {
            return Vec::new();
        }
        let length = self.pixel() * reach;
        match tool {
            Tool::Move => {
                let arrows = (0..3).filter_map(|axis| self.arrow(axis, length));
                let planes = (0..3).filter_map(|axis| self.plane(axis, length));
                let middle = self.square(Handle::MoveView, self.film, BOX * reach);
                arrows.chain(planes).chain([middle]).collect()
            }
            Tool::Rotate => (0..3).map(|axis| self.ring(axis, length)).collect(),
            Tool::Scale => {
                let axes = (0..3).filter_map(|axis| self.stretcher(axis, length, reach));
                axes.chain([self.square(Handle::ScaleAll, self.film, BOX * reach)]).collect()
            }
        }
    }

    fn faces_sideways(&self, axis: DVec3) -> bool {
        self.sight().cross(axis).length() > EDGE_ON
    }

    fn arrow(&self, axis: u8, length: f64) -> Option<HandleShape> {
        let direction = DVec3::AXES[usize::from(axis)];
        if !self.faces_sideways(direction) {
            return None;
        }
        let (from, tip) = (self.at + direction * (0.2 * length), self.at + direction * length);
        let shaft = self.view.segment(from, tip)?;
        let [begin, end] = shaft.map(|p| DVec2::new(f64::from(p[0]), f64::from(p[1])));
        let along = (end - begin).try_normalize()?;
        let (back, side) =
            (end - along * (begin.distance(end) * 0.2), along.perp() * (begin.distance(end) * 0.08));
        let area = [end, back + side, back - side].map(|p| p.as_vec2().to_array()).to_vec();
        Some(HandleShape { handle: Handle::MoveAxis(axis), lines: vec![shaft], area })
    }

    fn plane(&self, axis: u8, length: f64) -> Option<HandleShape> {
        let [normal, u, v] = [0, 1, 2].map(|i| DVec3::AXES[(usize::from(axis) + i) % 3]);
        if self.sight().dot(normal).abs() < EDGE_ON {
            return None;
        }
        let (near, far) = PLANE;
        let corners = [(near, near), (far, near), (far, far), (near, far)];
        let corners = corners.map(|(a, b)| self.at + (u * a + v * b) * length);
        let film: Option<Vec<DVec2>> = corners.iter().map(|c| self.view.project(*c)).collect();
        let lines = (0..4).filter_map(|i| self.view.segment(corners[i], corners[(i + 1) % 4])).collect();
        let area = film?.iter().map(|p| p.as_vec2().to_array()).collect();
        Some(HandleShape { handle: Handle::MovePlane(axis), lines, area })
    }

    /// The half of a ring that faces the camera.
    fn ring(&self, axis: u8, length: f64) -> HandleShape {
        let [normal, u, v] = [0, 1, 2].map(|i| DVec3::AXES[(usize::from(axis) + i) % 3]);
        let sight = self.sight();
        let around = |i: usize| {
            let (sin, cos) = (TAU * i as f64 / RING as f64).sin_cos();
            (u * cos + v * sin) * length
        };
        let faces_camera = sight.dot(normal).abs() > 0.95;
        let is_seen = |p: DVec3| faces_camera || p.dot(sight) <= 0.02 * length;
        let pieces =
            (0..RING).map(|i| (around(i), around(i + 1))).filter(|(p, q)| is_seen(*p) && is_seen(*q));
        let lines = pieces.filter_map(|(p, q)| self.view.segment(self.at + p, self.at + q)).collect();
        HandleShape { handle: Handle::Turn(axis), lines, area: Vec::new() }
    }

    fn stretcher(&self, axis: u8, length: f64, reach: f64) -> Option<HandleShape> {
        let direction = self.own[usize::from(axis)];
        if !self.stretches[usize::from(axis)] || !self.faces_sideways(direction) {
            return None;
        }
        let shaft = self.view.segment(self.at + direction * (0.2 * length), self.at + direction * length)?;
        let end = DVec2::new(f64::from(shaft[1][0]), f64::from(shaft[1][1]));
        let square = self.square(Handle::ScaleAxis(axis), end, 0.7 * BOX * reach);
        Some(HandleShape { lines: vec![shaft], ..square })
    }

    fn square(&self, handle: Handle, at: DVec2, half: f64) -> HandleShape {
        let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        let area = corners.map(|(x, y)| (at + DVec2::new(x, y) * half).as_vec2().to_array()).to_vec();
        HandleShape { handle, lines: Vec::new(), area }
    }
}

/// The handle at a film position: of those whose filled part it is in, the last; or else the one with the nearest line, within
/// `reach` pixels.
#[must_use]
pub fn nearest(handles: &[HandleShape], film: [f64; 2], reach: f64) -> Option<Handle> {
    let at = DVec2::from(film);
    if let Some(inside) = handles.iter().rev().find(|h| is_inside(&h.area, at)) {
        return Some(inside.handle);
    }
    let distance =
        |h: &HandleShape| h.lines.iter().map(|line| distance_to(line, at)).fold(f64::INFINITY, f64::min);
    let all = handles.iter().map(|h| (distance(h), h.handle));
    let best = all.min_by(|a, b| a.0.total_cmp(&b.0))?;
    (best.0 <= reach).then_some(best.1)
}

fn point(p: [f32; 2]) -> DVec2 {
    DVec2::new(f64::from(p[0]), f64::from(p[1]))
}

fn distance_to(line: &Segment, at: DVec2) -> f64 {
    let [a, b] = line.map(point);
    let d = b - a;
    let t =
        if d.length_squared() > 0.0 { ((at - a).dot(d) / d.length_squared()).clamp(0.0, 1.0) } else { 0.0 };
    (a + d * t).distance(at)
}

/// Whether a point is inside a convex polygon, whichever way its corners go.
fn is_inside(corners: &[[f32; 2]], at: DVec2) -> bool {
    let n = corners.len();
    let side = |i: usize| {
        let (a, b) = (point(corners[i]), point(corners[(i + 1) % n]));
        (b - a).perp_dot(at - a)
    };
    n > 2 && ((0..n).all(|i| side(i) >= 0.0) || (0..n).all(|i| side(i) <= 0.0))
}
