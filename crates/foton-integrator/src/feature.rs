//! Parts of the renderer that a scene or settings may ask for.

use std::borrow::Cow;

/// A part of the renderer that a scene may or may not need.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Feature {
    /// Its name.
    pub name: &'static str,
    /// Whether it is in the passes.
    pub on: bool,
    /// What was found, or not found.
    pub why: &'static str,
    /// What it costs while it is on.
    pub cost: Cow<'static, str>,
    /// Bytes a hit point while it is on.
    pub bytes_per_hit_point: usize,
    /// Bytes a pixel while it is on.
    pub bytes_per_pixel: usize,
}

impl Feature {
    /// A part that costs no memory for each hit point or pixel. `why` has what was found, and what was not.
    pub(crate) fn new(
        name: &'static str,
        on: bool,
        why: [&'static str; 2],
        cost: impl Into<Cow<'static, str>>,
    ) -> Self {
        let [found, absent] = why;
        let why = if on { found } else { absent };
        Self { name, on, why, cost: cost.into(), bytes_per_hit_point: 0, bytes_per_pixel: 0 }
    }

    pub(crate) fn with_bytes(self, bytes_per_hit_point: usize, bytes_per_pixel: usize) -> Self {
        Self { bytes_per_hit_point, bytes_per_pixel, ..self }
    }
}
