//! Spectra over wavelengths to linear sRGB: integrals with the CIE 1931 matching functions, `[CIE15]`.
//!
//! As in Mitsuba 3: values are interpolated between the stated wavelengths and zero outside them; shares of light and
//! indices of refraction are seen under D65, emitted light as it is.

use foton_input::quoted;
use foton_math::Rgb;
use foton_math::glam::DVec3;

use crate::mitsuba::read::values;

/// Points of a spectrum, wavelengths in nm growing.
pub(crate) struct Spectrum(Vec<(f64, f64)>);

impl Spectrum {
    /// `400:0.1, 700:0.9`.
    pub(crate) fn parse(text: &str) -> Result<Self, String> {
        // A colon may have space around it.
        let parts: Vec<&str> = text.split(':').map(str::trim).collect();
        let text = parts.join(":");
        let pairs = text.split(|c: char| c == ',' || c.is_whitespace()).filter(|t| !t.is_empty());
        let pair = |pair: &str| {
            let (wavelength, value) = pair.split_once(':').ok_or_else(|| {
                format!("{} is not a wavelength with its value, such as 550:0.5", quoted(pair))
            })?;
            Ok((values::number(wavelength)?, values::number(value)?))
        };
        Self::of_points(pairs.map(pair).collect::<Result<_, String>>()?)
    }

    /// A file: a wavelength and a value a line; lines that begin with `#` are comments.
    pub(crate) fn parse_file(text: &str) -> Result<Self, String> {
        // Nothing of a file is quoted that may be none of spectra.
        let lines =
            (1..).zip(text.lines().map(str::trim)).filter(|(_, l)| !l.is_empty() && !l.starts_with('#'));
        let pair = |(number, line): (usize, &str)| match values::numbers(line).as_deref() {
            Ok(&[wavelength, value]) => Ok((wavelength, value)),
            _ => Err(format!("it is no spectrum: line {number} is not a wavelength and a value")),
        };
        Self::of_points(lines.map(pair).collect::<Result<_, String>>()?)
    }

    /// The radiance of a black body of so many kelvin, in watts per square metre, steradian and nanometre: Planck's law.
    pub(crate) fn of_black_body(kelvin: f64) -> Self {
        /// The speed of light in m/s, Planck's constant in J s, and Boltzmann's in J/K.
        const C: f64 = 299_792_458.0;
        const H: f64 = 6.626_070_15e-34;
        const K: f64 = 1.380_649e-23;
        let radiance = |nm: f64| {
            let lambda = nm * 1e-9;
            2.0 * H * C * C / lambda.powi(5) / (H * C / (lambda * K * kelvin)).exp_m1() * 1e-9
        };
        let wavelengths = FIRST_NM..=FIRST_NM + 5 * (TABLE.len() as u32 - 1);
        Self(wavelengths.map(f64::from).map(|nm| (nm, radiance(nm))).collect())
    }

    /// Values at wavelengths in nm, at least two, which grow.
    pub(crate) fn of_points(points: Vec<(f64, f64)>) -> Result<Self, String> {
        if points.len() < 2 {
            return Err(format!("a spectrum needs two wavelengths or more, not {}", points.len()));
        }
        if let Some(pair) = points.windows(2).find(|p| p[0].0 >= p[1].0) {
            return Err(format!("wavelengths must grow: {} comes after {}", pair[1].0, pair[0].0));
        }
        Ok(Self(points))
    }

    /// The same with its first and its last value beyond its ends, over all that is visible.
    pub(crate) fn held_at_ends(mut self) -> Self {
        let (low, high) = (f64::from(FIRST_NM) - 1.0, f64::from(FIRST_NM + 5 * TABLE.len() as u32));
        if self.0[0].0 > low {
            self.0.insert(0, (low, self.0[0].1));
        }
        if let Some(&(last, value)) = self.0.last()
            && last < high
        {
            self.0.push((high, value));
        }
        self
    }

    /// Whether a value is below zero.
    pub(crate) fn has_negative(&self) -> bool {
        self.0.iter().any(|(_, value)| *value < 0.0)
    }

