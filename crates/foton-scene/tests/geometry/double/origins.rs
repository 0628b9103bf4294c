//! Origins of rays that leave a surface lie on its true side, and not far off it.

use foton_math::Ray;

use super::exact::{Exact, KINDS};
use super::{Worst, ulp};
use crate::{cases, direction, grazing, in_unit_cube, log_uniform, stream};

#[test]
fn origins_of_rays_lie_on_the_side_that_they_leave_to_and_within_a_few_steps() {
    for (number, kind) in KINDS.into_iter().enumerate() {
        let mut stream = stream(70 + number as u64);
        let mut offset = Worst::default();
        let mut wrong = 0;
        for _ in 0..cases(300) {
            let description = Exact::random(kind, &mut stream);
            let scene = in_unit_cube(description.clone());
            if scene.census().degenerate_triangles > 0 {
                continue;
            }
            let exact = Exact::of(&description, scene.normalisation());
            for _ in 0..500 {
                let (target, from) = (exact.target(&mut stream), direction(&mut stream));
                let origin = (target + from.as_dvec3() * log_uniform([1e-1, 1e4], &mut stream)).as_vec3();
                let aimed = (target - origin.as_dvec3()).normalize().as_vec3();
                let Some(hit) = scene.nearest(Ray::new(origin, aimed)).filter(|h| h.shape == 0) else {
                    continue;
                };
                let leaving = match (stream.next_1d() * 2.0) as u32 {
                    0 => grazing(hit.normal, log_uniform([1e-6, 1e-1], &mut stream), &mut stream),
                    _ => direction(&mut stream),
                };
                if leaving.dot(hit.normal) == 0.0 {
                    // Neither out nor in, in single precision.
                    continue;
                }
                for d in [leaving, -leaving] {
                    let start = hit.ray_origin(d);
                    let height = exact.height(start.as_dvec3());
                    let outside = d.dot(hit.normal) > 0.0;
                    wrong += u32::from(height == 0.0 || (height > 0.0) != outside);
                    let reach = hit.position.abs().max(scene.bounds().max.abs());
                    offset.add(start.as_dvec3().distance(hit.position.as_dvec3()) / ulp(reach));
                }
            }
        }
        eprintln!(
            "{kind}: {wrong} on the wrong side; offset {offset} steps of the scene's largest coordinate"
        );
        assert!(offset.count > 100_000, "{kind}: {offset}");
        assert_eq!(wrong, 0, "{kind}: of {}", offset.count);
        assert!(offset.largest < 32.0, "{kind}: {offset}");
    }
}
