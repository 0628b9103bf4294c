//! Renders from before an edit: undoing the edit brings them back as they were, in the middle of a pass if that is where they were
//! left.

use std::collections::VecDeque;

use super::command::Configuration;
use super::editable_scene::SceneState;
use super::render::LevelRender;

/// Bytes that all of them take at most.
const MAX_BYTES: f64 = 2.0 * 1024.0 * 1024.0 * 1024.0;

/// What a render is of.
#[derive(Clone, PartialEq)]
pub(super) struct Subject {
    pub(super) scene: SceneState,
    pub(super) configuration: Configuration,
}

/// Renders by what they are of, oldest first.
#[derive(Default)]
pub(super) struct Kept(VecDeque<(Subject, LevelRender)>);

impl Kept {
    /// Keeps a render, where `room` bytes are left for all of them. Returns how many had to go for that, this one included if it has no room
    /// itself.
    pub(super) fn put(&mut self, subject: Subject, render: LevelRender, room: Option<f64>) -> usize {
        self.0.retain(|(other, _)| *other != subject);
        self.0.push_back((subject, render));
        let room = room.map_or(MAX_BYTES, |room| room.min(MAX_BYTES));
        let mut gone = 0;
        while self.bytes() > room && self.0.pop_front().is_some() {
            gone += 1;
        }
        gone
    }

    /// The render of a subject, if there is one.
    pub(super) fn take(&mut self, subject: &Subject) -> Option<LevelRender> {
        let at = self.0.iter().position(|(other, _)| other == subject)?;
        self.0.remove(at).map(|(_, render)| render)
    }

    /// Forgets all of them.
    pub(super) fn clear(&mut self) {
        self.0.clear();
    }

    /// Bytes that all of them take.
    pub(super) fn bytes(&self) -> f64 {
        self.0.iter().map(|(_, render)| render.render().bytes() as f64).sum()
    }
}
