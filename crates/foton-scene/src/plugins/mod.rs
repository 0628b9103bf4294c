//! Plugins of scene files but BSDFs, with the parameters that each declares: what the reader, the writer, the inspector and the
//! documentation call them. A BSDF declares its own in its file (`bsdf/`).

pub mod emitters;
pub mod sensors;
pub mod shapes;
pub mod stand_ins;
pub mod textures;
pub mod wrappers;

use crate::parameter::Parameter;

/// A plugin of a scene file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plugin {
    /// Its name in files, that of Mitsuba 3.
    pub name: &'static str,
    /// Its kind in the window; empty: it is not there by itself.
    pub label: &'static str,
    /// What it is, in a sentence.
    pub help: &'static str,
    /// What it takes.
    pub parameters: &'static [Parameter],
}

/// The names of plugins.
pub fn names(plugins: &'static [Plugin]) -> impl Iterator<Item = &'static str> {
    plugins.iter().map(|p| p.name)
}
