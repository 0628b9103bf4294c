//! Parameters of directives: typed lists such as `"float fov" 45`, asked for by name.
//!
//! What nothing asks for is a warning, as in pbrt. Of two parameters with a name the last holds.

use std::cell::{Cell, RefCell};
use std::collections::BTreeSet;
use std::rc::Rc;

use foton_input::quoted;
use foton_math::glam::{DVec2, DVec3};

use super::texture::Picture;
use crate::diagnostic::{Place, Report};
use crate::mitsuba::read::properties::Located;
use crate::spelling::{did_you_mean, nearest};

/// The type of a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Integer,
    Float,
    Point2,
    Point3,
    Normal,
    Rgb,
    Xyz,
    Blackbody,
    Spectrum,
    Bool,
    Text,
    Texture,
}

/// Names of types, in both versions.
const KINDS: [(&str, Kind); 18] = [
    ("integer", Kind::Integer),
    ("float", Kind::Float),
    ("point2", Kind::Point2),
    ("vector2", Kind::Point2),
    ("point3", Kind::Point3),
    ("vector3", Kind::Point3),
    ("point", Kind::Point3),
    ("vector", Kind::Point3),
    ("normal3", Kind::Normal),
    ("normal", Kind::Normal),
    ("rgb", Kind::Rgb),
    ("color", Kind::Rgb),
    ("xyz", Kind::Xyz),
    ("blackbody", Kind::Blackbody),
    ("spectrum", Kind::Spectrum),
    ("bool", Kind::Bool),
    ("string", Kind::Text),
    ("texture", Kind::Texture),
];

/// Types of colours, textures apart.
pub(crate) const COLOURS: &[Kind] = &[Kind::Rgb, Kind::Xyz, Kind::Blackbody, Kind::Spectrum];

impl Kind {
    /// The type of that name; otherwise what is nearest, for a message.
    pub(crate) fn of(name: &str) -> Result<Self, String> {
        let found = KINDS.iter().find(|(known, _)| *known == name);
        found.map(|(_, kind)| *kind).ok_or_else(|| {
            let hint = did_you_mean(name, KINDS.iter().map(|(known, _)| *known));
            format!("{} is no type of a parameter{hint}", quoted(name))
        })
    }

    const fn said(self) -> &'static str {
        match self {
            Self::Integer => "integer",
            Self::Float => "float",
            Self::Point2 => "point2",
            Self::Point3 => "point3",
            Self::Normal => "normal",
            Self::Rgb => "rgb",
            Self::Xyz => "xyz",
            Self::Blackbody => "blackbody",
            Self::Spectrum => "spectrum",
            Self::Bool => "bool",
            Self::Text => "string",
            Self::Texture => "texture",
        }
    }
}

/// What a parameter says.
#[derive(Clone, Debug)]
pub(crate) enum Values {
    Numbers(Vec<f64>),
    Texts(Vec<Located<String>>),
    Booleans(Vec<bool>),
}

/// A parameter.
#[derive(Clone, Debug)]
pub(crate) struct Parameter {
    pub(crate) kind: Kind,
    pub(crate) name: String,
    /// Of its declaration, and of its first value.
    pub(crate) place: Place,
    pub(crate) value_place: Place,
    pub(crate) values: Values,
    /// What a texture's name stood for when it was read: of numbers, and of colours.
    pub(crate) pictures: [Option<Rc<Picture>>; 2],
    /// Whether something asked for it, or it is a default of another statement.
    pub(crate) used: Cell<bool>,
}

/// Parameters of a statement.
#[derive(Clone, Debug, Default)]
pub(crate) struct Parameters {
    /// The plugin that the statement names, and where.
    pub(crate) plugin: String,
    pub(crate) place: Place,
    pub(crate) list: Vec<Parameter>,
    asked: RefCell<BTreeSet<&'static str>>,
}

impl Parameters {
    pub(crate) fn new(plugin: String, place: Place, list: Vec<Parameter>) -> Self {
        Self { plugin, place, list, asked: RefCell::default() }
    }

    /// Whether there is a parameter of that name, which stays unused.
    pub(crate) fn has(&self, name: &str) -> bool {
        self.list.iter().any(|p| p.name == name)
    }

    /// The parameter of that name, if it is of one of these types; an error where it is of another.
    pub(crate) fn find(&self, name: &'static str, kinds: &[Kind], report: &mut Report) -> Option<&Parameter> {
        self.asked.borrow_mut().insert(name);
        let found = self.list.iter().rfind(|p| p.name == name)?;
        self.list.iter().filter(|p| p.name == name).for_each(|p| p.used.set(true));
        if kinds.contains(&found.kind) {
            return Some(found);
        }
        let wanted: Vec<&str> = kinds.iter().map(|kind| kind.said()).collect();
        let message =
            format!("\"{name}\" is a {} here, it must be a {}", found.kind.said(), wanted.join(" or "));
        report.error(found.place, message);
        None
    }

