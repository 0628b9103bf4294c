//! A camera as an editor needs it: film positions to rays and world points to film positions, in world units.
//!
//! The same camera as [`foton_scene::Sensor`], in double precision and both ways.

use foton_math::glam::{DVec2, DVec3};
use foton_scene::description::{FovAxis, SensorDescription};

/// A camera that projects.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct View {
    pub(crate) origin: DVec3,
    pub(crate) left: DVec3,
    pub(crate) up: DVec3,
    pub(crate) forward: DVec3,
    /// Tangents of half the horizontal and half the vertical field of view.
    half: DVec2,
    /// The film in pixels.
    pub(crate) film: DVec2,
    near: f64,
}

impl View {
    pub(crate) fn new(sensor: &SensorDescription) -> Self {
        let film = DVec2::new(f64::from(sensor.width), f64::from(sensor.height));
        let spanned = match sensor.fov_axis {
            FovAxis::X => film.x,
            FovAxis::Y => film.y,
            FovAxis::Diagonal => film.length(),
            FovAxis::Smaller => film.min_element(),
            FovAxis::Larger => film.max_element(),
        };
        let m = sensor.to_world.matrix3;
        Self {
            origin: sensor.to_world.translation,
            left: m.x_axis.normalize_or(DVec3::X),
            up: m.y_axis.normalize_or(DVec3::Y),
            forward: m.z_axis.normalize_or(DVec3::Z),
            half: film * ((sensor.fov_degrees.to_radians() * 0.5).tan() / spanned),
            film,
            near: sensor.near_clip.unwrap_or(0.0),
        }
    }

    /// The unit direction in which a film position looks.
    pub(crate) fn direction(&self, film: DVec2) -> DVec3 {
        let (x, y) = (2.0 * film.x / self.film.x - 1.0, 1.0 - 2.0 * film.y / self.film.y);
        (self.forward - self.left * (x * self.half.x) + self.up * (y * self.half.y)).normalize()
    }

    /// A vector in the camera's space: to the right, up, and depth.
    fn in_camera(&self, v: DVec3) -> DVec3 {
        DVec3::new(-v.dot(self.left), v.dot(self.up), v.dot(self.forward))
    }

    fn on_film(&self, p: DVec3) -> DVec2 {
        let q = DVec2::new(p.x, -p.y) / (p.z * self.half);
        (q + 1.0) * 0.5 * self.film
    }

    /// Where a world point is on the film; `None` behind the camera or nearer than its near plane.
    pub(crate) fn project(&self, world: DVec3) -> Option<DVec2> {
        let p = self.in_camera(world - self.origin);
        let film = self.on_film(p);
        (p.z > self.near && film.is_finite()).then_some(film)
    }

    /// Where on the film a direction vanishes.
    pub(crate) fn project_direction(&self, direction: DVec3) -> Option<DVec2> {
        let p = self.in_camera(direction);
        let film = self.on_film(p);
        (p.z > 0.0 && film.is_finite()).then_some(film)
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
        2.0 * self.half.x * depth.abs() / self.film.x
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
