//! A mesh file as a whole scene: what it lacks is added, and a warning says so.
//!
//! - Camera: 45° wide, as near as it can be with the whole model in view. Normally it looks from three quarters in
//!   front and above. A model that emits light, or that is a box open to one side (at least four of the other five faces
//!   of its bounds are at least half covered by triangles), is looked at straight through its open side: the first one
//!   of front (+z), right, back and left that is not covered.
//! - Light: only if nothing in the file emits. Above the model, or under the lid of a box; with it a dim sky and, outside
//!   of boxes, a floor.
//!
//! OBJ and PLY models stand on the xz plane with +z towards the viewer; STL models on the xy plane with −y there, as
//! printers and the programs that make these files have it.

mod parts;
mod shapes;

use std::path::Path;

use foton_input::shown;
use foton_math::Rgb;
use foton_math::glam::{DAffine3, DMat3, DVec3};
use foton_scene::description::{
    Colour, EmitterDescription, EmitterKind, Filter, FovAxis, Geometry, Mesh, SceneDescription,
    SensorDescription,
};

use crate::diagnostic::{Diagnostic, OpenError, Place, Report};
use crate::hash::Fnv1a;
use crate::limits::Budget;
use crate::mesh::normals;
use crate::mesh::obj::Obj;
use crate::mesh::ply;
use crate::mesh::stl;
use crate::mesh::wanted::{Format, Wanted};
use crate::mesh::words::Problem;
use crate::opened::{ForeignScene, Opened, Origin};
use crate::options::{BYTES_PER_BYTE, Options, ReadFile};
use crate::suggested::Suggested;
use crate::watch::Watch;
use shapes::{Library, add_shape};

/// Field of view along the shorter side of the image.
const FOV_DEGREES: f64 = 45.0;
/// Share of the image's half that the model may fill.
const FILL: f64 = 0.95;
/// How near to a face of the bounds a triangle covers it, as a share of the bounds' extent.
const COVERING: f64 = 0.05;
/// Irradiance that the default light brings to the middle of the model: a white surface there has radiance 1.
const KEY_IRRADIANCE: f64 = std::f64::consts::PI;
/// Names of the shapes that are added.
const ADDED: [&str; 2] = ["default-light", "default-floor"];
/// Radiance of the default sky.
const SKY: f32 = 0.2;

/// A kind of mesh file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Kind {
    Obj,
    Ply,
    Stl,
}

impl Kind {
    /// The kind that a file's extension says.
    pub(crate) fn of(path: &Path) -> Option<Self> {
        match path.extension()?.to_ascii_lowercase().to_str()? {
            "obj" => Some(Self::Obj),
            "ply" => Some(Self::Ply),
            "stl" => Some(Self::Stl),
            _ => None,
        }
    }

    fn axes(self) -> Axes {
        match self {
            Self::Obj | Self::Ply => Axes { right: DVec3::X, up: DVec3::Y, front: DVec3::Z },
            Self::Stl => Axes { right: DVec3::X, up: DVec3::Z, front: DVec3::NEG_Y },
        }
    }
}

/// How a model stands; right × up = front.
#[derive(Clone, Copy)]
struct Axes {
    right: DVec3,
    up: DVec3,
    front: DVec3,
}

/// Opens a mesh file as a scene.
pub(crate) fn open(
    path: &Path,
    kind: Kind,
    files: &ReadFile<'_>,
    options: &Options,
) -> Result<Opened, OpenError> {
    let name = path.to_string_lossy();
    let mut report = Report::new(&name, path.parent().unwrap_or(Path::new("")));
    for (name, value) in &options.defines {
        report.error(
            Place::default(),
            format!("-D {}: a mesh file has no parameters", shown(&format!("{name}={value}"))),
        );
    }
    let bytes = match files(path) {
        Ok(bytes) => bytes,
        Err(error) => {
            options.cancel.check()?;
            return Err(report.fail(Place::default(), format!("cannot be read: {error}")));
        }
    };
    let mut hash = Fnv1a::default();
    hash.add(&bytes);
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut budget = Budget::new(options.memory);
    let mut library = |name: &str| {
        let (path, bytes) = [name.to_owned(), name.replace('\\', "/")].into_iter().find_map(|name| {
            let path = folder.join(name);
            match files(&path) {
                Err(error) if is_absent(&error) => None,
                Err(error) => Some((path, Err(error.to_string()))),
                Ok(bytes) => Some((path, budget.take(bytes.len() as u64 * BYTES_PER_BYTE).map(|()| bytes))),
            }
        })?;
        if let Ok(bytes) = &bytes {
            hash.add(bytes);
        }
        Some((path.to_string_lossy().into_owned(), bytes))
    };
    let read = read(&bytes, kind, &mut library, &mut report, Watch::new(&options.cancel, &options.progress));
    options.cancel.check()?;
    let description = match read {
        Ok(description) => description,
        Err(problems) => {
            problems.into_iter().for_each(|(place, message)| report.error(place, message));
            SceneDescription::default()
        }
    };
    let warnings: Vec<Diagnostic> = report.finish()?;
    Ok(Opened {
        description,
        origin: Origin::Foreign(ForeignScene::new("a mesh file")),
        path: Some(path.to_owned()),
        files: Vec::new(),
        options: options.without_cancel(),
        suggested: Suggested::default(),
        warnings,
        source_hash: hash.finish(),
    })
}

