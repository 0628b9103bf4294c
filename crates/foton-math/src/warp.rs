//! Warps of the unit square to the domains that light transport samples, each with its pdf.

use std::f32::consts::{FRAC_1_PI, FRAC_PI_4, PI};

use glam::{Vec2, Vec3};

/// Uniform on the unit disc, by the concentric map of Shirley and Chiu (1997): strata stay compact. `[SC97]`
#[must_use]
#[inline]
pub fn square_to_disc(u: Vec2) -> Vec2 {
    let p = u * 2.0 - 1.0;
    let along_x = p.x.abs() > p.y.abs();
    let (major, minor) = if along_x { (p.x, p.y) } else { (p.y, p.x) };
    // Any angle will do in the centre. No branch: loops over many points are compiled to work on several at once.
    let ratio = if major == 0.0 { 0.0 } else { minor / major };
    let (sin, cos) = sin_cos_eighth(FRAC_PI_4 * ratio);
    let (across, along) = (major * sin, major * cos);
    if along_x { Vec2::new(along, across) } else { Vec2::new(across, along) }
}

/// The point of the unit square that [`square_to_disc`] maps to a point of the disc.
#[must_use]
pub fn disc_to_square(d: Vec2) -> Vec2 {
    let along_x = d.x.abs() > d.y.abs();
    let (along, across) = if along_x { (d.x, d.y) } else { (d.y, d.x) };
    let major = d.length().copysign(along);
    let minor = if along == 0.0 { 0.0 } else { major * (across / along).atan() / FRAC_PI_4 };
    let p = if along_x { Vec2::new(major, minor) } else { Vec2::new(minor, major) };
    (p + 1.0) * 0.5
}

/// Sine and cosine of an angle within ±π/4, to single precision: Taylor's series up to x⁹, whose remainder is below 2⁻²⁷.
///
/// Only basic operations: the functions of a system's library may differ in the last bit from machine to machine.
#[inline]
fn sin_cos_eighth(x: f32) -> (f32, f32) {
    let x2 = x * x;
    let sin = 1.0
        - x2 * (1.0 / 6.0)
            * (1.0 - x2 * (1.0 / 20.0) * (1.0 - x2 * (1.0 / 42.0) * (1.0 - x2 * (1.0 / 72.0))));
    let cos =
        1.0 - x2 * 0.5 * (1.0 - x2 * (1.0 / 12.0) * (1.0 - x2 * (1.0 / 30.0) * (1.0 - x2 * (1.0 / 56.0))));
    (x * sin, cos)
}

/// Sine and cosine of `u` turns, `u` in [0, 1].
#[inline]
fn sin_cos_turns(u: f32) -> (f32, f32) {
    let quarter = (4.0 * u + 0.5) as u32;
    let (sin, cos) = sin_cos_eighth((u - 0.25 * quarter as f32) * (2.0 * PI));
    match quarter & 3 {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

/// The pdf of [`square_to_disc`] with respect to area.
#[must_use]
#[inline]
pub const fn square_to_disc_pdf() -> f32 {
    FRAC_1_PI
}

/// Cosine-distributed about +z, a unit vector.
#[must_use]
#[inline]
pub fn square_to_cosine_hemisphere(u: Vec2) -> Vec3 {
    let d = square_to_disc(u);
    d.extend((1.0 - d.length_squared()).max(0.0).sqrt())
}

/// The pdf of [`square_to_cosine_hemisphere`] with respect to solid angle.
#[must_use]
#[inline]
pub fn square_to_cosine_hemisphere_pdf(v: Vec3) -> f32 {
    v.z.max(0.0) * FRAC_1_PI
}

/// Uniform on the unit sphere.
#[must_use]
#[inline]
pub fn square_to_sphere(u: Vec2) -> Vec3 {
    let z = 1.0 - 2.0 * u.x;
    let r = 2.0 * (u.x * (1.0 - u.x)).max(0.0).sqrt();
    let (sin, cos) = sin_cos_turns(u.y);
    Vec3::new(r * cos, r * sin, z)
}

/// The pdf of [`square_to_sphere`] with respect to solid angle.
#[must_use]
#[inline]
pub const fn square_to_sphere_pdf() -> f32 {
    0.25 * FRAC_1_PI
}

/// Uniform in the cone of directions about +z whose half angle θ has `one_minus_cos = 1 − cos θ`.
///
/// The angle comes as 1 − cos θ because cos θ itself rounds to 1 for a small, distant emitter.
#[must_use]
#[inline]
pub fn square_to_cone(u: Vec2, one_minus_cos: f32) -> Vec3 {
    let h = u.x * one_minus_cos;
    let r = (h * (2.0 - h)).max(0.0).sqrt();
    let (sin, cos) = sin_cos_turns(u.y);
    Vec3::new(r * cos, r * sin, 1.0 - h)
}

/// The pdf of [`square_to_cone`] with respect to solid angle, inside the cone.
#[must_use]
#[inline]
pub fn square_to_cone_pdf(one_minus_cos: f32) -> f32 {
    1.0 / (2.0 * PI * one_minus_cos)
}

/// Barycentric coordinates (of the second and third vertex), uniform by area.
#[must_use]
#[inline]
pub fn square_to_triangle(u: Vec2) -> Vec2 {
    let s = u.x.sqrt();
    Vec2::new(1.0 - s, u.y * s)
}

/// The pdf of [`square_to_triangle`] with respect to the triangle's own area.
#[must_use]
#[inline]
pub fn square_to_triangle_pdf(area: f32) -> f32 {
    1.0 / area
}

#[cfg(test)]
mod tests;
