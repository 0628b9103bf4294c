//! Materials of version 3.

use std::rc::Rc;

use foton_math::Rgb;
use foton_scene::description::{
    Bsdf, Conductor, Dielectric, Mirror, Number, Plastic, Principled, PrincipledThin,
};

use super::colours::Meaning;
use super::lobes::{Lobe, LobeKind, both_sides};
use super::made::Coordinates;
use super::parameters::Parameters;
use super::reader::Reader;
use super::texture::Picture;
use crate::mitsuba::read::known::Sides;
use crate::mitsuba::read::metals;

/// Names of roughness.
const ROUGHNESS: [&str; 3] = ["roughness", "uroughness", "vroughness"];

impl Reader<'_> {
    /// A material of version 3 that is not mixed.
    pub(super) fn old_material(&mut self, p: &Parameters, c: Coordinates) -> Option<Sides> {
        Some(match p.plugin.as_str() {
            "matte" => {
                let colour = self.picture(p, "Kd", 0.5);
                let sigma = self.number_picture(p, "sigma").and_then(|sigma| sigma.constant());
                let degrees = sigma.map_or(0.0, |sigma| sigma.mean().clamp(0.0, 90.0));
                let kind = LobeKind::Diffuse { sigma: degrees.to_radians() };
                self.sum(vec![Lobe { kind, colour }], c, p.place)
            }
            "plastic" => {
                let (diffuse, gloss) = (self.picture(p, "Kd", 0.25), self.picture(p, "Ks", 0.25));
                let roughness = self.facets(p, ROUGHNESS, (0.1, true), c);
                let kind = LobeKind::Gloss { ior: 1.5, roughness };
                self.coated(
                    vec![
                        Lobe { kind: LobeKind::Diffuse { sigma: 0.0 }, colour: diffuse },
                        Lobe { kind, colour: gloss },
                    ],
                    c,
                    p,
                )
            }
            "uber" => self.uber(p, c),
            "translucent" => self.translucent(p, c),
            "substrate" => self.substrate(p, c),
            "mirror" => {
                let colour = self.picture(p, "Kr", 0.9);
                both_sides(Bsdf::Mirror(Mirror { reflectance: self.share(&colour, 1.0, c, p.place) }))
            }
            "metal" => {
                let (eta, k) = metals::find("Cu").ok()?;
                let eta = self.colour(p, "eta", Meaning::Index).unwrap_or(eta);
                let k = self.colour(p, "k", Meaning::Index).unwrap_or(k);
                let roughness = self.facets(p, ROUGHNESS, (0.01, true), c);
                both_sides(Bsdf::Conductor(Conductor {
                    eta,
                    k,
                    specular_reflectance: Rgb::WHITE.into(),
                    roughness,
                }))
            }
            "glass" => {
                let (reflected, passed) = (self.picture(p, "Kr", 1.0), self.picture(p, "Kt", 1.0));
                let int_ior = self.index(p, if p.has("index") { "index" } else { "eta" }, 1.5);
                let roughness = self.facets(p, ROUGHNESS, (0.0, false), c);
                both_sides(Bsdf::Dielectric(Dielectric {
                    int_ior,
                    ext_ior: 1.0,
                    specular_reflectance: self.share(&reflected, 1.0, c, p.place),
                    specular_transmittance: self.share(&passed, 1.0, c, p.place),
                    roughness,
                }))
            }
            _ => self.disney(p, c),
        })
    }

    /// A diffuse and a glossy lobe: as they are where they reflect no more than all light together, else as a coat over a base.
    fn coated(&mut self, lobes: Vec<Lobe>, c: Coordinates, p: &Parameters) -> Sides {
        let (_, sum) = self.bounds(&lobes, c, p.place);
        let [Lobe { colour: diffuse, .. }, Lobe { kind: LobeKind::Gloss { ior, roughness }, colour: gloss }] =
            &lobes[..]
        else {
            return self.sum(lobes, c, p.place);
        };
        if sum <= 1.001 {
            return self.sum(lobes, c, p.place);
        }
        let message = "the diffuse and the glossy part of this material may reflect more than all light together: the glossy one is a coat that takes its light from the other".to_owned();
        self.report.warn_once(p.place, message);
        both_sides(Bsdf::Plastic(Plastic {
            int_ior: *ior,
            ext_ior: 1.0,
            diffuse_reflectance: self.share(diffuse, 1.0, c, p.place),
            specular_reflectance: self.share(gloss, 1.0, c, p.place),
            nonlinear: false,
            roughness: *roughness,
        }))
    }

    fn uber(&mut self, p: &Parameters, c: Coordinates) -> Sides {
        let [diffuse, gloss] = ["Kd", "Ks"].map(|name| self.picture(p, name, 0.25));
        let [mirror, passed] = ["Kr", "Kt"].map(|name| self.picture(p, name, 0.0));
        let ior = self.index(p, if p.has("index") { "index" } else { "eta" }, 1.5);
        let roughness = self.facets(p, ROUGHNESS, (0.1, true), c);
        let opacity = self.picture_of(p, "opacity", Meaning::Share);
        let lobes = vec![
            Lobe { kind: LobeKind::Diffuse { sigma: 0.0 }, colour: diffuse },
            Lobe { kind: LobeKind::Gloss { ior, roughness }, colour: gloss },
            Lobe { kind: LobeKind::Gloss { ior, roughness: None }, colour: mirror },
            Lobe { kind: LobeKind::Refraction { ior, roughness: None }, colour: passed },
        ];
        let is_black = |lobe: &Lobe| lobe.colour.constant().is_some_and(Rgb::is_black);
        let lobes: Vec<Lobe> = lobes.into_iter().filter(|lobe| !is_black(lobe)).collect();
        let mut sides = self.coated(lobes, c, p);
        if let Some(opacity) = opacity.filter(|o| o.constant() != Some(Rgb::WHITE)) {
            let share = self.share(&opacity, 1.0, c, p.place);
            let _ = sides.for_each(&mut |sides| {
                sides.opacity = Some(share);
                Ok::<_, ()>(())
            });
        }
        sides
    }

    fn translucent(&mut self, p: &Parameters, c: Coordinates) -> Sides {
        let [diffuse, gloss] = ["Kd", "Ks"].map(|name| self.picture(p, name, 0.25));
        let [reflected, passed] = ["reflect", "transmit"].map(|name| self.picture(p, name, 0.5));
        let roughness = self.facets(p, ROUGHNESS, (0.1, true), c);
        let product = |a: &Rc<Picture>, b: &Rc<Picture>| Picture::product(Rc::clone(a), Rc::clone(b));
        let lobes = vec![
            Lobe { kind: LobeKind::Diffuse { sigma: 0.0 }, colour: product(&reflected, &diffuse) },
            Lobe { kind: LobeKind::Passing, colour: product(&passed, &diffuse) },
            Lobe { kind: LobeKind::Gloss { ior: 1.5, roughness }, colour: product(&reflected, &gloss) },
            Lobe { kind: LobeKind::Refraction { ior: 1.5, roughness }, colour: product(&passed, &gloss) },
        ];
        self.sum(lobes, c, p.place)
    }

    /// Ashikhmin's and Shirley's coat over a base: a metal of the coat's reflectance blended with what is left for the base. `[AS00]`
    fn substrate(&mut self, p: &Parameters, c: Coordinates) -> Sides {
        let [diffuse, gloss] = ["Kd", "Ks"].map(|name| self.picture(p, name, 0.5));
        let roughness = self.facets(p, ROUGHNESS, (0.1, true), c);
        let message = "a blend of a metal and a diffuse base stands in for \"substrate\": it reflects as much at normal incidence".to_owned();
        self.report.warn_once(p.place, message);
        let mean = gloss.constant().map_or(0.5, |c| c.max_component()).clamp(0.0, 0.99);
        // The metal takes the square root of the coat's share, so that it can still grow towards grazing angles.
        let weight = mean.sqrt();
        let reflectance = gloss
            .constant()
            .map_or(Rgb::splat(weight), |ks| ks.map(|c| if weight > 0.0 { c / weight } else { 0.0 }));
        let (eta, k) = super::new_materials::metal_of(reflectance);
        let base = self.share(&diffuse, ((1.0 - mean) / (1.0 - weight)).min(1.0), c, p.place);
        let mut sides = both_sides(Bsdf::Diffuse(foton_scene::description::Diffuse { reflectance: base }));
        let metal = Conductor { eta, k, specular_reflectance: Rgb::WHITE.into(), roughness };
        sides.mixture.push((both_sides(Bsdf::Conductor(metal)), Number::Constant(weight)));
        sides
    }

    fn disney(&mut self, p: &Parameters, c: Coordinates) -> Sides {
        let colour = self.picture(p, "color", 0.5);
        let base_color = self.share(&colour, 1.0, c, p.place);
        let mut number = |name, default: f32| match self.number_picture(p, name) {
            Some(picture) => self.number(&picture, c, p.place),
            None => default.into(),
        };
        let (roughness, anisotropic) = (number("roughness", 0.5), number("anisotropic", 0.0));
        let (sheen, sheen_tint) = (number("sheen", 0.0), number("sheentint", 0.5));
        let (spec_tint, spec_trans) = (number("speculartint", 0.0), number("spectrans", 0.0));
        let (clearcoat, clearcoat_gloss) = (number("clearcoat", 0.0), number("clearcoatgloss", 1.0));
        let (metallic, flatness, diff_trans) =
            (number("metallic", 0.0), number("flatness", 0.0), number("difftrans", 1.0));
        let eta = self.index(p, "eta", 1.5);
        let is_thin = p.boolean("thin", &mut self.report).unwrap_or(false);
        if let Some(distance) = self.picture_of(p, "scatterdistance", Meaning::Index)
            && distance.constant() != Some(Rgb::BLACK)
        {
            let message =
                "light does not scatter below surfaces: \"scatterdistance\" has no effect".to_owned();
            self.report.warn_once(p.place, message);
        }
        both_sides(if is_thin {
            Bsdf::PrincipledThin(PrincipledThin {
                base_color,
                roughness,
                anisotropic,
                spec_trans,
                eta: eta.into(),
                spec_tint,
                sheen,
                sheen_tint,
                flatness,
                diff_trans,
            })
        } else {
            Bsdf::Principled(Principled {
                base_color,
                roughness,
                anisotropic,
                metallic,
                spec_trans,
                eta,
                spec_tint,
                sheen,
                sheen_tint,
                flatness: 0.0.into(),
                clearcoat,
                clearcoat_gloss,
            })
        })
    }
}