    /// Its colour as emitted light; channels outside the gamut are zero.
    pub(crate) fn emitted(&self) -> Rgb {
        self.colour(|_| 1.0)
    }

    /// Its colour under D65, by which a constant 1 is white; channels outside the gamut are zero.
    pub(crate) fn lit(&self) -> Rgb {
        self.colour(|row| row[3])
    }

    fn colour(&self, light: fn(&[f64; 4]) -> f64) -> Rgb {
        let mut xyz = DVec3::ZERO;
        let mut white = 0.0;
        for nm in FIRST_NM..=FIRST_NM + 5 * (TABLE.len() as u32 - 1) {
            let wavelength = f64::from(nm);
            let row = observer(nm);
            let power = light(&row);
            xyz += DVec3::new(row[0], row[1], row[2]) * power * self.at(wavelength);
            white += row[1] * power;
        }
        values::rgb(xyz_to_srgb(xyz / white).max(DVec3::ZERO))
    }

    fn at(&self, wavelength: f64) -> f64 {
        let after = self.0.partition_point(|(w, _)| *w < wavelength);
        match (after.checked_sub(1).and_then(|i| self.0.get(i)), self.0.get(after)) {
            (Some((w0, v0)), Some((w1, v1))) => v0 + (v1 - v0) * (wavelength - w0) / (w1 - w0),
            (None, Some((w1, v1))) if *w1 == wavelength => *v1,
            _ => 0.0,
        }
    }
}

/// The matching functions and D65 at a wavelength in the table's range.
fn observer(nm: u32) -> [f64; 4] {
    let steps = nm - FIRST_NM;
    let (low, share) = ((steps / 5) as usize, f64::from(steps % 5) / 5.0);
    let high = (low + 1).min(TABLE.len() - 1);
    std::array::from_fn(|i| TABLE[low][i] + (TABLE[high][i] - TABLE[low][i]) * share)
}

/// Linear sRGB of CIE XYZ; channels outside the gamut are below zero or above 1.
pub(crate) fn xyz_to_srgb(c: DVec3) -> DVec3 {
    DVec3::new(
        DVec3::new(3.240_479, -1.537_150, -0.498_535).dot(c),
        DVec3::new(-0.969_256, 1.875_991, 0.041_556).dot(c),
        DVec3::new(0.055_648, -0.204_043, 1.057_311).dot(c),
    )
}

/// The wavelength of the first row; the others follow every 5 nm.
const FIRST_NM: u32 = 360;

