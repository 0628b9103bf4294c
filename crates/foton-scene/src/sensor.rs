//! Perspective cameras with a pinhole or a thin lens: film positions to rays, and what a pixel covers.

use std::f32::consts::PI;

use foton_math::Ray;
use foton_math::glam::{DVec3, Vec2, Vec3};
use foton_math::warp::square_to_disc;

use crate::description::{Crop, FovAxis, SensorDescription};
use crate::filter::FilterSampler;
use crate::normalise::Normalisation;

/// A camera in scene units.
#[derive(Clone, Debug)]
pub struct Sensor {
    /// The name in the scene file.
    pub name: String,
    /// Width in pixels of what is rendered.
    pub width: u32,
    /// Height in pixels of what is rendered.
    pub height: u32,
    /// Size in pixels of the whole image, and where in it the rendered part begins.
    film: Vec2,
    corner: Vec2,
    /// How eye samples spread around a pixel's centre.
    pub filter: FilterSampler,
    origin: Vec3,
    /// Outer vectors of half the image's width and height at depth 1, and of the view axis.
    right: Vec3,
    up: Vec3,
    forward: Vec3,
    /// Depth bounds in scene units.
    near: f32,
    far: f32,
    lens: Option<ThinLens>,
}

/// A lens in scene units.
#[derive(Clone, Copy, Debug)]
struct ThinLens {
    /// Vectors from its middle to its edge, along the image's width and height.
    right: Vec3,
    up: Vec3,
    radius: f32,
    focus_distance: f32,
}

impl Sensor {
    pub(crate) fn new(description: &SensorDescription, normalisation: &Normalisation) -> Self {
        let (width, height) = (f64::from(description.width), f64::from(description.height));
        let whole = Crop { x: 0, y: 0, width: description.width, height: description.height };
        let crop = description.crop.unwrap_or(whole);
        let half = (description.fov_degrees.to_radians() * 0.5).tan();
        // Tangent of half the horizontal field of view.
        let tan_x = match description.fov_axis {
            FovAxis::X => half,
            FovAxis::Y => half * width / height,
            FovAxis::Diagonal => half * width / width.hypot(height),
            FovAxis::Smaller => half * width / width.min(height),
            FovAxis::Larger => half * width / width.max(height),
        };
        let m = description.to_world.matrix3;
        let axis = DVec3::normalize;
        // A camera's +x points to the image's left, as in Mitsuba.
        let (left, up, forward) = (axis(m.x_axis), axis(m.y_axis), axis(m.z_axis));
        let depth = |d: Option<f64>, default: f32| d.map_or(default, |d| normalisation.length(d));
        Self {
            name: description.name.clone(),
            width: crop.width,
            height: crop.height,
            film: Vec2::new(width as f32, height as f32),
            corner: Vec2::new(crop.x as f32, crop.y as f32),
            filter: FilterSampler::new(description.filter),
            origin: normalisation.point(description.to_world.translation),
            right: (-left * tan_x).as_vec3(),
            up: (up * (tan_x * height / width)).as_vec3(),
            forward: forward.as_vec3(),
            near: depth(description.near_clip, 0.0),
            far: depth(description.far_clip, f32::INFINITY),
            lens: description.lens.filter(|lens| lens.aperture_radius > 0.0).map(|lens| {
                let radius = normalisation.length(lens.aperture_radius);
                let focus_distance = normalisation.length(lens.focus_distance);
                let [right, up] = [-left, up].map(|axis| axis.as_vec3() * radius);
                ThinLens { right, up, radius, focus_distance }
            }),
        }
    }

    /// The ray through a film position in pixels, (0, 0) being the top left corner of what is rendered; with a lens the one through
    /// its middle.
    #[must_use]
    pub fn ray(&self, film: Vec2) -> Ray {
        self.ray_from(Vec3::ZERO, self.at_depth_1(film))
    }

    /// Whether it has a lens that blurs anything.
    #[must_use]
    pub const fn has_lens(&self) -> bool {
        self.lens.is_some()
    }

