//! What an inspector shows of a shape or light: its title, its fields, and whom an edit would touch besides.

use foton_input::quoted;
use foton_scene::description::{Colour, Geometry, SceneDescription, ShapeDescription};

use super::camera::UpAxis;
use super::field::{Field, FieldId, Fields};
use super::target::Target;
use super::{geometry, light, material, pick, placing};

/// A shape or light as the inspector shows it.
#[derive(Clone, Debug, PartialEq)]
pub struct Inspection {
    /// Its name in the scene file.
    pub title: String,
    /// What it is, in words.
    pub kind: String,
    /// A surface's material.
    pub material: Option<MaterialUse>,
    /// What a person should know: what is shared, and what cannot be edited.
    pub notes: Vec<String>,
    /// Its fields, in the order in which they are shown.
    pub fields: Vec<Field>,
    /// Whether it can be aimed at a point.
    pub can_aim: bool,
    /// Whether it emits light.
    pub is_light: bool,
}

/// A material and who uses it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MaterialUse {
    /// Its name.
    pub name: String,
    /// How many shapes have it: editing it changes them all. [`Edit::OwnMaterial`](super::Edit::OwnMaterial) parts one.
    pub shapes: usize,
}

/// What there is to see and set of a shape or light; `None` if it is not there.
#[must_use]
pub fn inspect(description: &SceneDescription, target: Target) -> Option<Inspection> {
    let mut fields = Fields(Vec::new());
    position_fields(description, target, &mut fields);
    rotation_fields(description, target, &mut fields);
    let can_aim = placing::aim_of(description, target).is_some();
    let inspection = match target {
        Target::Shape(index) => shape(description, index, fields)?,
        Target::Sensor(index) => camera(description, index, fields)?,
        Target::Emitter(index) => {
            let emitter = description.emitters.get(index)?;
            light::fields(&emitter.kind, up_axis(description), &mut fields);
            Inspection {
                title: emitter.name.clone(),
                kind: light::kind_name(&emitter.kind).to_owned(),
                material: None,
                notes: Vec::new(),
                fields: fields.0,
                can_aim: false,
                is_light: false,
            }
        }
    };
    let is_light = match target {
        Target::Shape(i) => description.shapes.get(i).is_some_and(|s| s.radiance.is_some()),
        Target::Emitter(_) => true,
        Target::Sensor(_) => false,
    };
    Some(Inspection { can_aim, is_light, ..inspection })
}

/// Sides of an image in pixels.
const SIDES: (f64, f64, bool) = (1.0, 16384.0, false);

fn camera(description: &SceneDescription, index: usize, mut fields: Fields) -> Option<Inspection> {
    let sensor = description.sensors.get(index)?;
    let help = "Of the image. Another size restarts the render; its cost grows with the number of pixels.";
    fields.number(FieldId::Width, ("Width", "px"), f64::from(sensor.width), SIDES, help);
    fields.number(FieldId::Height, ("Height", "px"), f64::from(sensor.height), SIDES, help);
    Some(Inspection {
        title: sensor.name.clone(),
        kind: "camera".to_owned(),
        material: None,
        notes: Vec::new(),
        fields: fields.0,
        can_aim: false,
        is_light: false,
    })
}

/// The up axis of a scene: that of its first camera.
pub(crate) fn up_axis(description: &SceneDescription) -> UpAxis {
    description.sensors.first().map_or(UpAxis::Y, UpAxis::guess)
}

fn position_fields(description: &SceneDescription, target: Target, fields: &mut Fields) {
    let Some(middle) = pick::anchor(description, target) else { return };
    for (axis, label) in (0u8..).zip(["X", "Y", "Z"]) {
        let help = "Of its middle, in the world.";
        let value = middle[usize::from(axis)];
        fields.number(FieldId::Position(axis), (label, "units"), value, (-1e6, 1e6, false), help);
    }
}

