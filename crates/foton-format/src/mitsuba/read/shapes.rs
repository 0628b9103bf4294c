//! `<shape>` elements: meshes, rectangle, cube, sphere, disk and cylinder, each with its material and emission.

use std::f64::consts::TAU;
use std::sync::Arc;

use foton_math::glam::{DAffine3, DMat3, DVec2, DVec3};
use foton_scene::description::{Colour, Geometry, Keyframes, Mesh, ShapeDescription};
use foton_scene::plugins::shapes::{
    self, CENTER, FACE_NORMALS, FILENAME, FLIP_NORMALS, FLIP_TEX_COORDS, P0, P1, RADIUS, SHAPE_INDEX,
    TO_WORLD,
};

use crate::diagnostic::Place;
use crate::mesh::wanted::{Format, Wanted};
use crate::mitsuba::document::NodeId;
use crate::mitsuba::names::SHAPES;
use crate::mitsuba::read::properties::Properties;
use crate::mitsuba::read::reader::Reader;
use crate::mitsuba::read::transform::even_scale;

/// How unevenly a sphere or a disk may be scaled: rounding of numbers in files, and a little less than the scene allows.
const ROUNDNESS: f64 = 9e-5;

/// Triangles of a disk that is not round.
const SECTORS: u32 = 512;

