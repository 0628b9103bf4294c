//! Radiance HDR files under other names: the decoder knows `#?RADIANCE` alone, while Mitsuba and others begin them with `#?RGBE` or
//! a name of their own.

const MARK: &[u8] = b"#?";
const KNOWN: &[u8] = b"#?RADIANCE";

/// No name is longer.
const LONGEST: usize = 80;

/// The file with the name that is known; other files as they are.
pub(super) fn named(mut bytes: Vec<u8>) -> Vec<u8> {
    let end = bytes.iter().take(LONGEST).position(|&b| b == b'\n');
    if let Some(end) = end
        && bytes.starts_with(MARK)
        && !bytes.starts_with(KNOWN)
    {
        drop(bytes.splice(..end, KNOWN.iter().copied()));
    }
    bytes
}