    /// The ray that an eye sample follows: through a film position and, where there is a lens, through a point of it, which `lens`
    /// chooses uniformly from the unit square. All rays of a film position meet at the distance in focus.
    #[must_use]
    pub fn eye_ray(&self, film: Vec2, lens: Vec2) -> Ray {
        let v = self.at_depth_1(film);
        let Some(thin) = &self.lens else { return self.ray_from(Vec3::ZERO, v) };
        let disc = square_to_disc(lens);
        let from = thin.right * disc.x + thin.up * disc.y;
        self.ray_from(from, v - from / thin.focus_distance)
    }

    /// From the camera's position to what a film position shows at depth 1.
    fn at_depth_1(&self, film: Vec2) -> Vec3 {
        let place = (film + self.corner) / self.film;
        let (x, y) = (2.0 * place.x - 1.0, 1.0 - 2.0 * place.y);
        self.forward + self.right * x + self.up * y
    }

    /// The ray from a point of the lens, relative to its middle, along a vector whose depth is 1.
    fn ray_from(&self, lens: Vec3, v: Vec3) -> Ray {
        let length = v.length();
        Ray {
            origin: self.origin + lens,
            direction: v / length,
            t_min: self.near * length,
            t_max: self.far * length,
        }
    }

    /// Radius and focus distance of its lens in scene units; `None` for a pinhole.
    #[must_use]
    pub fn lens(&self) -> Option<[f32; 2]> {
        self.lens.map(|lens| [lens.radius, lens.focus_distance])
    }

    /// Area of the disc over which a lens spreads a film position at a distance along a ray of unit `direction`, perpendicular to
    /// the camera's axis: the circle of confusion, projected into the scene. 0 for a pinhole.
    #[must_use]
    pub fn confusion(&self, direction: Vec3, distance: f32) -> f32 {
        let Some(thin) = &self.lens else { return 0.0 };
        let depth = distance * direction.dot(self.forward);
        let radius = thin.radius * (depth / thin.focus_distance - 1.0);
        PI * radius * radius
    }

    /// The part of the whole image that is rendered.
    #[must_use]
    pub fn window(&self) -> Crop {
        let [x, y] = self.corner.to_array().map(|v| v as u32);
        Crop { x, y, width: self.width, height: self.height }
    }

    /// Width and height in pixels of the whole image.
    #[must_use]
    pub fn whole(&self) -> [u32; 2] {
        self.film.to_array().map(|v| v as u32)
    }

    /// Whether a part of the whole image is rendered, and not all of it.
    #[must_use]
    pub fn is_cropped(&self) -> bool {
        [self.width, self.height] != self.whole()
    }

    /// The ray through a position in pixels of the whole image.
    #[must_use]
    pub fn ray_of_whole(&self, film: Vec2) -> Ray {
        self.ray(film - self.corner)
    }

    /// The same position as [`Sensor::project`] finds, in pixels of the whole image.
    #[must_use]
    pub fn project_on_whole(&self, point: Vec3) -> Option<(Vec2, f32)> {
        self.project(point).map(|(film, depth)| (film + self.corner, depth))
    }

    /// The film position that a point is seen at, and its depth along the view axis in scene units; `None` behind the camera.
    #[must_use]
    pub fn project(&self, point: Vec3) -> Option<(Vec2, f32)> {
        let v = point - self.origin;
        let depth = v.dot(self.forward);
        let along = |axis: Vec3| v.dot(axis) / (depth * axis.length_squared());
        let (x, y) = (along(self.right), along(self.up));
        let film = Vec2::new(x + 1.0, 1.0 - y) * self.film * 0.5 - self.corner;
        (depth > 0.0 && film.is_finite()).then_some((film, depth))
    }

    /// Where the camera is, in scene units.
    #[must_use]
    pub const fn origin(&self) -> Vec3 {
        self.origin
    }

    /// How the unit direction of a ray changes from one pixel to the next, along the image's width and along its height.
    #[must_use]
    pub fn change_of_direction(&self, direction: Vec3) -> [Vec3; 2] {
        let depth = direction.dot(self.forward);
        let steps = [self.right * (2.0 / self.film.x), self.up * (-2.0 / self.film.y)];
        steps.map(|step| (step - direction * direction.dot(step)) * depth)
    }

