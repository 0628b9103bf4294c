//! When the next frame is due: at once on input, on news as often as drawing is cheap. Knows no clock, so that tests need none.

use std::time::{Duration, Instant};

/// Between frames that only new passes ask for, where drawing takes the cores that render.
const SOFTWARE_GAP: Duration = Duration::from_millis(330);

/// The same while a person acts, and between frames that only egui asks for: a frame that shows nothing new to the person would
/// hold up the render of one that does.
const SOFTWARE_ATTENTIVE_GAP: Duration = Duration::from_millis(120);

/// The same where a graphics card draws.
const HARDWARE_GAP: Duration = Duration::from_millis(33);

/// For so long after an input a person is taken to be waiting for the picture.
const ATTENTION: Duration = Duration::from_millis(500);

/// So long a frame waits for the picture of a move, where drawing would take the cores that make it.
const PATIENCE: Duration = Duration::from_millis(70);

pub(super) struct Pace {
    /// Whether drawing takes the cores that render.
    pub(super) is_software: bool,
    due: Option<Instant>,
    drawn: Instant,
    last_input: Option<Instant>,
    /// Whether the last frame was left to the picture that follows.
    waited: bool,
}

impl Pace {
    pub(super) const fn new(now: Instant) -> Self {
        Self { is_software: false, due: None, drawn: now, last_input: None, waited: false }
    }

    /// When the next frame is due; `None`: when something happens.
    pub(super) const fn due(&self) -> Option<Instant> {
        self.due
    }

    /// What was due is being drawn, or is for nobody to see.
    pub(super) const fn begin(&mut self) {
        self.due = None;
    }

    pub(super) fn draw_at(&mut self, when: Instant) {
        self.due = Some(self.due.map_or(when, |due| due.min(when)));
    }

    /// A person acts.
    pub(super) const fn input(&mut self, now: Instant) {
        self.last_input = Some(now);
    }

    /// The engine has a frame; news if it is more than another pass.
    pub(super) fn hear(&mut self, now: Instant, is_news: bool) {
        if self.waited && !is_news {
            return;
        }
        let attentive = self.last_input.is_some_and(|at| now.saturating_duration_since(at) < ATTENTION);
        let gap = match (self.is_software, is_news, attentive) {
            (false, ..) | (_, true, _) => HARDWARE_GAP,
            (true, false, true) => SOFTWARE_ATTENTIVE_GAP,
            (true, false, false) => SOFTWARE_GAP,
        };
        self.draw_at(self.drawn + gap);
    }

    /// egui wants to be drawn again after a while.
    pub(super) fn repaint(&mut self, now: Instant, delay: Duration) {
        let Some(when) = now.checked_add(delay) else { return };
        let soonest = self.drawn + SOFTWARE_ATTENTIVE_GAP;
        self.draw_at(if self.is_software { when.max(soonest) } else { when });
    }

    /// Whether a frame may be left out for the picture that follows. Not twice in a row: a hand that never rests would see nothing.
    pub(super) const fn may_wait(&self) -> bool {
        self.is_software && !self.waited
    }

    /// A frame that began `then` was left out. One that another pass had asked for would show as little, and is put off too.
    pub(super) fn wait(&mut self, then: Instant) {
        self.waited = true;
        self.due = Some(then + PATIENCE);
    }

    /// A frame is on the screen.
    pub(super) const fn drawn(&mut self, now: Instant) {
        self.waited = false;
        self.drawn = now;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const fn ms(n: u64) -> Duration {
        Duration::from_millis(n)
    }

    /// Something drew at `start`, and nothing has happened since.
    fn pace(start: Instant, is_software: bool) -> Pace {
        Pace { is_software, ..Pace::new(start) }
    }

    #[test]
    fn in_software_a_frame_that_answers_a_move_waits_for_its_picture_but_not_for_ever() {
        let start = Instant::now();
        let mut pace = pace(start, true);
        assert!(pace.may_wait());
        pace.begin();
        pace.wait(start + ms(500));
        assert_eq!(pace.due(), Some(start + ms(570)), "without a picture");
        pace.hear(start + ms(530), true);
        assert!(pace.due().is_some_and(|due| due <= start + ms(530)), "the picture is shown at once");
        assert!(!pace.may_wait(), "a hand that never rests sees something");
        pace.drawn(start + ms(540));
        assert!(pace.may_wait());
    }

    #[test]
    fn what_the_passes_before_a_move_asked_for_does_not_cut_the_wait_short() {
        let start = Instant::now();
        let mut pace = pace(start, true);
        pace.input(start);
        pace.hear(start + ms(10), false);
        assert_eq!(pace.due(), Some(start + SOFTWARE_ATTENTIVE_GAP));
        pace.wait(start + ms(100));
        assert_eq!(pace.due(), Some(start + ms(170)), "another pass had asked before");
        pace.hear(start + ms(110), false);
        assert_eq!(pace.due(), Some(start + ms(170)), "another pass asks now");
    }

    #[test]
    fn where_a_graphics_card_draws_no_frame_waits() {
        assert!(!pace(Instant::now(), false).may_wait());
    }

    #[test]
    fn in_software_passes_are_drawn_seldom_and_more_often_while_a_person_acts() {
        let start = Instant::now();
        let due = |is_software, input, is_news| {
            let mut pace = pace(start, is_software);
            if input {
                pace.input(start);
            }
            pace.hear(start + ms(10), is_news);
            pace.due().expect("due") - start
        };
        assert_eq!(due(true, false, false), SOFTWARE_GAP);
        assert_eq!(due(true, true, false), SOFTWARE_ATTENTIVE_GAP);
        assert_eq!(due(true, false, true), HARDWARE_GAP);
        assert_eq!(due(false, false, false), HARDWARE_GAP);
    }

    #[test]
    fn attention_fades() {
        let start = Instant::now();
        let mut pace = pace(start, true);
        pace.input(start);
        pace.hear(start + ATTENTION, false);
        assert_eq!(pace.due(), Some(start + SOFTWARE_GAP));
    }

    #[test]
    fn the_soonest_of_what_is_due_counts_and_nothing_is_due_after_it() {
        let start = Instant::now();
        let mut pace = pace(start, true);
        pace.repaint(start, Duration::MAX);
        assert_eq!(pace.due(), None, "never");
        pace.repaint(start, Duration::ZERO);
        assert_eq!(pace.due(), Some(start + SOFTWARE_ATTENTIVE_GAP), "egui alone is in no hurry");
        pace.draw_at(start + ms(5));
        pace.draw_at(start + ms(50));
        assert_eq!(pace.due(), Some(start + ms(5)));
        pace.begin();
        assert_eq!(pace.due(), None);
    }
}
