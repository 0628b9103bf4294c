//! Textures are looked up over what an eye sample covers: a frozen sample shows the mean of its pixel, through mirrors and glass too, and
//! what many samples converge to stays what it is.

use std::num::NonZeroU32;
use std::sync::Arc;

use foton_math::glam::{DAffine2, DAffine3, DVec2, DVec3};
use foton_math::{Purpose, Rgb};
use foton_scene::Scene;
use foton_scene::description::{
    Bsdf, Colour, Dielectric, Diffuse, Filter, FovAxis, Geometry, Material, Mesh, Mirror, SceneDescription,
    SensorDescription, ShapeDescription, Texture, TextureKind,
};
use foton_transport::camera_paths::{EyePass, EyePaths, FirstRadius};
use foton_transport::{Cancel, LobePolicy, LobeUse};

const SIDE: u32 = 64;

/// A scene that grows by one thing a line.
struct Sketch(SceneDescription);

impl Sketch {
    /// Seen from `from` to `to`, with a field of view in degrees.
    fn new(from: DVec3, to: DVec3, fov_degrees: f64) -> Self {
        let forward = (to - from).normalize();
        let left = DVec3::Y.cross(forward).normalize();
        let sensor = SensorDescription {
            name: "camera".into(),
            to_world: DAffine3::from_cols(left, forward.cross(left), forward, from),
            fov_degrees,
            fov_axis: FovAxis::X,
            width: SIDE,
            height: SIDE,
            filter: Filter::Box { radius: 0.5 },
            ..SensorDescription::default()
        };
        Self(SceneDescription { sensors: vec![sensor], ..SceneDescription::default() })
    }

    fn shape(mut self, geometry: Geometry, to_world: DAffine3, front: Bsdf) -> Self {
        let material = self.0.materials.len();
        let name = format!("shape {material}");
        self.0.materials.push(Material { name: name.clone(), front, ..Material::default() });
        let (flip_normals, radiance) = (false, None);
        self.0.shapes.push(ShapeDescription { name, geometry, to_world, flip_normals, material, radiance });
        self
    }

    /// A rectangle by its middle and half its sides, whose normal is `x × y`.
    fn rectangle(self, middle: DVec3, x: DVec3, y: DVec3, front: Bsdf) -> Self {
        let to_world = DAffine3::from_cols(x, y, x.cross(y).normalize(), middle);
        self.shape(Geometry::Mesh(Arc::new(Mesh::rectangle())), to_world, front)
    }

    fn ball(self, centre: DVec3, front: Bsdf) -> Self {
        self.shape(Geometry::Sphere { centre, radius: 1.0 }, DAffine3::IDENTITY, front)
    }

    /// A floor of squares to the horizon, which faces up.
    fn floor(self, square: f64) -> Self {
        let half = 400.0;
        let front = Bsdf::Diffuse(Diffuse { reflectance: Colour::Texture(0) });
        let mut sketch = self.rectangle(DVec3::ZERO, DVec3::Z * half, DVec3::X * half, front);
        sketch.0.textures.push(Texture {
            name: "squares".into(),
            to_uv: DAffine2::from_scale(DVec2::splat(half / square)),
            kind: TextureKind::Checkerboard { colours: [0.1, 0.9].map(|c| Rgb::splat(c).into()) },
        });
        sketch
    }
}

fn mirror() -> Bsdf {
    Bsdf::Mirror(Mirror { reflectance: Rgb::WHITE.into() })
}

fn glass() -> Bsdf {
    Bsdf::Dielectric(Dielectric {
        int_ior: 1.5,
        ext_ior: 1.0,
        specular_reflectance: Rgb::WHITE.into(),
        specular_transmittance: Rgb::WHITE.into(),
        roughness: None,
    })
}

