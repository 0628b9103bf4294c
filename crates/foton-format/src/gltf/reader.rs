//! What is known while a file is read: its parts, what was made of them, and what is said of it.

use std::collections::{BTreeMap, HashMap};
use std::rc::Rc;
use std::sync::Arc;

use foton_scene::description::{Bitmap, Colour, Mesh, SceneDescription};

use super::buffers::Buffers;
use super::json::At;
use super::wanted::Wanted;
use crate::diagnostic::{Place, Report};
use crate::files::Files;

/// A file being read.
pub(super) struct Reader<'a> {
    pub(super) root: At<'a>,
    pub(super) buffers: Rc<Buffers<'a>>,
    pub(super) files: Files<'a>,
    pub(super) report: Report,
    pub(super) description: SceneDescription,
    /// Factor from candela and lux to W·sr⁻¹ and W·m⁻².
    pub(super) watts_per_lumen: f64,
    pub(super) made: Made,
}

/// What was made of parts that several others refer to.
#[derive(Default)]
pub(super) struct Made {
    /// Images by their number and how they are read; `None`: what is wrong was said.
    pub(super) bitmaps: HashMap<(usize, Wanted), Option<Arc<Bitmap>>>,
    /// Indices of textures by bitmap, wrapping, interpolation and transform.
    pub(super) textures: HashMap<TextureKey, usize>,
    /// Materials by their number, none for that of parts without, and what a mesh adds to them.
    pub(super) surfaces: HashMap<(Option<usize>, Painted), Surface>,
    /// Meshes by the numbers of the mesh and of its primitive.
    pub(super) parts: HashMap<(usize, usize), Arc<[Part]>>,
    /// The set of texture coordinates of the material that is read.
    pub(super) set: usize,
    /// How often a name was there: of materials, and of the rest.
    pub(super) names: [HashMap<String, usize>; 2],
    /// What is said once of each kind of thing, with how often it was met and where first.
    notices: BTreeMap<&'static str, (String, usize)>,
}

/// A bitmap by its address, its wrapping, whether it is interpolated, and the bits of its transform.
pub(super) type TextureKey = (*const Bitmap, u8, bool, [u64; 6]);

/// What the vertices of a part add to its material.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(super) struct Painted {
    /// Its colours differ from vertex to vertex.
    pub(super) colours: bool,
    /// As do its opacities.
    pub(super) opacities: bool,
    /// A colour and an opacity that all vertices share, as bits; `None`: white.
    pub(super) shared: Option<[u32; 4]>,
    /// Its texture coordinates are mirrored: normal maps are upside down.
    pub(super) mirrored: bool,
}

/// A material as a shape has it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Surface {
    /// Its index in the description.
    pub(super) material: usize,
    /// What it emits.
    pub(super) radiance: Option<Colour>,
}

/// Triangles of one material.
#[derive(Clone)]
pub(super) struct Part {
    pub(super) mesh: Arc<Mesh>,
    pub(super) surface: Surface,
}

impl Reader<'_> {
    /// Notes something that is said once, however often it is met.
    pub(super) fn notice(&mut self, what: &'static str, at: &At<'_>) {
        self.made.notices.entry(what).or_insert_with(|| (at.path().to_owned(), 0)).1 += 1;
    }

    /// Says what was noted.
    pub(super) fn say_notices(&mut self) {
        for (what, (path, count)) in std::mem::take(&mut self.made.notices) {
            let more = if count > 1 { format!(" (and {} more)", count - 1) } else { String::new() };
            self.report.warning(Place::default(), format!("{path}{more}: {what}"));
        }
    }

    /// The name of a shape, a camera or a light: that of the file, made different from those before.
    pub(super) fn unique(&mut self, name: &str) -> String {
        unique(name, &mut self.made.names[0])
    }

    /// The same of a material.
    pub(super) fn unique_material(&mut self, name: &str) -> String {
        unique(name, &mut self.made.names[1])
    }
}

fn unique(name: &str, names: &mut HashMap<String, usize>) -> String {
    let mut unique = if name.is_empty() { "unnamed".to_owned() } else { name.to_owned() };
    loop {
        let count = names.entry(unique.clone()).or_insert(0);
        *count += 1;
        if *count == 1 {
            return unique;
        }
        unique = format!("{unique}-{count}");
    }
}
