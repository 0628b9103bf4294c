//! The scene that ships inside the program.

use std::io;
use std::path::Path;

use foton_format::{OpenError, Opened, Options};

/// Its name in messages and metadata.
pub(crate) const NAME: &str = "glass-and-ring";

const XML: &str = include_str!("../../../assets/glass-and-ring/scene.xml");

const MESHES: [(&str, &[u8]); 4] = [
    ("meshes/backdrop.obj", include_bytes!("../../../assets/glass-and-ring/meshes/backdrop.obj")),
    ("meshes/gem.obj", include_bytes!("../../../assets/glass-and-ring/meshes/gem.obj")),
    ("meshes/goblet.obj", include_bytes!("../../../assets/glass-and-ring/meshes/goblet.obj")),
    ("meshes/ring.obj", include_bytes!("../../../assets/glass-and-ring/meshes/ring.obj")),
];

/// Opens it.
pub(crate) fn open(options: &Options) -> Result<Opened, OpenError> {
    let mesh = |path: &Path| {
        let found = MESHES.iter().find(|(name, _)| Path::new(name) == path);
        found.map(|(_, bytes)| bytes.to_vec()).ok_or_else(|| io::ErrorKind::NotFound.into())
    };
    foton_format::read_str(NAME, XML, &mesh, options)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_embedded_scene_opens_without_a_warning() {
        let opened = open(&Options::default()).expect("opens");
        assert_eq!(opened.warnings, []);
    }
}
