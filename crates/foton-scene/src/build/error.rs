//! Why a description makes no scene.

use foton_input::quoted;
use foton_math::Cancelled;
use thiserror::Error;

/// Why a description makes no scene. Names are those of the scene file.
#[derive(Debug, Error, PartialEq)]
pub enum BuildError {
    /// There is nothing to look through.
    #[error("the scene has no sensor")]
    NoSensor,
    /// A camera's numbers make no image.
    #[error("sensor {}: its field of view, size, lens or transform makes no image", quoted(.0))]
    BadSensor(String),
    /// A coordinate, or what an emitter emits, is NaN or infinite.
    #[error("{} has a coordinate or an emission that is not finite", quoted(.0))]
    NotFinite(String),
    /// Light whose power, or that of its photons, single precision does not hold.
    #[error(
        "{} emits more than single precision holds: of its {emission:.1e}, this scene can take up to about {most:.0e}. \
         Divide the emission of all lights by one number: the image is darker by that, and otherwise the same",
        quoted(name)
    )]
    TooBright {
        /// The emitter.
        name: String,
        /// The largest component of what it emits, in the unit of the file.
        emission: f64,
        /// What it may emit.
        most: f64,
    },
    /// Light so weak in so large a scene that single precision does not hold it.
    #[error(
        "{} emits less than single precision holds in so large a scene: of its {emission:.1e}, at least {least:.0e} \
         is needed. Multiply the emission of all lights by one number, or give the scene in a larger unit",
        quoted(name)
    )]
    TooDim {
        /// The emitter.
        name: String,
        /// The largest component of what it emits, in the unit of the file.
        emission: f64,
        /// What it must emit.
        least: f64,
    },
    /// A light or camera whose distance single precision does not hold.
    #[error(
        "{} is {times:.0e} times as far away as the scene is large, and single precision holds no such distance: bring it \
         nearer. For light from far away there is the \"directional\" emitter",
        quoted(name)
    )]
    TooFar {
        /// The emitter or sensor.
        name: String,
        /// Its distance in half-sizes of the scene.
        times: f64,
    },
    /// A material is blended of itself, of one that is not there, or of too many.
    #[error("material {}: it is blended of itself, or of too many others", quoted(.0))]
    BadMixture(String),
    /// A transform flattens the shape.
    #[error("shape {}: its transform cannot be inverted", quoted(.0))]
    Singular(String),
    /// A transform makes a sphere, a disc or the cone of a spot something else.
    #[error("{}: a sphere, a disc, a tube or a spot can only be turned, moved and scaled evenly", quoted(.0))]
    NotRound(String),
    /// A triangle names a vertex that is not there, or normals do not match positions.
    #[error("shape {} has a triangle or normals that do not fit its vertices", quoted(.0))]
    BadMesh(String),
    /// A shape names a material that is not there.
    #[error("shape {} names a material that is not there", quoted(.0))]
    NoMaterial(String),
    /// A material or an environment names a texture that is not there, or one without pixels.
    #[error("{} names a texture that is not there or has no pixels", quoted(.0))]
    NoTexture(String),
    /// A colour of a texture is not what its surface takes, its transform is not finite, or it is made of itself.
    #[error(
        "texture {} has colours that are not numbers, from 0 to 1 where they are shares of light, a transform that is \
         not finite, or other textures that do not stand before it or are too deep", quoted(.0))]
    BadTexture(String),
    /// A texture shows what a shape does not have.
    #[error("shape {} has no attribute {} for its texture", quoted(shape), quoted(attribute))]
    NoAttribute {
        /// The shape.
        shape: String,
        /// What it lacks.
        attribute: String,
    },
    /// A material's number is one that no surface has.
    #[error(
        "material {} has a share of light that is not a number from 0 to 1, or an index of refraction or a roughness that \
         is not a number above zero", quoted(.0))]
    BadMaterial(String),
    /// More primitives than indices.
    #[error("the scene has more than 2^31 primitives")]
    TooLarge,
    /// Someone asked to stop: nothing is wrong with the description.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl BuildError {
    /// The part of the scene that it is about, by its name.
    #[must_use]
    pub fn part(&self) -> Option<&str> {
        match self {
            Self::NoSensor | Self::TooLarge | Self::Cancelled(_) => None,
            Self::BadSensor(name)
            | Self::NotFinite(name)
            | Self::TooBright { name, .. }
            | Self::TooDim { name, .. }
            | Self::TooFar { name, .. }
            | Self::NoAttribute { shape: name, .. }
            | Self::Singular(name)
            | Self::NotRound(name)
            | Self::BadMesh(name)
            | Self::BadMixture(name)
            | Self::NoMaterial(name)
            | Self::NoTexture(name)
            | Self::BadTexture(name)
            | Self::BadMaterial(name) => Some(name),
        }
    }
}
