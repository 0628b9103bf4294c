//! What lies under a film position: a surface, or the marker of a light without one.

use foton_math::glam::{DVec2, DVec3, Vec2};
use foton_scene::Scene;
use foton_scene::description::{EmitterKind, SceneDescription};

use super::light::kind_name;
use super::target::Target;
use super::view::View;

/// How far from a light's marker a click still means it, in pixels.
pub const MARKER_REACH: f64 = 10.0;

/// What a person clicked.
#[derive(Clone, Debug, PartialEq)]
pub struct Picked {
    /// What it is.
    pub target: Target,
    /// Its name in the scene file.
    pub name: String,
    /// The name of its material; for a light its kind.
    pub material: String,
    /// Where it was met, in world units; for directional light a point in its direction.
    pub position: [f64; 3],
    /// From the camera, in world units.
    pub distance: f64,
    /// Unit normal on the outside; towards the camera for a light.
    pub normal: [f64; 3],
}

/// The first surface through a film position in pixels, (0, 0) being the whole image's top left corner. Glass counts.
#[must_use]
pub fn pick(scene: &Scene, sensor: usize, film: [f64; 2]) -> Option<Picked> {
    let ray = scene.sensors().get(sensor)?.ray_of_whole(DVec2::from(film).as_vec2());
    let surface = scene.nearest(ray)?;
    let shape = &scene.shapes()[surface.shape as usize];
    let to_world = scene.normalisation();
    let position = to_world.world_point(surface.position);
    Some(Picked {
        target: Target::Shape(surface.shape as usize),
        name: shape.name.clone(),
        material: scene.material(surface.shape).name.clone(),
        position: position.to_array(),
        distance: position.distance(to_world.world_point(ray.origin)),
        normal: surface.normal.as_dvec3().to_array(),
    })
}

/// The light without a surface whose marker is nearest to a film position, within [`MARKER_REACH`].
#[must_use]
pub fn pick_light(description: &SceneDescription, sensor: usize, film: [f64; 2]) -> Option<Picked> {
    let view = View::new(description.sensors.get(sensor)?);
    let reach = |at: DVec2| at.distance(film.into());
    let (index, at) = (0..description.emitters.len())
        .filter_map(|i| Some((i, marker_position(description, i, &view)?)))
        .filter(|(_, at)| reach(*at) <= MARKER_REACH)
        .min_by(|a, b| reach(a.1).total_cmp(&reach(b.1)))?;
    let emitter = &description.emitters[index];
    let position = emitter.kind.position().unwrap_or_else(|| {
        let (eye, direction) = view.ray(at);
        eye + direction
    });
    let away = position - view.eye_of(position);
    Some(Picked {
        target: Target::Emitter(index),
        name: emitter.name.clone(),
        material: kind_name(&emitter.kind).to_owned(),
        position: position.to_array(),
        distance: away.length(),
        normal: (-away).normalize_or_zero().to_array(),
    })
}

/// A light's marker if there is one here, or else the first surface.
#[must_use]
pub fn pick_any(
    scene: &Scene,
    description: &SceneDescription,
    sensor: usize,
    film: [f64; 2],
) -> Option<Picked> {
    pick_light(description, sensor, film).or_else(|| pick(scene, sensor, film))
}

/// The distance from a camera to what it looks at: the surface in the middle of its image, or else the scene's middle.
#[must_use]
pub fn focus_distance(scene: &Scene, sensor: usize) -> f64 {
    let Some(s) = scene.sensors().get(sensor) else { return 1.0 };
    let window = s.window();
    let middle =
        Vec2::new(window.x as f32 + 0.5 * window.width as f32, window.y as f32 + 0.5 * window.height as f32);
    if let Some(picked) = pick(scene, sensor, middle.as_dvec2().to_array()) {
        return picked.distance;
    }
    let (ray, bounds) = (s.ray_of_whole(middle), scene.bounds());
    let ahead = (bounds.centre() - ray.origin).dot(ray.direction).max(0.1 * bounds.radius());
    scene.normalisation().world_length(f64::from(ahead))
}

/// Where the marker of a light stands; a directional light's where its light comes from.
pub(crate) fn marker_position(description: &SceneDescription, emitter: usize, view: &View) -> Option<DVec2> {
    let visible = |at: &DVec2| at.cmpge(DVec2::ZERO).all() && at.cmple(view.film).all();
    let kind = &description.emitters.get(emitter)?.kind;
    let at = match (kind.position(), kind) {
        (Some(position), _) => view.project(position),
        (None, EmitterKind::Directional { direction, .. }) => view.project_direction(-*direction),
        (None, _) => None,
    };
    at.filter(visible)
}

/// A point of a surface or light that stands for the whole of it, in world units; `None` for light from infinity.
#[must_use]
pub fn anchor(description: &SceneDescription, target: Target) -> Option<DVec3> {
    match target {
        Target::Shape(i) => Some(super::geometry::centre(description.shapes.get(i)?)),
        Target::Emitter(i) => description.emitters.get(i)?.kind.position(),
        Target::Sensor(_) => None,
    }
}
