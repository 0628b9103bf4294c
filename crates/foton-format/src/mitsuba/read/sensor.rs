//! `<sensor>`, `<film>` and `<rfilter>`: a camera with or without perspective and a lens, its image size and filter.

use foton_input::quoted;
use foton_math::glam::{DAffine3, DMat3, DVec3};
use foton_scene::description::{Crop, Filter, FovAxis, Keyframes, Lens, Projection, SensorDescription};
use foton_scene::plugins::sensors::{
    APERTURE_RADIUS, FAR_CLIP, FOCAL_LENGTH, FOCUS_DISTANCE, FOV, FOV_AXIS, NEAR_CLIP, OFFSETS, ORTHOGRAPHIC,
    SHUTTER_CLOSE, SHUTTER_OPEN, TELECENTRIC, THINLENS, TO_WORLD,
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
/// The angle of view of a camera that has none: what an editor begins with.
const FOV_OF_NONE: f64 = 40.0;

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
        let is_parallel = plugin == ORTHOGRAPHIC.name || plugin == TELECENTRIC.name;
        let has_lens = plugin == THINLENS.name || plugin == TELECENTRIC.name;
        let mut p = self.properties(node, plugin);
        let (transform, keyframes) = p.placement(TO_WORLD.name, &mut self.report).unzip();
        let keyframes = keyframes.flatten();
        let on_the_way: Vec<_> = keyframes.iter().flat_map(Keyframes::all).map(|(_, m)| m.matrix3).collect();
        let stands_well: fn(&DMat3) -> bool = if is_parallel { is_unsheared } else { is_unscaled };
        if let Some(transform) = transform
            && !on_the_way.iter().chain([&transform.value.matrix3]).all(stands_well)
        {
            let scales = if is_parallel { "" } else { "scale or " };
            self.report.error(transform.place, format!("the transform of a camera must not {scales}shear"));
        }
        let to_world = transform.map_or(DAffine3::IDENTITY, |t| t.value);
        self.motion_of_sensor(&mut p, keyframes);
        let (fov_degrees, fov_axis) =
            if is_parallel { (FOV_OF_NONE, FovAxis::X) } else { self.field_of_view(&mut p) };
        let depth_scale = if is_parallel { to_world.matrix3.z_axis.length() } else { 1.0 };
        let (near_clip, far_clip) = self.clips(&mut p, depth_scale);
        let lens = has_lens.then(|| self.lens(&mut p, far_clip));
        let principal_point_offset =
            [0, 1].map(|i| p.number(OFFSETS[i].name, &mut self.report).map_or(0.0, |offset| offset.value));
        let film = self.films(&mut p);
        self.say_without_effect(&mut p, is_parallel, has_lens);
        p.nested("sampler");
        p.finish(&mut self.report);
        let number = self.description.sensors.len() + 1;
        let name = match element.attribute("id") {
            None if number == 1 => "sensor".to_owned(),
            _ => self.name(element, "sensor", number),
        };
        self.nodes.sensors.push(node);
        self.description.sensors.push(SensorDescription {
            name,
            to_world,
            projection: if is_parallel { Projection::Orthographic } else { Projection::Perspective },
            fov_degrees,
            fov_axis,
            width: film.width,
            height: film.height,
            crop: film.crop,
            filter: film.filter,
            near_clip,
            far_clip,
            lens,
            principal_point_offset,
        });
    }

    /// Warns of what a camera of its kind has no use for.
    fn say_without_effect(&mut self, p: &mut Properties<'_>, is_parallel: bool, has_lens: bool) {
        if !has_lens && let Some(focus) = p.number(FOCUS_DISTANCE.name, &mut self.report) {
            let message = "a pinhole camera shows everything sharp: \"focus_distance\" has no effect";
            self.report.warning(focus.place, message);
        }
        let angle = if is_parallel { &[FOV.name, FOV_AXIS.name, FOCAL_LENGTH.name][..] } else { &[] };
        for name in angle {
            if let Some((_, angle)) = p.take(name, &["float", "integer", "string"], &mut self.report) {
                let message = format!(
                    "a camera without perspective sees as much as the scale of \"to_world\" says: \"{name}\" has no effect"
                );
                self.report.warning(angle.place, message);
            }
        }
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
            let message = format!("a \"{}\" needs an \"aperture_radius\", in world units", p.subject());
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
    pub(super) fn field_of_view(&mut self, p: &mut Properties<'_>) -> (f64, FovAxis) {
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
        let axis = p.string(FOV_AXIS.name, &mut self.report)?;
        let found = FovAxis::ALL.into_iter().find(|known| known.name() == axis.value);
        if found.is_none() {
            self.report.error(axis.place, "\"fov_axis\" must be x, y, diagonal, smaller or larger");
        }
        found.map(|value| Located { value, place: axis.place })
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

    /// The depths between which it sees, in world units. Where the camera's z is so many times as long in the world, Mitsuba stretches
    /// the nearer one by that, but not what lies between them.
    fn clips(&mut self, p: &mut Properties<'_>, depth_scale: f64) -> (Option<f64>, Option<f64>) {
        let near = p.number(NEAR_CLIP.name, &mut self.report);
        let far = p.number(FAR_CLIP.name, &mut self.report);
        if let Some(near) = near.filter(|n| n.value <= 0.0) {
            self.report.error(near.place, "\"near_clip\" must be above zero");
        }
        if let Some(far) = far.filter(|f| f.value <= near.map_or(0.0, |n| n.value)) {
            self.report.error(far.place, "\"far_clip\" must be farther than \"near_clip\"");
        }
        let (near, far) = (near.map(|n| n.value), far.map(|f| f.value));
        let moved_by = near.map_or(0.0, |near| near * depth_scale - near);
        (near.map(|near| near * depth_scale), far.map(|far| far + moved_by))
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

/// Whether a transform only turns and mirrors.
fn is_unscaled(m: &DMat3) -> bool {
    even_scale(*m, 2e-3).is_some_and(|scale| (scale - 1.0).abs() <= 1e-3)
}

/// Whether axes stay at right angles under a transform, and have a length.
fn is_unsheared(m: &DMat3) -> bool {
    let [x, y, z] = [m.x_axis, m.y_axis, m.z_axis].map(DVec3::normalize_or_zero);
    let right = |a: DVec3, b: DVec3| a.dot(b).abs() < 2e-3;
    m.determinant() != 0.0 && right(x, y) && right(y, z) && right(z, x)
}
