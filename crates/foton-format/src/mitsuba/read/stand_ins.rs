//! BSDFs that are not modelled, by what stands in for them: `plugins/stand_ins.rs` of `foton-scene` says what that is.
//!
//! A warning says so where the first of a kind stands. What the file says that has no place in the stand-in is left out.

use foton_math::Rgb;
use foton_scene::bsdf::{MicrofacetDistribution, Microfacets};
use foton_scene::description::{Bsdf, Colour, Diffuse, Null, Plastic, PrincipledThin, ThinDielectric};
use foton_scene::parameter::Parameter;
use foton_scene::plugins::stand_ins::StandIn;

use crate::diagnostic::Place;
use crate::mitsuba::read::properties::Properties;
use crate::mitsuba::read::reader::Reader;

/// Absorption by a unit of each pigment of hair. `[CBTB16]`
pub(crate) const EUMELANIN: Rgb = Rgb::new(0.419, 0.697, 1.37);
pub(crate) const PHEOMELANIN: Rgb = Rgb::new(0.187, 0.4, 1.05);

/// Diffuse reflectance of substances by name. `[JMLH01]` figure 5
const SUBSTANCES: &[(&str, Rgb)] = &[
    ("apple", Rgb::new(0.85, 0.84, 0.53)),
    ("chicken1", Rgb::new(0.31, 0.15, 0.10)),
    ("chicken2", Rgb::new(0.32, 0.16, 0.10)),
    ("cream", Rgb::new(0.98, 0.90, 0.73)),
    ("ketchup", Rgb::new(0.16, 0.01, 0.0)),
    ("marble", Rgb::new(0.83, 0.79, 0.75)),
    ("potato", Rgb::new(0.77, 0.62, 0.21)),
    ("skimmilk", Rgb::new(0.81, 0.81, 0.69)),
    ("skin1", Rgb::new(0.44, 0.22, 0.13)),
    ("skin2", Rgb::new(0.63, 0.44, 0.34)),
    ("spectralon", Rgb::new(1.0, 1.0, 1.0)),
    ("wholemilk", Rgb::new(0.91, 0.88, 0.76)),
];

/// What Mitsuba takes where none is named.
const SUBSTANCE: &str = "skin1";

