//! Surfaces that lie closer to each other than a radius: each gets its own light.

use std::f64::consts::PI;
use std::sync::Arc;

use foton_integrator::{Alpha, PpmSettings, RenderSettings};
use foton_math::Rgb;
use foton_math::glam::{DAffine3, DVec3};
use foton_scene::description::{EmitterDescription, EmitterKind, Geometry, Material, Mesh};
use foton_tests::{Sketch, grey, mean};

use super::with_radius;

/// Adds a rectangle's two triangles, facing up.
fn level(mesh: &mut Mesh, y: f64, half: f64) {
    let first = mesh.positions.len() as u32;
    let corner = |x: f64, z: f64| DVec3::new(x * half, y, z * half);
    mesh.positions.extend([corner(-1.0, -1.0), corner(-1.0, 1.0), corner(1.0, 1.0), corner(1.0, -1.0)]);
    mesh.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
}

fn mesh(sketch: Sketch, mesh: Mesh) -> Sketch {
    sketch.shape(Geometry::Mesh(Arc::new(mesh)), DAffine3::IDENTITY, grey(0.5), None)
}

/// The last shape's material is on both sides and lets a share of light pass.
fn masked(mut sketch: Sketch, opacity: f64) -> Sketch {
    let material: &mut Material = sketch.0.materials.last_mut().expect("a material");
    material.back = Some(material.front);
    material.opacity = Some(Rgb::splat(opacity as f32).into());
    sketch
}

/// Light straight down, of irradiance 1.
fn sun(mut sketch: Sketch) -> Sketch {
    let kind = EmitterKind::Directional { direction: DVec3::NEG_Y, irradiance: Rgb::WHITE };
    sketch.0.emitters.push(EmitterDescription { name: "sun".into(), kind });
    sketch
}

fn from_above() -> Sketch {
    Sketch::default().camera(DVec3::new(0.1, 3.0, 0.2), DVec3::new(0.1, 0.0, 0.2), 6.0, 8)
}

fn fixed(radius: f64) -> RenderSettings {
    RenderSettings {
        error: true,
        ppm: PpmSettings { alpha: Alpha::new(1.0).expect("in range"), ..with_radius(radius, 60_000).ppm },
        ..with_radius(radius, 60_000)
    }
}

/// Under light of irradiance 1 from above a card of opacity a lies on a floor of opacity b, both of reflectance ½. Of the light
/// between them the floor gets E = (1 − a) + a b E/4, and what leaves upwards is (a + (1 − a) b E)/2.
fn card_on_floor(a: f64, b: f64) -> f64 {
    let on_floor = (1.0 - a) / (1.0 - 0.25 * a * b);
    0.5 * (a + (1.0 - a) * b * on_floor) / PI
}

/// Photons on a card do not count on the floor below, nor those on the floor for the card, whether their gap is a hundredth of
/// the radius or a tenth, and whether the file calls them one mesh or two. The claimed error covers the true one.
#[test]
fn a_card_above_a_floor_has_its_own_light_and_so_has_the_floor() {
    for gap in [5e-4, 5e-3] {
        for opacity in [0.0, 0.5, 0.9] {
            let apart = {
                let (mut floor, mut card) = (Mesh::default(), Mesh::default());
                level(&mut floor, 0.0, 1.5);
                level(&mut card, gap, 1.0);
                sun(masked(mesh(mesh(from_above(), floor), card), opacity))
            };
            let together = {
                let mut both = Mesh::default();
                level(&mut both, 0.0, 1.5);
                level(&mut both, gap, 1.0);
                sun(masked(mesh(from_above(), both), opacity))
            };
            for (sketch, floor, name) in [(apart, 1.0, "apart"), (together, opacity, "together")] {
                let render = sketch.render(fixed(0.05), 12);
                let (got, expected) = (mean(&render.image()), card_on_floor(opacity, floor));
                // A few thousand photons are found; their noise is about 1.5 %.
                let close = (got - expected).abs() <= 0.05 * expected;
                assert!(close, "{name}, opacity {opacity}, gap {gap}: {got}, expected {expected}");
                if let Some(error) = render.error() {
                    let off = (got - expected).abs() / expected;
                    assert!(off < error.high, "{name}, {opacity}, {gap}: {off} off, {error:?}");
                }
            }
        }
    }
}

