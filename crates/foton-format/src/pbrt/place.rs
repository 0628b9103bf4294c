//! Shapes at their places in the world: each becomes one of the description, those of objects once for each instance.

use std::rc::Rc;
use std::sync::Arc;

use foton_math::Rgb;
use foton_math::glam::{DAffine3, DMat3, DVec2};
use foton_scene::description::{Colour, Geometry, Keyframes, Mesh, ShapeDescription};

use super::made::Coordinates;
use super::parameters::Kind;
use super::pictures::Wanted;
use super::reader::Reader;
use super::round::{Profile, Round};
use super::state::{Definition, Transforms};
use super::texture::Picture;
use super::waiting::{Body, Emission, Shape};
use crate::diagnostic::Place;
use crate::image::Purpose;
use crate::mitsuba::read::transform::even_scale;

/// How unevenly a round shape may be scaled.
const ROUNDNESS: f64 = 9e-5;
/// Bytes that a shape takes in a description, and in a scene.
const BYTES_PER_SHAPE: u64 = 600;

impl Reader<'_> {
    /// Puts a shape into the description: at its own place, or at that of an instance. Whether there is memory for more.
    pub(crate) fn place_shape(&mut self, shape: &Shape, instance: Option<Transforms>, name: String) -> bool {
        if !self.take(BYTES_PER_SHAPE + name.len() as u64, shape.place) {
            return false;
        }
        let around = instance.unwrap_or(Transforms::IDENTITY);
        let transforms = [0, 1].map(|i| around.0[i] * shape.transforms.0[i]);
        let (geometry, local, coordinates) = match &shape.body {
            Body::Mesh(mesh) => {
                let mesh = if mesh.texture_coordinates.is_empty() && has_textures(shape) {
                    let Some(unfolded) = self.unfolded(mesh, shape.place) else { return false };
                    unfolded
                } else {
                    Arc::clone(mesh)
                };
                (Geometry::Mesh(mesh), DAffine3::IDENTITY, Coordinates::Same)
            }
            Body::Round(round) => {
                let Some(found) = self.round_geometry(round, transforms, shape.place) else { return false };
                found
            }
        };
        let place = self.place_of_motion(transforms.map(|t| t * local), &geometry, shape.place);
        self.remember(&name, shape.place);
        let Some(material) = self.material(&shape.material, coordinates, shape.opacity.as_ref()) else {
            return true;
        };
        let mirrored = place.matrix3.determinant() < 0.0;
        let is_primitive = !matches!(geometry, Geometry::Mesh(_)) || matches!(shape.body, Body::Round(_));
        // A mirrored quadric of pbrt has its normals inside; what it emits it emits outside all the same.
        let flip_normals = shape.reverses != (mirrored && is_primitive && shape.emission.is_none());
        let radiance = shape
            .emission
            .as_ref()
            .and_then(|e| self.radiance(e, &geometry, &place, coordinates, shape.place));
        let two_sided = radiance.is_some() && shape.emission.as_ref().is_some_and(|e| e.two_sided);
        let described =
            ShapeDescription { name, geometry, to_world: place, flip_normals, material, radiance };
        if two_sided {
            let (name, flip_normals) = (format!("{}/back", described.name), !flip_normals);
            self.push_moving(ShapeDescription { name, flip_normals, ..described.clone() }, transforms, local);
        }
        self.push_moving(described, transforms, local);
        true
    }

    fn push_moving(&mut self, shape: ShapeDescription, transforms: [DAffine3; 2], local: DAffine3) {
        if transforms[0] != transforms[1] {
            let keyframes = [0, 1].map(|i| (self.times[i], transforms[i] * local)).to_vec();
            if let Some(keyframes) = Keyframes::new(keyframes) {
                self.description.motion.shapes.insert(self.description.shapes.len(), keyframes);
            }
        }
        self.description.shapes.push(shape);
    }

    /// Where something is when it begins to move; a warning where it cannot be moved.
    fn place_of_motion(&mut self, places: [DAffine3; 2], geometry: &Geometry, place: Place) -> DAffine3 {
        if places[0] != places[1] {
            let keyframes = [0, 1].map(|i| (self.times[i], places[i])).to_vec();
            let stays_round =
                matches!(geometry, Geometry::Mesh(_)) || even_scale(places[1].matrix3, ROUNDNESS).is_some();
            if Keyframes::new(keyframes).is_none() || !stays_round {
                let message = "what is mirrored or sheared does not move: this shape stands still".to_owned();
                self.report.warn_once(place, message);
            }
        }
        places[0]
    }

    /// A surface of revolution as a primitive where it stays one, else as triangles.
    fn round_geometry(
        &mut self,
        round: &Round,
        transforms: [DAffine3; 2],
        place: Place,
    ) -> Option<(Geometry, DAffine3, Coordinates)> {
        if let Some((geometry, local)) = round.primitive() {
            let stays_round = transforms.iter().all(|t| is_even(&geometry, (*t * local).matrix3));
            if stays_round {
                let coordinates = match geometry {
                    Geometry::Sphere { .. } => Coordinates::Sphere,
                    Geometry::Disc => Coordinates::Disc,
                    _ => Coordinates::Same,
                };
                return Some((geometry, local, coordinates));
            }
        }
        let key = round.key();
        if let Some(known) = self.round.get(&key) {
            return Some((Geometry::Mesh(Arc::clone(known)), DAffine3::IDENTITY, Coordinates::Same));
        }
        let what = match round.profile {
            Profile::Sphere { .. } => "a sphere that is stretched or cut",
            Profile::Disc { .. } => "a disk that is stretched or cut",
            Profile::Cylinder { .. } => "a cylinder that is stretched or cut",
            Profile::Cone { .. } => "a cone",
            Profile::Paraboloid { .. } => "a paraboloid",
            Profile::Hyperboloid { .. } => "a hyperboloid",
        };
        self.report.warn_once(place, format!("{what} becomes triangles"));
        if !self.take(round.mesh_bytes(), place) {
            return None;
        }
        let mesh = Arc::new(round.mesh());
        self.round.insert(key, Arc::clone(&mesh));
        Some((Geometry::Mesh(mesh), DAffine3::IDENTITY, Coordinates::Same))
    }

    /// The same triangles, each with the corners (0, 0), (1, 0) and (1, 1) of its own texture, as in pbrt where a mesh states none.
    fn unfolded(&mut self, mesh: &Arc<Mesh>, place: Place) -> Option<Arc<Mesh>> {
        if let Some((_, known)) = self.unfolded.get(&Arc::as_ptr(mesh)) {
            return Some(Arc::clone(known));
        }
        if !self.take(mesh.triangles.len() as u64 * 3 * 72, place) {
            return None;
        }
        const CORNERS: [DVec2; 3] = [DVec2::ZERO, DVec2::X, DVec2::ONE];
        let corners = || mesh.triangles.iter().flatten().map(|&i| i as usize);
        let normals =
            if mesh.normals.is_empty() { Vec::new() } else { corners().map(|i| mesh.normals[i]).collect() };
        let count = mesh.triangles.len() as u32;
        let unfolded = Arc::new(Mesh {
            positions: corners().map(|i| mesh.positions[i]).collect(),
            normals,
            texture_coordinates: CORNERS.repeat(count as usize),
            triangles: (0..count).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect(),
            attributes: Vec::new(),
        });
        self.unfolded.insert(Arc::as_ptr(mesh), (Arc::clone(mesh), Arc::clone(&unfolded)));
        Some(unfolded)
    }

    /// The radiance of a lamp of that shape.
    fn radiance(
        &mut self,
        emission: &Emission,
        geometry: &Geometry,
        to_world: &DAffine3,
        coordinates: Coordinates,
        place: Place,
    ) -> Option<Colour> {
        let mut radiance = emission.radiance;
        let mut mean = 1.0;
        if let Some(file) = &emission.picture {
            let bitmap = self.bitmap(file, Rgb::WHITE, Purpose::Light)?;
            mean = bitmap.pixels.iter().map(|p| f64::from(p.luminance())).sum::<f64>()
                / bitmap.pixels.len() as f64;
        }
        if let Some(power) = emission.power {
            let sides = if emission.two_sided { 2.0 } else { 1.0 };
            let emitted = mean * sides * area(geometry, to_world) * std::f64::consts::PI;
            radiance *= (power / emitted) as f32;
        }
        if !radiance.is_finite() {
            self.report.error(place, "what this shape emits is too much for a number");
            return None;
        }
        let Some(file) = &emission.picture else { return (!radiance.is_black()).then(|| radiance.into()) };
        let picture = Rc::new(Picture::Image(file.clone()));
        self.made(&picture, Wanted { purpose: Purpose::Light, factor: radiance, coordinates, place })
    }
}

