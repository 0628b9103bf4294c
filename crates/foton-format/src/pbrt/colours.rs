//! Parameters of colours to linear sRGB: `rgb`, `xyz`, `blackbody` and `spectrum` in all of its spellings.
//!
//! Shares of light and indices of refraction are seen under D65, emitted light as it is. In version 4 the strength of a lamp is in its
//! `scale` and `power` alone: a spectrum or black body that it emits has a luminance of 1 before that, whatever its numbers are. In
//! version 3 a black body is 1 at its peak, times the second number, and a spectrum is as bright as its numbers say.

use std::path::PathBuf;
use std::rc::Rc;

use foton_input::{quoted, shown_path};
use foton_math::Rgb;
use foton_math::glam::DVec3;

use super::parameters::{COLOURS, Kind, Parameter, Parameters, Values};
use super::reader::Reader;
use super::substances::{self, Substance};
use super::texture::Picture;
use crate::files::Files;
use crate::mitsuba::read::properties::Located;
use crate::mitsuba::read::spectra::index_by_name;
use crate::mitsuba::read::spectrum::{Spectrum, xyz_to_srgb};
use crate::mitsuba::read::values;

/// What a colour stands for.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Meaning {
    /// A share of light.
    Share,
    /// Light.
    Emitted,
    /// An index of refraction, or what else may be any number.
    Index,
}

/// The radiance of a black body per nanometre where it is largest, by the fifth power of its temperature: Planck's law at Wien's
/// wavelength, in W·m⁻²·sr⁻¹·nm⁻¹·K⁻⁵.
const PEAK: f64 = 4.095_66e-15;