impl Reader<'_> {
    /// Reads a shape; nothing is added where its surface is not valid.
    pub(crate) fn shape(&mut self, node: NodeId) {
        let Some(element) = self.document.element(node) else { return };
        let Some(plugin) = self.plugin(element, &SHAPES) else {
            // What is inside may have problems of its own.
            let mut p = self.properties(node, "shape");
            self.surface(&mut p);
            return;
        };
        match plugin {
            "instance" => return self.instance(node, element),
            "shapegroup" => return self.shapegroup(node),
            _ => {}
        }
        let mut p = self.properties(node, plugin);
        let (transform, keyframes) = p.placement(TO_WORLD.name, &mut self.report).unzip();
        let mut to_world = transform.map_or(DAffine3::IDENTITY, |t| t.value);
        let place = transform.map_or(element.place, |t| t.place);
        let mirrored = to_world.matrix3.determinant() < 0.0;
        let flip = p.boolean(FLIP_NORMALS.name, &mut self.report).is_some_and(|f| f.value);
        let (material, radiance) = self.surface(&mut p);
        let geometry = match plugin {
            "obj" | "ply" | "stl" | "serialized" => self.mesh_file(&mut p, plugin, &to_world),
            "cylinder" => self.cylinder(&mut p, &mut to_world, place),
            "sphere" => self.sphere(&mut p, &mut to_world, place),
            "disk" => Some(self.disk(to_world.matrix3, place)),
            "cube" => Some(Geometry::Mesh(Arc::new(Mesh::cube()))),
            _ => Some(Geometry::Mesh(Arc::new(Mesh::rectangle()))),
        };
        if let Some(declared) = shapes::ALL.iter().find(|s| s.name == plugin) {
            p.leave_out(declared.parameters, &mut self.report);
        }
        p.finish(&mut self.report);
        let Some((geometry, material)) = geometry.zip(material) else { return };
        let flip_normals = flip != (mirrored && is_turned_inside_out(plugin, &geometry));
        let name = self.name(element, "shape", self.description.shapes.len() + 1);
        self.nodes.shapes.push(node);
        if let Some(keyframes) = keyframes.flatten() {
            self.motion_of_shape(keyframes, &geometry, place);
        }
        let is_hidden = self.document.is_hidden(node);
        if is_hidden {
            self.description.hidden.shapes.insert(self.description.shapes.len());
        }
        self.description.shapes.push(ShapeDescription {
            name,
            geometry,
            to_world,
            flip_normals,
            material,
            radiance,
        });
        if !is_hidden {
            self.check_attributes(node);
        }
    }

    /// How the shape that is read next moves.
    fn motion_of_shape(&mut self, keyframes: Keyframes, geometry: &Geometry, place: Place) {
        let is_round = !matches!(geometry, Geometry::Mesh(_));
        let stays_round = keyframes.all().iter().all(|(_, at)| even_scale(at.matrix3, ROUNDNESS).is_some());
        if is_round && !stays_round {
            self.report.error(place, "what is round must be scaled evenly on all of its way");
            return;
        }
        self.description.motion.shapes.insert(self.description.shapes.len(), keyframes);
    }

    /// The material's index and the emitted radiance.
    fn surface(&mut self, p: &mut Properties<'_>) -> (Option<usize>, Option<Colour>) {
        let emitters = p.nested("emitter");
        if let Some(second) = emitters.get(1) {
            self.report.error(second.place, "a shape has only one emitter");
        }
        let radiance = emitters.first().and_then(|&emitter| self.area_emitter(emitter));
        let bsdfs = p.nested("bsdf");
        if let Some(second) = bsdfs.get(1) {
            self.report.error(second.place, "a shape has only one bsdf");
        }
        // Light that scatters below the surface is seen on it.
        let below = p.nested("subsurface");
        let material = match below.first().or(bsdfs.first()) {
            Some(bsdf) => self.material(bsdf.node),
            None => Some(self.default_material(!emitters.is_empty())),
        };
        (material, radiance)
    }

    fn mesh_file(&mut self, p: &mut Properties<'_>, plugin: &str, to_world: &DAffine3) -> Option<Geometry> {
        let face_normals = p.boolean(FACE_NORMALS.name, &mut self.report).is_some_and(|f| f.value);
        let flip = p.boolean(FLIP_TEX_COORDS.name, &mut self.report).map(|f| f.value);
        let format = match plugin {
            "obj" => Format::Obj,
            "ply" => Format::Ply,
            "stl" => Format::Stl,
            _ => Format::Serialized(self.shape_index(p)),
        };
        let flip_v = flip.unwrap_or(plugin == "obj");
        if !p.has(FILENAME.name) {
            let article = if plugin == "obj" { "an" } else { "a" };
            self.report.error(p.place, format!("{article} {plugin} shape needs a \"filename\""));
        }
        let filename = p.string(FILENAME.name, &mut self.report)?;
        let wanted = Wanted { format, face_normals, flip_v };
        let mesh = self.meshes.read(&filename, wanted, to_world, &mut self.files, &mut self.report)?;
        Some(Geometry::Mesh(mesh))
    }

    /// Which mesh of several in a file.
    fn shape_index(&mut self, p: &mut Properties<'_>) -> u32 {
        let Some(index) = p.integer(SHAPE_INDEX.name, &mut self.report) else { return 0 };
        u32::try_from(index.value).unwrap_or_else(|_| {
            self.report.error(index.place, "\"shape_index\" must not be negative");
            0
        })
    }

    /// A cylinder; one that its transform makes longer or shorter than it makes it wide is brought into the world here.
    fn cylinder(
        &mut self,
        p: &mut Properties<'_>,
        to_world: &mut DAffine3,
        place: Place,
    ) -> Option<Geometry> {
        let from = p.point(P0.name, &mut self.report).map_or(DVec3::ZERO, |p| p.value);
        let to = p.point(P1.name, &mut self.report).map_or(DVec3::Z, |p| p.value);
        let radius = p.number(RADIUS.name, &mut self.report);
        if let Some(radius) = radius.filter(|r| !RADIUS.holds(r.value)) {
            self.report.error(radius.place, "\"radius\" must be above zero");
            return None;
        }
        let radius = radius.map_or(RADIUS.default, |r| r.value);
        let Some(axis) = (to - from).try_normalize() else {
            self.report.error(p.place, "the ends \"p0\" and \"p1\" of a cylinder are the same point");
            return None;
        };
        if even_scale(to_world.matrix3, ROUNDNESS).is_some() {
            return Some(Geometry::Cylinder { from, to, radius });
        }
        let across = to_world.matrix3 * axis.any_orthonormal_vector();
        let along = (to_world.matrix3 * axis).normalize_or_zero() * across.length();
        let other = to_world.matrix3 * axis.cross(axis.any_orthonormal_vector());
        let Some(scale) = even_scale(DMat3::from_cols(across, other, along), ROUNDNESS) else {
            self.report.error(place, "a cylinder must stay round: its transform stretches or shears it");
            return None;
        };
        let [from, to] = [from, to].map(|end| to_world.transform_point3(end));
        *to_world = DAffine3::IDENTITY;
        Some(Geometry::Cylinder { from, to, radius: radius * scale })
    }

    /// A sphere; one that its transform stretches stays round, as in Mitsuba 3, which scales its radius as its x axis.
    fn sphere(&mut self, p: &mut Properties<'_>, to_world: &mut DAffine3, place: Place) -> Option<Geometry> {
        let centre = p.point(CENTER.name, &mut self.report).map_or(DVec3::ZERO, |c| c.value);
        let radius = p.number(RADIUS.name, &mut self.report);
        if even_scale(to_world.matrix3, ROUNDNESS).is_none() {
            let message = "a sphere stays round: its transform stretches or shears it, and its x axis alone says by how much it is scaled, \
                           as in Mitsuba 3";
            self.report.warning(place, message);
            let there = to_world.transform_point3(centre);
            to_world.matrix3 = rounded(to_world.matrix3);
            to_world.translation = there - to_world.matrix3 * centre;
        }
        if let Some(radius) = radius.filter(|r| !RADIUS.holds(r.value)) {
            self.report.error(radius.place, "\"radius\" must be above zero");
            return None;
        }
        Some(Geometry::Sphere { centre, radius: radius.map_or(RADIUS.default, |r| r.value) })
    }

    /// A disk; an ellipse of triangles where its transform stretches it.
    fn disk(&mut self, m: DMat3, place: Place) -> Geometry {
        // The disc lies in the xy plane; where its normal goes follows from that.
        let normal = m.x_axis.cross(m.y_axis).normalize_or_zero() * m.x_axis.length();
        if even_scale(DMat3::from_cols(m.x_axis, m.y_axis, normal), ROUNDNESS).is_none() {
            let message = format!(
                "this disk is stretched or sheared by its transform: it is made of {SECTORS} triangles"
            );
            self.report.warning(place, message);
            return Geometry::Mesh(Arc::new(disk_of_triangles()));
        }
        Geometry::Disc
    }
}

