//! What reading a scene may take together: memory for files, elements, meshes and pixels, counted before it is taken.

use crate::diagnostic::Place;

/// No scene is refused for less.
const SMALL: u64 = 4 << 20;

/// The most attributes of an element: readers look for each among all before it.
const MAX_ATTRIBUTES: usize = 1000;
/// The most declarations of name spaces in a file. Each element repeats those around it, and scenes have none.
const MAX_NAME_SPACES: usize = 64;

/// Bytes that an element takes, with the text behind it, by the parser and in our trees before and after parameters are replaced.
const BYTES_PER_ELEMENT: u64 = 700;
/// Bytes that an attribute takes, likewise.
const BYTES_PER_ATTRIBUTE: u64 = 400;

/// Memory that reading a scene has taken, and how much of it there is.
#[derive(Default)]
pub(crate) struct Budget {
    limit: Option<u64>,
    taken: u64,
}

impl Budget {
    pub(crate) fn new(limit: Option<u64>) -> Self {
        Self { limit, taken: 0 }
    }

    /// Takes bytes that stay taken, or says why not.
    pub(crate) fn take(&mut self, bytes: u64) -> Result<(), String> {
        self.check(bytes)?;
        self.taken += bytes;
        Ok(())
    }

    /// Whether there would be so many bytes, for what is given back.
    pub(crate) fn check(&self, bytes: u64) -> Result<(), String> {
        let takes = self.taken.saturating_add(bytes);
        match self.limit {
            Some(limit) if takes > limit.max(SMALL) => {
                let before = if self.taken >> 20 > 0 { " with what was read before" } else { "" };
                Err(format!(
                    "reading it takes up to {} MiB{before}, {} MiB may be used",
                    takes >> 20,
                    limit >> 20
                ))
            }
            _ => Ok(()),
        }
    }

    /// Bytes that are left.
    pub(crate) fn left(&self) -> u64 {
        self.limit.map_or(u64::MAX, |limit| limit.max(SMALL).saturating_sub(self.taken))
    }
}

/// What a text of XML holds, counted before it is parsed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Census {
    elements: u64,
    attributes: u64,
    bytes: u64,
}

impl Census {
    /// Counts elements and attributes; at the offset of an element that has too many attributes a message.
    pub(crate) fn of(text: &str) -> Result<Self, (usize, String)> {
        if text.matches("xmlns").nth(MAX_NAME_SPACES).is_some() {
            return Err((0, format!("more than {MAX_NAME_SPACES} name spaces are declared")));
        }
        let mut census = Self { bytes: text.len() as u64, ..Self::default() };
        let mut at = 0;
        while let Some(start) = text[at..].find('<').map(|offset| at + offset) {
            let rest = &text[start..];
            let skipped = [("<!--", "-->"), ("<![CDATA[", "]]>"), ("<?", "?>"), ("</", ">"), ("<!", ">")];
            if let Some((open, close)) = skipped.iter().find(|(open, _)| rest.starts_with(open)) {
                let end = rest[open.len()..].find(close).map(|end| end + open.len() + close.len());
                at = start + end.unwrap_or(rest.len());
                continue;
            }
            let (length, attributes) = tag(rest);
            if attributes > MAX_ATTRIBUTES {
                return Err((start, format!("an element has more than {MAX_ATTRIBUTES} attributes")));
            }
            census.elements += 1;
            census.attributes += attributes as u64;
            at = start + length;
        }
        Ok(census)
    }

    /// Bytes that reading it takes at most.
    pub(crate) fn memory(self) -> u64 {
        self.elements * BYTES_PER_ELEMENT + self.attributes * BYTES_PER_ATTRIBUTE + 5 * self.bytes
    }
}

/// The length of the tag that a text begins with, and how many values in quotation marks stand in it.
fn tag(text: &str) -> (usize, usize) {
    let (mut quote, mut values) = (None, 0);
    for (i, byte) in text.bytes().enumerate().skip(1) {
        match (quote, byte) {
            (Some(open), _) if open == byte => quote = None,
            (None, b'"' | b'\'') => {
                quote = Some(byte);
                values += 1;
            }
            (None, b'>') => return (i + 1, values),
            _ => {}
        }
    }
    (text.len(), values)
}

/// A message at an offset as one at a place.
pub(crate) fn at_place(text: &str, offset: usize) -> Place {
    let before = &text[..offset];
    let line = before.matches('\n').count() + 1;
    let column = before.rsplit('\n').next().map_or(0, |line| line.chars().count()) + 1;
    let number = |n: usize| u32::try_from(n).unwrap_or(0);
    Place { line: number(line), column: number(column) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elements_and_attributes_are_counted_as_a_parser_finds_them() {
        let text =
            "<?xml version='1.0'?><!-- <a b='c'> --><s v=\"a'>b\"><a b='1' c='>'/>x='y'<![CDATA[<b/>]]></s>";
        let census = Census { elements: 2, attributes: 3, bytes: text.len() as u64 };
        assert_eq!(Census::of(text), Ok(census));
        for broken in ["<", "<a b='", "<!--", "<a", "</", "<![CDATA[", "<?"] {
            assert!(Census::of(broken).is_ok_and(|c| c.elements <= 1), "{broken}");
        }
        let many = format!("<s>\n <a {}/></s>", "a='' ".repeat(MAX_ATTRIBUTES + 1));
        let (offset, message) = Census::of(&many).unwrap_err();
        assert_eq!(
            (at_place(&many, offset), &*message),
            (Place { line: 2, column: 2 }, "an element has more than 1000 attributes")
        );
        assert!(Census::of(&"<a xmlns:b='c'/>".repeat(MAX_NAME_SPACES + 1)).is_err());
    }

    #[test]
    fn what_was_taken_counts_and_what_was_only_looked_at_does_not() {
        let mut budget = Budget::new(Some(10 << 20));
        assert_eq!((budget.check(10 << 20), budget.take(6 << 20)), (Ok(()), Ok(())));
        let said = "reading it takes up to 11 MiB with what was read before, 10 MiB may be used";
        assert_eq!(budget.check(5 << 20), Err(said.to_owned()));
        assert_eq!(budget.left(), 4 << 20);
        assert_eq!(Budget::new(None).take(u64::MAX), Ok(()));
    }
}
