//! What discs of known light make of radii.

use super::*;

/// The moments of a disc of radius 1 with `n` photons a unit of area, dimmed as `lit` says: laid out evenly, with the noise of random ones.
fn radius_statistics(n: f64, lit: impl Fn(f64, f64) -> f64) -> RadiusStatistics {
    const RINGS: i32 = 200;
    let mut e = RadiusStatistics::default();
    for (ring, turn) in (0..RINGS * RINGS).map(|i| (f64::from(i / RINGS), f64::from(i % RINGS))) {
        let s = (ring + 0.5) / f64::from(RINGS);
        let (y, x) = ((turn + 0.5) / f64::from(RINGS) * 2.0 * PI).sin_cos();
        let (x, y) = (x * s.sqrt(), y * s.sqrt());
        let light = lit(x, y) * n / f64::from(RINGS * RINGS);
        e.light += light;
        e.variance += light / PI;
        e.laplacian += 6.0 * (s - 0.5) * light;
        e.offset[0] += x * light;
        e.offset[1] += y * light;
    }
    let middle2 = (e.offset[0].powi(2) + e.offset[1].powi(2)) / e.light.powi(2);
    e.freedom = e.light * PI - 1.0;
    e.spread = (e.laplacian / (6.0 * e.light) + 0.5 - middle2) * e.freedom;
    e
}

#[test]
fn uniform_light_never_shrinks_its_radius_whatever_its_photons() {
    for n in [1.0, 1e3, 1e9] {
        assert_eq!(radius_statistics(n, |_, _| 1.0).alpha(Alpha::default()).get(), 1.0);
    }
}

#[test]
fn alpha_is_as_meant_where_blur_is_half_the_noise() {
    // L = 1 + c(2s − 1) is 1 − c in the middle: bias c, of which its noise 3/(πn) is taken off twice.
    let c = 0.1;
    let radius_statistics = |n: f64| radius_statistics(n, |x, y| 1.0 + c * (2.0 * (x * x + y * y) - 1.0));
    let n = (CAUTION * 3.0 + 0.5) / (PI * c * c);
    assert!((radius_statistics(n).balance() - 1.0).abs() < 0.02, "{}", radius_statistics(n).balance());
    assert!((radius_statistics(n).alpha(Alpha::default()).get() - 2.0 / 3.0).abs() < 0.01);
    assert_eq!(radius_statistics(0.9 * CAUTION * 3.0 / (PI * c * c)).balance(), 0.0, "it may be noise");
    assert_eq!(radius_statistics(100.0 * n).balance(), MAX_BALANCE);
}

#[test]
fn edges_through_the_middle_are_seen_and_gentle_slopes_are_not() {
    let edge = radius_statistics(100.0, |x, _| f64::from(u8::from(x > 0.0)));
    assert!(edge.laplacian.abs() < 1e-3 * edge.light, "both sides cancel");
    assert_eq!(edge.balance(), MAX_BALANCE);
    let slope = |n: f64| radius_statistics(n, |x, _| 1.0 + 0.1 * x);
    assert!(slope(1e3).balance() < 0.1);
    assert_eq!(slope(1e9).balance(), MAX_BALANCE, "in the end all blur outweighs noise");
}

#[test]
fn light_in_a_part_of_the_disc_may_be_brighter_than_the_disc_sees() {
    let of =
        |lit: fn(f64, f64) -> bool| radius_statistics(1e6, |x, y| f64::from(u8::from(lit(x, y)))).focus();
    assert!(of(|_, _| true) < 1e-3, "even light");
    // A circle of radius ρ off the middle: 1/ρ² − 1.
    let circle = of(|x, y| (x - 0.3).hypot(y + 0.2) < 0.25);
    assert!((circle / 15.0 - 1.0).abs() < 0.02, "{circle}");
    // Half of the disc: 1/(1 − 32/(9π²)) − 1.
    assert!((of(|x, _| x > 0.0) - 0.563).abs() < 0.01, "{}", of(|x, _| x > 0.0));
    let few = radius_statistics(2.0, |_, _| 1.0).focus();
    assert!(few < 0.1, "a few photons prove nothing: {few}");
    assert_eq!(RadiusStatistics::default().focus(), 0.0);
}

#[test]
fn light_that_is_no_number_says_nothing_of_a_radius() {
    let mut radius_statistics = RadiusStatistics::default();
    // Too bright for the square of single precision.
    let bright = DiscMoments { light: [1e30; LANES], squares: [f32::INFINITY; LANES], ..DiscMoments::NONE };
    radius_statistics.add(1.0, 0, 1e30, &bright);
    assert_eq!(radius_statistics, RadiusStatistics::default());
    radius_statistics.add(
        1.0,
        0,
        0.5,
        &DiscMoments { light: [1.0; LANES], squares: [1.0; LANES], ..DiscMoments::NONE },
    );
    assert!(radius_statistics.light > 0.0 && radius_statistics.variance > 0.0);
}

#[test]
fn without_light_or_with_numbers_that_are_none_alpha_is_a_share() {
    let alpha = Alpha::default();
    assert_eq!(RadiusStatistics::default().alpha(alpha), alpha);
    let infinite =
        RadiusStatistics { variance: f64::INFINITY, light: f64::INFINITY, ..RadiusStatistics::default() };
    assert!(infinite.alpha(alpha).get() > 0.0);
    assert_eq!(radius_statistics(1e6, |x, _| x + 1.0).alpha(Alpha::new(1.0).expect("in range")).get(), 1.0);
}
