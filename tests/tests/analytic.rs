//! Renders against closed forms. Each expectation is derived beside its test, its bias at a finite radius included.

mod extremes;

use std::f64::consts::PI;
use std::num::NonZeroU32;

use foton_integrator::{Alpha, DirectLight, LayerKind, PpmSettings, RenderSettings};
use foton_math::Rgb;
use foton_math::glam::DVec3;
use foton_tests::{Sketch, glass, grey, mean, mean_and_sigma, seeds};

fn settings(photons: u32, seed: u64) -> RenderSettings {
    RenderSettings {
        samples_per_pixel: NonZeroU32::MIN,
        seed,
        ppm: PpmSettings {
            photons_per_pass: NonZeroU32::new(photons).expect("above 0"),
            first_pass: NonZeroU32::new(photons).expect("above 0"),
            // What photons bring is what is known here; `direct.rs` is about shadow rays.
            direct_light: DirectLight::Photons,
            ..PpmSettings::default()
        },
        ..RenderSettings::default()
    }
}

/// Inside a sphere of radius R and albedo ρ with a source Φ at the centre, E = Φ/(4πR²(1−ρ)) everywhere, and L = ρE/π.
/// The cap within a chord r has the area πr² exactly, so there is no curvature bias: tested at r = R/4 with α = 1.
#[test]
fn an_integrating_sphere_has_the_irradiance_of_its_closed_form_at_a_large_radius() {
    let (radius, albedo, power) = (2.0, 0.6, 5.0);
    let sketch = Sketch::default()
        .camera(DVec3::new(0.5, 0.2, 0.1), DVec3::new(1.0, 0.0, 0.3), 90.0, 16)
        .sphere(DVec3::ZERO, radius, grey(albedo as f32), None)
        .inside_out()
        .point(DVec3::ZERO, power);
    let base = RenderSettings {
        ppm: PpmSettings {
            radius: Some(radius / 4.0),
            alpha: Alpha::new(1.0).expect("in range"),
            ..settings(20_000, 0).ppm
        },
        ..settings(20_000, 0)
    };
    let expected = albedo / PI * power / (4.0 * PI * radius * radius * (1.0 - albedo));
    let (got, sigma) = seeds(&sketch, &base, 2, 6);
    assert!((got - expected).abs() < 4.0 * sigma + 1e-3 * expected, "{got} ± {sigma}, expected {expected}");
    assert!(sigma < 0.01 * expected, "the test must be able to tell: {sigma}");
}

/// In a closed room of walls that emit Le and reflect ρ, every ray sees Le/(1−ρ).
#[test]
fn a_closed_furnace_is_uniformly_bright_away_from_its_edges() {
    let sketch =
        Sketch::default().camera(DVec3::ZERO, -DVec3::Z, 60.0, 24).room(grey(0.5), Some(Rgb::splat(1.0)));
    let (got, sigma) = seeds(
        &sketch,
        &RenderSettings {
            ppm: PpmSettings { radius: Some(0.1), ..settings(50_000, 0).ppm },
            ..settings(50_000, 0)
        },
        2,
        6,
    );
    assert!((got - 2.0).abs() < 4.0 * sigma + 2e-3, "{got} ± {sigma}");
    assert!(sigma < 0.01);
}

/// Where a disc of radius r hangs over a wall's edge at distance d, only the part of its area on the wall collects photons:
/// the reflected part of L is low by that share, 1 − (acos(d/r) − (d/r)√(1 − (d/r)²))/π.
#[test]
fn the_deficit_at_an_edge_is_the_clipped_share_of_the_disc() {
    let r = 0.2;
    // A narrow view of the wall z = −1, along its edge with x = 1: pixels at known distances from it.
    let pixels = 40;
    let sketch = Sketch::default()
        .camera(
            DVec3::new(0.85, 0.0, 0.5),
            DVec3::new(0.85, 0.0, -1.0),
            2.0 * (0.15f64 / 1.5).atan().to_degrees(),
            pixels,
        )
        .room(grey(0.5), Some(Rgb::splat(1.0)));
    let base = RenderSettings {
        ppm: PpmSettings {
            radius: Some(r),
            alpha: Alpha::new(1.0).expect("in range"),
            ..settings(200_000, 1).ppm
        },
        ..settings(200_000, 1)
    };
    let image = sketch.render(base, 4).image();
    let mut worst: f64 = 0.0;
    for column in 0..pixels {
        // Film x grows to the right, which is world +x here.
        let d = 0.3 * (1.0 - (f64::from(column) + 0.5) / f64::from(pixels));
        let k = (d / r).min(1.0);
        let share = 1.0 - (k.acos() - k * (1.0 - k * k).sqrt()) / PI;
        let rows = (0..pixels).map(|row| f64::from(image.pixels[(row * pixels + column) as usize].g));
        let got = rows.sum::<f64>() / f64::from(pixels);
        worst = worst.max((got - (1.0 + share)).abs());
    }
    assert!(worst < 0.04, "{worst}");
}

