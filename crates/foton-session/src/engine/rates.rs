//! How many photons and rays a second a render makes of late.

use std::time::Duration;

use crate::session::Session;

/// Rates are those of the passes of about this long.
const SPAN: Duration = Duration::from_secs(2);

/// How far a render was at some time.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Mark {
    elapsed: Duration,
    photons: u64,
    rays: u64,
}

impl Mark {
    pub(super) fn of(session: &Session) -> Self {
        Self { elapsed: session.elapsed(), photons: session.render().photons_emitted(), rays: session.rays() }
    }
}

/// What a render makes a second.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct PerSecond {
    pub(super) photons: f64,
    pub(super) rays: f64,
}

/// Marks of the last passes, oldest first; never none.
pub(super) struct Rates(Vec<Mark>);

impl Rates {
    pub(super) fn since(start: Mark) -> Self {
        Self(vec![start])
    }

    /// Adds the state after a pass.
    pub(super) fn add(&mut self, mark: Mark) {
        self.0.push(mark);
        let old = self.0.partition_point(|m| m.elapsed.saturating_add(SPAN) < mark.elapsed);
        // One from before the span stays, for passes may take longer.
        self.0.drain(..old.saturating_sub(1));
    }

    /// Zero until time has passed.
    pub(super) fn per_second(&self) -> PerSecond {
        let (Some(first), Some(last)) = (self.0.first(), self.0.last()) else { return PerSecond::default() };
        // Nothing here relies on clocks that go forwards: a checkpoint brings its own time.
        let seconds = last.elapsed.saturating_sub(first.elapsed).as_secs_f64();
        let rate = |n: u64| if seconds > 0.0 { n as f64 / seconds } else { 0.0 };
        PerSecond {
            photons: rate(last.photons.saturating_sub(first.photons)),
            rays: rate(last.rays.saturating_sub(first.rays)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mark(seconds: f64, photons: u64) -> Mark {
        Mark { elapsed: Duration::from_secs_f64(seconds), photons, rays: 3 * photons }
    }

    #[test]
    fn rates_are_those_of_the_last_two_seconds() {
        let mut rates = Rates::since(mark(1.0, 0));
        assert_eq!(rates.per_second(), PerSecond::default());
        for (seconds, photons) in [(2.0, 100), (3.0, 200), (4.5, 500), (5.0, 600)] {
            rates.add(mark(seconds, photons));
        }
        // From the mark at two seconds on: the last one that is older than the span.
        assert_eq!(rates.per_second(), PerSecond { photons: 500.0 / 3.0, rays: 500.0 });
    }

    /// A checkpoint may have taken less time, or fewer photons, than the render that resumes it has by then.
    #[test]
    fn clocks_that_go_backwards_give_no_rate_rather_than_a_panic() {
        let mut rates = Rates::since(mark(5.0, 1000));
        rates.add(mark(1.0, 10));
        assert_eq!(rates.per_second(), PerSecond::default());
        rates.add(Mark { elapsed: Duration::MAX, photons: u64::MAX, rays: u64::MAX });
        assert!(rates.per_second().photons.is_finite());
        rates.add(mark(2.0, 20));
        assert!(rates.per_second().photons >= 0.0);
    }
}
