//! A camera as an editor needs it: film positions to rays and world points to film positions, in world units.
//!
//! The same camera as [`foton_scene::Sensor`], in double precision and both ways.

use foton_math::glam::{DVec2, DVec3};
use foton_scene::description::{Projection, SensorDescription};

/// A camera that projects.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct View {
    pub(crate) origin: DVec3,
    pub(crate) left: DVec3,
    pub(crate) up: DVec3,
    pub(crate) forward: DVec3,
    projection: Projection,
    /// Half the width and height of what is seen: of a perspective at depth 1, else in world units.
    half: DVec2,
    /// Where the middle of the film looks, in shares of its width and height.
    offset: DVec2,
    /// The film in pixels.
    pub(crate) film: DVec2,
    near: f64,
}

impl View {
    pub(crate) fn new(sensor: &SensorDescription) -> Self {
        let film = DVec2::new(f64::from(sensor.width), f64::from(sensor.height));
        let spanned = sensor.fov_axis.spanned(film.to_array());
        let m = sensor.to_world.matrix3;
        let half = match sensor.projection {
            Projection::Perspective => film * ((sensor.fov_degrees.to_radians() * 0.5).tan() / spanned),
            Projection::Orthographic => DVec2::new(m.x_axis.length(), m.y_axis.length() * film.y / film.x),
        };
        Self {
            origin: sensor.to_world.translation,
            left: m.x_axis.normalize_or(DVec3::X),
            up: m.y_axis.normalize_or(DVec3::Y),
            forward: m.z_axis.normalize_or(DVec3::Z),
            projection: sensor.projection,
            half,
            offset: sensor.principal_point_offset.into(),
            film,
            near: sensor.near_clip.unwrap_or(0.0),
        }
    }

    /// The line of sight of a film position: where it begins, and its unit direction.
    pub(crate) fn ray(&self, film: DVec2) -> (DVec3, DVec3) {
        let place = (film / self.film + self.offset) * 2.0 - 1.0;
        let aside = self.up * (-place.y * self.half.y) - self.left * (place.x * self.half.x);
        match self.projection {
            Projection::Perspective => (self.origin, (self.forward + aside).normalize()),
            Projection::Orthographic => (self.origin + aside, self.forward),
        }
    }

    /// The unit direction of the line of sight to a world point.
    pub(crate) fn sight(&self, world: DVec3) -> DVec3 {
        match self.projection {
            Projection::Perspective => (world - self.origin).normalize_or(self.forward),
            Projection::Orthographic => self.forward,
        }
    }

    /// Where the line of sight to a world point begins.
    pub(crate) fn eye_of(&self, world: DVec3) -> DVec3 {
        match self.projection {
            Projection::Perspective => self.origin,
            Projection::Orthographic => world - self.forward * self.depth(world),
        }
    }

    /// How far along the camera's z a world point is.
    pub(crate) fn depth(&self, world: DVec3) -> f64 {
        (world - self.origin).dot(self.forward)
    }

    /// Whether lines of sight are parallel.
    pub(crate) fn is_parallel(&self) -> bool {
        self.projection == Projection::Orthographic
    }

    /// A vector in the camera's space: to the right, up, and depth.
    fn in_camera(&self, v: DVec3) -> DVec3 {
        DVec3::new(-v.dot(self.left), v.dot(self.up), v.dot(self.forward))
    }

    fn on_film(&self, p: DVec3) -> DVec2 {
        let scale = if self.is_parallel() { 1.0 } else { p.z };
        let q = DVec2::new(p.x, -p.y) / (scale * self.half);
        ((q + 1.0) * 0.5 - self.offset) * self.film
    }

    /// Where a world point is on the film; `None` behind the camera or nearer than its near plane.
    pub(crate) fn project(&self, world: DVec3) -> Option<DVec2> {
        let p = self.in_camera(world - self.origin);
        let film = self.on_film(p);
        (p.z > self.near && film.is_finite()).then_some(film)
    }

    /// Where on the film a direction vanishes; `None` behind the camera, and among parallel lines of sight.
    pub(crate) fn project_direction(&self, direction: DVec3) -> Option<DVec2> {
        let p = self.in_camera(direction);
        let film = self.on_film(p);
        (p.z > 0.0 && !self.is_parallel() && film.is_finite()).then_some(film)
    }

    /// A line on the film: cut at the near plane, and at the edges of a film three times as wide and high.
    pub(crate) fn segment(&self, a: DVec3, b: DVec3) -> Option<[[f32; 2]; 2]> {
        let (mut a, mut b) = (self.in_camera(a - self.origin), self.in_camera(b - self.origin));
        // What lies in the camera's own plane has no place on the film.
        let near = self.near.max(1e-6 * a.length().max(b.length()));
        if !(a.z > near || b.z > near) {
            return None;
        }
        let cut = |inside: DVec3, outside: DVec3| {
            inside.lerp(outside, (inside.z - near) / (inside.z - outside.z)).truncate().extend(near)
        };
        if a.z < near {
            a = cut(b, a);
        } else if b.z < near {
            b = cut(a, b);
        }
        clipped(self.on_film(a), self.on_film(b), -self.film, self.film * 2.0)
    }

    /// World units that a pixel covers at a depth.
    pub(crate) fn pixel_at(&self, depth: f64) -> f64 {
        let scale = if self.is_parallel() { 1.0 } else { depth.abs() };
        2.0 * self.half.x * scale / self.film.x
    }
}

/// The part of a line inside a rectangle.
fn clipped(a: DVec2, b: DVec2, min: DVec2, max: DVec2) -> Option<[[f32; 2]; 2]> {
    let (mut enter, mut leave) = (0.0f64, 1.0f64);
    let d = b - a;
    for axis in 0..2 {
        for (distance, speed) in [(a[axis] - min[axis], -d[axis]), (max[axis] - a[axis], d[axis])] {
            if speed == 0.0 {
                if distance < 0.0 {
                    return None;
                }
            } else if speed > 0.0 {
                leave = leave.min(distance / speed);
            } else {
                enter = enter.max(distance / speed);
            }
        }
    }
    let ends = [a + d * enter, a + d * leave];
    (enter <= leave && ends.iter().all(|p| p.is_finite())).then(|| ends.map(|p| p.as_vec2().to_array()))
}
