//! The text that travels with an image: an ordered list of keys and values. What the keys mean is the caller's.

use std::fmt::Display;

use exr::meta::header::standard_names;
use thiserror::Error;

/// Ordered key and value text, written as EXR text attributes and PNG text chunks.
///
/// A key is 1 to 79 printable ASCII characters without spaces, by convention `foton:NAME`; both formats can then
/// carry it, and the colon keeps it apart from OpenEXR's own attributes. A value is any text without NUL; a list
/// of changes is one value with a line for each. Keys are checked when the file is written.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Metadata(Vec<(String, String)>);

impl Metadata {
    /// Sets `key`, in its old place if it is there already, else at the end.
    pub fn set(&mut self, key: impl Into<String>, value: impl Display) {
        let (key, value) = (key.into(), value.to_string());
        match self.0.iter_mut().find(|(k, _)| *k == key) {
            Some((_, old)) => *old = value,
            None => self.0.push((key, value)),
        }
    }

    /// The value of `key`.
    #[must_use]
    pub fn get(&self, key: &str) -> Option<&str> {
        self.iter().find(|(k, _)| *k == key).map(|(_, value)| value)
    }

    /// Keys and values in order.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &str)> {
        self.0.iter().map(|(key, value)| (key.as_str(), value.as_str()))
    }

    /// Refuses text that one of the two formats cannot carry.
    pub(crate) fn check(&self) -> Result<(), MetadataError> {
        for (key, value) in self.iter() {
            let key_fits = (1..=79).contains(&key.len()) && key.bytes().all(|b| b.is_ascii_graphic());
            if !key_fits {
                return Err(MetadataError::Key { key: key.into() });
            }
            if standard_names::ALL.contains(&key.as_bytes()) {
                return Err(MetadataError::Reserved { key: key.into() });
            }
            if value.contains('\0') {
                return Err(MetadataError::Nul { key: key.into() });
            }
        }
        Ok(())
    }
}

impl<K: Into<String>, V: Display> FromIterator<(K, V)> for Metadata {
    fn from_iter<I: IntoIterator<Item = (K, V)>>(pairs: I) -> Self {
        let mut metadata = Self::default();
        for (key, value) in pairs {
            metadata.set(key, value);
        }
        metadata
    }
}

/// Why some metadata cannot be written.
#[derive(Debug, Error, PartialEq, Eq)]
pub enum MetadataError {
    /// The key is empty, too long, or not printable ASCII.
    #[error("the metadata key {key:?} is not 1 to 79 printable ASCII characters without spaces")]
    Key {
        /// The key.
        key: String,
    },
    /// The key names an attribute that OpenEXR defines.
    #[error("the metadata key {key:?} is one of OpenEXR's own attributes")]
    Reserved {
        /// The key.
        key: String,
    },
    /// The value holds a NUL.
    #[error("the metadata value of {key:?} holds a NUL character")]
    Nul {
        /// The key.
        key: String,
    },
}
