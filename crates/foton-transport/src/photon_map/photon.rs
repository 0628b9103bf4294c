//! The photon as it is stored: 32 bytes.

use foton_math::glam::Vec3;
use foton_math::{Rgb, octahedral};

use crate::lobes::Bounce;

/// How a photon came to where it was stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum PathClass {
    /// Straight from an emitter, also through what lets it pass as if nothing were there: LD.
    Direct = 0,
    /// By specular lobes alone, of which at least one deflected it: LS⁺D.
    Caustic = 1,
    /// By at least one surface that spreads light: L(S|D)*DS*D.
    Indirect = 2,
}

impl PathClass {
    /// All classes, in the order of their numbers.
    pub const ALL: [Self; 3] = [Self::Direct, Self::Caustic, Self::Indirect];

    /// The class after one more scattering.
    pub const fn scattered(self, bounce: Bounce) -> Self {
        match (self, bounce) {
            (_, Bounce::Straight) => self,
            (Self::Direct | Self::Caustic, Bounce::Delta | Bounce::Glossy) => Self::Caustic,
            _ => Self::Indirect,
        }
    }
}

/// Octahedral bits an axis of a stored direction: an error of at most 0.0021 radians, a fiftieth of the narrowest gathered
/// lobe.
const DIRECTION_BITS: u32 = 11;

/// Where in the code the number of the patch begins.
const PATCH_SHIFT: u32 = 2 * DIRECTION_BITS;

/// The class of caustic photons that came from a delta emitter by single directions alone.
const LONE: u32 = 3;

/// A photon where it met a surface that spreads light.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Photon {
    /// Where it was stored.
    pub position: Vec3,
    /// Geometric normal on the side of arrival, in 127ths.
    pub normal: [i8; 3],
    /// Edges from the emitter to here, at least 1.
    pub edges: u8,
    /// Power per channel, not divided by the number of photons (W).
    pub power: Rgb,
    /// Where it came from, the patch that it lies on in the next 8 bits, and its class in the two highest.
    code: u32,
}

impl Photon {
    /// A place holder for buffers.
    pub const NONE: Self =
        Self { position: Vec3::ZERO, normal: [0; 3], edges: 0, power: Rgb::BLACK, code: 0 };

    /// A photon of `power` that arrives from the unit direction `from`, if any hit point needs that, on the side of the unit `normal` and
    /// on the patch of that number.
    #[inline]
    pub fn new(
        position: Vec3,
        normal: Vec3,
        patch: u8,
        from: Option<Vec3>,
        power: Rgb,
        class: PathClass,
        edges: u8,
    ) -> Self {
        let direction = from.map_or(0, octahedral::encode::<DIRECTION_BITS>);
        Self {
            position,
            normal: [in_127ths(normal.x), in_127ths(normal.y), in_127ths(normal.z)],
            edges,
            power,
            code: direction | u32::from(patch) << PATCH_SHIFT | (class as u32) << 30,
        }
    }

    /// Unit direction towards where it came from.
    #[inline]
    pub fn direction(&self) -> Vec3 {
        octahedral::decode::<DIRECTION_BITS>(self.code & ((1 << PATCH_SHIFT) - 1))
    }

    /// The number of edges with the patch in the bits above it, which a hit point tests together.
    #[inline(always)]
    pub fn edges_on_patch(&self) -> i32 {
        i32::from(self.edges) | patch_mark((self.code >> PATCH_SHIFT) as u8)
    }

    /// The patch that it lies on, and the side of it.
    #[inline]
    pub const fn patch(&self) -> u8 {
        (self.code >> PATCH_SHIFT) as u8
    }

    /// Its class.
    #[inline]
    pub const fn class(&self) -> PathClass {
        PathClass::ALL[self.class_index()]
    }

    /// The same, marked if its light reaches narrow specular lobes by photons alone: see [`Photon::is_lone`].
    #[inline]
    pub const fn marked(self, lone: bool) -> Self {
        if lone { Self { code: self.code | LONE << 30, ..self } } else { self }
    }

    /// Whether it came from a delta emitter by mirrors and smooth glass alone, at least one of them: the only light on a specular
    /// lobe that eye paths cannot find.
    #[inline]
    pub const fn is_lone(&self) -> bool {
        self.code >> 30 == LONE
    }

    /// The number of its [`PathClass`].
    #[inline(always)]
    pub const fn class_index(&self) -> usize {
        let class = self.code >> 30;
        if class == LONE { PathClass::Caustic as usize } else { class as usize }
    }
}

/// The number of a patch above those of edges.
#[inline]
pub(super) const fn patch_mark(patch: u8) -> i32 {
    (patch as i32) << 8
}

/// The nearest multiple of 1/127.
#[inline]
fn in_127ths(n: f32) -> i8 {
    (n * 127.0 + 0.5f32.copysign(n)) as i8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stored_photon_takes_32_bytes_and_keeps_its_class_and_direction() {
        assert_eq!(size_of::<Photon>(), 32);
        for class in PathClass::ALL {
            let from = Vec3::new(-0.6, 0.0, -0.8);
            let p = Photon::new(Vec3::ONE, -Vec3::Z, 0xa5, Some(from), Rgb::WHITE, class, 3);
            assert_eq!((p.class_index(), p.normal, p.edges), (class as usize, [0, 0, -127], 3));
            assert_eq!(p.edges_on_patch(), 3 | patch_mark(0xa5));
            assert!(p.direction().distance(from) < 2.1e-3 && !p.is_lone());
        }
        let p = Photon::new(Vec3::ONE, Vec3::Z, 0, None, Rgb::WHITE, PathClass::Caustic, 3).marked(true);
        assert_eq!((p.class_index(), p.is_lone()), (PathClass::Caustic as usize, true));
    }

    #[test]
    fn classes_follow_the_path() {
        use Bounce::{Delta, Gathered, Glossy, Straight};
        use PathClass::{Caustic, Direct, Indirect};
        assert_eq!(Direct.scattered(Delta), Caustic);
        assert_eq!(Caustic.scattered(Glossy), Caustic);
        assert_eq!(Caustic.scattered(Gathered), Indirect);
        assert_eq!(Direct.scattered(Gathered).scattered(Delta), Indirect);
        for class in PathClass::ALL {
            assert_eq!(class.scattered(Straight), class);
        }
    }
}
