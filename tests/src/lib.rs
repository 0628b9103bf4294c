//! What tests across crates share: small scenes made in code, and renders of them.

pub mod plugins;
pub mod slopes;
pub mod window;

use std::f64::consts::PI;
use std::sync::Arc;

use foton_film::Image;
use foton_integrator::{Cancel, Render, RenderSettings};
use foton_math::Rgb;
use foton_math::glam::{DAffine3, DVec3};
use foton_scene::description::{
    Bsdf, Colour, Dielectric, Diffuse, EmitterDescription, EmitterKind, Filter, FovAxis, Geometry, Material,
    Mesh, SceneDescription, SensorDescription, ShapeDescription,
};
use foton_scene::{BuildError, Scene};

/// A description that grows by one line a thing.
#[derive(Clone, Default)]
pub struct Sketch(pub SceneDescription);

impl Sketch {
    /// A square image of `pixels`² looking from `from` to `to` with a field of view in degrees.
    #[must_use]
    pub fn camera(mut self, from: DVec3, to: DVec3, fov_degrees: f64, pixels: u32) -> Self {
        let forward = (to - from).normalize();
        let up = if forward.y.abs() > 0.99 { DVec3::Z } else { DVec3::Y };
        let left = up.cross(forward).normalize();
        self.0.sensors.push(SensorDescription {
            name: "camera".into(),
            to_world: DAffine3::from_cols(left, forward.cross(left), forward, from),
            fov_degrees,
            fov_axis: FovAxis::X,
            width: pixels,
            height: pixels,
            filter: Filter::Box { radius: 0.5 },
            ..SensorDescription::default()
        });
        self
    }

    /// A surface; it gets a material of its own.
    #[must_use]
    pub fn shape(
        mut self,
        geometry: Geometry,
        to_world: DAffine3,
        front: Bsdf,
        radiance: Option<Rgb>,
    ) -> Self {
        let name = format!("shape-{}", self.0.shapes.len() + 1);
        self.0.materials.push(Material { name: name.clone(), front, back: None, ..Material::default() });
        let material = self.0.materials.len() - 1;
        let flip_normals = false;
        let radiance = radiance.map(Into::into);
        self.0.shapes.push(ShapeDescription { name, geometry, to_world, flip_normals, material, radiance });
        self
    }

    /// Turns the last shape inside out.
    ///
    /// # Panics
    /// Without a shape.
    #[must_use]
    pub fn inside_out(mut self) -> Self {
        self.0.shapes.last_mut().expect("a shape").flip_normals = true;
        self
    }

    /// A rectangle given by its centre and half its sides; its normal is `x × y`.
    #[must_use]
    pub fn rectangle(self, centre: DVec3, x: DVec3, y: DVec3, front: Bsdf, radiance: Option<Rgb>) -> Self {
        let to_world = DAffine3::from_cols(x, y, x.cross(y).normalize(), centre);
        self.shape(Geometry::Mesh(Arc::new(Mesh::rectangle())), to_world, front, radiance)
    }

    /// A sphere.
    #[must_use]
    pub fn sphere(self, centre: DVec3, radius: f64, front: Bsdf, radiance: Option<Rgb>) -> Self {
        self.shape(Geometry::Sphere { centre, radius }, DAffine3::IDENTITY, front, radiance)
    }

    /// The cube [−1, 1]³ seen from inside: six rectangles, all facing the middle.
    #[must_use]
    pub fn room(mut self, front: Bsdf, radiance: Option<Rgb>) -> Self {
        for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
            for normal in [axis, -axis] {
                let x = DVec3::new(axis.z, axis.x, axis.y);
                self = self.rectangle(-normal, x, normal.cross(x), front, radiance);
            }
        }
        self
    }

    /// A point emitter of the given power in watts a channel.
    #[must_use]
    pub fn point(mut self, position: DVec3, power: f64) -> Self {
        let intensity = Rgb::splat((power / (4.0 * PI)) as f32);
        self.0.emitters.push(EmitterDescription {
            name: "point".into(),
            kind: EmitterKind::Point { position, intensity },
        });
        self
    }

    /// Paths of at most this many edges.
    #[must_use]
    pub fn max_depth(mut self, edges: u32) -> Self {
        self.0.max_depth = Some(edges);
        self
    }

    /// The scene.
    ///
    /// # Errors
    /// Those of [`Scene::build`].
    pub fn build(&self) -> Result<Arc<Scene>, BuildError> {
        Scene::build(&self.0).map(Arc::new)
    }

    /// The render after some passes.
    ///
    /// # Panics
    /// When the scene cannot be built: it is a test's own.
    #[must_use]
    pub fn render(&self, settings: RenderSettings, passes: u32) -> Render {
        let scene = self.build().expect("a sound scene");
        let cancel = Cancel::default();
        let mut render = Render::start(scene, settings, &mut |_| (), &cancel).expect("not cancelled");
        for _ in 0..passes {
            render.advance(&mut |_| (), &cancel).expect("not cancelled");
        }
        render
    }
}

/// A grey Lambertian reflector.
#[must_use]
pub const fn grey(reflectance: f32) -> Bsdf {
    Bsdf::Diffuse(Diffuse { reflectance: Colour::Constant(Rgb::splat(reflectance)) })
}

/// Clear glass in air.
#[must_use]
pub const fn glass(ior: f32) -> Bsdf {
    Bsdf::Dielectric(Dielectric {
        int_ior: ior,
        ext_ior: 1.0,
        specular_reflectance: Colour::Constant(Rgb::WHITE),
        specular_transmittance: Colour::Constant(Rgb::WHITE),
        roughness: None,
    })
}

/// The mean of an image's green channel.
#[must_use]
pub fn mean(image: &Image) -> f64 {
    image.pixels.iter().map(|p| f64::from(p.g)).sum::<f64>() / image.pixels.len() as f64
}

/// Mean and standard error of the mean.
#[must_use]
pub fn mean_and_sigma(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1.0);
    (mean, (variance / n).sqrt())
}

/// Mean green of a render under several seeds, with its standard error.
#[must_use]
pub fn seeds(sketch: &Sketch, base: &RenderSettings, passes: u32, count: u64) -> (f64, f64) {
    let means: Vec<f64> = (0..count)
        .map(|seed| mean(&sketch.render(RenderSettings { seed, ..base.clone() }, passes).image()))
        .collect();
    mean_and_sigma(&means)
}
