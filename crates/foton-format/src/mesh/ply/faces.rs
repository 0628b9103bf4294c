//! The faces of a PLY file, and its strips of triangles.

use foton_math::Cancel;
use foton_math::glam::DVec2;
use foton_scene::description::Mesh;

use super::attributes::Attributes;
use super::header::{Element, Header, Kind, Property};
use super::numbers::Numbers;
use super::values::{length, skip_value, whole};
use crate::diagnostic::Place;
use crate::mesh::obj::LEFT_OUT;
use crate::mesh::polygons::Polygons;
use crate::mesh::tally::Tally;
use crate::mesh::vertices::Vertices;
use crate::mesh::words::Problem;

/// The triangles of a file as they are read, and what was left out.
pub(super) struct Faces {
    /// How many vertices the file says it has.
    vertices: u64,
    triangles: Vec<[u32; 3]>,
    /// Triangles of strips, by the vertices of the file.
    strips: Vec<[u32; 3]>,
    polygons: Polygons,
    /// Vertices by their number in the file and the texture coordinate of a corner, if faces state any.
    split: Option<Vertices<(u32, Option<[u64; 2]>)>>,
    /// What else there is of faces, and which face each triangle is of where there is anything.
    attributes: Attributes,
    faces: Vec<u32>,
    short: Tally,
    unfit: Tally,
}

impl Faces {
    pub(super) fn new(header: &Header) -> Self {
        Self {
            vertices: header.vertices,
            triangles: Vec::new(),
            strips: Vec::new(),
            polygons: Polygons::default(),
            split: None,
            attributes: Attributes::default(),
            faces: Vec::new(),
            short: Tally::default(),
            unfit: Tally::default(),
        }
    }

    /// Reads faces that are polygons.
    pub(super) fn read(&mut self, element: &Element, numbers: &mut impl Numbers) -> Result<(), Problem> {
        self.triangles.reserve(usize::try_from(element.count).unwrap_or(0));
        if element.properties.iter().any(Property::is_corner_textures) {
            return self.read_textured(element, numbers);
        }
        let has_attributes = self.begin_attributes(element);
        for face in 0..element.count {
            if has_attributes {
                self.attributes.begin();
            }
            for (i, property) in element.properties.iter().enumerate() {
                match property.kind {
                    Kind::Scalar(kind) if has_attributes => self.attributes.set(i, numbers.next(kind)?),
                    Kind::List { count, item } if property.is_corners() => {
                        let corners = length(numbers.next(count)?, numbers)?;
                        if corners < 3 {
                            self.short.add(|| numbers.problem(String::new()));
                        }
                        let first = self.triangles.len();
                        let mut ends = [0; 2];
                        for i in 0..corners {
                            let corner = self.corner(numbers.next(item)?, numbers)?;
                            match i {
                                0 | 1 => ends[i as usize] = corner,
                                _ => {
                                    self.triangles.push([ends[0], ends[1], corner]);
                                    ends[1] = corner;
                                }
                            }
                        }
                        self.polygons.note(first, self.triangles.len() - first + 2);
                    }
                    _ => skip_value(property, numbers)?,
                }
            }
            self.end_attributes(has_attributes, face);
            numbers.end_element();
        }
        Ok(())
    }

    /// Whether faces have attributes.
    fn begin_attributes(&mut self, element: &Element) -> bool {
        self.attributes = Attributes::of(element, "face", |_| false);
        !self.attributes.is_empty()
    }

    /// Notes of which face the last triangles are.
    fn end_attributes(&mut self, has_attributes: bool, face: u64) {
        if has_attributes {
            self.faces.resize(self.triangles.len(), face as u32);
        }
    }

    /// Reads faces with a texture coordinate for each corner.
    fn read_textured(&mut self, element: &Element, numbers: &mut impl Numbers) -> Result<(), Problem> {
        let vertices = usize::try_from(self.vertices).unwrap_or(0);
        let mut split = Vertices::new(vertices);
        let (mut corners, mut textures): (Vec<u32>, Vec<f64>) = Default::default();
        let has_attributes = self.begin_attributes(element);
        for face in 0..element.count {
            corners.clear();
            textures.clear();
            if has_attributes {
                self.attributes.begin();
            }
            for (i, property) in element.properties.iter().enumerate() {
                match property.kind {
                    Kind::Scalar(kind) if has_attributes => self.attributes.set(i, numbers.next(kind)?),
                    Kind::List { count, item } if property.is_corners() => {
                        for _ in 0..length(numbers.next(count)?, numbers)? {
                            corners.push(self.corner(numbers.next(item)?, numbers)?);
                        }
                    }
                    Kind::List { count, item } if property.is_corner_textures() => {
                        for _ in 0..length(numbers.next(count)?, numbers)? {
                            textures.push(numbers.next(item)?);
                        }
                    }
                    _ => skip_value(property, numbers)?,
                }
            }
            if corners.len() < 3 {
                self.short.add(|| numbers.problem(String::new()));
            }
            let fits = textures.len() == 2 * corners.len();
            if !fits || !textures.iter().all(|t| t.is_finite()) {
                self.unfit.add(|| numbers.problem(String::new()));
            }
            for (i, corner) in corners.iter_mut().enumerate() {
                let uv = fits.then(|| DVec2::new(textures[2 * i], textures[2 * i + 1]));
                // Zero is zero, whatever its sign.
                let uv =
                    uv.filter(|uv| uv.is_finite()).map(|uv| (uv + DVec2::ZERO).to_array().map(f64::to_bits));
                *corner = split.index(*corner, (*corner, uv));
            }
            if let [first, rest @ ..] = &corners[..] {
                self.polygons.note(self.triangles.len(), corners.len());
                self.triangles.extend(rest.windows(2).map(|pair| [*first, pair[0], pair[1]]));
            }
            self.end_attributes(has_attributes, face);
            numbers.end_element();
        }
        self.split = Some(split);
        Ok(())
    }

