//! Wavefront OBJ to positions, normals, texture coordinates and triangles by index. Groups and curves are not
//! read; materials are kept by name.
//!
//! Our own reader, because errors must name the line. Two passes over the bytes: the first counts, so that the
//! second allocates once and can check every index where it stands. What exporters get wrong and what can be done
//! without is mended or left out, counted and warned of: normals and texture coordinates that are no numbers, faces of
//! fewer than three corners.

use foton_math::Cancel;
use foton_math::glam::{DVec2, DVec3};

use crate::diagnostic::Place;
use crate::mesh::polygons::Polygons;
use crate::mesh::tally::Tally;
use crate::mesh::words::{Problem, Word, Words, direction, shown, texture_coordinate, vector};

/// How warnings that readers of meshes share go on.
pub(crate) const LEFT_OUT: &str = "fewer than three corners and are left out";
pub(crate) const NORMALS_MENDED: &str = "zero or not finite: the faces around say where they point";
pub(crate) const TEXTURES_MENDED: &str = "not finite and taken as zero";

/// More problems than these in one file are only counted.
const MAX_PROBLEMS: usize = 20;

/// The contents of a file, still by index.
pub(crate) struct Obj {
    pub(crate) positions: Vec<DVec3>,
    pub(crate) normals: Vec<DVec3>,
    /// Texture coordinates, v upwards as a rule.
    pub(crate) textures: Vec<DVec2>,
    pub(crate) triangles: Vec<[Corner; 3]>,
    /// Files with materials, and where they are named.
    pub(crate) libraries: Vec<(Place, String)>,
    /// Names of materials, each with the number of triangles before the first that has it.
    pub(crate) materials: Vec<(usize, String)>,
    /// What was mended or left out.
    pub(crate) warnings: Vec<Problem>,
}

/// A corner of a face.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) struct Corner {
    /// Index of the position, from 0.
    pub(crate) position: u32,
    /// Number of the texture coordinate, from 1; 0: none.
    pub(crate) texture: u32,
    /// Number of the normal, from 1; 0: none.
    pub(crate) normal: u32,
}

