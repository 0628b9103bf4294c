//! Discs where single precision would not do: seen edge-on, and from nearer than the step between coordinates.
//!
//! Not here: what holds for all shapes, which is in `hits`. There a difference counts over the cosine, and origins next to the
//! surface are left out, so that discs met in single precision would pass too.

use foton_math::glam::DVec3;
use foton_math::{Ray, Stream};
use foton_scene::Scene;

use super::exact::Exact;
use super::{Worst, ulp};
use crate::{cases, grazing, in_unit_cube, log_uniform, stream};

/// Nearer to the rim than this, over the radius, the box around the disc may decide.
const UNCLEAR: f64 = 1e-5;

/// Looks at random discs, each with its reference, many times over.
fn each_disc(test: u64, mut look: impl FnMut(&Scene, &Exact, &mut Stream)) {
    let mut stream = stream(test);
    for _ in 0..cases(60) {
        let description = Exact::random("disc", &mut stream);
        let scene = in_unit_cube(description.clone());
        let exact = Exact::of(&description, scene.normalisation());
        for _ in 0..400 {
            look(&scene, &exact, &mut stream);
        }
    }
}

/// A direction with a cosine of either sign down to a hundred-thousandth.
fn nearly_along(normal: DVec3, stream: &mut Stream) -> DVec3 {
    let side = if stream.next_1d() < 0.5 { 1.0 } else { -1.0 };
    grazing(normal.as_vec3(), side * log_uniform([1e-5, 0.5], stream), stream).as_dvec3()
}

/// A sheet that lies on another, and a ray that starts between them: the disc must be met from its near side, however near,
/// and never by a ray that goes away from it.
#[test]
fn a_disc_is_met_from_a_step_away_by_the_rays_that_come_to_it_and_by_no_others() {
    let (mut met, mut missed) = (0, 0);
    each_disc(84, |scene, exact, stream| {
        let target = exact.target(stream);
        let height = 4.0 * ulp(target.as_vec3()) * (2.0 * f64::from(stream.next_1d()) - 1.0);
        let origin = (target + exact.normal(target) * height).as_vec3();
        let ray = Ray::new(origin, nearly_along(exact.normal(target), stream).as_vec3());
        let crossing = exact.crossings(origin.as_dvec3(), ray.direction.as_dvec3()).first().copied();
        if crossing.is_some_and(|c| c.margin.abs() < UNCLEAR) || exact.height(origin.as_dvec3()) == 0.0 {
            return;
        }
        let hit = scene.nearest(ray).filter(|hit| hit.shape == 0);
        let comes = crossing.is_some_and(|c| c.margin > 0.0);
        assert_eq!(
            hit.is_some(),
            comes,
            "{exact:?}: {ray:?} meets it at {crossing:?}, the scene says {hit:?}"
        );
        *(if comes { &mut met } else { &mut missed }) += 1;
    });
    eprintln!("{met} rays from a step away met their disc, {missed} did not");
    assert!(met > 4000 && missed > 4000, "{met} {missed}");
}

/// What a step at the origin does to the point is in the ray; what arithmetic adds to it must not grow with the cosine too.
#[test]
fn a_disc_seen_edge_on_is_met_as_exactly_as_one_seen_from_above() {
    let mut worst = Worst::default();
    each_disc(85, |scene, exact, stream| {
        let target = exact.target(stream);
        let d = nearly_along(exact.normal(target), stream);
        let origin = (target + d * log_uniform([1.0, 1e4], stream)).as_vec3();
        let ray = Ray::new(origin, -d.as_vec3());
        let (o, d) = (origin.as_dvec3(), ray.direction.as_dvec3().normalize());
        let Some(crossing) = exact.crossings(o, d).first().copied() else { return };
        let (Some(hit), true) = (scene.nearest(ray).filter(|h| h.shape == 0), crossing.margin > UNCLEAR)
        else {
            return;
        };
        let away = hit.position.as_dvec3().distance(o + d * crossing.t);
        worst.add(away / ulp(hit.position.abs().max(origin.abs())));
    });
    eprintln!("points of discs seen edge-on: {worst} steps");
    assert!(worst.count > 1000 && worst.largest < 8.0, "{worst}");
}
