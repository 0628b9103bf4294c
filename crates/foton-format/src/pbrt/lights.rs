//! The directive `LightSource`: lights that are not surfaces.

use std::f64::consts::PI;
use std::sync::Arc;

use foton_input::quoted;
use foton_math::Rgb;
use foton_math::glam::{DAffine3, DMat3, DVec2, DVec3};
use foton_scene::description::{
    Bitmap, Colour, EmitterDescription, EmitterKind, FovAxis, Texture, TextureKind, Wrap,
};

use super::colours::Meaning;
use super::parameters::{COLOURS, Kind, Parameters};
use super::reader::Reader;
use crate::image::{Purpose, Reading};
use crate::mitsuba::read::properties::Located;
use crate::mitsuba::read::textures::TURN;
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

    /// The file of a light's picture.
    fn map_name(&mut self, p: &Parameters) -> Option<Located<String>> {
        let name = if p.has("mapname") { "mapname" } else { "filename" };
        p.text(name, &mut self.report)
    }

    fn goniometric(&mut self, p: &Parameters) -> Option<EmitterKind> {
        let intensity = self.scaled_light(p, "I", "power", 4.0 * PI)?;
        let Some(filename) = self.map_name(p) else {
            return Some(EmitterKind::Point { position: self.in_world(DVec3::ZERO), intensity });
        };
        self.measured_lamp(&filename, intensity, p.place)
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

    /// A picture that is thrown along z; what it has in a direction is the intensity there.
    fn projection(&mut self, p: &Parameters) -> Option<EmitterKind> {
        let fov_degrees = p.number_or("fov", if self.is_old() { 45.0 } else { 90.0 }, &mut self.report);
        let filename = self.map_name(p);
        if filename.is_none() {
            self.report.error(p.place, "a projection light needs a picture");
        }
        if !(fov_degrees > 0.0 && fov_degrees < 180.0) {
            self.report.error(p.place_of("fov"), "\"fov\" must lie between 0 and 180 degrees");
            return None;
        }
        let picture = self.light_map(&filename?, Rgb::WHITE)?;
        let (projected, solid) = as_irradiance(&picture, fov_degrees);
        let intensity = self.scaled_light(p, "I", "power", solid)?;
        let pixels = projected.pixels.iter().map(|c| *c * intensity).collect();
        let bitmap = Arc::new(Bitmap::new(projected.width, projected.height, pixels));
        if !self.take(2 * size_of_val(&bitmap.pixels[..]) as u64, p.place) {
            return None;
        }
        let texture = self.description.textures.len();
        let kind = TextureKind::Bitmap { bitmap, wrap: Wrap::Clamp, bilinear: true };
        let name = format!("projection-{}", texture + 1);
        self.description.textures.push(Texture { name, to_uv: TURN, kind });
        // The picture has +x to its right in pbrt; in version 3 it stands upside down.
        let upright = if self.is_old() { -1.0 } else { 1.0 };
        let to_world = self.rigid(p.place)? * DAffine3::from_scale(DVec3::new(-1.0, upright, 1.0));
        let irradiance = Colour::Texture(texture);
        Some(EmitterKind::Projector {
            to_world,
            irradiance,
            scale: 1.0,
            fov_degrees,
            fov_axis: FovAxis::Smaller,
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
    pub(super) fn light_map(&mut self, filename: &Located<String>, factor: Rgb) -> Option<Arc<Bitmap>> {
        let reading = Reading { factor, purpose: Purpose::Light, ..Reading::LIGHT };
        self.images.read(filename, reading, &mut self.files, &mut self.report)
    }
}

/// What a picture of intensities sends to a plane at distance 1, over π, and the integral of its luminance over directions.
fn as_irradiance(picture: &Bitmap, fov_degrees: f64) -> (Bitmap, f64) {
    let (width, height) = (f64::from(picture.width), f64::from(picture.height));
    let half = (0.5 * fov_degrees).to_radians().tan() / width.min(height);
    let mut total = 0.0;
    let pixel = |(i, c): (usize, &Rgb)| {
        let (x, y) = (i % picture.width as usize, i / picture.width as usize);
        let at = DVec2::new(2.0 * x as f64 + 1.0 - width, 2.0 * y as f64 + 1.0 - height) * half;
        let cosine3 = (1.0 + at.length_squared()).sqrt().recip().powi(3);
        total += f64::from(c.luminance()) * cosine3 * 4.0 * half * half;
        #[allow(clippy::cast_possible_truncation, reason = "light is single precision")]
        let factor = (cosine3 / PI) as f32;
        *c * factor
    };
    let pixels = picture.pixels.iter().enumerate().map(pixel).collect();
    (Bitmap::new(picture.width, picture.height, pixels), total)
}
