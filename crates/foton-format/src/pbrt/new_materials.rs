//! Materials of version 4.

use foton_math::Rgb;
use foton_scene::description::{
    Bsdf, Coating, Colour, Conductor, Dielectric, Diffuse, Mirror, Null, Plastic, ThinDielectric,
};

use super::colours::Meaning;
use super::lobes::{Lobe, LobeKind, both_sides};
use super::made::Coordinates;
use super::parameters::{COLOURS, Kind, Parameters};
use super::reader::Reader;
use crate::mitsuba::read::known::Sides;
use crate::mitsuba::read::metals;

/// Names of roughness, of a conductor's under a coat, and of the coat's.
const ROUGHNESS: [&str; 3] = ["roughness", "uroughness", "vroughness"];
const OF_CONDUCTOR: [&str; 3] = ["conductor.roughness", "conductor.uroughness", "conductor.vroughness"];
const OF_INTERFACE: [&str; 3] = ["interface.roughness", "interface.uroughness", "interface.vroughness"];

impl Reader<'_> {
    /// A material of version 4 that is not mixed.
    pub(super) fn new_material(&mut self, p: &Parameters, c: Coordinates) -> Option<Sides> {
        Some(match p.plugin.as_str() {
            "diffuse" => {
                let colour = self.picture(p, "reflectance", 0.5);
                both_sides(Bsdf::Diffuse(Diffuse { reflectance: self.share(&colour, 1.0, c, p.place) }))
            }
            "coateddiffuse" => {
                let colour = self.picture(p, "reflectance", 0.5);
                let int_ior = self.index(p, "eta", 1.5);
                let roughness = self.facets(p, ROUGHNESS, (0.0, false), c);
                self.clear_layer(p);
                both_sides(Bsdf::Plastic(Plastic {
                    int_ior,
                    ext_ior: 1.0,
                    diffuse_reflectance: self.share(&colour, 1.0, c, p.place),
                    specular_reflectance: Rgb::WHITE.into(),
                    // Light between layers takes on the colour of the lower one each time.
                    nonlinear: true,
                    roughness,
                }))
            }
            "conductor" => {
                let roughness = self.facets(p, ROUGHNESS, (0.0, false), c);
                both_sides(self.conductor(p, ["eta", "k"], 1.0, (c, roughness))?)
            }
            "coatedconductor" => self.coated_conductor(p, c)?,
            "dielectric" => {
                let int_ior = self.index(p, "eta", 1.5);
                let roughness = self.facets(p, ROUGHNESS, (0.0, false), c);
                let white = || Colour::from(Rgb::WHITE);
                let (specular_reflectance, specular_transmittance) = (white(), white());
                both_sides(Bsdf::Dielectric(Dielectric {
                    int_ior,
                    ext_ior: 1.0,
                    specular_reflectance,
                    specular_transmittance,
                    roughness,
                }))
            }
            "thindielectric" => both_sides(Bsdf::ThinDielectric(ThinDielectric {
                int_ior: self.index(p, "eta", 1.5),
                ext_ior: 1.0,
                specular_reflectance: Rgb::WHITE.into(),
                specular_transmittance: Rgb::WHITE.into(),
            })),
            "diffusetransmission" => {
                #[allow(clippy::cast_possible_truncation, reason = "optics is single precision")]
                let scale = p.number_or("scale", 1.0, &mut self.report) as f32;
                let [reflected, passed] =
                    ["reflectance", "transmittance"].map(|name| self.picture(p, name, 0.25).times(scale));
                let lobes = vec![
                    Lobe { kind: LobeKind::Diffuse { sigma: 0.0 }, colour: reflected },
                    Lobe { kind: LobeKind::Passing, colour: passed },
                ];
                self.sum(lobes, c, p.place)
            }
            // "interface", or of version 3 "none".
            _ => both_sides(Bsdf::Null(Null)),
        })
    }

    /// A metal under a clear coat.
    fn coated_conductor(&mut self, p: &Parameters, c: Coordinates) -> Option<Sides> {
        let roughness = self.facets(p, OF_CONDUCTOR, (0.0, false), c);
        let int_ior = self.index(p, "interface.eta", 1.5);
        let base = self.conductor(p, ["conductor.eta", "conductor.k"], int_ior, (c, roughness))?;
        let roughness = self.facets(p, OF_INTERFACE, (0.0, false), c);
        self.clear_layer(p);
        let mut coating = Coating::default(roughness.is_some());
        (coating.int_ior, coating.ext_ior, coating.roughness) = (int_ior, 1.0, roughness);
        Some(Sides { coatings: [Some(coating); 2], ..both_sides(base) })
    }

    /// A metal by its indices or its reflectance, in a medium of an index.
    fn conductor(
        &mut self,
        p: &Parameters,
        [eta_name, k_name]: [&'static str; 2],
        outside: f32,
        (c, roughness): (Coordinates, Option<foton_scene::bsdf::Microfacets>),
    ) -> Option<Bsdf> {
        let stated = [eta_name, k_name].map(|name| self.index_colour(p, name));
        if let Some(picture) = self.picture_of(p, "reflectance", Meaning::Share) {
            if stated.iter().any(Option::is_some) {
                self.report.error(
                    p.place,
                    format!("a conductor has a \"reflectance\" or \"{eta_name}\" and \"{k_name}\", not both"),
                );
            }
            // What reflects that share at normal incidence grows towards grazing angles; of a texture it is the same at all.
            return Some(match (picture.constant(), roughness) {
                (Some(reflectance), _) => {
                    let (eta, k) = metal_of(reflectance);
                    Bsdf::Conductor(Conductor { eta, k, specular_reflectance: Rgb::WHITE.into(), roughness })
                }
                (None, None) => Bsdf::Mirror(Mirror { reflectance: self.share(&picture, 1.0, c, p.place) }),
                (None, Some(_)) => Bsdf::Conductor(Conductor {
                    eta: Rgb::BLACK,
                    k: Rgb::WHITE,
                    specular_reflectance: self.share(&picture, 1.0, c, p.place),
                    roughness,
                }),
            });
        }
        let copper = metals::find("Cu").ok()?;
        let (eta, k) = (stated[0].unwrap_or(copper.0), stated[1].unwrap_or(copper.1));
        let (eta, k) = (eta / outside, k / outside);
        Some(Bsdf::Conductor(Conductor { eta, k, specular_reflectance: Rgb::WHITE.into(), roughness }))
    }

    /// A part of an index of refraction by channel.
    fn index_colour(&mut self, p: &Parameters, name: &'static str) -> Option<Rgb> {
        let kinds = [COLOURS, &[Kind::Float]].concat();
        let found = p.find(name, &kinds, &mut self.report)?;
        if found.kind != Kind::Float {
            return self.colour_of(found, Meaning::Index);
        }
        #[allow(clippy::cast_possible_truncation, reason = "optics is single precision")]
        p.number(name, &mut self.report).map(|n| Rgb::splat(n.value as f32))
    }

    /// An index of refraction; of a spectrum its mean.
    pub(super) fn index(&mut self, p: &Parameters, name: &'static str, default: f32) -> f32 {
        let kinds = [COLOURS, &[Kind::Float, Kind::Texture]].concat();
        let found = match p.find(name, &kinds, &mut self.report).map(|found| (found.kind, found)) {
            Some((Kind::Float, _)) => self.number_picture(p, name).and_then(|picture| picture.constant()),
            Some((Kind::Texture, found)) => {
                let constant = found.pictures[0].as_ref().and_then(|picture| picture.constant());
                if constant.is_none() {
                    self.report.warning(
                        found.place,
                        format!("\"{name}\" is the same everywhere: {default} is taken"),
                    );
                }
                constant
            }
            Some((_, found)) => self.colour_of(found, Meaning::Index),
            None => None,
        };
        let Some(index) = found.map(Rgb::mean) else { return default };
        if index > 0.0 && index.is_normal() {
            return index;
        }
        self.report.error(p.place_of(name), "an index of refraction must be above zero");
        default
    }

    /// What layers say of the medium between them: it is clear here.
    fn clear_layer(&mut self, p: &Parameters) {
        p.ignore(&["thickness", "interface.thickness", "maxdepth", "nsamples", "g"]);
        let albedo = self.picture_of(p, "albedo", Meaning::Share);
        if albedo.is_some_and(|albedo| albedo.constant() != Some(Rgb::BLACK)) {
            let message = "layers have clear media between them: \"albedo\" has no effect".to_owned();
            self.report.warn_once(p.place_of("albedo"), message);
        }
    }
}

/// The indices of a metal that reflects such shares at normal incidence: eta 1, and k to match.
pub(super) fn metal_of(reflectance: Rgb) -> (Rgb, Rgb) {
    let k = |r: f32| {
        let r = r.clamp(0.0, 0.9999);
        2.0 * r.sqrt() / (1.0 - r).sqrt()
    };
    (Rgb::WHITE, reflectance.map(k))
}