impl Reader<'_> {
    /// The colour of a parameter; `None` where there is none, or it is not valid.
    pub(crate) fn colour(&mut self, p: &Parameters, name: &'static str, meaning: Meaning) -> Option<Rgb> {
        let parameter = p.find(name, COLOURS, &mut self.report)?;
        self.colour_of(parameter, meaning)
    }

    /// Light of a parameter, white where there is none; in version 3 a factor may be one number.
    pub(crate) fn light(&mut self, p: &Parameters, name: &'static str) -> Rgb {
        self.colour(p, name, Meaning::Emitted).unwrap_or(Rgb::WHITE)
    }

    /// The colour that a parameter states.
    pub(crate) fn colour_of(&mut self, parameter: &Parameter, meaning: Meaning) -> Option<Rgb> {
        let Parameter { kind, name, value_place: place, .. } = parameter;
        let numbers: &[f64] = match &parameter.values {
            Values::Numbers(numbers) => numbers,
            Values::Texts(texts) if texts.len() == 1 => return self.named(&texts[0], meaning),
            _ => {
                self.report.error(parameter.place, format!("{} is one spectrum", quoted(name)));
                return None;
            }
        };
        let colour = match (kind, numbers) {
            (Kind::Rgb, [r, g, b]) => values::rgb(self.state.colour_space.to_srgb(DVec3::new(*r, *g, *b))),
            (Kind::Xyz, [x, y, z]) => values::rgb(xyz_to_srgb(DVec3::new(*x, *y, *z)).max(DVec3::ZERO)),
            (Kind::Rgb | Kind::Xyz, _) => {
                let message = format!("{} has three numbers, not {}", quoted(name), numbers.len());
                self.report.error(parameter.place, message);
                return None;
            }
            (Kind::Blackbody, _) => self.blackbody(parameter, numbers)?,
            _ => self.of_pairs(parameter, numbers, meaning)?,
        };
        if !colour.is_finite() {
            self.report.error(*place, format!("{} is too large", quoted(name)));
            return None;
        }
        if colour.to_array().iter().any(|c| *c < 0.0) {
            self.report.error(*place, format!("{} must not be negative", quoted(name)));
            return None;
        }
        Some(colour)
    }

    /// A black body by its temperature, and in version 3 by a factor.
    fn blackbody(&mut self, parameter: &Parameter, numbers: &[f64]) -> Option<Rgb> {
        let (kelvin, scale) = match numbers {
            [kelvin] => (*kelvin, None),
            [kelvin, scale] => (*kelvin, Some(*scale)),
            _ => {
                self.report.error(
                    parameter.place,
                    "a blackbody is a temperature, in version 3 with a factor behind it",
                );
                return None;
            }
        };
        if !(100.0..1e6).contains(&kelvin) {
            self.report.error(parameter.value_place, "a temperature must lie between 100 and 1000000 kelvin");
            return None;
        }
        let colour = Spectrum::of_black_body(kelvin).emitted();
        #[allow(clippy::cast_possible_truncation, reason = "colours are single precision")]
        Some(match scale {
            Some(scale) => colour * (scale / (PEAK * kelvin.powi(5))) as f32,
            None => of_luminance_1(colour),
        })
    }

    /// Values at wavelengths, in turn.
    fn of_pairs(&mut self, parameter: &Parameter, numbers: &[f64], meaning: Meaning) -> Option<Rgb> {
        let (pairs, odd) = numbers.as_chunks::<2>();
        if !odd.is_empty() || pairs.is_empty() {
            self.report.error(parameter.place, "a spectrum has a value behind each wavelength");
            return None;
        }
        let mut points: Vec<(f64, f64)> =
            pairs.iter().map(|[wavelength, value]| (*wavelength, *value)).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        if let [(_, value)] = points[..] {
            points = vec![(0.0, value), (1000.0, value)];
        }
        match Spectrum::of_points(points).map(|spectrum| self.held(spectrum)) {
            Ok(spectrum) => self.of_spectrum(&spectrum, parameter.value_place, meaning),
            Err(message) => {
                self.report.error(parameter.value_place, message);
                None
            }
        }
    }

    /// A spectrum as its version has it: 3 goes on with the first and the last value.
    fn held(&self, spectrum: Spectrum) -> Spectrum {
        if self.is_old() { spectrum.held_at_ends() } else { spectrum }
    }

    fn of_spectrum(
        &mut self,
        spectrum: &Spectrum,
        place: crate::diagnostic::Place,
        meaning: Meaning,
    ) -> Option<Rgb> {
        if spectrum.has_negative() {
            self.report.error(place, "a spectrum must not be negative");
            return None;
        }
        Some(match meaning {
            Meaning::Emitted if self.is_old() => spectrum.emitted(),
            Meaning::Emitted => of_luminance_1(spectrum.emitted()),
            // Rounding may carry a share of 1 over.
            Meaning::Share => spectrum.lit().map(|c| if c < 1.001 { c.min(1.0) } else { c }),
            Meaning::Index => spectrum.lit(),
        })
    }

    /// A spectrum that pbrt knows by name, or one of a file.
    fn named(&mut self, name: &Located<String>, meaning: Meaning) -> Option<Rgb> {
        match substances::find(&name.value) {
            Some(Substance::Index(index)) => return Some(index),
            Some(Substance::Light(xyz)) => return Some(values::rgb(xyz_to_srgb(xyz).max(DVec3::ZERO))),
            None => {}
        }
        let is_file = name.value.contains(['.', '/', '\\']);
        if !is_file {
            let names = substances::names();
            let hint = self.report.did_you_mean(&name.value, names.iter().map(String::as_str));
            self.report
                .error(name.place, format!("no spectrum called {} is known{hint}", quoted(&name.value)));
            return None;
        }
        let key = Files::key(&name.value, name.place, &self.report);
        let known = self.spectra.get(&key).cloned();
        if known.is_none()
            && let Some(index) = index_by_name(&name.value)
            && !self.files.is_there(&name.value, name.place, &self.report)
        {
            return Some(index);
        }
        let spectrum = known.unwrap_or_else(|| self.spectrum_of_file(key, name))?;
        self.of_spectrum(&spectrum, name.place, meaning)
    }

    fn spectrum_of_file(&mut self, key: PathBuf, name: &Located<String>) -> Option<Rc<Spectrum>> {
        let read = self.files.read(&name.value, name.place, &mut self.report);
        let spectrum = read.and_then(|(path, bytes)| {
            let text =
                String::from_utf8(bytes).map_err(|_| "it is no spectrum: the text is not UTF-8".to_owned());
            let failed = |message| {
                self.report.error(name.place, format!("cannot read {}: {message}", shown_path(&path)));
            };
            text.and_then(|text| Spectrum::parse_file(&text)).map_err(failed).ok()
        });
        let spectrum = spectrum.map(|spectrum| Rc::new(self.held(spectrum)));
        self.spectra.insert(key, spectrum.clone());
        spectrum
    }

    /// A colour or a texture of colours.
    pub(crate) fn picture(&mut self, p: &Parameters, name: &'static str, default: f32) -> Rc<Picture> {
        self.picture_of(p, name, Meaning::Share)
            .unwrap_or_else(|| Rc::new(Picture::Constant(Rgb::splat(default))))
    }

    /// A colour or a texture of colours, where there is one.
    pub(crate) fn picture_of(
        &mut self,
        p: &Parameters,
        name: &'static str,
        meaning: Meaning,
    ) -> Option<Rc<Picture>> {
        let kinds = [COLOURS, &[Kind::Texture]].concat();
        let parameter = p.find(name, &kinds, &mut self.report)?;
        if parameter.kind == Kind::Texture {
            return parameter.pictures[1].clone();
        }
        self.colour_of(parameter, meaning).map(|colour| Rc::new(Picture::Constant(colour)))
    }

    /// A number or a texture of numbers, where there is one.
    pub(crate) fn number_picture(&mut self, p: &Parameters, name: &'static str) -> Option<Rc<Picture>> {
        let parameter = p.find(name, &[Kind::Float, Kind::Integer, Kind::Texture], &mut self.report)?;
        if parameter.kind == Kind::Texture {
            return parameter.pictures[0].clone();
        }
        let number = p.number(name, &mut self.report)?;
        #[allow(clippy::cast_possible_truncation, reason = "optics is single precision")]
        Some(Rc::new(Picture::Constant(Rgb::splat(number.value as f32))))
    }
}

/// Light of the same colour that is as bright as white.
fn of_luminance_1(colour: Rgb) -> Rgb {
    let luminance = colour.luminance();
    if luminance > 0.0 { colour / luminance } else { colour }
}
