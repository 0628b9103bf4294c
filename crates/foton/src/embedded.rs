//! The scenes that ship inside the program.

use std::io;
use std::path::Path;

use foton_format::{OpenError, Opened, Options};

/// A scene and the files that it names.
pub(crate) struct Embedded {
    /// Its name in messages and metadata.
    pub(crate) name: &'static str,
    xml: &'static str,
    /// A picture of it, as a PNG.
    #[cfg_attr(not(feature = "window"), allow(dead_code, reason = "the window shows it"))]
    pub(crate) thumbnail: &'static [u8],
    files: &'static [(&'static str, &'static [u8])],
}

/// A scene in `assets`, with the meshes that it names.
macro_rules! scene {
    ($name:literal $(, $mesh:literal)*) => {
        Embedded {
            name: $name,
            xml: include_str!(concat!("../../../assets/", $name, "/scene.xml")),
            thumbnail: include_bytes!(concat!("../../../assets/", $name, "/thumbnail.png")),
            files: &[$((
                concat!("meshes/", $mesh),
                include_bytes!(concat!("../../../assets/", $name, "/meshes/", $mesh)),
            )),*],
        }
    };
}

/// All of them; the first is opened where no other is asked for.
pub(crate) static ALL: [Embedded; 5] = [
    scene!("glass-and-ring", "backdrop.obj", "gem.obj", "goblet.obj", "ring.obj"),
    scene!("pool", "water.obj", "joints.obj", "tiles-dark.obj", "tiles-middle.obj", "tiles-light.obj"),
    scene!("ring", "band.obj"),
    scene!("box-spheres"),
    scene!("cornell-spheres"),
];

impl Embedded {
    /// The scene of that name.
    #[cfg(feature = "window")]
    pub(crate) fn named(name: &str) -> Option<&'static Self> {
        ALL.iter().find(|scene| scene.name == name)
    }

    /// Opens it.
    pub(crate) fn open(&self, options: &Options) -> Result<Opened, OpenError> {
        let file = |path: &Path| {
            let found = self.files.iter().find(|(name, _)| Path::new(name) == path);
            found.map(|(_, bytes)| bytes.to_vec()).ok_or_else(|| io::ErrorKind::NotFound.into())
        };
        foton_format::read_str(self.name, self.xml, &file, options)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_embedded_scenes_open_without_a_warning() {
        for scene in &ALL {
            let opened = scene.open(&Options::default()).expect("opens");
            assert_eq!(opened.warnings, [], "{}", scene.name);
        }
    }
}
