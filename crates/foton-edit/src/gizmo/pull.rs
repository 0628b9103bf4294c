//! A drag of a handle: two film positions to an edit.
//!
//! However the camera looks, what is moved goes at most [`MOST`] times as far as the pointer does at its distance: near a horizon, a
//! pixel would mean metres.

use foton_math::glam::{DVec2, DVec3};

use super::handle::Handle;
use super::layout::EDGE_ON;
use super::place::Gizmo;
use super::snap;
use crate::apply::Edit;
use crate::target::Target;

/// How far a thing goes at most, as a multiple of what the pointer's way means at its distance.
const MOST: f64 = 4.0;

/// Factors of one drag.
const FACTORS: (f64, f64) = (0.01, 100.0);

/// A drag of a handle under way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pull {
    gizmo: Gizmo,
    handle: Handle,
    from: DVec2,
    /// From the middle of the gizmo to the ends of its handles, in pixels.
    reach: f64,
}

impl Pull {
    /// Takes hold of a handle at a film position; handles reach so many pixels from the middle.
    #[must_use]
    pub fn new(gizmo: Gizmo, handle: Handle, from: [f64; 2], reach: f64) -> Self {
        let reach = if reach.is_finite() && reach > 0.0 { reach } else { 100.0 };
        Self { gizmo, handle, from: from.into(), reach }
    }

    /// What dragging it to a film position does to a thing, compared with how it was; with `snap` in round steps.
    #[must_use]
    pub fn edit(&self, target: Target, to: [f64; 2], snap: bool) -> Edit {
        let to = if DVec2::from(to).is_finite() { to.into() } else { self.from };
        match self.handle {
            Handle::MoveAxis(_) | Handle::MovePlane(_) | Handle::MoveView => {
                Edit::Move { target, by: self.translation(to, snap).to_array() }
            }
            Handle::Turn(axis) => {
                let axis = DVec3::AXES[usize::from(axis.min(2))];
                Edit::Turn { target, axis: axis.to_array(), radians: self.angle(axis, to, snap) }
            }
            Handle::ScaleAxis(axis) => {
                let mut factors = [1.0; 3];
                factors[usize::from(axis.min(2))] = self.factor_along(usize::from(axis.min(2)), to, snap);
                Edit::Scale { target, factors }
            }
            Handle::ScaleAll => Edit::Scale { target, factors: [self.factor(to, snap); 3] },
        }
    }

    fn translation(&self, to: DVec2, snap: bool) -> DVec3 {
        let by = match self.handle {
            Handle::MoveAxis(axis) => self.along(DVec3::AXES[usize::from(axis.min(2))], to),
            Handle::MovePlane(axis) => self.across(DVec3::AXES[usize::from(axis.min(2))], to),
            _ => self.across(self.gizmo.view.forward, to),
        };
        let most = MOST * self.gizmo.pixel() * self.from.distance(to);
        let by = if by.is_finite() { by.clamp_length_max(most) } else { DVec3::ZERO };
        if snap { self.snapped(by) } else { by }
    }

    /// A move after which the middle has round coordinates, where it moves at all.
    fn snapped(&self, by: DVec3) -> DVec3 {
        let step = snap::step(self.gizmo.pixel());
        let mut snapped = DVec3::ZERO;
        for axis in 0..3 {
            let moves = match self.handle {
                Handle::MoveAxis(own) => usize::from(own) == axis,
                Handle::MovePlane(normal) => usize::from(normal) != axis,
                _ => true,
            };
            if moves {
                let was = self.gizmo.centre[axis];
                snapped[axis] = snap::nearest(was + by[axis], step) - was;
            }
        }
        snapped
    }

    /// A move in the plane with that normal.
    fn across(&self, normal: DVec3, to: DVec2) -> DVec3 {
        match (self.on_plane(normal, self.from), self.on_plane(normal, to)) {
            (Some(from), Some(to)) => to - from,
            // Beyond the horizon: as the image's own plane has it, put onto this one.
            _ => {
                let by = self.in_view(to);
                by - normal * by.dot(normal)
            }
        }
    }

    /// A move along an axis, in the plane that holds it and faces the camera as well as it can.
    fn along(&self, axis: DVec3, to: DVec2) -> DVec3 {
        let sight = self.gizmo.sight();
        let normal = (sight - axis * sight.dot(axis)).normalize_or(self.gizmo.view.forward);
        let by = match (self.on_plane(normal, self.from), self.on_plane(normal, to)) {
            (Some(from), Some(to)) => to - from,
            _ => self.in_view(to),
        };
        axis * by.dot(axis)
    }

