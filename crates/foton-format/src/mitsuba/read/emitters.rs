//! `<emitter>` elements: area (inside shapes), point, directional, constant and envmap; others have files of their own.

use foton_math::glam::{DAffine3, DVec3};
use foton_scene::description::{Colour, EmitterDescription, EmitterKind};
use foton_scene::plugins::emitters::{
    CONSTANT, DIRECTION, ENVMAP, FILENAME, INTENSITY, IRRADIANCE, POSITION, RADIANCE, SCALE, TO_WORLD,
};

use crate::image::{Purpose, Reading};
use crate::mitsuba::document::NodeId;
use crate::mitsuba::names::EMITTERS;
use crate::mitsuba::read::properties::{Object, Properties};
use crate::mitsuba::read::reader::Reader;
use crate::mitsuba::read::transform::even_scale;

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
            "projector" => self.projector(&mut p),
            "goniometric" => self.goniometric(&mut p),
            "directional" => self.directional(&mut p),
            "envmap" => self.envmap(&mut p),
            "sunsky" | "sky" | "sun" => self.sky(plugin, &mut p),
            _ => self.constant(&mut p),
        };
        // It steers another renderer's sampling.
        p.ignore(&["sampling_weight"]);
        p.finish(&mut self.report);
        if let Some(kind) = kind {
            let name = self.name(element, plugin, self.description.emitters.len() + 1);
            self.nodes.emitters.push(node);
            if self.document.is_hidden(node) {
                self.description.hidden.emitters.insert(self.description.emitters.len());
            }
            self.description.emitters.push(EmitterDescription { name, kind });
        }
    }

    /// The radiance of an emitter inside a shape.
    pub(crate) fn area_emitter(&mut self, emitter: Object<'_>) -> Option<Colour> {
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
        if let Some(to_world) = p.transform(TO_WORLD.name, &mut self.report) {
            self.report.error(to_world.place, "an area emitter takes its transform from its shape");
        }
        let radiance = match p.texture(RADIANCE.name) {
            Some(texture) => self.texture_for(texture, Purpose::Light).map(Colour::Texture),
            None => Some(self.emission(&mut p, &RADIANCE).into()),
        };
        // It steers another renderer's sampling.
        p.ignore(&["sampling_weight"]);
        p.finish(&mut self.report);
        radiance
    }

    fn point(&mut self, p: &mut Properties<'_>) -> Option<EmitterKind> {
        let intensity = self.emission(p, &INTENSITY);
        let position = p.point(POSITION.name, &mut self.report);
        let to_world = p.transform(TO_WORLD.name, &mut self.report);
        if let (Some(position), Some(_)) = (position, to_world) {
            self.report
                .error(position.place, "a point emitter has a \"position\" or a \"to_world\", not both");
            return None;
        }
        let position = position.map(|p| p.value).or(to_world.map(|t| t.value.translation));
        Some(EmitterKind::Point { position: position.unwrap_or(DVec3::ZERO), intensity })
    }

    fn directional(&mut self, p: &mut Properties<'_>) -> Option<EmitterKind> {
        let irradiance = self.emission(p, &IRRADIANCE);
        let direction = p.point(DIRECTION.name, &mut self.report);
        let to_world = p.transform(TO_WORLD.name, &mut self.report);
        if let (Some(direction), Some(_)) = (direction, to_world) {
            let message = "a directional emitter has a \"direction\" or a \"to_world\", not both";
            self.report.error(direction.place, message);
            return None;
        }
        if let Some(direction) = direction.filter(|d| d.value.try_normalize().is_none()) {
            self.report.error(direction.place, "\"direction\" must not be zero");
            return None;
        }
        let turned = to_world.map(|t| t.value.matrix3.z_axis);
        let direction = direction.map(|d| d.value).or(turned).unwrap_or(DVec3::Z);
        Some(EmitterKind::Directional { direction, irradiance })
    }

    fn constant(&mut self, p: &mut Properties<'_>) -> Option<EmitterKind> {
        let radiance = self.emission(p, &RADIANCE);
        p.leave_out(CONSTANT.parameters, &mut self.report);
        self.is_first_around(p).then_some(EmitterKind::Constant { radiance })
    }

    #[allow(clippy::cast_possible_truncation, reason = "radiance is single precision")]
    fn envmap(&mut self, p: &mut Properties<'_>) -> Option<EmitterKind> {
        let scale = p.number(SCALE.name, &mut self.report);
        if let Some(scale) = scale.filter(|s| !SCALE.holds(s.value)) {
            self.report.error(scale.place, "\"scale\" must not be negative or above 1e30");
        }
        let transform = p.transform(TO_WORLD.name, &mut self.report);
        if let Some(t) = transform.filter(|t| even_scale(t.value.matrix3, 1e-3).is_none()) {
            self.report.error(t.place, "the transform of an envmap must not stretch or shear");
        }
        p.leave_out(ENVMAP.parameters, &mut self.report);
        if !p.has(FILENAME.name) {
            self.report.error(p.place, "an envmap needs a \"filename\"");
        }
        let filename = p.string(FILENAME.name, &mut self.report)?;
        if !self.is_first_around(p) {
            return None;
        }
        let bitmap = self.images.read(&filename, Reading::LIGHT, &mut self.files, &mut self.report)?;
        let to_world = transform.map_or(DAffine3::IDENTITY, |t| t.value);
        Some(EmitterKind::Environment {
            to_world,
            bitmap,
            scale: scale.map_or(SCALE.default_number(), |s| s.value as f32),
        })
    }

    /// Whether there is no other emitter all around; otherwise an error.
    pub(super) fn is_first_around(&mut self, p: &Properties<'_>) -> bool {
        let first = !self.description.emitters.iter().any(|e| e.kind.is_around());
        if !first {
            self.report.error(p.place, "a scene has only one emitter around it");
        }
        first
    }
}
