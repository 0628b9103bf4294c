//! Text of foreign files in messages: short, and printable.
//!
//! A name in a file can hold what a terminal obeys (escape sequences), what turns the direction of a line around, or a line of
//! its own. In messages all of that is escaped as in Rust's string literals.

use std::borrow::Cow;
use std::path::Path;

/// The largest number of characters of a word that a message quotes.
pub const MAX_QUOTE: usize = 40;

/// The largest number of characters of a path in a message.
const MAX_PATH: usize = 200;

/// Whether a character shows itself and nothing else: no control character, no mark of direction, no separator of lines, nothing
/// of no width.
#[must_use]
pub fn is_printable(c: char) -> bool {
    !c.is_control()
        && !matches!(c,
            '\u{ad}' | '\u{61c}' | '\u{180e}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}'
            | '\u{2060}'..='\u{206f}' | '\u{feff}' | '\u{fff9}'..='\u{fffb}' | '\u{e0000}'..='\u{e0fff}')
}

/// A text with everything escaped that is not printable, at its whole length: for what is printed in the end.
#[must_use]
pub fn printable(text: &str) -> Cow<'_, str> {
    if text.chars().all(is_printable) { Cow::Borrowed(text) } else { Cow::Owned(escaped(text.chars())) }
}

/// A word as a message may quote it: printable, at most [`MAX_QUOTE`] characters, with `…` for what is left out.
#[must_use]
pub fn shown(text: &str) -> String {
    if text.chars().nth(MAX_QUOTE).is_none() {
        return escaped(text.chars());
    }
    escaped(text.chars().take(MAX_QUOTE - 1)) + "…"
}

/// [`shown`] between quotation marks.
#[must_use]
pub fn quoted(text: &str) -> String {
    format!("\"{}\"", shown(text))
}

/// [`shown`] for bytes; those that are no UTF-8 are replaced.
#[must_use]
pub fn shown_bytes(text: &[u8]) -> String {
    // No character has more than four bytes.
    shown(&String::from_utf8_lossy(&text[..text.len().min(4 * MAX_QUOTE + 4)]))
}

/// A path as it may stand in a message: printable, and without its middle where it is very long.
#[must_use]
pub fn shown_path(path: &Path) -> String {
    let text = path.to_string_lossy();
    let length = text.chars().count();
    if length <= MAX_PATH {
        return escaped(text.chars());
    }
    let (start, end) = (MAX_PATH / 4, 3 * MAX_PATH / 4 - 1);
    escaped(text.chars().take(start)) + "…" + &escaped(text.chars().skip(length - end))
}

/// A document of JSON in which all is escaped that is not printable: the same values for a program, harmless on a terminal.
#[must_use]
pub fn json(document: &str) -> Cow<'_, str> {
    if document.chars().all(is_printable) {
        return Cow::Borrowed(document);
    }
    let mut text = String::with_capacity(document.len() + 16);
    for c in document.chars() {
        if is_printable(c) {
            text.push(c);
        } else {
            let mut units = [0; 2];
            c.encode_utf16(&mut units).iter().for_each(|unit| text += &format!("\\u{unit:04x}"));
        }
    }
    Cow::Owned(text)
}

fn escaped(text: impl Iterator<Item = char>) -> String {
    let mut escaped = String::new();
    for c in text {
        match c {
            '\n' | '\r' | '\t' => escaped.extend(c.escape_default()),
            _ if is_printable(c) => escaped.push(c),
            _ => escaped.extend(c.escape_unicode()),
        }
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quote_has_forty_characters_at_most() {
        let [short, long] = [40, 41].map(|n| "é".repeat(n));
        assert_eq!(quoted(&short), format!("\"{short}\""));
        assert_eq!(quoted(&long), format!("\"{}…\"", "é".repeat(39)));
        assert_eq!(shown_bytes(&[b'a'; 1000]).chars().count(), MAX_QUOTE);
        assert_eq!(shown_bytes(&"🦀".repeat(1000).into_bytes()).chars().count(), MAX_QUOTE);
    }

    #[test]
    fn nothing_in_a_quote_moves_the_cursor_or_turns_the_line() {
        assert_eq!(quoted("a\u{1b}[31mb\u{7}"), "\"a\\u{1b}[31mb\\u{7}\"");
        assert_eq!(quoted("a\nerror: b\r\t"), "\"a\\nerror: b\\r\\t\"");
        for c in [
            '\u{9b}',
            '\u{202e}',
            '\u{2066}',
            '\u{200f}',
            '\u{2028}',
            '\u{feff}',
            '\0',
            '\u{7f}',
            '\u{e0041}',
        ] {
            assert!(shown(&c.to_string()).starts_with("\\u{"), "{c:?}");
            assert!(printable(&format!("x{c}")).starts_with("x\\u{"), "{c:?}");
            assert!(json(&format!("\"x{c}\"")).starts_with("\"x\\u"), "{c:?}");
        }
        for plain in ["größe", "日本", "a\"b\\c", "1.5 × 2 → 3"] {
            assert_eq!((&*printable(plain), &*json(plain), shown(plain).as_str()), (plain, plain, plain));
        }
        assert_eq!(json("\"\u{e0041}\""), "\"\\udb40\\udc41\"");
    }

    #[test]
    fn bytes_that_are_no_text_are_replaced() {
        assert_eq!(shown_bytes(b"\xff\x00z"), "\u{fffd}\\u{0}z");
    }

    #[test]
    fn a_long_path_is_cut_in_its_middle() {
        let path = format!("/start/{}/end.obj", "x".repeat(5000));
        let shown = shown_path(Path::new(&path));
        assert_eq!(shown.chars().count(), MAX_PATH);
        assert!(shown.starts_with("/start/x") && shown.ends_with("x/end.obj"), "{shown}");
    }
}
