//! What each BSDF that has no others inside says, by the parameters that it declares.

use foton_input::quoted;
use foton_math::Rgb;
use foton_scene::bsdf::{MicrofacetDistribution, Microfacets, index_of_specular};
use foton_scene::description::{Bsdf, Conductor, Mirror, Number};
use foton_scene::parameter::{Binding, Kind, Parameter, Slot};
use foton_scene::plugins::stand_ins;

use crate::image::Purpose;
use crate::mitsuba::names::REFRACTION;
use crate::mitsuba::read::metals;
use crate::mitsuba::read::properties::{Located, Properties};
use crate::mitsuba::read::reader::Reader;
use crate::spelling::did_you_mean;

/// The name of the parameter that says which microfacets a surface has.
const DISTRIBUTION: &str = "distribution";

/// Mitsuba takes smaller values of alpha for this.
const MIN_ALPHA: f32 = 1e-4;

impl Reader<'_> {
    /// The BSDF of a plugin that has no others inside.
    pub(crate) fn bsdf(&mut self, plugin: &str, p: &mut Properties<'_>) -> Option<Bsdf> {
        if let Some(it) = stand_ins::find(plugin) {
            return self.stand_in(it, p);
        }
        let mut bsdf = Bsdf::of_plugin(plugin)?;
        // All of them, so that every fault is found at once.
        let mut is_complete = true;
        for binding in bsdf.parameters() {
            is_complete &= self.read_binding(p, binding).is_some();
        }
        let has_indices = ["eta", "k"].iter().any(|name| p.has(name));
        match bsdf {
            _ if !is_complete => None,
            // A smooth conductor that is no metal reflects everything.
            Bsdf::Conductor(Conductor { eta: Rgb::BLACK, roughness: None, specular_reflectance, .. })
                if !has_indices =>
            {
                Some(Bsdf::Mirror(Mirror { reflectance: specular_reflectance }))
            }
            _ => Some(bsdf),
        }
    }

    /// Reads a value into its place; `None` where it is not valid.
    pub(super) fn read_binding(
        &mut self,
        p: &mut Properties<'_>,
        Binding { parameters, slot }: Binding<'_>,
    ) -> Option<()> {
        p.leave_out(parameters, &mut self.report);
        match slot {
            Slot::Share(share) => *share = self.share(p, &parameters[0]),
            Slot::Number(number) => *number = self.number(p, &parameters[0])?,
            Slot::Refraction(ior) => *ior = self.refraction(p, &parameters[0])?,
            Slot::Reflectivity(ior) => *ior = self.reflectivity(p, parameters)?,
            Slot::Boolean(flag) => {
                *flag = p.boolean(parameters[0].name, &mut self.report).is_some_and(|found| found.value);
            }
            Slot::Choice(i) => *i = self.choice(p, &parameters[0])?,
            Slot::Metal { eta, k } => (*eta, *k) = self.metal(p, parameters)?,
            Slot::Roughness(Some(roughness)) => *roughness = self.roughness(p, parameters)?,
            Slot::Roughness(None) => {}
        }
        Some(())
    }

    /// A number within its range, the mean channel of a colour, or the texture that gives it.
    #[allow(clippy::cast_possible_truncation, reason = "optics is single precision")]
    pub(super) fn number(&mut self, p: &mut Properties<'_>, parameter: &Parameter) -> Option<Number> {
        let Parameter { name, range: (min, max), .. } = *parameter;
        if let Some(texture) = p.texture(name).filter(|_| parameter.textured) {
            return self.texture_for(texture, Purpose::Number).map(Number::Texture);
        }
        // A colour where a texture might stand is one that is the same everywhere.
        let is_colour = parameter.textured && p.is_written_as(name, &["rgb", "srgb", "spectrum"]);
        let found = if is_colour { self.mean_channel(p, name) } else { p.number(name, &mut self.report) };
        let Some(found) = found else { return Some(parameter.default_number().into()) };
        if parameter.holds(found.value) {
            return Some((found.value as f32).into());
        }
        let message = format!("\"{name}\" must lie between {min} and {max}");
        if p.subject().starts_with("principled") {
            // Exporters pass on what their program lets a person type.
            self.report.warning(found.place, format!("{message}, and is cut to that"));
            return Some((found.value.clamp(min, max) as f32).into());
        }
        self.report.error(found.place, message);
        None
    }

    /// The complex index of refraction of a metal: by name, or by its parts, relative to what is outside.
    fn metal(&mut self, p: &mut Properties<'_>, parameters: &'static [Parameter]) -> Option<(Rgb, Rgb)> {
        let [eta, k, material, ext_eta] = parameters else { return None };
        let name = p.string(material.name, &mut self.report);
        let has_indices = material.excludes.iter().any(|name| p.has(name));
        let stated = (self.optical(p, eta), self.optical(p, k));
        let outside = if p.has(ext_eta.name) { self.refraction(p, ext_eta) } else { Some(1.0) };
        let (eta, k) = match name.filter(|name| name.value != material.default_text) {
            Some(name) if has_indices => {
                self.report
                    .error(name.place, "a conductor has a \"material\" or \"eta\" and \"k\", not both");
                return None;
            }
            Some(name) => metals::find(&name.value).map_err(|m| self.report.error(name.place, m)).ok()?,
            None => stated,
        };
        let relative = 1.0 / outside?;
        Some((eta * relative, k * relative))
    }

    /// An index of refraction, a number or the name of a substance.
    #[allow(clippy::cast_possible_truncation, reason = "optics is single precision")]
    pub(super) fn refraction(&mut self, p: &mut Properties<'_>, parameter: &Parameter) -> Option<f32> {
        let name = parameter.name;
        if p.is_written_as(name, &["string"]) {
            let substance = p.string(name, &mut self.report)?;
            let lower = substance.value.to_lowercase();
            let found = REFRACTION.iter().find(|(known, _)| *known == lower);
            if found.is_none() {
                let hint = did_you_mean(&lower, REFRACTION.iter().map(|(known, _)| *known));
                let message =
                    format!("no index of refraction is known for {}{hint}", quoted(&substance.value));
                self.report.error(substance.place, message);
            }
            return found.map(|(_, ior)| *ior);
        }
        let Some(ior) = p.number(name, &mut self.report) else { return Some(parameter.default_number()) };
        let single = ior.value as f32;
        if single.is_normal() && single > 0.0 {
            return Some(single);
        }
        self.report.error(ior.place, "an index of refraction must be above zero");
        None
    }

    /// An index of refraction, or the `specular` that stands for it.
    fn reflectivity(&mut self, p: &mut Properties<'_>, parameters: &'static [Parameter]) -> Option<f32> {
        let [eta, specular, ..] = parameters else { return None };
        if !p.has(specular.name) {
            return self.refraction(p, eta);
        }
        if p.has(eta.name) {
            let message = format!("a {} has an \"eta\" or a \"specular\", not both", p.subject());
            self.report.error(p.place, message);
        }
        match self.number(p, specular)? {
            Number::Constant(specular) => Some(index_of_specular(specular)),
            Number::Texture(_) => None,
        }
    }

    /// `distribution` and `alpha`, or `alpha_u` and `alpha_v` where they are declared.
    fn roughness(&mut self, p: &mut Properties<'_>, parameters: &'static [Parameter]) -> Option<Microfacets> {
        let declared = |name: &str| parameters.iter().find(|p| p.name == name);
        let distribution = declared(DISTRIBUTION).and_then(|parameter| self.distribution(p, parameter));
        let mut alphas = (Some(Microfacets::DEFAULT.alpha_u), Some(Microfacets::DEFAULT.alpha_v));
        if let Some(alpha) = declared("alpha") {
            let alpha = self.alpha(p, alpha);
            alphas = (alpha, alpha);
        }
        if let (Some(u), Some(v)) = (declared("alpha_u"), declared("alpha_v"))
            && (p.states(u.name) || p.states(v.name))
        {
            if !(p.states(u.name) && p.states(v.name)) || p.states("alpha") {
                let message = "a rough surface has an \"alpha\", or both \"alpha_u\" and \"alpha_v\"";
                self.report.error(p.place, message);
            }
            alphas = (self.alpha(p, u), self.alpha(p, v));
        }
        let (alpha_u, alpha_v) = alphas;
        Some(Microfacets { distribution: distribution?, alpha_u: alpha_u?, alpha_v: alpha_v? })
    }

    fn distribution(
        &mut self,
        p: &mut Properties<'_>,
        parameter: &Parameter,
    ) -> Option<MicrofacetDistribution> {
        self.choice(p, parameter).map(|i| MicrofacetDistribution::ALL[i])
    }

    /// One of some words, by its place among them; the first where nothing is said.
    fn choice(&mut self, p: &mut Properties<'_>, parameter: &Parameter) -> Option<usize> {
        let Kind::Choice(words) = parameter.kind else { return None };
        let name = parameter.name;
        let Some(Located { value, place }) = p.string(name, &mut self.report) else { return Some(0) };
        // Files before version 0.6 call the distribution of Ashikhmin and Shirley by their initials.
        let value = if name == DISTRIBUTION && value == "as" { "phong".to_owned() } else { value };
        // Mitsuba 0.6 takes them in any case.
        let letters = |text: &str| text.to_ascii_lowercase().replace(['-', '_'], "");
        let known = words.iter().position(|word| letters(word) == letters(&value));
        if known.is_none() {
            let hint = did_you_mean(&value, words.iter().copied());
            let all = words.iter().map(|word| format!("\"{word}\"")).collect::<Vec<_>>().join(", ");
            let hint = if hint.is_empty() { format!(", only {all}") } else { hint };
            self.report.error(place, format!("no {name} {} is known{hint}", quoted(&value)));
        }
        known
    }

    fn alpha(&mut self, p: &mut Properties<'_>, parameter: &Parameter) -> Option<Number> {
        Some(match self.number(p, parameter)? {
            Number::Constant(alpha) => alpha.max(MIN_ALPHA).into(),
            texture @ Number::Texture(_) => texture,
        })
    }
}
