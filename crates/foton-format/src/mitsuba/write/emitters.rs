//! Emitters that are not surfaces, as `<emitter>` elements.

use foton_film::WriteError;
use foton_scene::description::{Colour, EmitterDescription, EmitterKind};
use foton_scene::plugins::{emitters, sensors};

use super::Writer;
use super::xml::{colour, number, single, vector};

impl Writer<'_> {
    pub(super) fn emitter(
        &mut self,
        emitter: &EmitterDescription,
        is_hidden: bool,
    ) -> Result<(), WriteError> {
        let id = self.id(&emitter.name);
        let filename = match &emitter.kind {
            EmitterKind::Environment { bitmap, .. } | EmitterKind::Goniometric { bitmap, .. } => {
                self.bitmap(bitmap, &id)?
            }
            _ => String::new(),
        };
        let xml = &mut self.xml;
        xml.open("emitter", &[("type", emitters::of(&emitter.kind).name), ("id", &id)]);
        if is_hidden {
            xml.hidden();
        }
        match &emitter.kind {
            EmitterKind::Point { position, intensity } => {
                xml.value("point", emitters::POSITION.name, &vector(*position));
                xml.value("rgb", emitters::INTENSITY.name, &colour(*intensity));
            }
            EmitterKind::Spot { to_world, intensity, cutoff_degrees, beam_degrees, texture } => {
                xml.value("rgb", emitters::INTENSITY.name, &colour(*intensity));
                xml.value("float", emitters::CUTOFF_ANGLE.name, &number(*cutoff_degrees));
                xml.value("float", emitters::BEAM_WIDTH.name, &number(*beam_degrees));
                xml.transform("to_world", to_world);
                if let Some(texture) = texture {
                    self.colour(emitters::TEXTURE.name, Colour::Texture(*texture));
                }
            }
            EmitterKind::Constant { radiance } => {
                xml.value("rgb", emitters::RADIANCE.name, &colour(*radiance));
            }
            EmitterKind::Directional { direction, irradiance } => {
                xml.value("vector", emitters::DIRECTION.name, &vector(*direction));
                xml.value("rgb", emitters::IRRADIANCE.name, &colour(*irradiance));
            }
            EmitterKind::Projector { to_world, irradiance, scale, fov_degrees, fov_axis } => {
                xml.value("float", emitters::PROJECTED_SCALE.name, &number(*scale));
                xml.value("float", sensors::FOV.name, &number(*fov_degrees));
                xml.value("string", sensors::FOV_AXIS.name, fov_axis.name());
                xml.transform("to_world", to_world);
                self.colour(emitters::PROJECTED.name, *irradiance);
            }
            EmitterKind::Goniometric { to_world, scale, .. } => {
                xml.value("string", emitters::INTENSITIES.name, &filename);
                xml.value("float", emitters::INTENSITY_SCALE.name, &single(*scale));
                xml.transform("to_world", to_world);
            }
            EmitterKind::Environment { to_world, scale, .. } => {
                xml.value("string", emitters::FILENAME.name, &filename);
                xml.value("float", emitters::SCALE.name, &single(*scale));
                xml.transform("to_world", to_world);
            }
        }
        self.xml.close("emitter");
        Ok(())
    }
}