impl Obj {
    /// Reads a file. Faces with more than three corners become fans, as in Mitsuba 3, unless they are concave.
    ///
    /// # Errors
    /// All problems of the file, at most [`MAX_PROBLEMS`] of them one by one.
    pub(crate) fn parse(bytes: &[u8], cancel: &Cancel) -> Result<Self, Vec<Problem>> {
        if u32::try_from(bytes.len()).is_err() {
            return Err(vec![(Place::default(), "the file is larger than 4 GiB".to_owned())]);
        }
        let totals = Totals::count(bytes, cancel);
        let mut parser = Parser {
            totals,
            face: Vec::new(),
            polygons: Polygons::default(),
            short_faces: Tally::default(),
            bad_normal: None,
            bad_textures: Tally::default(),
            problems: Vec::new(),
            obj: Self {
                positions: Vec::with_capacity(totals.positions),
                normals: Vec::with_capacity(totals.normals),
                textures: Vec::with_capacity(totals.textures),
                triangles: Vec::with_capacity(totals.faces),
                libraries: Vec::new(),
                materials: Vec::new(),
                warnings: Vec::new(),
            },
        };
        let mut unlisted = 0;
        let mut words = Words::new(bytes, cancel);
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

    /// Corners whose normal is zero have none; how many normals those are.
    fn drop_zero_normals(&mut self) -> usize {
        let mut is_dropped = vec![false; self.normals.len()];
        for corner in self.triangles.iter_mut().flatten().filter(|c| c.normal != 0) {
            let index = corner.normal as usize - 1;
            if self.normals[index].try_normalize().is_none() {
                is_dropped[index] = true;
                corner.normal = 0;
            }
        }
        is_dropped.iter().filter(|&&dropped| dropped).count()
    }

    /// Triangles that are gone no longer stand before a material.
    fn renumber_materials(&mut self, gone: &[usize]) {
        let mut gone = gone.iter().peekable();
        let mut count = 0;
        for (before, _) in &mut self.materials {
            while gone.next_if(|&at| at < before).is_some() {
                count += 1;
            }
            *before -= count;
        }
    }
}

/// Whether a file begins as an OBJ file does: its first statements are such that one has. An empty one may have been cut.
fn is_of_kind(bytes: &[u8], cancel: &Cancel) -> bool {
    const KNOWN: &[&[u8]] = &[
        b"v",
        b"vn",
        b"vt",
        b"vp",
        b"f",
        b"fo",
        b"l",
        b"p",
        b"g",
        b"o",
        b"s",
        b"mg",
        b"mtllib",
        b"usemtl",
        b"maplib",
        b"usemap",
        b"bevel",
        b"c_interp",
        b"d_interp",
        b"lod",
        b"shadow_obj",
        b"trace_obj",
        b"ctech",
        b"stech",
        b"cstype",
        b"deg",
        b"bmat",
        b"step",
        b"curv",
        b"curv2",
        b"surf",
        b"parm",
        b"trim",
        b"hole",
        b"scrv",
        b"sp",
        b"end",
        b"con",
        b"call",
        b"csh",
    ];
    let (mut words, mut left) = (Words::new(bytes, cancel), FIRST_STATEMENTS);
    while left > 0 && words.next_line() {
        if let Some(keyword) = words.next() {
            if !KNOWN.contains(&keyword.text) {
                return false;
            }
            left -= 1;
        }
    }
    true
}

/// How many statements say whether a file is of this kind.
const FIRST_STATEMENTS: usize = 20;

/// How many statements of each kind a file has.
#[derive(Clone, Copy, Default)]
struct Totals {
    positions: usize,
    normals: usize,
    textures: usize,
    faces: usize,
}

impl Totals {
    fn count(bytes: &[u8], cancel: &Cancel) -> Self {
        let mut totals = Self::default();
        let mut words = Words::new(bytes, cancel);
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
    obj: Obj,
}

impl Parser {
    fn line(&mut self, words: &mut Words<'_>) -> Result<(), Problem> {
        let Some(keyword) = words.next() else { return Ok(()) };
        match keyword.text {
            b"v" => {
                let position = vector(keyword, words);
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
        let Self { mut obj, polygons, short_faces, bad_normal, bad_textures, .. } = self;
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

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Obj {
        Obj::parse(text.as_bytes(), &Cancel::default()).map_err(|p| format!("{p:?}")).unwrap()
    }

    fn problems(text: &str) -> Vec<String> {
        let problems = Obj::parse(text.as_bytes(), &Cancel::default()).err().unwrap_or_default();
        problems.iter().map(|(p, message)| format!("{}:{}: {message}", p.line, p.column)).collect()
    }

    fn positions(obj: &Obj) -> Vec<[u32; 3]> {
        obj.triangles.iter().map(|t| t.map(|c| c.position)).collect()
    }

    const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

    #[test]
    fn every_form_of_a_corner_is_read() {
        let obj = read(&format!(
            "{SQUARE}vt 0 0\nvn 0 0 2\nf 1 2 3\nf 1/1 2/1 3/1\nf 1//1 2//1 3//1\nf 1/1/1 2/1/1 3/1/1\n"
        ));
        let firsts: Vec<_> = obj.triangles.iter().map(|t| (t[0].texture, t[0].normal)).collect();
        assert_eq!(firsts, [(0, 0), (1, 0), (0, 1), (1, 1)]);
        assert_eq!(obj.normals, [DVec3::new(0.0, 0.0, 2.0)]);
        assert_eq!(positions(&obj), [[0, 1, 2]; 4]);
    }

    #[test]
    fn negative_numbers_count_back_from_the_face() {
        let obj = read("v 0 0 0\nv 1 0 0\nv 1 1 0\nvn 0 0 1\nf -3//-1 -2//-1 -1//-1\nv 5 5 5\nf -4 -3 -2\n");
        assert_eq!(positions(&obj), [[0, 1, 2], [0, 1, 2]]);
        assert_eq!(obj.triangles[0][0].normal, 1);
    }

    #[test]
    fn a_polygon_becomes_a_fan() {
        assert_eq!(
            positions(&read(&format!("{SQUARE}v 2 2 2\nf 1 2 3 4 5\n"))),
            [[0, 1, 2], [0, 2, 3], [0, 3, 4]]
        );
    }

    #[test]
    fn a_concave_polygon_becomes_ears_and_materials_keep_their_faces() {
        // An arrow with corners on its edges, one of them named twice, and a square of another material. The points come later.
        let text = format!(
            "f 5 6 7 7 8 9\nusemtl m\nf 1 2 3 4\n{SQUARE}v 0 0 0\nv 4 2 0\nv 0 4 0\nv 0.5 3 0\nv 1 2 0\n"
        );
        let obj = read(&text);
        let area = |t: &[Corner; 3]| {
            let [a, b, c] = t.map(|c| obj.positions[c.position as usize]);
            0.5 * (b - a).cross(c - a).z
        };
        let start = obj.materials[0].0;
        assert_eq!(positions(&obj)[start..], [[0, 1, 2], [0, 2, 3]]);
        assert!(obj.triangles[..start].iter().all(|t| area(t) > 0.0), "{:?}", positions(&obj));
        assert!((obj.triangles[..start].iter().map(area).sum::<f64>() - 6.0).abs() < 1e-12);
        assert_eq!(obj.warnings, []);
    }

    #[test]
    fn what_exporters_get_wrong_is_mended_and_counted() {
        let text = format!(
            "{SQUARE}vn 0 0 1\nvn nan 0 0\nvn 0 0 0\nvn 0 0 0\nvn -nan(ind) 0 1\nvt 1 1\nvt 0.5 1.#QNAN\nf 1 2\nf\n\
             f 1/1/1 2/2/2 3/1/3\nf 1//5 3//1 4//1\nf 1 4 3 2 # and a face that crosses itself\nf 1 3 2 4\n"
        );
        let obj = read(&text);
        assert_eq!(obj.triangles.len(), 6);
        assert_eq!(obj.triangles[0].map(|c| c.normal), [1, 0, 0]);
        assert_eq!(obj.triangles[1].map(|c| c.normal), [0, 1, 1]);
        assert_eq!(obj.textures, [DVec2::ONE, DVec2::ZERO]);
        let said: Vec<_> = obj.warnings.iter().map(|(p, m)| format!("{}: {m}", p.line)).collect();
        assert_eq!(
            said,
            [
                format!("12: 2 faces have {LEFT_OUT}"),
                format!("6: 3 normals are {NORMALS_MENDED}"),
                format!("11: 1 texture coordinate is {TEXTURES_MENDED}"),
                "0: 1 face has edges that cross: what is filled may not be what was meant".to_owned(),
            ]
        );
    }

    #[test]
    fn positive_numbers_may_point_forward() {
        assert_eq!(positions(&read("f 1 2 3\nv 0 0 0\nv 1 0 0\nv 1 1 0")), [[0, 1, 2]]);
    }

    #[test]
    fn white_space_comments_and_other_statements_are_skipped() {
        let text = "\u{feff}# a comment \\\r\nmtllib x.mtl\r\no it\r\n\r\n  v\t0 0 0 1.0  \r\nv 1 0 0 # trailing\r\nv 1 1 \\\r\n 0 0.5 0.5 0.5\r\n\
                    g a \\\nv b\ns off\nusemtl m\nf 1 \\\n2 3  \r\n";
        let obj = read(text);
        assert_eq!(obj.positions, [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0)]);
        assert_eq!(positions(&obj), [[0, 1, 2]]);
    }

    #[test]
    fn every_problem_has_its_line_and_column() {
        let text = "v 0 0 0\nv 1 x 0\nv 1 1\nv 1 nan 0\nvn 0 0 0\nf 1 2\nf\nf 1 2 9\nf 0 1 2\nf -9 1 2\nf 1/2/3/4 1 2\nf 1//7 1 2\nf 1 \\\n  2 z\nf 1/5 1 1";
        assert_eq!(
            problems(text),
            [
                "2:5: \"x\" is not a number",
                "3:1: \"v\" needs three numbers, not 2",
                "4:5: \"nan\" is not a finite number",
                "8:7: there is no vertex 9, the file has 4",
                "9:3: there is no vertex 0, the file has 4",
                "10:3: there is no vertex -9, the file has 4",
                "11:3: \"1/2/3/4\" is not a corner such as 1, 1/2 or 1/2/3",
                "12:3: there is no normal 7, the file has 1",
                "14:5: \"z\" is not the number of a vertex",
                "15:3: there is no texture coordinate 5, the file has 0",
            ]
        );
    }

    #[test]
    fn a_hopeless_file_is_reported_briefly() {
        let found = problems(&"f 1 2 3\n".repeat(1000));
        assert_eq!(found.len(), MAX_PROBLEMS + 1);
        assert_eq!(found[MAX_PROBLEMS], "0:0: 980 more problems in this file");
        assert_eq!(problems(SQUARE), ["0:0: the file has no faces"]);
        assert_eq!(problems(""), ["0:0: the file has no faces"]);
    }

    #[test]
    fn any_bytes_are_read_or_refused_without_panic() {
        let pieces: [&[u8]; 12] = [
            b"v",
            b" 1",
            b"\n",
            b"f ",
            b"/",
            b"\\\n",
            b"-1",
            b"#",
            b"\xff",
            b"vn 0 0 1\n",
            b"\r",
            b"v 1 2 3\n",
        ];
        let mut state = 1_u64;
        for _ in 0..20_000 {
            let mut text = Vec::new();
            for _ in 0..12 {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
                text.extend_from_slice(pieces[(state >> 33) as usize % pieces.len()]);
            }
            let _ = Obj::parse(&text, &Cancel::default());
        }
    }
}
