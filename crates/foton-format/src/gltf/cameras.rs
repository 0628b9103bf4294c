//! Cameras. One of glTF looks along its −z with +x to the right, one of ours along its +z with +x to the left.

use foton_math::glam::{DAffine3, DMat3, DVec3};
use foton_scene::description::{FovAxis, Projection, SensorDescription};

use super::json::At;
use super::reader::Reader;
use crate::diagnostic::Report;

/// Pixels of an image; a camera says only how wide it is by its height.
const PIXELS: f64 = 768.0 * 576.0;

/// The widest and the narrowest image, by width over height.
const ASPECTS: (f64, f64) = (0.05, 20.0);

/// The aspect of an image that says none.
const ASPECT: f64 = 4.0 / 3.0;

impl<'a> Reader<'a> {
    /// Adds the camera of a node.
    pub(super) fn camera(&mut self, node: &At<'a>, camera: &At<'a>, global: &DAffine3, name: &str) {
        let report = &mut self.report;
        let kind = camera.text("type", report);
        let Some(lens) = kind.and_then(|kind| camera.get(kind)) else {
            return camera.error(report, "needs a \"type\", perspective or orthographic, and what that says");
        };
        let Some(to_world) = looking(global) else {
            return node.error(report, "a camera stands in a node that is scaled to nothing");
        };
        let sensor = match kind {
            Some("perspective") => perspective(&lens, to_world, report),
            Some("orthographic") => orthographic(&lens, to_world, report),
            _ => None,
        };
        let Some(sensor) = sensor else { return };
        let clip = |depth: Option<f64>| depth.filter(|depth| *depth > 0.0);
        let (near_clip, far_clip) = (clip(lens.number("znear", report)), clip(lens.number("zfar", report)));
        let name = self.unique(name);
        self.description.sensors.push(SensorDescription { name, near_clip, far_clip, ..sensor });
    }
}

fn perspective(lens: &At<'_>, to_world: DAffine3, report: &mut Report) -> Option<SensorDescription> {
    let fov_degrees = lens.number("yfov", report).unwrap_or(0.0).to_degrees();
    if !(fov_degrees > 0.0 && fov_degrees < 180.0) {
        lens.error(report, "needs a \"yfov\" above 0 and below π");
        return None;
    }
    let aspect = lens.number("aspectRatio", report).filter(|aspect| *aspect > 0.0).unwrap_or(ASPECT);
    let (width, height) = size(aspect);
    let fov_axis = FovAxis::Y;
    Some(SensorDescription { to_world, fov_degrees, fov_axis, width, height, ..SensorDescription::default() })
}

fn orthographic(lens: &At<'_>, to_world: DAffine3, report: &mut Report) -> Option<SensorDescription> {
    let [half_width, half_height] =
        ["xmag", "ymag"].map(|key| lens.number(key, report).map_or(0.0, f64::abs));
    if !(half_width > 0.0 && half_height > 0.0) {
        lens.error(report, "needs an \"xmag\" and a \"ymag\" other than 0");
        return None;
    }
    let (width, height) = size(half_width / half_height);
    let to_world = to_world * DAffine3::from_scale(DVec3::new(half_width, half_width, 1.0));
    let projection = Projection::Orthographic;
    Some(SensorDescription { to_world, projection, width, height, ..SensorDescription::default() })
}

/// Where a camera stands and looks, without the scale of its node; `None` where that leaves it no direction.
fn looking(global: &DAffine3) -> Option<DAffine3> {
    let m = global.matrix3;
    let back = m.z_axis.try_normalize()?;
    let up = (m.y_axis - back * back.dot(m.y_axis)).try_normalize()?;
    let matrix = DMat3::from_cols(up.cross(-back), up, -back);
    Some(DAffine3::from_mat3_translation(matrix, global.translation))
}

/// Width and height in pixels, even and of about as many as all images of files that say no size.
fn size(aspect: f64) -> (u32, u32) {
    let aspect = aspect.clamp(ASPECTS.0, ASPECTS.1);
    let even = |pixels: f64| 2 * (0.5 * pixels).round().max(1.0) as u32;
    (even((PIXELS * aspect).sqrt()), even((PIXELS / aspect).sqrt()))
}

#[cfg(test)]
mod tests {
    use foton_math::glam::DQuat;

    use super::*;

    #[test]
    fn images_have_the_aspect_of_their_camera() {
        assert_eq!((size(4.0 / 3.0), size(1.0), size(1e9)), ((768, 576), (666, 666), (2974, 148)));
    }

    #[test]
    fn cameras_look_along_their_minus_z_whatever_the_scale() {
        let turn = DAffine3::from_rotation_translation(DQuat::from_rotation_y(0.5), DVec3::X);
        let found = looking(&(turn * DAffine3::from_scale(DVec3::new(2.0, 3.0, -4.0)))).expect("a direction");
        let plain = looking(&turn).expect("a direction");
        assert!((plain.matrix3 * DVec3::Z + turn.matrix3 * DVec3::Z).length() < 1e-12);
        assert!((plain.matrix3 * DVec3::X + turn.matrix3 * DVec3::X).length() < 1e-12);
        assert!((found.matrix3 * DVec3::Y - turn.matrix3 * DVec3::Y).length() < 1e-12);
        assert!((found.matrix3.determinant() - 1.0).abs() < 1e-12);
        assert!(looking(&DAffine3::from_scale(DVec3::ZERO)).is_none());
    }
}
