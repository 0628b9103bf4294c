//! Where on its textures a point of a surface lies, and how large an eye sample is there.

use std::f32::consts::PI;

use foton_math::Frame;
use foton_math::glam::{Vec2, Vec3};

use super::Scene;
use crate::primitive::Primitive;
use crate::surface::Surface;
use crate::texture::{At, Sampler};

/// Sines of the angle to a pole, and shares of a disc's radius, below this count as this: texture coordinates change without bound there.
const NEAREST_POLE: f32 = 1e-3;

/// The part of a surface that an eye sample stands for: the parallelogram around the point with these sides, in its tangent plane.
/// Scene units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Footprint {
    /// From a point to those that the neighbouring samples along the image's width and height see.
    pub sides: [Vec3; 2],
}

/// A lookup of textures: at a point, or over a footprint in texture coordinates.
#[derive(Clone, Copy)]
pub(super) struct Lookup {
    at: At,
    sides: Option<[Vec2; 2]>,
}

impl Lookup {
    #[inline]
    pub(super) fn colour(&self, sampler: &Sampler) -> foton_math::Rgb {
        self.sides
            .as_ref()
            .map_or_else(|| sampler.colour(&self.at), |sides| sampler.filtered(&self.at, sides))
    }

    #[inline]
    pub(super) fn scalar(&self, sampler: &Sampler) -> f32 {
        let filtered = |sides: &[Vec2; 2]| sampler.filtered_scalar(&self.at, sides);
        self.sides.as_ref().map_or_else(|| sampler.scalar(&self.at), filtered)
    }

    /// How the number changes with the texture coordinates of the surface.
    pub(super) fn slope(&self, sampler: &Sampler) -> Vec2 {
        let step = sampler.step();
        let beside = |by: Vec2| Self { at: At { uv: self.at.uv + by, ..self.at }, ..*self }.scalar(sampler);
        let along = |by: Vec2| beside(by) - beside(-by);
        Vec2::new(along(Vec2::new(step.x, 0.0)), along(Vec2::new(0.0, step.y))) / (2.0 * step)
    }
}

impl Scene {
    /// Where textures are looked up for a point, or for what an eye sample sees around it.
    #[inline]
    pub(super) fn lookup(&self, surface: &Surface, footprint: Option<&Footprint>) -> Lookup {
        let at = At { uv: self.texture_coordinate(surface), corner: self.corner(surface) };
        let sides = footprint.map(|f| f.sides.map(|side| self.change_of_coordinate(surface, side)));
        Lookup { at, sides }
    }

    /// How texture coordinates change along a vector in the tangent plane.
    fn change_of_coordinate(&self, surface: &Surface, along: Vec3) -> Vec2 {
        let to_object = self.shapes[surface.shape as usize].to_object;
        // The change of the angle around an axis, in turns.
        let turn = |p: Vec2, d: Vec2, least: f32| p.perp_dot(d) / (2.0 * PI * p.length_squared().max(least));
        match self.accel.primitive(surface.primitive) {
            Primitive::Triangle(corners) => {
                let [a, b, c] = self.uvs_of(surface.primitive);
                let weights = change_of_weights(corners, along);
                (b - a) * weights.x + (c - a) * weights.y
            }
            Primitive::Sphere { centre, radius, .. } => {
                let p = (to_object * (surface.position - centre)).normalize_or(Vec3::Z);
                let d = to_object * along / radius;
                let sine = (1.0 - p.z * p.z).max(0.0).sqrt().max(NEAREST_POLE);
                Vec2::new(turn(p.truncate(), d.truncate(), NEAREST_POLE * NEAREST_POLE), -d.z / (PI * sine))
            }
            Primitive::Disc { centre, radius, .. } => {
                let p = to_object * (surface.position - centre) / radius;
                let (p, d) = (p.truncate(), (to_object * along / radius).truncate());
                let out = p.dot(d) / p.length().max(NEAREST_POLE);
                Vec2::new(out, turn(p, d, NEAREST_POLE * NEAREST_POLE))
            }
            Primitive::Cylinder { from, axis, .. } => {
                let frame = Frame::from_normal(axis.normalize());
                let (p, d) = (frame.to_local(surface.position - from), frame.to_local(along));
                Vec2::new(
                    turn(p.truncate(), d.truncate(), f32::MIN_POSITIVE),
                    along.dot(axis) / axis.length_squared(),
                )
            }
        }
    }

    /// How the unit shading normal changes along a vector in the tangent plane. Relief is left out.
    #[must_use]
    pub fn change_of_normal(&self, surface: &Surface, along: Vec3) -> Vec3 {
        let change = match self.accel.primitive(surface.primitive) {
            Primitive::Triangle(corners) => {
                let Some([a, b, c]) = self.normals_of(surface.primitive) else { return Vec3::ZERO };
                let (v, w) = (surface.barycentric.x, surface.barycentric.y);
                let normal = a * (1.0 - v - w) + b * v + c * w;
                let weights = change_of_weights(corners, along);
                let change = (b - a) * weights.x + (c - a) * weights.y;
                // Interpolated normals may be turned to the side of the geometric one.
                change / normal.length().copysign(normal.dot(surface.shading_normal))
            }
            Primitive::Sphere { radius, inward, .. } => along / if inward { -radius } else { radius },
            Primitive::Disc { .. } => return Vec3::ZERO,
            // The radius has the sign of the side on which the normal is.
            Primitive::Cylinder { axis, radius, .. } => {
                (along - axis * (along.dot(axis) / axis.length_squared())) / radius
            }
        };
        let n = surface.shading_normal;
        let across = change - n * change.dot(n);
        if across.is_finite() { across } else { Vec3::ZERO }
    }
}

