//! Shapes of triangles: stated in the scene, in PLY files, patches, subdivision surfaces and fields of heights.

use std::path::Path;
use std::sync::Arc;

use foton_input::shown_path;
use foton_math::glam::{DAffine3, DVec2, DVec3};
use foton_scene::description::Mesh;

use super::packed;
use super::parameters::{Kind, Parameters};
use super::reader::Reader;
use super::subdivision::Surface;
use crate::diagnostic::Place;
use crate::files::Files;
use crate::mesh::{normals, ply};
use crate::mitsuba::read::properties::Located;

/// Bytes of a triangle of a subdivided surface, while it is made.
const BYTES_PER_SUBDIVIDED: u64 = 400;
/// The most levels of subdivision: 4¹⁰ triangles for each.
const MAX_LEVELS: i64 = 10;
/// Pieces along each side of a patch that is not flat.
const PATCH: u32 = 8;

impl Reader<'_> {
    pub(crate) fn triangle_mesh(&mut self, p: &Parameters) -> Option<Arc<Mesh>> {
        p.ignore(&["S", "faceIndices"]);
        let (mesh, indices) = self.vertices(p, 3, &[0, 1, 2])?;
        let (triangles, odd) = indices.as_chunks::<3>();
        if !odd.is_empty() {
            self.report.error(p.place_of("indices"), "\"indices\" of triangles are three each");
            return None;
        }
        self.mended(Mesh { triangles: triangles.to_vec(), ..mesh }, p.place)
    }

    /// Points with normals and texture coordinates, and the indices that use them: `only` where none are stated of `count` points.
    fn vertices(&mut self, p: &Parameters, count: usize, only: &[u32]) -> Option<(Mesh, Vec<u32>)> {
        let report = &mut self.report;
        let positions = p.points("P", report);
        let normals = p.points("N", report).unwrap_or_default();
        let uv = ["uv", "st"].into_iter().find(|name| p.has(name));
        let texture_coordinates = uv.and_then(|name| p.points2(name, report)).unwrap_or_default();
        let indices = p.indices("indices", report);
        if positions.is_none() && !p.has("P") {
            report.error(p.place, format!("a {} needs its points \"P\"", p.plugin));
        }
        let positions = positions?;
        let indices = match indices {
            Some(indices) => indices,
            None if p.has("indices") => return None,
            None if positions.len() == count => only.to_vec(),
            None => {
                report.error(p.place, format!("a {} needs \"indices\" of its points", p.plugin));
                return None;
            }
        };
        if let Some(beyond) = indices.iter().find(|i| **i as usize >= positions.len()) {
            let message = format!(
                "the index {beyond} is that of no point: there are {}, counted from 0",
                positions.len()
            );
            report.error(p.place_of("indices"), message);
            return None;
        }
        let numbers = 3 * positions.len() + 3 * normals.len() + 2 * texture_coordinates.len();
        if !self.take((8 * numbers + 4 * indices.len()) as u64, p.place) {
            return None;
        }
        let report = &mut self.report;
        let mut mesh = Mesh { positions, normals, texture_coordinates, ..Mesh::default() };
        let points = mesh.positions.len();
        for (name, found) in [("N", mesh.normals.len()), (uv.unwrap_or("uv"), mesh.texture_coordinates.len())]
        {
            if found > 0 && found != points {
                report.warning(
                    p.place_of(name),
                    format!("\"{name}\" has {found} values for {points} points: it has no effect"),
                );
            }
        }
        mesh.normals.truncate(if mesh.normals.len() == points { points } else { 0 });
        mesh.texture_coordinates.truncate(if mesh.texture_coordinates.len() == points { points } else { 0 });
        Some((mesh, indices))
    }

    /// A mesh whose normals and texture coordinates are such.
    fn mended(&mut self, mut mesh: Mesh, place: Place) -> Option<Arc<Mesh>> {
        if mesh.triangles.is_empty() {
            self.report.warning(place, "this shape has no triangles");
            return None;
        }
        for (_, message) in normals::mend(&mut mesh, self.files.cancel()) {
            self.report.warning(place, message);
        }
        Some(Arc::new(mesh))
    }

    pub(crate) fn ply_mesh(&mut self, p: &Parameters) -> Option<Arc<Mesh>> {
        if p.has("displacement") {
            let place = p.place_of("displacement");
            self.report.warn_once(
                place,
                "meshes are not displaced: \"displacement\" of a shape has no effect".to_owned(),
            );
        }
        p.ignore(&["displacement", "edgelength"]);
        let Some(filename) = p.text("filename", &mut self.report) else {
            if !p.has("filename") {
                self.report.error(p.place, "a plymesh needs a \"filename\"");
            }
            return None;
        };
        let key = Files::key(&filename.value, filename.place, &self.report);
        if let Some(known) = self.meshes.get(&key) {
            return known.clone();
        }
        let mesh = self.ply_file(&filename, &key).map(Arc::new);
        self.meshes.insert(key, mesh.clone());
        mesh
    }

    /// The mesh of a PLY file, its normals only where the file states them.
    fn ply_file(&mut self, filename: &Located<String>, key: &Path) -> Option<Mesh> {
        let instead = "the shape is left out";
        let place = filename.place;
        let read = self.files.read_or_do_without(&filename.value, place, instead, &mut self.report)?;
        let (path, bytes) = read.ok()?;
        let cancel = self.files.cancel();
        let bytes = packed::unpacked(bytes, &mut self.files.budget, cancel);
        // Of what was packed, the mesh itself is not counted yet.
        let counted = bytes.and_then(|bytes| {
            let more = if key.extension().is_some_and(|e| e == "gz") { 3 * bytes.len() as u64 } else { 0 };
            self.files.budget.take(more).map(|()| bytes)
        });
        let bytes = match counted {
            Ok(bytes) => bytes,
            Err(message) => {
                self.report.error(place, format!("cannot read {}: {message}", shown_path(&path)));
                return None;
            }
        };
        let file = path.to_string_lossy();
        match ply::parse(&bytes, self.files.watch()) {
            Ok((mesh, warnings)) => {
                warnings
                    .into_iter()
                    .for_each(|(place, message)| self.report.warning_in(&file, place, message));
                Some(mesh)
            }
            Err((place, message)) => {
                self.report.error_in(&file, place, message);
                None
            }
        }
    }

    /// Patches of four corners: as two triangles where they are parallelograms, else as many.
    pub(crate) fn bilinear_mesh(&mut self, p: &Parameters) -> Option<Arc<Mesh>> {
        p.ignore(&["emissionfilename"]);
        let (corners, indices) = self.vertices(p, 4, &[0, 1, 2, 3])?;
        let (patches, odd) = indices.as_chunks::<4>();
        if !odd.is_empty() {
            self.report.error(p.place_of("indices"), "\"indices\" of patches are four each");
            return None;
        }
        let pieces = |patch: &[u32; 4]| {
            let [a, b, c, d] = patch.map(|i| corners.positions[i as usize]);
            let size = (b - a).abs().max((c - a).abs()).max_element();
            let is_flat = (d + a - b - c).abs().max_element() <= 1e-6 * size && corners.normals.is_empty();
            if is_flat { 1 } else { PATCH }
        };
        let bytes: u64 = patches.iter().map(|patch| u64::from(pieces(patch) + 1).pow(2) * 100).sum();
        if !self.take(bytes, p.place) {
            return None;
        }
        let mut mesh = Mesh::default();
        for patch in patches {
            add_patch(&corners, *patch, pieces(patch), &mut mesh);
        }
        self.mended(mesh, p.place)
    }

    pub(crate) fn loop_subdivision(&mut self, p: &Parameters) -> Option<Arc<Mesh>> {
        p.ignore(&["scheme"]);
        let name = if p.has("nlevels") { "nlevels" } else { "levels" };
        let levels = p.integer(name, &mut self.report).map_or(3, |levels| levels.value);
        let (mesh, indices) = self.vertices(p, 3, &[0, 1, 2])?;
        if !(0..=MAX_LEVELS).contains(&levels) {
            self.report.error(p.place_of(name), format!("\"{name}\" must lie between 0 and {MAX_LEVELS}"));
            return None;
        }
        let (triangles, odd) = indices.as_chunks::<3>();
        if !odd.is_empty() {
            self.report.error(p.place_of("indices"), "\"indices\" of triangles are three each");
            return None;
        }
        let levels = levels as u32;
        if !self.take((triangles.len() as u64).saturating_mul(BYTES_PER_SUBDIVIDED << (2 * levels)), p.place)
        {
            return None;
        }
        let surface = Surface { points: mesh.positions, triangles: triangles.to_vec() };
        let Surface { points, triangles } = surface.subdivided(levels, self.files.cancel());
        let normals = normals::smooth_normals(&points, &triangles, &DAffine3::IDENTITY, self.files.cancel());
        self.mended(Mesh { positions: points, normals, triangles, ..Mesh::default() }, p.place)
    }

    /// Heights over the unit square.
    pub(crate) fn height_field(&mut self, p: &Parameters) -> Option<Arc<Mesh>> {
        let [nu, nv] = ["nu", "nv"].map(|name| p.integer(name, &mut self.report).map_or(0, |n| n.value));
        let heights = p.numbers("Pz", &[Kind::Float], &mut self.report).unwrap_or_default();
        let fits = nu >= 2 && nv >= 2 && nu.saturating_mul(nv) == heights.len() as i64;
        if !fits {
            self.report.error(
                p.place,
                "a heightfield needs nu times nv heights \"Pz\", two or more along each side",
            );
            return None;
        }
        if !self.take(heights.len() as u64 * 100, p.place) {
            return None;
        }
        let (nu, nv) = (nu as u32, nv as u32);
        let uv =
            |i: u32| DVec2::new(f64::from(i % nu) / f64::from(nu - 1), f64::from(i / nu) / f64::from(nv - 1));
        let texture_coordinates: Vec<DVec2> = (0..nu * nv).map(uv).collect();
        let positions = texture_coordinates.iter().zip(heights).map(|(uv, z)| uv.extend(*z)).collect();
        let cells = (0..nv - 1).flat_map(|y| (0..nu - 1).map(move |x| y * nu + x));
        let triangles = cells.flat_map(|a| [[a, a + 1, a + nu + 1], [a, a + nu + 1, a + nu]]).collect();
        self.mended(Mesh { positions, texture_coordinates, triangles, ..Mesh::default() }, p.place)
    }
}

