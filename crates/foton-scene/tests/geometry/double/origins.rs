//! Origins of rays that leave a surface lie on its true side, and not far off it.

use foton_math::Stream;

use super::rig::{Pair, aim, each_kind};
use super::{Worst, ulp};
use crate::{direction, grazing, log_uniform};

/// How far origins are from the points that they leave, in steps of the scene's largest coordinate, and how many lie on the
/// wrong side.
#[derive(Default)]
struct Found {
    offset: Worst,
    wrong: u32,
}

#[test]
fn origins_of_rays_lie_on_the_side_that_they_leave_to_and_within_a_few_steps() {
    each_kind(70, 300, look, |kind, Found { offset, wrong }| {
        eprintln!(
            "{kind}: {wrong} on the wrong side; offset {offset} steps of the scene's largest coordinate"
        );
        assert!(offset.count > 100_000, "{kind}: {offset}");
        assert_eq!(wrong, 0, "{kind}: of {}", offset.count);
        assert!(offset.largest < 32.0, "{kind}: {offset}");
    });
}

fn look(Pair { exact, scene }: &Pair, stream: &mut Stream, found: &mut Found) {
    let (target, from) = (exact.target(stream), direction(stream));
    let Some(hit) = scene.nearest(aim(target, from, 1e4, stream)).filter(|h| h.shape == 0) else {
        return;
    };
    let leaving = match (stream.next_1d() * 2.0) as u32 {
        0 => grazing(hit.normal, log_uniform([1e-6, 1e-1], stream), stream),
        _ => direction(stream),
    };
    if leaving.dot(hit.normal) == 0.0 {
        // Neither out nor in, in single precision.
        return;
    }
    for d in [leaving, -leaving] {
        let start = hit.ray_origin(d);
        let height = exact.height(start.as_dvec3());
        let outside = d.dot(hit.normal) > 0.0;
        found.wrong += u32::from(height == 0.0 || (height > 0.0) != outside);
        let reach = hit.position.abs().max(scene.bounds().max.abs());
        found.offset.add(start.as_dvec3().distance(hit.position.as_dvec3()) / ulp(reach));
    }
}
