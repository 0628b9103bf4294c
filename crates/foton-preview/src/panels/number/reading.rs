//! Numbers between text and value: what a field shows, what it offers for editing, and what it reads.

use crate::panels::text::grouped;

/// Digits of a value that has no fixed number of decimals.
const SIGNIFICANT: i32 = 5;

/// How values are written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Digits {
    /// Whole numbers, with thousands set apart.
    Whole,
    /// So many decimals, always.
    Decimals(usize),
    /// As many as the value needs.
    Significant,
}

/// A value as the field shows it.
pub(super) fn shown(value: f64, digits: Digits) -> String {
    match digits {
        // Beyond the whole numbers of double precision there are no digits to set apart.
        Digits::Whole if (0.0..9e15).contains(&value) => grouped(value.round() as u64),
        Digits::Whole => format!("{value:.0}"),
        Digits::Decimals(n) => format!("{value:.n$}"),
        Digits::Significant => significant(value),
    }
}

/// A value in fewer and fewer digits, for fields that are too narrow for all.
pub(super) fn shorter(value: f64, digits: Digits) -> Vec<String> {
    let decimals = match digits {
        Digits::Whole => 0,
        Digits::Decimals(n) => n,
        Digits::Significant if (1e-4..1e7).contains(&value.abs()) => 3,
        Digits::Significant => 0,
    };
    let fewer = (0..decimals).rev().map(|n| format!("{value:.n$}"));
    [shown(value, digits)].into_iter().chain(fewer).collect()
}

/// A value as it is offered for editing: plain digits, nothing set apart.
pub(super) fn editable(value: f64, digits: Digits) -> String {
    match digits {
        Digits::Whole => format!("{value:.0}"),
        Digits::Decimals(n) => trimmed(format!("{value:.*}", n.max(6))),
        Digits::Significant => significant(value),
    }
}

fn significant(value: f64) -> String {
    match value.abs() {
        a if a < 1e-12 => "0".to_owned(),
        a if (1e-4..1e7).contains(&a) => {
            let decimals = (SIGNIFICANT - 1 - a.log10().floor() as i32).max(0);
            trimmed(format!("{value:.*}", decimals as usize))
        }
        _ => format!("{value:.3e}"),
    }
}

fn trimmed(text: String) -> String {
    if !text.contains('.') {
        return text;
    }
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// Reads what was typed, with or without the unit.
///
/// # Errors
/// What is wrong with it, in a sentence.
pub(super) fn read(text: &str, unit: &str) -> Result<f64, String> {
    let typed = text.trim();
    if typed.is_empty() {
        return Err("Type a number.".to_owned());
    }
    let (number, factor) = without_unit(typed, unit);
    let digits: String = number.chars().filter(|c| !c.is_whitespace() && !matches!(c, '_' | '\'')).collect();
    let digits = digits.replace('\u{2212}', "-");
    let read = with_point(&digits)?.parse::<f64>().ok().filter(|v| v.is_finite());
    read.map(|v| v * factor).ok_or_else(|| format!("\u{201c}{}\u{201d} is not a number.", cut(typed)))
}

/// The number in front of a unit, and what the unit is worth in the field's own.
fn without_unit<'t>(typed: &'t str, unit: &str) -> (&'t str, f64) {
    let words: &[(&str, f64)] = match unit {
        "s" => &[("min", 60.0), ("ms", 1e-3), ("h", 3600.0), ("s", 1.0)],
        "°" => &[("deg", 1.0), ("°", 1.0)],
        _ => &[],
    };
    let ends = words.iter().find_map(|(word, factor)| Some((typed.strip_suffix(word)?, *factor)));
    let own = typed.strip_suffix(unit).filter(|_| !unit.is_empty()).map(|number| (number, 1.0));
    ends.or(own).unwrap_or((typed, 1.0))
}

/// A comma is a decimal point, unless it may as well set thousands apart.
fn with_point(digits: &str) -> Result<String, String> {
    let commas = digits.matches(',').count();
    if commas == 0 {
        return Ok(digits.to_owned());
    }
    let is_thousands = digits.split(',').skip(1).all(|part| part.split('.').next().map_or(0, str::len) == 3);
    match (is_thousands, digits.contains('.'), commas) {
        (true, true, _) | (true, false, 2..) => Ok(digits.replace(',', "")),
        (false, false, 1) => Ok(digits.replace(',', ".")),
        _ => {
            let (whole, point) = (digits.replace(',', ""), digits.replacen(',', ".", 1));
            Err(format!(
                "\u{201c}{}\u{201d} can mean {} or {}: leave the comma out.",
                cut(digits),
                cut(&whole),
                cut(&point)
            ))
        }
    }
}

/// What of a text fits into a message.
fn cut(text: &str) -> String {
    const MOST: usize = 24;
    if text.chars().count() <= MOST {
        return text.to_owned();
    }
    text.chars().take(MOST).chain(['…']).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_as_people_write_them() {
        for (text, unit, value) in [
            ("262144", "", 262_144.0),
            (" 262 144 ", "", 262_144.0),
            ("262\u{a0}144", "", 262_144.0),
            ("1,234,567", "", 1_234_567.0),
            ("1,234.5", "", 1234.5),
            ("0,5", "", 0.5),
            (".5", "", 0.5),
            ("2.5e-3", "", 0.0025),
            ("\u{2212}3", "", -3.0),
            ("50°", "°", 50.0),
            ("50 deg", "°", 50.0),
            ("25 %", "%", 25.0),
            ("2 min", "s", 120.0),
            ("1h", "s", 3600.0),
            ("90 s", "s", 90.0),
            ("3 world units", "world units", 3.0),
        ] {
            assert_eq!(read(text, unit), Ok(value), "{text}");
        }
    }

    #[test]
    fn what_is_no_number_is_said() {
        for (text, part) in [
            ("", "Type a number"),
            ("abc", "“abc” is not a number"),
            ("1e999", "is not a number"),
            ("nan", "is not a number"),
            ("12,345", "12345 or 12.345"),
        ] {
            let said = read(text, "").expect_err(text);
            assert!(said.contains(part), "{text}: {said}");
        }
        assert!(read(&"9x".repeat(500), "").expect_err("no number").len() < 200);
    }

    #[test]
    fn narrow_fields_lose_the_last_decimals() {
        assert_eq!(shorter(1.75, Digits::Decimals(3)), ["1.750", "1.75", "1.8", "2"]);
        assert_eq!(shorter(12.0, Digits::Whole), ["12"]);
        assert_eq!(shorter(1e12, Digits::Significant), ["1.000e12"]);
    }

    #[test]
    fn values_keep_their_places() {
        assert_eq!(shown(262_144.0, Digits::Whole), "262\u{a0}144");
        assert_eq!(editable(262_144.0, Digits::Whole), "262144");
        assert_eq!(shown(2.0 / 3.0, Digits::Decimals(3)), "0.667");
        assert_eq!(editable(0.5, Digits::Decimals(3)), "0.5");
        assert_eq!(editable(1.0 / 3.0, Digits::Significant), "0.33333");
        assert_eq!(
            (shown(0.0, Digits::Significant), shown(120.0, Digits::Significant)),
            ("0".into(), "120".into())
        );
        assert_eq!(shown(1e12, Digits::Significant), "1.000e12");
    }
}
