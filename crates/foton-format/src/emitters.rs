//! `<emitter>` elements: area (inside shapes), point, spot and constant.

use foton_math::Rgb;
use foton_math::glam::{DAffine3, DVec3};
use foton_scene::description::{EmitterDescription, EmitterKind};

use crate::document::NodeId;
use crate::names::EMITTERS;
use crate::properties::{Object, Properties};
use crate::reader::Reader;

impl Reader<'_> {
    /// An emitter directly inside the scene.
    pub(crate) fn scene_emitter(&mut self, node: NodeId) {
        let Some(element) = self.document.element(node) else { return };
        let Some(plugin) = self.plugin(element, &EMITTERS) else { return };
        if plugin == "area" {
            self.loose_areas.insert(node, false);
            return;
        }
        let mut p = self.properties(node, plugin);
        let kind = match plugin {
            "point" => self.point(&mut p),
            "spot" => self.spot(&mut p),
            _ => self.constant(&mut p),
        };
        p.finish(&mut self.report);
        if let Some(kind) = kind {
            let name = self.name(element, plugin, self.description.emitters.len() + 1);
            self.description.emitters.push(EmitterDescription { name, kind });
        }
    }

    /// The radiance of an emitter inside a shape.
    pub(crate) fn area_emitter(&mut self, emitter: Object<'_>) -> Option<Rgb> {
        let plugin = self.plugin(emitter.element, &EMITTERS)?;
        if plugin != "area" {
            let message = format!("only an area emitter can stand inside a shape, not a {plugin} emitter");
            self.report.error(emitter.place, message);
            return None;
        }
        if let Some(used) = self.loose_areas.get_mut(&emitter.node) {
            *used = true;
        }
        let mut p = self.properties(emitter.node, "area");
        if let Some(to_world) = p.transform("to_world", &mut self.report) {
            self.report.error(to_world.place, "an area emitter takes its transform from its shape");
        }
        let radiance = p.emission("radiance", &mut self.report).unwrap_or(Rgb::WHITE);
        p.finish(&mut self.report);
        Some(radiance)
    }

    fn point(&mut self, p: &mut Properties<'_>) -> Option<EmitterKind> {
        let intensity = p.emission("intensity", &mut self.report).unwrap_or(Rgb::WHITE);
        let position = p.point("position", &mut self.report);
        let to_world = p.transform("to_world", &mut self.report);
        if let (Some(position), Some(_)) = (position, to_world) {
            self.report
                .error(position.place, "a point emitter has a \"position\" or a \"to_world\", not both");
            return None;
        }
        let position = position.map(|p| p.value).or(to_world.map(|t| t.value.translation));
        Some(EmitterKind::Point { position: position.unwrap_or(DVec3::ZERO), intensity })
    }

    fn spot(&mut self, p: &mut Properties<'_>) -> Option<EmitterKind> {
        let intensity = p.emission("intensity", &mut self.report).unwrap_or(Rgb::WHITE);
        let to_world = p.transform("to_world", &mut self.report).map_or(DAffine3::IDENTITY, |t| t.value);
        let cutoff = p.number("cutoff_angle", &mut self.report);
        let beam = p.number("beam_width", &mut self.report);
        p.refuse(&["texture"], &mut self.report);
        let cutoff_degrees = cutoff.map_or(20.0, |c| c.value);
        if let Some(cutoff) = cutoff.filter(|c| !(c.value > 0.0 && c.value <= 180.0)) {
            self.report.error(cutoff.place, "\"cutoff_angle\" must be above 0 and at most 180 degrees");
            return None;
        }
        let beam_degrees = beam.map_or(cutoff_degrees * 0.75, |b| b.value);
        if let Some(beam) = beam.filter(|b| b.value < 0.0) {
            self.report.error(beam.place, "\"beam_width\" must not be negative");
        } else if let Some(beam) = beam.filter(|b| b.value > cutoff_degrees) {
            let message =
                format!("\"beam_width\" is larger than \"cutoff_angle\" ({cutoff_degrees}) and is cut to it");
            self.report.warning(beam.place, message);
        }
        let beam_degrees = beam_degrees.min(cutoff_degrees);
        Some(EmitterKind::Spot { to_world, intensity, cutoff_degrees, beam_degrees })
    }

    fn constant(&mut self, p: &mut Properties<'_>) -> Option<EmitterKind> {
        let radiance = p.emission("radiance", &mut self.report).unwrap_or(Rgb::WHITE);
        p.ignore(&["to_world"]);
        if self.description.emitters.iter().any(|e| matches!(e.kind, EmitterKind::Constant { .. })) {
            self.report.error(p.place, "a scene has only one emitter around it");
            return None;
        }
        Some(EmitterKind::Constant { radiance })
    }
}
