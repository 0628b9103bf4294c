//! The directive `LightSource`: lights that are not surfaces.

use std::f64::consts::PI;

use foton_input::quoted;
use foton_math::Rgb;
use foton_math::glam::{DAffine3, DMat3, DVec3};
use foton_scene::description::{EmitterDescription, EmitterKind};

use super::colours::Meaning;
use super::parameters::{COLOURS, Kind, Parameters};
use super::reader::Reader;
use crate::image::{Purpose, Reading};
use crate::spelling::did_you_mean;

/// Lights of both versions.
const LIGHTS: [&str; 6] = ["point", "spot", "distant", "infinite", "goniometric", "projection"];

impl Reader<'_> {
    /// Reads a light.
    pub(crate) fn light_source(&mut self, p: &Parameters) {
        p.ignore(&["nsamples", "samples"]);
        let kind = match p.plugin.as_str() {
            "point" => self.point_light(p),
            "goniometric" => self.goniometric(p),
            "spot" => self.spot(p),
            "projection" => self.projection(p),
            "distant" => self.distant(p),
            "infinite" | "exinfinite" => self.infinite(p),
            other => {
                p.ignore_rest();
                let hint = did_you_mean(other, LIGHTS);
                self.report.error(p.place, format!("unknown light {}{hint}", quoted(other)));
                None
            }
        };
        p.finish(&mut self.report);
        if self.state.transforms.0[0] != self.state.transforms.0[1] {
            self.report.warn_once(p.place, "lights that are not surfaces stand still".to_owned());
        }
        let Some(kind) = kind else { return };
        let name = format!("{}-{}", p.plugin, self.description.emitters.len() + 1);
        self.remember(&name, p.place);
        self.description.emitters.push(EmitterDescription { name, kind });
    }

    /// The factor of a light: a number, or in version 3 a colour.
    pub(crate) fn light_scale(&mut self, p: &Parameters) -> Rgb {
        let kinds = [COLOURS, &[Kind::Float]].concat();
        let Some(found) = p.find("scale", &kinds, &mut self.report) else { return Rgb::WHITE };
        if found.kind != Kind::Float {
            return self.colour_of(found, Meaning::Share).unwrap_or(Rgb::WHITE);
        }
        let Some(scale) = p.number("scale", &mut self.report) else { return Rgb::WHITE };
        #[allow(clippy::cast_possible_truncation, reason = "light is single precision")]
        let factor = scale.value as f32;
        if factor >= 0.0 && factor.is_finite() {
            return Rgb::splat(factor);
        }
        self.report.error(scale.place, "\"scale\" must not be negative");
        Rgb::WHITE
    }

    /// Light of a parameter with its factor, scaled further where its power is stated: so much of that there is of light 1.
    fn scaled_light(
        &mut self,
        p: &Parameters,
        name: &'static str,
        total: &'static str,
        of_one: f64,
    ) -> Option<Rgb> {
        let light = self.light(p, name) * self.light_scale(p);
        let stated = p.number(total, &mut self.report).map(|n| n.value).filter(|n| *n > 0.0);
        #[allow(clippy::cast_possible_truncation, reason = "light is single precision")]
        let light = stated.map_or(light, |stated| light * (stated / of_one) as f32);
        if !light.is_finite() {
            self.report.error(p.place, "what this light emits is too much for a number");
            return None;
        }
        Some(light)
    }

    /// Where a point light is.
    fn light_position(&mut self, p: &Parameters) -> DVec3 {
        let from = p.point("from", &mut self.report).map_or(DVec3::ZERO, |from| from.value);
        // Version 3 moves a point light after its transform, version 4 before.
        if self.is_old() { self.in_world(DVec3::ZERO) + from } else { self.in_world(from) }
    }

    fn point_light(&mut self, p: &Parameters) -> Option<EmitterKind> {
        let intensity = self.scaled_light(p, "I", "power", 4.0 * PI)?;
        Some(EmitterKind::Point { position: self.light_position(p), intensity })
    }

    /// The mean of the picture that a light shines through; 1 where there is none.
    fn mean_of_map(&mut self, p: &Parameters) -> Option<Rgb> {
        let name = if p.has("mapname") { "mapname" } else { "filename" };
        let Some(filename) = p.text(name, &mut self.report) else { return Some(Rgb::WHITE) };
        let bitmap = self.images.read(&filename, Reading::LIGHT, &mut self.files, &mut self.report)?;
        Some(bitmap.pixels.iter().copied().sum::<Rgb>() / bitmap.pixels.len() as f32)
    }

    fn goniometric(&mut self, p: &Parameters) -> Option<EmitterKind> {
        let mean = self.mean_of_map(p)?;
        let message = "a point that shines evenly stands in for a \"goniometric\" light: it has the mean of its picture";
        self.report.warn_once(p.place, message.to_owned());
        let intensity = self.scaled_light(p, "I", "power", 4.0 * PI)? * mean;
        Some(EmitterKind::Point { position: self.in_world(DVec3::ZERO), intensity })
    }

    /// Light along the direction of a frame at a point of the current space.
    fn aimed(&self, from: DVec3, direction: DVec3) -> Option<DAffine3> {
        let z = self.place().transform_vector3(direction).try_normalize()?;
        let x = z.any_orthonormal_vector();
        Some(DAffine3::from_mat3_translation(DMat3::from_cols(x, z.cross(x), z), self.in_world(from)))
    }

    fn spot(&mut self, p: &Parameters) -> Option<EmitterKind> {
        let from = p.point("from", &mut self.report).map_or(DVec3::ZERO, |from| from.value);
        let to = p.point("to", &mut self.report).map_or(DVec3::Z, |to| to.value);
        let cutoff_degrees = p.number_or("coneangle", 30.0, &mut self.report);
        let delta = p.number_or("conedeltaangle", 5.0, &mut self.report);
        if !(cutoff_degrees > 0.0 && cutoff_degrees <= 180.0) {
            self.report
                .error(p.place_of("coneangle"), "\"coneangle\" must be above 0 and at most 180 degrees");
            return None;
        }
        let beam_degrees = (cutoff_degrees - delta).clamp(0.0, cutoff_degrees);
        let [begin, end] = [beam_degrees, cutoff_degrees].map(|degrees: f64| degrees.to_radians().cos());
        let intensity =
            self.scaled_light(p, "I", "power", 2.0 * PI * ((1.0 - begin) + 0.5 * (begin - end)))?;
        let Some(to_world) = self.aimed(from, to - from) else {
            self.report.error(p.place, "\"from\" and \"to\" of a light are the same point");
            return None;
        };
        Some(EmitterKind::Spot { to_world, intensity, cutoff_degrees, beam_degrees, texture: None })
    }

    fn projection(&mut self, p: &Parameters) -> Option<EmitterKind> {
        let mean = self.mean_of_map(p)?;
        let message = "a spot stands in for a \"projection\" light: it has the mean of its picture";
        self.report.warn_once(p.place, message.to_owned());
        let fov = p.number_or("fov", 45.0, &mut self.report).clamp(0.1, 179.0);
        let intensity =
            self.scaled_light(p, "I", "power", 2.0 * PI * (1.0 - (0.5 * fov).to_radians().cos()))? * mean;
        let to_world = self.aimed(DVec3::ZERO, DVec3::Z)?;
        Some(EmitterKind::Spot {
            to_world,
            intensity,
            cutoff_degrees: 0.5 * fov,
            beam_degrees: 0.5 * fov,
            texture: None,
        })
    }

    fn distant(&mut self, p: &Parameters) -> Option<EmitterKind> {
        let from = p.point("from", &mut self.report).map_or(DVec3::ZERO, |from| from.value);
        let to = p.point("to", &mut self.report).map_or(DVec3::Z, |to| to.value);
        let irradiance = self.scaled_light(p, "L", "illuminance", 1.0)?;
        let direction = self.place().transform_vector3(to - from);
        if direction.try_normalize().is_none() {
            self.report.error(p.place, "\"from\" and \"to\" of a light are the same point");
            return None;
        }
        Some(EmitterKind::Directional { direction, irradiance })
    }

    fn infinite(&mut self, p: &Parameters) -> Option<EmitterKind> {
        if p.has("portal") {
            p.ignore(&["portal"]);
            self.report.warn_once(
                p.place_of("portal"),
                "light from all around comes through no portal: \"portal\" has no effect".to_owned(),
            );
        }
        let radiance = self.scaled_light(p, "L", "illuminance", PI)?;
        // Version 3 has latitudes and longitudes in its "mapname", version 4 a square in its "filename".
        let [old, new] = ["mapname", "filename"].map(|name| p.text(name, &mut self.report));
        let kind = match (old, new) {
            (Some(filename), _) => self.latitudes(&filename, radiance, p.place)?,
            (None, Some(filename)) => self.square(&filename, radiance, p.place)?,
            _ => EmitterKind::Constant { radiance },
        };
        let around = |e: &EmitterDescription| {
            matches!(e.kind, EmitterKind::Constant { .. } | EmitterKind::Environment { .. })
        };
        let Some(first) = self.description.emitters.iter_mut().find(|e| around(e)) else { return Some(kind) };
        match (&mut first.kind, kind) {
            (EmitterKind::Constant { radiance }, EmitterKind::Constant { radiance: more }) => {
                *radiance += more;
            }
            _ => self.report.error(
                p.place,
                "a scene has only one light around it that has a picture, and no other one beside that",
            ),
        }
        None
    }

    /// The pixels of a light's picture.
    pub(super) fn light_map(
        &mut self,
        filename: &crate::mitsuba::read::properties::Located<String>,
        factor: Rgb,
    ) -> Option<std::sync::Arc<foton_scene::description::Bitmap>> {
        let reading = Reading { factor, purpose: Purpose::Light, ..Reading::LIGHT };
        self.images.read(filename, reading, &mut self.files, &mut self.report)
    }
}
