//! What directives change for those that follow: transforms, the material, the area light, and so on.

use std::rc::Rc;

use foton_math::glam::{DAffine3, DMat3, DQuat, DVec3};

use super::colour_space::ColourSpace;
use super::parameters::{Parameter, Parameters};
use crate::diagnostic::Place;
use crate::mitsuba::read::properties::Located;

/// The transform when the shutter opens and when it closes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Transforms(pub(crate) [DAffine3; 2]);

impl Transforms {
    pub(crate) const IDENTITY: Self = Self([DAffine3::IDENTITY; 2]);

    pub(crate) fn inverse(self) -> Self {
        Self(self.0.map(|t| t.inverse()))
    }

    /// At the first time.
    pub(crate) const fn first(&self) -> DAffine3 {
        self.0[0]
    }
}

/// A material as a file defines it. It is made when a shape has it.
pub(crate) struct Definition {
    /// The number that tells it from others.
    pub(crate) number: usize,
    /// What it is called, for the description.
    pub(crate) name: String,
    pub(crate) parameters: Parameters,
    /// Those that it is mixed of, in the order in which the file names them.
    pub(crate) parts: Vec<Rc<Self>>,
    /// How many materials it is, those that it is mixed of included.
    pub(crate) size: usize,
}

/// The graphics state.
#[derive(Clone)]
pub(crate) struct State {
    pub(crate) transforms: Transforms,
    /// Which of the transforms directives change.
    pub(crate) active: [bool; 2],
    pub(crate) reverses: bool,
    pub(crate) material: Rc<Definition>,
    pub(crate) area_light: Option<Rc<Parameters>>,
    pub(crate) colour_space: ColourSpace,
    /// Names of the media inside and outside of surfaces, and where that is said.
    pub(crate) media: Option<Located<[String; 2]>>,
    /// Defaults of parameters, by what they are for.
    pub(crate) defaults: Rc<Vec<(String, Parameter)>>,
}

impl State {
    pub(crate) fn new(material: Rc<Definition>) -> Self {
        Self {
            transforms: Transforms::IDENTITY,
            active: [true; 2],
            reverses: false,
            material,
            area_light: None,
            colour_space: ColourSpace::default(),
            media: None,
            defaults: Rc::default(),
        }
    }

    /// Replaces the transforms that are active.
    pub(crate) fn set(&mut self, to: impl Fn(usize) -> DAffine3) {
        for i in (0..2).filter(|i| self.active[*i]) {
            self.transforms.0[i] = to(i);
        }
    }

    /// Puts a transform in front of what is transformed already.
    pub(crate) fn concatenate(&mut self, transform: DAffine3) {
        for i in (0..2).filter(|i| self.active[*i]) {
            self.transforms.0[i] *= transform;
        }
    }
}

/// What an end closes.
pub(crate) enum Open {
    Attribute(Box<State>),
    Transform(Transforms, [bool; 2]),
    Object(Box<State>),
}

/// Something that is open, and where it was opened.
pub(crate) struct Opened {
    pub(crate) what: Open,
    pub(crate) place: Place,
}

/// World to camera: `None` where eye and target are one, or the direction is that of `up`.
pub(crate) fn look_at(eye: DVec3, target: DVec3, up: DVec3) -> Option<DAffine3> {
    let forward = (target - eye).try_normalize()?;
    let right = up.try_normalize()?.cross(forward).try_normalize()?;
    let up = forward.cross(right);
    Some(DAffine3::from_mat3_translation(DMat3::from_cols(right, up, forward), eye).inverse())
}

/// A turn by degrees about an axis; `None` for an axis of no length.
pub(crate) fn rotation(degrees: f64, axis: DVec3) -> Option<DAffine3> {
    let axis = axis.try_normalize()?;
    Some(DAffine3::from_quat(DQuat::from_axis_angle(axis, degrees.to_radians())))
}

/// The transform that sixteen numbers state, a column after the other; `None` where its last row is not 0 0 0 1.
pub(crate) fn of_columns(m: &[f64; 16]) -> Option<DAffine3> {
    let is_affine = [m[3], m[7], m[11], m[15] - 1.0].iter().all(|c| c.abs() < 1e-6);
    let column = |i: usize| DVec3::new(m[i], m[i + 1], m[i + 2]);
    is_affine.then(|| DAffine3::from_cols(column(0), column(4), column(8), column(12)))
}
