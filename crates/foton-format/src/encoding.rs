//! The bytes of an XML file as text: UTF-8 or UTF-16 by their marks, UTF-8 without one, or Latin-1 where the declaration says so.

/// Names that XML declarations give to Latin-1 and to what programs mean by it.
const LATIN_1: [&str; 7] =
    ["iso-8859-1", "iso8859-1", "iso_8859-1", "latin1", "latin-1", "windows-1252", "cp1252"];

/// A declaration stands within so many bytes.
const MAX_DECLARATION: usize = 200;

/// The text of a file, without the mark of its encoding; otherwise the line, from 1, that is not UTF-8.
pub(crate) fn decoded(bytes: Vec<u8>) -> Result<String, u32> {
    if let [a @ (0xff | 0xfe), b, rest @ ..] = &bytes[..]
        && a ^ b == 1
    {
        let unit =
            |pair: &[u8; 2]| if *a == 0xff { u16::from_le_bytes(*pair) } else { u16::from_be_bytes(*pair) };
        let (pairs, odd) = rest.as_chunks::<2>();
        let text = char::decode_utf16(pairs.iter().map(unit)).collect::<Result<String, _>>();
        return text.ok().filter(|_| odd.is_empty()).ok_or(1);
    }
    match String::from_utf8(bytes) {
        Ok(mut text) => {
            if text.starts_with('\u{feff}') {
                text.drain(..'\u{feff}'.len_utf8());
            }
            Ok(text)
        }
        Err(error) if is_declared_latin_1(error.as_bytes()) => {
            Ok(error.as_bytes().iter().map(|&byte| char::from(byte)).collect())
        }
        Err(error) => {
            let valid = &error.as_bytes()[..error.utf8_error().valid_up_to()];
            Err(u32::try_from(valid.iter().filter(|&&b| b == b'\n').count() + 1).unwrap_or(0))
        }
    }
}

/// Whether a file begins with a declaration by which it is Latin-1.
fn is_declared_latin_1(bytes: &[u8]) -> bool {
    let begin = &bytes[..bytes.len().min(MAX_DECLARATION)];
    let text: String = begin.iter().map(|&byte| char::from(byte)).collect();
    let Some((declaration, _)) = text.strip_prefix("<?xml").and_then(|rest| rest.split_once("?>")) else {
        return false;
    };
    let Some((_, value)) = declaration.split_once("encoding") else { return false };
    let value = value.trim_start().trim_start_matches('=').trim_start();
    let Some(quote) = value.chars().next().filter(|c| matches!(c, '"' | '\'')) else { return false };
    let name = value[1..].split(quote).next().unwrap_or_default();
    LATIN_1.iter().any(|known| name.eq_ignore_ascii_case(known))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_and_declarations_say_what_bytes_mean() {
        let utf16 = |mark: &str, bytes: fn(u16) -> [u8; 2]| -> Vec<u8> {
            format!("{mark}<a b='é𝄞'/>").encode_utf16().flat_map(bytes).collect()
        };
        let text = Ok("<a b='é𝄞'/>".to_owned());
        assert_eq!(decoded("<a b='é𝄞'/>".into()), text);
        assert_eq!(decoded("\u{feff}<a b='é𝄞'/>".into()), text);
        assert_eq!(decoded(utf16("\u{feff}", u16::to_le_bytes)), text);
        assert_eq!(decoded(utf16("\u{feff}", u16::to_be_bytes)), text);
        for name in ["ISO-8859-1", "latin1", "Windows-1252"] {
            let begin = format!("<?xml version=\"1.0\" encoding='{name}' ?>\n<a b='");
            let bytes = [begin.as_bytes(), b"\xe9'/>"].concat();
            assert_eq!(decoded(bytes), Ok(format!("{begin}é'/>")), "{name}");
        }
        // A declaration is often wrong, and what is UTF-8 is hardly anything else.
        let wrong = "<?xml version='1.0' encoding='latin1'?><a b='é'/>";
        assert_eq!(decoded(wrong.into()), Ok(wrong.to_owned()));
    }

    #[test]
    fn other_bytes_are_refused_with_their_line() {
        for bytes in [
            &b"<a>\n\n\xe9</a>"[..],
            b"<?xml version='1.0' encoding='utf-8'?>\n\n\xe9",
            b"<?xml version='1.0' encoding=latin1?>\n\n\xe9",
            b"<?xml version='1.0'?>\n<!-- encoding='latin1' -->\n\xe9",
        ] {
            assert_eq!(decoded(bytes.to_vec()), Err(3), "{}", bytes.escape_ascii());
        }
        assert_eq!(decoded(b"\xff\xfe<\0a".to_vec()), Err(1));
        assert_eq!(decoded(b"\xff\xfe\x00\xd8".to_vec()), Err(1));
    }
}
