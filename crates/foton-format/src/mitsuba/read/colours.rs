//! Colours of plugins: one for all, a spectrum, or a texture.

use foton_math::Rgb;
use foton_scene::description::Colour;
use foton_scene::parameter::Parameter;

use crate::mitsuba::read::attributes::parse_attribute;
use crate::mitsuba::read::properties::{Located, Properties};
use crate::mitsuba::read::reader::Reader;
use crate::mitsuba::read::spectra::Meaning;
use crate::mitsuba::read::values;

/// How far below zero the least channel of a colour outside the gamut of sRGB may be, as a share of the largest.
const OUT_OF_GAMUT: f32 = 0.1;

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
        let (least, most) = extremes(colour.value);
        if parameter.holds(f64::from(least)) && parameter.holds(f64::from(most)) {
            return colour.value;
        }
        let subject = p.subject();
        if most > 1.0 + OUT_OF_GAMUT && least >= 0.0 && parameter.range.1 == 1.0 && self.is_of_version_0() {
            // Mitsuba 0.6 scaled what returned more than it got.
            let message = format!("\"{name}\" of \"{subject}\" is larger than 1, and is scaled down to that");
            self.report.warning(colour.place, message);
            return colour.value / most;
        }
        if least < -OUT_OF_GAMUT * most || most > 1.0 + OUT_OF_GAMUT {
            let wanted = if parameter.range.1 > 1.0 { "not be negative" } else { "lie between 0 and 1" };
            self.report.error(colour.place, format!("\"{name}\" of \"{subject}\" must {wanted}"));
        } else {
            let message = format!(
                "\"{name}\" of \"{subject}\" lies a little outside 0 to 1, as colours outside sRGB do; it is cut to that"
            );
            self.report.warning(colour.place, message);
        }
        colour.value.map(|c| c.clamp(0.0, 1.0))
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

    /// Channels a little below zero are those of colours outside the gamut of sRGB, and are cut.
    /// The mean channel of a colour, as Mitsuba 3 takes it for a number.
    pub(crate) fn mean_channel(
        &mut self,
        p: &mut Properties<'_>,
        name: &'static str,
    ) -> Option<Located<f64>> {
        let Located { value, place } = self.colour(p, name, Meaning::Factor)?;
        Some(Located { value: f64::from(value.mean()), place })
    }

    fn not_negative(&mut self, name: &str, colour: &Located<Rgb>) -> Rgb {
        let (least, most) = extremes(colour.value);
        if least < -OUT_OF_GAMUT * most {
            self.report.error(colour.place, format!("\"{name}\" must not be negative"));
        } else if least < 0.0 {
            let message =
                format!("\"{name}\" is a little below zero, as colours outside sRGB are; it is cut to zero");
            self.report.warning(colour.place, message);
            return colour.value.map(|c| c.max(0.0));
        }
        colour.value
    }

    /// A colour as it is meant, in whatever spelling.
    pub(crate) fn colour(
        &mut self,
        p: &mut Properties<'_>,
        name: &'static str,
        meaning: Meaning,
    ) -> Option<Located<Rgb>> {
        match p.spectrum_plugin(name) {
            Some(plugin) => self.spectrum_plugin(plugin, meaning),
            None => self.plain_colour(p, name, meaning),
        }
    }

    /// A colour that is no plugin.
    pub(crate) fn plain_colour(
        &mut self,
        p: &mut Properties<'_>,
        name: &'static str,
        meaning: Meaning,
    ) -> Option<Located<Rgb>> {
        let tags = ["rgb", "srgb", "float", "integer", "spectrum", "blackbody"];
        let (_, element) = p.take(name, &tags, &mut self.report)?;
        let tag = element.name.as_str();
        match tag {
            "spectrum" => return self.spectrum(element, meaning),
            "blackbody" => return self.blackbody(element),
            _ => {}
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
}

/// The least and the largest channel.
fn extremes(colour: Rgb) -> (f32, f32) {
    let channels = colour.to_array();
    (channels.iter().fold(f32::INFINITY, |a, &b| a.min(b)), colour.max_component())
}
