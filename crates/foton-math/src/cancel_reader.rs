//! A reader that fails once it is cancelled: for decoders of other crates, which check nothing.

use std::io::{self, BufRead, Read, Seek, SeekFrom};

use crate::cancel::Cancel;

/// Bytes that are handed out between two checks.
const BLOCK: usize = 1 << 16;

/// Reads `inner`, a block at a time, until it is cancelled.
#[derive(Debug)]
pub struct CancelReader<'a, R> {
    inner: R,
    cancel: &'a Cancel,
}

impl<'a, R> CancelReader<'a, R> {
    /// Over a reader.
    pub const fn new(inner: R, cancel: &'a Cancel) -> Self {
        Self { inner, cancel }
    }

    fn check(&self) -> io::Result<()> {
        self.cancel.check().map_err(io::Error::other)
    }
}

impl<R: Read> Read for CancelReader<'_, R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.check()?;
        let length = buffer.len().min(BLOCK);
        self.inner.read(&mut buffer[..length])
    }
}

impl<R: BufRead> BufRead for CancelReader<'_, R> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        self.check()?;
        let bytes = self.inner.fill_buf()?;
        Ok(&bytes[..bytes.len().min(BLOCK)])
    }

    fn consume(&mut self, amount: usize) {
        self.inner.consume(amount);
    }
}

impl<R: Seek> Seek for CancelReader<'_, R> {
    fn seek(&mut self, position: SeekFrom) -> io::Result<u64> {
        self.inner.seek(position)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_reads_all_unless_it_is_cancelled() {
        let bytes: Vec<u8> = (0..=255).cycle().take(3 * BLOCK + 7).collect();
        let read = |cancel: &Cancel| {
            let mut found = Vec::new();
            CancelReader::new(&bytes[..], cancel).read_to_end(&mut found).map(|_| found)
        };
        assert_eq!(read(&Cancel::default()).expect("all"), bytes);
        assert!(read(&Cancel::after(2)).is_err());
        let (cancel, mut buffered) = (Cancel::after(2), 0);
        let mut reader = CancelReader::new(&bytes[..], &cancel);
        while let Ok(block) = reader.fill_buf() {
            let length = block.len();
            buffered += length;
            reader.consume(length);
        }
        assert_eq!(buffered, 2 * BLOCK);
    }
}