    /// Goes over parameters that have no effect here.
    pub(crate) fn ignore(&self, names: &[&'static str]) {
        self.asked.borrow_mut().extend(names);
        self.list.iter().filter(|p| names.contains(&p.name.as_str())).for_each(|p| p.used.set(true));
    }

    /// Goes over all that is left.
    pub(crate) fn ignore_rest(&self) {
        self.list.iter().for_each(|p| p.used.set(true));
    }

    /// Warns of what nothing asked for.
    pub(crate) fn finish(&self, report: &mut Report) {
        let asked = self.asked.borrow();
        for unused in self.list.iter().filter(|p| !p.used.replace(true)) {
            let near = nearest(&unused.name, asked.iter().copied());
            let hint = near.map_or_else(String::new, |near| format!(", did you mean \"{near}\"?"));
            let (name, plugin) = (quoted(&unused.name), quoted(&self.plugin));
            report.warning(unused.place, format!("the parameter {name} of {plugin} is unused{hint}"));
        }
    }

    /// Numbers of a parameter.
    pub(crate) fn numbers(&self, name: &'static str, kinds: &[Kind], report: &mut Report) -> Option<&[f64]> {
        match &self.find(name, kinds, report)?.values {
            Values::Numbers(numbers) => Some(numbers),
            _ => None,
        }
    }

    /// A number.
    pub(crate) fn number(&self, name: &'static str, report: &mut Report) -> Option<Located<f64>> {
        let found = self.find(name, &[Kind::Float, Kind::Integer], report)?;
        let Values::Numbers(numbers) = &found.values else { return None };
        if numbers.len() == 1 {
            return Some(Located { value: numbers[0], place: found.value_place });
        }
        report.error(found.place, format!("\"{name}\" is one number, not {}", numbers.len()));
        None
    }

    /// A number, or what it is where nothing is said.
    pub(crate) fn number_or(&self, name: &'static str, default: f64, report: &mut Report) -> f64 {
        self.number(name, report).map_or(default, |n| n.value)
    }

    /// A number above zero, or what it is where nothing is said.
    pub(crate) fn above_zero(&self, name: &'static str, default: f64, report: &mut Report) -> f64 {
        match self.number(name, report) {
            Some(n) if n.value > 0.0 => n.value,
            Some(n) => {
                report.error(n.place, format!("\"{name}\" must be above zero"));
                default
            }
            None => default,
        }
    }

    /// A whole number.
    pub(crate) fn integer(&self, name: &'static str, report: &mut Report) -> Option<Located<i64>> {
        let Located { value, place } = self.number(name, report)?;
        if value.fract() == 0.0 && value.abs() < 1e15 {
            #[allow(clippy::cast_possible_truncation, reason = "it is a whole number of few digits")]
            return Some(Located { value: value as i64, place });
        }
        report.error(place, format!("\"{name}\" must be a whole number"));
        None
    }

    /// Whole numbers from 0, for vertices.
    pub(crate) fn indices(&self, name: &'static str, report: &mut Report) -> Option<Vec<u32>> {
        let found = self.find(name, &[Kind::Integer], report)?;
        let Values::Numbers(numbers) = &found.values else { return None };
        let index =
            |n: &f64| (n.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(n)).then_some(*n as u32);
        let indices: Option<Vec<u32>> = numbers.iter().map(index).collect();
        if indices.is_none() {
            report.error(found.place, format!("\"{name}\" must be whole numbers from 0"));
        }
        indices
    }

    pub(crate) fn boolean(&self, name: &'static str, report: &mut Report) -> Option<bool> {
        let found = self.find(name, &[Kind::Bool], report)?;
        match &found.values {
            Values::Booleans(values) if values.len() == 1 => Some(values[0]),
            _ => {
                report.error(found.place, format!("\"{name}\" is one of true and false"));
                None
            }
        }
    }

    pub(crate) fn text(&self, name: &'static str, report: &mut Report) -> Option<Located<String>> {
        let found = self.find(name, &[Kind::Text], report)?;
        match &found.values {
            Values::Texts(texts) if texts.len() == 1 => Some(texts[0].clone()),
            _ => {
                report.error(found.place, format!("\"{name}\" is one text in quotes"));
                None
            }
        }
    }

    /// Points, vectors or normals.
    pub(crate) fn points(&self, name: &'static str, report: &mut Report) -> Option<Vec<DVec3>> {
        let found = self.find(name, &[Kind::Point3, Kind::Normal], report)?;
        let Values::Numbers(numbers) = &found.values else { return None };
        let (points, odd) = numbers.as_chunks::<3>();
        if !odd.is_empty() {
            report.error(
                found.place,
                format!("\"{name}\" has {} numbers, no multiple of three", numbers.len()),
            );
            return None;
        }
        Some(points.iter().map(|p| DVec3::from_array(*p)).collect())
    }

    /// One point.
    pub(crate) fn point(&self, name: &'static str, report: &mut Report) -> Option<Located<DVec3>> {
        let points = self.points(name, report)?;
        let place = self.list.iter().rfind(|p| p.name == name)?.value_place;
        match points[..] {
            [value] => Some(Located { value, place }),
            _ => {
                report.error(place, format!("\"{name}\" is one point, not {}", points.len()));
                None
            }
        }
    }

    /// Points of the plane: files of version 3 may have them as plain numbers.
    pub(crate) fn points2(&self, name: &'static str, report: &mut Report) -> Option<Vec<DVec2>> {
        let found = self.find(name, &[Kind::Point2, Kind::Float], report)?;
        let Values::Numbers(numbers) = &found.values else { return None };
        let (points, odd) = numbers.as_chunks::<2>();
        if !odd.is_empty() {
            report
                .error(found.place, format!("\"{name}\" has {} numbers, no multiple of two", numbers.len()));
            return None;
        }
        Some(points.iter().map(|p| DVec2::from_array(*p)).collect())
    }

    /// Where the value of a parameter stands, or the statement.
    pub(crate) fn place_of(&self, name: &str) -> Place {
        self.list.iter().rfind(|p| p.name == name).map_or(self.place, |p| p.value_place)
    }
}
