//! What a description must fulfil before anything is built, and how large it is.

use foton_math::glam::DVec3;

use super::BuildError;
use crate::description::{
    Colour, EmitterDescription, EmitterKind, Geometry, Material, SceneDescription, SensorDescription,
};

/// Whether a span of pixels lies within a side of the image and holds one.
fn fits(first: u32, count: u32, side: u32) -> bool {
    count > 0 && u64::from(first) + u64::from(count) <= u64::from(side)
}

pub(super) fn check_sensors(sensors: &[SensorDescription]) -> Result<(), BuildError> {
    if sensors.is_empty() {
        return Err(BuildError::NoSensor);
    }
    for s in sensors {
        let determinant = s.to_world.matrix3.determinant();
        let good = s.fov_degrees > 0.0
            && s.fov_degrees < 180.0
            && s.width > 0
            && s.height > 0
            && s.crop.is_none_or(|c| fits(c.x, c.width, s.width) && fits(c.y, c.height, s.height))
            && determinant.is_finite()
            && determinant != 0.0
            && s.to_world.translation.is_finite();
        if !good {
            return Err(BuildError::BadSensor(s.name.clone()));
        }
    }
    Ok(())
}

pub(super) fn check_environments(description: &SceneDescription) -> Result<(), BuildError> {
    let unsound = |e: &&EmitterDescription| match &e.kind {
        EmitterKind::Environment { bitmap, .. } => !bitmap.is_sound(),
        _ => false,
    };
    description.emitters.iter().find(unsound).map_or(Ok(()), |e| Err(BuildError::NoTexture(e.name.clone())))
}

pub(super) fn check_textures(material: &Material, description: &SceneDescription) -> Result<(), BuildError> {
    use crate::description::TextureKind::Bitmap;
    for colour in material.colours() {
        let Colour::Texture(index) = colour else { continue };
        let good = match description.textures.get(index).map(|t| &t.kind) {
            Some(Bitmap { bitmap, .. }) => bitmap.is_sound(),
            Some(_) => true,
            None => false,
        };
        if !good {
            return Err(BuildError::NoTexture(material.name.clone()));
        }
    }
    Ok(())
}

/// The corners of all surfaces in world units; the origin where there are none.
pub(super) fn world_bounds(description: &SceneDescription) -> Result<(DVec3, DVec3), BuildError> {
    let (mut min, mut max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for shape in &description.shapes {
        let mut finite = true;
        let mut add = |p: DVec3| {
            finite &= p.is_finite();
            min = min.min(p);
            max = max.max(p);
        };
        match &shape.geometry {
            Geometry::Mesh(mesh) => {
                mesh.positions.iter().for_each(|&p| add(shape.to_world.transform_point3(p)));
            }
            Geometry::Sphere { centre, radius } => {
                let c = shape.to_world.transform_point3(*centre);
                let r = radius * shape.to_world.matrix3.x_axis.length();
                add(c - r);
                add(c + r);
            }
            Geometry::Disc => {
                let c = shape.to_world.translation;
                let r = shape.to_world.matrix3.x_axis.length();
                add(c - r);
                add(c + r);
            }
            Geometry::Cylinder { from, to, radius } => {
                let r = radius * shape.to_world.matrix3.x_axis.length();
                for end in [from, to].map(|&p| shape.to_world.transform_point3(p)) {
                    add(end - r);
                    add(end + r);
                }
            }
        }
        if !finite {
            return Err(BuildError::NotFinite(shape.name.clone()));
        }
    }
    if min.cmpgt(max).any() { Ok((DVec3::ZERO, DVec3::ZERO)) } else { Ok((min, max)) }
}
