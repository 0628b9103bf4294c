//! Numbers as people read them.

/// A number with thousands set apart: `12 345 678`.
pub(super) fn grouped(n: u64) -> String {
    let digits = n.to_string();
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push('\u{a0}');
        }
        text.push(digit);
    }
    text
}

/// A positive number in three digits, with powers of ten where that is shorter.
pub(super) fn short(x: f64) -> String {
    match x.abs() {
        0.0 => "0".to_owned(),
        a if (0.01..1e4).contains(&a) => {
            let decimals = (2 - a.log10().floor() as i32).clamp(0, 4);
            format!("{x:.*}", decimals as usize)
        }
        _ => format!("{x:.2e}"),
    }
}

/// "3.1 %".
pub(super) fn percent(share: f64) -> String {
    let digits = if share < 0.1 { 2 } else { 1 };
    format!("{:.digits$} %", 100.0 * share)
}

/// A name of at most so many characters, its middle left out where it has more: names often differ at their ends.
pub(super) fn shortened(name: &str, most: usize) -> String {
    let count = name.chars().count();
    if count <= most {
        return name.to_owned();
    }
    let end = (most - 1) / 2;
    let begin = most - 1 - end;
    name.chars().take(begin).chain(['…']).chain(name.chars().skip(count - end)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_names_lose_their_middles() {
        assert_eq!(shortened("ring", 9), "ring");
        assert_eq!(shortened("glass-and-ring-edited", 9), "glas…ited");
        assert_eq!(shortened("größer als überall", 9).chars().count(), 9);
    }

    #[test]
    fn numbers_are_short_and_grouped() {
        assert_eq!(grouped(1_234_567), "1\u{a0}234\u{a0}567");
        assert_eq!((grouped(0), grouped(999)), ("0".to_owned(), "999".to_owned()));
        assert_eq!((short(0.0), short(12.345), short(0.0456)), ("0".into(), "12.3".into(), "0.0456".into()));
        assert_eq!((short(1.5e-5), short(123_456.0)), ("1.50e-5".to_owned(), "1.23e5".to_owned()));
    }
}
