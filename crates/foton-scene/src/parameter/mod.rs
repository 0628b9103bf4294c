//! Parameters of plugins, declared once: what files, messages, the window and the documentation call them, and what they may be.
//!
//! A declaration stands beside what it describes: with each BSDF in `bsdf/`, with emitters, shapes and textures in
//! `plugins/`. The reader, the writer, saving as an edit, the checks of a build, the inspector and `docs/plugins.md` all go
//! by it.

mod binding;
mod declaration;

pub use binding::{Binding, Slot};
pub use declaration::{Kind, Parameter, Role};
