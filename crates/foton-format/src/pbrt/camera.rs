//! Cameras, films and filters, as one sensor of the description.
//!
//! pbrt's camera looks along its +z with +x to the right of the image; a description has +x to the left. So the sensor of a scene that is
//! not mirrored is: its numbers are those of the file, and the picture is the same.

use foton_input::quoted;
use foton_math::glam::{DAffine3, DMat3, DVec2, DVec3};
use foton_scene::description::{Crop, Filter, FovAxis, Keyframes, Lens, Projection, SensorDescription};

use super::parameters::{Kind, Parameters};
use super::reader::{Camera, Reader};
use crate::diagnostic::Place;
use crate::spelling::did_you_mean;

/// x to the left.
const TO_THE_LEFT: DAffine3 =
    DAffine3 { matrix3: DMat3::from_cols(DVec3::NEG_X, DVec3::Y, DVec3::Z), translation: DVec3::ZERO };

struct Film {
    width: u32,
    height: u32,
    crop: Option<Crop>,
}

/// The part of the plane at a distance of 1 that the image shows, x to the right and y up.
#[derive(Clone, Copy)]
struct Window {
    low: DVec2,
    high: DVec2,
}

impl Window {
    fn size(self) -> DVec2 {
        self.high - self.low
    }

    /// Where its middle is, in shares of its width to the right and of its height down.
    fn offset(self) -> [f64; 2] {
        let middle = 0.5 * (self.low + self.high) / self.size();
        let share = |c: f64| if c.abs() < 1e-9 { 0.0 } else { c };
        [share(middle.x), share(-middle.y)]
    }
}

