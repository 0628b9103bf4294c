//! What files, the window and the documentation say of a BSDF.

use crate::parameter::Binding;

/// What a model is called.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BsdfInfo {
    /// Its kind in the window.
    pub label: &'static str,
    /// What it is, in a sentence.
    pub help: &'static str,
    /// The plugin of Mitsuba that means the same, where the surface is smooth.
    pub plugin: &'static str,
    /// The plugin that means the same with microfacets; `None`: there is none.
    pub rough_plugin: Option<&'static str>,
    /// A value that tells it from another model of the same plugin: tag, name and value in files.
    pub stated: Option<[&'static str; 3]>,
    /// Whether Mitsuba 3 has the plugin; the others are of Mitsuba 0.6.
    pub is_of_mitsuba_3: bool,
}

/// What the file of each BSDF declares of it.
pub(super) trait Described: Sized {
    /// What it is called.
    const INFO: BsdfInfo;

    /// As a file means it that gives no parameters.
    fn default(rough: bool) -> Self;

    /// As a surface begins that becomes one in the window.
    fn preset() -> Self;

    /// Its parameters, in the order of files and of the inspector, with the places of their values.
    fn parameters(&mut self) -> Vec<Binding<'_>>;
}
