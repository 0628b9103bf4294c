//! What an inspector shows and sets: plain values with names, units, ranges and help.

use foton_scene::parameter::Parameter;

/// A number, colour, choice or switch of a shape, its material, or a light.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum FieldId {
    /// Position along a world axis, 0 to 2.
    Position(u8),
    /// Angle about a world axis, 0 to 2, of the three that make up its orientation.
    Rotation(u8),
    /// Side of the bounds along an axis of its own, 0 to 2.
    Extent(u8),
    /// The longest side of the bounds.
    Size,
    /// Of a sphere or disc.
    Radius,
    /// Where light comes from, around the up axis.
    Azimuth,
    /// Where light comes from, above the horizon.
    Elevation,
    /// A light's brightest channel.
    Brightness,
    /// A light's colour, its brightest channel 1.
    LightColour,
    /// A light's power over all directions.
    Power,
    /// Half angle of a spot's cone.
    Cutoff,
    /// Half angle of the cone in which a spot is brightest.
    Beam,
    /// A camera's image, in pixels.
    Width,
    /// A camera's image, in pixels.
    Height,
    /// Of a material.
    Opacity,
    /// Of a material's side.
    Material(Side, Property),
}

/// A side of a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Side {
    /// The side that the normal points to, and the other one if it is of the same kind.
    Front,
    /// The other side, where it differs.
    Back,
    /// What lies over the front, and over the other side if it is the same.
    Coating,
    /// What lies over the other side, where it differs.
    CoatingBehind,
}

/// A property of a material's side.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Property {
    /// What kind of material it is.
    Kind,
    /// A parameter of its BSDF, by its name in files.
    Parameter(&'static str),
    /// A channel, 0 to 2, of a parameter that is no colour to look at.
    Channel(&'static str, u8),
    /// Whether it is rough.
    Rough,
    /// Whether it is there at all, of a coating.
    Coated,
}

/// A field's value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// In the field's unit.
    Number(f64),
    /// Linear red, green and blue from 0 to 1.
    Colour([f32; 3]),
    /// Index into the options.
    Choice(usize),
    /// On or off.
    Toggle(bool),
}

/// Which values a field takes.
#[derive(Clone, Debug, PartialEq)]
pub enum Control {
    /// Numbers in a range.
    Number {
        /// The least one.
        min: f64,
        /// The largest one.
        max: f64,
        /// Whether a slider moves by factors.
        logarithmic: bool,
    },
    /// Colours.
    Colour,
    /// One of these.
    Choice(Vec<String>),
    /// On or off.
    Toggle,
}

/// A field as the inspector shows it.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// Which one it is.
    pub id: FieldId,
    /// Its name.
    pub label: &'static str,
    /// Unit of a number; empty where it has none.
    pub unit: &'static str,
    /// What it does, in a sentence or two.
    pub help: &'static str,
    /// What it is now.
    pub value: Value,
    /// What it can be.
    pub control: Control,
    /// Whether only those who know the physics set it.
    pub is_advanced: bool,
}

impl Field {
    /// Whether it can take a value.
    #[must_use]
    pub fn accepts(&self, value: Value) -> bool {
        match (&self.control, value) {
            (Control::Number { min, max, .. }, Value::Number(v)) => v >= *min && v <= *max,
            (Control::Colour, Value::Colour(c)) => c.iter().all(|x| (0.0..=1.0).contains(x)),
            (Control::Choice(options), Value::Choice(i)) => i < options.len(),
            (Control::Toggle, Value::Toggle(_)) => true,
            _ => false,
        }
    }
}

/// Makes fields: id, label, help, and what the kind needs. Fields are plain ones unless [`Fields::advance`] says otherwise.
pub(crate) struct Fields(pub(crate) Vec<Field>);

impl Fields {
    /// A number; the range grows to hold the value that is there.
    pub(crate) fn number(
        &mut self,
        id: FieldId,
        (label, unit): (&'static str, &'static str),
        value: f64,
        (min, max, logarithmic): (f64, f64, bool),
        help: &'static str,
    ) {
        let control = Control::Number { min: min.min(value), max: max.max(value), logarithmic };
        self.0.push(Field {
            id,
            label,
            unit,
            help,
            value: Value::Number(value),
            control,
            is_advanced: false,
        });
    }

    /// Makes the last field one for those who know the physics.
    pub(crate) fn advance(&mut self) {
        if let Some(last) = self.0.last_mut() {
            last.is_advanced = true;
        }
    }

    /// A number as a plugin declares it.
    pub(crate) fn parameter(&mut self, id: FieldId, parameter: &Parameter, value: f64) {
        let (min, max) = parameter.range;
        let range = parameter.slider.unwrap_or((min, max, false));
        self.number(id, (parameter.label, parameter.unit), value, range, parameter.help);
    }

    pub(crate) fn colour(&mut self, id: FieldId, label: &'static str, value: [f32; 3], help: &'static str) {
        let value = Value::Colour(value);
        self.0.push(Field { id, label, unit: "", help, value, control: Control::Colour, is_advanced: false });
    }

    pub(crate) fn choice(
        &mut self,
        id: FieldId,
        label: &'static str,
        chosen: usize,
        options: Vec<String>,
        help: &'static str,
    ) {
        let (value, control) = (Value::Choice(chosen), Control::Choice(options));
        self.0.push(Field { id, label, unit: "", help, value, control, is_advanced: false });
    }

    pub(crate) fn toggle(&mut self, id: FieldId, label: &'static str, on: bool, help: &'static str) {
        let value = Value::Toggle(on);
        self.0.push(Field { id, label, unit: "", help, value, control: Control::Toggle, is_advanced: false });
    }
}
