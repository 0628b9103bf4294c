//! Text of attributes to numbers, vectors and colours, as Mitsuba 3 reads them: separated by commas or white space.
//!
//! Messages say what is wrong with the text; the caller knows its place.

use foton_input::quoted;
use foton_math::Rgb;
use foton_math::glam::DVec3;

/// A finite number.
pub(crate) fn number(text: &str) -> Result<f64, String> {
    let value: f64 = text.trim().parse().map_err(|_| format!("{} is not a number", quoted(text)))?;
    if value.is_finite() { Ok(value) } else { Err(format!("{} is not a finite number", quoted(text))) }
}

/// A whole number, which may be written as "32.0".
pub(crate) fn integer(text: &str) -> Result<i64, String> {
    /// Beyond it numbers of double precision are not all whole ones.
    const LARGEST: f64 = (1u64 << 53) as f64;
    let text = text.trim();
    let whole = |number: &f64| number.fract() == 0.0 && number.abs() <= LARGEST;
    let number =
        text.parse().ok().or_else(|| text.parse::<f64>().ok().filter(whole).map(|number| number as i64));
    number.ok_or_else(|| format!("{} is not a whole number", quoted(text)))
}

/// `true` or `false`, in any case.
pub(crate) fn boolean(text: &str) -> Result<bool, String> {
    match text.trim() {
        text if text.eq_ignore_ascii_case("true") => Ok(true),
        text if text.eq_ignore_ascii_case("false") => Ok(false),
        _ => Err(format!("{} is neither \"true\" nor \"false\"", quoted(text))),
    }
}

/// Finite numbers, as many as there are.
pub(crate) fn numbers(text: &str) -> Result<Vec<f64>, String> {
    text.split(|c: char| c == ',' || c.is_whitespace()).filter(|t| !t.is_empty()).map(number).collect()
}

/// Exactly three numbers.
pub(crate) fn vector(text: &str) -> Result<DVec3, String> {
    match numbers(text)?[..] {
        [x, y, z] => Ok(DVec3::new(x, y, z)),
        ref other => Err(format!("three numbers are needed, not {}", other.len())),
    }
}

/// Three numbers, or one for all three.
pub(crate) fn one_or_three(text: &str) -> Result<DVec3, String> {
    match numbers(text)?[..] {
        [all] => Ok(DVec3::splat(all)),
        [x, y, z] => Ok(DVec3::new(x, y, z)),
        ref other => Err(format!("one or three numbers are needed, not {}", other.len())),
    }
}

/// Three linear RGB components, one for all three, or `#rrggbb` with linear components, as Mitsuba reads that.
pub(crate) fn colour(text: &str) -> Result<Rgb, String> {
    let colour = rgb(hexadecimal(text).unwrap_or_else(|| one_or_three(text))?);
    if colour.is_finite() { Ok(colour) } else { Err(format!("{} is too large", quoted(text))) }
}

/// Three components of sRGB, or `#rrggbb`, made linear.
pub(crate) fn srgb(text: &str) -> Result<Rgb, String> {
    let encoded = hexadecimal(text).unwrap_or_else(|| one_or_three(text))?;
    let colour = rgb(DVec3::from_array(encoded.to_array().map(srgb_to_linear)));
    if colour.is_finite() { Ok(colour) } else { Err(format!("{} is too large", quoted(text))) }
}

/// `#rrggbb` to three components in [0, 1]; `None` if there is no `#`.
fn hexadecimal(text: &str) -> Option<Result<DVec3, String>> {
    let digits = text.trim().strip_prefix('#')?;
    let all_digits = digits.len() == 6 && digits.bytes().all(|b| b.is_ascii_hexdigit());
    let number = u32::from_str_radix(digits, 16).ok().filter(|_| all_digits);
    Some(number.ok_or_else(|| format!("{} is not a colour such as #ff8000", quoted(text))).map(|n| {
        let [_, r, g, b] = n.to_be_bytes().map(|byte| f64::from(byte) / 255.0);
        DVec3::new(r, g, b)
    }))
}

/// The linear value of an sRGB component (IEC 61966-2-1).
pub(crate) fn srgb_to_linear(encoded: f64) -> f64 {
    if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

/// The first part of a version such as `3.0.0`.
pub(crate) fn major_version(version: &str) -> Result<u32, String> {
    // Digits alone: "+3" is a number, too.
    let part = |text: &str| text.parse::<u32>().ok().filter(|_| text.bytes().all(|b| b.is_ascii_digit()));
    let parts: Option<Vec<u32>> = version.trim().split('.').map(part).collect();
    match parts {
        Some(parts) if parts.len() <= 3 => Ok(parts[0]),
        _ => Err(format!("{} is not a version such as 3.0.0", quoted(version))),
    }
}

/// The colour of three components, rounded to single precision.
#[allow(clippy::cast_possible_truncation, reason = "colours are single precision")]
pub(crate) fn rgb(v: DVec3) -> Rgb {
    Rgb::new(v.x as f32, v.y as f32, v.z as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_as_mitsuba_reads_them() {
        for (text, value) in
            [("2", 2.0), (" 2 ", 2.0), ("+2", 2.0), ("2.", 2.0), (".5e1", 5.0), ("-1E-2", -0.01)]
        {
            assert_eq!(number(text), Ok(value), "{text}");
        }
        for text in ["", "2f", "1,5", "0x10", "--1", "1 2"] {
            assert_eq!(number(text), Err(format!("\"{text}\" is not a number")));
        }
        for text in ["inf", "-inf", "NaN", "1e999"] {
            assert_eq!(number(text), Err(format!("\"{text}\" is not a finite number")));
        }
    }

    #[test]
    fn whole_numbers_may_have_a_point() {
        for (text, value) in [("32", 32), (" 32.0 ", 32), ("-1.", -1), ("1e3", 1000)] {
            assert_eq!(integer(text), Ok(value), "{text}");
        }
        for text in ["32.5", "1e300", "NaN", "deep", ""] {
            assert_eq!(integer(text), Err(format!("\"{text}\" is not a whole number")));
        }
    }

    #[test]
    fn commas_and_spaces_separate_alike() {
        for text in ["1, 2, 3", "1 2 3", "1,2,3", " 1\t2 ,3 "] {
            assert_eq!(vector(text), Ok(DVec3::new(1.0, 2.0, 3.0)), "{text}");
        }
        assert_eq!(one_or_three("4"), Ok(DVec3::splat(4.0)));
        assert_eq!(vector("1 2"), Err("three numbers are needed, not 2".to_owned()));
        assert_eq!(colour("1 2"), Err("one or three numbers are needed, not 2".to_owned()));
        assert_eq!(colour("1e300"), Err("\"1e300\" is too large".to_owned()));
    }
}
