//! Elements of spectra to colours: `<spectrum>` in all of its spellings, `<blackbody>`, and the plugins of spectra of Mitsuba 3.
//!
//! Three numbers without wavelengths are red, green and blue, as in Mitsuba 0.6 where it is built for three channels.

use std::path::Path;
use std::rc::Rc;

use foton_input::{quoted, shown_path};
use foton_math::Rgb;

use crate::diagnostic::Place;
use crate::files::Files;
use crate::mitsuba::document::{Attribute, Element};
use crate::mitsuba::names::SPECTRUM_PLUGINS;
use crate::mitsuba::read::attributes::parse_attribute;
use crate::mitsuba::read::properties::{Located, Object, Properties};
use crate::mitsuba::read::reader::Reader;
use crate::mitsuba::read::spectrum::Spectrum;
use crate::mitsuba::read::{metals, values};

/// What a colour stands for, which decides how a spectrum becomes one.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Meaning {
    /// Light as it is.
    Emitted,
    /// A factor on light.
    Factor,
}

/// Linear sRGB of CIE XYZ (1, 1, 1).
const EQUAL_ENERGY: Rgb = Rgb::new(1.204_794, 0.948_291, 0.908_916);

impl Reader<'_> {
    /// The colour of a `<spectrum>`.
    pub(crate) fn spectrum(&mut self, element: &Element, meaning: Meaning) -> Option<Located<Rgb>> {
        match (element.attribute("value"), element.attribute("filename")) {
            (Some(value), None) if value.value.contains(':') => {
                let spectrum = parse_attribute(value, Spectrum::parse, &mut self.report)?;
                self.colour_of(&spectrum, value.value_place, meaning)
            }
            (Some(value), None) => self.without_wavelengths(value, meaning),
            (None, Some(filename)) if !filename.broken => self.spectrum_of_file(filename, meaning),
            (None, Some(_)) => None,
            _ => {
                let message = "a <spectrum> has a \"value\" or a \"filename\"";
                self.report.error(element.place, message);
                None
            }
        }
    }

    /// One number, the same at every wavelength, or red, green and blue.
    fn without_wavelengths(&mut self, attribute: &Attribute, meaning: Meaning) -> Option<Located<Rgb>> {
        let parse = |text: &str| {
            if text.trim().starts_with('#') {
                return values::colour(text);
            }
            let count = values::numbers(text)?.len();
            let colour = match count {
                1 | 3 => values::colour(text)?,
                _ => {
                    return Err(format!(
                        "a spectrum has one number, three (red, green and blue) or wavelengths with their values, such as \
                         400:0.1 700:0.2, not {count} numbers"
                    ));
                }
            };
            Ok(if count == 1 && meaning == Meaning::Emitted { colour * EQUAL_ENERGY } else { colour })
        };
        let value = parse_attribute(attribute, parse, &mut self.report)?;
        Some(Located { value, place: attribute.value_place })
    }

    /// The colour of a spectrum, or that it has values below zero.
    fn colour_of(&mut self, spectrum: &Spectrum, place: Place, meaning: Meaning) -> Option<Located<Rgb>> {
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

    /// The spectrum in a file, which is read once. Those of metals that came with Mitsuba 0.6 are known without their files.
    fn spectrum_of_file(&mut self, filename: &Attribute, meaning: Meaning) -> Option<Located<Rgb>> {
        let (name, place) = (&filename.value, filename.value_place);
        let key = Files::key(name, place, &self.report);
        if let Some(known) = self.spectra.get(&key).cloned() {
            return self.colour_of(&*known?, place, meaning);
        }
        if let Some(value) = index_by_name(name).filter(|_| !self.files.is_there(name, place, &self.report)) {
            return Some(Located { value, place });
        }
        let read = self.files.read(name, place, &mut self.report);
        let spectrum = read.and_then(|(path, bytes)| {
            let text =
                String::from_utf8(bytes).map_err(|_| "it is no spectrum: the text is not UTF-8".to_owned());
            let failed = |message| {
                self.report.error(place, format!("cannot read {}: {message}", shown_path(&path)));
            };
            text.and_then(|text| Spectrum::parse_file(&text)).map_err(failed).ok().map(Rc::new)
        });
        self.spectra.insert(key, spectrum.clone());
        self.colour_of(&*spectrum?, place, meaning)
    }

    /// The light of a black body: `<blackbody temperature="5000K" scale="0.001"/>`.
    pub(crate) fn blackbody(&mut self, element: &Element) -> Option<Located<Rgb>> {
        let temperature = element.attribute("temperature")?;
        let kelvin = parse_attribute(temperature, kelvin, &mut self.report)?;
        let scale = match element.attribute("scale") {
            Some(scale) => parse_attribute(scale, values::number, &mut self.report)?,
            None => 1.0,
        };
        let place = temperature.value_place;
        Some(Located { value: Spectrum::of_black_body(kelvin).emitted() * scale as f32, place })
    }

    /// What a plugin of a spectrum says.
    pub(crate) fn spectrum_plugin(&mut self, object: Object<'_>, meaning: Meaning) -> Option<Located<Rgb>> {
        let plugin = object.element.attribute("type").map(|t| t.value.as_str())?;
        let plugin = SPECTRUM_PLUGINS.iter().find(|known| **known == plugin)?;
        let mut p = self.properties(object.node, plugin);
        let found = match *plugin {
            "uniform" | "rawconstant" => Some(self.plain(&mut p, "value", meaning)),
            "srgb" => Some(self.plain(&mut p, "color", meaning)),
            "d65" => {
                let scale = p.number("scale", &mut self.report).map_or(1.0, |scale| scale.value as f32);
                let name = if p.has("color") { "color" } else { "value" };
                Some(self.plain(&mut p, name, meaning) * scale)
            }
            "blackbody" => {
                let temperature = p.number("temperature", &mut self.report).map_or(5000.0, |t| t.value);
                let scale = p.number("scale", &mut self.report).map_or(1.0, |scale| scale.value as f32);
                Some(Spectrum::of_black_body(temperature).emitted() * scale)
            }
            _ => self.sampled(&mut p, meaning),
        };
        p.finish(&mut self.report);
        Some(Located { value: found?, place: object.place })
    }

    /// A colour that means itself, white by default.
    fn plain(&mut self, p: &mut Properties<'_>, name: &'static str, meaning: Meaning) -> Rgb {
        if let Some(vector) = p.is_vector(name).then(|| p.point(name, &mut self.report)).flatten() {
            return values::rgb(vector.value);
        }
        self.plain_colour(p, name, meaning).map_or(Rgb::WHITE, |colour| colour.value)
    }

    /// Values at wavelengths: evenly from `wavelength_min` to `wavelength_max`, or at those of `wavelengths`.
    fn sampled(&mut self, p: &mut Properties<'_>, meaning: Meaning) -> Option<Rgb> {
        let [wavelengths, sampled] = ["wavelengths", "values"].map(|name| {
            let text = p.string(name, &mut self.report)?;
            values::numbers(&text.value).map_err(|message| self.report.error(text.place, message)).ok()
        });
        let [min, max] = [("wavelength_min", 360.0), ("wavelength_max", 830.0)]
            .map(|(name, default)| p.number(name, &mut self.report).map_or(default, |w| w.value));
        let sampled = sampled.unwrap_or_default();
        let steps = sampled.len().saturating_sub(1).max(1) as f64;
        let even = || (0..sampled.len()).map(|i| min + (max - min) * i as f64 / steps).collect();
        let wavelengths: Vec<f64> = wavelengths.unwrap_or_else(even);
        if wavelengths.len() != sampled.len() {
            let message =
                format!("{} values cannot stand at {} wavelengths", sampled.len(), wavelengths.len());
            self.report.error(p.place, message);
            return None;
        }
        let spectrum = Spectrum::of_points(wavelengths.into_iter().zip(sampled).collect());
        let spectrum = spectrum.map_err(|message| self.report.error(p.place, message)).ok()?;
        self.colour_of(&spectrum, p.place, meaning).map(|colour| colour.value)
    }
}

/// A temperature such as `5000` or `5000K`.
fn kelvin(text: &str) -> Result<f64, String> {
    let text = text.trim();
    let number = values::number(text.strip_suffix(['K', 'k']).unwrap_or(text))?;
    if number > 0.0 { Ok(number) } else { Err(format!("{} is no temperature above zero", quoted(text))) }
}

/// The index of refraction that a file's name tells: `Cu.eta.spd` or `Cu.k.spd`, in whatever folder.
pub(crate) fn index_by_name(filename: &str) -> Option<Rgb> {
    let name = filename.rsplit(['/', '\\']).next()?;
    let stem = Path::new(name).file_stem()?.to_str()?;
    let (metal, part) = stem.rsplit_once('.')?;
    let (eta, k) = metals::find(metal).ok()?;
    match part {
        "eta" => Some(eta),
        "k" => Some(k),
        _ => None,
    }
}
