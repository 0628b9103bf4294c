//! What instances take: memory and time of a scene of 10,000 of them, the time until one has been moved, and rays against a few of them
//! and against as many meshes of their own, in turns.

use std::sync::Arc;
use std::time::Instant;

use foton_math::glam::{DAffine3, DQuat, DVec3};
use foton_math::{Purpose, Ray, Stream, warp};
use foton_scene::description::{
    Bsdf, Diffuse, Geometry, Material, Mesh, SceneDescription, SensorDescription, ShapeDescription,
};
use foton_scene::{BuildOptions, Instancing, Scene};

use super::rig;

/// Rows and columns of the ball: each pair is two triangles.
const ROWS: u32 = 224;

/// Instances along a side of the field.
const SIDE: u32 = 100;

/// Balls along a side of the field that is also built of meshes of their own.
const FEW: u32 = 4;

/// Rays of a round.
const RAYS: u64 = 300_000;

/// Rounds in turns.
const ROUNDS: usize = 7;

pub(crate) fn print() {
    let ball = Arc::new(bumpy_ball());
    let triangles = ball.triangles.len();
    let mut field = field(&ball, SIDE);
    let options = BuildOptions::default();
    let (scene, wall, cpu) = timed(|| Scene::build_with(&field, &options).expect("sound"));
    println!(
        "{} instances of {triangles} triangles: built in {wall:.2} s ({cpu:.2} s of the processor), {:.1} MiB",
        scene.census().instances,
        scene.bytes() as f64 / f64::from(1 << 20)
    );
    let middle = field.shapes.len() / 2;
    for _ in 0..3 {
        let moved = &mut field.shapes[middle].to_world;
        *moved = DAffine3::from_translation(DVec3::new(0.05, 0.0, 0.02)) * *moved;
        let (rebuilt, wall, cpu) = timed(|| scene.rebuild(&field, &options).expect("sound"));
        println!("one moved: {:.0} ms ({:.0} ms of the processor)", wall * 1e3, cpu * 1e3);
        drop(rebuilt);
    }
    drop(scene);
    let few = self::field(&ball, FEW);
    let ways = [Instancing::Never, Instancing::Always];
    let scenes = ways.map(|instancing| {
        let options = BuildOptions { instancing, ..BuildOptions::default() };
        Scene::build_with(&few, &options).expect("sound")
    });
    let mut seconds = [const { Vec::new() }; 2];
    for round in 0..ROUNDS {
        for (scene, seconds) in scenes.iter().zip(&mut seconds) {
            let (hits, _, cpu) = timed(|| hits(scene, round as u64));
            assert!(hits > 0);
            seconds.push(cpu);
        }
    }
    let [own, shared] = seconds.map(|s| rig::median(s.into_iter()));
    println!(
        "{} balls: {:.2} M rays/s of meshes of their own, {:.2} M rays/s of instances, {:.0} %",
        FEW * FEW,
        RAYS as f64 / own * 1e-6,
        RAYS as f64 / shared * 1e-6,
        100.0 * own / shared
    );
}

/// What something gives, and how long it took on the wall and on the processor.
fn timed<T>(what: impl FnOnce() -> T) -> (T, f64, f64) {
    let processor = || rig::processor_seconds(std::process::id()).unwrap_or_default();
    let (clock, before) = (Instant::now(), processor());
    let result = what();
    (result, clock.elapsed().as_secs_f64(), processor() - before)
}

/// Hits of rays through the field, each followed by one from where it hit.
fn hits(scene: &Scene, round: u64) -> u64 {
    let mut stream = Stream::new(22, Purpose::Test, 0, round);
    let (centre, radius) = (scene.bounds().centre(), scene.bounds().radius());
    let mut hits = 0;
    for _ in 0..RAYS / 2 {
        let from = centre + warp::square_to_sphere(stream.next_2d()) * radius;
        let to = centre + warp::square_to_sphere(stream.next_2d()) * radius * 0.7;
        let Some(surface) = scene.nearest(Ray::new(from, (to - from).normalize())) else { continue };
        let direction = warp::square_to_sphere(stream.next_2d());
        hits += 1 + u64::from(scene.nearest(Ray::new(surface.ray_origin(direction), direction)).is_some());
    }
    hits
}

fn bumpy_ball() -> Mesh {
    let point = |row: u32, column: u32| {
        let v = std::f64::consts::PI * f64::from(row) / f64::from(ROWS);
        let u = std::f64::consts::TAU * f64::from(column) / f64::from(ROWS);
        let r = 1.0 + 0.08 * (9.0 * u).sin() * (7.0 * v).sin() * v.sin();
        DVec3::new(v.sin() * u.cos(), v.cos(), v.sin() * u.sin()) * r
    };
    let mut mesh = Mesh::default();
    for row in 0..=ROWS {
        mesh.positions.extend((0..ROWS).map(|column| point(row, column)));
    }
    let at = |row: u32, column: u32| row * ROWS + column % ROWS;
    for row in 0..ROWS {
        for column in 0..ROWS {
            let [a, b] = [at(row, column), at(row, column + 1)];
            let [c, d] = [at(row + 1, column), at(row + 1, column + 1)];
            mesh.triangles.extend((row > 0).then_some([a, b, c]));
            mesh.triangles.extend((row + 1 < ROWS).then_some([b, d, c]));
        }
    }
    mesh
}

/// Balls of several sizes in a square of side 200, each turned another way.
fn field(ball: &Arc<Mesh>, side: u32) -> SceneDescription {
    let mut stream = Stream::new(22, Purpose::Test, 1, 0);
    let grey = Bsdf::Diffuse(Diffuse { reflectance: foton_math::Rgb::splat(0.5).into() });
    let sensor = SensorDescription {
        name: "camera".into(),
        to_world: DAffine3::IDENTITY,
        width: 8,
        height: 8,
        ..SensorDescription::default()
    };
    let step = 200.0 / f64::from(side);
    let mut shape = |i: u32| {
        let size = step * (0.2 + 0.25 * f64::from(stream.next_1d()));
        let turn = DQuat::from_rotation_y(f64::from(stream.next_1d()) * std::f64::consts::TAU);
        let place = DVec3::new(f64::from(i % side) * step, size, f64::from(i / side) * step);
        ShapeDescription {
            name: format!("ball-{i}"),
            geometry: Geometry::Mesh(Arc::clone(ball)),
            to_world: DAffine3::from_scale_rotation_translation(DVec3::splat(size), turn, place),
            flip_normals: false,
            material: 0,
            radiance: None,
        }
    };
    SceneDescription {
        sensors: vec![sensor],
        materials: vec![Material {
            name: "grey".into(),
            front: grey,
            back: Some(grey),
            ..Material::default()
        }],
        shapes: (0..side * side).map(&mut shape).collect(),
        ..SceneDescription::default()
    }
}
