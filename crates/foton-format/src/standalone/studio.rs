//! What a model lacks to be a scene: a camera, and light.
//!
//! - Camera: 45° wide, as near as it can be with the whole model in view. Normally it looks from three quarters in
//!   front and above. A model that emits light, or that is a box open to one side (at least four of the other five faces
//!   of its bounds are at least half covered by triangles), is looked at straight through its open side: the first one
//!   of front (+z), right, back and left that is not covered.
//! - Light: only if nothing in the file emits. Above the model, or under the lid of a box; with it a dim sky and, outside
//!   of boxes, a floor.
//!   A scene with a camera of its own gets no floor.

use std::collections::HashMap;

use foton_math::Rgb;
use foton_math::glam::{DAffine3, DMat3, DVec3};
use foton_scene::description::{
    Colour, EmitterDescription, EmitterKind, FovAxis, Geometry, Mesh, SceneDescription, SensorDescription,
};

use super::shapes::add_shape;
use crate::diagnostic::{Place, Report};

/// Field of view along the shorter side of the image.
const FOV_DEGREES: f64 = 45.0;
/// Share of the image's half that the model may fill.
const FILL: f64 = 0.95;
/// How near to a face of the bounds a triangle covers it, as a share of the bounds' extent.
const COVERING: f64 = 0.05;
/// Irradiance that the default light brings to the middle of the model: a white surface there has radiance 1.
const KEY_IRRADIANCE: f64 = std::f64::consts::PI;
/// Of models of more triangles, instances counted, boxes around their meshes are looked at.
const MANY: usize = 4_000_000;
/// Names of the shapes that are added.
pub(super) const ADDED: [&str; 2] = ["default-light", "default-floor"];
/// Radiance of the default sky.
const SKY: f32 = 0.2;

/// How a model stands; right × up = front.
#[derive(Clone, Copy)]
pub(crate) struct Axes {
    pub(crate) right: DVec3,
    pub(crate) up: DVec3,
    pub(crate) front: DVec3,
}

impl Axes {
    /// +y up, +z towards the viewer.
    pub(crate) const Y_UP: Self = Self { right: DVec3::X, up: DVec3::Y, front: DVec3::Z };
}

/// Adds a camera and light to a scene where it has none; `file` is what a warning calls it.
///
/// # Errors
/// Where there is nothing to look at.
pub(crate) fn complete(
    scene: &mut SceneDescription,
    axes: Axes,
    file: &str,
    report: &mut Report,
) -> Result<(), String> {
    let has_camera = !scene.sensors.is_empty();
    let is_lit = !scene.emitters.is_empty() || scene.shapes.iter().any(|s| s.radiance.is_some());
    if has_camera && is_lit && !scene.shapes.is_empty() {
        return Ok(());
    }
    let model = Model::of(scene, axes).ok_or_else(|| "the model has no extent".to_owned())?;
    if !has_camera {
        model.add_camera(scene, file, report);
    }
    if !is_lit {
        model.add_light(scene, !has_camera, report);
    }
    Ok(())
}

/// A mesh where it stands.
struct Placed<'a> {
    mesh: &'a Mesh,
    to_world: DAffine3,
}

impl Placed<'_> {
    /// The corners of its triangles that have an area, in the world.
    fn triangles(&self) -> impl Iterator<Item = [DVec3; 3]> {
        let Self { mesh, to_world } = self;
        let corner = |i: u32| to_world.transform_point3(mesh.positions[i as usize]);
        mesh.triangles.iter().filter(|t| mesh.has_area(**t)).map(move |t| t.map(corner))
    }

    fn corners(&self) -> impl Iterator<Item = DVec3> {
        self.triangles().flatten()
    }
}

/// The corners of the bounds of points; `None` where there are none.
fn bounds(points: impl Iterator<Item = DVec3>) -> Option<(DVec3, DVec3)> {
    points.map(|p| (p, p)).reduce(|(low, high), (p, q)| (low.min(p), high.max(q)))
}

