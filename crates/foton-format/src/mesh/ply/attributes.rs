//! What a PLY file states of its vertices and faces beyond their geometry: properties to attributes, as Mitsuba 3 names them.
//!
//! `r`, `g`, `b` or `red`, `green`, `blue` are a colour, and so are `name_r`, `name_g`, `name_b`; `name_x` to `name_z`, `name_0` to
//! `name_2`, or one of the two sorts alone, are numbers. Colours in whole numbers are sRGB, as scanners and editors write them.

use foton_scene::description::Attribute;

use super::header::{Element, Kind, Number, Property};
use crate::mitsuba::read::values::srgb_to_linear;

/// What properties of an element become attributes, and their values so far.
#[derive(Default)]
pub(super) struct Attributes {
    found: Vec<Found>,
    /// By property, the attribute and the channel that it states.
    places: Vec<Option<(usize, usize)>>,
}

/// An attribute, and how its numbers are stored.
struct Found {
    name: String,
    numbers: Vec<Option<Number>>,
    is_colour: bool,
    values: Vec<f32>,
}

impl Attributes {
    /// What an element of that prefix, `vertex` or `face`, states; `is_taken` tells properties that mean something else.
    pub(super) fn of(element: &Element, prefix: &str, is_taken: impl Fn(&Property) -> bool) -> Self {
        let mut all = Self { found: Vec::new(), places: vec![None; element.properties.len()] };
        for (i, property) in element.properties.iter().enumerate() {
            let Kind::Scalar(number) = property.kind else { continue };
            if let Some((name, is_colour, channel)) = meaning(&property.name).filter(|_| !is_taken(property))
            {
                let name = format!("{prefix}_{name}");
                let known = all.found.iter().position(|f| f.name == name && f.is_colour == is_colour);
                let index = known.unwrap_or_else(|| {
                    all.found.push(Found { name, numbers: vec![None; 3], is_colour, values: Vec::new() });
                    all.found.len() - 1
                });
                all.found[index].numbers[channel] = Some(number);
                all.places[i] = Some((index, channel));
            }
        }
        // Three channels, or the first alone.
        for (index, found) in all.found.iter_mut().enumerate() {
            match found.numbers[..] {
                [Some(_), Some(_), Some(_)] => {}
                [Some(_), None, None] => found.numbers.truncate(1),
                _ => {
                    found.numbers.clear();
                    all.places
                        .iter_mut()
                        .filter(|p| p.is_some_and(|(i, _)| i == index))
                        .for_each(|p| *p = None);
                }
            }
        }
        all
    }

    /// Whether there are none.
    pub(super) fn is_empty(&self) -> bool {
        self.places.iter().all(Option::is_none)
    }

    /// Makes room for the values of one vertex or face.
    pub(super) fn begin(&mut self) {
        for found in &mut self.found {
            found.values.resize(found.values.len() + found.numbers.len(), 0.0);
        }
    }

    /// Notes the number of a property of the vertex or face begun last.
    pub(super) fn set(&mut self, property: usize, number: f64) {
        let Some((index, channel)) = self.places[property] else { return };
        let found = &mut self.found[index];
        let value = match found.numbers[channel].and_then(most) {
            Some(most) if found.is_colour => srgb_to_linear(number / most),
            _ => number,
        };
        let at = found.values.len() - found.numbers.len() + channel;
        found.values[at] = if (value as f32).is_finite() { value as f32 } else { 0.0 };
    }

    /// The attributes of some of the vertices or faces, by their numbers in the file, in another order.
    pub(super) fn pick(self, numbers: impl Iterator<Item = usize> + Clone) -> Vec<Attribute> {
        let of = |found: Found| {
            let channels = found.numbers.len();
            let one =
                |i: usize| found.values.get(i * channels..(i + 1) * channels).unwrap_or(&ZEROS[..channels]);
            let values = numbers.clone().flat_map(one).copied().collect();
            Attribute { name: found.name, channels, values }
        };
        self.found.into_iter().filter(|f| !f.numbers.is_empty()).map(of).collect()
    }

    /// The attributes of all vertices.
    pub(super) fn all(self) -> Vec<Attribute> {
        let of = |f: Found| Attribute { name: f.name, channels: f.numbers.len(), values: f.values.into() };
        self.found.into_iter().filter(|f| !f.numbers.is_empty()).map(of).collect()
    }
}

/// What triangles have that no face of the file states.
const ZEROS: [f32; 3] = [0.0; 3];

/// The attribute that a property belongs to, whether it is a colour, and which channel it is.
fn meaning(property: &str) -> Option<(String, bool, usize)> {
    const COLOURS: [[&str; 3]; 2] = [["r", "g", "b"], ["red", "green", "blue"]];
    const NUMBERS: [[&str; 3]; 2] = [["x", "y", "z"], ["0", "1", "2"]];
    let channel =
        |names: &[[&str; 3]], name: &str| names.iter().find_map(|n| n.iter().position(|n| *n == name));
    if let Some(i) = channel(&COLOURS, property) {
        return Some(("color".to_owned(), true, i));
    }
    let (name, end) = property.rsplit_once('_').filter(|(name, _)| !name.is_empty())?;
    let of_colour = channel(&COLOURS[..1], end).map(|i| (format!("{name}_color"), true, i));
    // Mitsuba writes a mesh's colours with numbers.
    of_colour.or_else(|| channel(&NUMBERS, end).map(|i| (name.to_owned(), name == "color", i)))
}

/// The largest number of a type of whole ones.
fn most(number: Number) -> Option<f64> {
    match number {
        Number::I8 => Some(f64::from(i8::MAX)),
        Number::U8 => Some(f64::from(u8::MAX)),
        Number::I16 => Some(f64::from(i16::MAX)),
        Number::U16 => Some(f64::from(u16::MAX)),
        Number::I32 => Some(f64::from(i32::MAX)),
        Number::U32 => Some(f64::from(u32::MAX)),
        Number::F32 | Number::F64 => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn properties_mean_what_they_mean_in_mitsuba() {
        let of = |name: &str| meaning(name).map(|(name, is_colour, i)| format!("{name} {is_colour} {i}"));
        for (property, wanted) in [
            ("green", "color true 1"),
            ("b", "color true 2"),
            ("foo_r", "foo_color true 0"),
            ("a_b_y", "a_b false 1"),
            ("foo_2", "foo false 2"),
            ("color_1", "color true 1"),
        ] {
            assert_eq!(of(property).as_deref(), Some(wanted), "{property}");
        }
        for property in ["x", "quality", "alpha", "foo_w", "_r"] {
            assert_eq!(of(property), None, "{property}");
        }
    }
}
