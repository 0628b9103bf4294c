//! Wavefront OBJ to positions, normals, texture coordinates and triangles by index. Groups and curves are not
//! read; materials are kept by name.
//!
//! Our own reader, because errors must name the line. Two passes over the bytes: the first counts, so that the
//! second allocates once and can check every index where it stands.

use foton_math::glam::{DVec2, DVec3};

use crate::diagnostic::Place;

/// More problems than these in one file are only counted.
const MOST_PROBLEMS: usize = 20;

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
}

/// A corner of a face.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Corner {
    /// Index of the position, from 0.
    pub(crate) position: u32,
    /// Number of the texture coordinate, from 1; 0: none.
    pub(crate) texture: u32,
    /// Number of the normal, from 1; 0: none.
    pub(crate) normal: u32,
}

/// What is wrong, and where.
pub(crate) type Problem = (Place, String);

impl Obj {
    /// Reads a file. Faces with more than three corners become fans, as in Mitsuba 3.
    ///
    /// # Errors
    /// All problems of the file, at most [`MOST_PROBLEMS`] of them one by one.
    pub(crate) fn parse(bytes: &[u8]) -> Result<Self, Vec<Problem>> {
        if u32::try_from(bytes.len()).is_err() {
            return Err(vec![(Place::default(), "the file is larger than 4 GiB".to_owned())]);
        }
        let totals = Totals::count(bytes);
        let mut parser = Parser {
            totals,
            face: Vec::new(),
            problems: Vec::new(),
            obj: Self {
                positions: Vec::with_capacity(totals.positions),
                normals: Vec::with_capacity(totals.normals),
                textures: Vec::with_capacity(totals.textures),
                triangles: Vec::with_capacity(totals.faces),
                libraries: Vec::new(),
                materials: Vec::new(),
            },
        };
        let mut unlisted = 0;
        let mut words = Words::new(bytes);
        while words.next_line() {
            if let Err(problem) = parser.line(&mut words) {
                if parser.problems.len() < MOST_PROBLEMS {
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
        parser.obj.drop_zero_normals();
        if parser.problems.is_empty() { Ok(parser.obj) } else { Err(parser.problems) }
    }
}

impl Obj {
    /// Corners whose normal is zero have none.
    fn drop_zero_normals(&mut self) {
        for corner in self.triangles.iter_mut().flatten().filter(|c| c.normal != 0) {
            if self.normals[corner.normal as usize - 1].try_normalize().is_none() {
                corner.normal = 0;
            }
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
    fn count(bytes: &[u8]) -> Self {
        let mut totals = Self::default();
        let mut words = Words::new(bytes);
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
                let normal = vector(keyword, words);
                self.obj.normals.push(normal.as_ref().map_or(DVec3::Z, |n| *n));
                normal.map(|_| ())
            }
            b"vt" => {
                let texture = texture_coordinate(keyword, words);
                self.obj.textures.push(texture.as_ref().map_or(DVec2::ZERO, |t| *t));
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
            return Err((keyword.place, "a face needs three corners, not 0".to_owned()));
        };
        if rest.len() < 2 {
            return Err((keyword.place, format!("a face needs three corners, not {}", self.face.len())));
        }
        self.obj.triangles.extend(rest.windows(2).map(|pair| [*first, pair[0], pair[1]]));
        Ok(())
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

/// The three finite numbers after a keyword; more are ignored.
pub(crate) fn vector(keyword: Word<'_>, words: &mut Words<'_>) -> Result<DVec3, Problem> {
    let mut v = [0.0; 3];
    for (count, number) in v.iter_mut().enumerate() {
        let Some(word) = words.next() else {
            let name = shown(keyword.text);
            return Err((keyword.place, format!("\"{name}\" needs three numbers, not {count}")));
        };
        *number = finite(word)?;
    }
    Ok(DVec3::from_array(v))
}

/// One or two finite numbers after a keyword, the second 0 if it is missing; more are ignored.
fn texture_coordinate(keyword: Word<'_>, words: &mut Words<'_>) -> Result<DVec2, Problem> {
    let u = words.next().ok_or_else(|| (keyword.place, "\"vt\" needs two numbers, not 0".to_owned()))?;
    Ok(DVec2::new(finite(u)?, words.next().map_or(Ok(0.0), finite)?))
}

fn finite(word: Word<'_>) -> Result<f64, Problem> {
    let quality = match std::str::from_utf8(word.text).ok().and_then(|t| t.parse::<f64>().ok()) {
        Some(value) if value.is_finite() => return Ok(value),
        Some(_) => "finite number",
        None => "number",
    };
    Err((word.place, format!("\"{}\" is not a {quality}", shown(word.text))))
}

/// The beginning of a word as it may stand in a message.
pub(crate) fn shown(text: &[u8]) -> String {
    text[..text.len().min(40)].escape_ascii().to_string()
}

/// A word and its place.
#[derive(Clone, Copy)]
pub(crate) struct Word<'a> {
    pub(crate) text: &'a [u8],
    pub(crate) place: Place,
}

/// The words of each line. Comments are skipped, and a backslash at the end of a line continues it.
pub(crate) struct Words<'a> {
    bytes: &'a [u8],
    at: usize,
    line: u32,
    line_start: usize,
    started: bool,
}

impl<'a> Words<'a> {
    pub(crate) fn new(bytes: &'a [u8]) -> Self {
        let bom = b"\xEF\xBB\xBF";
        Self {
            bytes: bytes.strip_prefix(bom).unwrap_or(bytes),
            at: 0,
            line: 1,
            line_start: 0,
            started: false,
        }
    }

    /// Goes to the beginning of the next line; whether there is one.
    pub(crate) fn next_line(&mut self) -> bool {
        if self.started {
            while self.next().is_some() {}
            self.at += 1;
            self.line += 1;
            self.line_start = self.at;
        }
        self.started = true;
        self.at < self.bytes.len()
    }

    /// The next word of this line.
    pub(crate) fn next(&mut self) -> Option<Word<'a>> {
        loop {
            match *self.bytes.get(self.at)? {
                b'\n' => return None,
                b'#' => {
                    let rest = &self.bytes[self.at..];
                    self.at += rest.iter().position(|&b| b == b'\n').unwrap_or(rest.len());
                }
                b'\\' if self.continuation() > 0 => {
                    self.at += self.continuation();
                    self.line += 1;
                    self.line_start = self.at;
                }
                b if b.is_ascii_whitespace() => self.at += 1,
                _ => break,
            }
        }
        let start = self.at;
        while let Some(&b) = self.bytes.get(self.at) {
            if b.is_ascii_whitespace() || (b == b'\\' && self.continuation() > 0) {
                break;
            }
            self.at += 1;
        }
        let column = u32::try_from(start - self.line_start + 1).unwrap_or(0);
        Some(Word { text: &self.bytes[start..self.at], place: Place { line: self.line, column } })
    }

    /// What is left of this line as one text, white space around it removed.
    pub(crate) fn rest_of_line(&mut self) -> String {
        let rest = &self.bytes[self.at..];
        let length = rest.iter().position(|&b| b == b'\n').unwrap_or(rest.len());
        self.at += length;
        String::from_utf8_lossy(&rest[..length]).trim().to_owned()
    }

    /// The length of a backslash with the end of line after it, or 0.
    fn continuation(&self) -> usize {
        match &self.bytes[self.at + 1..] {
            [b'\n', ..] => 2,
            [b'\r', b'\n', ..] => 3,
            _ => 0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Obj {
        Obj::parse(text.as_bytes()).map_err(|p| format!("{p:?}")).unwrap()
    }

    fn problems(text: &str) -> Vec<String> {
        let problems = Obj::parse(text.as_bytes()).err().unwrap_or_default();
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
                "6:1: a face needs three corners, not 2",
                "7:1: a face needs three corners, not 0",
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
        assert_eq!(found.len(), MOST_PROBLEMS + 1);
        assert_eq!(found[MOST_PROBLEMS], "0:0: 980 more problems in this file");
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
            let _ = Obj::parse(&text);
        }
    }
}