/// The shapes of a mesh file, with their materials and textures, and nothing that it lacks.
pub(crate) fn shapes_alone(mut description: SceneDescription) -> SceneDescription {
    while description.shapes.last().is_some_and(|s| ADDED.contains(&s.name.as_str())) {
        description.shapes.pop();
    }
    SceneDescription { sensors: Vec::new(), emitters: Vec::new(), ..description }
}

/// Whether a name stands for nothing: a word that is none, or one too long to be one.
fn is_absent(error: &std::io::Error) -> bool {
    use std::io::ErrorKind::{InvalidFilename, InvalidInput, NotADirectory, NotFound};
    matches!(error.kind(), NotFound | NotADirectory | InvalidFilename | InvalidInput)
}

fn read(
    bytes: &[u8],
    kind: Kind,
    library: &mut Library<'_>,
    report: &mut Report,
    watch: Watch<'_>,
) -> Result<SceneDescription, Vec<Problem>> {
    let cancel = watch.cancel();
    let mut scene = SceneDescription::default();
    match kind {
        Kind::Obj => {
            let mut obj = Obj::parse(bytes, watch)?;
            warn(std::mem::take(&mut obj.warnings), report);
            parts::add_obj(&obj, library, report, &mut scene, cancel);
        }
        Kind::Ply => {
            let wanted = Wanted { format: Format::Ply, face_normals: false, flip_v: false };
            let (mesh, warnings) = ply::parse(bytes, watch).map_err(|problem| vec![problem])?;
            warn(warnings, report);
            let mesh = normals::finished(&mesh, wanted, &DAffine3::IDENTITY, cancel);
            add_shape("mesh", mesh, None, &mut scene);
        }
        Kind::Stl => {
            let (mesh, warnings) = stl::parse(bytes, cancel).map_err(|problem| vec![problem])?;
            warn(warnings, report);
            add_shape("mesh", mesh, None, &mut scene);
        }
    }
    let Some(model) = Model::of(&scene, kind.axes()) else {
        return Err(vec![(Place::default(), "the model has no extent".to_owned())]);
    };
    model.add_camera(&mut scene, report);
    if !model.emits {
        model.add_light(&mut scene, report);
    }
    Ok(scene)
}

fn warn(warnings: Vec<Problem>, report: &mut Report) {
    warnings.into_iter().for_each(|(place, message)| report.warning(place, message));
}

/// What is to be looked at and lit.
struct Model {
    axes: Axes,
    low: DVec3,
    high: DVec3,
    emits: bool,
    /// The side through which it is looked into, if it is a box.
    open_side: Option<DVec3>,
}

impl Model {
    /// `None` if it is a point or nothing at all.
    fn of(scene: &SceneDescription, axes: Axes) -> Option<Self> {
        let meshes: Vec<&Mesh> = scene
            .shapes
            .iter()
            .filter_map(|s| if let Geometry::Mesh(mesh) = &s.geometry { Some(&**mesh) } else { None })
            .collect();
        let points = || {
            let corners = |m: &Mesh, t: &[u32; 3]| t.map(|i| m.positions[i as usize]);
            meshes.iter().flat_map(move |m| {
                m.triangles.iter().filter(|t| m.has_area(**t)).flat_map(move |t| corners(m, t))
            })
        };
        let low = points().reduce(DVec3::min)?;
        let high = points().reduce(DVec3::max)?;
        let emits = scene.shapes.iter().any(|s| s.radiance.is_some());
        let mut model = Self { axes, low, high, emits, open_side: None };
        if !(model.size().max_element() > 0.0 && model.size().is_finite()) {
            return None;
        }
        let Axes { right, up, front } = axes;
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
    fn is_covered(&self, side: DVec3, meshes: &[&Mesh]) -> bool {
        let depth = side.abs().dot(self.size());
        let plane = side.dot(self.face(side));
        let near = |p: DVec3| plane - side.dot(p) <= COVERING * depth;
        let area: f64 = meshes
            .iter()
            .flat_map(|mesh| mesh.triangles.iter().map(|t| t.map(|i| mesh.positions[i as usize])))
            .filter(|corners| corners.iter().all(|&p| near(p)))
            .map(|[a, b, c]| 0.5 * (b - a).cross(c - a).dot(side).abs())
            .sum();
        let across = DVec3::ONE - side.abs();
        let extents = (self.size() * across + side.abs()).element_product();
        area >= 0.5 * extents && extents > 0.0
    }

    fn add_camera(&self, scene: &mut SceneDescription, report: &mut Report) {
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
            filter: Filter::Gaussian { stddev: 0.5 },
            ..SensorDescription::default()
        });
        report.warning(Place::default(), format!("a mesh file has no camera: one is placed {place}"));
    }

    fn add_light(&self, scene: &mut SceneDescription, report: &mut Report) {
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
        if self.open_side.is_none() {
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
