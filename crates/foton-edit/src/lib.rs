//! Edits of a scene: picking, moving, setting fields, cameras, undo. Plain data for whoever displays it: no window, no
//! thread and no render here.
//!
//! An [`Edit`] makes the next description from one; the two share what is not edited. Whoever edits then builds the scene.

mod additions;
mod apply;
mod camera;
mod camera_xml;
mod contents;
mod edit_error;
mod field;
mod geometry;
mod gizmo;
mod history;
mod inspect;
mod light;
mod material;
mod names;
mod nudge;
mod outline;
mod pick;
mod placing;
mod presets;
mod remake;
mod target;
mod things;
mod view;

#[cfg(test)]
mod tests;

pub use additions::{NewThing, Site};
pub use apply::Edit;
pub use camera::{Camera, FOV_RANGE, LENS, UpAxis, ViewSide};
pub use camera_xml::camera_xml;
pub use contents::{Item, contents};
pub use edit_error::EditError;
pub use field::{Control, Field, FieldId, Property, Side, Value};
pub use gizmo::{Gizmo, Handle, HandleShape, Pull, Tool, nearest};
pub use history::{History, MAX_STEPS};
pub use inspect::{Inspection, MaterialUse, inspect};
pub use names::of as name_of;
pub use nudge::{DragMode, nudge};
pub use outline::{Outline, Segment, markers};
pub use pick::{MARKER_REACH, Picked, anchor, focus_distance, pick, pick_any, pick_light};
pub use presets::{Preset, presets};
pub use remake::Make;
pub use target::Target;
