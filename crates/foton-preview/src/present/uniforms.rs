//! A view as the shader takes it: the bytes of its uniform buffer, and what a pipeline is made for.

use foton_film::ToneMap;

use super::{Mode, View};

/// The size of `View` in `shaders/present.wgsl`, in words.
const WORDS: usize = 20;

/// The size of it in bytes.
pub(super) const BYTES: u64 = 4 * WORDS as u64;

/// Texels that a pixel may hold along an axis before their mean is drawn. A little more than one: at scale 1 rounding must not
/// start to blur.
const MAX_TEXEL_COUNT: f32 = 1.001;

/// The extents in texels of the picture and of the pinned one, if there is one.
pub(super) type Extents = [Option<[f32; 2]>; 2];

/// What the shader's `View` holds for `view` in an area that begins at the pixel `origin`.
pub(super) fn pack(view: &View, origin: [u32; 2], extents: Extents) -> [u32; WORDS] {
    let [picture, pinned] = extents.map(Option::unwrap_or_default);
    let [red, green, blue, _] = view.background.to_normalized_gamma_f32();
    // So that the shader never divides by zero.
    let size = view.image_rect.size().max(egui::Vec2::splat(1e-3));
    let (low, high) = match view.mode {
        Mode::Radiance => (0.0, 1.0),
        Mode::FalseColour { low, high, logarithmic: false } => (low, above(low, high)),
        Mode::FalseColour { low, high, logarithmic: true } => {
            let [low, high] = [low, high].map(|v| v.max(f32::MIN_POSITIVE).log2());
            (low, above(low, high))
        }
    };
    let wipe = view.wipe.unwrap_or_default();
    let min = view.image_rect.min;
    let exposure = view.exposure_stops.clamp(-60.0, 60.0).exp2();
    let floats = |values: [f32; 4]| values.map(f32::to_bits);
    let rows = [
        floats([min.x, min.y, size.x, size.y]),
        floats([picture[0], picture[1], pinned[0], pinned[1]]),
        floats([red, green, blue, exposure]),
        floats([low, high, origin[0] as f32, origin[1] as f32]),
        floats([wipe, 0.0, 0.0, 0.0]),
    ];
    std::array::from_fn(|i| rows[i / 4][i % 4])
}

/// What the shader's pipeline is made for: the values of its overrides.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Kind {
    mode: u8,
    tone_map: u8,
    compares: bool,
    shrinks: [bool; 2],
    marks_clipping: bool,
}

impl Kind {
    pub(super) fn of(view: &View, extents: Extents) -> Self {
        let mode = match view.mode {
            Mode::Radiance => 0,
            Mode::FalseColour { logarithmic: false, .. } => 1,
            Mode::FalseColour { logarithmic: true, .. } => 2,
        };
        let tone_map = match view.tone_map {
            // False colours know none.
            _ if mode != 0 => 0,
            ToneMap::Linear => 0,
            ToneMap::PbrNeutral => 1,
            ToneMap::AgX => 2,
        };
        let size = view.image_rect.size();
        let compares = view.wipe.is_some() && extents[1].is_some();
        let shrinks = extents.map(|extent| {
            extent.is_some_and(|[width, height]| {
                width > MAX_TEXEL_COUNT * size.x || height > MAX_TEXEL_COUNT * size.y
            })
        });
        let marks_clipping = view.marks_clipping && mode == 0;
        Self { mode, tone_map, compares, shrinks: [shrinks[0], shrinks[1] && compares], marks_clipping }
    }

    /// By the names of the shader.
    pub(super) fn constants(self) -> [(&'static str, f64); 6] {
        [
            ("MODE", self.mode.into()),
            ("TONE_MAP", self.tone_map.into()),
            ("COMPARES", self.compares.into()),
            ("SHRINKS_A", self.shrinks[0].into()),
            ("SHRINKS_B", self.shrinks[1].into()),
            ("MARKS_CLIPPING", self.marks_clipping.into()),
        ]
    }
}

/// `high`, or what is a little above `low` where it is not.
fn above(low: f32, high: f32) -> f32 {
    if high > low { high } else { low + low.abs().max(f32::MIN_POSITIVE) * 1e-5 }
}
