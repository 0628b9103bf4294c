//! OFF files, as text: vertices and polygons, with colours of either, normals and texture coordinates where the first word says so.
//!
//! The first word is `OFF` behind letters for what vertices have (`ST`, `C`, `N`); it may be missing. Colours in whole numbers are
//! sRGB from 0 to 255, others linear from 0 to 1; one number alone is the index of a table that the file does not have. Lines end
//! faces, nothing else.

use std::sync::Arc;

use foton_math::glam::{DVec2, DVec3};
use foton_scene::description::{Attribute, Mesh};

use super::normals;
use super::polygons::Polygons;
use super::tally::Tally;
use super::wanted::Parsed;
use super::words::{Problem, Word, Words, parsed, shown, unread};
use crate::diagnostic::Place;
use crate::mitsuba::read::values::srgb_to_linear;
use crate::watch::Watch;

/// The least bytes of a vertex, `0 0 0` and what ends it, and of a face.
const VERTEX: usize = 6;
const FACE: usize = 2;

/// The colour of a face that states none, where others do.
const GREY: [f32; 3] = [0.5; 3];

/// What vertices have beside their position, as the first word says.
#[derive(Clone, Copy, Default)]
struct Has {
    normals: bool,
    colours: bool,
    coordinates: bool,
}

/// Reads a file. Triangles are in the order of its faces.
///
/// # Errors
/// The first problem, with its place.
pub(crate) fn parse(bytes: &[u8], watch: Watch<'_>) -> Parsed {
    let mut reader = Reader { words: Words::new(bytes, watch), last: Place::default(), waiting: None };
    let has = reader.header()?;
    let [vertices, faces] = [reader.count("vertices")?, reader.count("faces")?];
    // How many edges there are says nothing, and is missing in some files.
    reader.words.rest_of_line();
    if vertices > bytes.len() / VERTEX + 1 || faces > bytes.len() / FACE + 1 {
        let message = format!("{vertices} vertices and {faces} faces are not in {} bytes", bytes.len());
        return Err((reader.last, message));
    }
    let mut mesh = Mesh::default();
    let mut colours = Vec::new();
    for _ in 0..vertices {
        reader.vertex(has, &mut mesh, &mut colours)?;
    }
    let mut of_faces = Vec::new();
    let mut polygons = Polygons::default();
    let mut small = Tally::default();
    for _ in 0..faces {
        reader.face(&mut mesh, &mut of_faces, &mut polygons, &mut small)?;
    }
    watch.check().map_err(unread)?;
    if mesh.triangles.is_empty() {
        return Err((Place::default(), "the file has no faces".to_owned()));
    }
    let Mesh { positions, triangles, .. } = &mut mesh;
    let mended = polygons.mend(triangles, |i: u32| positions[i as usize], watch.cancel());
    let mut gone = mended.gone.iter().copied().peekable();
    let mut at = 0;
    of_faces.retain(|_| {
        at += 1;
        gone.next_if_eq(&(at - 1)).is_none()
    });
    if has.colours {
        mesh.attributes.push(attribute("vertex_color", colours.into_iter()));
    } else if of_faces.iter().any(Option::is_some) {
        let colours = of_faces.into_iter().map(|colour| colour.unwrap_or(GREY));
        mesh.attributes.push(attribute("face_color", colours));
    }
    let mut warnings: Vec<Problem> = mended.warnings().collect();
    warnings.extend(small.warning("face has", "faces have", "fewer than three corners and no area"));
    warnings.extend(normals::mend(&mut mesh, watch.cancel()));
    Ok((mesh, warnings))
}

fn attribute(name: &str, colours: impl Iterator<Item = [f32; 3]>) -> Attribute {
    let values: Arc<[f32]> = colours.flatten().collect();
    Attribute { name: name.to_owned(), channels: 3, values }
}

struct Reader<'a> {
    words: Words<'a>,
    /// Where the last word was.
    last: Place,
    /// A word that was read and is to come again.
    waiting: Option<Word<'a>>,
}

