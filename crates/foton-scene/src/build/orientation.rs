//! How shapes and emitters are turned.

use foton_math::glam::{DAffine3, DMat3, Mat3};

/// Scene to object space, turning only.
pub(super) fn orientation(to_world: &DAffine3) -> Mat3 {
    let m = to_world.matrix3;
    let turn = DMat3::from_cols(m.x_axis.normalize(), m.y_axis.normalize(), m.z_axis.normalize());
    turn.transpose().as_mat3()
}
