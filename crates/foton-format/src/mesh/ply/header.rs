//! The header of a PLY file: what stands in which order after it.

use foton_input::quoted;

use crate::diagnostic::Place;
use crate::mesh::tally::Tally;
use crate::mesh::words::{Problem, shown};

/// What a file says about itself.
pub(super) struct Header {
    pub(super) encoding: Encoding,
    pub(super) elements: Vec<Element>,
    /// How many vertices there are, fewer than 2³².
    pub(super) vertices: u64,
    /// Its bytes, end of the last line included.
    pub(super) length: usize,
    /// Its lines.
    pub(super) lines: u32,
    /// What its lines end in: `\n`, or `\r` on systems of long ago.
    pub(super) line_end: u8,
    /// Lines that begin with no word of a header: they belong to the one before.
    pub(super) wrapped: Tally,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Encoding {
    Ascii,
    LittleEndian,
    BigEndian,
}

/// A list of things of one kind.
pub(super) struct Element {
    pub(super) name: String,
    pub(super) count: u64,
    pub(super) properties: Vec<Property>,
}

/// What each thing of a list states.
pub(super) struct Property {
    pub(super) name: String,
    pub(super) kind: Kind,
}

impl Property {
    /// Whether it lists the corners of a face.
    pub(super) fn is_corners(&self) -> bool {
        matches!(self.kind, Kind::List { .. }) && matches!(&*self.name, "vertex_indices" | "vertex_index")
    }

    /// Whether it lists a texture coordinate for each corner of a face.
    pub(super) fn is_corner_textures(&self) -> bool {
        matches!(self.kind, Kind::List { .. }) && matches!(&*self.name, "texcoord" | "texcoords")
    }
}

#[derive(Clone, Copy, Debug)]
pub(super) enum Kind {
    Scalar(Number),
    List { count: Number, item: Number },
}

/// How a number is stored.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Number {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Number {
    fn named(name: &str) -> Option<Self> {
        Some(match name {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return None,
        })
    }

    /// Bytes in a binary file.
    pub(super) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    fn is_whole(self) -> bool {
        !matches!(self, Self::F32 | Self::F64)
    }
}

impl Header {
    /// Reads the lines up to `end_header`.
    pub(super) fn parse(bytes: &[u8]) -> Result<Self, Problem> {
        let mut header = Self {
            encoding: Encoding::Ascii,
            elements: Vec::new(),
            vertices: 0,
            length: 0,
            lines: 0,
            line_end: line_end(bytes),
            wrapped: Tally::default(),
        };
        let mut encoding = None;
        // A statement that says too little by itself, how many lines it may go on, and what was wrong with it.
        let mut unfinished: Option<(Vec<String>, u32, Problem)> = None;
        let mut is_comment = false;
        loop {
            let (place, line) = header.line(bytes)?;
            let text = String::from_utf8_lossy(line);
            let mut words: Vec<String> = text.split_ascii_whitespace().map(str::to_owned).collect();
            if header.lines == 1 && words != ["ply"] {
                return Err((place, NO_PLY.to_owned()));
            }
            let begins = words.first().is_none_or(|word| KEYWORDS.contains(&word.as_str()));
            let (mut problem, mut may_go_on) = ((place, misunderstood(line)), MAX_WRAPS);
            match unfinished.take() {
                Some((before, left, first)) if !begins && left > 0 => {
                    words = [before, words].concat();
                    (problem, may_go_on) = (first, left - 1);
                    header.wrapped.add(|| (place, String::new()));
                }
                Some((_, _, problem)) => return Err(problem),
                None if !begins && is_comment => {
                    header.wrapped.add(|| (place, String::new()));
                    continue;
                }
                None if !begins => return Err(problem),
                None => {
                    is_comment = words.first().is_some_and(|word| word == "comment" || word == "obj_info");
                }
            }
            if words == ["end_header"] {
                break;
            }
            let words_read: Vec<&str> = words.iter().map(String::as_str).collect();
            if let Err(message) = header.statement(&words_read, &mut encoding) {
                problem.1 = message.unwrap_or(problem.1);
                unfinished = Some((words, may_go_on, problem));
            }
        }
        let place = Place { line: header.lines, column: 0 };
        header.encoding = encoding.ok_or_else(|| (place, "the header has no \"format\" line".to_owned()))?;
        header.check().map_err(|message| (place, message.to_owned()))?;
        Ok(header)
    }

