//! What is so far away, or so large, that single precision does not hold it together with the rest of the scene.
//!
//! Nothing is refused here: such a scene renders, and whoever shows it can say why it comes out black or coarse. What no number
//! holds at all is a [`BuildError`](crate::BuildError).

use std::fmt;

use foton_input::quoted;
use foton_math::Rgb;
use foton_math::glam::Vec3;

use crate::emitter::Kind;
use crate::scene::{Scene, Shape};

/// What lies so many times as far from the camera as all that is nearer leaves that with a dozen steps of single precision.
const APART: f32 = 3e6;

/// Of lamps beyond all else that reach so many times as far, hardly a millionth of the surface is near the rest.
const LAMP_APART: f32 = 1e3;

/// A camera or light so many half-diagonals of the scene away sees or meets it by steps of a hundredth of its size.
const TOO_FAR: f64 = 1e5;

/// A light that fewer of its photons than this reach the scene of lights nothing within any time.
const MIN_CHANCE: f64 = 1e-6;

/// What to take instead of what is far.
const FROM_FAR: &str =
    "for light from far away there are the \"constant\", \"envmap\" and \"directional\" emitters";

/// Something that is too far away or too large for the rest of the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Far {
    /// Its name in the scene file.
    pub name: String,
    /// What it is.
    pub kind: FarKind,
    /// How many times as far away as the rest of the scene is large; for surfaces, as far as the farthest that is near.
    pub times: f64,
}

/// What is far.
#[derive(Clone, Debug, PartialEq)]
pub enum FarKind {
    /// A surface and so many others.
    Surfaces(usize),
    /// A surface that emits: the rest has its shape beside it, but few of its photons.
    Lamp,
    /// A camera.
    Camera,
    /// A light that shines from one point.
    Light {
        /// The share of its photons that meet the scene.
        chance: f64,
        /// The irradiance that it brings to the scene.
        irradiance: Rgb,
        /// The unit direction in which its light arrives.
        direction: Vec3,
    },
}

impl Scene {
    /// What is too far away or too large to be rendered well through a sensor.
    #[must_use]
    pub fn far_things(&self, sensor: usize) -> Vec<Far> {
        let mut far: Vec<Far> = self.far_surfaces(sensor).into_iter().collect();
        let camera = &self.sensors[sensor];
        let times = self.half_diagonals(camera.origin());
        if times > TOO_FAR {
            far.push(Far { name: camera.name.clone(), kind: FarKind::Camera, times });
        }
        far.extend((0..self.emitters.len()).filter_map(|i| self.far_light(i)));
        far
    }

    /// The surfaces beyond a gap in the distances from the camera that is too wide, if there are others before it.
    fn far_surfaces(&self, sensor: usize) -> Option<Far> {
        let eye = self.sensors[sensor].origin();
        let reach = |s: &Shape| (eye - s.extent.min).abs().max((s.extent.max - eye).abs()).max_element();
        let with_extent = self.shapes.iter().filter(|s| !s.extent.is_empty());
        let mut reaches: Vec<(f32, &Shape)> = with_extent.map(|s| (reach(s), s)).collect();
        reaches.sort_by(|a, b| a.0.total_cmp(&b.0));
        let apart = |i: usize| {
            let shine = reaches[i..].iter().all(|(_, shape)| shape.emitter.is_some());
            reaches[i].0 > if shine { LAMP_APART } else { APART } * reaches[i - 1].0
        };
        let first = (1..reaches.len()).find(|&i| apart(i))?;
        let (near, (far, shape)) = (reaches[first - 1].0, reaches[first]);
        let lost = far > APART * near;
        let kind = if lost { FarKind::Surfaces(reaches.len() - first - 1) } else { FarKind::Lamp };
        Some(Far { name: shape.name.clone(), kind, times: f64::from(far) / f64::from(near) })
    }

