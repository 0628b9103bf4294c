//! Renders where numbers run out: tiny and huge scenes, lights that differ a hundred millionfold, glass in glass, cameras and
//! lights inside it, and values that are no numbers. What each line expects stands in docs/robustness.md.

mod light;
mod narrow;
mod numbers;
mod optics;
mod strict;
mod surfaces;
mod wide;

use std::num::NonZeroU32;

use foton_film::Image;
use foton_integrator::{Cancel, PpmSettings, RadiusFloor, Render, RenderSettings};

use crate::settings;

/// One sample a pixel, a first radius in world units that shrinks for ever.
fn with_radius(radius: f64, photons: u32) -> RenderSettings {
    RenderSettings {
        ppm: PpmSettings {
            radius: Some(radius),
            radius_floor: RadiusFloor::NONE,
            ..settings(photons, 3).ppm
        },
        ..settings(photons, 3)
    }
}

/// Everything below a bit of an image.
fn bits(image: &Image) -> Vec<[u32; 3]> {
    image.pixels.iter().map(|p| p.to_array().map(f32::to_bits)).collect()
}

fn number(n: u32) -> NonZeroU32 {
    NonZeroU32::new(n).expect("above 0")
}

fn advance(render: &mut Render, passes: u32) {
    for _ in 0..passes {
        render.advance(&mut |_| (), &Cancel::default()).expect("not cancelled");
    }
}
