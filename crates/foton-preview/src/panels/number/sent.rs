//! A value that was committed and that frames do not have yet: it is shown until they do, so that nothing jumps back.

/// How long a committed value is shown while frames still have the old one, in seconds.
const PATIENCE: f64 = 1.5;

#[derive(Clone, Copy, Debug)]
pub(crate) struct Sent {
    before: f64,
    value: f64,
    until: f64,
}

impl Sent {
    /// A value that was committed over another one.
    pub(crate) fn new(before: f64, value: f64, now: f64) -> Self {
        Self { before, value, until: now + PATIENCE }
    }

    /// What is shown while frames have `value`; `None` once they have another one, or for too long.
    pub(crate) fn shown(self, value: f64, now: f64) -> Option<f64> {
        (self.before == value && now < self.until).then_some(self.value)
    }
}
