//! What is drawn over the picture: the photons of the last pass, and the disc of the pixel that a person points at.

use std::f64::consts::TAU;
use std::sync::Arc;

use foton_edit::Segment;
use foton_integrator::{Disc, PhotonPath, Render};
use foton_math::Ray;
use foton_math::glam::{DVec3, Vec2};
use foton_scene::{Scene, Sensor};

use super::frame::{DrawnPath, Probe, SurfaceNames};
use crate::dots::{dot, pixel_in};

/// Photons drawn in a disc at most.
const DISC_DOTS: usize = 2_000;

/// Paths drawn at most.
const PATHS: usize = 64;

/// Corners of a disc's outline.
const CORNERS: u32 = 48;

/// What is known of a pixel of the whole image; `None` outside what is rendered.
pub(super) fn probe(render: &Render, pixel: [u32; 2]) -> Option<Probe> {
    let scene = render.scene();
    let sensor = &scene.sensors()[render.settings().sensor];
    let film = Vec2::new(pixel[0] as f32 + 0.5, pixel[1] as f32 + 0.5);
    let [x, y] = pixel_in(&sensor.window(), film)?;
    let index = y as usize * sensor.width as usize + x as usize;
    let discs = render.discs(index);
    let first = discs.first();
    let photons = first.map_or_else(Vec::new, |d| render.photons_near(d.position, d.radius, DISC_DOTS));
    Some(Probe {
        pixel,
        radiance: render.radiance(index),
        radius: (!discs.is_empty()).then(|| discs.iter().map(|d| d.radius).sum::<f64>() / discs.len() as f64),
        photons_found: discs.iter().map(|d| d.photons_found).sum(),
        hit_points: discs.len(),
        distance: first.map(|d| distance(scene, sensor, d.position)),
        surface: surface(scene, sensor.ray_of_whole(film)),
        disc: first.map_or_else(Vec::new, |d| outline(scene, render.settings().sensor, d)),
        photons: photons.iter().filter_map(|p| dot(render, p, false)).collect(),
        paths: Arc::default(),
    })
}

/// From where a sensor's line of sight to a point begins, in world units.
fn distance(scene: &Scene, sensor: &Sensor, world: DVec3) -> f64 {
    let to_world = scene.normalisation();
    world.distance(to_world.world_point(sensor.eye_of(to_world.point(world))))
}

/// Paths of photons that lit a pixel of the whole image, as the camera sees them.
pub(super) fn paths(render: &Render, pixel: [u32; 2]) -> Vec<DrawnPath> {
    let scene = render.scene();
    let sensor = &scene.sensors()[render.settings().sensor];
    let film = Vec2::new(pixel[0] as f32 + 0.5, pixel[1] as f32 + 0.5);
    let Some([x, y]) = pixel_in(&sensor.window(), film) else { return Vec::new() };
    let project = |world: DVec3| {
        sensor.project_on_whole(scene.normalisation().point(world)).map(|(film, _)| film.to_array())
    };
    let draw = |path: PhotonPath| {
        let edges = path.points.windows(2).filter_map(|ends| edge(ends[0], ends[1], &project));
        DrawnPath { edges: edges.collect(), class: path.class }
    };
    render.paths_to(y as usize * sensor.width as usize + x as usize, PATHS).into_iter().map(draw).collect()
}

/// An edge on the film as far as it is before the camera.
fn edge(a: DVec3, b: DVec3, project: &dyn Fn(DVec3) -> Option<[f32; 2]>) -> Option<Segment> {
    let (a, b) = match (project(a), project(b)) {
        (Some(a), Some(b)) => return Some([a, b]),
        (Some(_), None) => (a, b),
        (None, Some(_)) => (b, a),
        (None, None) => return None,
    };
    // Halves what is seen and what is not until the edge of that is a pixel or so away.
    let (mut seen, mut unseen) = (0.0, 1.0);
    for _ in 0..24 {
        let middle = 0.5 * (seen + unseen);
        if project(a.lerp(b, middle)).is_some() {
            seen = middle;
        } else {
            unseen = middle;
        }
    }
    Some([project(a)?, project(a.lerp(b, seen))?])
}

fn surface(scene: &Scene, ray: Ray) -> Option<SurfaceNames> {
    let hit = scene.nearest(ray)?;
    let shape = scene.shapes().get(hit.shape as usize)?;
    Some(SurfaceNames { shape: shape.name.clone(), material: scene.material(hit.shape).name.clone() })
}

/// The edge of a disc in pixels; empty where a part of it is behind the camera.
fn outline(scene: &Scene, sensor: usize, disc: &Disc) -> Vec<[f32; 2]> {
    let tangent = disc.normal.any_orthonormal_vector();
    let bitangent = disc.normal.cross(tangent);
    let corner = |i: u32| -> Option<[f32; 2]> {
        let (sin, cos) = (TAU * f64::from(i) / f64::from(CORNERS)).sin_cos();
        let point: DVec3 = disc.position + (tangent * cos + bitangent * sin) * disc.radius;
        let (film, _) = scene.sensors()[sensor].project_on_whole(scene.normalisation().point(point))?;
        Some(film.to_array())
    };
    (0..CORNERS).map(corner).collect::<Option<_>>().unwrap_or_default()
}
