//! Glass in glass, glass that touches glass, and what stands inside it. Each surface has the two indices that its material
//! states, as in Mitsuba: nothing is guessed from what encloses what.

use std::f64::consts::PI;

use foton_integrator::{Alpha, DirectLight, PpmSettings, RenderSettings};
use foton_math::Rgb;
use foton_math::glam::DVec3;
use foton_scene::description::{Bsdf, Colour, Dielectric};
use foton_tests::{Sketch, glass, grey, mean, seeds};

use super::with_radius;
use crate::settings;

/// Glass between two stated indices.
fn between(int_ior: f32, ext_ior: f32) -> Bsdf {
    Bsdf::Dielectric(Dielectric {
        int_ior,
        ext_ior,
        specular_reflectance: Colour::Constant(Rgb::WHITE),
        specular_transmittance: Colour::Constant(Rgb::WHITE),
        roughness: None,
    })
}

/// Share that passes a boundary along its normal.
fn passes(a: f64, b: f64) -> f64 {
    1.0 - ((a - b) / (a + b)).powi(2)
}

/// What the camera at z = `from` sees along −z through `sketch` of a wall of radiance 3, by paths of so many edges at most.
fn seen(sketch: Sketch, from: f64, edges: u32) -> f64 {
    let wall = sketch
        .camera(DVec3::Z * from, DVec3::Z * -9.0, 0.01, 2)
        .rectangle(DVec3::Z * -9.0, DVec3::X * 9.0, DVec3::Y * 9.0, grey(0.0), Some(Rgb::splat(3.0)))
        .max_depth(edges);
    mean(&wall.render(settings(100, 0), 0).image())
}

fn close(got: f64, expected: f64, what: &str) {
    assert!((got / expected - 1.0).abs() < 1e-4, "{what}: {got}, expected {expected}");
}

/// Straight through two balls, four surfaces; the cap on edges leaves out what is reflected to and fro. Each surface passes
/// what its own two indices let through, whatever stands around it, and squared indices cancel where they are stated in pairs.
#[test]
fn nested_and_touching_glass_is_as_each_surface_says() {
    let ball = |s: Sketch, z: f64, r: f64, b: Bsdf| s.sphere(DVec3::Z * z, r, b, None);
    let empty = Sketch::default;
    // Water in glass, stated as such.
    let nested = ball(ball(empty(), 0.0, 1.0, between(1.5, 1.0)), 0.0, 0.5, between(1.33, 1.5));
    let water_in_glass = 3.0 * passes(1.0, 1.5).powi(2) * passes(1.5, 1.33).powi(2);
    close(seen(nested, 5.0, 5), water_in_glass, "nested");
    // The same balls, the inner one stated as if in air: so it is taken.
    let careless = ball(ball(empty(), 0.0, 1.0, between(1.5, 1.0)), 0.0, 0.5, between(1.33, 1.0));
    close(seen(careless, 5.0, 5), 3.0 * passes(1.0, 1.5).powi(2) * passes(1.0, 1.33).powi(2), "as stated");
    // Two balls that all but touch, and two that overlap: four surfaces each. Where the gap is below the offsets of ray origins,
    // some 10⁻⁷ of the scene, a ray that leaves one ball may start inside the other.
    for distance in [1.0 + 5e-6, 0.6] {
        let glass_twice = 3.0 * passes(1.0, 1.5).powi(4);
        let pair = ball(ball(empty(), distance, 1.0, glass(1.5)), -distance, 1.0, glass(1.5));
        close(seen(pair, 5.0, 5), glass_twice, &format!("balls {distance} from the middle"));
    }
    // Two slabs with a face in one place: each keeps its own.
    let slab = |s: Sketch, z: f64| {
        let x = DVec3::X * 9.0;
        s.rectangle(DVec3::Z * z, x, DVec3::Y * 9.0, glass(1.5), None).rectangle(
            DVec3::Z * (z - 1.0),
            x,
            DVec3::Y * -9.0,
            glass(1.5),
            None,
        )
    };
    let stacked = seen(slab(slab(empty(), 2.0), 0.9), 5.0, 5);
    close(stacked, 3.0 * passes(1.0, 1.5).powi(4), "two panes");
}

