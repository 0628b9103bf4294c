//! Where rays meet shapes.

use foton_math::glam::DVec3;
use foton_math::{Ray, Stream};

use super::exact::{Crossing, Exact};
use super::rig::{Pair, aim, each_kind};
use super::{Worst, ulp};
use crate::{direction, grazing, log_uniform};

/// Nearer to an outline than this, over the shape's size, single precision may decide either way: some ten steps between
/// coordinates of the scene, for the smallest shapes of these tests.
const UNCLEAR: f64 = 1e-6;

/// A ray that begins nearer to the surface than this many steps between its own coordinates may begin on either side.
const UNCLEAR_SIDE: f64 = 4.0;

/// Largest differences of one kind of shape.
#[derive(Default)]
struct Found {
    /// Distance between the points, in steps of the largest coordinate, where rays come in steeply.
    steep: Worst,
    /// The same over the cosine, where they graze.
    grazing: Worst,
    /// Height of the point over the exact surface, in steps.
    height: Worst,
    unclear: u64,
    misses: u64,
}

#[test]
fn points_where_rays_meet_shapes_are_those_of_double_precision() {
    let look = |pair: &Pair, stream: &mut Stream, found: &mut Found| {
        let exact = &pair.exact;
        let target = exact.beside(exact.target(stream), stream);
        // From anywhere, and from nearly along the surface.
        let from = match (stream.next_1d() * 3.0) as u32 {
            0 => grazing(exact.normal(target).as_vec3(), log_uniform([1e-5, 0.1], stream), stream),
            _ => direction(stream),
        };
        compare(pair, aim(target, from, 1e5, stream), found);
    };
    each_kind(60, 400, look, |kind, found: Found| {
        eprintln!(
            "{kind}: point {} steep steps, {} steps × cosine; height {} steps; {} misses, {} unclear",
            found.steep, found.grazing, found.height, found.misses, found.unclear
        );
        assert!(found.steep.count > 10_000 && found.grazing.count > 10_000 && found.misses > 1000, "{kind}");
        // Points of a slender triangle are moved off its edges by as many as 128 such steps, on purpose.
        let bound = if kind == "triangle" { 256.0 } else { 40.0 };
        assert!(found.steep.largest < bound, "{kind}: {}", found.steep);
        assert!(found.grazing.largest < bound, "{kind}: {}", found.grazing);
        assert!(found.height.largest < 8.0, "{kind}: {}", found.height);
        assert!(found.unclear < 2 * (found.steep.count + found.grazing.count), "{kind}: {}", found.unclear);
    });
}

fn compare(Pair { exact, scene }: &Pair, ray: Ray, found: &mut Found) {
    let (origin, d) = (ray.origin.as_dvec3(), ray.direction.as_dvec3().normalize());
    if exact.height(origin).abs() < UNCLEAR_SIDE * ulp(ray.origin) {
        found.unclear += 1;
        return;
    }
    let crossings = exact.crossings(origin, d);
    // A step at the origin moves the line by as much.
    let size = match *exact {
        Exact::Triangle([a, b, c]) => a.distance(b).max(b.distance(c)).max(c.distance(a)),
        Exact::Sphere { radius, .. } | Exact::Disc { radius, .. } | Exact::Cylinder { radius, .. } => radius,
    };
    let reach = crossings.first().map_or(0.0, |c| c.t);
    // Seen edge-on, an outline moves by the step over the cosine.
    let unclear = |c: &Crossing| {
        (UNCLEAR + 16.0 * f64::from(f32::EPSILON) * (reach + 2048.0) / size) / c.cosine.max(1e-9)
    };
    let first = crossings.iter().find(|c| c.margin > -unclear(c));
    let hit = scene.nearest(ray);
    if hit.is_some_and(|h| h.shape != 0) {
        return;
    }
    let Some(first) = first else {
        assert!(hit.is_none(), "{exact:?}: {ray:?} meets nothing, not {hit:?}");
        found.misses += 1;
        return;
    };
    if first.margin < unclear(first) || first.cosine < 1e-6 {
        found.unclear += 1;
        return;
    }
    let hit = hit.unwrap_or_else(|| panic!("{exact:?}: {ray:?} meets it at {first:?}"));
    let point: DVec3 = origin + d * first.t;
    let steps = hit.position.as_dvec3().distance(point) / ulp(hit.position.abs().max(ray.origin.abs()));
    if first.cosine > 0.5 {
        found.steep.add(steps);
    } else {
        found.grazing.add(steps * first.cosine);
    }
    found.height.add(exact.height(hit.position.as_dvec3()).abs() / ulp(hit.position.abs() + size as f32));
}
