//! Every emitter: photons and shadow rays, two independent codes, must bring the same light.

use super::*;
use crate::description::{Bitmap, Texture, TextureKind, Wrap};
use crate::primitive::Primitive;
use crate::texture::{Sampler, samplers};
use foton_math::glam::{DAffine2, Mat3};
use foton_math::{Frame, Purpose, Stream, warp};
use std::f32::consts::PI;

fn emitter(kind: Kind) -> Emitter {
    Emitter { name: "test".into(), kind, aim: Aim::default() }
}

fn area(primitives: Vec<Primitive>) -> Emitter {
    emitter(Kind::Area(Area::new(0, Rgb::splat(2.0), &primitives)))
}

/// A picture with one bright pixel, and a black one.
pub(super) fn picture() -> std::sync::Arc<Sampler> {
    let mut pixels: Vec<Rgb> = (0..20).map(|i| Rgb::splat(0.1 + (i % 7) as f32 * 0.2)).collect();
    pixels[7] = Rgb::splat(12.0);
    pixels[12] = Rgb::BLACK;
    let bitmap = Bitmap::new(5, 4, pixels).into();
    let kind = TextureKind::Bitmap { bitmap, wrap: Wrap::Repeat, bilinear: true };
    let texture = Texture { name: "picture".into(), to_uv: DAffine2::IDENTITY, kind };
    samplers(&[texture], &[None])[0].clone()
}

pub(super) fn patterned(primitives: Vec<Primitive>) -> Area {
    let uvs: Vec<_> = (0..primitives.len())
        .map(|i| [(0.1, 0.2), (0.9, 0.1), (0.4, 0.3 + 0.5 * i as f32)].map(Vec2::from))
        .collect();
    let pattern = Pattern::new(picture(), &primitives, &uvs, (0, 0), Mat3::from_rotation_x(0.3));
    let mut area = Area::new(0, Rgb::BLACK, &primitives);
    area.set_pattern(pattern);
    let order: std::sync::Arc<[u32]> = (0..primitives.len() as u32).collect();
    area.pattern.iter_mut().for_each(|p| p.set_order(&order));
    area
}

/// Each kind as it shines, aimed at one ball, and at three of which some are near and some far.
fn all() -> Vec<Emitter> {
    let target = |centre: Vec3, radius, share| Target { ball: Ball { centre, radius }, share };
    let casters = vec![target(Vec3::new(0.5, 0.2, 0.1), 1.1, 0.5)];
    let nested = vec![
        target(Vec3::new(0.1, 0.0, -0.1), 0.6, 0.3),
        target(Vec3::new(0.5, 0.2, 0.1), 1.1, 0.2),
        target(Vec3::ZERO, 4.0, 0.3),
    ];
    let aims = [Aim::default(), Aim::new(casters), Aim::new(nested)];
    let aimed = |e: Emitter| aims.clone().map(|aim| Emitter { aim, ..e.clone() });
    as_they_shine().into_iter().flat_map(aimed).collect()
}

