//! Portable float maps (PFM): linear numbers of single precision, rows from the bottom up. `[PFM]`

use foton_math::Rgb;

/// The size, where the pixels begin, whether there are three channels, and whether numbers are little-endian.
pub(super) struct Header {
    pub(super) width: u32,
    pub(super) height: u32,
    start: usize,
    channels: usize,
    is_little: bool,
}

/// Whether a file begins as a PFM.
pub(super) fn is_pfm(bytes: &[u8]) -> bool {
    (bytes.starts_with(b"PF") || bytes.starts_with(b"Pf"))
        && bytes.get(2).is_some_and(u8::is_ascii_whitespace)
}

impl Header {
    /// Three words after the mark: width, height, and a number whose sign tells the order of bytes.
    pub(super) fn parse(bytes: &[u8]) -> Result<Self, String> {
        let broken = || "its header is broken".to_owned();
        let mut at = 2;
        let mut word = || {
            let is_space = |i: &usize| bytes.get(*i).is_some_and(u8::is_ascii_whitespace);
            at += (at..).take_while(is_space).count();
            let start = at;
            at += (at..).take_while(|i| *i < bytes.len() && !is_space(i)).count();
            let text = std::str::from_utf8(&bytes[start..at]).ok().filter(|text| !text.is_empty());
            // One space ends a word, what follows the last one are pixels.
            (text, at + 1)
        };
        let mut size = || word().0.and_then(|text| text.parse::<u32>().ok()).ok_or_else(broken);
        let (width, height) = (size()?, size()?);
        let (scale, start) = word();
        let scale = scale.and_then(|text| text.parse::<f32>().ok()).filter(|s| s.is_finite() && *s != 0.0);
        let scale = scale.ok_or_else(broken)?;
        let channels = if bytes[1] == b'F' { 3 } else { 1 };
        Ok(Self { width, height, start, channels, is_little: scale < 0.0 })
    }

    /// The pixels from the top left; the size was judged before.
    pub(super) fn pixels(&self, bytes: &[u8]) -> Result<Vec<Rgb>, String> {
        let row = self.width as usize * self.channels * 4;
        let pixels =
            bytes.get(self.start..).and_then(|rest| rest.get(..row.checked_mul(self.height as usize)?));
        let pixels = pixels.ok_or("the file ends before its pixels do")?;
        let number =
            |b: &[u8; 4]| if self.is_little { f32::from_le_bytes(*b) } else { f32::from_be_bytes(*b) };
        let colour = |c: &[[u8; 4]]| match c {
            [r, g, b] => Rgb::new(number(r), number(g), number(b)),
            other => Rgb::splat(number(&other[0])),
        };
        let rows = pixels.chunks_exact(row).rev();
        Ok(rows.flat_map(|row| row.as_chunks().0.chunks_exact(self.channels).map(colour)).collect())
    }
}