    /// A move in the image's plane.
    fn in_view(&self, to: DVec2) -> DVec3 {
        let forward = self.gizmo.view.forward;
        match (self.on_plane(forward, self.from), self.on_plane(forward, to)) {
            (Some(from), Some(to)) => to - from,
            _ => DVec3::ZERO,
        }
    }

    /// Where the plane through the gizmo is seen; `None` where it is not.
    fn on_plane(&self, normal: DVec3, film: DVec2) -> Option<DVec3> {
        let view = &self.gizmo.view;
        let (eye, direction) = view.ray(film);
        let t = (self.gizmo.at - eye).dot(normal) / direction.dot(normal);
        (t.is_finite() && t > 0.0).then(|| eye + direction * t)
    }

    fn angle(&self, axis: DVec3, to: DVec2, snap: bool) -> f64 {
        let sight = self.gizmo.sight();
        let arms = [self.from, to].map(|film| Some(self.on_plane(axis, film)? - self.gizmo.at));
        let angle = match arms {
            [Some(a), Some(b)] if sight.dot(axis).abs() > EDGE_ON => axis.dot(a.cross(b)).atan2(a.dot(b)),
            // A ring that is seen edge-on is pulled along: its near side goes with the pointer.
            _ => {
                let near = -(sight - axis * sight.dot(axis)).normalize_or_zero();
                let way = axis.cross(near) * self.gizmo.pixel();
                let (a, b) =
                    (self.gizmo.view.project(self.gizmo.at), self.gizmo.view.project(self.gizmo.at + way));
                let direction = a.zip(b).map_or(DVec2::ZERO, |(a, b)| (b - a).normalize_or_zero());
                (to - self.from).dot(direction) / self.reach
            }
        };
        let angle = if angle.is_finite() { angle } else { 0.0 };
        if snap { snap::nearest(angle.to_degrees(), snap::DEGREES).to_radians() } else { angle }
    }

    fn factor_along(&self, axis: usize, to: DVec2, snap: bool) -> f64 {
        let gizmo = &self.gizmo;
        let end = gizmo.view.project(gizmo.at + gizmo.own[axis] * (gizmo.pixel() * self.reach));
        let direction = end.map_or(DVec2::X, |end| (end - gizmo.film).normalize_or(DVec2::X));
        let was = (self.from - gizmo.film).dot(direction).max(0.1 * self.reach);
        bounded(1.0 + (to - self.from).dot(direction) / was, snap)
    }

    /// Twice as large for each reach to the right or up.
    fn factor(&self, to: DVec2, snap: bool) -> f64 {
        let way = to - self.from;
        bounded(((way.x - way.y) / self.reach).exp2(), snap)
    }

    /// How far the drag is, for people: `+0.25`, `15°`, `× 1.2`.
    #[must_use]
    pub fn words(&self, to: [f64; 2], snap: bool) -> String {
        let axis = self.handle.axis().map_or("", |axis| ["X", "Y", "Z"][usize::from(axis.min(2))]);
        match (self.handle, self.edit(Target::Shape(0), to, snap)) {
            (Handle::MoveAxis(axis_of), Edit::Move { by, .. }) => {
                format!("{axis} {}", signed(by[usize::from(axis_of.min(2))]))
            }
            (_, Edit::Move { by, .. }) => {
                let [x, y, z] = by.map(signed);
                format!("X {x}  Y {y}  Z {z}")
            }
            (_, Edit::Turn { radians, .. }) => format!("{axis} {:+.1}°", radians.to_degrees()),
            (_, Edit::Scale { factors, .. }) => {
                let changed = factors.into_iter().find(|f| *f != 1.0).unwrap_or(1.0);
                format!("{axis} × {changed:.3}").trim_start().to_owned()
            }
            _ => String::new(),
        }
    }
}

fn bounded(factor: f64, snap: bool) -> f64 {
    let factor = if factor.is_finite() { factor } else { 1.0 };
    let factor = if snap { snap::nearest(factor, snap::FACTOR).max(snap::FACTOR) } else { factor };
    factor.clamp(FACTORS.0, FACTORS.1)
}

/// A length with its sign in four digits or so.
fn signed(x: f64) -> String {
    let decimals = if x == 0.0 { 2 } else { (3 - x.abs().log10().floor() as i32).clamp(0, 6) };
    format!("{x:+.*}", decimals as usize)
}
