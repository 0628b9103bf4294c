//! The attributes of an EXR header in the order of the file, which the `exr` crate keeps in a hash map without one.
//!
//! Two uses: putting our text attributes into the caller's order, so that equal input gives equal bytes, and reading
//! them back in that order. Only the first header of a file is looked at; pixels never are.

use std::ops::Range;

use crate::Metadata;

/// Bytes before the first attribute: the magic number and the version.
const START: usize = 8;

/// One attribute of a header.
struct Attribute<'a> {
    name: &'a [u8],
    kind: &'a [u8],
    value: &'a [u8],
    /// All its bytes in the file, name to value.
    bytes: Range<usize>,
}

/// Puts the attributes that `metadata` names into its order, behind all others, which stay in theirs.
///
/// The header keeps its length, so the offsets to the pixels stay right. `None` when the header is malformed.
pub(crate) fn sort_attributes(file: &mut [u8], metadata: &Metadata) -> Option<()> {
    let mut attributes = attributes(file)?;
    let place = |name: &[u8]| metadata.iter().position(|(key, _)| key.as_bytes() == name);
    // A stable sort, and `None` comes first: OpenEXR's own attributes keep their places.
    attributes.sort_by_key(|attribute| place(attribute.name));
    let sorted: Vec<u8> =
        attributes.iter().flat_map(|attribute| &file[attribute.bytes.clone()]).copied().collect();
    file[START..START + sorted.len()].copy_from_slice(&sorted);
    Some(())
}

/// All text attributes but `type`, which tells the storage, in the order of the file; bytes that are not UTF-8 are
/// replaced.
pub(crate) fn text_attributes(file: &[u8]) -> Option<Metadata> {
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    let is_text = |attribute: &&Attribute| attribute.kind == b"string" && attribute.name != b"type";
    Some(attributes(file)?.iter().filter(is_text).map(|a| (text(a.name), text(a.value))).collect())
}

/// The attributes of the first header: `name NUL type NUL size:i32 value`, closed by an empty name.
fn attributes(file: &[u8]) -> Option<Vec<Attribute<'_>>> {
    let mut found = Vec::new();
    let mut start = START;
    loop {
        let name = until_nul(file, start)?;
        if name.is_empty() {
            return Some(found);
        }
        let kind = until_nul(file, start + name.len() + 1)?;
        let size_at = start + name.len() + kind.len() + 2;
        let size = u32::from_le_bytes(*file.get(size_at..)?.first_chunk()?);
        let end = (size_at + 4).checked_add(usize::try_from(size).ok()?)?;
        let value = file.get(size_at + 4..end)?;
        found.push(Attribute { name, kind, value, bytes: start..end });
        start = end;
    }
}

/// The bytes from `start` up to the next NUL.
fn until_nul(file: &[u8], start: usize) -> Option<&[u8]> {
    file.get(start..)?.split(|&b| b == 0).next()
}