/// How the weights of a triangle's second and third vertex change along a vector in its plane.
fn change_of_weights([a, b, c]: [Vec3; 3], along: Vec3) -> Vec2 {
    let (e, f) = (b - a, c - a);
    let (ee, ef, ff) = (e.length_squared(), e.dot(f), f.length_squared());
    let (de, df) = (along.dot(e), along.dot(f));
    Vec2::new(ff * de - ef * df, ee * df - ef * de) / (ee * ff - ef * ef)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use foton_math::glam::{DAffine3, DVec2, DVec3};
    use foton_math::{Purpose, Ray, Stream, warp};

    use super::super::tests::described;
    use super::*;
    use crate::description::{
        Bsdf, Colour, Diffuse, Geometry, Material, Mesh, SceneDescription, ShapeDescription,
    };

    /// A part of a bent sheet with normals that its vertices state.
    fn sheet() -> Mesh {
        let corners = [(0.0, 0.0, 0.1), (1.0, 0.1, 0.0), (0.2, 0.9, 0.3)];
        let bent = |(x, y, z): (f64, f64, f64)| DVec3::new(0.6 * x - 0.2, 0.5 * y - 0.1, 1.0 + z);
        Mesh {
            positions: corners.map(DVec3::from).to_vec(),
            normals: corners.map(bent).to_vec(),
            texture_coordinates: [(0.1, 0.2), (0.9, 0.4), (0.3, 1.7)].map(DVec2::from).to_vec(),
            triangles: vec![[0, 1, 2]],
            ..Mesh::default()
        }
    }

    fn scene(geometry: Geometry, flip_normals: bool) -> Scene {
        let front = Bsdf::Diffuse(Diffuse { reflectance: Colour::Texture(0) });
        let material = Material { name: "squares".into(), front, ..Material::default() };
        let turn = DAffine3::from_axis_angle(DVec3::new(1.0, 2.0, 3.0).normalize(), 0.7);
        let to_world = turn * DAffine3::from_scale(DVec3::splat(1.5));
        let description = described(vec![material]);
        let shape = ShapeDescription { geometry, to_world, flip_normals, ..description.shapes[0].clone() };
        Scene::build(&SceneDescription { shapes: vec![shape], ..description }).expect("a sound scene")
    }

    /// How coordinates and normals change along the surface is what they differ by between points that are close.
    #[test]
    fn coordinates_and_normals_change_as_they_differ_between_near_points() {
        let mut stream = Stream::new(1, Purpose::Test, 0, 0);
        let tube = Geometry::Cylinder { from: DVec3::ZERO, to: DVec3::new(0.0, 0.4, 1.0), radius: 0.6 };
        let ball = || Geometry::Sphere { centre: DVec3::X, radius: 0.8 };
        for (name, geometry, flip) in [
            ("sheet", Geometry::Mesh(Arc::new(sheet())), false),
            ("ball", ball(), false),
            ("hollow ball", ball(), true),
            ("disc", Geometry::Disc, false),
            ("tube", tube.clone(), false),
            ("hollow tube", tube, true),
        ] {
            let scene = scene(geometry, flip);
            let radius = scene.bounds().radius();
            let (mut compared, mut tried) = (0, 0);
            while compared < 100 && tried < 20_000 {
                tried += 1;
                let from = scene.bounds().centre() + warp::square_to_sphere(stream.next_2d()) * radius * 2.0;
                let to = scene.bounds().centre() + warp::square_to_sphere(stream.next_2d()) * radius * 0.4;
                let Some(here) = scene.nearest(Ray::new(from, (to - from).normalize())) else { continue };
                let random = warp::square_to_sphere(stream.next_2d());
                let along = (random - here.normal * random.dot(here.normal)) * radius * 2e-3;
                // Half of it to either side.
                let beside = |by: f32| {
                    let to = here.position + along * by;
                    scene.nearest(Ray::new(from, (to - from).normalize()))
                };
                let (Some(before), Some(after)) = (beside(-0.5), beside(0.5)) else { continue };
                let uvs = [&before, &after].map(|s| scene.texture_coordinate(s));
                let difference = uvs[1] - uvs[0];
                let normals = after.shading_normal - before.shading_normal;
                if here.normal.dot((to - from).normalize()).abs() < 0.3
                    || difference.abs().max_element() > 0.2
                {
                    continue;
                }
                let found = scene.change_of_coordinate(&here, along);
                assert!(
                    (found - difference).length() < 0.03 * difference.length() + 2e-4,
                    "{name}: {found} {difference}"
                );
                let found = scene.change_of_normal(&here, along);
                assert!(
                    (found - normals).length() < 0.03 * normals.length() + 2e-5,
                    "{name}: {found} {normals}"
                );
                compared += 1;
            }
            assert_eq!(compared, 100, "{name}");
        }
    }
}