    /// Area of a pixel per square distance, perpendicular to a ray of unit `direction` (steradians).
    #[must_use]
    pub fn pixel_solid_angle(&self, direction: Vec3) -> f32 {
        let pixel = 4.0 * self.right.cross(self.up).length() / (self.film.x * self.film.y);
        // A pixel at depth 1 is 1/cos θ away and seen under the angle θ.
        pixel * direction.dot(self.forward).powi(3)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::description::{Filter, Lens};
    use foton_math::glam::DAffine3;

    fn sensor(axis: FovAxis) -> Sensor {
        Sensor::new(&description(axis), &Normalisation::IDENTITY)
    }

    fn description(axis: FovAxis) -> SensorDescription {
        // Looks along world −z from (0, 0, 5): camera x to world −x, camera z to world −z.
        let to_world = DAffine3::from_cols(-DVec3::X, DVec3::Y, -DVec3::Z, DVec3::new(0.0, 0.0, 5.0));
        SensorDescription {
            name: "camera".into(),
            to_world,
            fov_degrees: 90.0,
            fov_axis: axis,
            width: 200,
            height: 100,
            crop: None,
            filter: Filter::Box { radius: 0.5 },
            near_clip: None,
            far_clip: None,
            lens: None,
        }
    }

    #[test]
    fn all_rays_of_a_film_position_meet_in_focus_and_spread_over_the_circle_of_confusion() {
        let lens = Lens { aperture_radius: 0.25, focus_distance: 4.0 };
        let description = SensorDescription { lens: Some(lens), ..description(FovAxis::X) };
        let s = Sensor::new(&description, &Normalisation::IDENTITY);
        for film in [Vec2::new(100.0, 50.0), Vec2::new(12.0, 90.0)] {
            let middle = s.ray(film);
            let at = |ray: &Ray, depth: f32| ray.at(depth / ray.direction.dot(-Vec3::Z));
            let mut widest = [0f32; 2];
            for i in 0..256 {
                let u = Vec2::new((i % 16) as f32 / 15.0, (i / 16) as f32 / 15.0);
                let ray = s.eye_ray(film, u);
                assert!(at(&ray, 4.0).distance(at(&middle, 4.0)) < 1e-5, "{film} {u}");
                assert!((ray.origin.z - 5.0).abs() < 1e-6, "from the plane of the lens");
                // r |z/f − 1|, nearer and farther than the focus.
                for (widest, depth) in widest.iter_mut().zip([1.0, 12.0]) {
                    *widest = widest.max(
                        (ray.origin + ray.direction * (depth / -ray.direction.z))
                            .distance(at(&middle, depth)),
                    );
                }
            }
            for (widest, (depth, expected)) in widest.into_iter().zip([(1.0, 0.1875), (12.0, 0.5)]) {
                assert!((widest / expected - 1.0).abs() < 1e-4, "{widest} {expected}");
                let distance = depth / middle.direction.dot(-Vec3::Z);
                let area = s.confusion(middle.direction, distance);
                assert!((area / (PI * expected * expected) - 1.0).abs() < 1e-4, "{area}");
            }
        }
        assert_eq!(s.lens(), Some([0.25, 4.0]));
        let closed = SensorDescription { lens: Some(Lens { aperture_radius: 0.0, ..lens }), ..description };
        let pinhole = Sensor::new(&closed, &Normalisation::IDENTITY);
        assert_eq!(pinhole.lens(), None);
        assert_eq!(pinhole.eye_ray(Vec2::ONE, Vec2::ZERO).origin, pinhole.ray(Vec2::ONE).origin);
    }

    #[test]
    fn directions_change_as_rays_of_neighbouring_pixels_do() {
        let s = sensor(FovAxis::X);
        for film in [Vec2::new(100.0, 50.0), Vec2::new(12.0, 90.0)] {
            let ray = s.ray(film);
            for (change, step) in s.change_of_direction(ray.direction).into_iter().zip([Vec2::X, Vec2::Y]) {
                let between = s.ray(film + 0.5 * step).direction - s.ray(film - 0.5 * step).direction;
                assert!(change.distance(between) < 1e-3 * between.length(), "{change} {between}");
            }
        }
    }

    #[test]
    fn a_crop_sees_what_its_window_of_the_whole_image_sees() {
        let whole = sensor(FovAxis::X);
        let crop = Some(Crop { x: 30, y: 20, width: 64, height: 50 });
        let part =
            Sensor::new(&SensorDescription { crop, ..description(FovAxis::X) }, &Normalisation::IDENTITY);
        assert_eq!((part.width, part.height), (64, 50));
        let (a, b) = (part.ray(Vec2::new(3.5, 7.25)), whole.ray(Vec2::new(33.5, 27.25)));
        assert_eq!(a.direction, b.direction);
        assert_eq!(part.pixel_solid_angle(a.direction), whole.pixel_solid_angle(b.direction));
    }

    #[test]
    fn a_crop_keeps_its_place_and_stays_inside_at_another_size() {
        let crop = Some(Crop { x: 30, y: 20, width: 170, height: 50 });
        for (size, expected) in
            [((400, 200), (60, 40, 340, 100)), ((20, 10), (3, 2, 17, 5)), ((3, 1), (0, 0, 3, 1))]
        {
            let mut resized = SensorDescription { crop, ..description(FovAxis::X) };
            resized.resize(size.0, size.1);
            let c = resized.crop.expect("still a crop");
            assert_eq!((c.x, c.y, c.width, c.height), expected, "{size:?}");
        }
    }

    #[test]
    fn a_point_on_a_ray_is_seen_where_the_ray_leaves_the_film() {
        let sensor = sensor(FovAxis::X);
        for film in [Vec2::new(3.0, 7.0), Vec2::new(150.5, 99.0), Vec2::new(100.0, 50.0)] {
            let ray = sensor.ray(film);
            let (seen, depth) = sensor.project(ray.at(12.0)).expect("in front");
            assert!(seen.distance(film) < 1e-3 && depth > 0.0 && depth <= 12.0, "{film} {seen} {depth}");
            assert_eq!(sensor.project(ray.at(-12.0)), None);
        }
        assert_eq!(sensor.project(sensor.origin()), None);
    }

    #[test]
    fn the_right_edge_of_the_image_looks_right_at_half_the_field_of_view() {
        let ray = sensor(FovAxis::X).ray(Vec2::new(200.0, 50.0));
        assert!(ray.direction.distance(Vec3::new(1.0, 0.0, -1.0).normalize()) < 1e-6);
        assert_eq!(ray.origin, Vec3::new(0.0, 0.0, 5.0));
        let up = sensor(FovAxis::Y).ray(Vec2::new(100.0, 0.0));
        assert!(up.direction.distance(Vec3::new(0.0, 1.0, -1.0).normalize()) < 1e-6);
        assert_eq!(
            sensor(FovAxis::Larger).ray(Vec2::ZERO).direction,
            sensor(FovAxis::X).ray(Vec2::ZERO).direction
        );
        assert_eq!(
            sensor(FovAxis::Smaller).ray(Vec2::ZERO).direction,
            sensor(FovAxis::Y).ray(Vec2::ZERO).direction
        );
        let corner = sensor(FovAxis::Diagonal).ray(Vec2::new(200.0, 0.0)).direction;
        assert!((corner.dot(-Vec3::Z) - 45f32.to_radians().cos()).abs() < 1e-6);
    }

    #[test]
    fn pixels_cover_the_solid_angle_of_the_image() {
        // The pyramid of half angles whose tangents are 1 and 1/2.
        let (a, b) = (1f64, 0.5f64);
        let expected = 4.0 * (a * b / (1.0 + a * a + b * b).sqrt()).atan();
        let s = sensor(FovAxis::X);
        let mut sum = 0.0;
        for y in 0..100 {
            for x in 0..200 {
                let ray = s.ray(Vec2::new(x as f32 + 0.5, y as f32 + 0.5));
                sum += f64::from(s.pixel_solid_angle(ray.direction));
            }
        }
        assert!((sum / expected - 1.0).abs() < 1e-4, "{sum} {expected}");
    }
}