fn rotation_fields(description: &SceneDescription, target: Target, fields: &mut Fields) {
    let Some(angles) = placing::angles(description, target) else { return };
    for (axis, (label, angle)) in
        (0u8..).zip(["Rotation X", "Rotation Y", "Rotation Z"].into_iter().zip(angles))
    {
        let help = "About its middle: first Z, then Y, then X, axes of the world.";
        // What is nothing but rounding is no angle.
        let angle = if angle.abs() < 1e-9 { 0.0 } else { angle };
        fields.number(FieldId::Rotation(axis), (label, "°"), angle, (-360.0, 360.0, false), help);
    }
}

fn extent_fields(shape: &ShapeDescription, fields: &mut Fields) {
    if !matches!(shape.geometry, Geometry::Mesh(_)) {
        return;
    }
    let (extents, size) = (geometry::extents(shape), geometry::size(shape));
    for (axis, (label, extent)) in (0u8..).zip(["Length X", "Length Y", "Length Z"].into_iter().zip(extents))
    {
        if extent > 1e-9 * size {
            let help = "Along its own axis, before it is turned.";
            let range = (extent * 0.01, extent * 100.0, true);
            fields.number(FieldId::Extent(axis), (label, "units"), extent, range, help);
        }
    }
}

/// What a shape is, in words: `mesh, smooth conductor`.
pub(crate) fn shape_kind(description: &SceneDescription, shape: &ShapeDescription) -> String {
    let surface = match shape.geometry {
        Geometry::Mesh(_) => "mesh",
        Geometry::Sphere { .. } => "sphere",
        Geometry::Disc => "disc",
        Geometry::Cylinder { .. } => "tube",
    };
    if shape.radiance.is_some() {
        return format!("area light, {surface}");
    }
    let made_of = description.materials.get(shape.material).map(material::kind_name);
    format!("{surface}, {}", made_of.unwrap_or_default())
}

fn shape(description: &SceneDescription, index: usize, mut fields: Fields) -> Option<Inspection> {
    let shape = description.shapes.get(index)?;
    let used = description.materials.get(shape.material)?;
    let light = shape.radiance.is_some();
    let help = if light {
        "Scales it about its middle. Its power stays, so a smaller light is brighter and makes sharper caustics."
    } else {
        "Scales it about its middle."
    };
    let (id, label, size) = match geometry::radius(shape) {
        Some(radius) => (FieldId::Radius, "Radius", radius),
        None => (FieldId::Size, "Size", geometry::size(shape)),
    };
    if size > 0.0 {
        fields.number(id, (label, "units"), size, (size * 0.01, size * 100.0, true), help);
    }
    extent_fields(shape, &mut fields);
    light::surface_fields(shape, &mut fields);
    let textured = material::fields(used, &mut fields);
    let shapes = description.shapes.iter().filter(|s| s.material == shape.material).count();
    let mut notes = Vec::new();
    if shapes > 1 {
        notes.push(format!("The material {} is shared by {shapes} shapes.", quoted(&used.name)));
    }
    if textured || matches!(shape.radiance, Some(Colour::Texture(_))) {
        notes.push("Values that come from textures cannot be edited here.".to_owned());
    }
    if !used.mixture.is_empty() {
        let others: Vec<_> =
            used.mixture.iter().filter_map(|b| description.materials.get(b.material)).collect();
        let kinds: Vec<_> = others.into_iter().map(material::kind_name).collect();
        notes.push(format!(
            "The material is a blend: this is its first component; the others are {}.",
            kinds.join(", ")
        ));
    }
    if used.relief.is_some() {
        notes.push("A bump or normal map perturbs its normals.".to_owned());
    }
    let kind = shape_kind(description, shape);
    let material = Some(MaterialUse { name: used.name.clone(), shapes });
    Some(Inspection {
        title: shape.name.clone(),
        kind,
        material,
        notes,
        fields: fields.0,
        can_aim: false,
        is_light: light,
    })
}
