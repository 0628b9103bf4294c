//! Statistics as hit points keep them: in as few bytes as lose nothing that matters.
//!
//! r² loses no bit: a packet has it in single precision, and here is the rest. What radii adapt to is noisy, and sums in single precision
//! are exact enough for it: 20,000 passes that bring the same, which round alike, move α by less than 0.1 % and the focus by less than 1 %.
//! The variance is kept relative to the square of the light, for it is beyond single precision where light is very bright or very dim.

use foton_transport::codec::{Reader, StateError, Writer};

use super::adaptive::RadiusStatistics;
use super::statistics::Statistics;

/// [`Statistics`] without what a packet has: its r² in single precision.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct KeptStatistics {
    accumulated: f64,
    found: u32,
    /// How many steps of double precision r² lies above what the packet has.
    rest: i32,
}

impl KeptStatistics {
    /// To be kept beside that [`Statistics::radius2`] in single precision.
    #[inline]
    pub(crate) fn new(statistics: &Statistics) -> Self {
        let radius2 = statistics.radius2();
        let steps = (radius2.to_bits() as i64).wrapping_sub(f64::from(radius2 as f32).to_bits() as i64);
        Self {
            accumulated: statistics.accumulated(),
            found: u32::try_from(statistics.photons_found()).unwrap_or(u32::MAX),
            rest: steps.clamp(i32::MIN.into(), i32::MAX.into()) as i32,
        }
    }

    /// The whole, of a hit point with that r² in single precision.
    #[inline]
    pub(crate) fn beside(&self, radius2: f32) -> Statistics {
        let bits = (f64::from(radius2).to_bits() as i64).wrapping_add(self.rest.into());
        Statistics::of(self.accumulated, f64::from_bits(bits as u64), self.found.into())
    }
}

/// [`RadiusStatistics`] in single precision.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct KeptRadius {
    light: f32,
    /// The variance over the square of the light.
    variance: f32,
    laplacian: f32,
    offset: [f32; 3],
    spread: f32,
    freedom: f32,
}

impl KeptRadius {
    #[inline]
    pub(crate) fn new(sums: &RadiusStatistics) -> Self {
        let light2 = sums.light * sums.light;
        Self {
            light: sums.light as f32,
            variance: if light2 > 0.0 { (sums.variance / light2) as f32 } else { 0.0 },
            laplacian: sums.laplacian as f32,
            offset: sums.offset.map(|o| o as f32),
            spread: sums.spread as f32,
            freedom: sums.freedom as f32,
        }
    }

    /// The sums to go on with.
    #[inline]
    pub(crate) fn sums(&self) -> RadiusStatistics {
        let light = f64::from(self.light);
        RadiusStatistics {
            light,
            variance: f64::from(self.variance) * light * light,
            laplacian: self.laplacian.into(),
            offset: self.offset.map(f64::from),
            spread: self.spread.into(),
            freedom: self.freedom.into(),
        }
    }

    pub(super) fn write(&self, out: &mut Writer) {
        self.sums().write(out);
    }

    pub(super) fn read(input: &mut Reader<'_>) -> Result<Self, StateError> {
        RadiusStatistics::read(input).map(|sums| Self::new(&sums))
    }
}

#[cfg(test)]
mod tests {
    use super::super::settings::Alpha;
    use super::*;

    #[test]
    fn a_radius_loses_no_bit() {
        let (mut whole, mut radius2) = (Statistics::new(3.7), 3.7_f32);
        let mut kept = KeptStatistics::new(&whole);
        for pass in 0..20_000 {
            whole.refine(pass % 7, Alpha::default(), 0.0);
            let mut statistics = kept.beside(radius2);
            statistics.refine(pass % 7, Alpha::default(), 0.0);
            (kept, radius2) = (KeptStatistics::new(&statistics), statistics.radius2() as f32);
            assert_eq!(kept.beside(radius2), whole, "{pass}");
        }
        let empty = KeptStatistics::default().beside(-1.0);
        assert_eq!(empty, Statistics::EMPTY_SLOT);
    }

    #[test]
    fn radii_adapt_to_light_of_any_brightness_as_in_double_precision() {
        for power in [1e-15, 1.0, 1e15] {
            let mut whole = RadiusStatistics::default();
            let mut kept = KeptRadius::default();
            for pass in 0..20_000 {
                let a = power * (1.0 + f64::from(pass % 5));
                let of_pass = RadiusStatistics {
                    light: a,
                    variance: 0.3 * a * a,
                    laplacian: 0.2 * a,
                    offset: [0.01 * a, -0.02 * a, 0.0],
                    spread: 1.7,
                    freedom: 4.0,
                };
                whole.add_pass(&of_pass);
                let mut sums = kept.sums();
                sums.add_pass(&of_pass);
                kept = KeptRadius::new(&sums);
                // A state holds sums.
                kept = KeptRadius::new(&kept.sums());
            }
            let [a, b] = [whole, kept.sums()].map(|sums| (sums.alpha(Alpha::default()).get(), sums.focus()));
            // The same addends again and again round alike, which those of passes do not.
            assert!((a.0 / b.0 - 1.0).abs() < 1e-3 && (a.1 - b.1).abs() < 1e-2 * a.1, "{power}: {a:?} {b:?}");
        }
    }
}