impl<'a> Reader<'a> {
    /// The next word, on this line or a later one.
    fn word(&mut self, what: &str) -> Result<Word<'a>, Problem> {
        if let Some(word) = self.waiting.take() {
            return Ok(word);
        }
        loop {
            if let Some(word) = self.words.next() {
                self.last = word.place;
                return Ok(word);
            }
            if !self.words.next_line() {
                return Err((self.last, format!("the file ends where {what} should follow")));
            }
        }
    }

    fn number(&mut self, what: &str) -> Result<f64, Problem> {
        let word = self.word(what)?;
        parsed(word.text).ok_or_else(|| (word.place, format!("\"{}\" is not a number", shown(word.text))))
    }

    fn numbers<const N: usize>(&mut self, what: &str) -> Result<[f64; N], Problem> {
        let mut numbers = [0.0; N];
        for number in &mut numbers {
            *number = self.number(what)?;
        }
        Ok(numbers)
    }

    fn count(&mut self, what: &str) -> Result<usize, Problem> {
        let number = self.number(&format!("the number of {what}"))?;
        if number >= 0.0 && number.fract() == 0.0 && number < f64::from(u32::MAX) {
            return Ok(number as usize);
        }
        Err((self.last, format!("{number} is no number of {what}")))
    }

    /// What vertices have, by the first word.
    fn header(&mut self) -> Result<Has, Problem> {
        self.words.next_line();
        let first = self.word("OFF")?;
        let Some(letters) = first.text.strip_suffix(b"OFF") else {
            if parsed(first.text).is_some() {
                self.waiting = Some(first);
                return Ok(Has::default());
            }
            let message = format!("an OFF file begins with \"OFF\", not with \"{}\"", shown(first.text));
            return Err((first.place, message));
        };
        let mut rest = letters;
        let mut takes = |letters: &[u8]| {
            let found = rest.strip_prefix(letters);
            rest = found.unwrap_or(rest);
            found.is_some()
        };
        let has = Has { coordinates: takes(b"ST"), colours: takes(b"C"), normals: takes(b"N") };
        if !rest.is_empty() {
            let message = format!("\"{}\" is not read: vertices have three coordinates", shown(first.text));
            return Err((first.place, message));
        }
        let next = self.word("the number of vertices")?;
        if next.text == b"BINARY" {
            return Err((next.place, "OFF files in bytes are not read, only those in text".to_owned()));
        }
        self.waiting = Some(next);
        Ok(has)
    }

    fn vertex(&mut self, has: Has, mesh: &mut Mesh, colours: &mut Vec<[f32; 3]>) -> Result<(), Problem> {
        let position = DVec3::from_array(self.numbers("a vertex")?);
        if !position.is_finite() {
            return Err((self.last, "the position of a vertex is not finite".to_owned()));
        }
        mesh.positions.push(position);
        if has.normals {
            mesh.normals.push(DVec3::from_array(self.numbers("a normal")?));
        }
        if has.colours {
            let words = [self.word("a colour")?, self.word("a colour")?, self.word("a colour")?];
            colours.push(colour(&words)?);
            // What comes behind three numbers is an opacity, unless texture coordinates do.
            let mut behind = 0;
            while !has.coordinates && behind < 1 && self.words.next().is_some() {
                behind += 1;
            }
            if has.coordinates {
                self.word("an opacity")?;
            }
        }
        if has.coordinates {
            mesh.texture_coordinates.push(DVec2::from_array(self.numbers("a texture coordinate")?));
        }
        Ok(())
    }

    fn face(
        &mut self,
        mesh: &mut Mesh,
        colours: &mut Vec<Option<[f32; 3]>>,
        polygons: &mut Polygons,
        small: &mut Tally,
    ) -> Result<(), Problem> {
        let corners = self.count("corners")?;
        let place = self.last;
        let first = mesh.triangles.len();
        let (mut fixed, mut before) = (0, 0);
        for i in 0..corners {
            let vertex = self.number("the vertex of a face")?;
            if !(vertex >= 0.0 && vertex.fract() == 0.0 && vertex < mesh.positions.len() as f64) {
                let count = mesh.positions.len();
                return Err((self.last, format!("there is no vertex {vertex}, there are {count}, from 0")));
            }
            let vertex = vertex as u32;
            match i {
                0 => fixed = vertex,
                1 => {}
                _ => mesh.triangles.push([fixed, before, vertex]),
            }
            before = vertex;
        }
        if corners < 3 {
            small.add(|| (place, String::new()));
        }
        polygons.note(first, corners);
        let mut rest = Vec::new();
        while let Some(word) = self.words.next() {
            rest.push(word);
        }
        let colour = if rest.len() < 3 { None } else { Some(colour(&rest[..3])?) };
        colours.resize(mesh.triangles.len(), colour);
        Ok(())
    }
}

