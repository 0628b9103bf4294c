//! Where light stopped being a number: NaN or infinite.
//!
//! Such values are left out and counted where they arise, always. The first of a pass is noted there as well, on a path that is next
//! to never taken; first is what comes first in the order of tasks, which no number of threads changes. Not here: the counts, which
//! are the ledger's.

use std::fmt;

use foton_input::quoted;
use foton_math::Ray;
use foton_math::glam::{DVec3, Vec3};
use foton_scene::Scene;
use thiserror::Error;

use foton_math::{Cancelled, Suspended};

/// How far in front of a point the ray that looks for its surface starts, in scene units: the scene's half-size is at least a
/// thousand.
const BEFORE: f32 = 0.01;

/// What was not finite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// The power with which a photon left its light.
    EmittedPower,
    /// The power with which a photon left a surface.
    ScatteredPower,
    /// What a photon brings to a hit point, weighed by the BSDF there.
    GatheredLight,
    /// What all photons of a pass together bring to a hit point.
    Irradiance,
    /// What a shadow ray brings to a hit point.
    DirectLight,
    /// The sum of a pixel's hit points.
    PixelSum,
    /// The weight of an eye path.
    EyeWeight,
    /// The emitted light that an eye path sees.
    SeenEmission,
}

impl Quantity {
    /// The name in files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::EmittedPower => "emitted_power",
            Self::ScatteredPower => "scattered_power",
            Self::GatheredLight => "gathered_light",
            Self::Irradiance => "irradiance",
            Self::DirectLight => "direct_light",
            Self::PixelSum => "pixel_sum",
            Self::EyeWeight => "eye_weight",
            Self::SeenEmission => "seen_emission",
        }
    }

    const fn words(self) -> &'static str {
        match self {
            Self::EmittedPower => "the power of a photon that leaves its light",
            Self::ScatteredPower => "the power of a photon that leaves a surface",
            Self::GatheredLight => "what a photon brings to a hit point, weighed by the BSDF,",
            Self::Irradiance => "what all photons together bring to a hit point",
            Self::DirectLight => "what a shadow ray brings to a hit point",
            Self::PixelSum => "the sum of a pixel's hit points",
            Self::EyeWeight => "the weight of an eye path",
            Self::SeenEmission => "the emitted light that an eye path sees",
        }
    }
}

/// The surface of a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Surface {
    /// None, or not known.
    Unknown,
    /// That of this index.
    Shape(u32),
    /// Whichever has the place, seen from where this normal points.
    Below(Vec3),
}

/// A value that was left out, as it is noted where it arises: in scene units and indices.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeftOut {
    /// What it was.
    pub quantity: Quantity,
    /// Index of the emitter that it came from, where it is one.
    pub light: Option<u32>,
    /// Where it arose.
    pub surface: Surface,
    /// In scene units.
    pub position: Vec3,
}

/// How many values a task left out, and the first of them.
#[derive(Clone, Copy, Debug, Default)]
pub struct Omissions {
    /// How many.
    pub count: u64,
    /// The first.
    pub first: Option<LeftOut>,
}

impl Omissions {
    /// One more.
    pub fn add(&mut self, left_out: LeftOut) {
        self.count += 1;
        self.first.get_or_insert(left_out);
    }

    /// With those of the task after this.
    pub fn followed_by(self, next: Self) -> Self {
        Self { count: self.count + next.count, first: self.first.or(next.first) }
    }
}

/// The first value of a render that was not finite, and its place.
#[derive(Clone, Debug, PartialEq, Error)]
pub struct NotFinite {
    /// The pass, from 1; 0: while hit points were collected.
    pub pass: u64,
    /// What it was.
    pub quantity: Quantity,
    /// The light that it came from, by its name; `None`: not of one light, or not known.
    pub light: Option<String>,
    /// The shape and its material, by their names; `None`: not at a surface, or not known.
    pub surface: Option<[String; 2]>,
    /// Where, in world units.
    pub position: DVec3,
}

impl NotFinite {
    /// With the names of what it was at.
    #[must_use]
    pub fn new(scene: &Scene, pass: u64, left_out: LeftOut) -> Self {
        let LeftOut { quantity, light, surface, position } = left_out;
        let shape = match surface {
            Surface::Unknown => None,
            Surface::Shape(shape) => Some(shape),
            Surface::Below(normal) => {
                let normal = normal.normalize_or_zero();
                let ray = Ray { t_max: 2.0 * BEFORE, ..Ray::new(position + normal * BEFORE, -normal) };
                scene.nearest(ray).map(|surface| surface.shape)
            }
        };
        let shape = shape.map(|shape| &scene.shapes()[shape as usize]);
        Self {
            pass,
            quantity,
            light: light.map(|light| scene.emitters()[light as usize].name.clone()),
            surface: shape.map(|s| [s.name.clone(), scene.materials()[s.material as usize].name.clone()]),
            position: scene.normalisation().world_point(position),
        }
    }
}

impl fmt::Display for NotFinite {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.pass {
            0 => f.write_str("before the first pass ")?,
            pass => write!(f, "in pass {pass} ")?,
        }
        write!(f, "{} is not finite (NaN or infinite)", self.quantity.words())?;
        if let Some(light) = &self.light {
            write!(f, ", from the light {}", quoted(light))?;
        }
        if let Some([shape, material]) = &self.surface {
            write!(f, ", at {} of the material {}", quoted(shape), quoted(material))?;
        }
        let DVec3 { x, y, z } = self.position;
        write!(f, ", at the point {x:.6}, {y:.6}, {z:.6}")
    }
}

/// Why a pass is not finished.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum Halt {
    /// Someone asked to stop inside it: it has not happened.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// Someone asked it to make way: the next call goes on with it.
    #[error(transparent)]
    Suspended(#[from] Suspended),
    /// A value was not finite, and the render is to stop at the first of those.
    #[error(transparent)]
    NotFinite(#[from] Box<NotFinite>),
}