/// A floor of sixteen rectangles looks like one of one.
#[test]
fn a_floor_of_sixteen_rectangles_has_no_seams() {
    let camera = || Sketch::default().camera(DVec3::new(0.0, 2.0, 0.0), DVec3::ZERO, 50.0, 32);
    let tile = |sketch: Sketch, x: f64, z: f64, half: f64| {
        sketch.rectangle(DVec3::new(x, 0.0, z), DVec3::Z * half, DVec3::X * half, grey(0.5), None)
    };
    let one = tile(camera(), 0.0, 0.0, 1.2).point(DVec3::new(0.2, 1.0, 0.1), 10.0);
    let place = |i: i32| -0.9 + 0.6 * f64::from(i);
    let sixteen = (0..16).fold(camera(), |s, i| tile(s, place(i % 4), place(i / 4), 0.3));
    let sixteen = sixteen.point(DVec3::new(0.2, 1.0, 0.1), 10.0);
    let [one, sixteen] = [one, sixteen].map(|s| s.render(fixed(0.1), 4).image());
    for (i, (a, b)) in one.pixels.iter().zip(&sixteen.pixels).enumerate() {
        assert!((a.g - b.g).abs() <= 0.01 * a.g, "pixel {i}: {a:?} {b:?}");
    }
}

/// No light reaches the inside of a folded leaf's lower half straight from above, though the upper half is nearer than the
/// radius and joined to it.
#[test]
fn the_inside_of_a_folded_leaf_is_dark() {
    let angle: f64 = 0.06;
    let mut leaf = Mesh::default();
    let up = DVec3::new(angle.cos(), angle.sin(), 0.0);
    let corners =
        [DVec3::Z * -1.0, DVec3::Z, DVec3::X + DVec3::Z, DVec3::X - DVec3::Z, up + DVec3::Z, up - DVec3::Z];
    leaf.positions.extend(corners);
    leaf.triangles.extend([[0, 1, 2], [0, 2, 3], [1, 0, 5], [1, 5, 4]]);
    // From between the halves towards the fold, down on the lower half.
    let eye = up * 0.9 * 0.5 + DVec3::X * 0.45;
    let sketch = Sketch::default().camera(eye, DVec3::new(0.5, 0.0, 0.0), 1.5, 8).max_depth(2);
    let mut sketch = sun(mesh(sketch, leaf));
    let material = sketch.0.materials.last_mut().expect("a material");
    material.back = Some(material.front);
    let render = sketch.render(fixed(0.1), 6);
    assert!(render.start_report().hit_points == 64, "the lower half is seen");
    assert!(render.ledger().emitted > 0.0 && mean(&render.image()) == 0.0, "{}", mean(&render.image()));
}

/// A sphere, the same of flat triangles and the same of smooth ones are as bright as each other.
#[test]
fn a_sphere_of_triangles_is_as_bright_as_a_sphere() {
    let camera = || Sketch::default().camera(DVec3::new(0.5, 3.0, 1.0), DVec3::ZERO, 45.0, 24);
    let geodesic = |smooth: bool| {
        let (rings, around) = (48u32, 96u32);
        let mut ball = Mesh::default();
        let at = |i: u32, j: u32| {
            let (theta, phi) =
                (PI * f64::from(i) / f64::from(rings), 2.0 * PI * f64::from(j) / f64::from(around));
            DVec3::new(theta.sin() * phi.cos(), theta.cos(), theta.sin() * phi.sin())
        };
        for (i, j) in (0..rings).flat_map(|i| (0..around).map(move |j| (i, j))) {
            let first = ball.positions.len() as u32;
            ball.positions.extend([
                at(i, j),
                at(i, (j + 1) % around),
                at(i + 1, (j + 1) % around),
                at(i + 1, j),
            ]);
            ball.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
        }
        if smooth {
            ball.normals.clone_from(&ball.positions);
        }
        camera().shape(Geometry::Mesh(Arc::new(ball)), DAffine3::IDENTITY, grey(0.8), None)
    };
    let spheres = [camera().sphere(DVec3::ZERO, 1.0, grey(0.8), None), geodesic(false), geodesic(true)];
    // Discs of three facets' width: flat slabs would lose what curves away.
    let means = spheres.map(|s| mean(&sun(s).render(fixed(0.15), 4).image()));
    for got in means {
        assert!((got / means[0] - 1.0).abs() < 0.01, "{means:?}");
    }
}
