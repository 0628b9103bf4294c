//! What a render models, and what it will take.

use foton_scene::Scene;

use super::block::Block;
use super::sample::Seen;
use super::sums::PixelSums;
use crate::error::Independent;
use crate::feature::Feature;
use crate::memory::MemoryEstimate;
use crate::settings::{Method, RenderSettings};

/// Parts that can be left out, with whether they are.
pub(crate) fn features(settings: &RenderSettings) -> Vec<Feature> {
    vec![
        Feature::new(
            "light by path class",
            settings.layers,
            ["asked for by --layers", "no layer asks for it"],
            "sums of direct, caustic and indirect light beside those of all",
        )
        .with_bytes(0, PixelSums::BYTES_BY_CLASS),
        Feature::new(
            "live error",
            settings.error,
            ["the error is asked for", "the error is not asked for"],
            "squares of each pass",
        )
        .with_bytes(0, Independent::BYTES_PER_PIXEL),
    ]
}

/// Memory of a render.
pub(crate) fn memory(scene: &Scene, settings: &RenderSettings) -> MemoryEstimate {
    let sensor = &scene.sensors()[settings.sensor];
    let pixels = f64::from(sensor.width) * f64::from(sensor.height);
    let per_pixel = PixelSums::BYTES_PER_PIXEL
        + if settings.layers { PixelSums::BYTES_BY_CLASS } else { 0 }
        + if settings.error { Independent::BYTES_PER_PIXEL } else { 0 }
        // A pass is added to the image once all of it is there.
        + 2 * size_of::<Seen>()
        + size_of::<Block>() / super::block::BLOCK;
    MemoryEstimate {
        hit_points: 0.0,
        pixels,
        scene_bytes: scene.bytes() as f64,
        hit_point_bytes: 0.0,
        pixel_bytes: pixels * per_pixel as f64,
        photon_bytes: match settings.method {
            Method::PhotonMap => settings.photon_map.bytes(),
            _ => 0.0,
        },
        layout_bytes: 0.0,
    }
}
