//! New things in a scene: surfaces, lights, and the shapes of a mesh file.

use std::f64::consts::FRAC_PI_4;
use std::sync::Arc;

use foton_math::Rgb;
use foton_math::glam::{DAffine3, DMat3, DQuat, DVec3};
use foton_scene::description::{
    Blend, Bsdf, Colour, Diffuse, EmitterDescription, EmitterKind, Geometry, Material, Mesh, Number, Relief,
    SceneDescription, ShapeDescription, Texture, TextureKind,
};

use super::camera::UpAxis;
use super::edit_error::EditError;
use super::geometry;
use super::names;
use super::target::Target;
use super::things;

/// What can be added.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NewThing {
    /// A sphere.
    Sphere,
    /// A cube.
    Cube,
    /// A level rectangle.
    Plane,
    /// A rectangle above, that shines down.
    AreaLight,
    /// A point light above.
    PointLight,
    /// A spot light above, aimed at the middle.
    SpotLight,
    /// Parallel light from high at a side.
    Sun,
    /// The same light from everywhere.
    Sky,
}

impl NewThing {
    /// All of them, in the order of the window.
    pub const ALL: [Self; 8] = [
        Self::Sphere,
        Self::Cube,
        Self::Plane,
        Self::AreaLight,
        Self::PointLight,
        Self::SpotLight,
        Self::Sun,
        Self::Sky,
    ];

    /// Its name in a menu.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Sphere => "Sphere",
            Self::Cube => "Cube",
            Self::Plane => "Plane",
            Self::AreaLight => "Area light",
            Self::PointLight => "Point light",
            Self::SpotLight => "Spot light",
            Self::Sun => "Sun (parallel light)",
            Self::Sky => "Sky (constant environment)",
        }
    }

    /// What its name in the scene begins with.
    const fn stem(self) -> &'static str {
        match self {
            Self::Sphere => "sphere",
            Self::Cube => "cube",
            Self::Plane => "plane",
            Self::AreaLight => "area-light",
            Self::PointLight => "point-light",
            Self::SpotLight => "spot-light",
            Self::Sun => "sun",
            Self::Sky => "sky",
        }
    }

    /// Whether it is a light.
    #[must_use]
    pub const fn is_light(self) -> bool {
        !matches!(self, Self::Sphere | Self::Cube | Self::Plane)
    }
}

/// Where new things go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Site {
    /// The point on which surfaces stand and which lights light.
    pub at: [f64; 3],
    /// How large a surface is: its half, in world units.
    pub half: f64,
    /// Which way is up.
    pub up: UpAxis,
}

/// Radiance that a new light makes of a white surface at the middle, about.
const BRIGHTNESS: f64 = 1.0;

/// The grey of new surfaces.
const GREY: f32 = 0.5;

impl Site {
    fn half(&self) -> f64 {
        if self.half.is_finite() && self.half > 0.0 { self.half } else { 1.0 }
    }

    /// A point above the middle.
    fn above(&self, halves: f64) -> DVec3 {
        DVec3::from(self.at) + self.up.vector() * (halves * self.half())
    }

    /// The rotation that takes an axis to the one that points up.
    fn stand(&self, axis: DVec3) -> DMat3 {
        DMat3::from_quat(DQuat::from_rotation_arc(axis, self.up.vector()))
    }
}

/// Heights of lights above the middle, in half sizes of surfaces.
const HIGH: f64 = 8.0;

/// Adds a thing; returns which one it is.
///
/// # Errors
/// For a sky where there is one.
pub(crate) fn add(
    description: &mut SceneDescription,
    thing: NewThing,
    site: Site,
) -> Result<Target, EditError> {
    if thing == NewThing::Sky {
        things::check_sky(description)?;
    }
    Ok(match surface(thing, site) {
        Some((geometry, to_world, radiance)) => {
            let material = own_material(description, thing, radiance.is_some());
            let name = names::free(description, thing.stem());
            let flip_normals = false;
            let shape = ShapeDescription { name, geometry, to_world, flip_normals, material, radiance };
            description.shapes.push(shape);
            Target::Shape(description.shapes.len() - 1)
        }
        None => {
            let name = names::free(description, thing.stem());
            description.emitters.push(EmitterDescription { name, kind: light(thing, site) });
            Target::Emitter(description.emitters.len() - 1)
        }
    })
}

/// The surface of a thing that has one.
fn surface(thing: NewThing, site: Site) -> Option<(Geometry, DAffine3, Option<Colour>)> {
    let half = site.half();
    let mesh = |mesh, turn: DMat3, size: f64, at: DVec3| {
        let to_world = DAffine3::from_mat3_translation(turn * size, at);
        Some((Geometry::Mesh(Arc::new(mesh)), to_world, None))
    };
    match thing {
        NewThing::Sphere => {
            let geometry = Geometry::Sphere { centre: site.above(1.0), radius: half };
            Some((geometry, DAffine3::IDENTITY, None))
        }
        NewThing::Cube => mesh(Mesh::cube(), DMat3::IDENTITY, half, site.above(1.0)),
        // A little above what is there: two surfaces in one place are seen as neither.
        NewThing::Plane => mesh(Mesh::rectangle(), site.stand(DVec3::Z), 3.0 * half, site.above(0.01)),
        NewThing::AreaLight => {
            let (side, height) = (1.5 * half, HIGH * half);
            let area = 4.0 * side * side;
            let radiance = BRIGHTNESS * std::f64::consts::PI * height * height / area;
            let (geometry, to_world, _) =
                mesh(Mesh::rectangle(), site.stand(DVec3::NEG_Z), side, site.above(HIGH))?;
            Some((geometry, to_world, Some(Rgb::splat(radiance as f32).into())))
        }
        _ => None,
    }
}

