//! A camera as a person moves it: around a target, at a distance, by two angles.
//!
//! With h = cos y · A + sin y · B (A and B the level axes, y the yaw, p the pitch, U up) it looks along
//! cos p · h + sin p · U, and its image's up is −sin p · h + cos p · U, rolled. Nothing here degenerates at the poles. A
//! camera that was not moved keeps its transform to the last bit.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use foton_math::glam::{DAffine3, DMat3, DVec3};
use foton_scene::description::{Lens, Projection, SensorDescription};
use foton_scene::parameter::Parameter;
use foton_scene::plugins::sensors;

use super::view::View;

/// What is declared of a lens: its aperture radius and its focus distance.
pub const LENS: [Parameter; 2] = [sensors::APERTURE_RADIUS, sensors::FOCUS_DISTANCE];

/// Fields of view that a person can set, in degrees.
pub const FOV_RANGE: (f64, f64) = (1.0, 170.0);

/// Which axis of the world points up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum UpAxis {
    /// +y, as in most scenes.
    #[default]
    Y,
    /// +z, as in scenes of architects and printers.
    Z,
}

impl UpAxis {
    /// The axis nearest to the camera's own up; of cameras that stand level in one of them, that one.
    #[must_use]
    pub fn guess(sensor: &SensorDescription) -> Self {
        let view = View::new(sensor);
        let is_level = |axis: DVec3| view.left.dot(axis).abs() < 1e-3;
        match (is_level(DVec3::Y), is_level(DVec3::Z)) {
            (true, false) => Self::Y,
            (false, true) => Self::Z,
            _ if view.up.y.abs() >= view.up.z.abs() => Self::Y,
            _ => Self::Z,
        }
    }

    /// As a unit vector.
    #[must_use]
    pub(crate) const fn vector(self) -> DVec3 {
        match self {
            Self::Y => DVec3::Y,
            Self::Z => DVec3::Z,
        }
    }

    /// The level axes, so that with the up axis they are right-handed.
    pub(crate) const fn level(self) -> (DVec3, DVec3) {
        match self {
            Self::Y => (DVec3::Z, DVec3::X),
            Self::Z => (DVec3::X, DVec3::Y),
        }
    }

    /// The unit vector of a yaw and a pitch in radians.
    pub(crate) fn direction(self, yaw: f64, pitch: f64) -> DVec3 {
        let (a, b) = self.level();
        (a * yaw.cos() + b * yaw.sin()) * pitch.cos() + self.vector() * pitch.sin()
    }

    /// The yaw and pitch in radians of a direction other than zero; of one straight up or down the yaw is 0.
    pub(crate) fn angles(self, direction: DVec3) -> (f64, f64) {
        let (a, b) = self.level();
        let (x, y) = (direction.dot(a), direction.dot(b));
        let level = x.hypot(y);
        let yaw = if level > 0.0 { y.atan2(x) } else { 0.0 };
        (yaw, direction.dot(self.vector()).atan2(level))
    }
}

/// A side from which a scene is looked at along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ViewSide {
    /// From the front: from +z where y points up, from −y where z does.
    Front,
    /// From the right: from +x.
    Side,
    /// From above.
    Top,
}

impl ViewSide {
    /// All of them, in the order of the window.
    pub const ALL: [Self; 3] = [Self::Front, Self::Side, Self::Top];

    /// Its name on a button.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Front => "Front",
            Self::Side => "Side",
            Self::Top => "Top",
        }
    }

    /// The way that a camera there looks; from above, the way that is up in its image.
    const fn looks(self, up: UpAxis) -> DVec3 {
        match (self, up) {
            (Self::Side, _) => DVec3::NEG_X,
            (_, UpAxis::Y) => DVec3::NEG_Z,
            (_, UpAxis::Z) => DVec3::Y,
        }
    }
}

/// A camera around a target. Angles in radians.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    /// What it turns around, in world units.
    pub target: [f64; 3],
    /// From the target, in world units.
    pub distance: f64,
    /// Around the up axis.
    pub yaw: f64,
    /// Above the horizon that it looks; −π/2 is straight down.
    pub pitch: f64,
    /// By which the image is turned.
    pub roll: f64,
    /// Which way is up.
    pub up: UpAxis,
    /// Field of view along the sensor's axis, in degrees.
    pub fov_degrees: f64,
    /// What blurs things out of focus.
    pub lens: Option<Lens>,
    /// Factor on the width of what an orthographic camera sees.
    widened: f64,
    projection: Projection,
    /// Whether left and right are exchanged in the image.
    mirrored: bool,
    /// The camera of the file, and what its transform became.
    original: Box<(DAffine3, f64)>,
    is_moved: bool,
    /// Its distance when it was made: what bounds zooming.
    scale: f64,
}

