//! Dragging: two film positions to a move in the world.
//!
//! A drag stays in a plane through the point that was picked. Where that plane is seen edge-on, and a pixel would mean
//! metres, the plane that faces the camera takes its place. Beyond a plane's horizon things stay at a bounded distance.

use foton_math::glam::{DVec2, DVec3};
use foton_scene::description::SensorDescription;

use super::camera::UpAxis;
use super::view::View;

/// Sine of the angle between a line of sight and the plane below which the plane counts as seen edge-on: 6 degrees.
const EDGE_ON: f64 = 0.1;
/// How far a drag may take a thing, in distances from the camera to where it was.
const FARTHEST: f64 = 30.0;

/// In which plane a drag moves things.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DragMode {
    /// On the floor: across the up axis.
    #[default]
    Horizontal,
    /// Up and down alone.
    Vertical,
}

/// A drag under way.
#[derive(Clone, Copy, Debug)]
pub struct DragPlane {
    view: View,
    picked: DVec3,
    normal: DVec3,
    /// The only direction in which things move, if there is only one.
    along: Option<Along>,
    farthest: f64,
}

#[derive(Clone, Copy, Debug)]
enum Along {
    /// By the plane's points.
    Plane(DVec3),
    /// So much for each pixel towards the image's top: the axis points at the camera or away from it.
    Pixels(DVec3),
}

impl DragPlane {
    /// A drag of what was picked at a world position.
    #[must_use]
    pub fn new(sensor: &SensorDescription, up: UpAxis, picked: [f64; 3], mode: DragMode) -> Self {
        let view = View::new(sensor);
        let picked = DVec3::from(picked);
        let away = picked - view.origin;
        let sight = away.normalize_or(view.forward);
        let up = up.vector();
        let (normal, along) = match mode {
            DragMode::Horizontal if sight.dot(up).abs() >= EDGE_ON => (up, None),
            DragMode::Horizontal => (view.forward, None),
            DragMode::Vertical => {
                // The plane that holds the axis and faces the camera as well as it can.
                let across = sight - up * sight.dot(up);
                if across.length() >= EDGE_ON {
                    (across.normalize(), Some(Along::Plane(up)))
                } else {
                    let pixel = view.pixel_at(away.dot(view.forward));
                    (view.forward, Some(Along::Pixels(up * pixel)))
                }
            }
        };
        let farthest = FARTHEST * away.length();
        Self { view, picked, normal, along, farthest }
    }

    /// The move, in world units, that takes a thing from under one film position to under the other. Always finite.
    #[must_use]
    pub fn translation(&self, from: [f64; 2], to: [f64; 2]) -> [f64; 3] {
        let (from, to) = (DVec2::from(from), DVec2::from(to));
        let by = match self.along {
            None => self.point(to) - self.point(from),
            Some(Along::Plane(axis)) => axis * (self.point(to) - self.point(from)).dot(axis),
            Some(Along::Pixels(axis)) => axis * (from.y - to.y),
        };
        if by.is_finite() { by.to_array() } else { [0.0; 3] }
    }

    /// The point of the plane under a film position; beyond the horizon the one below a point far along the line of sight.
    fn point(&self, film: DVec2) -> DVec3 {
        let direction = self.view.direction(film);
        let height = (self.picked - self.view.origin).dot(self.normal);
        let t = height / direction.dot(self.normal);
        let t = if t > 0.0 && t < self.farthest { t } else { self.farthest };
        let p = self.view.origin + direction * t;
        p - self.normal * (p - self.picked).dot(self.normal)
    }
}
