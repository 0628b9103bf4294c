//! Rays against built scenes, through the public interface alone: nothing leaks, nothing meets itself, and units and
//! mirrors change nothing.
//!
//! Not here: densities of emitters, BSDFs, sensors and filters, which are tested beside their code.

mod building;
mod coincident;
mod contacts;
mod descriptions;
mod double;
mod far;
mod instances;
mod patches;
mod ray_origins;
mod reference;
mod sides;
mod units;
mod watertight;

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use foton_math::glam::{DAffine3, DQuat, DVec3, EulerRot, Vec3};
use foton_math::{Purpose, Rgb, Stream, warp};
use foton_scene::Scene;
use foton_scene::description::{
    Bsdf, Diffuse, Filter, FovAxis, Geometry, Material, Mesh, SceneDescription, SensorDescription,
    ShapeDescription,
};

/// So many cases, or a multiple of them where someone asks for more than the tests can bear: `FOTON_CASES` multiplies them.
fn cases(usual: u32) -> u32 {
    usual * std::env::var("FOTON_CASES").ok().and_then(|n| n.parse().ok()).unwrap_or(1)
}

/// The random numbers of one test.
const fn stream(test: u64) -> Stream {
    Stream::new(2008, Purpose::Test, 0, test)
}

/// Uniform on the unit sphere.
fn direction(stream: &mut Stream) -> Vec3 {
    warp::square_to_sphere(stream.next_2d())
}

/// Uniform on the half of the unit sphere around `normal`.
fn direction_around(normal: Vec3, stream: &mut Stream) -> Vec3 {
    let d = direction(stream);
    if d.dot(normal) < 0.0 { -d } else { d }
}

/// Nearly along a surface: the cosine with `normal` is `cosine`.
fn grazing(normal: Vec3, cosine: f64, stream: &mut Stream) -> Vec3 {
    let (normal, any) = (normal.as_dvec3(), direction(stream).as_dvec3());
    let tangent = (any - normal * any.dot(normal)).normalize();
    (tangent * (1.0 - cosine * cosine).sqrt() + normal * cosine).normalize().as_vec3()
}

/// Uniform in the cube [−1, 1]³.
fn in_cube(stream: &mut Stream) -> DVec3 {
    DVec3::from_array([(); 3].map(|()| f64::from(stream.next_1d()))) * 2.0 - 1.0
}

/// Uniform in the logarithm.
fn log_uniform([low, high]: [f64; 2], stream: &mut Stream) -> f64 {
    low * (high / low).powf(f64::from(stream.next_1d()))
}

/// A turn about no axis in particular.
fn turn() -> DQuat {
    DQuat::from_euler(EulerRot::XYZ, 0.3, 1.1, -0.7)
}

/// Shapes under a plain camera, of a material that is white on both sides.
fn describe(shapes: Vec<ShapeDescription>) -> SceneDescription {
    let sensor = SensorDescription {
        name: "camera".into(),
        to_world: DAffine3::IDENTITY,
        fov_degrees: 40.0,
        fov_axis: FovAxis::X,
        width: 8,
        height: 8,
        filter: Filter::Box { radius: 0.5 },
        ..SensorDescription::default()
    };
    let white = Bsdf::Diffuse(Diffuse { reflectance: Rgb::splat(0.5).into() });
    let material = Material { name: "white".into(), front: white, back: Some(white), ..Material::default() };
    SceneDescription {
        sensors: vec![sensor],
        materials: vec![material],
        shapes,
        ..SceneDescription::default()
    }
}

fn build(shapes: Vec<ShapeDescription>) -> Scene {
    Scene::build(&describe(shapes)).expect("a sound description")
}

fn shape(geometry: Geometry, to_world: DAffine3) -> ShapeDescription {
    ShapeDescription {
        name: "shape".into(),
        geometry,
        to_world,
        flip_normals: false,
        material: 0,
        radiance: None,
    }
}

fn mesh(mesh: Mesh, to_world: DAffine3) -> ShapeDescription {
    shape(Geometry::Mesh(Arc::new(mesh)), to_world)
}

fn triangle(corners: [DVec3; 3]) -> ShapeDescription {
    let single = Mesh { positions: corners.to_vec(), triangles: vec![[0, 1, 2]], ..Mesh::default() };
    mesh(single, DAffine3::IDENTITY)
}

fn ball(centre: DVec3, radius: f64) -> ShapeDescription {
    shape(Geometry::Sphere { centre, radius }, DAffine3::IDENTITY)
}

/// A shape among two specks in opposite corners of the cube [−1, 1]³, which fix the scene's units. The shape has index 0.
fn in_unit_cube(shape: ShapeDescription) -> Scene {
    let speck = |side: f64| {
        let corner = DVec3::splat(side);
        triangle([corner, corner - DVec3::X * side * 1e-3, corner - DVec3::Y * side * 1e-3])
    };
    build(vec![shape, speck(-1.0), speck(1.0)])
}

/// A closed mesh close to the unit sphere: an octahedron, each face cut into n² that are moved onto the sphere. Corners are
/// not shared, but those in one place have the same bits.
fn geodesic(n: u32) -> Mesh {
    let mut mesh = Mesh::default();
    for octant in 0..8 {
        let side = |bit: u32| if octant & bit == 0 { 1.0 } else { -1.0 };
        let (x, y, z) = (DVec3::X * side(1), DVec3::Y * side(2), DVec3::Z * side(4));
        let outward = x.cross(y).dot(z) > 0.0;
        let point =
            |i: u32, j: u32| (x * f64::from(n - i - j) + y * f64::from(i) + z * f64::from(j)).normalize();
        let mut face = |[a, b, c]: [DVec3; 3]| {
            let first = mesh.positions.len() as u32;
            mesh.positions.extend(if outward { [a, b, c] } else { [a, c, b] });
            mesh.triangles.push([first, first + 1, first + 2]);
        };
        for i in 0..n {
            for j in 0..n - i {
                face([point(i, j), point(i + 1, j), point(i, j + 1)]);
                if i + j + 2 <= n {
                    face([point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)]);
                }
            }
        }
    }
    mesh
}

/// The same with the sphere's normals.
fn smooth_geodesic(n: u32) -> Mesh {
    let mut mesh = geodesic(n);
    mesh.normals.clone_from(&mesh.positions);
    mesh
}

/// A torus around +y that rests on y = 0.
fn ring(major: f64, minor: f64) -> Mesh {
    const AROUND: u32 = 64;
    const ACROSS: u32 = 32;
    let mut mesh = Mesh::default();
    for i in 0..AROUND {
        for j in 0..ACROSS {
            let around = TAU * f64::from(i) / f64::from(AROUND);
            let across = TAU * f64::from(j) / f64::from(ACROSS) - 0.5 * PI;
            let r = major + minor * across.cos();
            let height = minor + minor * across.sin();
            mesh.positions.push(DVec3::new(r * around.cos(), height, r * around.sin()));
            let at = |i: u32, j: u32| (i % AROUND) * ACROSS + j % ACROSS;
            let [a, b, c, d] = [at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)];
            mesh.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    mesh
}