/// Below a point source at height h, the mean irradiance over a disc of radius r is E₀·2(1 − 1/√(1+s²))/s², s = r/h: what
/// photon mapping must find, bias and all.
#[test]
fn blur_below_a_point_source_is_exactly_the_mean_over_the_disc() {
    let (h, power) = (1.0, 3.0);
    for s in [0.3, 1.0] {
        let sketch = Sketch::default()
            // All eye samples meet the floor within 10⁻³ of the foot.
            .camera(DVec3::new(0.0, 0.5, 0.0), DVec3::ZERO, 0.1, 4)
            .rectangle(DVec3::ZERO, DVec3::new(0.0, 0.0, 4.0), DVec3::new(4.0, 0.0, 0.0), grey(0.8), None)
            .point(DVec3::new(0.0, h, 0.0), power)
            .max_depth(2);
        let base = RenderSettings {
            ppm: PpmSettings {
                radius: Some(s * h),
                alpha: Alpha::new(1.0).expect("in range"),
                ..settings(100_000, 0).ppm
            },
            ..settings(100_000, 0)
        };
        let at_foot = power / (4.0 * PI * h * h);
        let expected = 0.8 / PI * at_foot * 2.0 * (1.0 - 1.0 / (1.0 + s * s).sqrt()) / (s * s);
        let (got, sigma) = seeds(&sketch, &base, 2, 6);
        assert!((got - expected).abs() < 4.0 * sigma, "s {s}: {got} ± {sigma}, expected {expected}");
        assert!(sigma < 0.01 * expected);
    }
}

/// Seen through a flat water surface along the normal, a Lambertian floor of radiance L_in has (1−F) L_in/n².
/// An emitting black floor needs no photons, so this is the eye path's own weight.
#[test]
fn radiance_seen_through_water_is_compressed_by_the_squared_index() {
    let n = 1.33;
    let sketch = Sketch::default()
        .camera(DVec3::new(0.0, 2.0, 0.0), DVec3::ZERO, 0.1, 2)
        .rectangle(DVec3::ZERO, DVec3::new(0.0, 0.0, 4.0), DVec3::new(4.0, 0.0, 0.0), glass(n as f32), None)
        .rectangle(
            -DVec3::Y,
            DVec3::new(0.0, 0.0, 4.0),
            DVec3::new(4.0, 0.0, 0.0),
            grey(0.0),
            Some(Rgb::splat(3.0)),
        );
    let got = mean(&sketch.render(settings(100, 0), 0).image());
    let fresnel = ((n - 1.0f64) / (n + 1.0)).powi(2);
    let expected = (1.0 - fresnel) * 3.0 / (n * n);
    assert!((got / expected - 1.0).abs() < 1e-5, "{got}, expected {expected}");
}

/// A pane of glass of index 1 is not there: the same photons, the same picture.
#[test]
fn glass_of_index_one_changes_nothing() {
    let scene = |with_glass: bool| {
        let s = Sketch::default()
            .camera(DVec3::new(0.0, 0.0, 0.9), DVec3::ZERO, 70.0, 16)
            .room(grey(0.5), None)
            .point(DVec3::new(0.1, 0.5, 0.2), 10.0);
        if with_glass { s.sphere(DVec3::new(0.0, -0.2, -0.3), 0.4, glass(1.0), None) } else { s }
    };
    let base = RenderSettings {
        ppm: PpmSettings { radius: Some(0.1), ..settings(50_000, 0).ppm },
        ..settings(50_000, 0)
    };
    let (a, sigma_a) = seeds(&scene(false), &base, 4, 5);
    let (b, sigma_b) = seeds(&scene(true), &base, 4, 5);
    assert!((a - b).abs() < 4.0 * sigma_a.hypot(sigma_b), "{a} ± {sigma_a}, {b} ± {sigma_b}");
    // Emission and depth apart, radiance through it is that without it, pixel by pixel, up to noise.
    let (x, y) = (scene(false).render(base.clone(), 40).image(), scene(true).render(base, 40).image());
    let worst = x.pixels.iter().zip(&y.pixels).map(|(p, q)| (p.g - q.g).abs() / p.g).fold(0f32, f32::max);
    assert!(worst < 0.35, "{worst}");
}