/// Adds a patch, `pieces` along each side. Its corners are those of (u, v) = (0, 0), (1, 0), (0, 1) and (1, 1).
fn add_patch(corners: &Mesh, patch: [u32; 4], pieces: u32, mesh: &mut Mesh) {
    let first = mesh.positions.len() as u32;
    let [a, b, c, d] = patch.map(|i| corners.positions[i as usize]);
    let between = |values: [DVec3; 4], uv: DVec2| {
        let [a, b, c, d] = values;
        a.lerp(b, uv.x).lerp(c.lerp(d, uv.x), uv.y)
    };
    for i in 0..(pieces + 1) * (pieces + 1) {
        let uv = DVec2::new(f64::from(i % (pieces + 1)), f64::from(i / (pieces + 1))) / f64::from(pieces);
        mesh.positions.push(between([a, b, c, d], uv));
        let along_u = (b - a).lerp(d - c, uv.y);
        let along_v = (c - a).lerp(d - b, uv.x);
        let stated =
            (!corners.normals.is_empty()).then(|| between(patch.map(|i| corners.normals[i as usize]), uv));
        mesh.normals.push(stated.unwrap_or_else(|| along_u.cross(along_v).normalize_or(DVec3::Z)));
        let coordinates = &corners.texture_coordinates;
        let stated = || between(patch.map(|i| coordinates[i as usize].extend(0.0)), uv).truncate();
        mesh.texture_coordinates.push(if coordinates.is_empty() { uv } else { stated() });
    }
    for i in (0..pieces * pieces).map(|i| first + i / pieces * (pieces + 1) + i % pieces) {
        let above = i + pieces + 1;
        mesh.triangles.extend([[i, i + 1, above + 1], [i, above + 1, above]]);
    }
}
