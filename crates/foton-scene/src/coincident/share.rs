//! Which primitives and shapes lie in one another.

/// The largest number of primitives that are tested near another: a heap of thousands in one place must not take for ever.
pub(super) const MAX_NEAR: usize = 512;

/// What a primitive has in common with others.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Share {
    /// Whether a part of its surface.
    pub(crate) any: bool,
    /// Whether another may count there, or it is one boundary with another, for light from inside and from outside.
    pub(super) unsettled: [bool; 2],
}

impl Share {
    /// Where only the hit itself can tell.
    pub(super) const UNSETTLED: Self = Self { any: true, unsettled: [true; 2] };

    /// Whether hits from a side are to be settled.
    #[inline(always)]
    pub(crate) const fn is_unsettled(self, outward: bool) -> bool {
        self.unsettled[outward as usize]
    }
}

/// The primitives that share a part of their surface with another.
#[derive(Clone, Debug, Default)]
pub(crate) struct Coincidences {
    /// By primitive in the tree's order; empty where there are none.
    pub(super) shared: Vec<Share>,
    /// By instance: whether any part of its surface lies in another. Empty where there are none.
    pub(super) instances: Vec<bool>,
    /// Pairs of shapes that share a part of a surface, the lower index first, each once, and whether their normals agree.
    pub(super) shapes: Vec<([u32; 2], bool)>,
    /// By shape: how far apart its surface and those in it may be, for rays that start there.
    pub(super) gaps: Vec<f32>,
}

impl Coincidences {
    /// What a primitive of the scene's own has in common with others.
    #[inline(always)]
    pub(crate) fn share(&self, primitive: usize) -> Share {
        self.shared.get(primitive).copied().unwrap_or_default()
    }

    /// Whether a part of an instance lies in another surface.
    pub(crate) fn has_instance(&self, instance: usize) -> bool {
        self.instances.get(instance).copied().unwrap_or(false)
    }

    /// How far from a shape's surface another may lie that counts as the same.
    pub(crate) fn gap(&self, shape: usize) -> f32 {
        self.gaps.get(shape).copied().unwrap_or(0.0)
    }
}