/// Direct light by photons and by shadow rays is the same light. Bias makes the first differ at shadow edges and creases, so
/// pixels near those are left out: those whose footprint's disc could touch one.
#[test]
fn photons_and_shadow_rays_agree_away_from_edges() {
    let sketch = Sketch::default()
        .camera(DVec3::new(0.0, 0.0, 0.95), DVec3::new(0.0, -0.1, -1.0), 60.0, 24)
        .room(grey(0.6), None)
        .rectangle(
            DVec3::new(0.0, 0.95, 0.0),
            DVec3::new(0.0, 0.0, -0.3),
            DVec3::new(-0.3, 0.0, 0.0),
            grey(0.0),
            Some(Rgb::splat(10.0)),
        )
        .sphere(DVec3::new(0.2, -0.5, -0.4), 0.35, glass(1.5), None);
    let base = RenderSettings {
        layers: true,
        ppm: PpmSettings { radius: Some(0.05), ..settings(60_000, 0).ppm },
        ..settings(60_000, 0)
    };
    let run = |direct_light, seed| {
        sketch
            .render(
                RenderSettings { seed, ppm: PpmSettings { direct_light, ..base.ppm }, ..base.clone() },
                12,
            )
            .image()
    };
    let shapes = match sketch.render(base.clone(), 1).layer(LayerKind::ShapeId).expect("summed").channels {
        foton_film::LayerData::U32(plane) => plane.values,
        _ => panic!("shape ids are whole numbers"),
    };
    let pixels = 24i32;
    let interior = |i: usize| {
        let (x, y) = (i as i32 % pixels, i as i32 / pixels);
        let around = (-2..=2).flat_map(|dy| (-2..=2).map(move |dx| (x + dx, y + dy)));
        around.into_iter().all(|(x, y)| {
            (0..pixels).contains(&x)
                && (0..pixels).contains(&y)
                && shapes[(y * pixels + x) as usize] == shapes[i]
        })
    };
    let count = 6;
    let by_photons: Vec<_> = (0..count).map(|s| run(DirectLight::Photons, s)).collect();
    let by_rays: Vec<_> = (0..count).map(|s| run(DirectLight::ShadowRays, s + 100)).collect();
    let mut beyond = 0;
    let mut looked_at = 0;
    let (mut total_a, mut total_b) = (0.0, 0.0);
    for i in (0..shapes.len()).filter(|&i| interior(i)) {
        let values =
            |runs: &[foton_film::Image]| runs.iter().map(|r| f64::from(r.pixels[i].g)).collect::<Vec<_>>();
        let (a, sigma_a) = mean_and_sigma(&values(&by_photons));
        let (b, sigma_b) = mean_and_sigma(&values(&by_rays));
        looked_at += 1;
        total_a += a;
        total_b += b;
        // Six seeds give a rough σ: Student's t with ten degrees of freedom exceeds 4.6 once in a thousand.
        beyond += usize::from((a - b).abs() > 4.6 * sigma_a.hypot(sigma_b) + 0.03 * b);
    }
    assert!(looked_at > 150, "{looked_at}");
    assert!(beyond * 50 <= looked_at, "{beyond} of {looked_at} differ");
    assert!((total_a / total_b - 1.0).abs() < 0.01, "{total_a} {total_b}");
}

/// Depth counts edges as Mitsuba does: 1 shows emitters alone, 2 adds one bounce, each more adds less, and a furnace's sum
/// at depth d is Le (1 − ρᵈ)/(1 − ρ).
#[test]
fn a_furnace_cut_at_each_depth_has_its_partial_sum() {
    for depth in 1..=5u32 {
        let sketch = Sketch::default()
            .camera(DVec3::ZERO, -DVec3::Z, 60.0, 16)
            .room(grey(0.5), Some(Rgb::splat(1.0)))
            .max_depth(depth);
        for direct_light in [DirectLight::Photons, DirectLight::ShadowRays] {
            let base = RenderSettings {
                ppm: PpmSettings { radius: Some(0.1), direct_light, ..settings(40_000, 0).ppm },
                ..settings(40_000, 0)
            };
            let (got, sigma) = seeds(&sketch, &base, 2, 5);
            let expected = (1.0 - 0.5f64.powi(depth as i32)) / 0.5;
            assert!(
                (got - expected).abs() < 4.0 * sigma + 3e-3,
                "depth {depth}: {got} ± {sigma}, expected {expected}"
            );
        }
    }
}

/// The same through glass: a pane between eye and wall costs edges, and pairs that are too long together do not count.
#[test]
fn edges_through_glass_count_for_each_pair() {
    // Index 1: a pane of two faces that changes nothing but the number of edges.
    let furnace = |depth: u32, pane: bool| {
        let s = Sketch::default()
            .camera(DVec3::ZERO, -DVec3::Z, 40.0, 12)
            .room(grey(0.5), Some(Rgb::splat(1.0)))
            .max_depth(depth);
        if pane { s.sphere(DVec3::ZERO, 0.1, glass(1.0), None) } else { s }
    };
    let base = RenderSettings {
        ppm: PpmSettings { radius: Some(0.1), ..settings(40_000, 0).ppm },
        ..settings(40_000, 0)
    };
    // The eye leaves the ball through one face: depth d + 1 sees what depth d saw, less what photons lose that cross the
    // ball themselves (a share of about its size, bounded here by 2 %).
    for depth in [1, 2, 3] {
        let (with, sigma) = seeds(&furnace(depth + 1, true), &base, 2, 5);
        let (without, sigma_without) = seeds(&furnace(depth, false), &base, 2, 5);
        let bound = 4.0 * sigma.hypot(sigma_without) + 0.02;
        assert!((with - without).abs() < bound, "depth {depth}: {with} ± {sigma}, {without}");
    }
}
