//! From which directions indirect light comes, as the global map knows it: where gather rays go. `[JEN95]`
//!
//! The hemisphere is cut into cells such that light which comes evenly from everywhere brings the same irradiance through each. A ray's
//! cell is chosen by the power of the photons that came through it, in part by chance, so that no direction is ever left out.

use std::f32::consts::{PI, TAU};

use foton_math::glam::{Vec2, Vec3};

/// Cells between the normal and the horizon.
const RINGS: usize = 4;
/// Cells around the normal.
const SECTORS: usize = 16;
const CELLS: usize = RINGS * SECTORS;

/// Of all rays, the part that goes anywhere: the photons that tell are few.
const ANYWHERE: f32 = 0.4;

/// How much comes through each cell, in 255ths of the most.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Directions([u8; CELLS]);

/// The chances of cells.
pub(super) struct Chances {
    /// Sums up to and with each cell; the last is 1.
    cumulative: [f32; CELLS],
}

impl Directions {
    /// Bytes of it.
    pub(super) const BYTES: usize = CELLS;

    /// By the directions that light of some power comes from, local to the normal.
    pub(super) fn of(light: impl Iterator<Item = (Vec3, f32)>) -> Self {
        let mut sums = [0.0f32; CELLS];
        for (from, power) in light {
            sums[cell_of(from)] += power;
        }
        let most = sums.into_iter().fold(0.0, f32::max);
        Self(sums.map(|sum| if most > 0.0 { (255.0 * sum / most).round() as u8 } else { 0 }))
    }

    pub(super) const fn bytes(&self) -> &[u8; CELLS] {
        &self.0
    }

    pub(super) const fn from_bytes(bytes: [u8; CELLS]) -> Self {
        Self(bytes)
    }

    /// The chances of rays.
    pub(super) fn chances(&self) -> Chances {
        let all: u32 = self.0.iter().map(|&cell| u32::from(cell)).sum();
        let mut sum = 0.0;
        let cumulative = self.0.map(|cell| {
            let known = if all > 0 { f32::from(cell) / all as f32 } else { 1.0 / CELLS as f32 };
            sum += ANYWHERE / CELLS as f32 + (1.0 - ANYWHERE) * known;
            sum
        });
        Chances { cumulative }
    }
}

impl Chances {
    /// A direction about +z chosen by `u` in [0, 1) and by the place `within` its cell, with its pdf (sr⁻¹).
    pub(super) fn sample(&self, u: f32, within: Vec2) -> (Vec3, f32) {
        let cell = self.cumulative.partition_point(|&c| c <= u).min(CELLS - 1);
        let place = Vec2::new(
            ((cell / SECTORS) as f32 + within.x) / RINGS as f32,
            ((cell % SECTORS) as f32 + within.y) / SECTORS as f32,
        );
        let (sin, cos) = (TAU * place.y).sin_cos();
        let r = place.x.sqrt();
        let direction = Vec3::new(r * cos, r * sin, (1.0 - place.x).max(0.0).sqrt());
        (direction, self.chance(cell) * CELLS as f32 * direction.z / PI)
    }

    /// The pdf (sr⁻¹) of a direction in [`Chances::sample`].
    pub(super) fn pdf(&self, direction: Vec3) -> f32 {
        if direction.z <= 0.0 {
            0.0
        } else {
            self.chance(cell_of(direction)) * CELLS as f32 * direction.z / PI
        }
    }

    fn chance(&self, cell: usize) -> f32 {
        self.cumulative[cell] - cell.checked_sub(1).map_or(0.0, |before| self.cumulative[before])
    }
}

/// The cell of a direction; below the horizon, the last but one ring's end.
fn cell_of(direction: Vec3) -> usize {
    let ring = (direction.x * direction.x + direction.y * direction.y).min(1.0) * RINGS as f32;
    let turn = direction.y.atan2(direction.x) / TAU;
    let sector = (turn - turn.floor()) * SECTORS as f32;
    (ring as usize).min(RINGS - 1) * SECTORS + (sector as usize).min(SECTORS - 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use foton_math::{Purpose, Stream, warp};

    #[test]
    fn rays_go_where_light_comes_from_with_the_pdf_that_they_say() {
        let mut stream = Stream::new(1, Purpose::Test, 0, 0);
        let from = Vec3::new(0.6, 0.3, 0.74).normalize();
        let known = Directions::of((0..50).map(|_| (from, 1.0))).chances();
        let even = Directions::of(std::iter::empty()).chances();
        for (chances, least) in [(&known, 0.5), (&even, 0.0)] {
            let (mut near, mut whole, n) = (0, 0.0, 40_000);
            for i in 0..n {
                let u = (i as f32 + stream.next_1d()) / n as f32;
                let (direction, pdf) = chances.sample(u, stream.next_2d());
                assert!((chances.pdf(direction) / pdf - 1.0).abs() < 1e-3 || direction.z < 1e-3);
                near += u32::from(direction.dot(from) > 0.8);
                // ∫ cos θ over the hemisphere is π.
                whole += f64::from(direction.z / pdf.max(1e-9)) / f64::from(n);
            }
            assert!((whole / std::f64::consts::PI - 1.0).abs() < 0.03, "{whole}");
            assert!(f64::from(near) / f64::from(n) > least, "{near}");
        }
        let mean: f64 = (0..20_000)
            .map(|_| f64::from(known.pdf(warp::square_to_sphere(stream.next_2d()))) / 20_000.0)
            .sum();
        assert!(
            (mean * 4.0 * std::f64::consts::PI - 1.0).abs() < 0.05,
            "the pdf is one of the hemisphere: {mean}"
        );
    }
}
