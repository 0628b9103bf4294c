//! A scene file to a description: `reader.rs` walks it, and each kind of plugin has a file.

mod animation;
mod attributes;
pub(crate) mod bsdfs;
pub(crate) mod colours;
pub(crate) mod emitters;
pub(crate) mod ids;
pub(crate) mod include;
mod instances;
pub(crate) mod integrator;
pub(crate) mod known;
pub(crate) mod materials;
pub(crate) mod metals;
pub(crate) mod properties;
pub(crate) mod reader;
pub(crate) mod sensor;
pub(crate) mod shapes;
pub(crate) mod sky;
pub(crate) mod spectra;
pub(crate) mod spectrum;
pub(crate) mod stand_ins;
pub(crate) mod substitute;
pub(crate) mod textures;
pub(crate) mod transform;
pub(crate) mod upgrade;
pub(crate) mod usage;
pub(crate) mod values;
pub(crate) mod wrappers;
