//! Who may end reading, and who is told how far it is.

use std::fmt;
use std::ops::Deref;
use std::sync::Arc;

use foton_math::Cancel;

/// Is told which share of a scene is read, from 0 to 1, while it is read; nobody by default.
#[derive(Clone, Default)]
pub struct Progress(Option<Arc<dyn Fn(f64) + Send + Sync>>);

impl Progress {
    /// Has that called, often but not for every line.
    #[must_use]
    pub fn new(tell: impl Fn(f64) + Send + Sync + 'static) -> Self {
        Self(Some(Arc::new(tell)))
    }
}

impl fmt::Debug for Progress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(if self.0.is_some() { "Progress(told)" } else { "Progress" })
    }
}

/// What reads a part of a scene asks for whether to go on, and tells how far it is.
#[derive(Clone, Copy)]
pub(crate) struct Watch<'a> {
    cancel: &'a Cancel,
    progress: Option<&'a Progress>,
    /// Where the part begins, and how much it is, as shares of the whole.
    begin: f64,
    length: f64,
}

impl<'a> Watch<'a> {
    /// Of all that is read.
    pub(crate) const fn new(cancel: &'a Cancel, progress: &'a Progress) -> Self {
        Self { cancel, progress: Some(progress), begin: 0.0, length: 1.0 }
    }

    /// Of a part, by where it begins and how much it is.
    pub(crate) fn part(self, begin: f64, length: f64) -> Self {
        Self { begin: self.begin + begin * self.length, length: length * self.length, ..self }
    }

    /// Tells that a share of the part is read.
    pub(crate) fn at(&self, share: f64) {
        if let Some(tell) = self.progress.and_then(|progress| progress.0.as_ref()) {
            tell((self.begin + self.length * share).clamp(0.0, 1.0));
        }
    }

    /// What ends reading.
    pub(crate) const fn cancel(&self) -> &'a Cancel {
        self.cancel
    }
}

impl<'a> From<&'a Cancel> for Watch<'a> {
    fn from(cancel: &'a Cancel) -> Self {
        Self { cancel, progress: None, begin: 0.0, length: 1.0 }
    }
}

impl Deref for Watch<'_> {
    type Target = Cancel;

    fn deref(&self) -> &Cancel {
        self.cancel
    }
}
