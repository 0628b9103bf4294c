//! Materials that are not modelled, and what stands in for them.

use foton_math::Rgb;
use foton_scene::bsdf::{MicrofacetDistribution, Microfacets};
use foton_scene::description::{Bsdf, Diffuse, Plastic};

use super::colours::Meaning;
use super::lobes::both_sides;
use super::made::Coordinates;
use super::parameters::Parameters;
use super::reader::Reader;
use crate::mitsuba::read::known::Sides;
use crate::mitsuba::read::stand_ins::{EUMELANIN, PHEOMELANIN, fibres, much_scattering, substance};

/// Scattering and absorption by a millimetre, where a file states none.
const SCATTERING: Rgb = Rgb::new(2.55, 3.21, 3.77);
const ABSORPTION: Rgb = Rgb::new(0.0011, 0.0024, 0.014);

impl Reader<'_> {
    /// What stands in for a material that is not modelled.
    pub(super) fn substitute(&mut self, p: &Parameters, c: Coordinates) -> Option<Sides> {
        match p.plugin.as_str() {
            "hair" => Some(self.hair(p)),
            "subsurface" | "kdsubsurface" => Some(self.skin(p, c)),
            name => {
                p.ignore_rest();
                let message = format!(
                    "the material \"{name}\" has its reflection in a file of measurements, which is not read"
                );
                if self.files.allows_missing() {
                    self.report.warn_once(p.place, format!("{message}: it is magenta"));
                    return Some(both_sides(Bsdf::Diffuse(Diffuse {
                        reflectance: Rgb::new(0.8, 0.0, 0.8).into(),
                    })));
                }
                self.report.error(p.place, message);
                self.report.help("--allow-missing opens the scene with magenta for it");
                None
            }
        }
    }

    /// A rough coat over the colour that many fibres have together.
    fn hair(&mut self, p: &Parameters) -> Sides {
        let message = "a rough coat over a diffuse colour stands in for \"hair\"".to_owned();
        self.report.warn_once(p.place, message);
        let mut number = |name, default: f32| {
            let found = self.number_picture(p, name).and_then(|picture| picture.constant());
            found.map_or(default, |c| c.mean().max(0.0))
        };
        let has_pigment =
            ["sigma_a", "color", "reflectance", "eumelanin", "pheomelanin"].iter().any(|name| p.has(name));
        let pigments = [number("eumelanin", if has_pigment { 0.0 } else { 1.3 }), number("pheomelanin", 0.0)];
        let (along, around) = (number("beta_m", 0.3), number("beta_n", 0.3).min(1.0));
        number("alpha", 2.0);
        let int_ior = self.index(p, "eta", 1.55);
        let name = if p.has("color") { "color" } else { "reflectance" };
        let colour = self.picture_of(p, name, Meaning::Share).and_then(|picture| picture.constant());
        let absorption = self.picture_of(p, "sigma_a", Meaning::Index).and_then(|picture| picture.constant());
        let absorption = absorption.unwrap_or(EUMELANIN * pigments[0] + PHEOMELANIN * pigments[1]);
        let diffuse_reflectance =
            colour.unwrap_or_else(|| fibres(absorption, around)).map(|c| c.min(1.0)).into();
        let roughness = Some(Microfacets::isotropic(MicrofacetDistribution::Ggx, along.max(0.05)));
        both_sides(plastic(diffuse_reflectance, int_ior, roughness))
    }

    /// A coat over what much scattering reflects.
    fn skin(&mut self, p: &Parameters, c: Coordinates) -> Sides {
        let message = format!(
            "a coat over a diffuse colour stands in for \"{}\": light does not scatter below surfaces",
            p.plugin
        );
        self.report.warn_once(p.place, message);
        p.ignore(&["mfp", "scale", "Kr", "Kt"]);
        let int_ior = self.index(p, "eta", if p.plugin == "kdsubsurface" { 1.3 } else { 1.33 });
        let roughness = self.facets(p, ["roughness", "uroughness", "vroughness"], (0.0, false), c);
        let name = if p.plugin == "kdsubsurface" { "Kd" } else { "reflectance" };
        let stated = self.picture_of(p, name, Meaning::Share);
        let named = p.text("name", &mut self.report).and_then(|name| substance(&name.value.to_lowercase()));
        let scattering = if p.has("sigma_prime_s") { "sigma_prime_s" } else { "sigma_s" };
        let mut sigma = |name, default| {
            let found = self.picture_of(p, name, Meaning::Index).and_then(|picture| picture.constant());
            found.unwrap_or(default)
        };
        let (scattered, absorbed) = (sigma(scattering, SCATTERING), sigma("sigma_a", ABSORPTION));
        let forwards = p.number_or("g", 0.0, &mut self.report).clamp(-1.0, 0.999);
        #[allow(clippy::cast_possible_truncation, reason = "optics is single precision")]
        let scattered = if scattering == "sigma_s" { scattered * (1.0 - forwards) as f32 } else { scattered };
        let lost = (scattered + absorbed).map(|c| c.max(f32::MIN_POSITIVE)).to_array();
        let [r, g, b] = scattered.to_array();
        let albedo = Rgb::new(r / lost[0], g / lost[1], b / lost[2]);
        let default = if p.plugin == "kdsubsurface" { Some(Rgb::splat(0.5)) } else { named };
        let colour = match stated {
            Some(picture) => self.share(&picture, 1.0, c, p.place),
            None => default.unwrap_or_else(|| albedo.map(|a| much_scattering(a, int_ior))).into(),
        };
        both_sides(plastic(colour, int_ior, roughness))
    }
}

fn plastic(
    diffuse_reflectance: foton_scene::description::Colour,
    int_ior: f32,
    roughness: Option<Microfacets>,
) -> Bsdf {
    Bsdf::Plastic(Plastic {
        int_ior,
        ext_ior: 1.0,
        diffuse_reflectance,
        specular_reflectance: Rgb::WHITE.into(),
        nonlinear: false,
        roughness,
    })
}
