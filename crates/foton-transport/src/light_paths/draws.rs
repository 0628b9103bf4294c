//! The random numbers of a wave of photons, each kind in a row of its own, so that a processor makes several at once.

use foton_math::glam::{Vec2, Vec3};
use foton_math::warp;

use super::pass::{Path, WAVE};

/// Rows are filled in blocks of this length, as far as there are photons.
const AT_ONCE: usize = 16;

/// Random dimensions that each edge of a path may use, and that are reserved before the first.
const DIMENSIONS: u64 = 8;

/// The numbers of a photon at the end of its ray.
#[derive(Clone, Copy)]
pub(super) struct Draw {
    /// Chooses among lobes, where there are several.
    pub(super) lobe: f32,
    /// Chooses the direction.
    pub(super) direction: Vec2,
    /// The direction that this is on a Lambertian surface, about +z.
    pub(super) diffuse: Vec3,
    /// Chooses whether the photon goes on.
    pub(super) survival: f32,
}

/// The numbers of a wave.
pub(super) struct Draws {
    /// As in [`Draw`]: lobe, direction, survival.
    numbers: [[f32; WAVE]; 4],
    /// By axis.
    diffuse: [[f32; WAVE]; 3],
}

impl Default for Draws {
    fn default() -> Self {
        Self { numbers: [[0.0; WAVE]; 4], diffuse: [[0.0; WAVE]; 3] }
    }
}

impl Draws {
    /// Draws for the first of `paths`, [`WAVE`] at most.
    #[inline(always)]
    pub(super) fn draw(&mut self, paths: &[Path]) {
        let Self { numbers: [lobe, x, y, survival], diffuse: [dx, dy, dz] } = self;
        for (i, path) in paths.iter().enumerate().take(WAVE) {
            let mut stream = path.stream.from_dimension(u64::from(path.edges) * DIMENSIONS);
            lobe[i] = stream.next_1d();
            x[i] = stream.next_1d();
            y[i] = stream.next_1d();
            survival[i] = stream.next_1d();
        }
        for i in 0..paths.len().next_multiple_of(AT_ONCE).min(WAVE) {
            let direction = warp::square_to_cosine_hemisphere(Vec2::new(x[i], y[i]));
            (dx[i], dy[i], dz[i]) = (direction.x, direction.y, direction.z);
        }
    }

    /// The numbers of one photon of the wave.
    #[inline(always)]
    pub(super) fn of(&self, i: usize) -> Draw {
        let (i, [lobe, x, y, survival], [dx, dy, dz]) = (i % WAVE, &self.numbers, &self.diffuse);
        Draw {
            lobe: lobe[i],
            direction: Vec2::new(x[i], y[i]),
            diffuse: Vec3::new(dx[i], dy[i], dz[i]),
            survival: survival[i],
        }
    }
}