/// The 2° observer's x, y, z, and D65 with 1 at about 560 nm.
#[rustfmt::skip]
const TABLE: &[[f64; 4]] = &[
    [0.000_129_9, 0.000_003_917, 0.000_606_1, 0.466_383_1],
    [0.000_232_1, 0.000_006_965, 0.001_086, 0.493_637],
    [0.000_414_9, 0.000_012_39, 0.001_946, 0.520_891],
    [0.000_741_6, 0.000_022_02, 0.003_486, 0.510_323],
    [0.001_368, 0.000_038_999_999, 0.006_450_001, 0.499_755],
    [0.002_236, 0.000_064, 0.010_549_99, 0.523_118],
    [0.004_243, 0.000_12, 0.020_050_01, 0.546_482],
    [0.007_65, 0.000_217, 0.036_21, 0.687_015],
    [0.014_31, 0.000_396, 0.067_850_01, 0.827_549],
    [0.023_19, 0.000_64, 0.110_2, 0.871_204],
    [0.043_51, 0.001_21, 0.207_4, 0.914_860_1],
    [0.077_63, 0.002_18, 0.371_3, 0.924_589],
    [0.134_38, 0.004, 0.645_6, 0.934_318_1],
    [0.214_77, 0.007_3, 1.039_05, 0.900_57],
    [0.283_9, 0.011_6, 1.385_6, 0.866_823],
    [0.328_5, 0.016_84, 1.622_96, 0.957_736],
    [0.348_28, 0.023, 1.747_06, 1.048_65],
    [0.348_06, 0.029_8, 1.782_6, 1.109_36],
    [0.336_2, 0.038, 1.772_11, 1.170_08],
    [0.318_7, 0.048, 1.744_1, 1.174_1],
    [0.290_8, 0.06, 1.669_2, 1.178_12],
    [0.251_1, 0.073_9, 1.528_1, 1.163_36],
    [0.195_36, 0.090_98, 1.287_64, 1.148_61],
    [0.142_1, 0.112_6, 1.041_9, 1.153_92],
    [0.095_64, 0.139_02, 0.812_950_1, 1.159_23],
    [0.057_950_01, 0.169_3, 0.616_2, 1.123_67],
    [0.032_01, 0.208_02, 0.465_18, 1.088_11],
    [0.014_7, 0.258_6, 0.353_3, 1.090_82],
    [0.004_9, 0.323, 0.272, 1.093_54],
    [0.002_4, 0.407_3, 0.212_3, 1.085_78],
    [0.009_3, 0.503, 0.158_2, 1.078_02],
    [0.029_1, 0.608_2, 0.111_7, 1.062_96],
    [0.063_27, 0.71, 0.078_249_99, 1.047_9],
    [0.109_6, 0.793_2, 0.057_250_01, 1.062_39],
    [0.165_5, 0.862, 0.042_16, 1.076_89],
    [0.225_749_9, 0.914_850_1, 0.029_84, 1.060_47],
    [0.290_4, 0.954, 0.020_3, 1.044_05],
    [0.359_7, 0.980_3, 0.013_4, 1.042_25],
    [0.433_449_9, 0.994_950_1, 0.008_749_999, 1.040_46],
    [0.512_050_1, 1.0, 0.005_749_999, 1.020_23],
    [0.594_5, 0.995, 0.003_9, 1.0],
    [0.678_4, 0.978_6, 0.002_749_999, 0.981_671],
    [0.762_1, 0.952, 0.002_1, 0.963_342],
    [0.842_5, 0.915_4, 0.001_8, 0.960_611],
    [0.916_3, 0.87, 0.001_650_001, 0.957_880_1],
    [0.978_6, 0.816_3, 0.001_4, 0.922_368_1],
    [1.026_3, 0.757, 0.001_1, 0.886_856],
    [1.056_7, 0.694_9, 0.001, 0.893_459_1],
    [1.062_2, 0.631, 0.000_8, 0.900_062_1],
    [1.045_6, 0.566_8, 0.000_6, 0.898_026],
    [1.002_6, 0.503, 0.000_34, 0.895_991],
    [0.938_4, 0.441_2, 0.000_24, 0.886_489_1],
    [0.854_449_9, 0.381, 0.000_19, 0.876_987],
    [0.751_4, 0.321, 0.000_1, 0.854_936],
    [0.642_4, 0.265, 0.000_049_999_991, 0.832_886],
    [0.541_9, 0.217, 0.000_029_999_999, 0.834_939],
    [0.447_9, 0.175, 0.000_019_999_999, 0.836_992_1],
    [0.360_8, 0.138_2, 0.000_01, 0.818_630_1],
    [0.283_5, 0.107, 0.0, 0.800_268_1],
    [0.218_7, 0.081_6, 0.0, 0.801_207],
    [0.164_9, 0.061, 0.0, 0.802_146],
    [0.121_2, 0.044_58, 0.0, 0.812_462],
    [0.087_4, 0.032, 0.0, 0.822_778_1],
    [0.063_6, 0.023_2, 0.0, 0.802_81],
    [0.046_77, 0.017, 0.0, 0.782_842_1],
    [0.032_9, 0.011_92, 0.0, 0.740_027],
    [0.022_7, 0.008_21, 0.0, 0.697_213],
    [0.015_84, 0.005_723, 0.0, 0.706_652_1],
    [0.011_359_16, 0.004_102, 0.0, 0.716_091_1],
    [0.008_110_916, 0.002_929, 0.0, 0.729_79],
    [0.005_790_346, 0.002_091, 0.0, 0.743_49],
    [0.004_109_457, 0.001_484, 0.0, 0.679_765_1],
    [0.002_899_327, 0.001_047, 0.0, 0.616_04],
    [0.002_049_19, 0.000_74, 0.0, 0.657_448],
    [0.001_439_971, 0.000_52, 0.0, 0.698_856],
    [0.000_999_949_3, 0.000_361_1, 0.0, 0.724_863],
    [0.000_690_078_6, 0.000_249_2, 0.0, 0.750_87],
    [0.000_476_021_3, 0.000_171_9, 0.0, 0.693_398],
    [0.000_332_301_1, 0.000_12, 0.0, 0.635_927],
    [0.000_234_826_1, 0.000_084_799_998, 0.0, 0.550_054],
    [0.000_166_150_5, 0.000_059_999_998, 0.0, 0.464_182],
    [0.000_117_413, 0.000_042_399_999, 0.0, 0.566_118_1],
    [0.000_083_075_269, 0.000_029_999_999, 0.0, 0.668_054],
    [0.000_058_706_519, 0.000_021_2, 0.0, 0.650_941_1],
    [0.000_041_509_938, 0.000_014_99, 0.0, 0.633_828],
    [0.000_029_353_259, 0.000_010_6, 0.0, 0.638_434],
    [0.000_020_673_83, 0.000_007_465_7, 0.0, 0.643_04],
    [0.000_014_559_77, 0.000_005_257_8, 0.0, 0.618_779],
    [0.000_010_253_98, 0.000_003_702_9, 0.0, 0.594_519],
    [0.000_007_221_456, 0.000_002_607_8, 0.0, 0.557_054],
    [0.000_005_085_868, 0.000_001_836_6, 0.0, 0.519_59],
    [0.000_003_581_652, 0.000_001_293_4, 0.0, 0.546_998],
    [0.000_002_522_525, 0.000_000_910_93, 0.0, 0.574_406],
    [0.000_001_776_509, 0.000_000_641_53, 0.0, 0.588_765],
    [0.000_001_251_141, 0.000_000_451_81, 0.0, 0.603_125],
];

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_close(found: Rgb, wanted: [f32; 3]) {
        for (a, b) in found.to_array().iter().zip(wanted) {
            assert!((a - b).abs() < 2e-3, "{found:?} is not {wanted:?}");
        }
    }

    #[test]
    fn colours_are_those_of_mitsuba() {
        // Printed by Mitsuba 3.9.1.
        let ramp = Spectrum::parse("400:0.1, 700:0.9").unwrap();
        assert_close(ramp.lit(), [0.742_853, 0.481_140, 0.208_325]);
        assert_close(ramp.emitted(), [0.872_215, 0.458_728, 0.181_301]);
        let line = Spectrum::parse("500:0.2 510:1 520:0.2").unwrap();
        assert_close(line.lit(), [0.0, 0.115_339, 0.008_511]);
        let uneven = Spectrum::parse_file("# x\n300 0.5\n400 1\n\n500 0.3\n900 2").unwrap();
        assert_close(uneven.lit(), [0.937_104, 0.438_221, 0.632_585]);
        assert_close(uneven.emitted(), [1.089_672, 0.415_851, 0.586_876]);
    }

    #[test]
    fn black_bodies_are_those_of_mitsuba() {
        // Integrals over what Mitsuba 3.9.1 says of them from 360 to 830 nm.
        for (kelvin, wanted) in [
            (2000.0, [16.014_2, 4.111_809, 0.130_369]),
            (5000.0, [15_263.054, 12_082.584, 9_592.587]),
            (6500.0, [43_918.658, 41_407.22, 43_582.869]),
        ] {
            let found = Spectrum::of_black_body(kelvin).emitted();
            for (a, b) in found.to_array().iter().zip(wanted) {
                assert!((a / b - 1.0).abs() < 1e-3, "{found:?} is not {wanted:?}");
            }
        }
    }

    #[test]
    fn a_flat_spectrum_is_white_under_d65() {
        let flat = Spectrum::parse("300:0.5, 900:0.5").unwrap().lit();
        assert_close(flat, [0.5; 3]);
    }
}
