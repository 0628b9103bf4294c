//! What a description must fulfil before anything is built, and how large it is.

use foton_math::Rgb;
use foton_math::glam::DVec3;
use rayon::prelude::*;

use super::error::BuildError;
use super::extent::Extent;
use super::gather::even_scale;
use super::gauge::Instancing;
use super::instances::{Extents, Known, shared_meshes};
use super::textures::Textures;
use crate::description::{
    Bsdf, Coating, Colour, EmitterDescription, EmitterKind, Geometry, Material, SceneDescription,
    SensorDescription, ShapeDescription,
};
use crate::emitter::{Emitter, Kind};
use crate::normalise::Normalisation;
use crate::parameter::Binding;

/// How unevenly a spot may be scaled: what nobody sees of its cone.
const CONE_ROUNDNESS: f64 = 2e-3;

/// Whether a span of pixels lies within a side of the image and holds one.
fn fits(first: u32, count: u32, side: u32) -> bool {
    count > 0 && u64::from(first) + u64::from(count) <= u64::from(side)
}

pub(super) fn check_sensors(
    sensors: &[SensorDescription],
    to_scene: &Normalisation,
) -> Result<(), BuildError> {
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
            && s.to_world.translation.is_finite()
            && s.principal_point_offset.iter().all(|offset| offset.is_finite())
            && s.lens.is_none_or(|lens| lens.is_sound());
        if !good {
            return Err(BuildError::BadSensor(s.name.clone()));
        }
        check_distance(s.to_world.translation, to_scene, &s.name)?;
    }
    Ok(())
}

pub(super) fn check_described_emitters(
    description: &SceneDescription,
    textures: &Textures<'_>,
) -> Result<(), BuildError> {
    for EmitterDescription { name, kind } in &description.emitters {
        match kind {
            // That its pixels are numbers is seen by its power, which has a share of each.
            EmitterKind::Environment { bitmap, .. } | EmitterKind::Goniometric { bitmap, .. }
                if !bitmap.is_sound() =>
            {
                return Err(BuildError::NoTexture(name.clone()));
            }
            EmitterKind::Spot { to_world, .. }
            | EmitterKind::Projector { to_world, .. }
            | EmitterKind::Goniometric { to_world, .. } => {
                even_scale(to_world, &[0, 1, 2], CONE_ROUNDNESS, name)?;
            }
            _ => {}
        }
        if let EmitterKind::Projector { fov_degrees, scale, .. } = kind
            && !(*fov_degrees > 0.0 && *fov_degrees < 180.0 && scale.is_finite() && *scale >= 0.0)
        {
            return Err(BuildError::NotFinite(name.clone()));
        }
        if let Some(index) = kind.texture() {
            textures.is_there(index, name)?;
            textures.is_within(index, f32::INFINITY)?;
            textures.is_of_no_mesh(index, name)?;
        }
    }
    Ok(())
}

/// Room for the sums of photons above an emitter's power.
const HEADROOM: f64 = 1e6;

/// Farther away than this, in scene units, the square of a distance is no number of single precision.
const FARTHEST: f64 = 1e18;

/// Whether what emitters emit and where they stand are numbers, of single precision and in scene units. `emitters` are those that
/// are surfaces, and then those of the description.
pub(super) fn check_emitters(
    emitters: &[Emitter],
    description: &SceneDescription,
    to_scene: &Normalisation,
) -> Result<(), BuildError> {
    let surfaces = emitters.len() - description.emitters.len();
    for (i, emitter) in emitters.iter().enumerate() {
        let described = i.checked_sub(surfaces).map(|i| &description.emitters[i].kind);
        let name = || emitter.name.clone();
        let position = described.and_then(EmitterKind::position);
        position.map_or(Ok(()), |p| check_distance(p, to_scene, &emitter.name))?;
        let emission = match (described, &emitter.kind) {
            (None, Kind::Area(area)) => area.radiance,
            (Some(kind), _) => brightest(kind),
            (None, _) => continue,
        };
        let placed = if let Kind::Spot(spot) = &emitter.kind { spot.frame.normal.is_finite() } else { true };
        if !(emission.is_finite() && placed) {
            return Err(BuildError::NotFinite(name()));
        }
        let emission = f64::from(emission.max_component());
        // Intensities are in scene units here, radiances are the same in all units.
        let unit = if position.is_some() { to_scene.scale() * to_scene.scale() } else { 1.0 };
        if !emitter.power().is_finite() {
            let most = f64::from(f32::MAX) / (f64::from(emitter.power_factor()) * unit * HEADROOM);
            return Err(BuildError::TooBright { name: name(), emission, most });
        }
        let least = f64::from(f32::MIN_POSITIVE) / unit;
        if emission > 0.0 && emission < least && position.is_some() {
            return Err(BuildError::TooDim { name: name(), emission, least });
        }
    }
    Ok(())
}

