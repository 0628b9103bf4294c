//! An orthonormal frame around a unit vector.

use glam::Vec3;

/// A right-handed orthonormal frame whose z axis is `normal`.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// Local x in outer coordinates.
    pub tangent: Vec3,
    /// Local y in outer coordinates.
    pub bitangent: Vec3,
    /// Local z in outer coordinates.
    pub normal: Vec3,
}

impl Frame {
    /// The frame of Duff et al., "Building an Orthonormal Basis, Revisited" (2017): no branch, no cancellation. `[DBC17]`
    #[must_use]
    #[inline]
    pub fn from_normal(normal: Vec3) -> Self {
        let sign = 1f32.copysign(normal.z);
        let a = -1.0 / (sign + normal.z);
        let b = normal.x * normal.y * a;
        Self {
            tangent: Vec3::new(1.0 + sign * normal.x * normal.x * a, sign * b, -sign * normal.x),
            bitangent: Vec3::new(b, sign + normal.y * normal.y * a, -normal.y),
            normal,
        }
    }

    /// Outer coordinates of a local vector.
    #[must_use]
    #[inline]
    pub fn to_outer(&self, v: Vec3) -> Vec3 {
        self.tangent * v.x + self.bitangent * v.y + self.normal * v.z
    }

    /// Local coordinates of an outer vector.
    #[must_use]
    #[inline]
    pub fn to_local(&self, v: Vec3) -> Vec3 {
        Vec3::new(v.dot(self.tangent), v.dot(self.bitangent), v.dot(self.normal))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_frame_is_orthonormal_at_the_poles_too() {
        for n in [
            Vec3::Z,
            -Vec3::Z,
            Vec3::X,
            Vec3::new(1e-7, -1e-7, -1.0).normalize(),
            Vec3::new(0.3, -0.8, 0.1).normalize(),
        ] {
            let f = Frame::from_normal(n);
            assert!(f.tangent.dot(f.bitangent).abs() < 1e-6, "{n}");
            assert!((f.tangent.cross(f.bitangent) - n).length() < 1e-6, "{n}");
            let v = Vec3::new(0.2, 0.5, -0.7);
            assert!((f.to_local(f.to_outer(v)) - v).length() < 1e-6, "{n}");
        }
    }
}
