//! Disney's principled model, as Mitsuba 3 has it: for surfaces of closed bodies, and for thin sheets.
//!
//! Sources: Burley 2012 `[BUR12]` for the diffuse lobe, sheen, metals and the clear coat, Burley 2015 `[BUR15]` for transmission
//! and thin sheets. Where they leave a choice, values are those of Mitsuba 3: `tests/tests/bsdf_values.rs` compares them.

mod clear_coat;
mod parameters;
mod scatter;
mod shading;
mod solid;
mod thin;

pub use solid::{Principled, index_of_specular};
pub use thin::PrincipledThin;

#[cfg(test)]
mod tests;
