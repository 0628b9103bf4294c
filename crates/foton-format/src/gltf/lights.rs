//! Lights of `KHR_lights_punctual`: candela and lux, divided by 683 lm/W, as Blender does when it exports and imports.
//!
//! Emission of surfaces stays as it stands, in W·m⁻²·sr⁻¹, which is Blender's convention as well.

use foton_math::Rgb;
use foton_math::glam::{DAffine3, DMat3, DVec3};
use foton_scene::description::{EmitterDescription, EmitterKind};

use super::json::At;
use super::reader::Reader;

impl<'a> Reader<'a> {
    /// Adds the light of a node.
    pub(super) fn light(&mut self, node: &At<'a>, light: &At<'a>, global: &DAffine3, name: &str) {
        let report = &mut self.report;
        let colour = light.numbers("color", report).unwrap_or([1.0; 3]);
        let most = f64::from(f32::MAX);
        let strength = light.number_in("intensity", (0.0, most), 1.0, report) * self.watts_per_lumen;
        let colour = Rgb::from_array(colour.map(|c| (c.max(0.0) * strength) as f32));
        if !colour.is_finite() {
            return light.error(report, "is too bright");
        }
        let Some(direction) = (-global.matrix3.z_axis).try_normalize() else {
            return node.error(report, "a light stands in a node that is scaled to nothing");
        };
        let kind = match light.text("type", report) {
            Some("point") => EmitterKind::Point { position: global.translation, intensity: colour },
            Some("directional") => EmitterKind::Directional { direction, irradiance: colour },
            Some("spot") => self.spot(light, direction, global.translation, colour),
            _ => return light.error(report, "needs a \"type\": point, spot or directional"),
        };
        if light.get("range").is_some() {
            self.notice("\"range\" is left out: light goes on", light);
        }
        if colour.is_black() {
            return self.notice("emits no light", light);
        }
        let name = self.unique(name);
        self.description.emitters.push(EmitterDescription { name, kind });
    }

    fn spot(&mut self, light: &At<'_>, direction: DVec3, position: DVec3, intensity: Rgb) -> EmitterKind {
        let report = &mut self.report;
        let cone = light.get("spot");
        let mut angle = |key: &str, most: f64, default: f64| {
            cone.as_ref().map_or(default, |cone| cone.number_in(key, (0.0, most), default, report))
        };
        let outer = angle("outerConeAngle", std::f64::consts::FRAC_PI_2, std::f64::consts::FRAC_PI_4);
        let inner = angle("innerConeAngle", outer, 0.0);
        if inner < outer {
            self.notice(
                "a spot fades linearly in the angle between its cones, not by the square of a cosine's share",
                light,
            );
        }
        let right = direction.any_orthonormal_vector();
        let turn = DMat3::from_cols(right, direction.cross(right), direction);
        EmitterKind::Spot {
            to_world: DAffine3::from_mat3_translation(turn, position),
            intensity,
            cutoff_degrees: outer.to_degrees().max(1e-3),
            beam_degrees: inner.to_degrees(),
            texture: None,
        }
    }
}
