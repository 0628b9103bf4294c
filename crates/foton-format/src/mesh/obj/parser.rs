//! The statements of an OBJ file, one by one.

use foton_math::Cancel;
use foton_math::glam::{DVec2, DVec3};

use super::colours::Colours;
use super::kind::is_of_kind;
use super::{Corner, LEFT_OUT, NORMALS_MENDED, Obj, TEXTURES_MENDED};
use crate::diagnostic::Place;
use crate::mesh::polygons::Polygons;
use crate::mesh::tally::Tally;
use crate::mesh::words::{Problem, Word, Words, direction, shown, texture_coordinate, vector};
use crate::watch::Watch;

/// The share of the time that counting statements takes.
const COUNTING: f64 = 0.25;

/// More problems than these in one file are only counted.
pub(super) const MAX_PROBLEMS: usize = 20;

impl Obj {
    /// Reads a file. Faces with more than three corners become fans, as in Mitsuba 3, unless they are concave.
    ///
    /// # Errors
    /// All problems of the file, at most [`MAX_PROBLEMS`] of them one by one.
    pub(crate) fn parse<'a>(bytes: &'a [u8], watch: impl Into<Watch<'a>>) -> Result<Self, Vec<Problem>> {
        let watch: Watch<'a> = watch.into();
        let cancel = watch.cancel();
        if u32::try_from(bytes.len()).is_err() {
            return Err(vec![(Place::default(), "the file is larger than 4 GiB".to_owned())]);
        }
        let totals = Totals::count(bytes, watch.part(0.0, COUNTING));
        let mut parser = Parser {
            totals,
            face: Vec::new(),
            polygons: Polygons::default(),
            short_faces: Tally::default(),
            bad_normal: None,
            bad_textures: Tally::default(),
            problems: Vec::new(),
            colours: Colours::default(),
            obj: Self {
                positions: Vec::with_capacity(totals.positions),
                colours: Vec::new(),
                normals: Vec::with_capacity(totals.normals),
                textures: Vec::with_capacity(totals.textures),
                triangles: Vec::with_capacity(totals.faces),
                libraries: Vec::new(),
                materials: Vec::new(),
                warnings: Vec::new(),
            },
        };
        let mut unlisted = 0;
        let mut words = Words::new(bytes, watch.part(COUNTING, 1.0 - COUNTING));
        while words.next_line() {
            if let Err(problem) = parser.line(&mut words) {
                if parser.problems.len() < MAX_PROBLEMS {
                    parser.problems.push(problem);
                } else {
                    unlisted += 1;
                }
            }
        }
        if unlisted > 0 {
            parser.problems.push((Place::default(), format!("{unlisted} more problems in this file")));
        } else if parser.problems.is_empty() && parser.obj.triangles.is_empty() {
            parser.problems.push((Place::default(), "the file has no faces".to_owned()));
        }
        match parser.problems.is_empty() {
            true => Ok(parser.finish(cancel)),
            // Nothing is quoted of a file that is none of these.
            false if !is_of_kind(bytes, cancel) => {
                Err(vec![(Place::default(), "this is no OBJ file".to_owned())])
            }
            false => Err(parser.problems),
        }
    }
}

/// How many statements of each kind a file has.
#[derive(Clone, Copy, Default)]
struct Totals {
    positions: usize,
    normals: usize,
    textures: usize,
    faces: usize,
}

impl Totals {
    fn count(bytes: &[u8], watch: Watch<'_>) -> Self {
        let mut totals = Self::default();
        let mut words = Words::new(bytes, watch);
        while words.next_line() {
            match words.next().map_or(&b""[..], |w| w.text) {
                b"v" => totals.positions += 1,
                b"vn" => totals.normals += 1,
                b"vt" => totals.textures += 1,
                b"f" => totals.faces += 1,
                _ => {}
            }
        }
        totals
    }
}

struct Parser {
    totals: Totals,
    /// Corners of the face being read.
    face: Vec<Corner>,
    polygons: Polygons,
    short_faces: Tally,
    /// The first normal that has no direction; how many of them faces name is known at the end.
    bad_normal: Option<Place>,
    bad_textures: Tally,
    problems: Vec<Problem>,
    colours: Colours,
    obj: Obj,
}

