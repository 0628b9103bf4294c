//! Steps of keys: so many pixels in the image to a move in the world.
//!
//! A step is as long as pixels are at the thing's distance, however the camera looks, so that a key never throws a thing to the horizon. A
//! drag is the gizmo's.

use foton_math::glam::DVec3;
use foton_scene::description::SensorDescription;

use super::camera::UpAxis;
use super::view::View;

/// Which way a step goes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DragMode {
    /// On the floor: to the right in the image, and towards the camera.
    #[default]
    Horizontal,
    /// Up and down alone.
    Vertical,
}

/// The move, in world units, of a thing at a world position by so many pixels to the right and downwards. Always finite.
#[must_use]
pub fn nudge(
    sensor: &SensorDescription,
    up: UpAxis,
    at: [f64; 3],
    pixels: [f64; 2],
    mode: DragMode,
) -> [f64; 3] {
    let (view, up) = (View::new(sensor), up.vector());
    let pixel = view.pixel_at(view.depth(at.into()));
    let on_floor = |v: DVec3| (v - up * v.dot(up)).try_normalize();
    // Where the camera looks straight down, what is up in the image is away.
    let away = on_floor(view.forward + view.up * 1e-6).unwrap_or(view.forward);
    let right = on_floor(-view.left).unwrap_or(-view.left);
    let [x, y] = pixels;
    let by = match mode {
        DragMode::Horizontal => right * x - away * y,
        DragMode::Vertical => up * -y,
    } * pixel;
    if by.is_finite() { by.to_array() } else { [0.0; 3] }
}