impl Reader<'_> {
    /// The BSDF that stands in for one that is not modelled; `None`: there is none, which is an error here.
    pub(crate) fn stand_in(&mut self, it: &StandIn, p: &mut Properties<'_>) -> Option<Bsdf> {
        let StandIn { name, instead, help } = *it;
        let Some(instead) = instead else {
            p.leave_rest();
            return self.none_stands_in(name, help, p.place);
        };
        self.report.warn_once(p.place, format!("a \"{instead}\" stands in for \"{name}\": {help}"));
        let found = match name {
            "pplastic" => {
                p.rename("alpha_u", "alpha");
                self.bsdf(instead, p)
            }
            "polarizer" | "circular" => self.neutral_filter(p, 0.5),
            "retarder" => self.neutral_filter(p, 1.0),
            "hair" => self.hair(p),
            "irawan" => self.cloth(p),
            "hk" => self.sheet(p),
            _ => self.skin(p),
        };
        p.leave_rest();
        found
    }

    /// Refuses a BSDF, or where the user takes a picture in which parts are missing, paints it magenta.
    fn none_stands_in(&mut self, name: &str, help: &str, place: Place) -> Option<Bsdf> {
        if self.files.allows_missing() {
            self.report.warn_once(place, format!("magenta stands for \"{name}\": {help}"));
            return Some(Bsdf::Diffuse(Diffuse { reflectance: Rgb::new(0.8, 0.0, 0.8).into() }));
        }
        self.report.error(place, format!("a \"{name}\" bsdf cannot be rendered: {help}"));
        None
    }

    /// A filter that light passes straight, of its transmittance times a factor. Of a texture the factor is left out.
    fn neutral_filter(&mut self, p: &mut Properties<'_>, factor: f32) -> Option<Bsdf> {
        let specular_transmittance = match self.share(p, &Parameter::share("transmittance", 1.0)) {
            Colour::Constant(c) if c * factor == Rgb::WHITE => return Some(Bsdf::Null(Null)),
            Colour::Constant(c) => (c * factor).into(),
            texture @ Colour::Texture(_) => texture,
        };
        let specular_reflectance = Rgb::WHITE.into();
        Some(Bsdf::ThinDielectric(ThinDielectric {
            int_ior: 1.0,
            ext_ior: 1.0,
            specular_reflectance,
            specular_transmittance,
        }))
    }

    /// A rough coat over the colour that many fibres have together.
    fn hair(&mut self, p: &mut Properties<'_>) -> Option<Bsdf> {
        let number = |reader: &mut Self, p: &mut Properties<'_>, name, default, range| {
            let parameter = Parameter::number(name, default, range);
            reader.number(p, &parameter)?.constant()
        };
        let eumelanin = number(self, p, "eumelanin", 1.3, (0.0, 1e6))?;
        let pheomelanin = number(self, p, "pheomelanin", 0.2, (0.0, 1e6))?;
        let along = number(self, p, "longitudinal_roughness", 0.3, (0.0, 1.0))?;
        let around = number(self, p, "azimuthal_roughness", 0.3, (0.0, 1.0))?;
        let int_ior = self.refraction(p, &Parameter::refraction("int_ior", 1.55))?;
        let absorption = if p.has("sigma_a") {
            self.optical(p, &Parameter::colour("sigma_a", 0.0))
        } else {
            EUMELANIN * eumelanin + PHEOMELANIN * pheomelanin
        };
        let alpha = along.max(0.05).into();
        let roughness =
            Microfacets { distribution: MicrofacetDistribution::Ggx, alpha_u: alpha, alpha_v: alpha };
        Some(coated(fibres(absorption, around), int_ior, Some(roughness)))
    }

    /// The mean of a weave's diffuse colours.
    fn cloth(&mut self, p: &mut Properties<'_>) -> Option<Bsdf> {
        let names = ["kd", "warp_kd", "weft_kd"].into_iter().filter(|name| p.has(name)).collect::<Vec<_>>();
        let colours = names.iter().map(|name| self.constant_share(p, &Parameter::share(name, 0.5)));
        let sum: Rgb = colours.sum();
        let mean = if names.is_empty() { Rgb::splat(0.5) } else { sum / names.len() as f32 };
        Some(Bsdf::Diffuse(Diffuse { reflectance: mean.into() }))
    }

    /// A sheet that reflects as much as it passes.
    fn sheet(&mut self, p: &mut Properties<'_>) -> Option<Bsdf> {
        let base_color = self.albedo(p).unwrap_or(Rgb::splat(0.5)).into();
        let Some(Bsdf::PrincipledThin(sheet)) = Bsdf::of_plugin("principledthin") else { return None };
        Some(Bsdf::PrincipledThin(PrincipledThin { base_color, diff_trans: 1.0.into(), ..sheet }))
    }

    /// A smooth coat over what much scattering reflects.
    fn skin(&mut self, p: &mut Properties<'_>) -> Option<Bsdf> {
        let int_ior = self.refraction(p, &Parameter::refraction("int_ior", 1.3))?;
        let named = p.string("material", &mut self.report).map(|found| found.value.to_lowercase());
        let colour = match (self.albedo(p), named) {
            (Some(albedo), _) => albedo.map(|albedo| much_scattering(albedo, int_ior)),
            (None, Some(name)) => substance(&name).unwrap_or(Rgb::splat(0.5)),
            (None, None) => substance(SUBSTANCE)?,
        };
        Some(coated(colour, int_ior, None))
    }

    /// The share of light that each meeting scatters, where the file says it; of scattering that has no direction left.
    fn albedo(&mut self, p: &mut Properties<'_>) -> Option<Rgb> {
        if p.has("albedo") {
            return Some(self.constant_share(p, &Parameter::share("albedo", 0.5)));
        }
        if !p.has("sigma_s") || !p.has("sigma_a") {
            return None;
        }
        let forwards = p.number("g", &mut self.report).map_or(0.0, |g| g.value.clamp(-1.0, 0.999));
        #[allow(clippy::cast_possible_truncation, reason = "optics is single precision")]
        let scattered = self.optical(p, &Parameter::colour("sigma_s", 0.0)) * (1.0 - forwards) as f32;
        let lost = self.optical(p, &Parameter::colour("sigma_a", 0.0)) + scattered;
        let share = |s: f32, t: f32| if t > 0.0 { s / t } else { 0.0 };
        Some(Rgb::new(share(scattered.r, lost.r), share(scattered.g, lost.g), share(scattered.b, lost.b)))
    }
}

