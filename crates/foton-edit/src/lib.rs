//! Edits of a scene: picking, moving, setting fields, cameras, undo. Plain data for whoever displays it: no window, no
//! thread and no render here.
//!
//! An [`Edit`] makes the next description from one; the two share what is not edited. Whoever edits then builds the scene.

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
mod target;
mod view;

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
pub use pick::{MARKER_REACH, Picked, anchor, focus_distance, pick, pick_any, pick_light};
pub use target::Target;
