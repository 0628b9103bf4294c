//! Passes that keep to a time limit, and that end early when a person asks for it: after the batch under way, as passes of fewer photons.
//!
//! What clocks decide here stands in the changes of the render, so that it can be made again.

use std::num::NonZeroU32;
use std::time::{Duration, Instant};

use foton_integrator::{PassReport, SettingChange};

use crate::interrupt::Interrupt;
use crate::session::{PassError, Session};

/// A pass may go on this long after the limit before it is given up.
const GRACE: Duration = Duration::from_millis(500);

/// The last pass is planned to take this share of what is left.
const MARGIN: f64 = 0.8;

/// A last pass with less than this share of the photons of the one before is not worth its cost a hit point.
const WORTHWHILE: f64 = 0.25;

impl Session {
    /// How long the next pass will take, up to its first batch, by the last one's time and photons; where that is more than is left, it
    /// is given fewer photons.
    pub(crate) fn plan_for(&mut self, limit: Option<Duration>, last: Option<(Duration, u64)>) -> Duration {
        let (Some(limit), Some((took, photons))) = (limit, last) else { return Duration::ZERO };
        let left = limit.saturating_sub(self.elapsed());
        let (next, photons) = (self.render().next_batch() as f64, photons.max(1) as f64);
        let needed = took.mul_f64(next / photons);
        let fitting = MARGIN * next * left.as_secs_f64() / needed.as_secs_f64().max(1e-9);
        if needed <= left || fitting < WORTHWHILE * photons {
            return needed;
        }
        if let Some(fitting) = NonZeroU32::new(fitting as u32) {
            self.render_mut().change(SettingChange::PhotonsOnce(fitting));
        }
        left.mul_f64(MARGIN)
    }

    /// One pass. Where it is interrupted it ends after the batch under way, and at the limit before that; where it has only one, it is
    /// finished. `None` where it is given up since it goes on well beyond the limit. There is always one pass.
    ///
    /// # Errors
    /// As [`Session::advance`].
    pub(crate) fn advance_in_time(
        &mut self,
        limit: Option<Duration>,
        interrupt: &Interrupt,
    ) -> Result<Option<PassReport>, PassError> {
        let (begin, before) = (Instant::now(), self.elapsed());
        let is_beyond = |more: Duration| {
            limit.is_some_and(|limit| before.saturating_add(begin.elapsed()) >= limit.saturating_add(more))
        };
        let has_passes = self.render().passes() > 0;
        let mut is_cut = false;
        loop {
            let should_suspend = || {
                (!is_cut && (interrupt.is_requested() || is_beyond(Duration::ZERO)))
                    || (has_passes && is_beyond(GRACE))
            };
            match self.advance_unless(&should_suspend, interrupt.cancel()) {
                Err(PassError::Suspended(_)) => {}
                other => return other.map(Some),
            }
            if has_passes && is_beyond(GRACE) {
                if self.render_mut().discard_pass() {
                    return Ok(None);
                }
                return self.advance(interrupt.cancel()).map(Some);
            }
            is_cut = true;
            self.render_mut().cut_pass(!interrupt.is_requested());
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use foton_integrator::{PpmSettings, RenderSettings};
    use foton_math::Rgb;

    use super::*;
    use crate::session::StopCause;
    use crate::stop::StopRule;
    use crate::test_scene::discs;

    /// Three batches.
    const PHOTONS: u32 = 2_200_000;

    fn session(photons: u32, interrupt: &Interrupt) -> Session {
        let photons = NonZeroU32::new(photons).expect("above 0");
        let settings = RenderSettings {
            ppm: PpmSettings { photons_per_pass: photons, first_pass: photons, ..PpmSettings::default() },
            ..RenderSettings::default()
        };
        let scene = Arc::new(discs(Some(Rgb::splat(1.0))));
        Session::start(scene, settings, None, interrupt.cancel()).expect("starts")
    }

    fn run(rule: &StopRule, interrupt: &Interrupt) -> (Session, StopCause) {
        let mut session = session(PHOTONS, interrupt);
        let cause = session.run(rule, interrupt, &mut |_| ());
        (session, cause)
    }

    #[test]
    fn an_interrupt_and_a_limit_end_a_pass_after_a_batch_and_say_so() {
        let interrupt = Interrupt::default();
        interrupt.request();
        let (interrupted, cause) = run(&StopRule::default(), &interrupt);
        assert_eq!(cause, StopCause::Interrupted);
        let (late, cause) = run(&StopRule::time(Duration::ZERO), &Interrupt::default());
        assert_eq!(cause, StopCause::Rule);
        for session in [&interrupted, &late] {
            let render = session.render();
            assert_eq!((render.passes(), render.photons_emitted()), (1, u64::from(PHOTONS).div_ceil(3)));
            let cut = SettingChange::CutPass(NonZeroU32::MIN);
            assert_eq!(render.changes(), [(0, cut)]);
            assert!(render.ledger().imbalance().abs() < 1e-6);
        }
        // The log is enough to make it again.
        let mut again = session(PHOTONS, &Interrupt::default());
        again.render_mut().change(interrupted.render().changes()[0].1);
        again.run(&StopRule::passes(1), &Interrupt::default(), &mut |_| ());
        assert!(again.render().save() == interrupted.render().save());
        assert!(late.render().save() == interrupted.render().save());
    }

    #[test]
    fn a_pass_that_would_end_late_gets_photons_that_fit_unless_they_are_few() {
        let s = Duration::from_secs;
        let mut session = session(100_000, &Interrupt::default());
        let last = Some((s(10), 50_000));
        // Nothing has been rendered yet but hit points: all of the limit is left, to a moment.
        let planned = |session: &mut Session, limit| session.plan_for(Some(s(limit)), last).as_secs_f64();
        assert!((planned(&mut session, 1000) - 20.0).abs() < 0.1);
        assert_eq!(session.render().next_batch(), 100_000);
        assert!((planned(&mut session, 1) - 20.0).abs() < 0.1, "too few are worth nothing");
        assert_eq!(session.render().next_batch(), 100_000);
        assert!((planned(&mut session, 15) - 12.0).abs() < 0.5);
        let fitting = session.render().next_batch() as f64;
        assert!((fitting / 60_000.0 - 1.0).abs() < 0.05, "{fitting}");
        assert_eq!(session.plan_for(None, last), Duration::ZERO, "no limit");
        assert_eq!(session.plan_for(Some(s(1)), None), Duration::ZERO, "no pass to go by");
    }
}
