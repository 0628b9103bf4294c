//! Colours of plugins: one for all, a spectrum, or a texture.

use std::rc::Rc;

use foton_input::shown_path;
use foton_math::Rgb;
use foton_scene::description::Colour;
use foton_scene::parameter::Parameter;

use crate::diagnostic::Place;
use crate::files::Files;
use crate::mitsuba::document::Element;
use crate::mitsuba::read::attributes::parse_attribute;
use crate::mitsuba::read::properties::{Located, Properties};
use crate::mitsuba::read::reader::Reader;
use crate::mitsuba::read::spectrum::Spectrum;
use crate::mitsuba::read::values;

/// What a colour stands for, which decides how a spectrum becomes one.
#[derive(Clone, Copy, PartialEq)]
enum Meaning {
    /// Light as it is.
    Emitted,
    /// A factor on light.
    Factor,
}

impl Reader<'_> {
    /// A share of light, each channel in [0, 1]: the same everywhere, or from a texture.
    pub(crate) fn share(&mut self, p: &mut Properties<'_>, parameter: &Parameter) -> Colour {
        if let Some(texture) = p.texture(parameter.name) {
            return self.texture(texture).map_or(parameter.default_colour(), Colour::Texture);
        }
        self.constant_share(p, parameter).into()
    }

    /// A share of light, each channel in [0, 1].
    pub(crate) fn constant_share(&mut self, p: &mut Properties<'_>, parameter: &Parameter) -> Rgb {
        let name = parameter.name;
        let Some(colour) = self.colour(p, name, Meaning::Factor) else {
            return Rgb::splat(parameter.default_number());
        };
        if !colour.value.to_array().iter().all(|&c| parameter.holds(f64::from(c))) {
            let subject = p.subject();
            self.report.error(colour.place, format!("\"{name}\" of \"{subject}\" must lie between 0 and 1"));
        }
        colour.value
    }

    /// Part of an index of refraction, no channel below zero.
    pub(crate) fn optical(&mut self, p: &mut Properties<'_>, parameter: &Parameter) -> Rgb {
        let colour = self.colour(p, parameter.name, Meaning::Factor);
        let default = Rgb::splat(parameter.default_number());
        colour.map_or(default, |colour| self.not_negative(parameter.name, &colour))
    }

    /// Emitted light, no channel below zero.
    ///
    /// A `<spectrum>` of one number is the same at every wavelength, which is not white in sRGB: Mitsuba 3 takes its
    /// colour from the matching functions, and so do we.
    pub(crate) fn emission(&mut self, p: &mut Properties<'_>, parameter: &Parameter) -> Rgb {
        let colour = self.colour(p, parameter.name, Meaning::Emitted);
        let default = Rgb::splat(parameter.default_number());
        colour.map_or(default, |colour| self.not_negative(parameter.name, &colour))
    }

    fn not_negative(&mut self, name: &str, colour: &Located<Rgb>) -> Rgb {
        if colour.value.to_array().iter().any(|&c| c < 0.0) {
            self.report.error(colour.place, format!("\"{name}\" must not be negative"));
        }
        colour.value
    }

    fn colour(
        &mut self,
        p: &mut Properties<'_>,
        name: &'static str,
        meaning: Meaning,
    ) -> Option<Located<Rgb>> {
        let tags = ["rgb", "srgb", "float", "integer", "spectrum"];
        let (_, element) = p.take(name, &tags, &mut self.report)?;
        let tag = element.name.as_str();
        if tag == "spectrum" {
            return self.spectrum(element, meaning);
        }
        let attribute = element.attribute("value")?;
        let parse = |text: &str| match tag {
            "rgb" => values::colour(text),
            "srgb" => values::srgb(text),
            _ => values::number(text).and_then(|_| values::colour(text)),
        };
        let value = parse_attribute(attribute, parse, &mut self.report)?;
        Some(Located { value, place: attribute.value_place })
    }

    /// The spectrum in a file, which is read once.
    fn spectrum_file(&mut self, filename: &str, place: Place) -> Option<Rc<Spectrum>> {
        let key = Files::key(filename, place, &self.report);
        if let Some(known) = self.spectra.get(&key) {
            return known.clone();
        }
        let read = self.files.read(filename, place, &mut self.report);
        let spectrum = read.and_then(|(path, bytes)| {
            let text =
                String::from_utf8(bytes).map_err(|_| "it is no spectrum: the text is not UTF-8".to_owned());
            let failed = |message| {
                self.report.error(place, format!("cannot read {}: {message}", shown_path(&path)));
            };
            text.and_then(|text| Spectrum::parse_file(&text)).map_err(failed).ok().map(Rc::new)
        });
        self.spectra.insert(key, spectrum.clone());
        spectrum
    }

    fn spectrum(&mut self, element: &Element, meaning: Meaning) -> Option<Located<Rgb>> {
        /// Linear sRGB of CIE XYZ (1, 1, 1).
        const EQUAL_ENERGY: Rgb = Rgb::new(1.204_794, 0.948_291, 0.908_916);
        let place;
        let spectrum: Rc<Spectrum> = match (element.attribute("value"), element.attribute("filename")) {
            (Some(value), None) if value.value.contains(':') => {
                place = value.value_place;
                parse_attribute(value, Spectrum::parse, &mut self.report).map(Rc::new)?
            }
            (Some(value), None) => {
                let number = |text: &str| values::number(text).and_then(|_| values::colour(text));
                let level = parse_attribute(value, number, &mut self.report)?;
                let value_place = value.value_place;
                let value = if meaning == Meaning::Emitted { level * EQUAL_ENERGY } else { level };
                return Some(Located { value, place: value_place });
            }
            (None, Some(filename)) if !filename.broken => {
                place = filename.value_place;
                self.spectrum_file(&filename.value, place)?
            }
            (None, Some(_)) => return None,
            _ => {
                let message = "a <spectrum> has a \"value\" or a \"filename\"";
                self.report.error(element.place, message);
                return None;
            }
        };
        if spectrum.has_negative() {
            self.report.error(place, "a spectrum must not be negative");
            return None;
        }
        let value = match meaning {
            Meaning::Emitted => spectrum.emitted(),
            Meaning::Factor => spectrum.lit(),
        };
        // Rounding may carry a factor of 1 over.
        let value = if meaning == Meaning::Factor && value.max_component() < 1.001 {
            value.map(|c| c.min(1.0))
        } else {
            value
        };
        Some(Located { value, place })
    }
}
