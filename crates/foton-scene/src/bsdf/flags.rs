//! Which kinds of lobes a BSDF has, and which of them are meant.

use std::ops::BitOr;

/// A set of kinds of lobes, as in pbrt and Mitsuba: how light spreads (`DIFFUSE`, `GLOSSY`, `DELTA`) and to which side
/// (`REFLECTION`, `TRANSMISSION`, of which `STRAIGHT` is the part that does not change direction).
///
/// Functions that take a set of lobes go by its kinds of spreading alone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct LobeFlags(u8);

impl LobeFlags {
    /// No lobe.
    pub const NONE: Self = Self(0);
    /// Light that spreads in all directions.
    pub const DIFFUSE: Self = Self(1);
    /// Light that spreads around a direction, as wide as the roughness says.
    pub const GLOSSY: Self = Self(1 << 1);
    /// Light that goes in a single direction.
    pub const DELTA: Self = Self(1 << 2);
    /// Light that stays on its side of the surface.
    pub const REFLECTION: Self = Self(1 << 3);
    /// Light that goes to the other side.
    pub const TRANSMISSION: Self = Self(1 << 4);
    /// Light that goes to the other side in the direction that it had.
    pub const STRAIGHT: Self = Self(1 << 5);
    /// Every lobe.
    pub const ALL: Self = Self(0b11_1111);

    /// Those of either set.
    #[must_use]
    pub const fn or(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Those of this set that are not in the other.
    #[must_use]
    pub const fn without(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }

    /// Whether any flag is in both sets.
    #[must_use]
    pub const fn intersects(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }

    /// Whether light spreads by any of these lobes, as it does by all but delta ones.
    #[must_use]
    pub const fn spreads(self) -> bool {
        self.intersects(Self::DIFFUSE.or(Self::GLOSSY))
    }

    /// The flags for how light spreads, without those for the side.
    #[must_use]
    pub const fn spreading(self) -> Self {
        Self(self.0 & (Self::DIFFUSE.0 | Self::GLOSSY.0 | Self::DELTA.0))
    }
}

impl BitOr for LobeFlags {
    type Output = Self;

    fn bitor(self, other: Self) -> Self {
        self.or(other)
    }
}