/// A colour in linear sRGB: of whole numbers by its curve.
fn colour(words: &[Word<'_>]) -> Result<[f32; 3], Problem> {
    let is_whole = words.iter().all(|w| w.text.iter().all(u8::is_ascii_digit));
    let mut channels = [0.0; 3];
    for (channel, word) in channels.iter_mut().zip(words) {
        let number = parsed(word.text).filter(|n| n.is_finite());
        let Some(number) = number else {
            return Err((word.place, format!("\"{}\" is not a number", shown(word.text))));
        };
        let linear = if is_whole { srgb_to_linear(number.clamp(0.0, 255.0) / 255.0) } else { number };
        *channel = linear.clamp(0.0, 1.0) as f32;
    }
    Ok(channels)
}

#[cfg(test)]
mod tests {
    use foton_math::Cancel;

    use super::*;

    fn read(text: &str) -> Result<Mesh, String> {
        let read = parse(text.as_bytes(), Watch::from(&Cancel::default()));
        read.map(|(mesh, _)| mesh)
            .map_err(|(place, message)| format!("{}:{}: {message}", place.line, place.column))
    }

    const SQUARE: &str = "4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

    #[test]
    fn polygons_become_triangles_with_or_without_the_first_word() {
        for head in ["OFF\n", "OFF # a comment\n# and another\n", "", "OFF "] {
            let mesh =
                read(&format!("{head}{SQUARE}4 0 1 2 3\n")).unwrap_or_else(|e| panic!("{head:?}: {e}"));
            assert_eq!((mesh.positions.len(), mesh.triangles), (4, vec![[0, 1, 2], [0, 2, 3]]), "{head:?}");
            assert!(mesh.attributes.is_empty() && mesh.normals.is_empty());
        }
    }

    #[test]
    fn colours_of_faces_are_those_of_their_triangles() {
        let text = format!(
            "OFF\n{}4 0 1 2 3 255 0 0 9\n3 0 1 2 0.5 1.0 0.25\n3 0 1 3\n",
            SQUARE.replace("4 1", "4 3")
        );
        let mesh = read(&text).expect("a file");
        let [colours] = &mesh.attributes[..] else { panic!("{:?}", mesh.attributes) };
        assert_eq!((colours.name.as_str(), mesh.triangles.len()), ("face_color", 4));
        let wanted = [1., 0., 0., 1., 0., 0., 0.5, 1., 0.25, 0.5, 0.5, 0.5];
        assert_eq!(colours.values[..], wanted);
    }

    #[test]
    fn vertices_have_what_the_first_word_says() {
        let text = "STCNOFF\n3 1 0\n0 0 0  0 0 1  255 255 255 255  0 0\n1 0 0  0 0 1  0 0 0 255  1 0\n\
                    0 1 0  0 0 1  255 0 0 255  0 1\n3 0 1 2\n";
        let mesh = read(text).expect("a file");
        assert_eq!((mesh.normals, mesh.texture_coordinates[2]), (vec![DVec3::Z; 3], DVec2::Y));
        assert_eq!(mesh.attributes[0].name, "vertex_color");
        assert_eq!(mesh.attributes[0].values[..], [1., 1., 1., 0., 0., 0., 1., 0., 0.]);
        let without = "COFF\n3 1 0\n0 0 0 1.0 0 0\n1 0 0 1.0 0 0 0.5\n0 1 0 1.0 0 0\n3 0 1 2\n";
        assert_eq!(read(without).expect("a file").attributes[0].values[..3], [1., 0., 0.]);
    }

    #[test]
    fn faults_are_named_with_their_place() {
        for (text, said) in [
            ("", "0:0: the file ends where OFF should follow"),
            ("ply", "1:1: an OFF file begins with \"OFF\", not with \"ply\""),
            ("4OFF 1 1 1", "1:1: \"4OFF\" is not read: vertices have three coordinates"),
            ("OFF BINARY\n", "1:5: OFF files in bytes are not read, only those in text"),
            ("OFF\n3 1000000 0\n", "2:3: 3 vertices and 1000000 faces are not in 16 bytes"),
            ("OFF\n1 1 0\n0 0 x\n", "3:5: \"x\" is not a number"),
            ("OFF\n1 1 0\n0 0 inf\n", "3:5: the position of a vertex is not finite"),
            ("OFF\n1 1 0\n0 0 0\n3 0 1 0\n", "4:5: there is no vertex 1, there are 1, from 0"),
            ("OFF\n1 1 0\n0 0 0\n3 0 0", "4:5: the file ends where the vertex of a face should follow"),
            ("OFF\n1 0 0\n0 0 0\n", "0:0: the file has no faces"),
        ] {
            assert_eq!(read(text).err().as_deref(), Some(said), "{text:?}");
        }
    }
}
