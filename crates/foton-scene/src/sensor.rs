//! Cameras, perspective or orthographic, with a pinhole or a thin lens: film positions to rays, and what a pixel covers.

use std::f32::consts::PI;

use foton_math::Ray;
use foton_math::glam::{DVec3, Vec2, Vec3};
use foton_math::warp::square_to_disc;

use crate::description::{Crop, FovAxis, Projection, SensorDescription};
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
    /// Where the middle of the image looks, in shares of its width and height from the view axis.
    offset: Vec2,
    projection: Projection,
    origin: Vec3,
    /// Outer vectors of half the image's width and height, of a perspective at depth 1, and of the view axis.
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
        let m = description.to_world.matrix3;
        let axis = DVec3::normalize;
        // A camera's +x points to the image's left, as in Mitsuba.
        let (left, up, forward) = (axis(m.x_axis), axis(m.y_axis), axis(m.z_axis));
        let half = match description.projection {
            Projection::Perspective => {
                let tan_x = tan_of_half_width(description);
                [tan_x, tan_x * height / width]
            }
            Projection::Orthographic => {
                let half = [m.x_axis.length(), m.y_axis.length() * height / width];
                half.map(|half| half * normalisation.scale())
            }
        };
        let offset = description.principal_point_offset.map(|offset| offset as f32);
        let depth = |d: Option<f64>, default: f32| d.map_or(default, |d| normalisation.length(d));
        Self {
            name: description.name.clone(),
            width: crop.width,
            height: crop.height,
            film: Vec2::new(width as f32, height as f32),
            corner: Vec2::new(crop.x as f32, crop.y as f32),
            filter: FilterSampler::new(description.filter),
            origin: normalisation.point(description.to_world.translation),
            offset: Vec2::from(offset),
            projection: description.projection,
            right: (-left * half[0]).as_vec3(),
            up: (up * half[1]).as_vec3(),
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
        let (from, v) = self.line(film);
        self.ray_from(from, v)
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
        let (from, v) = self.line(film);
        let Some(thin) = &self.lens else { return self.ray_from(from, v) };
        let disc = square_to_disc(lens);
        let on_lens = thin.right * disc.x + thin.up * disc.y;
        self.ray_from(from + on_lens, v - on_lens / thin.focus_distance)
    }

    /// The line of sight of a film position: where it begins, from the camera's position, and how far it gets at depth 1.
    fn line(&self, film: Vec2) -> (Vec3, Vec3) {
        let place = (film + self.corner) / self.film + self.offset;
        let (x, y) = (2.0 * place.x - 1.0, 1.0 - 2.0 * place.y);
        match self.projection {
            Projection::Perspective => (Vec3::ZERO, self.forward + self.right * x + self.up * y),
            Projection::Orthographic => (self.right * x + self.up * y, self.forward),
        }
    }

    /// The ray from a point beside the camera's position, relative to that, along a vector whose depth is 1.
    fn ray_from(&self, from: Vec3, v: Vec3) -> Ray {
        let length = v.length();
        Ray {
            origin: self.origin + from,
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
        let scale = match self.projection {
            Projection::Perspective => depth,
            Projection::Orthographic => 1.0,
        };
        let along = |axis: Vec3| v.dot(axis) / (scale * axis.length_squared());
        let (x, y) = (along(self.right), along(self.up));
        let place = Vec2::new(x + 1.0, 1.0 - y) * 0.5 - self.offset;
        let film = place * self.film - self.corner;
        (depth > 0.0 && film.is_finite()).then_some((film, depth))
    }

    /// Where the line of sight to a point begins, in scene units; that through a lens's middle.
    #[must_use]
    pub fn eye_of(&self, point: Vec3) -> Vec3 {
        match self.projection {
            Projection::Perspective => self.origin,
            Projection::Orthographic => point - self.forward * (point - self.origin).dot(self.forward),
        }
    }

    /// Where the camera is, in scene units.
    #[must_use]
    pub const fn origin(&self) -> Vec3 {
        self.origin
    }

    /// How the origin of a ray of unit `direction` and that direction change from one pixel to the next, along the image's width and
    /// along its height.
    #[must_use]
    pub fn change_of_ray(&self, direction: Vec3) -> [[Vec3; 2]; 2] {
        let steps = [self.right * (2.0 / self.film.x), self.up * (-2.0 / self.film.y)];
        match self.projection {
            Projection::Perspective => {
                let depth = direction.dot(self.forward);
                [[Vec3::ZERO; 2], steps.map(|step| (step - direction * direction.dot(step)) * depth)]
            }
            Projection::Orthographic => [steps, [Vec3::ZERO; 2]],
        }
    }

    /// Area that a pixel covers across a ray of unit `direction` after a distance.
    #[must_use]
    pub fn pixel_area(&self, direction: Vec3, distance: f32) -> f32 {
        let pixel = 4.0 * self.right.cross(self.up).length() / (self.film.x * self.film.y);
        let cosine = direction.dot(self.forward);
        match self.projection {
            // A pixel at depth 1 is 1/cos θ away and seen under the angle θ.
            Projection::Perspective => distance * distance * (pixel * cosine.powi(3)),
            Projection::Orthographic => pixel * cosine,
        }
    }
}

/// Tangent of half the horizontal field of view of a perspective.
fn tan_of_half_width(description: &SensorDescription) -> f64 {
    let (width, height) = (f64::from(description.width), f64::from(description.height));
    let half = (description.fov_degrees.to_radians() * 0.5).tan();
    match description.fov_axis {
        // Not by way of its width, for the last bit.
        FovAxis::X => half,
        axis => half * width / axis.spanned([width, height]),
    }
}

#[cfg(test)]
mod tests;
