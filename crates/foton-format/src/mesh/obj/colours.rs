//! Colours that stand behind positions, `v x y z r g b`, as sculpting and scanning programs write them: sRGB, from 0 to 1 or to 255.

use crate::mesh::words::{Words, parsed};
use crate::mitsuba::read::values::srgb_to_linear;

/// The colours of the positions so far.
#[derive(Default)]
pub(super) struct Colours {
    /// As they stand there; [`NONE`] where a position has none. Nothing before the first one.
    values: Vec<[f32; 3]>,
}

impl Colours {
    /// Notes what stands behind the position of that number.
    pub(super) fn note(&mut self, position: usize, words: &mut Words<'_>, positions: usize) {
        let Some(first) = words.next() else { return };
        let rest = [words.next(), words.next()];
        // One number alone is a weight of the position.
        let [Some(second), Some(third)] = rest else { return };
        let numbers = [first, second, third].map(|word| parsed(word.text).filter(|x| x.is_finite()));
        let [Some(r), Some(g), Some(b)] = numbers else { return };
        if self.values.is_empty() {
            self.values.reserve_exact(positions);
        }
        self.values.resize(position, NONE);
        self.values.push([r, g, b].map(|x| x as f32));
    }

    /// Linear colours of that many positions, or none at all.
    pub(super) fn finish(mut self, positions: usize) -> Vec<[f32; 3]> {
        if self.values.is_empty() {
            return self.values;
        }
        let is_of_bytes = self.values.iter().flatten().any(|x| *x > 1.0);
        let most = if is_of_bytes { 255.0 } else { 1.0 };
        self.values.resize(positions, NONE);
        for value in self.values.iter_mut().flatten() {
            let share = if value.is_nan() { 1.0 } else { (*value / most).clamp(0.0, 1.0) };
            *value = srgb_to_linear(f64::from(share)) as f32;
        }
        self.values
    }
}

/// No colour: it becomes white.
const NONE: [f32; 3] = [f32::NAN; 3];