fn as_they_shine() -> Vec<Emitter> {
    let scene = Ball { centre: Vec3::ZERO, radius: 10.0 };
    let pixels = (0..32).map(|i| Rgb::splat(0.2 + 0.3 * (i % 5) as f32)).collect();
    let bitmap = Bitmap::new(8, 4, pixels);
    let map = EnvironmentMap::new(bitmap.into(), 1.5, Mat3::from_rotation_x(0.4));
    let square = |x: f32| Vec3::new(x, 0.0, 3.0);
    vec![
        area(vec![Primitive::Sphere { centre: Vec3::new(0.0, 0.0, 5.0), radius: 1.5, inward: false }]),
        area(vec![Primitive::Disc { centre: Vec3::new(0.5, 0.0, 4.0), normal: -Vec3::Z, radius: 1.0 }]),
        area(vec![
            Primitive::Triangle([square(0.0), square(1.0) + Vec3::Y, square(1.0)]),
            Primitive::Triangle([square(0.0), square(-3.0), square(0.0) - Vec3::Y]),
        ]),
        emitter(Kind::Point(Point { position: Vec3::new(1.0, 0.0, 2.0), intensity: Rgb::splat(3.0) })),
        emitter(Kind::Spot(Spot {
            position: Vec3::new(0.0, 0.5, 3.0),
            frame: Frame::from_normal(Vec3::new(0.1, -0.1, -1.0).normalize()),
            intensity: Rgb::splat(4.0),
            cone: Cone { cutoff: 0.5, beam: 0.3 },
        })),
        emitter(Kind::Beam(Box::new(slide(Picture::Texture(picture()))))),
        emitter(Kind::Beam(Box::new(slide(Picture::Even)))),
        emitter(Kind::Beam(Box::new(coloured()))),
        emitter(Kind::Goniometric(Goniometric {
            position: Vec3::new(1.0, 0.0, 2.0),
            map: map.clone().into(),
        })),
        emitter(Kind::Constant(Constant { radiance: Rgb::splat(0.7), scene })),
        emitter(Kind::Directional(Directional {
            direction: Vec3::new(0.3, 0.2, -0.9).normalize(),
            irradiance: Rgb::splat(2.0),
            scene,
        })),
        emitter(Kind::Environment(Environment { map: Box::new(map), scene })),
        area(vec![Primitive::Cylinder { from: Vec3::new(-1.0, 0.0, 3.0), axis: Vec3::X * 2.0, radius: 0.4 }]),
    ]
    .into_iter()
    .chain(shapes_with_patterns().into_iter().map(|primitives| emitter(Kind::Area(patterned(primitives)))))
    .collect()
}

/// A projector from above that throws half of its picture beside what is looked at.
fn slide(picture: Picture) -> Beam {
    let light = Light::Projected { half: Vec2::new(0.6, 0.4), factor: Rgb::splat(2.0) };
    Beam::new(Vec3::new(0.4, 0.5, 3.0), mirrored_frame(), picture, light)
}

/// A spot with a picture before it.
fn coloured() -> Beam {
    let light = Light::Coloured { cone: Cone { cutoff: 0.5, beam: 0.3 }, intensity: Rgb::new(4.0, 3.0, 2.0) };
    Beam::new(Vec3::new(0.0, 0.5, 3.0), mirrored_frame(), Picture::Texture(picture()), light)
}

fn mirrored_frame() -> Frame {
    let frame = Frame::from_normal(Vec3::new(0.1, -0.1, -1.0).normalize());
    Frame { tangent: -frame.tangent, ..frame }
}

/// One of each kind of surface, two triangles among them.
pub(super) fn shapes_with_patterns() -> Vec<Vec<Primitive>> {
    let square = |x: f32| Vec3::new(x, 0.0, 3.0);
    vec![
        vec![
            Primitive::Triangle([square(0.0), square(1.0) + Vec3::Y, square(1.0)]),
            Primitive::Triangle([square(0.0), square(-3.0), square(0.0) - Vec3::Y]),
        ],
        vec![Primitive::Sphere { centre: Vec3::new(0.0, 0.0, 5.0), radius: 1.5, inward: false }],
        vec![Primitive::Disc { centre: Vec3::new(0.5, 0.0, 4.0), normal: -Vec3::Z, radius: 1.0 }],
        vec![Primitive::Cylinder { from: Vec3::new(-1.0, 0.0, 3.0), axis: Vec3::X * 2.0, radius: 0.4 }],
    ]
}

/// Irradiance on a disc of radius 1 at the origin facing +z, from photons and from shadow rays: two independent codes.
#[test]
fn photons_and_shadow_rays_bring_the_same_light_to_a_disc() {
    for emitter in all() {
        let mut stream = Stream::new(4, Purpose::Test, 0, 0);
        let n = 400_000;
        let (mut sum, mut sum2) = (0.0f64, 0.0f64);
        for _ in 0..n {
            let e = emitter.emit(stream.next_1d(), stream.next_2d(), stream.next_2d());
            let t = -e.origin.z / e.direction.z;
            let p = e.origin + e.direction * t;
            let arrives = e.direction.z < 0.0 && t > 0.0 && p.length_squared() <= 1.0;
            let x = if arrives { f64::from(e.power.g) } else { 0.0 };
            sum += x;
            sum2 += x * x;
        }
        let flux = sum / f64::from(n);
        let flux_sigma = ((sum2 / f64::from(n) - flux * flux).max(0.0) / f64::from(n)).sqrt();
        let (mut sum, mut sum2) = (0.0f64, 0.0f64);
        for _ in 0..n {
            let p = warp::square_to_disc(stream.next_2d()).extend(0.0);
            let light = emitter.illuminate(p, Vec3::Z, stream.next_1d(), stream.next_2d());
            let x = light.map_or(0.0, |i| f64::from(i.radiance_over_pdf.g * i.direction.z.max(0.0) * PI));
            sum += x;
            sum2 += x * x;
        }
        let direct = sum / f64::from(n);
        let direct_sigma = ((sum2 / f64::from(n) - direct * direct).max(0.0) / f64::from(n)).sqrt();
        let sigma = flux_sigma.hypot(direct_sigma);
        assert!(
            direct > 0.0 && (flux - direct).abs() < 4.0 * sigma,
            "{emitter:?}: {flux} {direct} ± {sigma}"
        );
    }
}

