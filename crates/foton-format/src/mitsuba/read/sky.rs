//! Skies and suns: `sunsky`, `sky` and `sun`. The models are in `sky/`.

use std::sync::Arc;

use foton_math::glam::{DAffine3, DMat3, DVec3};
use foton_scene::description::EmitterKind;
use foton_scene::parameter::Parameter;
use foton_scene::plugins::emitters::{
    ALBEDO, PLACE_AND_TIME, SCALE_OF_SKY, SKY, SKY_SCALE, SUN, SUN_APERTURE, SUN_DIRECTION, SUN_RADIUS_SCALE,
    SUN_SCALE, SUNSKY, TO_WORLD, TURBIDITY,
};

use crate::mitsuba::read::properties::Properties;
use crate::mitsuba::read::reader::Reader;
use crate::mitsuba::read::transform::even_scale;
use crate::sky::{PlaceAndTime, Sky};

/// The ground of files of version 0.
const OLD_ALBEDO: f32 = 0.15;

impl Reader<'_> {
    /// A sky, a sun or both, as an environment map.
    pub(super) fn sky(&mut self, plugin: &str, p: &mut Properties<'_>) -> Option<EmitterKind> {
        p.leave_out(SUNSKY.parameters, &mut self.report);
        let is_old = self.is_of_version_0();
        let albedo = if is_old && !p.has(ALBEDO.name) {
            foton_math::Rgb::splat(OLD_ALBEDO)
        } else {
            self.constant_share(p, &ALBEDO)
        };
        let mut number = |parameter: &Parameter| self.ranged(p, parameter);
        let all = number(&SCALE_OF_SKY);
        let (of_sky, of_sun) = (number(&SKY_SCALE), number(&SUN_SCALE));
        let turbidity = number(&TURBIDITY);
        let aperture = number(&SUN_APERTURE) * number(&SUN_RADIUS_SCALE);
        let [latitude, longitude, timezone, year, month, day, hour, minute, second] =
            PLACE_AND_TIME.map(|parameter| number(&parameter));
        let (date, time) = ([year, month, day], [hour, minute, second]);
        let by_time = PlaceAndTime { latitude, longitude, timezone, date, time }.sun();
        // +y is up on the map; of Mitsuba 3's sky +z is, and +x lies in the south.
        let of_map =
            if is_old { DMat3::IDENTITY } else { DMat3::from_cols(DVec3::X, DVec3::Z, DVec3::NEG_Y) };
        let by_time = if is_old { by_time } else { DVec3::new(by_time.z, by_time.y, by_time.x) };
        let transform = p.transform(TO_WORLD.name, &mut self.report);
        if let Some(t) = transform.filter(|t| even_scale(t.value.matrix3, 1e-3).is_none()) {
            self.report.error(t.place, "the transform of a sky must not stretch or shear");
            return None;
        }
        let turned = transform.map_or(DMat3::IDENTITY, |t| t.value.matrix3);
        let to_world = turned * of_map;
        let stated = p.point(SUN_DIRECTION.name, &mut self.report);
        let sun = match &stated {
            Some(stated) => (to_world.inverse() * stated.value).normalize_or_zero(),
            None => by_time,
        };
        if sun.y <= 0.0 {
            let place = stated.map_or(p.place, |s| s.place);
            self.report.error(place, "the sun of a sky must stand above the horizon");
            return None;
        }
        if plugin != SUN.name && !self.is_first_around(p) {
            return None;
        }
        let scales = match plugin {
            name if name == SKY.name => [all * of_sky, 0.0],
            name if name == SUN.name => [0.0, all * of_sun],
            _ => [all * of_sky, all * of_sun],
        };
        let bitmap = Arc::new(Sky { sun, turbidity, albedo, scales, aperture }.bitmap());
        Some(EmitterKind::Environment { to_world: DAffine3::from_mat3(to_world), bitmap, scale: 1.0 })
    }
}