impl Reader<'_> {
    /// Makes the sensor of the file.
    pub(crate) fn sensor(&mut self) {
        let film = self.film();
        let Some(Camera { parameters: p, transforms }) = self.camera.take() else {
            self.report.warning(Place::default(), "the scene has no Camera");
            return;
        };
        let known = ["perspective", "orthographic", "environment", "spherical", "realistic"];
        if !matches!(p.plugin.as_str(), "perspective" | "orthographic") {
            let name = quoted(&p.plugin);
            let message = if known.contains(&p.plugin.as_str()) {
                format!("the camera {name} is not supported yet")
            } else {
                format!("unknown camera {name}{}", did_you_mean(&p.plugin, known))
            };
            self.report.error(p.place, message);
            return;
        }
        let default =
            if self.is_old() { Filter::Box { radius: 0.5 } } else { Filter::Gaussian { stddev: 0.5 } };
        let described = SensorDescription {
            name: "sensor".to_owned(),
            width: film.width,
            height: film.height,
            crop: film.crop,
            filter: self.filter.unwrap_or(default),
            ..SensorDescription::default()
        };
        let places = transforms.inverse().0.map(|t| t * TO_THE_LEFT);
        let described = self.projected(&p, places[0], described);
        self.motion_of_sensor(&p, places);
        p.finish(&mut self.report);
        self.description.sensors.extend(described);
    }

    /// A sensor with what it sees.
    fn projected(
        &mut self,
        p: &Parameters,
        place: DAffine3,
        sensor: SensorDescription,
    ) -> Option<SensorDescription> {
        let aspect = f64::from(sensor.width) / f64::from(sensor.height);
        let window = self.screen_window(p, aspect)?;
        let radius = p.number_or("lensradius", 0.0, &mut self.report);
        let focus = p.above_zero("focaldistance", 1e6, &mut self.report);
        if radius < 0.0 {
            self.report.error(p.place_of("lensradius"), "\"lensradius\" must not be negative");
        }
        let Some((to_world, scale, stretch)) = without_scale(place) else {
            self.report.error(p.place, "the transform of a camera must not shear, nor stretch the image");
            return None;
        };
        let principal_point_offset = window.offset();
        if p.plugin == "orthographic" {
            if radius > 0.0 {
                self.report.warning(
                    p.place_of("lensradius"),
                    "a camera without perspective shows everything sharp: \"lensradius\" has no effect",
                );
            }
            let half = 0.5 * scale * window.size();
            let scale = DAffine3::from_scale(DVec3::new(half.x, half.y * aspect, 1.0));
            let projection = Projection::Orthographic;
            return Some(SensorDescription {
                to_world: to_world * scale,
                projection,
                principal_point_offset,
                ..sensor
            });
        }
        let fov = self.field_of_view(p)?;
        let size = window.size();
        if (size.x / size.y / aspect - 1.0).abs() > 0.02 {
            let name = if p.has("screenwindow") { "screenwindow" } else { "frameaspectratio" };
            self.report.error(
                p.place_of(name),
                "the pixels of this camera are not square: what it sees has another shape than the film",
            );
        }
        // What the shorter side of the image spans, at a distance of 1.
        let tangent = 0.5 * size.min_element() * (0.5 * fov).to_radians().tan() / stretch;
        let focus_distance = focus * scale * stretch;
        let lens = (radius > 0.0).then_some(Lens { aperture_radius: radius * scale, focus_distance });
        let fov_degrees = 2.0 * tangent.atan().to_degrees();
        Some(SensorDescription {
            to_world,
            fov_degrees,
            fov_axis: FovAxis::Smaller,
            lens,
            principal_point_offset,
            ..sensor
        })
    }

    /// The angle that the shorter side of the image spans, in degrees.
    fn field_of_view(&mut self, p: &Parameters) -> Option<f64> {
        let fov = match p.number("halffov", &mut self.report) {
            Some(half) => 2.0 * half.value,
            None => p.number_or("fov", 90.0, &mut self.report),
        };
        if fov > 0.0 && fov < 180.0 {
            return Some(fov);
        }
        self.report.error(p.place_of("fov"), "\"fov\" must lie between 0 and 180 degrees");
        None
    }

    /// When the shutter of the sensor that comes next is open, and how it moves.
    fn motion_of_sensor(&mut self, p: &Parameters, places: [DAffine3; 2]) {
        let sensor = self.description.sensors.len();
        let times = [("shutteropen", 0.0), ("shutterclose", 1.0)];
        let [open, close] = times.map(|(name, default)| p.number_or(name, default, &mut self.report));
        // Where nothing moves a shutter has nothing to blur.
        let moves = places[0] != places[1] || !self.description.motion.is_still();
        if close > open && moves {
            self.description.motion.shutters.insert(sensor, [open, close]);
        }
        if places[0] == places[1] {
            return;
        }
        let keyframes = [0, 1].map(|i| (self.times[i], places[i])).to_vec();
        match Keyframes::new(keyframes) {
            Some(keyframes) => drop(self.description.motion.sensors.insert(sensor, keyframes)),
            None => {
                let message = "a camera that is mirrored or scaled does not move: it stands where it begins";
                self.report.warning(p.place, message);
            }
        }
    }

    /// The part of the plane at a distance of 1 that the image shows.
    fn screen_window(&mut self, p: &Parameters, aspect: f64) -> Option<Window> {
        let ratio = p.above_zero("frameaspectratio", aspect, &mut self.report);
        let window = match p.numbers("screenwindow", &[Kind::Float], &mut self.report) {
            None if ratio > 1.0 => [-ratio, ratio, -1.0, 1.0],
            None => [-1.0, 1.0, -1.0 / ratio, 1.0 / ratio],
            Some([x0, x1, y0, y1]) => [*x0, *x1, *y0, *y1],
            Some(other) => {
                let message = format!("\"screenwindow\" has four numbers, not {}", other.len());
                self.report.error(p.place_of("screenwindow"), message);
                return None;
            }
        };
        let [x0, x1, y0, y1] = window;
        let window = Window { low: DVec2::new(x0, y0), high: DVec2::new(x1, y1) };
        if window.size().min_element() > 0.0 {
            return Some(window);
        }
        self.report.error(p.place_of("screenwindow"), "the screen window has no extent");
        None
    }

    fn film(&mut self) -> Film {
        let sides: [i64; 2] = if self.is_old() { [640, 480] } else { [1280, 720] };
        let p = self
            .film
            .take()
            .unwrap_or_else(|| Parameters::new("Film".to_owned(), Place::default(), Vec::new()));
        let mut side = |name: &'static str, default: i64| {
            let found = p.integer(name, &mut self.report).map_or(default, |n| n.value);
            u32::try_from(found).ok().filter(|n| (1..=65_536).contains(n)).unwrap_or_else(|| {
                self.report
                    .error(p.place_of(name), format!("\"{name}\" must lie between 1 and 65536 pixels"));
                1
            })
        };
        let (width, height) = (side("xresolution", sides[0]), side("yresolution", sides[1]));
        let crop = self.crop(&p, [width, height]);
        p.ignore(&[
            "filename",
            "diagonal",
            "maxsampleluminance",
            "maxcomponentvalue",
            "savefp16",
            "coordinatesystem",
        ]);
        self.exposure(&p);
        p.ignore(&["sensor", "whitebalance", "lambdamin", "lambdamax", "nbuckets"]);
        p.finish(&mut self.report);
        Film { width, height, crop }
    }

    /// Says what a film makes of the scene's light, which has no effect here.
    fn exposure(&mut self, p: &Parameters) {
        let factors = [("scale", 1.0), ("iso", 100.0), ("exposuretime", 1.0)];
        let times =
            |(name, usual): &(&'static str, f64)| p.above_zero(name, *usual, &mut self.report) / usual;
        let factor: f64 = factors.iter().map(times).product();
        let mut names = factors.iter().map(|(name, _)| *name).chain(["sensor", "whitebalance"]);
        let Some(name) = names.find(|name| p.has(name)) else { return };
        let how = if (factor - 1.0).abs() < 1e-6 {
            "the image has the scene's own light".to_owned()
        } else {
            let stops = factor.log2();
            format!("the film makes the image {factor:.3} times as bright, as --exposure {stops:.2} does")
        };
        self.report.warning(p.place_of(name), format!("\"{name}\" has no effect: {how}"));
    }

    /// The part of the image that is rendered, by shares or by pixels.
    fn crop(&mut self, p: &Parameters, sides: [u32; 2]) -> Option<Crop> {
        let shares = p.numbers("cropwindow", &[Kind::Float], &mut self.report);
        let pixels = p.numbers("pixelbounds", &[Kind::Integer], &mut self.report);
        let name = if shares.is_some() { "cropwindow" } else { "pixelbounds" };
        let side = |i: usize| f64::from(sides[i]);
        let ends = match (shares, pixels) {
            (Some([x0, x1, y0, y1]), _) => {
                [x0 * side(0), x1 * side(0), y0 * side(1), y1 * side(1)].map(f64::ceil)
            }
            (None, Some([x0, x1, y0, y1])) => [*x0, *x1, *y0, *y1],
            (None, None) => return None,
            _ => {
                self.report.error(p.place_of(name), format!("\"{name}\" has four numbers"));
                return None;
            }
        };
        let [x0, x1, y0, y1] = [0, 1, 2, 3].map(|i| ends[i].clamp(0.0, side(i / 2)) as u32);
        if x1 <= x0 || y1 <= y0 {
            self.report.error(p.place_of(name), format!("\"{name}\" leaves nothing of the image"));
            return None;
        }
        let crop = Crop { x: x0, y: y0, width: x1 - x0, height: y1 - y0 };
        ([crop.width, crop.height] != sides).then_some(crop)
    }

    pub(crate) fn pixel_filter(&mut self, p: &Parameters) {
        let report = &mut self.report;
        let width = |report: &mut crate::diagnostic::Report, default: f64| {
            let [x, y] = [("xwidth", "xradius"), ("ywidth", "yradius")]
                .map(|(old, new)| p.above_zero(if p.has(old) { old } else { new }, default, report));
            if x != y {
                report.warning(p.place, format!("filters are as wide as high: {x} is taken"));
            }
            x
        };
        self.filter = Some(match p.plugin.as_str() {
            "box" => Filter::Box { radius: width(report, 0.5) },
            "triangle" => Filter::Tent { radius: width(report, 2.0) },
            "gaussian" => {
                width(report, 1.5);
                let stddev = p.above_zero("sigma", 0.5, report);
                // Version 3 has the factor of x² in the exponent.
                let alpha = p.number("alpha", report).map(|a| a.value).filter(|a| *a > 0.0);
                Filter::Gaussian { stddev: alpha.map_or(stddev, |alpha| (0.5 / alpha).sqrt()) }
            }
            "mitchell" | "sinc" => {
                p.ignore_rest();
                report.warning(
                    p.place,
                    format!("the filter \"{}\" weighs some light below zero: a Gaussian is taken", p.plugin),
                );
                Filter::Gaussian { stddev: 0.5 }
            }
            other => {
                let hint = did_you_mean(other, ["box", "triangle", "gaussian", "mitchell", "sinc"]);
                report.error(p.place, format!("unknown filter {}{hint}", quoted(other)));
                return;
            }
        });
        p.finish(report);
    }
}

/// A camera's place without what scales it: how much that is across, and how many times as much along its view. `None` where axes are
/// not at right angles, or the image is stretched.
fn without_scale(t: DAffine3) -> Option<(DAffine3, f64, f64)> {
    let m = t.matrix3;
    let [x, y, z] = [m.x_axis, m.y_axis, m.z_axis].map(DVec3::length);
    let slant = m.x_axis.dot(m.y_axis).abs() / (x * y)
        + m.y_axis.dot(m.z_axis).abs() / (y * z)
        + m.z_axis.dot(m.x_axis).abs() / (z * x);
    let is_sound = slant < 1e-3 && (x / y - 1.0).abs() < 1e-3;
    let turned = DMat3::from_cols(m.x_axis / x, m.y_axis / y, m.z_axis / z);
    is_sound.then(|| (DAffine3::from_mat3_translation(turned, t.translation), x, z / x))
}
