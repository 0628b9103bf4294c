//! The outline of a chosen shape or light as lines on the film.
//!
//! A mesh shows its silhouette: edges between a face that looks at the camera and one that does not, and edges of one
//! face alone. Which faces share an edge is found once, when the shape is chosen; a line at a time is projected while it
//! moves. Hidden parts are drawn, too: the outline says what is chosen, not what is seen.

use std::collections::HashMap;
use std::f64::consts::TAU;
use std::sync::Arc;

use foton_math::glam::{DAffine3, DVec2, DVec3};
use foton_scene::description::{Geometry, Mesh, SceneDescription, ShapeDescription};

use super::geometry::object_bounds;
use super::pick::marker_position;
use super::target::Target;
use super::view::View;

/// A line on the film, in pixels from its top left corner; both ends at most one film's size outside.
pub type Segment = [[f32; 2]; 2];

/// Meshes of more triangles show their bounds instead.
const MAX_TRIANGLES: usize = 200_000;
/// Lines of a circle.
const CIRCLE: usize = 64;
/// Half the size of a light's marker in pixels.
const MARKER: f64 = 7.0;

/// What an outline needs to know of a mesh, whatever its place and the camera.
#[derive(Clone, Debug)]
struct Edges {
    mesh: Arc<Mesh>,
    /// Two vertices, and the faces on both sides; the same one twice where there is only one.
    edges: Vec<[u32; 4]>,
}

/// A chosen thing's outline.
#[derive(Clone, Debug)]
pub struct Outline {
    target: Target,
    edges: Option<Edges>,
}

impl Outline {
    /// Prepares the outline of a shape or light: tens of milliseconds for a mesh of 100,000 triangles.
    #[must_use]
    pub fn new(description: &SceneDescription, target: Target) -> Self {
        let mut edges = None;
        if let Target::Shape(index) = target
            && let Some(Geometry::Mesh(mesh)) = description.shapes.get(index).map(|s| &s.geometry)
            && mesh.triangles.len() <= MAX_TRIANGLES
        {
            edges = Some(Edges { mesh: Arc::clone(mesh), edges: shared_edges(mesh) });
        }
        Self { target, edges }
    }

    /// Whose outline it is.
    #[must_use]
    pub const fn target(&self) -> Target {
        self.target
    }

    /// The lines, as a camera sees the thing where the description has it now. None for what has no place on the film.
    #[must_use]
    pub fn segments(&self, description: &SceneDescription, sensor: usize) -> Vec<Segment> {
        let Some(view) = description.sensors.get(sensor).map(View::new) else { return Vec::new() };
        match self.target {
            Target::Shape(index) => {
                description.shapes.get(index).map_or_else(Vec::new, |shape| self.shape(shape, &view))
            }
            Target::Emitter(index) => {
                marker_position(description, index, &view).map_or_else(Vec::new, marker)
            }
            // Who looks through it sees none of it, and where others are is not drawn.
            Target::Sensor(_) => Vec::new(),
        }
    }

    fn shape(&self, shape: &ShapeDescription, view: &View) -> Vec<Segment> {
        let m = &shape.to_world;
        match &shape.geometry {
            Geometry::Mesh(mesh) => match &self.edges {
                Some(edges) if Arc::ptr_eq(mesh, &edges.mesh) => silhouette(edges, m, view),
                _ => bounds(&shape.geometry, m, view),
            },
            Geometry::Sphere { centre, radius } => {
                let centre = m.transform_point3(*centre);
                sphere(centre, radius * m.matrix3.x_axis.length(), view)
            }
            Geometry::Disc => circle(m.translation, m.matrix3.x_axis, m.matrix3.y_axis, view),
            Geometry::Cylinder { from, to, radius } => {
                let [from, to] = [from, to].map(|p| m.transform_point3(*p));
                tube(from, to, radius * m.matrix3.x_axis.length(), view)
            }
        }
    }
}

/// The markers of all lights without a surface, each with its target.
#[must_use]
pub fn markers(description: &SceneDescription, sensor: usize) -> Vec<(Target, Vec<Segment>)> {
    let Some(view) = description.sensors.get(sensor).map(View::new) else { return Vec::new() };
    let all = (0..description.emitters.len()).filter(|i| !description.hidden.emitters.contains(i));
    all.filter_map(|i| Some((Target::Emitter(i), marker(marker_position(description, i, &view)?)))).collect()
}

/// A square on its corner with a ray at each.
fn marker(at: DVec2) -> Vec<Segment> {
    let corners = [DVec2::X, DVec2::Y, DVec2::NEG_X, DVec2::NEG_Y];
    let line = |a: DVec2, b: DVec2| [(at + a).as_vec2().to_array(), (at + b).as_vec2().to_array()];
    let rays = corners.map(|c| line(c * MARKER, c * (1.6 * MARKER)));
    let sides = [0, 1, 2, 3].map(|i| line(corners[i] * MARKER, corners[(i + 1) % 4] * MARKER));
    [sides, rays].concat()
}

