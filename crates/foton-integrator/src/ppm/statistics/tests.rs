//! The update of radii against its closed forms and the published one.

use super::*;
use foton_math::{Purpose, Stream};

fn alpha(a: f64) -> Alpha {
    Alpha::new(a).expect("in range")
}

/// ln Γ by Stirling's series after shifting the argument up; to about 1e-14 here.
fn ln_gamma(mut x: f64) -> f64 {
    let mut shift = 0.0;
    while x < 20.0 {
        shift += x.ln();
        x += 1.0;
    }
    let tail = 1.0 / (12.0 * x) - 1.0 / (360.0 * x.powi(3)) + 1.0 / (1260.0 * x.powi(5));
    (x - 0.5) * x.ln() - x + 0.5 * (2.0 * std::f64::consts::PI).ln() + tail - shift
}

#[test]
fn the_density_of_retained_photons_is_that_of_found_ones_with_alpha_changing() {
    // N/r² = Σ Mⱼ/rⱼ².
    let mut stream = Stream::new(1, Purpose::Test, 0, 0);
    let mut s = Statistics::new(3.0);
    let mut sum = 0.0;
    for pass in 0..2000 {
        let m = (stream.next_1d() * 12.0) as u64;
        sum += m as f64 / s.radius2();
        s.refine(m, alpha([0.5, 0.7, 2.0 / 3.0, 1.0, 0.9][pass % 5]), 0.0);
        if s.accumulated > 0.0 {
            assert!((s.accumulated / s.radius2() / sum - 1.0).abs() < 1e-9, "pass {pass}");
        }
    }
}

#[test]
fn the_running_mean_is_the_published_rescaled_flux_with_alpha_changing() {
    // Hachisuka 2008: τ' = (τ + Φ) ρ, L = τ'/(π r'² N_emitted). Here: S += Φ/(π r²), L = S/N_emitted.
    let mut stream = Stream::new(2, Purpose::Test, 0, 0);
    let mut s = Statistics::new(2.0);
    let (mut tau, mut n, mut r2, mut sum) = (0.0f64, 0.0f64, 2.0f64, 0.0f64);
    for pass in 0..5000 {
        let m = (stream.next_1d() * 9.0) as u64;
        let flux = m as f64 * f64::from(stream.next_1d());
        let a = alpha([0.6, 2.0 / 3.0, 0.9][pass / 7 % 3]);
        sum += flux / (std::f64::consts::PI * s.radius2());
        s.refine(m, a, 0.0);
        if m > 0 {
            let rho = (n + a.get() * m as f64) / (n + m as f64);
            n += a.get() * m as f64;
            r2 *= rho;
            tau = (tau + flux) * rho;
        } else {
            tau += flux;
        }
        let published = tau / (std::f64::consts::PI * r2);
        assert!((sum - published).abs() <= 1e-10 * sum, "pass {pass}: {sum} {published}");
    }
}

#[test]
fn constant_counts_follow_their_gamma_formula_over_a_million_passes() {
    // r_n²/r_0² = Γ(1/α) Γ(n+1)/Γ(n+1/α).
    for a in [0.5, 2.0 / 3.0, 0.9] {
        let mut s = Statistics::new(1.0);
        for n in 1..=1_000_000u64 {
            s.refine(5, alpha(a), 0.0);
            if n.is_power_of_two() || n == 1_000_000 {
                let n = n as f64;
                let expected = (ln_gamma(1.0 / a) + ln_gamma(n + 1.0) - ln_gamma(n + 1.0 / a)).exp();
                assert!((s.radius2() / expected - 1.0).abs() < 1e-8, "α {a}, n {n}");
            }
        }
    }
}

#[test]
fn uniform_density_follows_its_gamma_formula() {
    // Real-valued M ∝ r²: r_n²/r_0² = Γ(n+α)/(Γ(α)Γ(n+1)). Counts are whole, so make them large.
    let a = 2.0 / 3.0;
    let mut s = Statistics::new(1.0);
    for n in 1..=10_000u32 {
        s.refine((1e15 * s.radius2()).round() as u64, alpha(a), 0.0);
        if n.is_power_of_two() {
            let n = f64::from(n);
            let expected = (ln_gamma(n + a) - ln_gamma(a) - ln_gamma(n + 1.0)).exp();
            assert!((s.radius2() / expected - 1.0).abs() < 1e-8, "{n}: {} {expected}", s.radius2());
        }
    }
}

#[test]
fn alpha_one_never_shrinks_and_a_tiny_alpha_stays_finite() {
    let mut one = Statistics::new(0.7);
    let mut tiny = Statistics::new(0.7);
    for _ in 0..10_000 {
        one.refine(3, alpha(1.0), 0.0);
        tiny.refine(3, alpha(1e-3), 1e-30);
    }
    assert_eq!(one.radius2(), f64::from(0.7f32));
    assert!(tiny.radius2() > 0.0 && tiny.radius2() < 1e-20);
}

#[test]
fn radii_still_shrink_after_two_to_the_forty_photons() {
    let mut s = Statistics { accumulated: 2f64.powi(40), radius2: 1.0, found: 1 << 41 };
    let before = s.radius2();
    s.refine(1, Alpha::default(), 0.0);
    assert!(s.radius2() < before && s.photons_found() == (1 << 41) + 1);
}

#[test]
fn an_empty_pass_changes_nothing_and_the_floor_is_reported() {
    let mut s = Statistics::new(1.0);
    let before = s;
    assert!(!s.refine(0, Alpha::default(), 0.5) && s == before && s.is_unknown());
    assert!(!s.refine(1, Alpha::default(), 0.5));
    assert!(s.refine(5, Alpha::default(), 0.5));
    assert_eq!(s.radius2(), 0.5);
}