/// The diffuse reflectance of a substance by its name in lower case.
pub(crate) fn substance(name: &str) -> Option<Rgb> {
    SUBSTANCES.iter().find(|(known, _)| *known == name).map(|(_, colour)| *colour)
}

fn coated(base: Rgb, int_ior: f32, roughness: Option<Microfacets>) -> Bsdf {
    Bsdf::Plastic(Plastic {
        int_ior,
        ext_ior: 1.0,
        diffuse_reflectance: base.into(),
        specular_reflectance: Rgb::WHITE.into(),
        nonlinear: false,
        roughness,
    })
}

/// The colour of many fibres that absorb so much, by their azimuthal roughness. `[CBTB16]` equation 9
pub(crate) fn fibres(absorption: Rgb, roughness: f32) -> Rgb {
    let powers = [5.969, -0.215, 2.532, -10.73, 5.574, 0.245];
    let scale: f32 = powers.into_iter().rev().fold(0.0, |sum, c| sum * roughness + c);
    absorption.map(|sigma| (-sigma.sqrt() * scale).exp())
}

/// Diffuse reflectance of a half space that scatters this share of light at each meeting. `[JMLH01]` equation 15
pub(crate) fn much_scattering(albedo: f32, ior: f32) -> f32 {
    let inverse = 1.0 / ior;
    let inside = -1.44 * inverse * inverse + 0.71 * inverse + 0.668 + 0.0636 * ior;
    let boundary = (1.0 + inside) / (1.0 - inside);
    let depth = (3.0 * (1.0 - albedo)).sqrt();
    (0.5 * albedo * (1.0 + (-4.0 / 3.0 * boundary * depth).exp()) * (-depth).exp()).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_scatters_all_light_is_white_and_skin_is_as_published() {
        assert!((much_scattering(1.0, 1.3) - 1.0).abs() < 1e-6 && much_scattering(0.0, 1.3) == 0.0);
        // σs' and σa of skin1 per millimetre, and its reflectance in the same table.
        let (scattered, absorbed) = (Rgb::new(0.74, 0.88, 1.01), Rgb::new(0.032, 0.17, 0.48));
        let of = |s: f32, a: f32| much_scattering(s / (s + a), 1.3);
        let found =
            Rgb::new(of(scattered.r, absorbed.r), of(scattered.g, absorbed.g), of(scattered.b, absorbed.b));
        let published = SUBSTANCES.iter().find(|s| s.0 == "skin1").expect("is in the table").1;
        let error = (found - published).map(f32::abs).max_component();
        assert!(error < 0.02, "{found:?}");
    }

    #[test]
    fn dark_pigment_makes_dark_hair() {
        let black = fibres(EUMELANIN * 8.0, 0.3);
        let blond = fibres(EUMELANIN * 0.3, 0.3);
        assert!(black.max_component() < 0.01 && blond.r > blond.b && blond.r > 0.1, "{black:?} {blond:?}");
    }
}
