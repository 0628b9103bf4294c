//! A colour in four bytes: three mantissas and the exponent that they share. `[WAR91]`
//!
//! Ward cuts mantissas off, and adds a half when he reads them. Photons carry about equal powers, so that any fixed rounding would
//! err in one direction for nearly all of them. Here a mantissa is rounded up with the probability of what is cut off: the
//! expected value is the colour itself, in every channel, whatever its power.

use foton_math::Rgb;

/// Of the exponent byte: 1 is 2⁻¹²⁷.
const OFFSET: i32 = 128;

/// Mantissas are 256ths.
const MANTISSA_BITS: i32 = 8;

/// A colour with a shared exponent. Not negative.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Rgbe(pub [u8; 4]);

impl Rgbe {
    /// A colour whose channels are finite and not negative, each rounded up if its number of `u`, uniform in [0, 1), is below what would
    /// be cut off. Each channel is off by less than a 127th of the largest.
    #[must_use]
    pub fn new(colour: Rgb, u: [f32; 3]) -> Self {
        let largest = colour.max_component();
        if largest <= 0.0 {
            return Self::default();
        }
        // f · 2^e with f in [1/2, 1).
        let mut exponent = exponent_of(largest);
        if largest * power_of_two(-exponent) > 255.0 / 256.0 {
            // There is no mantissa 256 to round up to.
            exponent += 1;
        }
        let byte = exponent + OFFSET;
        let round = |channel: f32, u: f32| {
            // In two steps: both together may be more than single precision holds.
            let mantissa = channel.max(0.0) * power_of_two(-exponent) * power_of_two(MANTISSA_BITS);
            let floor = mantissa.floor();
            (floor + f32::from(u8::from(u < mantissa - floor))) as u8
        };
        let [r, g, b] = colour.to_array();
        Self([round(r, u[0]), round(g, u[1]), round(b, u[2]), byte.min(255) as u8])
    }

    /// The colour.
    #[must_use]
    #[inline]
    pub fn colour(self) -> Rgb {
        let Self([r, g, b, e]) = self;
        let scale = power_of_two(i32::from(e) - OFFSET - MANTISSA_BITS);
        Rgb::new(f32::from(r), f32::from(g), f32::from(b)) * scale
    }
}

/// The exponent e of a positive number f · 2^e with f in [1/2, 1).
const fn exponent_of(x: f32) -> i32 {
    let biased = (x.to_bits() >> 23) as i32;
    if biased == 0 { -126 } else { biased - 126 }
}

/// 2^n; 0 below the range of single precision.
#[inline]
const fn power_of_two(n: i32) -> f32 {
    match n {
        ..-149 => 0.0,
        -149..-126 => f32::from_bits(1 << (n + 149)),
        -126..=127 => f32::from_bits(((n + 127) as u32) << 23),
        128.. => f32::INFINITY,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use foton_math::{Purpose, Stream};

    fn random_colour(stream: &mut Stream) -> Rgb {
        let scale = 2f32.powf(60.0 * (stream.next_1d() - 0.5));
        Rgb::new(stream.next_1d(), stream.next_1d(), stream.next_1d()) * scale
    }

    #[test]
    fn each_channel_is_off_by_less_than_a_127th_of_the_largest() {
        let mut stream = Stream::new(1, Purpose::Test, 0, 0);
        for _ in 0..20_000 {
            let colour = random_colour(&mut stream);
            let u = [stream.next_1d(), stream.next_1d(), stream.next_1d()];
            let packed = Rgbe::new(colour, u).colour();
            for (a, b) in colour.to_array().into_iter().zip(packed.to_array()) {
                assert!((a - b).abs() < colour.max_component() / 127.0, "{colour:?} {packed:?}");
            }
        }
        for exact in [0.0, 1.0, 0.5, 255.0, 2f32.powi(-129), 2f32.powi(-120), 2f32.powi(120)] {
            assert_eq!(Rgbe::new(Rgb::splat(exact), [0.5; 3]).colour(), Rgb::splat(exact));
        }
        assert!(Rgbe::new(Rgb::splat(f32::MAX), [0.0; 3]).colour().is_finite());
    }

    /// Over evenly spread numbers the mean is the colour, whatever its fraction, also next to a power of two.
    #[test]
    fn rounding_has_no_bias_of_the_mean() {
        const STEPS: u32 = 4096;
        let mut stream = Stream::new(2, Purpose::Test, 0, 0);
        let mut colours: Vec<Rgb> = (0..200).map(|_| random_colour(&mut stream)).collect();
        colours.extend([255.3, 255.9, 256.0 - 1e-4, 127.6, 128.2].map(|x| Rgb::new(x, 0.3 * x, 0.001 * x)));
        for colour in colours {
            let mut sum = [0.0f64; 3];
            for i in 0..STEPS {
                let u = (i as f32 + 0.5) / STEPS as f32;
                let packed = Rgbe::new(colour, [u; 3]).colour().to_array();
                sum.iter_mut().zip(packed).for_each(|(sum, c)| *sum += f64::from(c) / f64::from(STEPS));
            }
            for (mean, c) in sum.into_iter().zip(colour.to_array()) {
                let off = (mean - f64::from(c)).abs();
                assert!(off < 1e-5 * f64::from(colour.max_component()), "{colour:?}: {mean} for {c}");
            }
        }
    }
}
