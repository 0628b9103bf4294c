//! Numbers as bytes, and back: what the states of renders are written with.

use foton_math::Rgb;
use thiserror::Error;

/// Why bytes are no state of a render.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
pub enum StateError {
    /// They end too early, or go on.
    #[error("the state of the render is {0} bytes too short or too long")]
    Length(i64),
    /// They are of another scene, or of other settings.
    #[error("the state of the render is of another scene or of other settings")]
    OtherRender,
    /// A number that no render can have.
    #[error("the state of the render holds a value that cannot be")]
    Impossible,
}

/// Little-endian numbers, appended.
#[derive(Default)]
pub struct Writer(Vec<u8>);

impl Writer {
    /// The bytes.
    #[must_use]
    pub fn finish(self) -> Vec<u8> {
        self.0
    }

    /// An integer, in 8 bytes.
    pub fn u64(&mut self, value: u64) {
        self.0.extend_from_slice(&value.to_le_bytes());
    }

    /// A double, in 8 bytes.
    pub fn f64(&mut self, value: f64) {
        self.u64(value.to_bits());
    }

    /// Bytes as they are.
    pub fn bytes(&mut self, bytes: &[u8]) {
        self.0.extend_from_slice(bytes);
    }

    /// A colour, in 12 bytes.
    pub fn rgb(&mut self, colour: Rgb) {
        for channel in colour.to_array() {
            self.0.extend_from_slice(&channel.to_le_bytes());
        }
    }
}

/// The same numbers in the same order.
pub struct Reader<'a>(&'a [u8]);

impl<'a> Reader<'a> {
    /// Reads what a [`Writer`] has written.
    #[must_use]
    pub const fn new(bytes: &'a [u8]) -> Self {
        Self(bytes)
    }

    /// # Errors
    /// When bytes are left.
    pub fn finish(self) -> Result<(), StateError> {
        if self.0.is_empty() { Ok(()) } else { Err(StateError::Length(self.0.len() as i64)) }
    }

    /// Whether no bytes are left.
    #[must_use]
    pub const fn is_at_end(&self) -> bool {
        self.0.is_empty()
    }

    fn take<const N: usize>(&mut self) -> Result<[u8; N], StateError> {
        let (head, tail) =
            self.0.split_first_chunk::<N>().ok_or(StateError::Length(self.0.len() as i64 - N as i64))?;
        self.0 = tail;
        Ok(*head)
    }

    /// Bytes as they are.
    ///
    /// # Errors
    /// When the bytes end.
    pub fn bytes<const N: usize>(&mut self) -> Result<[u8; N], StateError> {
        self.take()
    }

    /// An integer, in 8 bytes.
    ///
    /// # Errors
    /// When the bytes end.
    pub fn u64(&mut self) -> Result<u64, StateError> {
        Ok(u64::from_le_bytes(self.take()?))
    }

    /// A double, in 8 bytes.
    ///
    /// # Errors
    /// When the bytes end.
    pub fn f64(&mut self) -> Result<f64, StateError> {
        Ok(f64::from_bits(self.u64()?))
    }

    /// A number of things that were counted one by one: more than 2⁵³ no render lives to see, and sums with them would overflow.
    ///
    /// # Errors
    /// When the bytes end, or hold something else.
    pub fn count(&mut self) -> Result<u64, StateError> {
        self.u64().and_then(|n| if n <= 1 << 53 { Ok(n) } else { Err(StateError::Impossible) })
    }

    /// One that must be finite: a NaN would go on to spoil the image.
    ///
    /// # Errors
    /// When the bytes end, or hold something else.
    pub fn finite(&mut self) -> Result<f64, StateError> {
        self.f64().and_then(|x| if x.is_finite() { Ok(x) } else { Err(StateError::Impossible) })
    }

    /// A colour, which must be finite.
    ///
    /// # Errors
    /// When the bytes end, or hold something else.
    pub fn rgb(&mut self) -> Result<Rgb, StateError> {
        let mut channel = || self.take().map(f32::from_le_bytes);
        let colour = Rgb::from_array([channel()?, channel()?, channel()?]);
        if colour.is_finite() { Ok(colour) } else { Err(StateError::Impossible) }
    }

    /// A count that must be what this render has.
    ///
    /// # Errors
    /// When the bytes end, or hold something else.
    pub fn expect(&mut self, count: usize) -> Result<(), StateError> {
        if self.u64()? == count as u64 { Ok(()) } else { Err(StateError::OtherRender) }
    }
}
