//! A view as the bytes that the shader reads.

use foton_film::ToneMap;

use super::{Mode, View};

/// The size of `View` in `shaders/present.wgsl`, in words.
const WORDS: usize = 20;

/// The size of it in bytes.
pub(super) const BYTES: u64 = 4 * WORDS as u64;

/// What the shader's `View` holds for `view`; `extents` are those of the picture and of the pinned one, if there is one.
pub(super) fn pack(view: &View, extents: [Option<[f32; 2]>; 2]) -> [u32; WORDS] {
    let [picture, pinned] = extents.map(Option::unwrap_or_default);
    let [red, green, blue, _] = view.background.to_normalized_gamma_f32();
    // So that the shader never divides by zero.
    let size = view.image_rect.size().max(egui::Vec2::splat(1e-3));
    let (low, high, mode) = match view.mode {
        Mode::Radiance => (0.0, 1.0, 0),
        Mode::FalseColour { low, high, logarithmic: false } => (low, above(low, high), 1),
        Mode::FalseColour { low, high, logarithmic: true } => {
            let [low, high] = [low, high].map(|v| v.max(f32::MIN_POSITIVE).log2());
            (low, above(low, high), 2)
        }
    };
    let tone_map = match view.tone_map {
        ToneMap::Linear => 0,
        ToneMap::PbrNeutral => 1,
        ToneMap::AgX => 2,
    };
    // Without a second picture the line is far outside of the narrowest view.
    let wipe = view.wipe.filter(|_| extents[1].is_some()).unwrap_or(1e6);
    let min = view.image_rect.min;
    let exposure = view.exposure_stops.clamp(-60.0, 60.0).exp2();
    let floats = |values: [f32; 4]| values.map(f32::to_bits);
    let rows = [
        floats([min.x, min.y, size.x, size.y]),
        floats([picture[0], picture[1], pinned[0], pinned[1]]),
        floats([red, green, blue, exposure]),
        [low.to_bits(), high.to_bits(), mode, tone_map],
        floats([wipe, 0.0, 0.0, 0.0]),
    ];
    std::array::from_fn(|i| rows[i / 4][i % 4])
}

/// `high`, or what is a little above `low` where it is not.
fn above(low: f32, high: f32) -> f32 {
    if high > low { high } else { low + low.abs().max(f32::MIN_POSITIVE) * 1e-5 }
}
