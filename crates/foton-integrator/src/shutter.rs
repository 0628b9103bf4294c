//! When each pass sees a scene that moves.

use std::sync::Arc;

use foton_math::{Cancel, Cancelled, Purpose, Stream};
use foton_scene::Scene;

use crate::settings::RenderSettings;

/// The scene as the pass after `before` others sees it; itself where nothing moves.
///
/// # Errors
/// When cancelled.
pub(crate) fn at_pass(
    scene: &Arc<Scene>,
    settings: &RenderSettings,
    before: u64,
    cancel: &Cancel,
) -> Result<Arc<Scene>, Cancelled> {
    scene.after_share_of_shutter(settings.sensor, share_of_shutter(settings.seed, before), cancel)
}

/// The share of a shutter's time after which the pass after `before` others sees everything. Passes take turns with two sequences that are
/// independent of each other, as their eye samples do; of each 2^k passes of a sequence one is in each of 2^k equal parts of the time.
fn share_of_shutter(seed: u64, before: u64) -> f64 {
    let (sequence, turn) = (before % 2, before / 2);
    let shift = f64::from(Stream::new(seed, Purpose::Shutter, sequence, 0).next_1d());
    let radical_inverse = turn.reverse_bits() as f64 / 2f64.powi(64);
    (radical_inverse + shift).fract()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn passes_of_each_sequence_are_spread_evenly_over_the_shutters_time() {
        for (seed, sequence) in [(0, 0u64), (0, 1), (1, 0), (7, 1)] {
            for (first, passes) in [(0u64, 8u64), (8, 8), (0, 32)] {
                let of_pass = |turn: u64| share_of_shutter(seed, 2 * turn + sequence);
                let mut parts: Vec<usize> =
                    (first..first + passes).map(|turn| (of_pass(turn) * passes as f64) as usize).collect();
                parts.sort_unstable();
                assert!(parts.iter().copied().eq(0..passes as usize), "{parts:?}");
            }
        }
    }
}
