//! The changes of settings that a render has gone by, for whoever wants to make it again.

use crate::settings::SettingChange;

/// Changes that have had an effect, each with the number of passes before it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Changes {
    log: Vec<(u64, SettingChange)>,
    /// For each, what it replaced.
    before: Vec<SettingChange>,
}

impl Changes {
    /// Those of a render that is restored.
    pub(crate) fn restored(log: Vec<(u64, SettingChange)>) -> Self {
        Self { before: log.iter().map(|(_, change)| *change).collect(), log }
    }

    /// All of them.
    pub(crate) fn log(&self) -> &[(u64, SettingChange)] {
        &self.log
    }

    /// Notes a change after some passes, from one value to another. Of several between two passes the last one counts; a change back
    /// to what it was is none.
    pub(crate) fn add(&mut self, passes: u64, from: SettingChange, to: SettingChange) {
        let is_same = |(at, change): &(u64, SettingChange)| *at == passes && change.is_of_the_kind_of(&to);
        let mut from = from;
        if let Some(earlier) = self.log.iter().position(is_same) {
            self.log.remove(earlier);
            from = self.before.remove(earlier);
        }
        if from != to {
            self.log.push((passes, to));
            self.before.push(from);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::num::NonZeroU32;

    use super::*;
    use crate::ppm::Alpha;

    fn alpha(value: f64) -> SettingChange {
        SettingChange::Alpha(Alpha::new(value).expect("in range"))
    }

    fn photons(n: u32) -> SettingChange {
        SettingChange::PhotonsPerPass(NonZeroU32::new(n).expect("above 0"))
    }

    #[test]
    fn of_several_changes_between_two_passes_the_last_one_stands() {
        let mut changes = Changes::default();
        changes.add(3, alpha(0.7), alpha(0.6));
        changes.add(3, photons(10), photons(20));
        changes.add(3, alpha(0.6), alpha(0.5));
        assert_eq!(changes.log(), [(3, photons(20)), (3, alpha(0.5))]);
        changes.add(4, alpha(0.5), alpha(0.6));
        assert_eq!(changes.log().len(), 3);
    }

    #[test]
    fn a_change_to_what_was_is_none() {
        let mut changes = Changes::default();
        changes.add(0, alpha(0.7), alpha(0.7));
        changes.add(1, alpha(0.7), alpha(0.6));
        changes.add(1, alpha(0.6), alpha(0.7));
        assert!(changes.log().is_empty());
        changes.add(2, alpha(0.7), alpha(0.5));
        assert_eq!(changes.log(), [(2, alpha(0.5))]);
    }
}