    /// The next line and its place.
    fn line<'a>(&mut self, bytes: &'a [u8]) -> Result<(Place, &'a [u8]), Problem> {
        let rest = &bytes[self.length..];
        self.lines += 1;
        let place = Place { line: self.lines, column: 0 };
        let Some(end) = rest.iter().position(|&b| b == self.line_end) else {
            let message = if self.lines == 1 { NO_PLY } else { "the file ends inside its header" };
            return Err((place, message.to_owned()));
        };
        self.length += end + 1;
        Ok((place, &rest[..end]))
    }

    /// One statement; an error with no message is one that is not understood.
    fn statement(&mut self, words: &[&str], encoding: &mut Option<Encoding>) -> Result<(), Option<String>> {
        let number =
            |name: &str| Number::named(name).ok_or_else(|| Some(format!("unknown type {}", quoted(name))));
        match *words {
            [] | ["ply" | "comment" | "obj_info", ..] => {}
            ["format", name, _version] => {
                *encoding = Some(match name {
                    "ascii" => Encoding::Ascii,
                    "binary_little_endian" => Encoding::LittleEndian,
                    "binary_big_endian" => Encoding::BigEndian,
                    _ => return Err(None),
                });
            }
            ["element", name, count] => {
                let count = count.parse().map_err(|_| None)?;
                if self.elements.len() >= MAX_ELEMENTS {
                    return Err(Some(format!("more than {MAX_ELEMENTS} elements are declared")));
                }
                if self.elements.iter().any(|e| e.name == name) {
                    return Err(Some(format!("element {} is declared twice", quoted(name))));
                }
                self.elements.push(Element { name: name.to_owned(), count, properties: Vec::new() });
            }
            ["property", "list", count, item, name] => {
                let (count, item) = (number(count)?, number(item)?);
                if !count.is_whole() {
                    return Err(Some("the length of a list must be a whole number".to_owned()));
                }
                self.property(name, Kind::List { count, item })?;
            }
            ["property", kind, name] => self.property(name, Kind::Scalar(number(kind)?))?,
            _ => return Err(None),
        }
        Ok(())
    }

    fn property(&mut self, name: &str, kind: Kind) -> Result<(), Option<String>> {
        let element = self.elements.last_mut().ok_or_else(|| Some("a property of no element".to_owned()))?;
        element.properties.push(Property { name: name.to_owned(), kind });
        Ok(())
    }

    /// Whether there are vertices and faces, and what they need.
    fn check(&mut self) -> Result<(), &'static str> {
        let element = |name| self.elements.iter().find(|e| e.name == name && e.count > 0);
        let vertex = element("vertex").ok_or("the file has no vertices")?;
        let scalar =
            |name| vertex.properties.iter().any(|p| p.name == name && matches!(p.kind, Kind::Scalar(_)));
        if !["x", "y", "z"].into_iter().all(scalar) {
            return Err("a vertex needs x, y and z");
        }
        if vertex.count > u64::from(u32::MAX) {
            return Err("the file has more vertices than can be numbered");
        }
        let faces = [element("face"), element("tristrips")];
        if faces.iter().all(Option::is_none) {
            return Err("the file has no faces");
        }
        let one_list = |e: &Element| e.properties.iter().filter(|p| p.is_corners()).count() == 1;
        if !faces.into_iter().flatten().all(one_list) {
            return Err("a face needs one list \"vertex_indices\"");
        }
        self.vertices = vertex.count;
        Ok(())
    }
}

const NO_PLY: &str = "the file does not begin with \"ply\"";

/// What lines of a header begin with.
const KEYWORDS: [&str; 7] = ["ply", "format", "comment", "obj_info", "element", "property", "end_header"];

/// Kinds of things that a file lists at most; those of programs have three.
const MAX_ELEMENTS: usize = 1000;

/// A statement goes on for at most so many lines more.
const MAX_WRAPS: u32 = 4;

/// What lines end in, going by the first.
fn line_end(bytes: &[u8]) -> u8 {
    let first = bytes.iter().position(|b| matches!(b, b'\r' | b'\n'));
    match first.map(|at| &bytes[at..]) {
        Some([b'\r', b'\n', ..]) | None => b'\n',
        Some(rest) => rest[0],
    }
}

fn misunderstood(line: &[u8]) -> String {
    format!("\"{}\" is not understood in a header", shown(line.trim_ascii()))
}