    /// Reads strips: each corner makes a triangle with the two before, every other one turned around; −1 begins a new strip.
    pub(super) fn read_strips(
        &mut self,
        element: &Element,
        numbers: &mut impl Numbers,
    ) -> Result<(), Problem> {
        for _ in 0..element.count {
            for property in &element.properties {
                match property.kind {
                    Kind::List { count, item } if property.is_corners() => {
                        let mut strip = 0;
                        let mut last = [0; 2];
                        for _ in 0..length(numbers.next(count)?, numbers)? {
                            let number = numbers.next(item)?;
                            if number == -1.0 {
                                strip = 0;
                                continue;
                            }
                            let corner = self.corner(number, numbers)?;
                            let [a, b] = last;
                            // Strips are joined by triangles that name a corner twice.
                            if strip >= 2 && a != b && b != corner && corner != a {
                                self.strips.push(if strip % 2 == 0 {
                                    [a, b, corner]
                                } else {
                                    [b, a, corner]
                                });
                            }
                            last = [b, corner];
                            strip += 1;
                        }
                    }
                    _ => skip_value(property, numbers)?,
                }
            }
            numbers.end_element();
        }
        Ok(())
    }

    /// The vertex that a number names.
    #[allow(clippy::cast_possible_truncation, reason = "an index is below the count of vertices, which fits")]
    fn corner(&self, number: f64, numbers: &impl Numbers) -> Result<u32, Problem> {
        let index = whole(number).filter(|&i| i < self.vertices);
        index.map(|i| i as u32).ok_or_else(|| {
            numbers.problem(format!("there is no vertex {number}, the file has {}", self.vertices))
        })
    }

    /// Gives the mesh its triangles, and vertices for them; what is to be warned of.
    pub(super) fn finish(
        self,
        mesh: &mut Mesh,
        of_vertices: Attributes,
        cancel: &Cancel,
    ) -> Result<Vec<Problem>, Problem> {
        let Self { mut triangles, mut strips, polygons, split, attributes, mut faces, short, unfit, .. } =
            self;
        if triangles.is_empty() && strips.is_empty() {
            return Err((Place::default(), "the file has no faces".to_owned()));
        }
        if let Some(mut split) = split {
            // Strips state no texture coordinates for their corners.
            strips.iter_mut().flatten().for_each(|corner| *corner = split.index(*corner, (*corner, None)));
            let of_vertex = |i: u32| mesh.texture_coordinates.get(i as usize).copied().unwrap_or_default();
            let textures = split
                .keys
                .iter()
                .map(|&(i, uv)| {
                    uv.map_or_else(|| of_vertex(i), |uv| DVec2::from_array(uv.map(f64::from_bits)))
                })
                .collect();
            mesh.texture_coordinates = textures;
            mesh.positions = split.keys.iter().map(|&(i, _)| mesh.positions[i as usize]).collect();
            if !mesh.normals.is_empty() {
                mesh.normals = split.keys.iter().map(|&(i, _)| mesh.normals[i as usize]).collect();
            }
            mesh.attributes = of_vertices.pick(split.keys.iter().map(|&(i, _)| i as usize));
        } else {
            mesh.attributes = of_vertices.all();
        }
        triangles.append(&mut strips);
        let mended = polygons.mend(&mut triangles, |i| mesh.positions[i as usize], cancel);
        if !attributes.is_empty() {
            let mut at = 0..;
            faces.retain(|_| at.next().is_none_or(|i| mended.gone.binary_search(&i).is_err()));
            // Triangles of strips are of no face.
            faces.resize(triangles.len(), u32::MAX);
            mesh.attributes.extend(attributes.pick(faces.iter().map(|&face| face as usize)));
        }
        mesh.triangles = triangles;
        let warnings = [
            short.warning("face has", "faces have", LEFT_OUT),
            unfit.warning("face has", "faces have", UNFIT),
        ];
        Ok(warnings.into_iter().flatten().chain(mended.warnings()).collect())
    }
}

const UNFIT: &str =
    "texture coordinates that are not finite or do not fit the corners: those of the vertices are taken";