/// The reflectance that each pixel sees, by the first of so many frozen samples. Of very many each one covers next to nothing.
fn seen(sketch: &Sketch, samples: u32, of: u32) -> Vec<f64> {
    let scene = Scene::build(&sketch.0).expect("a sound scene");
    let policy = LobePolicy { max_specular_roughness: 0.1 };
    let number = |n| NonZeroU32::new(n).expect("above 0");
    let pass = EyePass {
        scene: &scene,
        sensor: 0,
        samples_per_pixel: number(of),
        pass: None,
        hit_points_per_sample: number(16),
        radius: FirstRadius::new(&scene, None, 1.0, 1.0, of),
        max_depth: 12,
        policy,
        uses: LobeUse::of(scene.census(), &policy),
        seed: 7,
        purpose: Purpose::Eye,
    };
    let paths = pass.run(EyePaths::default(), samples, &Cancel::default(), &|_| ()).expect("not cancelled");
    let start = paths.pixel_start();
    let weight = |pixel: usize| {
        let points = &paths.hit_points[start[pixel] as usize..start[pixel + 1] as usize];
        points.iter().map(|p| f64::from(p.weight.g)).sum::<f64>() * std::f64::consts::PI / f64::from(samples)
    };
    (0..(SIDE * SIDE) as usize).map(weight).collect()
}

/// One sample a pixel, filtered, is off by less than `share` of what one is off that is looked up at a point, and has the same mean.
fn assert_filtered(name: &str, sketch: &Sketch, share: f64) {
    let many = seen(sketch, 256, 1 << 20);
    let (point, filtered) = (seen(sketch, 1, 1 << 20), seen(sketch, 1, 1));
    let n = many.len() as f64;
    let error = |one: &[f64]| {
        let square: f64 = one.iter().zip(&many).map(|(a, b)| (a - b).powi(2)).sum();
        (square / n).sqrt()
    };
    let mean = |image: &[f64]| image.iter().sum::<f64>() / n;
    let errors = [error(&filtered), error(&point)];
    assert!(errors[0] < share * errors[1], "{name}: {errors:?}");
    assert!(
        (mean(&filtered) / mean(&many) - 1.0).abs() < 0.01,
        "{name}: {} {}",
        mean(&filtered),
        mean(&many)
    );
}

/// Over the floor to the horizon.
fn along_the_floor() -> Sketch {
    Sketch::new(DVec3::new(0.0, 2.0, 0.3), DVec3::new(30.0, -4.0, 7.0), 40.0)
}

#[test]
fn one_sample_shows_the_mean_of_a_floor_that_it_sees_directly() {
    assert_filtered("directly", &along_the_floor().floor(0.015), 0.15);
}

#[test]
fn one_sample_shows_the_mean_of_a_floor_in_a_flat_and_in_a_round_mirror() {
    // The mirror stands upright before the camera, and shows the floor behind it.
    let flat = Sketch::new(DVec3::new(0.0, 2.0, 0.3), DVec3::new(6.0, 1.2, 0.3), 40.0);
    let flat = flat.rectangle(DVec3::new(6.0, 2.0, 0.0), -DVec3::Z * 9.0, DVec3::Y * 9.0, mirror());
    assert_filtered("flat", &flat.floor(0.015), 0.15);
    // Squares that only the curvature of the ball makes smaller than what a sample covers.
    let round = Sketch::new(DVec3::new(0.0, 3.0, 0.0), DVec3::new(4.0, 1.2, 0.0), 24.0);
    assert_filtered("round", &round.ball(DVec3::new(4.0, 1.2, 0.0), mirror()).floor(0.1), 0.35);
}

#[test]
fn one_sample_shows_the_mean_of_a_floor_through_a_slab_and_a_ball_of_glass() {
    let pane = |sketch: Sketch, x: f64, side: f64| {
        sketch.rectangle(DVec3::new(x, 2.0, 0.0), DVec3::Z * 9.0, DVec3::Y * 9.0 * side, glass())
    };
    // Normals point out of the slab.
    let slab = pane(pane(along_the_floor(), 1.0, 1.0), 2.0, -1.0);
    assert_filtered("slab", &slab.floor(0.015), 0.15);
    let ball = Sketch::new(DVec3::new(0.0, 3.0, 0.0), DVec3::new(4.0, 1.2, 0.0), 20.0);
    assert_filtered("ball", &ball.ball(DVec3::new(4.0, 1.2, 0.0), glass()).floor(0.05), 0.5);
}