/// A light without a surface.
fn light(thing: NewThing, site: Site) -> EmitterKind {
    let height = HIGH * site.half();
    let irradiance = BRIGHTNESS * std::f64::consts::PI;
    let intensity = Rgb::splat((irradiance * height * height) as f32);
    match thing {
        NewThing::SpotLight => {
            let turn = site.stand(DVec3::NEG_Z);
            let to_world = DAffine3::from_mat3_translation(turn, site.above(HIGH));
            EmitterKind::Spot { to_world, intensity, cutoff_degrees: 25.0, beam_degrees: 18.0, texture: None }
        }
        NewThing::Sun => {
            let direction = -site.up.direction(FRAC_PI_4, FRAC_PI_4);
            EmitterKind::Directional { direction, irradiance: Rgb::splat(irradiance as f32) }
        }
        NewThing::Sky => EmitterKind::Constant { radiance: Rgb::splat(0.2) },
        _ => EmitterKind::Point { position: site.above(HIGH), intensity },
    }
}

/// A grey material, or a black one for a surface that shines.
fn own_material(description: &mut SceneDescription, thing: NewThing, is_light: bool) -> usize {
    let reflectance = Colour::Constant(if is_light { Rgb::BLACK } else { Rgb::splat(GREY) });
    let front = Bsdf::Diffuse(Diffuse { reflectance });
    let name = names::free(description, &format!("{}-material", thing.stem()));
    description.materials.push(Material { name, front, back: Some(front), ..Material::default() });
    description.materials.len() - 1
}

/// Adds the shapes of another description, with their materials and textures, standing at a site and as large as it says; returns
/// the first of them. Its lights and cameras stay behind.
pub(crate) fn import(
    description: &mut SceneDescription,
    from: &SceneDescription,
    site: Site,
) -> Option<Target> {
    let (first, textures) = (description.shapes.len(), description.textures.len());
    let moved = |colour: Colour| match colour {
        Colour::Texture(i) => Colour::Texture(i + textures),
        constant @ Colour::Constant(_) => constant,
    };
    for texture in &from.textures {
        let mut texture = Texture { name: names::free(description, &texture.name), ..texture.clone() };
        if let TextureKind::Checkerboard { colours } = &mut texture.kind {
            *colours = colours.map(moved);
        }
        description.textures.push(texture);
    }
    let materials = description.materials.len();
    let moved_number = |number: Number, _| match number {
        Number::Texture(i) => Number::Texture(i + textures),
        constant @ Number::Constant(_) => constant,
    };
    for material in &from.materials {
        let name = names::free(description, &material.name);
        let Material { front, back, coatings, opacity, relief, mixture, .. } = material;
        let moved_side = |b: &Bsdf| b.map(moved, moved_number);
        let (front, back) = (moved_side(front), back.as_ref().map(moved_side));
        let relief = relief.map(|relief| Relief { texture: relief.texture + textures, ..relief });
        let moved_blend = |blend: &Blend| Blend {
            material: blend.material + materials,
            weight: moved_number(blend.weight, [0.0, 1.0]),
        };
        let mixture = mixture.iter().map(moved_blend).collect();
        let opacity = opacity.map(moved);
        let coatings = coatings.map(|c| c.map(|c| c.map(moved, moved_number)));
        description.materials.push(Material { name, front, back, coatings, opacity, relief, mixture });
    }
    for shape in &from.shapes {
        let name = names::free(description, &shape.name);
        let material = shape.material + materials;
        let radiance = shape.radiance.map(moved);
        description.shapes.push(ShapeDescription { name, material, radiance, ..shape.clone() });
    }
    stand(&mut description.shapes[first..], site);
    (description.shapes.len() > first).then_some(Target::Shape(first))
}

/// Moves and scales shapes together so that they stand on a site.
fn stand(shapes: &mut [ShapeDescription], site: Site) {
    let (mut min, mut max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for shape in shapes.iter() {
        let (low, high) = geometry::world_bounds(shape);
        (min, max) = (min.min(low), max.max(high));
    }
    let size = (max - min).max_element();
    if !(size.is_finite() && size > 0.0) {
        return;
    }
    let factor = 2.0 * site.half() / size;
    let up = site.up.vector();
    let middle = (min + max) * 0.5;
    let bottom = middle - up * ((max - min) * 0.5).dot(up);
    let place = DAffine3::from_translation(site.at.into())
        * DAffine3::from_scale(DVec3::splat(factor))
        * DAffine3::from_translation(-bottom);
    for shape in shapes {
        shape.to_world = place * shape.to_world;
    }
}