#[test]
fn the_mean_photon_carries_the_emitters_power() {
    for emitter in all() {
        let mut stream = Stream::new(6, Purpose::Test, 0, 0);
        let n = 100_000;
        let sum: f64 = (0..n)
            .map(|_| f64::from(emitter.emit(stream.next_1d(), stream.next_2d(), stream.next_2d()).power.r))
            .sum();
        let mean = sum / f64::from(n);
        let expected = f64::from(emitter.power().r);
        assert!((mean / expected - 1.0).abs() < 0.01, "{emitter:?}: {mean} {expected}");
    }
}

#[test]
fn a_rectangle_and_a_sphere_give_the_irradiance_of_their_closed_forms() {
    // Sphere, wholly above the horizon: π L (R/d)² cos θ.
    let irradiance = |emitter: &Emitter, p: Vec3| {
        let mut stream = Stream::new(8, Purpose::Test, 0, 0);
        let n = 200_000;
        let sum: f64 = (0..n)
            .filter_map(|_| emitter.illuminate(p, Vec3::Z, stream.next_1d(), stream.next_2d()))
            .map(|i| f64::from(i.radiance_over_pdf.r * i.direction.z.max(0.0)))
            .sum();
        sum / f64::from(n)
    };
    let p = Vec3::new(2.0, 0.0, 0.0);
    let d2 = 29.0f64;
    let expected = std::f64::consts::PI * 2.0 * 2.25 / d2 * (5.0 / d2.sqrt());
    assert!((irradiance(&as_they_shine()[0], p) / expected - 1.0).abs() < 2e-3);
    // Disc on its axis: π L a² / (a² + h²).
    let disc = Primitive::Disc { centre: Vec3::new(0.0, 0.0, 4.0), normal: -Vec3::Z, radius: 2.0 };
    let expected = std::f64::consts::PI * 2.0 * 4.0 / 20.0;
    assert!((irradiance(&area(vec![disc]), Vec3::ZERO) / expected - 1.0).abs() < 5e-3);
    // Rectangle: (L/2) Σ acos(vᵢ·vᵢ₊₁) n·norm(vᵢ×vᵢ₊₁).
    let corners = [(-1.0, -1.0), (-1.0, 2.0), (3.0, 2.0), (3.0, -1.0)].map(|(x, y)| Vec3::new(x, y, 2.0));
    let [a, b, c, d] = corners;
    let rectangle = area(vec![Primitive::Triangle([a, b, c]), Primitive::Triangle([a, c, d])]);
    let unit = corners.map(|v| v.as_dvec3().normalize());
    let expected: f64 = (0..4)
        .map(|i| {
            let (v, w) = (unit[i], unit[(i + 1) % 4]);
            v.dot(w).acos() * w.cross(v).normalize().z
        })
        .sum::<f64>();
    assert!((irradiance(&rectangle, Vec3::ZERO) / expected - 1.0).abs() < 5e-3, "{expected}");
}