/// Whether a transform leaves a primitive what it is.
fn is_even(geometry: &Geometry, m: DMat3) -> bool {
    // A disc lies in the plane: where its normal goes follows from that.
    let m = if matches!(geometry, Geometry::Disc) {
        let normal = m.x_axis.cross(m.y_axis).normalize_or_zero() * m.x_axis.length();
        DMat3::from_cols(m.x_axis, m.y_axis, normal)
    } else {
        m
    };
    even_scale(m, ROUNDNESS).is_some()
}

/// Whether a shape's material or its opacity is a picture.
fn has_textures(shape: &Shape) -> bool {
    fn is_textured(definition: &Definition) -> bool {
        let of_pictures = |name: &str| matches!(name, "normalmap");
        definition.parameters.list.iter().any(|p| p.kind == Kind::Texture || of_pictures(&p.name))
            || definition.parts.iter().any(|part| is_textured(part))
    }
    is_textured(&shape.material)
        || shape.opacity.as_ref().is_some_and(|o| o.constant().is_none())
        || shape.emission.as_ref().is_some_and(|e| e.picture.is_some())
}

/// The area of a surface in the world.
fn area(geometry: &Geometry, to_world: &DAffine3) -> f64 {
    use std::f64::consts::PI;
    let scale = to_world.matrix3.x_axis.length();
    let square = scale * scale;
    match geometry {
        Geometry::Sphere { radius, .. } => 4.0 * PI * radius * radius * square,
        Geometry::Disc => PI * square,
        Geometry::Cylinder { from, to, radius } => 2.0 * PI * radius * (*to - *from).length() * square,
        Geometry::Mesh(mesh) => {
            let of = |t: &[u32; 3]| {
                let [a, b, c] = t.map(|i| to_world.transform_point3(mesh.positions[i as usize]));
                0.5 * (b - a).cross(c - a).length()
            };
            mesh.triangles.iter().map(of).sum()
        }
    }
}