/// The largest components of what an emitter emits, in the file's unit.
fn brightest(kind: &EmitterKind) -> Rgb {
    match kind {
        EmitterKind::Point { intensity: c, .. }
        | EmitterKind::Spot { intensity: c, .. }
        | EmitterKind::Constant { radiance: c }
        | EmitterKind::Directional { irradiance: c, .. } => *c,
        // Textures have numbers.
        EmitterKind::Projector { irradiance, scale, .. } => match irradiance {
            Colour::Constant(c) => *c * (*scale as f32),
            Colour::Texture(_) => Rgb::splat(*scale as f32),
        },
        // NaN is no largest of any: a sum has it.
        EmitterKind::Environment { bitmap, scale, .. } | EmitterKind::Goniometric { bitmap, scale, .. } => {
            let pixels = || bitmap.pixels.iter().map(|&p| p * *scale);
            if pixels().all(Rgb::is_finite) {
                Rgb::splat(pixels().fold(0.0, |most, p| p.max_component().max(most)))
            } else {
                Rgb::splat(f32::NAN)
            }
        }
    }
}

/// Whether a light or a camera is so near that its distance from a surface is a number.
fn check_distance(world: DVec3, to_scene: &Normalisation, name: &str) -> Result<(), BuildError> {
    if !world.is_finite() {
        return Err(BuildError::NotFinite(name.to_owned()));
    }
    let distance = to_scene.distance(world);
    if distance < FARTHEST {
        Ok(())
    } else {
        Err(BuildError::TooFar { name: name.to_owned(), times: distance / Normalisation::HALF_SIZE })
    }
}

/// Whether a colour may be a share of light: NaN is not.
fn is_share(c: Rgb) -> bool {
    c.to_array().iter().all(|c| (0.0..=1.0).contains(c))
}

/// Whether a shape's radiance, where it comes from a texture, is such as a surface can emit; whether it does.
pub(super) fn check_radiance(shape: &ShapeDescription, textures: &Textures<'_>) -> Result<bool, BuildError> {
    let Some(Colour::Texture(index)) = shape.radiance else { return Ok(false) };
    textures.is_there(index, &shape.name)?;
    textures.is_within(index, f32::INFINITY)?;
    Ok(true)
}

/// Whether a material's numbers are such as a surface can have, and its textures are there.
pub(super) fn check_material(material: &Material, textures: &Textures<'_>) -> Result<(), BuildError> {
    for colour in material.colours() {
        match colour {
            Colour::Constant(c) if is_share(c) => {}
            Colour::Constant(_) => return Err(BuildError::BadMaterial(material.name.clone())),
            Colour::Texture(index) => {
                textures.is_there(index, &material.name)?;
                textures.is_within(index, 1.0)?;
            }
        }
    }
    for index in material.textures() {
        textures.is_there(index, &material.name)?;
    }
    let is_sound = |bsdf: &Bsdf| { *bsdf }.parameters().iter().all(Binding::is_valid);
    let is_sound_coating = |coating: &Coating| { *coating }.parameters().iter().all(Binding::is_valid);
    let all_sound =
        material.bsdfs().all(is_sound) && material.coatings.iter().flatten().all(is_sound_coating);
    if all_sound { Ok(()) } else { Err(BuildError::BadMaterial(material.name.clone())) }
}

/// The corners of a surface in world units, but of what is left out of the scene: vertices of no triangle that has area. Not finite
/// where any of its points is not.
pub(super) fn shape_bounds(shape: &ShapeDescription) -> (DVec3, DVec3) {
    let (mut min, mut max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let mut finite = true;
    let mut add = |p: DVec3| {
        finite &= p.is_finite();
        min = min.min(p);
        max = max.max(p);
    };
    let scale = shape.to_world.matrix3.x_axis.length();
    let around = |c: DVec3, r: f64| [c - r, c + r];
    match &shape.geometry {
        Geometry::Mesh(mesh) => return Extent::new(mesh).under(&shape.to_world),
        Geometry::Sphere { centre, radius } => {
            around(shape.to_world.transform_point3(*centre), radius * scale).into_iter().for_each(&mut add);
        }
        Geometry::Disc => {
            around(shape.to_world.translation, scale).into_iter().for_each(&mut add);
        }
        Geometry::Cylinder { from, to, radius } => {
            for end in [from, to].map(|&p| shape.to_world.transform_point3(p)) {
                around(end, radius * scale).into_iter().for_each(&mut add);
            }
        }
    }
    if finite { (min, max) } else { (DVec3::NAN, DVec3::NAN) }
}

/// The corners of all surfaces in world units; the origin where there are none.
pub(super) fn world_bounds(
    description: &SceneDescription,
    known: &Known<'_>,
) -> Result<(DVec3, DVec3), BuildError> {
    let (mut min, mut max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let extents = Extents::of(&shared_meshes(description, Instancing::default()), known);
    let bounds = |(i, shape): (usize, &ShapeDescription)| {
        extents.of_shape(i, shape).unwrap_or_else(|| shape_bounds(shape))
    };
    let all: Vec<_> = description.shapes.par_iter().enumerate().map(bounds).collect();
    for (shape, (low, high)) in description.shapes.iter().zip(all) {
        if low.is_nan() {
            return Err(BuildError::NotFinite(shape.name.clone()));
        }
        min = min.min(low);
        max = max.max(high);
    }
    if min.cmpgt(max).any() { Ok((DVec3::ZERO, DVec3::ZERO)) } else { Ok((min, max)) }
}
