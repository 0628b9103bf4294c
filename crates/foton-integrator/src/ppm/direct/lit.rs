//! What shadow rays find in a block of pixels.

use foton_math::Rgb;
use foton_transport::Omissions;

/// What a block of places has come to.
pub(crate) struct Lit {
    /// Radiance by place, without what is the same each time where that is found apart.
    pub(crate) light: Vec<Rgb>,
    /// What is, where it had not been found yet.
    pub(crate) fixed: Vec<Rgb>,
    pub(crate) rays: u64,
    pub(crate) omissions: Omissions,
}

impl Lit {
    /// Nothing yet.
    pub(crate) fn with_room_for(light: usize, fixed: usize) -> Self {
        Self {
            light: Vec::with_capacity(light),
            fixed: Vec::with_capacity(fixed),
            rays: 0,
            omissions: Omissions::default(),
        }
    }
}
