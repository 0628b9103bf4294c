//! Emitters of a description in scene units, and how photons are shared among them.

use std::f64::consts::PI;
use std::sync::Arc;

use foton_math::glam::{DAffine3, DVec3, Mat3, Vec3};
use foton_math::{Aabb, Frame, Rgb};

use super::orientation::orientation;
use crate::description::{Bitmap, Colour, EmitterDescription, EmitterKind, projected_half};
use crate::discrete::Discrete;
use crate::emitter::{
    Aim, Ball, Beam, Cone, Constant, Directional, Emitter, Environment, EnvironmentMap, Goniometric, Kind,
    Light, Picture, Point, Spot, Target,
};
use crate::normalise::Normalisation;
use crate::texture::Sampler;

/// Share of photons spread evenly over emitters, whatever their power (δ of theory's many lights).
const DEFENSIVE_SHARE: f64 = 0.1;

/// A ball around a box. A margin keeps the start of every path off the outermost surface.
pub(super) fn ball(b: &Aabb) -> Ball {
    Ball { centre: b.centre(), radius: b.radius() * 1.01 }
}

/// Half of the light from infinity is aimed at what focuses it, where that saves most of the photons.
pub(super) fn aim_at_casters(casters: Option<Ball>) -> Aim {
    Aim::new(casters.map(|ball| Target { ball, share: 0.5 }).into_iter().collect())
}

pub(super) fn unattached_emitter(
    description: &EmitterDescription,
    to_scene: &Normalisation,
    textures: &[Arc<Sampler>],
    (scene, casters): (Ball, Option<Ball>),
) -> Emitter {
    // Irradiance is intensity over squared distance, so intensity grows with the square of the scale. That may be no number of
    // single precision where what it makes of an intensity is one.
    let scale2 = to_scene.scale() * to_scene.scale();
    let scaled = |intensity: Rgb| intensity.map(|c| (f64::from(c) * scale2) as f32);
    let place = |to_world: &DAffine3| to_scene.point(to_world.translation);
    let kind = match &description.kind {
        EmitterKind::Point { position, intensity } => {
            Kind::Point(Point { position: to_scene.point(*position), intensity: scaled(*intensity) })
        }
        EmitterKind::Spot { to_world, intensity, cutoff_degrees, beam_degrees, texture } => {
            let cone = Cone {
                cutoff: cutoff_degrees.to_radians() as f32,
                beam: beam_degrees.min(*cutoff_degrees).to_radians() as f32,
            };
            let (position, intensity) = (place(to_world), scaled(*intensity));
            if let Some(texture) = texture {
                let picture = Picture::Texture(Arc::clone(&textures[*texture]));
                let light = Light::Coloured { cone, intensity };
                Kind::Beam(Box::new(Beam::new(position, axes(to_world), picture, light)))
            } else {
                let axis = to_world.matrix3.z_axis.normalize().as_vec3();
                Kind::Spot(Spot { position, frame: Frame::from_normal(axis), intensity, cone })
            }
        }
        EmitterKind::Projector { to_world, irradiance, scale, fov_degrees, fov_axis } => {
            let (picture, colour) = match irradiance {
                Colour::Constant(c) => (Picture::Even, *c),
                Colour::Texture(i) => (Picture::Texture(Arc::clone(&textures[*i])), Rgb::WHITE),
            };
            let half = projected_half(*fov_degrees, *fov_axis, picture.shape()).map(|c| c as f32);
            let factor = colour.map(|c| (f64::from(c) * scale * scale2 * PI) as f32);
            let light = Light::Projected { half: half.into(), factor };
            Kind::Beam(Box::new(Beam::new(place(to_world), axes(to_world), picture, light)))
        }
        EmitterKind::Goniometric { to_world, bitmap, scale } => {
            let scale = (f64::from(*scale) * scale2) as f32;
            Kind::Goniometric(lamp(place(to_world), &axes(to_world), bitmap, scale))
        }
        EmitterKind::Constant { radiance } => Kind::Constant(Constant { radiance: *radiance, scene }),
        EmitterKind::Directional { direction, irradiance } => Kind::Directional(Directional {
            direction: direction.normalize_or(DVec3::NEG_Z).as_vec3(),
            irradiance: *irradiance,
            scene,
        }),
        EmitterKind::Environment { to_world, bitmap, scale } => {
            let to_world = orientation(to_world).transpose();
            let map = Box::new(EnvironmentMap::new(bitmap.clone(), *scale, to_world));
            Kind::Environment(Environment { map, scene })
        }
    };
    let emitter = Emitter { name: description.name.clone(), kind, aim: Aim::default() };
    if emitter.is_at_infinity() { Emitter { aim: aim_at_casters(casters), ..emitter } } else { emitter }
}

/// A measured lamp.
fn lamp(position: Vec3, axes: &Frame, bitmap: &Arc<Bitmap>, scale: f32) -> Goniometric {
    // Rows of a map are angles to its +y, columns begin at its −z and grow towards +x.
    let of_map = Mat3::from_cols(axes.bitangent, axes.normal, -axes.tangent);
    let map = Box::new(EnvironmentMap::new(Arc::clone(bitmap), scale, of_map));
    Goniometric { position, map }
}

/// The unit axes of an emitter in the scene; they may be left-handed.
fn axes(to_world: &DAffine3) -> Frame {
    let m = to_world.matrix3;
    let [tangent, bitangent, normal] = [m.x_axis, m.y_axis, m.z_axis].map(|axis| axis.normalize().as_vec3());
    Frame { tangent, bitangent, normal }
}

/// p = (1 − δ) Φ/ΣΦ + δ/n over those that emit at all.
pub(super) fn emitter_choice(emitters: &[Emitter]) -> Discrete {
    // In double precision: the sum of three channels may overflow where none of them does.
    let power = |e: &Emitter| e.power().to_array().into_iter().map(f64::from).sum::<f64>() / 3.0;
    let total: f64 = emitters.iter().map(power).sum();
    let count = emitters.iter().filter(|e| power(e) > 0.0).count() as f64;
    Discrete::new(
        emitters.iter().map(power).map(|p| {
            if p > 0.0 { (1.0 - DEFENSIVE_SHARE) * p / total + DEFENSIVE_SHARE / count } else { 0.0 }
        }),
    )
}
