//! FNV-1a with 64 bits: the same hash on every platform, to recognise a scene. Not for security.

/// A hash of parts; each part counts with its length, so that moving a byte from one to the next changes it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fnv1a(u64);

impl Default for Fnv1a {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl Fnv1a {
    /// Adds a part.
    pub(crate) fn add(&mut self, part: &[u8]) {
        self.bytes(&(part.len() as u64).to_le_bytes());
        self.bytes(part);
    }

    fn bytes(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }

    /// The hash of all parts so far.
    pub(crate) fn finish(self) -> u64 {
        self.0
    }
}

/// The hash of some parts.
pub(crate) fn of_parts<'a>(parts: impl IntoIterator<Item = &'a [u8]>) -> u64 {
    let mut hash = Fnv1a::default();
    parts.into_iter().for_each(|part| hash.add(part));
    hash.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_hash_to_the_published_value() {
        let mut hash = Fnv1a::default();
        hash.bytes(b"foobar");
        assert_eq!(hash.finish(), 0x85944171f73967e8);
    }

    #[test]
    fn parts_are_told_apart() {
        let (ab_c, a_bc): ([&[u8]; 2], [&[u8]; 2]) = ([b"ab", b"c"], [b"a", b"bc"]);
        assert_ne!(of_parts(ab_c), of_parts(a_bc));
    }
}