impl Parser {
    fn line(&mut self, words: &mut Words<'_>) -> Result<(), Problem> {
        let Some(keyword) = words.next() else { return Ok(()) };
        match keyword.text {
            b"v" => {
                let position = vector(keyword, words);
                if position.is_ok() {
                    self.colours.note(self.obj.positions.len(), words, self.totals.positions);
                }
                // Keeps the count right for later faces even if the numbers are bad.
                self.obj.positions.push(position.as_ref().map_or(DVec3::ZERO, |p| *p));
                position.map(|_| ())
            }
            b"vn" => {
                let normal = direction(keyword, words);
                let vector = normal.as_ref().map_or(DVec3::Z, |n| n.unwrap_or(DVec3::ZERO));
                if vector.try_normalize().is_none() {
                    self.bad_normal.get_or_insert(keyword.place);
                }
                self.obj.normals.push(vector);
                normal.map(|_| ())
            }
            b"vt" => {
                let texture = texture_coordinate(keyword, words);
                if let Ok(None) = texture {
                    self.bad_textures.add(|| (keyword.place, String::new()));
                }
                self.obj.textures.push(texture.as_ref().map_or(DVec2::ZERO, |t| t.unwrap_or_default()));
                texture.map(|_| ())
            }
            b"f" => self.face(keyword, words),
            b"mtllib" => {
                self.obj.libraries.push((keyword.place, words.rest_of_line()));
                Ok(())
            }
            b"usemtl" => {
                self.obj.materials.push((self.obj.triangles.len(), words.rest_of_line()));
                Ok(())
            }
            _ => Ok(()),
        }
    }

    fn face(&mut self, keyword: Word<'_>, words: &mut Words<'_>) -> Result<(), Problem> {
        self.face.clear();
        while let Some(word) = words.next() {
            let corner = self.corner(word.text).map_err(|message| (word.place, message))?;
            self.face.push(corner);
        }
        let [first, rest @ ..] = &self.face[..] else {
            self.short_faces.add(|| (keyword.place, String::new()));
            return Ok(());
        };
        if rest.len() < 2 {
            self.short_faces.add(|| (keyword.place, String::new()));
        }
        self.polygons.note(self.obj.triangles.len(), self.face.len());
        self.obj.triangles.extend(rest.windows(2).map(|pair| [*first, pair[0], pair[1]]));
        Ok(())
    }

    /// The file, its polygons and normals mended.
    fn finish(self, cancel: &Cancel) -> Obj {
        let Self { mut obj, colours, polygons, short_faces, bad_normal, bad_textures, .. } = self;
        obj.colours = colours.finish(obj.positions.len());
        let positions = std::mem::take(&mut obj.positions);
        let mended = polygons.mend(&mut obj.triangles, |corner| positions[corner.position as usize], cancel);
        obj.positions = positions;
        obj.renumber_materials(&mended.gone);
        let mut bad_normals = Tally::default();
        bad_normals.add_many(obj.drop_zero_normals(), || (bad_normal.unwrap_or_default(), String::new()));
        obj.warnings = [
            short_faces.warning("face has", "faces have", LEFT_OUT),
            bad_normals.warning("normal is", "normals are", NORMALS_MENDED),
            bad_textures.warning("texture coordinate is", "texture coordinates are", TEXTURES_MENDED),
        ]
        .into_iter()
        .flatten()
        .chain(mended.warnings())
        .collect();
        obj
    }

    /// `v`, `v/t`, `v//n` or `v/t/n`.
    fn corner(&self, text: &[u8]) -> Result<Corner, String> {
        let mut parts = text.split(|&b| b == b'/');
        let mut next = || parts.next().unwrap_or_default();
        let (position, texture, normal) = (next(), next(), next());
        if parts.next().is_some() || position.is_empty() {
            return Err(format!("\"{}\" is not a corner such as 1, 1/2 or 1/2/3", shown(text)));
        }
        let seen = (self.obj.positions.len(), self.obj.textures.len(), self.obj.normals.len());
        let position = number("vertex", position, self.totals.positions, seen.0)?;
        let texture = number("texture coordinate", texture, self.totals.textures, seen.1)?;
        let normal = number("normal", normal, self.totals.normals, seen.2)?;
        Ok(Corner { position: position - 1, texture, normal })
    }
}

/// A number from 1 to `total`, 0 for an empty text; negative ones count back from those `seen` so far.
fn number(what: &str, text: &[u8], total: usize, seen: usize) -> Result<u32, String> {
    if text.is_empty() {
        return Ok(0);
    }
    let bad = || format!("\"{}\" is not the number of a {what}", shown(text));
    let given: i64 = std::str::from_utf8(text).ok().and_then(|t| t.parse().ok()).ok_or_else(bad)?;
    let limit = |n: usize| i64::try_from(n).unwrap_or(i64::MAX);
    let found = if given < 0 { limit(seen).saturating_add(given).saturating_add(1) } else { given };
    if found < 1 || found > limit(total) {
        return Err(format!("there is no {what} {given}, the file has {total}"));
    }
    u32::try_from(found).map_err(|_| bad())
}
