//! Random shapes, each in a scene of its own with its reference beside it, and rays aimed at them.

use foton_math::glam::{DVec3, Vec3};
use foton_math::{Ray, Stream};
use foton_scene::Scene;

use super::exact::{Exact, KINDS};
use crate::{cases, in_unit_cube, log_uniform, stream};

/// Rays for each shape.
const RAYS: u32 = 500;

/// A shape twice: single precision in the scene, double beside it.
pub(super) struct Pair {
    pub(super) scene: Scene,
    pub(super) exact: Exact,
}

/// Looks at `shapes` random shapes of each kind, and a multiple where [`cases`] says so, through [`RAYS`] rays each; then tells
/// what was found of the kind.
pub(super) fn each_kind<Found: Default>(
    test: u64,
    shapes: u32,
    mut look: impl FnMut(&Pair, &mut Stream, &mut Found),
    mut tell: impl FnMut(&str, Found),
) {
    for (number, kind) in KINDS.into_iter().enumerate() {
        let mut stream = stream(test + number as u64);
        let mut found = Found::default();
        for _ in 0..cases(shapes) {
            let description = Exact::random(kind, &mut stream);
            let scene = in_unit_cube(description.clone());
            if scene.census().degenerate_triangles > 0 {
                continue;
            }
            let pair = Pair { exact: Exact::of(&description, scene.normalisation()), scene };
            for _ in 0..RAYS {
                look(&pair, &mut stream, &mut found);
            }
        }
        tell(kind, found);
    }
}

/// A ray to a point from `from` as seen there, from near by to a thousand scenes away.
pub(super) fn aim(target: DVec3, from: Vec3, farthest: f64, stream: &mut Stream) -> Ray {
    let origin = (target + from.as_dvec3() * log_uniform([1e-1, farthest], stream)).as_vec3();
    Ray::new(origin, (target - origin.as_dvec3()).normalize().as_vec3())
}
