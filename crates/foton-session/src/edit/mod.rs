//! Editing a scene: picking, moving, setting fields, cameras, undo. Plain data for whoever shows it; no window here.
//!
//! An [`Edit`] makes the next description from one; what is not edited is shared between them. The scene is built anew.

mod apply;
mod camera;
mod camera_xml;
mod drag;
mod field;
mod geometry;
mod history;
mod inspect;
mod light;
mod material;
mod outline;
mod pick;
mod view;

#[cfg(test)]
mod camera_tests;
#[cfg(test)]
mod tests;

pub use apply::{Edit, EditError};
pub use camera::{Camera, FOV_RANGE, UpAxis};
pub use camera_xml::camera_xml;
pub use drag::{DragMode, DragPlane};
pub use field::{Control, Field, FieldId, Property, Side, Value};
pub use history::{History, MAX_STEPS};
pub use inspect::{Inspection, MaterialUse, inspect};
pub use outline::{Outline, Segment, markers};
pub(crate) use pick::middle;
pub use pick::{MARKER_REACH, Picked, focus_distance, pick, pick_any, pick_light};

/// Something that can be chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Target {
    /// Index into the description's shapes.
    Shape(usize),
    /// Index into the description's emitters: a light without a surface.
    Emitter(usize),
}