/// A camera inside glass looks out through one surface: radiance from outside is compressed by the squared index.
#[test]
fn a_camera_inside_glass_sees_out_through_its_surface() {
    let inside = Sketch::default().sphere(DVec3::ZERO, 1.0, glass(1.5), None);
    close(seen(inside, 0.0, 2), 3.0 * passes(1.0, 1.5) * 1.5 * 1.5, "inside");
}

/// A source inside a ball of glass gives all its power to the room around: E = Φ/(4πR²(1−ρ)) as without glass.
#[test]
fn a_light_inside_glass_gives_its_power_to_the_room() {
    let sketch = Sketch::default()
        .camera(DVec3::new(1.2, 0.2, 0.1), DVec3::new(2.0, 0.0, 0.3), 60.0, 12)
        .sphere(DVec3::ZERO, 2.0, grey(0.6), None)
        .inside_out()
        .sphere(DVec3::ZERO, 0.5, glass(1.5), None)
        .point(DVec3::ZERO, 5.0);
    let settings = RenderSettings {
        ppm: PpmSettings { alpha: Alpha::new(1.0).expect("in range"), ..with_radius(0.5, 20_000).ppm },
        ..with_radius(0.5, 20_000)
    };
    let expected = 0.6 / PI * 5.0 / (4.0 * PI * 4.0 * 0.4);
    let (got, sigma) = seeds(&sketch, &settings, 2, 6);
    assert!((got - expected).abs() < 4.0 * sigma + 0.01 * expected, "{got} ± {sigma}, expected {expected}");
    // A shadow ray cannot pass the glass, so only photons may bring this light.
    let by_rays = RenderSettings {
        ppm: PpmSettings { direct_light: DirectLight::ShadowRays, ..settings.ppm },
        ..settings
    };
    let (rays, sigma_rays) = seeds(&sketch, &by_rays, 2, 6);
    assert!((rays - got).abs() < 4.0 * sigma.hypot(sigma_rays), "{rays} ± {sigma_rays}, {got} ± {sigma}");
}

/// Glass of index 1000 reflects ((n−1)/(n+1))² along the normal, and looks back at the camera's own side.
#[test]
fn glass_of_index_a_thousand_is_nearly_a_mirror() {
    let wall = |s: Sketch| {
        s.rectangle(DVec3::Z * 6.0, DVec3::X * 9.0, DVec3::Y * -9.0, grey(0.0), Some(Rgb::splat(2.0)))
    };
    let plate = |ior: f32| {
        Sketch::default()
            .camera(DVec3::Z * 5.0, DVec3::ZERO, 0.01, 2)
            .rectangle(DVec3::ZERO, DVec3::X * 9.0, DVec3::Y * 9.0, glass(ior), None)
            .max_depth(2)
    };
    let got = mean(&wall(plate(1e3)).render(settings(100, 0), 0).image());
    close(got, 2.0 * (999.0f64 / 1001.0).powi(2), "index 1000");
    let none = mean(&wall(plate(1.0)).render(settings(100, 0), 0).image());
    assert_eq!(none, 0.0, "index 1 reflects nothing");
}

/// From inside glass beyond the critical angle everything is reflected: a wall of light outside is not seen at all, and one
/// inside is seen in full.
#[test]
fn total_reflection_is_total() {
    // The camera looks along (1, 0, −1) at a surface z = 0 from below it: 45° is beyond 41.8°.
    let sketch = |inside: f32, outside: f32| {
        Sketch::default()
            .camera(DVec3::new(-1.0, 0.0, -1.0), DVec3::ZERO, 0.01, 2)
            .rectangle(DVec3::ZERO, DVec3::X * 9.0, DVec3::Y * 9.0, glass(1.5), None)
            .rectangle(DVec3::Z * 3.0, DVec3::X * 9.0, DVec3::Y * -9.0, grey(0.0), Some(Rgb::splat(outside)))
            .rectangle(DVec3::Z * -3.0, DVec3::X * 9.0, DVec3::Y * 9.0, grey(0.0), Some(Rgb::splat(inside)))
            .max_depth(2)
    };
    let seen = |inside, outside| mean(&sketch(inside, outside).render(settings(100, 0), 0).image());
    assert_eq!((seen(0.0, 7.0), seen(7.0, 0.0)), (0.0, 7.0));
}
