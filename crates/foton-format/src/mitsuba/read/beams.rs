//! `<emitter>` elements of points whose light goes by direction: spot, projector and goniometric.

use std::sync::Arc;

use foton_input::printable;
use foton_math::glam::DAffine3;
use foton_scene::description::{Bitmap, Colour, EmitterKind};
use foton_scene::parameter::Parameter;
use foton_scene::plugins::emitters::{
    BEAM_WIDTH, CUTOFF_ANGLE, INTENSITIES, INTENSITY, INTENSITY_SCALE, PROJECTED, PROJECTED_SCALE, TEXTURE,
    TO_WORLD,
};

use crate::ies;
use crate::image::{Purpose, Reading};
use crate::mitsuba::read::properties::{Located, Properties};
use crate::mitsuba::read::reader::Reader;
use crate::mitsuba::read::transform::even_scale;

impl Reader<'_> {
    pub(super) fn spot(&mut self, p: &mut Properties<'_>) -> Option<EmitterKind> {
        let mut intensity = self.emission(p, &INTENSITY);
        let texture = p.texture(TEXTURE.name).and_then(|texture| self.texture_for(texture, Purpose::Light));
        if texture.is_none() && p.states(TEXTURE.name) {
            intensity *= self.emission(p, &TEXTURE);
        }
        let transform = p.transform(TO_WORLD.name, &mut self.report);
        if let Some(t) = transform.filter(|t| even_scale(t.value.matrix3, 1e-3).is_none()) {
            let message = "a spot can be turned, moved and scaled evenly, but not stretched or sheared: its cone must stay round";
            self.report.error(t.place, message);
        }
        let to_world = transform.map_or(DAffine3::IDENTITY, |t| t.value);
        let cutoff = p.number(CUTOFF_ANGLE.name, &mut self.report);
        let beam = p.number(BEAM_WIDTH.name, &mut self.report);
        let cutoff_degrees = cutoff.map_or(CUTOFF_ANGLE.default, |c| c.value);
        if let Some(cutoff) = cutoff.filter(|c| !CUTOFF_ANGLE.holds(c.value)) {
            self.report.error(cutoff.place, "\"cutoff_angle\" must be above 0 and at most 180 degrees");
            return None;
        }
        let beam_degrees =
            beam.map_or(cutoff_degrees * (BEAM_WIDTH.default / CUTOFF_ANGLE.default), |b| b.value);
        if let Some(beam) = beam.filter(|b| b.value < BEAM_WIDTH.range.0) {
            self.report.error(beam.place, "\"beam_width\" must not be negative");
        } else if let Some(beam) = beam.filter(|b| b.value > cutoff_degrees) {
            let message =
                format!("\"beam_width\" is larger than \"cutoff_angle\" ({cutoff_degrees}) and is cut to it");
            self.report.warning(beam.place, message);
        }
        let beam_degrees = beam_degrees.min(cutoff_degrees);
        Some(EmitterKind::Spot { to_world, intensity, cutoff_degrees, beam_degrees, texture })
    }

    /// A picture that is thrown, with the field of view of a camera.
    pub(super) fn projector(&mut self, p: &mut Properties<'_>) -> Option<EmitterKind> {
        let irradiance = match p.texture(PROJECTED.name) {
            Some(texture) => self.texture_for(texture, Purpose::Light).map(Colour::Texture),
            None => Some(self.emission(p, &PROJECTED).into()),
        };
        let scale = self.factor(p, &PROJECTED_SCALE);
        let (to_world, size) = self.unstretched(p, "the picture of a projector");
        let (fov_degrees, fov_axis) = self.field_of_view(p);
        Some(EmitterKind::Projector {
            to_world,
            irradiance: irradiance?,
            // As Mitsuba 3 has it.
            scale: scale * size,
            fov_degrees,
            fov_axis,
        })
    }

    /// A measured lamp.
    #[allow(clippy::cast_possible_truncation, reason = "intensity is single precision")]
    pub(super) fn goniometric(&mut self, p: &mut Properties<'_>) -> Option<EmitterKind> {
        let scale = self.factor(p, &INTENSITY_SCALE) as f32;
        let (to_world, _) = self.unstretched(p, "the light of a lamp");
        if !p.has(INTENSITIES.name) {
            self.report.error(p.place, "a goniometric emitter needs a \"filename\"");
        }
        let filename = p.string(INTENSITIES.name, &mut self.report)?;
        let bitmap = if filename.value.to_ascii_lowercase().ends_with(".ies") {
            self.profile(&filename)?
        } else {
            self.images.read(&filename, Reading::LIGHT, &mut self.files, &mut self.report)?
        };
        Some(EmitterKind::Goniometric { to_world, bitmap, scale })
    }

    fn profile(&mut self, filename: &Located<String>) -> Option<Arc<Bitmap>> {
        let (_, bytes) = self.files.read(&filename.value, filename.place, &mut self.report)?;
        match ies::read(&bytes) {
            Ok(bitmap) => Some(Arc::new(bitmap)),
            Err(why) => {
                let message = format!("cannot read {} as an IES profile: {why}", printable(&filename.value));
                self.report.error(filename.place, message);
                None
            }
        }
    }

    fn factor(&mut self, p: &mut Properties<'_>, parameter: &Parameter) -> f64 {
        let Some(scale) = p.number(parameter.name, &mut self.report) else { return parameter.default };
        if !parameter.holds(scale.value) {
            let message = format!("\"{}\" must not be negative or above 1e30", parameter.name);
            self.report.error(scale.place, message);
        }
        scale.value
    }

    /// The transform of what must not be stretched, without its scale, and that.
    fn unstretched(&mut self, p: &mut Properties<'_>, what: &str) -> (DAffine3, f64) {
        let Some(transform) = p.transform(TO_WORLD.name, &mut self.report) else {
            return (DAffine3::IDENTITY, 1.0);
        };
        let mut to_world = transform.value;
        let Some(size) = even_scale(to_world.matrix3, 1e-3) else {
            let message =
                format!("{what} can be turned, moved and scaled evenly, but not stretched or sheared");
            self.report.error(transform.place, message);
            return (to_world, 1.0);
        };
        // What is not scaled keeps its numbers to the last bit.
        if (size - 1.0).abs() < 1e-6 {
            return (to_world, 1.0);
        }
        to_world.matrix3 *= 1.0 / size;
        (to_world, size)
    }
}
