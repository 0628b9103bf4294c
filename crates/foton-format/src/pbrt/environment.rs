//! Pictures of the light from all around: latitudes and longitudes of version 3, squares of equal area of version 4.
//!
//! In both the z axis of the light's space is up. A description's map has y up and runs the other way around, so that a picture of
//! version 3 is mirrored, unless the light's transform mirrors it already. Version 4 folds the sphere into a square, each part of it as
//! large as its solid angle `[CLA08]`; that becomes latitudes here.

use std::f64::consts::{FRAC_2_PI, PI, TAU};
use std::sync::Arc;

use foton_math::Rgb;
use foton_math::glam::{DAffine3, DMat3, DVec2, DVec3};
use foton_scene::description::{Bitmap, EmitterKind};

use super::reader::Reader;
use crate::diagnostic::Place;
use crate::mitsuba::read::properties::Located;
use crate::mitsuba::read::transform::even_scale;

/// The light's axes for those of a map that is not mirrored: x becomes y, y becomes z, z becomes −x.
const UNMIRRORED: DMat3 = DMat3::from_cols(DVec3::Y, DVec3::Z, DVec3::NEG_X);
/// The same for a mirrored map.
const MIRRORED: DMat3 = DMat3::from_cols(DVec3::NEG_Y, DVec3::Z, DVec3::NEG_X);
/// Lookups along each side of a pixel, where a square becomes latitudes.
const SAMPLES: u32 = 3;

impl Reader<'_> {
    /// A map of latitudes, the first row towards +z, and the first column towards +x.
    pub(super) fn latitudes(
        &mut self,
        filename: &Located<String>,
        factor: Rgb,
        place: Place,
    ) -> Option<EmitterKind> {
        let bitmap = self.light_map(filename, factor)?;
        let (to_world, mirrored) = self.light_axes(place)?;
        let bitmap = if mirrored {
            if !self.take(size_of_val(&bitmap.pixels[..]) as u64, place) {
                return None;
            }
            let rows = bitmap.pixels.chunks_exact(bitmap.width as usize);
            let pixels = rows.flat_map(|row| row.iter().rev().copied()).collect();
            Arc::new(Bitmap::new(bitmap.width, bitmap.height, pixels))
        } else {
            bitmap
        };
        Some(EmitterKind::Environment { to_world, bitmap, scale: 1.0 })
    }

    /// A square map of equal areas.
    pub(super) fn square(
        &mut self,
        filename: &Located<String>,
        factor: Rgb,
        place: Place,
    ) -> Option<EmitterKind> {
        let map = self.light_map(filename, factor)?;
        self.check_square(&map, filename)?;
        let (to_world, mirrored) = self.light_axes(place)?;
        let axes = if mirrored { MIRRORED } else { UNMIRRORED };
        // Where columns and rows of a description's map lie.
        let direction = |u: f64, theta: f64| {
            let (sin, cos) = theta.sin_cos();
            axes * DVec3::new(sin * (TAU * u).sin(), cos, -sin * (TAU * u).cos())
        };
        let bitmap = self.latitudes_of(&map, direction, place)?;
        Some(EmitterKind::Environment { to_world, bitmap, scale: 1.0 })
    }

    /// The lamp whose light goes by a picture: latitudes about the light's y axis, or a square.
    pub(super) fn measured_lamp(
        &mut self,
        filename: &Located<String>,
        factor: Rgb,
        place: Place,
    ) -> Option<EmitterKind> {
        let map = self.light_map(filename, factor)?;
        let to_world = self.rigid(place)?;
        if self.is_old() {
            // y is up, and columns go from +x towards +z.
            let axes = DAffine3::from_mat3(DMat3::from_cols(DVec3::X, DVec3::Z, DVec3::Y));
            return Some(EmitterKind::Goniometric { to_world: to_world * axes, bitmap: map, scale: 1.0 });
        }
        self.check_square(&map, filename)?;
        let direction = |u: f64, theta: f64| {
            let (sin, cos) = theta.sin_cos();
            DVec3::new(sin * (TAU * u).cos(), sin * (TAU * u).sin(), cos)
        };
        let bitmap = self.latitudes_of(&map, direction, place)?;
        Some(EmitterKind::Goniometric { to_world, bitmap, scale: 1.0 })
    }

    /// The transform of what comes next, if it does not stretch.
    pub(super) fn rigid(&mut self, place: Place) -> Option<DAffine3> {
        let to_world = self.place();
        if even_scale(to_world.matrix3, 1e-3).is_some() {
            return Some(to_world);
        }
        self.report.error(place, "the transform of a light with a picture must not stretch or shear");
        None
    }

    /// An error where a picture is no square.
    fn check_square(&mut self, map: &Bitmap, filename: &Located<String>) -> Option<()> {
        if map.width == map.height {
            return Some(());
        }
        let message = format!(
            "the picture of this light has {} × {} pixels: it must be a square of equal areas, which pbrt's `imgtool makeequiarea` makes of latitudes",
            map.width, map.height
        );
        self.report.error(filename.place, message);
        None
    }

    /// Latitudes of a square: the direction of a column, from 0 to 1, and an angle from the pole is given.
    fn latitudes_of(
        &mut self,
        map: &Bitmap,
        direction: impl Fn(f64, f64) -> DVec3,
        place: Place,
    ) -> Option<Arc<Bitmap>> {
        let (width, height) = (2 * map.width, map.height + 1);
        if !self.take(u64::from(width) * u64::from(height) * size_of::<Rgb>() as u64, place) {
            return None;
        }
        let mut pixels = Vec::with_capacity(width as usize * height as usize);
        for y in 0..height {
            if self.files.cancel().is_requested() {
                return None;
            }
            pixels.extend((0..width).map(|x| mean(map, &direction, [x, y], [width, height])));
        }
        Some(Arc::new(Bitmap::new(width, height, pixels)))
    }

    /// The transform of a map of this light, and whether it must be mirrored.
    fn light_axes(&mut self, place: Place) -> Option<(DAffine3, bool)> {
        let m = self.place().matrix3;
        if even_scale(m, 1e-3).is_none() {
            self.report.error(place, "the transform of a light from all around must not stretch or shear");
            return None;
        }
        let mirrored = m.determinant() > 0.0;
        let axes = m * if mirrored { MIRRORED } else { UNMIRRORED };
        Some((DAffine3::from_mat3(axes), mirrored))
    }
}