impl Camera {
    /// The camera of a sensor, its target `distance` ahead.
    #[must_use]
    pub fn new(sensor: &SensorDescription, distance: f64) -> Self {
        let distance = if distance.is_finite() && distance > 0.0 { distance } else { 1.0 };
        let view = View::new(sensor);
        let up = UpAxis::guess(sensor);
        let (mut yaw, pitch) = up.angles(view.forward);
        if view.forward.dot(up.vector()).abs() > 1.0 - 1e-12 {
            // At a pole the image's up says where the camera is turned.
            yaw = up.angles(view.up * -view.forward.dot(up.vector())).0;
        }
        let mut camera = Self {
            target: (view.origin + view.forward * distance).to_array(),
            distance,
            yaw,
            pitch,
            roll: 0.0,
            up,
            fov_degrees: sensor.fov_degrees,
            lens: sensor.lens,
            widened: 1.0,
            projection: sensor.projection,
            mirrored: sensor.to_world.matrix3.determinant() < 0.0,
            original: Box::new((sensor.to_world, sensor.fov_degrees)),
            is_moved: false,
            scale: distance,
        };
        let [left, level_up, _] = camera.axes();
        camera.roll = view.up.dot(left).atan2(view.up.dot(level_up));
        camera
    }

    /// The image's left, its up, and the way it looks: rolled, but not mirrored.
    fn axes(&self) -> [DVec3; 3] {
        let forward = self.up.direction(self.yaw, self.pitch);
        let up = self.up.direction(self.yaw, self.pitch + FRAC_PI_2);
        let left = up.cross(forward);
        let (sin, cos) = self.roll.sin_cos();
        [left * cos - up * sin, up * cos + left * sin, forward]
    }

    /// Where it stands, in world units.
    #[must_use]
    pub fn position(&self) -> [f64; 3] {
        let [.., forward] = self.axes();
        (DVec3::from(self.target) - forward * self.distance).to_array()
    }

    /// Camera to world, as in [`SensorDescription::to_world`].
    #[must_use]
    pub fn to_world(&self) -> DAffine3 {
        if !self.is_moved {
            return self.original.0;
        }
        let [left, up, forward] = self.axes();
        let left = if self.mirrored { -left } else { left };
        let mut axes = DMat3::from_cols(left, up, forward);
        if self.projection == Projection::Orthographic {
            let was = self.original.0.matrix3;
            let [x, y] = [was.x_axis, was.y_axis].map(|axis| axis.length() * self.widened);
            axes *= DMat3::from_diagonal(DVec3::new(x, y, was.z_axis.length()));
        }
        DAffine3::from_mat3_translation(axes, self.position().into())
    }

    /// The sensor with this camera's place, field of view and lens.
    #[must_use]
    pub fn applied_to(&self, sensor: &SensorDescription) -> SensorDescription {
        let (to_world, fov_degrees, lens) = (self.to_world(), self.fov_degrees, self.lens);
        SensorDescription { to_world, fov_degrees, lens, ..sensor.clone() }
    }

    /// Turns around the target, by angles in radians; a positive pitch lets it look further up.
    pub fn orbit(&mut self, yaw: f64, pitch: f64) {
        self.turn(yaw, pitch);
    }

    /// Looks at the target along an axis of the world, level and from the same distance.
    pub fn face(&mut self, side: ViewSide) {
        self.is_moved = true;
        (self.yaw, self.pitch) = self.up.angles(side.looks(self.up));
        if side == ViewSide::Top {
            self.pitch = -FRAC_PI_2;
        }
        self.roll = 0.0;
    }

    /// Turns on the spot.
    pub fn look(&mut self, yaw: f64, pitch: f64) {
        let position = DVec3::from(self.position());
        self.turn(yaw, pitch);
        let [.., forward] = self.axes();
        self.target = (position + forward * self.distance).to_array();
    }

