//! The state of a render as bytes: all that passes have changed.

use foton_transport::codec::{Reader, StateError, Writer};

use super::algorithm::Sampled;

impl Sampled {
    pub(crate) fn save(&self) -> Vec<u8> {
        let mut out = Writer::default();
        out.u64(self.passes);
        out.u64(self.ledger.dropped);
        out.u64(self.pixels() as u64);
        self.sums.write(&mut out);
        out.finish()
    }

    pub(crate) fn restore(&mut self, state: &[u8]) -> Result<(), StateError> {
        let mut input = Reader::new(state);
        self.passes = input.count()?;
        self.ledger.dropped = input.count()?;
        input.expect(self.pixels())?;
        self.sums.read(&mut input)?;
        self.under_way.clear();
        input.finish()
    }
}
