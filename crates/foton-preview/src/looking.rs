//! What is looked at, and how: what is drawn over the picture, what it is compared with, and pictures in strips and menus.

use std::path::PathBuf;

use crate::difference::Difference;
use crate::light_scale::LightScale;

/// How two pictures are compared.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Compare {
    /// One beside the other, with a line between them that can be dragged.
    #[default]
    Wipe,
    /// How far they are apart.
    Difference,
}

/// A region that is being dragged out.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Choosing {
    /// Where the drag began, in pixels of the image.
    pub(crate) from: Option<[f64; 2]>,
    pub(crate) to: [f64; 2],
}

/// A scene that ships with the program.
#[derive(Clone, Debug)]
pub struct BuiltIn {
    /// Its name.
    pub name: String,
    /// A picture of it, as a PNG.
    pub thumbnail: &'static [u8],
}

/// A picture of a scene in a menu.
pub(crate) struct ScenePicture {
    /// What it is of.
    pub(crate) key: PathBuf,
    /// When its file was written, if it has one.
    pub(crate) written: Option<std::time::SystemTime>,
    /// `None` where it cannot be read.
    pub(crate) texture: Option<egui::TextureHandle>,
}

/// All of it.
pub(crate) struct Looking {
    pub(crate) show_histogram: bool,
    /// How bright the last picture is.
    pub(crate) light_scale: Option<LightScale>,
    /// What the wheel has turned of a tenth of a stop.
    pub(crate) turned: f32,
    /// Whether pixels are marked that are black or as bright as they get.
    pub(crate) marks_clipping: bool,
    /// The region that is being dragged out.
    pub(crate) choosing_region: Option<Choosing>,
    pub(crate) compare: Compare,
    /// The difference that was shown last.
    pub(crate) difference: Option<Difference>,
    pub(crate) show_history: bool,
    /// Pictures of the history, by their numbers.
    pub(crate) thumbnails: Vec<(u64, egui::TextureHandle)>,
    /// Steps of a turntable, and passes of each.
    pub(crate) turntable: [u64; 2],
    /// Pictures of scenes in menus.
    pub(crate) scene_pictures: Vec<ScenePicture>,
    /// When the first hint was drawn, in seconds of the window's clock.
    pub(crate) hinted: Option<f64>,
}

impl Default for Looking {
    fn default() -> Self {
        Self {
            show_histogram: false,
            light_scale: None,
            turned: 0.0,
            marks_clipping: false,
            choosing_region: None,
            compare: Compare::Wipe,
            difference: None,
            show_history: false,
            thumbnails: Vec::new(),
            turntable: [24, 16],
            scene_pictures: Vec::new(),
            hinted: None,
        }
    }
}