    fn turn(&mut self, yaw: f64, pitch: f64) {
        if yaw.is_finite() && pitch.is_finite() {
            self.is_moved = true;
            self.yaw = (self.yaw + yaw + PI).rem_euclid(TAU) - PI;
            self.pitch = (self.pitch + pitch).clamp(-FRAC_PI_2, FRAC_PI_2);
        }
    }

    /// Moves along the image by pixels, as if its target were held: to the right and down.
    pub fn pan(&mut self, sensor: &SensorDescription, right: f64, down: f64) {
        let (fov_degrees, to_world) = (self.fov_degrees, self.to_world());
        let seen = SensorDescription { fov_degrees, to_world, ..sensor.clone() };
        let pixel = View::new(&seen).pixel_at(self.distance);
        let side = if self.mirrored { -1.0 } else { 1.0 };
        self.shift([side * right * pixel, down * pixel, 0.0]);
    }

    /// Nearer (below 1) or farther (above 1), towards the target; an orthographic camera sees less or more where it stands.
    pub fn zoom(&mut self, factor: f64) {
        if self.projection == Projection::Orthographic {
            self.set_width(self.width() * factor);
        } else if factor.is_finite() && factor > 0.0 {
            self.is_moved = true;
            self.distance = (self.distance * factor).clamp(1e-6 * self.scale, 1e6 * self.scale);
        }
    }

    /// Flies, target and all, by world units: forward, to the right and along the up axis.
    pub fn fly(&mut self, forward: f64, right: f64, up: f64) {
        let side = if self.mirrored { 1.0 } else { -1.0 };
        self.shift([side * right, 0.0, forward]);
        self.target = (DVec3::from(self.target) + self.up.vector() * up).to_array();
    }

    /// Along the image's left and up, and forward.
    fn shift(&mut self, by: [f64; 3]) {
        if by.iter().all(|x| x.is_finite()) {
            self.is_moved = true;
            let moved: DVec3 = self.axes().iter().zip(by).map(|(axis, by)| *axis * by).sum();
            self.target = (DVec3::from(self.target) + moved).to_array();
        }
    }

    /// Looks at another target from where it stands: what a person clicked to turn around.
    pub fn focus(&mut self, distance: f64) {
        if distance.is_finite() && distance > 0.0 {
            let [.., forward] = self.axes();
            self.target = (DVec3::from(self.position()) + forward * distance).to_array();
            self.distance = distance;
        }
    }

    /// Sets the field of view in degrees, within [`FOV_RANGE`].
    pub fn set_fov(&mut self, degrees: f64) {
        if degrees.is_finite() {
            self.fov_degrees = degrees.clamp(FOV_RANGE.0, FOV_RANGE.1);
        }
    }

    /// How much of the world the image of an orthographic camera is wide; of another one without meaning.
    #[must_use]
    pub fn width(&self) -> f64 {
        2.0 * self.original.0.matrix3.x_axis.length() * self.widened
    }

    /// Sets how wide that is, in world units: its height goes with it.
    pub fn set_width(&mut self, width: f64) {
        let widened = width / (2.0 * self.original.0.matrix3.x_axis.length());
        if widened.is_finite() && widened > 0.0 {
            self.is_moved = true;
            self.widened = widened.clamp(1e-6, 1e6);
        }
    }

    /// Sets the radius of the lens in world units, 0 for a pinhole. A new lens is focused on the target.
    pub fn set_aperture(&mut self, radius: f64) {
        if radius.is_finite() && radius >= 0.0 {
            let focus_distance = self.lens.map_or(self.distance, |lens| lens.focus_distance);
            self.lens = Some(Lens { aperture_radius: radius, focus_distance });
        }
    }

    /// Sets the depth at which things are sharp, in world units. A camera without a lens stays without one.
    pub fn set_focus(&mut self, distance: f64) {
        if let Some(lens) = &mut self.lens
            && distance.is_finite()
            && distance > 0.0
        {
            lens.focus_distance = distance;
        }
    }

    /// Back to the camera as it was opened.
    pub fn reset(&mut self, sensor: &SensorDescription) {
        let original =
            SensorDescription { to_world: self.original.0, fov_degrees: self.original.1, ..sensor.clone() };
        *self = Self::new(&original, self.scale);
    }

    /// Whether its place is another than the file's.
    #[must_use]
    pub const fn is_moved(&self) -> bool {
        self.is_moved
    }
}
