//! A channel that holds the newest value only: a slow reader never holds a writer up, and never sees the past.

use crossbeam_channel::{Receiver, Sender, TrySendError, bounded};

/// The writing end.
pub(super) struct NewestSender<T> {
    sender: Sender<T>,
    /// Takes what nobody read out of the way.
    stale: Receiver<T>,
}

/// The two ends.
pub(super) fn channel<T>() -> (NewestSender<T>, Receiver<T>) {
    let (sender, receiver) = bounded(1);
    (NewestSender { sender, stale: receiver.clone() }, receiver)
}

impl<T> NewestSender<T> {
    /// Puts a value in the place of the one that nobody has read yet.
    pub(super) fn send(&self, value: T) {
        let mut value = value;
        // The reader may take the old value in between: then the second try finds room.
        while let Err(TrySendError::Full(back)) = self.sender.try_send(value) {
            let _ = self.stale.try_recv();
            value = back;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_reader_sees_the_newest_value_only() {
        let (sender, receiver) = channel();
        for i in 0..5 {
            sender.send(i);
        }
        assert_eq!(receiver.try_recv(), Ok(4));
        assert!(receiver.try_recv().is_err());
    }
}
