//! `cargo xtask pictures`: renders every scene in `assets/` to `docs/pictures/NAME.png`, and the window, for the documents to show.
//!
//! Passes, photons and seed are fixed and results do not depend on threads, so that the same program writes the same files.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::program;
use crate::tools::{self, Trouble};

/// How one scene is rendered for its picture.
struct Picture {
    /// The scene's folder in `assets/`, and the picture's name.
    scene: &'static str,
    /// WIDTHxHEIGHT in pixels.
    size: &'static str,
    passes: u32,
    /// Eye samples a pixel: more where gloss is seen, whose noise passes do not lower.
    samples: u32,
    /// The size of its picture in the window's gallery, and eye samples a pixel of that, if it is there.
    thumbnail: Option<(&'static str, u32)>,
}

const PICTURES: &[Picture] = &[
    Picture { scene: "pool", size: "480x320", passes: 64, samples: 4, thumbnail: Some(("144x96", 16)) },
    Picture { scene: "ring", size: "480x320", passes: 48, samples: 16, thumbnail: Some(("144x96", 32)) },
    Picture {
        scene: "cornell-spheres",
        size: "480x480",
        passes: 32,
        samples: 4,
        thumbnail: Some(("96x96", 16)),
    },
    Picture { scene: "cornell-water", size: "480x480", passes: 64, samples: 4, thumbnail: None },
    Picture { scene: "cornell-diffuse", size: "480x480", passes: 24, samples: 4, thumbnail: None },
    Picture { scene: "box-spheres", size: "480x480", passes: 32, samples: 4, thumbnail: Some(("96x96", 16)) },
    Picture { scene: "museum", size: "480x360", passes: 48, samples: 4, thumbnail: None },
    Picture { scene: "furnace", size: "128x128", passes: 8, samples: 1, thumbnail: None },
    Picture {
        scene: "glass-and-ring",
        size: "960x640",
        passes: 64,
        samples: 4,
        thumbnail: Some(("144x96", 32)),
    },
];

/// Renders all pictures with the release build, made once. Takes minutes.
///
/// # Errors
/// What could not be built, rendered or written, or a scene that has no picture here.
pub(crate) fn render_all() -> Result<(), Trouble> {
    let forgotten = without_picture(&tools::root().join("assets")).map_err(Trouble::Failed)?;
    if !forgotten.is_empty() {
        return Err(Trouble::Failed(format!("no picture is planned for {}", forgotten.join(", "))));
    }
    let (foton, folder) = prepare()?;
    PICTURES.iter().try_for_each(|picture| picture.render(&foton))?;
    program::pictures(&foton, &folder)
}

/// Pictures of the window alone.
///
/// # Errors
/// What could not be built, opened or written.
pub(crate) fn of_window() -> Result<(), Trouble> {
    let (foton, folder) = prepare()?;
    program::pictures(&foton, &folder)
}

/// The program, built, and the folder for its pictures, made.
pub(crate) fn prepare() -> Result<(PathBuf, PathBuf), Trouble> {
    let folder = tools::root().join("docs/pictures");
    fs::create_dir_all(&folder).map_err(|cause| Trouble::Failed(format!("{}: {cause}", folder.display())))?;
    tools::run(&mut tools::cargo(&["build", "--release", "--package", "foton"]))?;
    Ok((program::foton("release"), folder))
}

impl Picture {
    fn render(&self, foton: &Path) -> Result<(), Trouble> {
        let scene = format!("assets/{}/scene.xml", self.scene);
        let output = format!("docs/pictures/{}.png", self.scene);
        let (passes, samples) = (self.passes.to_string(), self.samples.to_string());
        let render = |output: &str, size: &str, samples: &str| {
            println!("{output}: {size} at {passes} passes");
            tools::run(
                Command::new(foton)
                    .args(["render", &scene, "-o", output, "--direct", "shadow-rays"])
                    .args(["--size", size, "--passes", &passes, "--spp", samples]),
            )
        };
        if let Some((size, samples)) = self.thumbnail {
            render(&format!("assets/{}/thumbnail.png", self.scene), size, &samples.to_string())?;
        }
        render(&output, self.size, &samples)
    }
}

/// The scenes in a folder that [`PICTURES`] does not name.
fn without_picture(assets: &Path) -> Result<Vec<String>, String> {
    let trouble = |cause| format!("{}: {cause}", assets.display());
    let mut scenes = BTreeSet::new();
    for entry in fs::read_dir(assets).map_err(trouble)? {
        let path = entry.map_err(trouble)?.path();
        if path.join("scene.xml").is_file() {
            scenes.extend(path.file_name().map(|name| name.to_string_lossy().into_owned()));
        }
    }
    for picture in PICTURES {
        scenes.remove(picture.scene);
    }
    Ok(scenes.into_iter().collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_scene_has_a_picture_and_every_picture_a_scene() {
        let assets = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets");
        assert_eq!(without_picture(&assets), Ok(Vec::new()));
        for picture in PICTURES {
            assert!(assets.join(picture.scene).join("scene.xml").is_file(), "{}", picture.scene);
        }
    }
}
