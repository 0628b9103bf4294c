//! `<sensor>`, `<film>` and `<rfilter>`: a perspective camera with or without a lens, its image size and filter.

use foton_input::quoted;
use foton_math::glam::{DAffine3, DMat3};
use foton_scene::description::{Crop, Filter, FovAxis, Keyframes, Lens, SensorDescription};
use foton_scene::plugins::sensors::{
    APERTURE_RADIUS, FAR_CLIP, FOCAL_LENGTH, FOCUS_DISTANCE, FOV, FOV_AXIS, NEAR_CLIP, PERSPECTIVE,
    SHUTTER_CLOSE, SHUTTER_OPEN, THINLENS, TO_WORLD,
};

use crate::diagnostic::Place;
use crate::mitsuba::document::NodeId;
use crate::mitsuba::names::{FILMS, FILTERS, SENSORS};
use crate::mitsuba::read::properties::{Located, Object, Properties};
use crate::mitsuba::read::reader::Reader;
use crate::mitsuba::read::transform::even_scale;

/// Mitsuba's filter where a film names none.
const DEFAULT_FILTER: Filter = Filter::Gaussian { stddev: 0.5 };
/// Half the diagonal of a 36 mm × 24 mm frame, in mm: what a focal length refers to.
const HALF_DIAGONAL: f64 = 21.633_307_652_783_937;

struct Film {
    width: u32,
    height: u32,
    crop: Option<Crop>,
    filter: Filter,
}

