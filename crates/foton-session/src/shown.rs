//! What of a render an image shows: all its light, some kinds of it, or its photons.

use foton_film::Image;
use foton_integrator::{LayerKind, PathClass, Render};
use foton_math::Rgb;
use foton_math::glam::Vec2;

use crate::dots::{dots, pixel_in};

/// What of a render an image shows.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Shown {
    /// All light.
    #[default]
    All,
    /// The sum of some kinds of light.
    Light(Vec<LayerKind>),
    /// The photons of the last pass, up to 20,000 of them, as dots on black.
    Photons,
}

impl Shown {
    /// Kinds of light that an image can show alone.
    pub const KINDS: [LayerKind; 4] =
        [LayerKind::Direct, LayerKind::Caustic, LayerKind::Indirect, LayerKind::Emission];

    /// The image of a render as it stands; all light where what is asked for is not kept apart.
    #[must_use]
    pub fn image(&self, render: &Render) -> Image {
        match self {
            Self::All => render.image(),
            Self::Light(kinds) => sum(render, kinds),
            Self::Photons => photons(render),
        }
    }

    /// What it is called in the metadata of an image; `None` for all light.
    pub(crate) fn name(&self) -> Option<String> {
        match self {
            Self::All => None,
            Self::Light(kinds) => Some(kinds.iter().map(|k| k.name()).collect::<Vec<_>>().join(",")),
            Self::Photons => Some("photons".to_owned()),
        }
    }
}

/// The sum of some kinds of light.
fn sum(render: &Render, kinds: &[LayerKind]) -> Image {
    let all = render.image();
    let mut sum = Image::black(all.width, all.height);
    for kind in kinds {
        let Some(layer) = render.colour_layer(*kind) else { return all };
        sum.pixels.iter_mut().zip(&layer.pixels).for_each(|(sum, light)| *sum += *light);
    }
    sum
}

/// Linear colours of dots: direct yellow, caustic white, indirect blue.
const fn colour(class: PathClass) -> Rgb {
    match class {
        PathClass::Direct => Rgb::new(0.76, 0.52, 0.05),
        PathClass::Caustic => Rgb::new(0.76, 0.76, 0.76),
        PathClass::Indirect => Rgb::new(0.12, 0.33, 0.76),
    }
}

/// Photons as dots, of two pixels by two where the image is large.
fn photons(render: &Render) -> Image {
    let sensor = &render.scene().sensors()[render.settings().sensor];
    let mut image = Image::black(sensor.width, sensor.height);
    let side = if sensor.width.max(sensor.height) >= 400 { 2 } else { 1 };
    let offsets = (0..side).flat_map(|y| (0..side).map(move |x| Vec2::new(x as f32, y as f32)));
    let offsets: Vec<Vec2> = offsets.collect();
    for dot in dots(render) {
        for offset in &offsets {
            if let Some([x, y]) = pixel_in(&sensor.window(), Vec2::from(dot.film) + *offset) {
                image.pixels[(y * sensor.width + x) as usize] = colour(dot.class);
            }
        }
    }
    image
}