/// Axes at right angles that are all as long as the first one.
fn rounded(m: DMat3) -> DMat3 {
    let x = m.x_axis.normalize_or(DVec3::X);
    let y = (m.y_axis - x * m.y_axis.dot(x)).try_normalize().unwrap_or_else(|| x.any_orthonormal_vector());
    let z = x.cross(y) * m.determinant().signum();
    DMat3::from_cols(x, y, z) * m.x_axis.length()
}

/// The unit disk in sectors that have its area, with the texture coordinates of a disk: distance and turn.
fn disk_of_triangles() -> Mesh {
    let step = TAU / f64::from(SECTORS);
    // A sector's triangle is smaller than it by sin θ / θ.
    let radius = (step / step.sin()).sqrt();
    let mut mesh = Mesh::default();
    for i in 0..SECTORS {
        let [from, to] = [i, i + 1].map(f64::from);
        let corner = |turn: f64| DVec3::new((turn * step).cos(), (turn * step).sin(), 0.0) * radius;
        mesh.triangles.push([3 * i, 3 * i + 1, 3 * i + 2]);
        mesh.positions.extend([DVec3::ZERO, corner(from), corner(to)]);
        let turns = [0.5 * (from + to), from, to].map(|turn| turn / f64::from(SECTORS));
        mesh.texture_coordinates.extend([
            DVec2::new(0.0, turns[0]),
            DVec2::new(radius, turns[1]),
            DVec2::new(radius, turns[2]),
        ]);
    }
    mesh
}

/// Whether Mitsuba 3 turns the normals around when a transform mirrors the surface: those of a sphere, and those that
/// follow the winding of an OBJ file's faces in the world. In a description outside stays outside, as it does for the
/// other shapes of Mitsuba. Those are cylinders, too: rays that meet a mirrored one in Mitsuba 3.9 find its normals outside, and
/// it shines there; only the points that it samples on such a lamp have them inside, which its pictures by paths then lack.
pub(crate) fn is_turned_inside_out(plugin: &str, geometry: &Geometry) -> bool {
    match geometry {
        Geometry::Sphere { .. } => true,
        Geometry::Mesh(mesh) => !matches!(plugin, "cube" | "rectangle" | "disk") && mesh.normals.is_empty(),
        Geometry::Disc | Geometry::Cylinder { .. } => false,
    }
}
