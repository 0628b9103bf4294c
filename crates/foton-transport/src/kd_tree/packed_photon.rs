//! A photon in 20 bytes: position 12, power 4, direction 2, flags 2. `[JEN96]`

use foton_math::glam::Vec3;
use foton_math::{Rgb, octahedral};

use super::rgbe::Rgbe;
use crate::photon_map::PathClass;

/// Bytes of a photon.
pub const PACKED_BYTES: usize = 20;

/// More edges than this count as this many.
pub const MAX_EDGES: u8 = 15;

/// Octahedral bits an axis of the direction: an error of at most 0.017 radians, a sixth of the narrowest gathered lobe.
const DIRECTION_BITS: u32 = 8;

/// What a photon of a map that stays stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum MapClass {
    /// Light straight from an emitter.
    Direct = 0,
    /// Light by specular lobes alone.
    Caustic = 1,
    /// Light that a surface has spread before.
    Indirect = 2,
    /// The shadow of the first surface that light from an emitter met.
    Shadow = 3,
}

impl MapClass {
    const ALL: [Self; 4] = [Self::Direct, Self::Caustic, Self::Indirect, Self::Shadow];
}

impl From<PathClass> for MapClass {
    fn from(class: PathClass) -> Self {
        Self::ALL[class as usize & 3]
    }
}

/// A photon as it stays.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct PackedPhoton {
    /// Where it met a surface.
    pub position: Vec3,
    /// Its power (W); of irradiance that is kept like a photon, that (W/m²); of photons that tell what is lit, the emitter's index.
    pub power: Rgbe,
    direction: u16,
    /// From the lowest bit: 2 for the axis by which the tree divides here, 2 for the class, 4 for the edges of its path, 8 for the patch.
    flags: u16,
}

impl PackedPhoton {
    /// A photon on a patch. `direction` is the unit direction that it came from; `edges` are those from the emitter to here.
    #[must_use]
    pub fn new(position: Vec3, power: Rgbe, direction: Vec3, patch: u8, class: MapClass, edges: u8) -> Self {
        let flags = (class as u16) << 2 | u16::from(edges.min(MAX_EDGES)) << 4 | u16::from(patch) << 8;
        Self { position, power, direction: octahedral::encode::<DIRECTION_BITS>(direction) as u16, flags }
    }

    /// The same with another power.
    #[must_use]
    pub const fn with_power(self, power: Rgbe) -> Self {
        Self { power, ..self }
    }

    /// Unit direction towards where it came from.
    #[must_use]
    #[inline]
    pub fn direction(&self) -> Vec3 {
        octahedral::decode::<DIRECTION_BITS>(u32::from(self.direction))
    }

    /// Its power as a colour.
    #[must_use]
    #[inline]
    pub fn light(&self) -> Rgb {
        self.power.colour()
    }

    /// What it stands for.
    #[must_use]
    #[inline]
    pub const fn class(&self) -> MapClass {
        MapClass::ALL[(self.flags >> 2 & 3) as usize]
    }

    /// Edges from the emitter to here, [`MAX_EDGES`] at most.
    #[must_use]
    #[inline]
    pub const fn edges(&self) -> u8 {
        (self.flags >> 4 & 15) as u8
    }

    /// The patch that it lies on, and the side of it.
    #[must_use]
    #[inline]
    pub const fn patch(&self) -> u8 {
        (self.flags >> 8) as u8
    }

    /// The axis by which the tree divides at this photon.
    #[inline]
    pub(super) const fn axis(&self) -> usize {
        (self.flags & 3) as usize
    }

    #[inline]
    pub(super) const fn set_axis(&mut self, axis: usize) {
        self.flags = self.flags & !3 | axis as u16 & 3;
    }

    /// All that it is, in an order of its own: what decides where coordinates are equal.
    pub(super) fn rank(&self) -> ([u32; 3], Rgbe, u16, u16) {
        (self.position.to_array().map(f32::to_bits), self.power, self.direction, self.flags & !3)
    }

    /// As it stands in a file.
    #[must_use]
    pub fn to_bytes(self) -> [u8; PACKED_BYTES] {
        let mut bytes = [0; PACKED_BYTES];
        let [x, y, z] = self.position.to_array().map(f32::to_le_bytes);
        let parts: [&[u8]; 6] =
            [&x, &y, &z, &self.power.0, &self.direction.to_le_bytes(), &self.flags.to_le_bytes()];
        let whole = parts.into_iter().flatten();
        bytes.iter_mut().zip(whole).for_each(|(to, from)| *to = *from);
        bytes
    }

    /// Out of a file; `None` where a coordinate is not finite, or the axis is none.
    #[must_use]
    pub fn from_bytes(bytes: &[u8; PACKED_BYTES]) -> Option<Self> {
        let word = |at: usize| [0, 1, 2, 3].map(|i| bytes[at + i]);
        let position = Vec3::from_array([0, 4, 8].map(|at| f32::from_le_bytes(word(at))));
        let half = |at: usize| u16::from_le_bytes([bytes[at], bytes[at + 1]]);
        let photon = Self { position, power: Rgbe(word(12)), direction: half(16), flags: half(18) };
        (position.is_finite() && photon.axis() < 3).then_some(photon)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use foton_math::{Purpose, Stream, warp};

    #[test]
    fn the_round_trip_of_a_photon_is_bounded_and_its_size_is_20_bytes() {
        assert_eq!(size_of::<PackedPhoton>(), PACKED_BYTES);
        let mut stream = Stream::new(1, Purpose::Test, 0, 0);
        for i in 0..5_000u32 {
            let position = (Vec3::new(stream.next_1d(), stream.next_1d(), stream.next_1d()) - 0.5) * 4000.0;
            let power = Rgb::new(stream.next_1d(), stream.next_1d(), stream.next_1d()) * 1e-4;
            let from = warp::square_to_sphere(stream.next_2d());
            let u = [stream.next_1d(), stream.next_1d(), stream.next_1d()];
            let class = MapClass::ALL[i as usize % 4];
            let mut photon =
                PackedPhoton::new(position, Rgbe::new(power, u), from, i as u8, class, (i % 20) as u8);
            photon.set_axis(i as usize % 3);
            let back = PackedPhoton::from_bytes(&photon.to_bytes()).expect("sound");
            assert_eq!(back, photon);
            assert_eq!(back.position, position, "positions are kept whole");
            assert!(back.direction().distance(from) < 4.25 / 256.0);
            for (a, b) in back.light().to_array().into_iter().zip(power.to_array()) {
                assert!((a - b).abs() < power.max_component() / 127.0);
            }
            assert_eq!((back.patch(), back.class(), back.axis()), (i as u8, class, i as usize % 3));
            assert_eq!(u32::from(back.edges()), (i % 20).min(15));
        }
    }

    #[test]
    fn what_is_no_photon_is_refused() {
        let photon = PackedPhoton::new(Vec3::ONE, Rgbe::default(), Vec3::Z, 1, MapClass::Direct, 1);
        let mut bytes = photon.to_bytes();
        bytes[18] |= 3;
        assert_eq!(PackedPhoton::from_bytes(&bytes), None, "an axis 3");
        let mut bytes = photon.to_bytes();
        bytes[4..8].copy_from_slice(&f32::NAN.to_le_bytes());
        assert_eq!(PackedPhoton::from_bytes(&bytes), None, "a coordinate that is no number");
    }
}