/// That numbers decide directions alone changes no light, and the same direction leaves all points that see it.
#[test]
fn a_sphere_that_goes_by_direction_brings_the_same_light() {
    let sphere = &as_they_shine()[0];
    let flux = |emit: &dyn Fn(Vec2, Vec2) -> Emission| {
        let mut stream = Stream::new(5, Purpose::Test, 0, 0);
        let n = 200_000;
        let arrives = |e: Emission| {
            let p = e.origin - e.direction * (e.origin.z / e.direction.z);
            e.direction.z < 0.0 && p.length_squared() <= 1.0
        };
        let hits = (0..n).filter(|_| arrives(emit(stream.next_2d(), stream.next_2d()))).count();
        hits as f64 / f64::from(n)
    };
    let by_direction = |x, u| sphere.emit_by_direction(x, u).expect("a sphere");
    let (one, other) = (flux(&|x, u| sphere.emit(0.0, x, u)), flux(&by_direction));
    // A few per cent of 200,000.
    assert!((one / other - 1.0).abs() < 0.05, "{one} {other}");
    assert_eq!(
        by_direction(Vec2::ZERO, Vec2::splat(0.3)).power,
        sphere.emit(0.0, Vec2::ZERO, Vec2::ZERO).power
    );
    let [a, b] = [0.1, 0.8].map(|x| by_direction(Vec2::splat(x), Vec2::splat(0.3)));
    assert!(a.direction == b.direction && a.origin.distance(b.origin) > 0.1);
    assert!(as_they_shine()[1].emit_by_direction(Vec2::ZERO, Vec2::ZERO).is_none());
}

/// E/π of the picture on any plane across the axis, E/d² of it: E is the factor times the picture. A spot has the picture over the square
/// around its cone.
#[test]
fn a_projector_lights_a_plane_as_its_picture_says() {
    let (axes, half) = (mirrored_frame(), Vec2::new(0.6, 0.4));
    let shown = |uv: Vec2| {
        let corner = crate::attributes::Corner::default();
        picture().colour(&crate::texture::At { uv, corner })
    };
    let slide = slide(Picture::Texture(picture()));
    let coloured = coloured();
    for (u, v) in [(0.1, 0.2), (0.5, 0.5), (0.93, 0.02), (0.4, 0.999)] {
        for distance in [0.5, 1.0, 3.0] {
            // u from the left, which is +x; v from the top.
            let on_plane = Vec2::new(half.x * (1.0 - 2.0 * u), half.y * (1.0 - 2.0 * v)).extend(1.0);
            let p = slide.position + axes.to_outer(on_plane * distance);
            let light = slide.illuminate(p).expect("lit");
            let irradiance = light.radiance_over_pdf * light.direction.dot(-axes.normal);
            let expected = shown(Vec2::new(u, v)) * (2.0 / (distance * distance));
            let error = irradiance - expected;
            assert!(error.to_array().iter().all(|e| e.abs() < 1e-3 * expected.max_component()), "{u} {v}");
        }
        // Within the beam, which is 0.3 wide.
        let tan = 0.5f32.tan();
        let at = Vec2::new(u, v) * 0.4 + 0.3;
        let way = axes.to_outer((tan * (2.0 * at - 1.0)).extend(1.0)).normalize();
        let expected = shown(at) * Rgb::new(4.0, 3.0, 2.0);
        let error = coloured.intensity(way) - expected;
        assert!(error.to_array().iter().all(|e| e.abs() < 1e-3 * expected.max_component()), "{at}");
    }
    for outside in [Vec3::new(0.61, 0.0, 1.0), Vec3::new(0.0, -0.41, 1.0), -Vec3::Z] {
        assert!(slide.illuminate(slide.position + axes.to_outer(outside)).is_none(), "{outside}");
    }
}

/// Photons leave in proportion to the picture: their powers differ by little but at the edges of pixels.
#[test]
fn photons_of_a_projector_carry_about_the_same() {
    for beam in [slide(Picture::Texture(picture())), slide(Picture::Even), coloured()] {
        let emitter = emitter(Kind::Beam(Box::new(beam)));
        let mut stream = Stream::new(9, Purpose::Test, 0, 0);
        let n = 100_000;
        let (mut sum, mut sum2) = (0.0, 0.0);
        for _ in 0..n {
            let power = f64::from(emitter.emit(0.0, Vec2::ZERO, stream.next_2d()).power.g);
            (sum, sum2) = (sum + power, sum2 + power * power);
        }
        let mean = sum / f64::from(n);
        let spread = (sum2 / f64::from(n) / (mean * mean) - 1.0).max(0.0).sqrt();
        assert!(spread < 0.3, "{emitter:?}: {spread}");
    }
}