/// The bounds of the boxes around meshes, each mesh gone through once, however often it stands there.
fn boxes(meshes: &[Placed<'_>]) -> Option<(DVec3, DVec3)> {
    let mut known: HashMap<*const Mesh, Option<(DVec3, DVec3)>> = HashMap::new();
    let corners = meshes.iter().flat_map(|Placed { mesh, to_world }| {
        let alone = || bounds(Placed { mesh, to_world: DAffine3::IDENTITY }.corners());
        let own = *known.entry(std::ptr::from_ref(*mesh)).or_insert_with(alone);
        let corner = |(low, high): (DVec3, DVec3), i: i32| {
            let side = |bit: i32, low: f64, high: f64| if i & bit == 0 { low } else { high };
            DVec3::new(side(1, low.x, high.x), side(2, low.y, high.y), side(4, low.z, high.z))
        };
        own.into_iter().flat_map(move |own| (0..8).map(move |i| to_world.transform_point3(corner(own, i))))
    });
    bounds(corners)
}

/// What is to be looked at and lit.
struct Model {
    axes: Axes,
    low: DVec3,
    high: DVec3,
    /// The side through which it is looked into, if it is a box.
    open_side: Option<DVec3>,
}

impl Model {
    /// `None` if it is a point or nothing at all.
    fn of(scene: &SceneDescription, axes: Axes) -> Option<Self> {
        let meshes: Vec<Placed<'_>> = scene
            .shapes
            .iter()
            .filter_map(|s| match &s.geometry {
                Geometry::Mesh(mesh) => Some(Placed { mesh, to_world: s.to_world }),
                _ => None,
            })
            .collect();
        let triangles: usize = meshes.iter().map(|m| m.mesh.triangles.len()).sum();
        let is_large = triangles > MANY;
        let (low, high) =
            if is_large { boxes(&meshes)? } else { bounds(meshes.iter().flat_map(Placed::corners))? };
        let emits = scene.shapes.iter().any(|s| s.radiance.is_some());
        let mut model = Self { axes, low, high, open_side: None };
        if !(model.size().max_element() > 0.0 && model.size().is_finite()) {
            return None;
        }
        let Axes { right, up, front } = axes;
        if is_large && meshes.len() > 1 {
            model.open_side = emits.then_some(front);
            return Some(model);
        }
        let sides =
            [front, right, -front, -right, up, -up].map(|side| (side, model.is_covered(side, &meshes)));
        let open = sides[..4].iter().find(|(_, covered)| !covered).map(|(side, _)| *side);
        let covered = sides.iter().filter(|(_, covered)| *covered).count();
        model.open_side = if covered >= 4 { open } else { None };
        if emits {
            model.open_side = Some(open.unwrap_or(front));
        }
        Some(model)
    }

    fn size(&self) -> DVec3 {
        self.high - self.low
    }

    fn centre(&self) -> DVec3 {
        0.5 * (self.low + self.high)
    }

    /// The middle of the face of the bounds that looks in a direction along an axis.
    fn face(&self, direction: DVec3) -> DVec3 {
        self.centre() + 0.5 * self.size() * direction
    }

    /// Whether triangles near that face of the bounds make up half of its area.
    fn is_covered(&self, side: DVec3, meshes: &[Placed<'_>]) -> bool {
        let depth = side.abs().dot(self.size());
        let plane = side.dot(self.face(side));
        let near = |p: DVec3| plane - side.dot(p) <= COVERING * depth;
        let area: f64 = meshes
            .iter()
            .flat_map(Placed::triangles)
            .filter(|corners| corners.iter().all(|&p| near(p)))
            .map(|[a, b, c]| 0.5 * (b - a).cross(c - a).dot(side).abs())
            .sum();
        let across = DVec3::ONE - side.abs();
        let extents = (self.size() * across + side.abs()).element_product();
        area >= 0.5 * extents && extents > 0.0
    }

    fn add_camera(&self, scene: &mut SceneDescription, file: &str, report: &mut Report) {
        let (width, height) = (768, 576);
        let Axes { right, up, front } = self.axes;
        let (towards_viewer, place) = match self.open_side {
            Some(side) => (side, "straight in front"),
            None => ((front + 0.7 * right + 0.5 * up).normalize(), "three quarters in front"),
        };
        let forward = -towards_viewer;
        let left = up.cross(forward).normalize();
        let up = forward.cross(left);
        let tangent = (0.5 * FOV_DEGREES).to_radians().tan() * FILL;
        let wide = tangent * f64::from(width) / f64::from(height);
        let distance = (0..8)
            .map(|corner| {
                let side = |bit: i32| if corner & bit == 0 { -0.5 } else { 0.5 };
                let p = DVec3::new(side(1), side(2), side(4)) * self.size();
                (p.dot(left).abs() / wide).max(p.dot(up).abs() / tangent) - p.dot(forward)
            })
            .fold(0.0, f64::max);
        let origin = self.centre() - distance * forward;
        scene.sensors.push(SensorDescription {
            name: "sensor".to_owned(),
            to_world: DAffine3::from_mat3_translation(DMat3::from_cols(left, up, forward), origin),
            fov_degrees: FOV_DEGREES,
            fov_axis: FovAxis::Smaller,
            width,
            height,
            ..SensorDescription::default()
        });
        report.warning(Place::default(), format!("{file} has no camera: one is placed {place}"));
    }

    fn add_light(&self, scene: &mut SceneDescription, has_floor: bool, report: &mut Report) {
        let Axes { right, up, front } = self.axes;
        let height = self.size().dot(up.abs());
        let length = self.size().length();
        let (floor, centre) = (self.face(-up).dot(up), self.centre());
        let (at, half) = if self.open_side.is_some() {
            (floor + 0.95 * height, 0.125 * self.size().dot(right.abs()).min(self.size().dot(front.abs())))
        } else {
            (centre.dot(up) + 1.25 * length, 0.375 * length)
        };
        let half = if half > 0.0 { half } else { 0.05 * length };
        let along = |height: f64| centre + (height - centre.dot(up)) * up;
        let distance = (at - centre.dot(up)).max(half);
        let radiance = (KEY_IRRADIANCE * distance * distance / (4.0 * half * half)) as f32;
        let down = DMat3::from_cols(half * right, half * front, -half * up);
        let light = DAffine3::from_mat3_translation(down, along(at));
        add_rectangle(ADDED[0], light, Some(Rgb::splat(radiance)), scene);
        let kind = EmitterKind::Constant { radiance: Rgb::splat(SKY) };
        scene.emitters.push(EmitterDescription { name: "default-sky".to_owned(), kind });
        let mut added = "a light and a dim sky";
        if self.open_side.is_none() && has_floor {
            let side = 10.0 * length;
            let flat = DMat3::from_cols(side * right, -side * front, side * up);
            // A little lower, so that it does not coincide with the model's own bottom.
            let floor = DAffine3::from_mat3_translation(flat, along(floor - 1e-4 * length));
            add_rectangle(ADDED[1], floor, None, scene);
            added = "a light, a dim sky and a floor";
        }
        report.warning(Place::default(), format!("nothing in the file emits light: {added} are added"));
    }
}

fn add_rectangle(name: &str, to_world: DAffine3, radiance: Option<Rgb>, scene: &mut SceneDescription) {
    add_shape(name, Mesh::rectangle(), None, scene);
    if let Some(shape) = scene.shapes.last_mut() {
        shape.to_world = to_world;
        shape.radiance = radiance.map(Colour::from);
    }
}
