//! Text of attributes to numbers, vectors and colours, as Mitsuba 3 reads them: separated by commas or white space.
//!
//! Messages say what is wrong with the text; the caller knows its place.

use foton_math::Rgb;
use foton_math::glam::DVec3;

/// A finite number.
pub(crate) fn number(text: &str) -> Result<f64, String> {
    let value: f64 = text.trim().parse().map_err(|_| format!("\"{text}\" is not a number"))?;
    if value.is_finite() { Ok(value) } else { Err(format!("\"{text}\" is not a finite number")) }
}

/// A whole number.
pub(crate) fn integer(text: &str) -> Result<i64, String> {
    text.trim().parse().map_err(|_| format!("\"{text}\" is not a whole number"))
}

/// `true` or `false`, in any case.
pub(crate) fn boolean(text: &str) -> Result<bool, String> {
    match text {
        _ if text.eq_ignore_ascii_case("true") => Ok(true),
        _ if text.eq_ignore_ascii_case("false") => Ok(false),
        _ => Err(format!("\"{text}\" is neither \"true\" nor \"false\"")),
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

/// Three linear RGB components, or one for all three.
pub(crate) fn colour(text: &str) -> Result<Rgb, String> {
    let colour = rgb(one_or_three(text)?);
    if colour.is_finite() { Ok(colour) } else { Err(format!("\"{text}\" is too large")) }
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
