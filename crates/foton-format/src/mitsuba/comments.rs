//! Comments that hold `--`: XML forbids them, and yet other readers take them, so that people comment out what is a comment already.

use std::borrow::Cow;

/// The text with every comment such that XML allows it, and every byte at its place: hyphens that stand before another one
/// or at a comment's end become underscores. Comments end, as in other readers, at the first `-->`.
pub(super) fn mended(text: &str) -> Cow<'_, str> {
    let mut mended: Option<Vec<u8>> = None;
    let mut at = 0;
    while let Some(start) = text[at..].find('<').map(|offset| at + offset) {
        let rest = &text[start..];
        let (open, close) = match () {
            () if rest.starts_with("<!--") => ("<!--", "-->"),
            () if rest.starts_with("<![CDATA[") => ("<![CDATA[", "]]>"),
            () if rest.starts_with("<?") => ("<?", "?>"),
            () => {
                at = start + 1;
                continue;
            }
        };
        let Some(length) = rest[open.len()..].find(close) else { break };
        let inside = start + open.len()..start + open.len() + length;
        at = inside.end + close.len();
        if open != "<!--" {
            continue;
        }
        let comment = &text.as_bytes()[inside.clone()];
        for (i, _) in comment.iter().enumerate().filter(|(_, byte)| **byte == b'-') {
            if matches!(comment.get(i + 1), None | Some(b'-')) {
                let bytes = mended.get_or_insert_with(|| text.as_bytes().to_vec());
                bytes[inside.start + i] = b'_';
            }
        }
    }
    // One byte of ASCII stands for another.
    mended.and_then(|bytes| String::from_utf8(bytes).ok()).map_or(Cow::Borrowed(text), Cow::Owned)
}

/// The text with white space in the place of a document type that declares nothing itself, as editors put it at the top of scenes. One that
/// does stays, for the parser to refuse.
pub(crate) fn without_document_type(text: &str) -> Cow<'_, str> {
    const OPEN: &str = "<!DOCTYPE";
    let mut at = 0;
    // Before the first element there may be comments and instructions, which may hold anything.
    let start = loop {
        let rest = &text[at..];
        let blank = rest.len() - rest.trim_start().len();
        let rest = &rest[blank..];
        at += blank;
        let Some((_, close)) =
            [("<!--", "-->"), ("<?", "?>")].iter().find(|(open, _)| rest.starts_with(open))
        else {
            break at;
        };
        let Some(end) = rest.find(close) else { return Cow::Borrowed(text) };
        at += end + close.len();
    };
    let Some(end) = text[start..].starts_with(OPEN).then(|| text[start..].find('>')).flatten() else {
        return Cow::Borrowed(text);
    };
    let declaration = &text[start..=start + end];
    if declaration.contains('[') {
        return Cow::Borrowed(text);
    }
    // As many bytes and lines: what comes after keeps its place.
    let blank: String = declaration.bytes().map(|b| if b == b'\n' { '\n' } else { ' ' }).collect();
    Cow::Owned([&text[..start], &blank, &text[start + end + 1..]].concat())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_document_type_that_declares_nothing_is_white_space() {
        for (text, wanted) in [
            ("<!DOCTYPE a><a/>", "            <a/>"),
            (
                "<?xml v?>\n<!-- <!DOCTYPE b> -->\n<!DOCTYPE a\n'é'><a/>",
                "<?xml v?>\n<!-- <!DOCTYPE b> -->\n           \n     <a/>",
            ),
            ("<!DOCTYPE a [<!ENTITY b 'c'>]><a/>", "<!DOCTYPE a [<!ENTITY b 'c'>]><a/>"),
            ("<a><!DOCTYPE a></a>", "<a><!DOCTYPE a></a>"),
            ("<!DOCTYPE a", "<!DOCTYPE a"),
            ("<!-- ", "<!-- "),
        ] {
            assert_eq!(without_document_type(text), wanted);
        }
    }

    #[test]
    fn hyphens_in_comments_keep_their_places_and_others_stay() {
        for (text, wanted) in [
            ("<!-- a -- b --><a/>", "<!-- a _- b --><a/>"),
            ("<!--- a ---><a/>", "<!--- a _--><a/>"),
            ("<!------><a/>", "<!--__--><a/>"),
            ("<!-- é - ---- -->", "<!-- é - ___- -->"),
            (
                "<!-- <a b='--'/> --><a b='--'/>--<?p --?><![CDATA[<!-- -- -->]]>",
                "<!-- <a b='_-'/> --><a b='--'/>--<?p --?><![CDATA[<!-- -- -->]]>",
            ),
            ("<!-- -- ", "<!-- -- "),
            ("<!---->", "<!---->"),
        ] {
            assert_eq!(mended(text), wanted);
        }
    }
}
