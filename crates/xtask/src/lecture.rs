//! `cargo xtask lecture`: pictures for a lecture on photon mapping, and `docs/lecture.md`, which shows each with the command that made it.

use std::fmt::Write as _;
use std::fs;
use std::process::Command;

use crate::pictures;
use crate::tools::{self, Trouble};

const PAGE: &str = "docs/lecture.md";

/// Pictures under one heading.
struct Part {
    heading: &'static str,
    text: &'static str,
    pictures: &'static [Picture],
}

/// A picture and how it is made.
struct Picture {
    /// `docs/pictures/lecture-NAME.png`.
    name: &'static str,
    caption: &'static str,
    /// Of `foton render`, without the output.
    arguments: &'static str,
}

const PARTS: &[Part] = &[
    Part {
        heading: "Light by its paths",
        text: "`--show` adds up the kinds of light that are named. Direct light comes straight from emitters, caustics by mirrors and \
               glass alone, indirect light by surfaces that scatter.",
        pictures: &[
            Picture {
                name: "direct",
                caption: "Direct light only",
                arguments: "assets/cornell-spheres/scene.xml --size 320x320 --passes 32 --show direct,emission",
            },
            Picture {
                name: "caustic",
                caption: "Direct light and caustics",
                arguments: "assets/cornell-spheres/scene.xml --size 320x320 --passes 32 --show direct,emission,caustic",
            },
            Picture {
                name: "indirect",
                caption: "Direct light, caustics and indirect light: everything",
                arguments: "assets/cornell-spheres/scene.xml --size 320x320 --passes 32",
            },
            Picture {
                name: "whitted",
                caption: "Without photon mapping: Whitted's ray tracing, which has no caustics and no indirect light",
                arguments: "assets/cornell-spheres/scene.xml --size 320x320 --integrator whitted --passes 32",
            },
        ],
    },
    Part {
        heading: "Photons and radiance estimates",
        text: "Photons lie where light arrives. A radiance estimate divides the power of those in a disc by its area: with few photons \
               each shows as a disc of its own. Here the radius stays the same, so that their number alone makes the difference.",
        pictures: &[
            Picture {
                name: "photons",
                caption: "Photons as dots: direct light yellow, caustics white, indirect light blue",
                arguments: "assets/cornell-spheres/scene.xml --size 320x320 --passes 1 --photons 16384 --direct photons \
                            --guide off --show photons",
            },
            Picture {
                name: "100-photons",
                caption: "100 photons",
                arguments: "assets/cornell-spheres/scene.xml --size 320x320 --passes 1 --photons 100 --direct photons \
                            --guide off --radius 0.15",
            },
            Picture {
                name: "500-photons",
                caption: "500 photons",
                arguments: "assets/cornell-spheres/scene.xml --size 320x320 --passes 1 --photons 500 --direct photons \
                            --guide off --radius 0.15",
            },
            Picture {
                name: "200000-photons",
                caption: "200,000 photons, in passes of 10,000 with α = 1, which keeps the radius",
                arguments: "assets/cornell-spheres/scene.xml --size 320x320 --passes 20 --photons 10000 --direct photons \
                            --guide off --radius 0.15 --alpha 1",
            },
            Picture {
                name: "shrunk",
                caption: "The same photons with α = 2/3: progressive photon mapping shrinks the discs",
                arguments: "assets/cornell-spheres/scene.xml --size 320x320 --passes 20 --photons 10000 --direct photons \
                            --guide off --radius 0.15 --radius-rule local",
            },
        ],
    },
    Part {
        heading: "What photon mapping is for",
        text: "Caustics that are seen through what casts them, which path tracers find late or never.",
        pictures: &[
            Picture {
                name: "water",
                caption: "The Cornell box with water",
                arguments: "assets/cornell-water/scene.xml --size 320x320 --passes 64",
            },
            Picture {
                name: "water-path",
                caption: "The same by path tracing, with 256 samples a pixel",
                arguments: "assets/cornell-water/scene.xml --size 320x320 --integrator path --passes 256",
            },
        ],
    },
    Part {
        heading: "Cameras",
        text: "",
        pictures: &[Picture {
            name: "depth-of-field",
            caption: "Depth of field: a thin lens, focused on the green ball",
            arguments: "tests/scenes/depth-of-field.xml --size 320x240 --passes 32 --spp 64",
        }],
    },
];

impl Picture {
    fn file(&self) -> String {
        format!("pictures/lecture-{}.png", self.name)
    }

    fn command(&self) -> String {
        format!("foton render {} -o {}.png", self.arguments, self.name)
    }
}

/// Renders all pictures with the release build, and writes their page.
///
/// # Errors
/// What could not be built, rendered or written.
pub(crate) fn make() -> Result<(), Trouble> {
    let (foton, _) = pictures::prepare()?;
    for picture in PARTS.iter().flat_map(|part| part.pictures) {
        println!("{}", picture.command());
        let mut command = Command::new(&foton);
        command.arg("render").args(picture.arguments.split_whitespace());
        tools::run(command.arg("-o").arg(format!("docs/{}", picture.file())))?;
    }
    let path = tools::root().join(PAGE);
    fs::write(&path, page()).map_err(|cause| Trouble::Failed(format!("{}: {cause}", path.display())))
}

/// The page, as Markdown.
fn page() -> String {
    let mut page = String::from(
        "# Pictures for a lecture\n\nEach picture is made by the command under it. `cargo xtask lecture` makes them all again, and this page.\n",
    );
    for Part { heading, text, pictures } in PARTS {
        // Writing to a string does not fail.
        let _ = write!(page, "\n## {heading}\n");
        if !text.is_empty() {
            let _ = write!(page, "\n{text}\n");
        }
        for picture in *pictures {
            let (caption, file) = (picture.caption, picture.file());
            let _ =
                write!(page, "\n### {caption}\n\n![{caption}]({file})\n\n```\n{}\n```\n", picture.command());
        }
    }
    page
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_shows_the_pictures_that_are_there_with_the_commands_that_make_them() {
        let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let written = fs::read_to_string(root.join(PAGE)).expect("the page");
        assert!(written == page(), "cargo xtask lecture");
        for picture in PARTS.iter().flat_map(|part| part.pictures) {
            assert!(root.join("docs").join(picture.file()).is_file(), "{}", picture.name);
            let scene = picture.arguments.split_whitespace().next().expect("a scene");
            assert!(root.join(scene).is_file(), "{scene}");
        }
    }
}
