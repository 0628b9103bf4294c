//! What a person has hidden in an editor.

use std::collections::BTreeSet;

/// Shapes and emitters that stay in the description and its file, and are left out of the scene.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Hidden {
    /// Indices of shapes.
    pub shapes: BTreeSet<usize>,
    /// Indices of emitters that are not surfaces.
    pub emitters: BTreeSet<usize>,
}
