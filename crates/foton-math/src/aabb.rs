//! An axis-aligned box.

use glam::Vec3;

/// The axis-aligned box of all points `min ≤ p ≤ max`; empty when `min > max` on an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// The smallest corner.
    pub min: Vec3,
    /// The largest corner.
    pub max: Vec3,
}

impl Aabb {
    /// The box that holds nothing: the neutral element of [`Aabb::union`].
    pub const EMPTY: Self = Self { min: Vec3::INFINITY, max: Vec3::NEG_INFINITY };

    /// The box of a cube around `centre`.
    #[must_use]
    #[inline]
    pub fn around(centre: Vec3, half_size: f32) -> Self {
        Self { min: centre - half_size, max: centre + half_size }
    }

    /// Whether the box holds nothing.
    #[must_use]
    #[inline]
    pub fn is_empty(&self) -> bool {
        !self.min.cmple(self.max).all()
    }

    /// The smallest box that holds this one and `p`.
    #[must_use]
    #[inline]
    pub fn with(self, p: Vec3) -> Self {
        Self { min: self.min.min(p), max: self.max.max(p) }
    }

    /// The smallest box that holds both.
    #[must_use]
    #[inline]
    pub fn union(self, o: Self) -> Self {
        Self { min: self.min.min(o.min), max: self.max.max(o.max) }
    }

    /// Extent along each axis.
    #[must_use]
    #[inline]
    pub fn size(&self) -> Vec3 {
        self.max - self.min
    }

    /// The middle.
    #[must_use]
    #[inline]
    pub fn centre(&self) -> Vec3 {
        (self.min + self.max) * 0.5
    }

    /// Half the length of the diagonal.
    #[must_use]
    #[inline]
    pub fn radius(&self) -> f32 {
        self.size().length() * 0.5
    }
}