/// What a pixel of a map of latitudes has of a square: the mean over it.
fn mean(
    map: &Bitmap,
    direction: &impl Fn(f64, f64) -> DVec3,
    [x, y]: [u32; 2],
    [width, height]: [u32; 2],
) -> Rgb {
    let mut sum = Rgb::BLACK;
    for i in 0..SAMPLES * SAMPLES {
        let within = |k: u32| (f64::from(k) + 0.5) / f64::from(SAMPLES);
        // Columns stand for the middles of their pixels, rows for latitudes from pole to pole.
        let u = (f64::from(x) + within(i % SAMPLES)) / f64::from(width);
        let theta = (f64::from(y) + within(i / SAMPLES) - 0.5) / f64::from(height - 1) * PI;
        sum += lookup(map, to_square(direction(u, theta.clamp(0.0, PI))));
    }
    sum / (SAMPLES * SAMPLES) as f32
}

/// Where a direction lies on the square, from 0 to 1.
fn to_square(direction: DVec3) -> DVec2 {
    let DVec3 { x, y, z } = direction.abs();
    let r = (1.0 - z).max(0.0).sqrt();
    let phi = y.atan2(x) * FRAC_2_PI;
    let (u, v) = (r - phi * r, phi * r);
    let (u, v) = if direction.z < 0.0 { (1.0 - v, 1.0 - u) } else { (u, v) };
    0.5 * DVec2::new(u.copysign(direction.x) + 1.0, v.copysign(direction.y) + 1.0)
}

/// The map at a place, interpolated; its edges are folded onto themselves.
fn lookup(map: &Bitmap, st: DVec2) -> Rgb {
    let side = i64::from(map.width);
    let p = st * f64::from(map.width) - 0.5;
    let (low, f) = (p.floor(), (p - p.floor()).as_vec2());
    let at = |dx: i64, dy: i64| {
        let (mut x, mut y) = (low.x as i64 + dx, low.y as i64 + dy);
        let folded = |i: i64| if i < 0 { -1 - i } else { 2 * side - 1 - i };
        if x < 0 || x >= side {
            (x, y) = (folded(x), side - 1 - y);
        }
        if y < 0 || y >= side {
            (x, y) = (side - 1 - x, folded(y));
        }
        map.pixels[(y.clamp(0, side - 1) * side + x.clamp(0, side - 1)) as usize]
    };
    let row = |dy: i64| at(0, dy) * (1.0 - f.x) + at(1, dy) * f.x;
    row(0) * (1.0 - f.y) + row(1) * f.y
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_lie_where_they_do_in_the_square() {
        for (direction, st) in [
            (DVec3::Z, [0.5, 0.5]),
            (DVec3::X, [1.0, 0.5]),
            (DVec3::Y, [0.5, 1.0]),
            (DVec3::NEG_X, [0.0, 0.5]),
            (DVec3::new(-1e-9, -1e-9, -1.0), [0.0, 0.0]),
        ] {
            let found = to_square(direction.normalize());
            assert!((found - DVec2::from_array(st)).length() < 1e-4, "{direction}: {found}");
        }
    }

    #[test]
    fn parts_of_the_square_are_as_large_as_their_solid_angle() {
        // Points spread evenly over the sphere fall evenly into the square.
        let mut counts = [0u32; 16];
        let n = 40_000;
        for i in 0..n {
            let z = 1.0 - 2.0 * (f64::from(i) + 0.5) / f64::from(n);
            let phi = TAU * (f64::from(i) * 0.618_033_988_75).fract();
            let r = (1.0 - z * z).sqrt();
            let st = to_square(DVec3::new(r * phi.cos(), r * phi.sin(), z));
            let cell = |c: f64| ((c * 4.0) as usize).min(3);
            counts[cell(st.y) * 4 + cell(st.x)] += 1;
        }
        assert!(counts.iter().all(|c| c.abs_diff(n / 16) < 30), "{counts:?}");
    }
}
