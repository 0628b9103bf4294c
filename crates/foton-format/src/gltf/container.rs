//! The parts of a file: of `.glb` the JSON text and the bytes behind it, of `.gltf` the text alone; and bytes inside of texts.

use std::borrow::Cow;

/// What a binary file begins with, and the kinds of its parts.
const MAGIC: &[u8] = b"glTF";
const JSON: &[u8] = b"JSON";
const BINARY: &[u8] = b"BIN\0";

/// The parts of a file.
pub(super) struct Parts<'a> {
    /// The description.
    pub(super) json: &'a [u8],
    /// The bytes behind it.
    pub(super) binary: Option<&'a [u8]>,
}

impl<'a> Parts<'a> {
    /// Takes a file apart.
    ///
    /// # Errors
    /// What is wrong with a binary file.
    pub(super) fn of(bytes: &'a [u8]) -> Result<Self, String> {
        if !bytes.starts_with(MAGIC) {
            let json = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
            return Ok(Self { json, binary: None });
        }
        let word = |at: usize| bytes.get(at..at + 4)?.try_into().ok().map(u32::from_le_bytes);
        match word(4) {
            Some(2) => {}
            Some(version) => {
                return Err(format!("version {version} of the binary format is not read, only 2"));
            }
            None => return Err("the file ends in its header".to_owned()),
        }
        let stated = word(8).map_or(0, |length| length as usize);
        if stated > bytes.len() {
            return Err(format!("the file has {} bytes and says that it has {stated}", bytes.len()));
        }
        let (mut at, mut json, mut binary) = (12, None, None);
        while let Some(length) = word(at) {
            let start = at + 8;
            let end = start.checked_add(length as usize).filter(|end| *end <= bytes.len());
            let (Some(kind), Some(end)) = (bytes.get(at + 4..start), end) else {
                return Err(format!(
                    "a part of {length} bytes begins at byte {at}, and the file ends before"
                ));
            };
            match kind {
                JSON if json.is_none() => json = Some(&bytes[start..end]),
                BINARY if binary.is_none() => binary = Some(&bytes[start..end]),
                // The format leaves room for parts of other kinds.
                _ => {}
            }
            at = end.next_multiple_of(4);
        }
        let json = json.ok_or_else(|| "the file has no part with a description (JSON)".to_owned())?;
        Ok(Self { json, binary })
    }
}

/// The bytes in a `data:` address; `None` for an address of another kind.
pub(super) fn data_of(uri: &str) -> Option<Result<Vec<u8>, String>> {
    let scheme = uri.get(..5)?;
    if !scheme.eq_ignore_ascii_case("data:") {
        return None;
    }
    let Some((head, data)) = uri[5..].split_once(',') else {
        return Some(Err("a data address needs a comma before its data".to_owned()));
    };
    let is_base64 = head.len() >= 7 && head.as_bytes()[head.len() - 7..].eq_ignore_ascii_case(b";base64");
    Some(if is_base64 { base64(data) } else { Ok(unescaped(data).into_owned()) })
}

/// What stands for four times six bits, with padding or without.
fn base64(text: &str) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::with_capacity(text.len() / 4 * 3 + 3);
    let (mut bits, mut count) = (0_u32, 0);
    for (i, letter) in text.bytes().enumerate() {
        let value = match letter {
            b'A'..=b'Z' => letter - b'A',
            b'a'..=b'z' => letter - b'a' + 26,
            b'0'..=b'9' => letter - b'0' + 52,
            b'+' | b'-' => 62,
            b'/' | b'_' => 63,
            b'=' => break,
            b if b.is_ascii_whitespace() => continue,
            _ => return Err(format!("character {} of its data is not of base64", i + 1)),
        };
        bits = bits << 6 | u32::from(value);
        count += 1;
        if count == 4 {
            bytes.extend(&bits.to_be_bytes()[1..]);
            (bits, count) = (0, 0);
        }
    }
    // What is left of the last four.
    let left = (bits << (6 * (4 - count))).to_be_bytes();
    bytes.extend(&left[1..1 + (count * 6 / 8) as usize]);
    Ok(bytes)
}

/// The bytes that a name in an address stands for: `%20` is a space.
pub(super) fn unescaped(text: &str) -> Cow<'_, [u8]> {
    if !text.contains('%') {
        return Cow::Borrowed(text.as_bytes());
    }
    let (bytes, mut at, mut out) = (text.as_bytes(), 0, Vec::with_capacity(text.len()));
    while let Some(&byte) = bytes.get(at) {
        let digits = if byte == b'%' { bytes.get(at + 1..at + 3) } else { None };
        let digits = digits.and_then(|digits| std::str::from_utf8(digits).ok());
        let code = digits.filter(|d| d.bytes().all(|b| b.is_ascii_hexdigit()));
        match code.and_then(|code| u8::from_str_radix(code, 16).ok()) {
            Some(code) => {
                out.push(code);
                at += 3;
            }
            None => {
                out.push(byte);
                at += 1;
            }
        }
    }
    Cow::Owned(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_is_decoded_whatever_its_length() {
        // RFC 4648, section 10.
        for (text, bytes) in [
            ("", ""),
            ("Zg==", "f"),
            ("Zm8=", "fo"),
            ("Zm9v", "foo"),
            ("Zm9vYg==", "foob"),
            ("Zm9vYmE=", "fooba"),
            ("Zm9vYmFy", "foobar"),
            ("Zm9vYmE", "fooba"),
        ] {
            assert_eq!(base64(text), Ok(bytes.as_bytes().to_vec()), "{text}");
        }
        assert_eq!(base64("+/-_"), Ok(vec![0xfb, 0xff, 0xbf]));
        assert!(base64("a*").is_err());
    }

    #[test]
    fn addresses_of_data_and_of_files_are_told_apart() {
        assert_eq!(data_of("data:application/octet-stream;base64,AAE="), Some(Ok(vec![0, 1])));
        assert_eq!(data_of("DATA:;BASE64,AAE="), Some(Ok(vec![0, 1])));
        assert_eq!(data_of("data:,a%20b"), Some(Ok(b"a b".to_vec())));
        assert!(matches!(data_of("data:base64"), Some(Err(_))));
        assert_eq!((data_of("a.bin"), data_of("é")), (None, None));
        assert_eq!(unescaped("a%20b%c3%A9%g%"), Cow::<[u8]>::Owned("a b\u{e9}%g%".into()));
    }

    #[test]
    fn parts_that_do_not_fit_are_refused() {
        let file = |version: u32, length: u32, part: u32| {
            let mut bytes = MAGIC.to_vec();
            [version, length, part].iter().for_each(|word| bytes.extend(word.to_le_bytes()));
            bytes.extend(b"JSON{}  ");
            bytes
        };
        assert!(
            Parts::of(&file(2, 24, 4)).is_ok_and(|parts| parts.json == b"{}  " && parts.binary.is_none())
        );
        for (bytes, wanted) in [
            (file(1, 24, 4), "version 1"),
            (file(2, 25, 4), "says that it has 25"),
            (file(2, 24, 5), "a part of 5 bytes"),
            (file(2, 24, u32::MAX), "a part of 4294967295 bytes"),
            (file(2, 24, 4)[..6].to_vec(), "ends in its header"),
            (file(2, 12, 4)[..12].to_vec(), "no part"),
        ] {
            let said = Parts::of(&bytes).err().unwrap_or_default();
            assert!(said.contains(wanted), "{said}");
        }
    }
}
