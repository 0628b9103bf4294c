//! Why an edit cannot be made.

use foton_input::quoted;
use thiserror::Error;

use super::field::Value;

/// Why an edit cannot be made.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum EditError {
    /// The shape, light or camera is not there.
    #[error("there is no such thing in the scene")]
    NoTarget,
    /// It has no such field.
    #[error("{} has no such field", quoted(.0))]
    NoField(String),
    /// The value is of another kind, or out of range.
    #[error("{0} cannot be {1:?}")]
    BadValue(&'static str, Value),
    /// Light from infinity has no place, and a camera is moved by looking around.
    #[error("{} has no place to move from", quoted(.0))]
    CannotMove(String),
    /// It looks the same from all sides, or is a camera.
    #[error("{} cannot be turned", quoted(.0))]
    CannotTurn(String),
    /// It has no size, or would not keep its shape.
    #[error("{} cannot be scaled like that", quoted(.0))]
    CannotScale(String),
    /// It shines nowhere in particular, or the point is where it is.
    #[error("{} cannot be aimed at that point", quoted(.0))]
    CannotAim(String),
    /// A move by NaN, or to infinity.
    #[error("that is not a place")]
    NotFinite,
    /// Names are told apart in files and outputs.
    #[error("the scene has a {} already", quoted(.0))]
    NameTaken(String),
    /// Nothing but white space, or what cannot be shown.
    #[error("{} is no name", quoted(.0))]
    BadName(String),
    /// A scene without a camera shows nothing.
    #[error("a scene needs a camera: this is its last one")]
    LastCamera,
    /// Files have only one light all around.
    #[error("the scene has an environment already, and can have only one")]
    OneSky,
    /// Cameras are not seen anyway.
    #[error("a camera cannot be hidden")]
    CannotHide,
}
