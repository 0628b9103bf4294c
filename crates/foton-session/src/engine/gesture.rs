//! What a person does to a camera.

use foton_edit::ViewSide;

/// A move of the camera. Angles in radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Gesture {
    /// Around what it looks at.
    Orbit {
        /// Around the up axis.
        yaw: f64,
        /// Above the horizon.
        pitch: f64,
    },
    /// Where it stands.
    Turn {
        /// Around the up axis.
        yaw: f64,
        /// Above the horizon.
        pitch: f64,
    },
    /// Across the view, in pixels of what it looks at.
    Pan {
        /// To the image's right.
        right: f64,
        /// Downwards.
        down: f64,
    },
    /// Multiplies the distance to what it looks at; for an orthographic camera, how much of it the image shows.
    Zoom(f64),
    /// As shares of the distance to what it looks at.
    Fly {
        /// The way it looks.
        forward: f64,
        /// To the image's right.
        right: f64,
        /// Up.
        up: f64,
    },
    /// In degrees along the sensor's own axis.
    FieldOfView(f64),
    /// How wide the image of an orthographic camera is, in world units.
    Width(f64),
    /// Looks at the same along an axis of the world.
    Face(ViewSide),
    /// Radius of the lens in world units, 0 for a pinhole.
    Aperture(f64),
    /// Depth at which the lens shows things sharp, in world units.
    FocusDistance(f64),
    /// Focuses the lens on what is seen at a film position.
    FocusAt([f64; 2]),
}
