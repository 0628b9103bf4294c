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
mod tests;