impl Reader<'_> {
    /// Reads a camera.
    pub(crate) fn sensor(&mut self, node: NodeId) {
        let Some(element) = self.document.element(node) else { return };
        let Some(plugin) = self.plugin(element, &SENSORS) else { return };
        let mut p = self.properties(node, plugin);
        let (transform, keyframes) = p.placement(TO_WORLD.name, &mut self.report).unzip();
        let keyframes = keyframes.flatten();
        let on_the_way = keyframes.iter().flat_map(Keyframes::all).any(|(_, place)| scales(place.matrix3));
        if let Some(transform) = transform.filter(|t| on_the_way || scales(t.value.matrix3)) {
            self.report.error(transform.place, "the transform of a camera must not scale or shear");
        }
        self.motion_of_sensor(&mut p, keyframes);
        let (fov_degrees, fov_axis) = self.field_of_view(&mut p);
        let (near_clip, far_clip) = self.clips(&mut p);
        let lens = (plugin == THINLENS.name).then(|| self.lens(&mut p, far_clip));
        let film = self.films(&mut p);
        if plugin == PERSPECTIVE.name
            && let Some(focus) = p.number(FOCUS_DISTANCE.name, &mut self.report)
        {
            let message = "a pinhole camera shows everything sharp: \"focus_distance\" has no effect";
            self.report.warning(focus.place, message);
        }
        p.nested("sampler");
        self.refuse_shift(&mut p, "principal_point_offset_x");
        self.refuse_shift(&mut p, "principal_point_offset_y");
        p.leave_out(PERSPECTIVE.parameters, &mut self.report);
        p.finish(&mut self.report);
        let number = self.description.sensors.len() + 1;
        let name = match element.attribute("id") {
            None if number == 1 => "sensor".to_owned(),
            _ => self.name(element, "sensor", number),
        };
        self.nodes.sensors.push(node);
        self.description.sensors.push(SensorDescription {
            name,
            to_world: transform.map_or(DAffine3::IDENTITY, |t| t.value),
            fov_degrees,
            fov_axis,
            width: film.width,
            height: film.height,
            crop: film.crop,
            filter: film.filter,
            near_clip,
            far_clip,
            lens,
        });
    }

    /// How the camera that is read next moves, and when its shutter is open.
    fn motion_of_sensor(&mut self, p: &mut Properties<'_>, keyframes: Option<Keyframes>) {
        let (sensor, motion) = (self.description.sensors.len(), &mut self.description.motion);
        motion.sensors.extend(keyframes.map(|keyframes| (sensor, keyframes)));
        let open = p.number(SHUTTER_OPEN.name, &mut self.report);
        let close = p.number(SHUTTER_CLOSE.name, &mut self.report);
        let begin = open.as_ref().map_or(0.0, |t| t.value);
        let times = [begin, close.as_ref().map_or(begin, |t| t.value)];
        if times[1] < times[0] {
            let place = close.or(open).map_or(p.place, |time| time.place);
            self.report.error(place, "a shutter closes before it opens");
        } else if open.is_some() || close.is_some() {
            self.description.motion.shutters.insert(sensor, times);
        }
    }

    /// The lens of a camera that sees as far as `far_clip`, where Mitsuba puts the focus if a file does not say.
    fn lens(&mut self, p: &mut Properties<'_>, far_clip: Option<f64>) -> Lens {
        let aperture = p.number(APERTURE_RADIUS.name, &mut self.report);
        let focus = p.number(FOCUS_DISTANCE.name, &mut self.report);
        if let Some(aperture) = aperture.filter(|a| !APERTURE_RADIUS.holds(a.value)) {
            self.report.error(aperture.place, "\"aperture_radius\" must not be negative");
        }
        if aperture.is_none() && !p.has(APERTURE_RADIUS.name) {
            let message = "a \"thinlens\" needs an \"aperture_radius\", in world units";
            self.report.error(p.place, message);
        }
        if let Some(focus) = focus.filter(|f| !FOCUS_DISTANCE.holds(f.value)) {
            self.refuse_zero(FOCUS_DISTANCE.name, focus.place);
        }
        Lens {
            aperture_radius: aperture.map_or(APERTURE_RADIUS.default, |a| a.value),
            focus_distance: focus.map(|f| f.value).or(far_clip).unwrap_or(FOCUS_DISTANCE.default),
        }
    }

    /// `fov` along `fov_axis`, or what a lens of `focal_length` (50 mm by default) sees on 35 mm film.
    fn field_of_view(&mut self, p: &mut Properties<'_>) -> (f64, FovAxis) {
        let fov = p.number(FOV.name, &mut self.report);
        let focal = p.string(FOCAL_LENGTH.name, &mut self.report);
        let axis = self.fov_axis(p);
        if let Some(fov) = fov {
            if let Some(focal) = focal {
                self.report.error(focal.place, "a camera has a \"fov\" or a \"focal_length\", not both");
            }
            if !(fov.value > 0.0 && fov.value < 180.0) {
                self.report.error(fov.place, "\"fov\" must lie between 0 and 180 degrees");
            }
            return (fov.value, axis.map_or(FovAxis::X, |a| a.value));
        }
        if let Some(axis) = axis {
            self.report.warning(axis.place, "\"fov_axis\" has no effect without \"fov\"");
        }
        let millimetres = focal.map_or(Some(50.0), |focal| self.millimetres(&focal));
        let half_angle = (HALF_DIAGONAL / millimetres.unwrap_or(50.0)).atan();
        (2.0 * half_angle.to_degrees(), FovAxis::Diagonal)
    }

    fn fov_axis(&mut self, p: &mut Properties<'_>) -> Option<Located<FovAxis>> {
        const AXES: [(&str, FovAxis); 5] = [
            ("x", FovAxis::X),
            ("y", FovAxis::Y),
            ("diagonal", FovAxis::Diagonal),
            ("smaller", FovAxis::Smaller),
            ("larger", FovAxis::Larger),
        ];
        let axis = p.string(FOV_AXIS.name, &mut self.report)?;
        let found = AXES.iter().find(|(name, _)| *name == axis.value);
        if found.is_none() {
            self.report.error(axis.place, "\"fov_axis\" must be x, y, diagonal, smaller or larger");
        }
        found.map(|(_, value)| Located { value: *value, place: axis.place })
    }

    fn millimetres(&mut self, focal: &Located<String>) -> Option<f64> {
        let text = focal.value.trim();
        let number = text.strip_suffix("mm").unwrap_or(text).trim().parse::<f64>();
        let length = number.ok().filter(|mm| mm.is_finite() && *mm > 0.0);
        if length.is_none() {
            let message = format!("{} is not a focal length such as 50mm", quoted(&focal.value));
            self.report.error(focal.place, message);
        }
        length
    }

    fn clips(&mut self, p: &mut Properties<'_>) -> (Option<f64>, Option<f64>) {
        let near = p.number(NEAR_CLIP.name, &mut self.report);
        let far = p.number(FAR_CLIP.name, &mut self.report);
        if let Some(near) = near.filter(|n| n.value <= 0.0) {
            self.report.error(near.place, "\"near_clip\" must be above zero");
        }
        if let Some(far) = far.filter(|f| f.value <= near.map_or(0.0, |n| n.value)) {
            self.report.error(far.place, "\"far_clip\" must be farther than \"near_clip\"");
        }
        (near.map(|n| n.value), far.map(|f| f.value))
    }

    fn refuse_shift(&mut self, p: &mut Properties<'_>, name: &'static str) {
        if p.is_written_as(name, &["string"]) {
            return;
        }
        if let Some(shift) = p.number(name, &mut self.report).filter(|s| s.value != 0.0) {
            let message = format!("\"{name}\" of \"{}\" is not supported yet", p.subject());
            self.report.error(shift.place, message);
        }
    }

    fn films(&mut self, p: &mut Properties<'_>) -> Film {
        let films = p.nested("film");
        if let Some(second) = films.get(1) {
            self.report.error(second.place, "a sensor has only one film");
        }
        // What stands beside a film instead of inside of it is meant for it.
        let filter = p.nested("rfilter").first().copied().or(self.loose_filter);
        if let Some(film) = films.first().copied().or(self.loose_film)
            && let Some(film) = self.film(film.node, filter)
        {
            return film;
        }
        let filter = filter.and_then(|filter| self.filter(filter.node)).unwrap_or(DEFAULT_FILTER);
        Film { width: 768, height: 576, crop: None, filter }
    }

    /// Says what became of a film and a filter that stand in no sensor.
    pub(crate) fn say_loose(&mut self) {
        for loose in [self.loose_film, self.loose_filter].into_iter().flatten() {
            let tag = &loose.element.name;
            let message = format!("this {tag} stands in no sensor; sensors that have none take it");
            self.report.warning(loose.place, message);
        }
    }

    /// A film; `filter` is its filter where it has none inside.
    fn film(&mut self, node: NodeId, filter: Option<Object<'_>>) -> Option<Film> {
        let element = self.document.element(node)?;
        let plugin = self.replaceable(element, &FILMS, "hdrfilm");
        let mut p = self.properties(node, plugin);
        let width = self.pixels(&mut p, "width", 768);
        let height = self.pixels(&mut p, "height", 576);
        let (x, columns) = self.span(&mut p, ["crop_offset_x", "crop_width"], width);
        let (y, rows) = self.span(&mut p, ["crop_offset_y", "crop_height"], height);
        let whole = (x, y, columns, rows) == (0, 0, width, height);
        let crop = (!whole).then_some(Crop { x, y, width: columns, height: rows });
        p.ignore(&[
            "file_format",
            "pixel_format",
            "component_format",
            "gamma",
            "exposure",
            "banner",
            "attach_log",
            "compensate",
            "sample_border",
            "high_quality_edges",
        ]);
        let filters = p.nested("rfilter");
        if let Some(second) = filters.get(1) {
            self.report.error(second.place, "a film has only one rfilter");
        }
        let filter = filters.first().copied().or(filter).and_then(|filter| self.filter(filter.node));
        p.finish(&mut self.report);
        Some(Film { width, height, crop, filter: filter.unwrap_or(DEFAULT_FILTER) })
    }

    /// Where a crop begins along a side of the image, and its length; all of the side by default.
    fn span(&mut self, p: &mut Properties<'_>, names: [&'static str; 2], side: u32) -> (u32, u32) {
        let [first, length] = names.map(|name| p.integer(name, &mut self.report));
        let begin = first.as_ref().map_or(0, |f| f.value);
        let count = length.as_ref().map_or(i64::from(side), |l| l.value);
        let inside = begin >= 0 && count > 0 && begin.saturating_add(count) <= i64::from(side);
        if let Some(wrong) = length.or(first).filter(|_| !inside) {
            let message =
                format!("the crop reaches from {begin} over {count} pixels, but the image has {side}");
            self.report.error(wrong.place, message);
        }
        let within = |n: i64| u32::try_from(n).ok().filter(|_| inside);
        (within(begin).unwrap_or(0), within(count).unwrap_or(side))
    }

    fn pixels(&mut self, p: &mut Properties<'_>, name: &'static str, default: u32) -> u32 {
        let Some(pixels) = p.integer(name, &mut self.report) else { return default };
        match u32::try_from(pixels.value) {
            Ok(count @ 1..=65_536) => count,
            _ => {
                self.report.error(pixels.place, format!("\"{name}\" must lie between 1 and 65536 pixels"));
                default
            }
        }
    }

    fn filter(&mut self, node: NodeId) -> Option<Filter> {
        let element = self.document.element(node)?;
        let plugin = self.replaceable(element, &FILTERS, "gaussian");
        if element.attribute("type").is_none_or(|t| t.value != plugin) {
            return Some(DEFAULT_FILTER);
        }
        let mut p = self.properties(node, plugin);
        let filter = match plugin {
            "box" => Filter::Box { radius: 0.5 },
            "tent" => Filter::Tent { radius: self.above_zero(&mut p, "radius", 1.0) },
            _ => Filter::Gaussian { stddev: self.above_zero(&mut p, "stddev", 0.5) },
        };
        p.finish(&mut self.report);
        Some(filter)
    }

    fn above_zero(&mut self, p: &mut Properties<'_>, name: &'static str, default: f64) -> f64 {
        let Some(Located { value, place }) = p.number(name, &mut self.report) else { return default };
        if value <= 0.0 {
            self.refuse_zero(name, place);
        }
        value
    }

    fn refuse_zero(&mut self, name: &str, place: Place) {
        self.report.error(place, format!("\"{name}\" must be above zero"));
    }
}

/// Whether a transform does more than turn and mirror.
fn scales(m: DMat3) -> bool {
    even_scale(m, 2e-3).is_none_or(|scale| (scale - 1.0).abs() > 1e-3)
}