    /// A light that shines from one point, if it is too far away.
    fn far_light(&self, index: usize) -> Option<Far> {
        let emitter = &self.emitters[index];
        // Of all directions of a photon, the share of those within a cone of that half-angle is the square of its half's sine.
        let (position, share_of_all) = match &emitter.kind {
            Kind::Point(point) => (point.position, 1.0),
            Kind::Spot(spot) => (spot.position, f64::from(spot.cone.cutoff * 0.5).sin().powi(2)),
            Kind::Beam(beam) => (beam.position, f64::from(beam.reach() * 0.5).sin().powi(2)),
            Kind::Goniometric(lamp) => (lamp.position, 1.0),
            _ => return None,
        };
        let times = self.half_diagonals(position);
        let chance = (0.25 / (times * times * share_of_all)).min(1.0);
        let near = times <= TOO_FAR && chance >= MIN_CHANCE;
        let towards = (self.bounds.centre().as_dvec3() - position.as_dvec3()).normalize_or_zero().as_vec3();
        let intensity = match &emitter.kind {
            Kind::Point(point) => point.intensity,
            Kind::Spot(spot) => spot.intensity * spot.falloff(towards),
            Kind::Beam(beam) => beam.intensity(towards),
            Kind::Goniometric(lamp) => lamp.map.radiance(towards),
            _ => return None,
        };
        if near || intensity.is_black() {
            return None;
        }
        let distance = times * f64::from(self.bounds.radius());
        let irradiance = intensity.map(|i| (f64::from(i) / (distance * distance)) as f32);
        let kind = FarKind::Light { chance, irradiance, direction: towards };
        Some(Far { name: emitter.name.clone(), kind, times })
    }

    /// How far a point is from the middle of all surfaces, in half-diagonals of their bounds.
    fn half_diagonals(&self, point: Vec3) -> f64 {
        (point.as_dvec3() - self.bounds.centre().as_dvec3()).length() / f64::from(self.bounds.radius())
    }
}

impl fmt::Display for Far {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, kind, times } = self;
        write!(f, "{}", quoted(name))?;
        match kind {
            FarKind::Surfaces(others) => {
                if *others > 0 {
                    write!(f, " and {others} more")?;
                }
                let verb = if *others > 0 { "reach" } else { "reaches" };
                if times.is_finite() {
                    write!(f, " {verb} {times:.0e} times as far from the camera as everything else")?;
                } else {
                    write!(f, " {verb} so far that nothing else has a size beside it")?;
                }
                write!(
                    f,
                    ", and single precision does not hold both: what is near comes out coarse, dark or not at all. Make it \
                     smaller or bring it nearer; {FROM_FAR}"
                )
            }
            FarKind::Lamp => write!(
                f,
                " reaches {times:.0e} times as far from the camera as everything else, and few of its photons start where they \
                 matter: its light is noisy. Make it smaller or bring it nearer; {FROM_FAR}"
            ),
            FarKind::Camera => write!(
                f,
                " is {times:.0e} times as far away as the scene is large: in single precision its picture is coarse or empty. \
                 Bring it nearer and widen its field of view"
            ),
            FarKind::Light { chance, irradiance, direction } => {
                let [r, g, b] = irradiance.to_array().map(short);
                let [x, y, z] = direction.to_array().map(short);
                write!(
                    f,
                    " is {times:.0e} times as far away as the scene is large, and about one in {:.0e} of its photons meets the \
                     scene. A \"directional\" emitter with the direction \"{x}, {y}, {z}\" and the irradiance \"{r}, {g}, {b}\" \
                     gives the same light",
                    1.0 / chance
                )
            }
        }
    }
}

/// A number with four digits or so.
fn short(x: f32) -> String {
    match x.abs() {
        0.0 => "0".to_owned(),
        1e-3..1e5 => format!("{}", (x * 1e4).round() / 1e4),
        _ => format!("{x:.3e}"),
    }
}