/// Pairs the faces along edges. Vertices at the same place are one: files split them where normals or textures break.
fn shared_edges(mesh: &Mesh) -> Vec<[u32; 4]> {
    let mut places = HashMap::with_capacity(mesh.positions.len());
    let key = |p: &DVec3| p.to_array().map(|x| (x + 0.0).to_bits());
    let welded: Vec<u32> =
        (0u32..).zip(&mesh.positions).map(|(i, p)| *places.entry(key(p)).or_insert(i)).collect();
    let mut sides: Vec<([u32; 2], u32)> = Vec::with_capacity(mesh.triangles.len() * 3);
    for (face, triangle) in (0u32..).zip(&mesh.triangles) {
        let Some([a, b, c]) = corners(triangle, &welded) else { continue };
        sides.extend([[a, b], [b, c], [c, a]].map(|[a, b]| ([a.min(b), a.max(b)], face)));
    }
    sides.sort_unstable();
    // Of the faces along an edge the outermost two; one alone is on both sides.
    let along = sides.chunk_by(|(a, _), (b, _)| a == b);
    along.map(|faces| [faces[0].0[0], faces[0].0[1], faces[0].1, faces[faces.len() - 1].1]).collect()
}

/// A triangle's corners after welding, unless it names vertices that are not there or has lost a side.
fn corners(triangle: &[u32; 3], welded: &[u32]) -> Option<[u32; 3]> {
    let mut found = [0; 3];
    for (corner, i) in found.iter_mut().zip(triangle) {
        *corner = *welded.get(*i as usize)?;
    }
    let [a, b, c] = found;
    (a != b && b != c && c != a).then_some(found)
}

fn silhouette(Edges { mesh, edges }: &Edges, to_world: &DAffine3, view: &View) -> Vec<Segment> {
    let positions: Vec<DVec3> = mesh.positions.iter().map(|p| to_world.transform_point3(*p)).collect();
    let at = |i: u32| positions.get(i as usize).copied().unwrap_or_default();
    let faces_camera: Vec<bool> = mesh
        .triangles
        .iter()
        .map(|t| {
            let [a, b, c] = t.map(at);
            (b - a).cross(c - a).dot(view.sight(a)) < 0.0
        })
        .collect();
    let facing = |face: u32| faces_camera[face as usize];
    let seen = edges.iter().filter(|[_, _, f, g]| f == g || facing(*f) != facing(*g));
    seen.filter_map(|[a, b, ..]| view.segment(at(*a), at(*b))).collect()
}

fn bounds(geometry: &Geometry, to_world: &DAffine3, view: &View) -> Vec<Segment> {
    let (min, max) = object_bounds(geometry);
    let corner = |i: usize| {
        let pick = |bit: usize, axis: usize| if i & bit == 0 { min[axis] } else { max[axis] };
        to_world.transform_point3(DVec3::new(pick(1, 0), pick(2, 1), pick(4, 2)))
    };
    let edges = (0..8).flat_map(|i| [1, 2, 4].map(|bit| (i, i | bit))).filter(|(i, j)| i != j);
    edges.filter_map(|(i, j)| view.segment(corner(i), corner(j))).collect()
}

/// Where lines of sight touch the sphere: a circle before its middle. Nothing from inside.
fn sphere(centre: DVec3, radius: f64, view: &View) -> Vec<Segment> {
    let away = centre - view.eye_of(centre);
    let distance = away.length();
    if distance <= radius {
        return Vec::new();
    }
    let sine = if view.is_parallel() { 0.0 } else { radius / distance };
    let (x, y) = (away / distance).any_orthonormal_pair();
    let r = radius * (1.0 - sine * sine).sqrt();
    circle(centre - away * (sine * sine), x * r, y * r, view)
}

fn circle(centre: DVec3, x: DVec3, y: DVec3, view: &View) -> Vec<Segment> {
    let at = |i: usize| {
        let (sin, cos) = (TAU * i as f64 / CIRCLE as f64).sin_cos();
        centre + x * cos + y * sin
    };
    (0..CIRCLE).filter_map(|i| view.segment(at(i), at(i + 1))).collect()
}

/// Both ends, and the two lines where lines of sight touch it.
fn tube(from: DVec3, to: DVec3, radius: f64, view: &View) -> Vec<Segment> {
    let Some(axis) = (to - from).try_normalize() else { return Vec::new() };
    let (x, y) = axis.any_orthonormal_pair();
    let mut lines = circle(from, x * radius, y * radius, view);
    lines.extend(circle(to, x * radius, y * radius, view));
    let away = view.eye_of(from) - from;
    let across = away - axis * away.dot(axis);
    let distance = across.length();
    if distance > radius {
        let (u, cos) = (across / distance, if view.is_parallel() { 0.0 } else { radius / distance });
        let w = axis.cross(u) * (1.0 - cos * cos).sqrt();
        let sides = [u * cos + w, u * cos - w].map(|side| side * radius);
        lines.extend(sides.iter().filter_map(|side| view.segment(from + *side, to + *side)));
    }
    lines
}
