//! Renders a ball of each material preset, or of those that are named, to `crates/foton-preview/presets/NAME.png`, for the window to
//! show.
//!
//! Passes, photons and seed are fixed and results do not depend on threads, so that the same program writes the same files.

#![allow(clippy::print_stdout, reason = "it says what it wrote")]

use std::error::Error;
use std::num::NonZeroU32;
use std::path::Path;

use foton_edit::presets;
use foton_film::{Metadata, ToneMap, write_png};
use foton_integrator::{PpmSettings, RenderSettings};
use foton_math::Rgb;
use foton_math::glam::{DAffine2, DVec2, DVec3};
use foton_scene::description::{
    Bsdf, Colour, Diffuse, EmitterDescription, EmitterKind, Texture, TextureKind,
};
use foton_tests::{Sketch, grey};

/// Width and height of a picture in pixels.
const SIDE: u32 = 64;

/// The exposure.
const STOPS: f32 = -0.2;

/// Passes of each.
const PASSES: u32 = 64;

/// Eye samples a pixel.
const SAMPLES: u32 = 36;

/// Bytes of a picture at most: all of them are in the program.
const MAX_BYTES: u64 = 10_000;

/// A ball on a chequered floor before a wall, with a lamp at its left and a window at its right.
fn ball(material: Bsdf) -> Sketch {
    let lamp = Some(Rgb::splat(11.0));
    let window = Some(Rgb::new(2.4, 2.6, 2.8));
    let checks = Bsdf::Diffuse(Diffuse { reflectance: Colour::Texture(0) });
    let mut sketch = Sketch::default()
        .camera(DVec3::new(0.0, 2.6, 6.4), DVec3::new(0.0, 0.92, 0.0), 26.0, SIDE)
        .rectangle(DVec3::ZERO, DVec3::X * 9.0, DVec3::NEG_Z * 9.0, checks, None)
        .rectangle(DVec3::new(0.0, 4.0, -4.0), DVec3::X * 9.0, DVec3::Y * 4.0, grey(0.6), None)
        .rectangle(
            DVec3::new(-2.5, 5.5, 1.5),
            DVec3::new(1.0, 0.5, 0.0),
            DVec3::new(0.0, -0.2, 1.0),
            grey(0.0),
            lamp,
        )
        .rectangle(DVec3::new(4.6, 3.0, 3.5), DVec3::new(-0.9, 0.0, 1.0), DVec3::Y * 1.8, grey(0.0), window)
        .sphere(DVec3::Y, 1.0, material, None);
    let colours = [Rgb::splat(0.8), Rgb::splat(0.35)];
    sketch.0.textures.push(Texture {
        name: "checks".into(),
        to_uv: DAffine2::from_scale(DVec2::splat(9.0)),
        kind: TextureKind::Checkerboard { colours: colours.map(Colour::from) },
    });
    let sky = EmitterKind::Constant { radiance: Rgb::splat(0.25) };
    sketch.0.emitters.push(EmitterDescription { name: "sky".into(), kind: sky });
    sketch
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../crates/foton-preview/presets");
    std::fs::create_dir_all(&folder)?;
    let count = |n| NonZeroU32::new(n).ok_or("not zero");
    let settings = RenderSettings {
        ppm: PpmSettings { photons_per_pass: count(1 << 17)?, ..PpmSettings::default() },
        ..RenderSettings::default()
    };
    let wanted: Vec<String> = std::env::args().skip(1).collect();
    let is_wanted = |name: &str| wanted.is_empty() || wanted.iter().any(|w| w == name);
    for preset in presets().into_iter().filter(|preset| is_wanted(preset.name)) {
        let material = preset.material("ball").front;
        // Rough glass is followed in directions chosen once, whose noise passes do not lower.
        let is_rough_glass = material.transmits() && material.roughness().is_some();
        let samples = if is_rough_glass { count(16 * SAMPLES)? } else { count(SAMPLES)? };
        let settings = RenderSettings { samples_per_pixel: samples, ..settings.clone() };
        let render = ball(material).render(settings, if is_rough_glass { PASSES / 4 } else { PASSES });
        let path = folder.join(preset.name).with_extension("png");
        write_png(&path, &render.image(), ToneMap::default(), STOPS, &Metadata::default())?;
        let bytes = std::fs::metadata(&path)?.len();
        println!("{} ({bytes} bytes)", path.display());
        if bytes > MAX_BYTES {
            return Err(format!("{} has {bytes} bytes, of {MAX_BYTES} at most", path.display()).into());
        }
    }
    Ok(())
}
