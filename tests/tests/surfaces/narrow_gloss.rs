//! Narrow gloss: what sampled lobes, sampled emitters and photons each bring, on both sides of the roughness that divides specular
//! from gathered lobes.

use super::*;

/// How light comes to a sheet of gloss.
struct Way {
    name: &'static str,
    /// Adds to the scene what light comes by.
    add: fn(Sketch) -> Sketch,
    /// Whether the sun shines instead of a point.
    sun: bool,
    /// Whether the gloss is a coat.
    coated: bool,
}

impl Way {
    const fn new(name: &'static str, add: fn(Sketch) -> Sketch) -> Self {
        Self { name, add, sun: false, coated: false }
    }
}

/// A sheet whose gloss has that roughness, lit in a way.
fn lit(way: &Way, alpha: f32) -> Sketch {
    let material = if way.coated {
        Bsdf::Plastic(Plastic {
            int_ior: 1.5,
            ext_ior: 1.0,
            diffuse_reflectance: Colour::Constant(Rgb::BLACK),
            specular_reflectance: WHITE,
            nonlinear: false,
            roughness: Some(Microfacets::isotropic(MicrofacetDistribution::Ggx, alpha)),
        })
    } else {
        white_metal(alpha)
    };
    let s = Sketch::default().camera(DVec3::new(4.0, 3.0, 0.0), DVec3::ZERO, 26.0, 12).rectangle(
        DVec3::ZERO,
        DVec3::X * 3.0,
        DVec3::NEG_Z * 3.0,
        material,
        None,
    );
    let mut s = (way.add)(s).max_depth(8);
    if way.sun {
        s.0.emitters.push(EmitterDescription {
            name: "sun".into(),
            kind: EmitterKind::Directional {
                direction: DVec3::new(-1.0, -0.75, 0.0),
                irradiance: Rgb::splat(5.0),
            },
        });
        return s;
    }
    s.point(DVec3::new(-2.0, 1.5, 0.0), 120.0)
}

fn wall(s: Sketch, bsdf: Bsdf) -> Sketch {
    s.rectangle(DVec3::new(-3.0, 2.0, 0.0), DVec3::NEG_Z * 3.0, DVec3::Y * 3.0, bsdf, None)
}

fn sheet(s: Sketch, bsdf: Bsdf) -> Sketch {
    s.rectangle(DVec3::new(-1.6, 1.2, 0.0), DVec3::X * 1.2, DVec3::NEG_Z * 1.2, bsdf, None)
}

fn slab(s: Sketch) -> Sketch {
    let at = DAffine3::from_translation(DVec3::new(-1.6, 1.2, 0.0));
    let flat = DAffine3::from_scale(DVec3::new(1.2, 0.1, 1.2));
    s.shape(Geometry::Mesh(Arc::new(Mesh::cube())), at * flat, glass(1.5), None)
}

/// Light of a point, a spot or the sun that arrives by way of something clear shows in a specular lobe as in a gathered one.
#[test]
fn light_by_mirrors_and_through_clear_things_shows_on_both_sides_of_the_specular_roughness() {
    let by_mirror: fn(Sketch) -> Sketch = |s| wall(s, MIRROR);
    let ways = [
        Way::new("mirror", by_mirror),
        Way { coated: true, ..Way::new("coat by a mirror", by_mirror) },
        Way { sun: true, ..Way::new("sun by a mirror", by_mirror) },
        Way::new("panes", |s| wall(sheet(s, pane()), pane())),
        Way::new("mask", |s| masked(sheet(s, grey(0.0)), 0.5, true)),
        Way::new("nothing and a mirror", |s| wall(sheet(s, Bsdf::Null(Null)), MIRROR)),
        Way::new("slab", slab),
    ];
    let base = RenderSettings {
        ppm: PpmSettings { radius: Some(0.08), ..settings(60_000, 4).ppm },
        ..settings(60_000, 4)
    };
    for way in ways {
        let specular = seeds(&lit(&way, 0.0999), &base, 3, 4);
        let gathered = seeds(&lit(&way, 0.1001), &base, 3, 4);
        assert!(specular.0 > 0.0 && specular.1 < 0.05 * specular.0, "{}: {specular:?}", way.name);
        near(way.name, specular, gathered, 0.03);
    }
}

/// Where there is a point light, narrow lobes have hit points; those count nothing of an area emitter, which eye paths find.
#[test]
fn photons_in_narrow_gloss_bring_only_what_eye_paths_cannot() {
    let scene = |area: bool, point: bool| {
        let s = Sketch::default()
            .camera(DVec3::new(2.0, 3.0, 0.0), DVec3::ZERO, 16.0, 6)
            .rectangle(DVec3::ZERO, DVec3::X * 2.0, DVec3::NEG_Z * 2.0, white_metal(0.09), None)
            .rectangle(DVec3::new(-1.5, 1.5, 0.0), DVec3::NEG_Z * 1.5, DVec3::Y * 1.3, MIRROR, None)
            .max_depth(8);
        let s = if point { s.point(DVec3::new(-1.0, 1.2, 0.1), 100.0) } else { s };
        if !area {
            return s;
        }
        let radiance = 100.0 / (4.0 * PI * PI * 0.12 * 0.12);
        s.sphere(DVec3::new(-1.0, 1.5, 0.0), 0.12, grey(0.0), Some(Rgb::splat(radiance as f32)))
    };
    let base = RenderSettings {
        ppm: PpmSettings { radius: Some(0.05), ..settings(30_000, 64).ppm },
        ..settings(30_000, 64)
    };
    let [a, b, both] = [(true, false), (false, true), (true, true)]
        .map(|(area, point)| seeds(&scene(area, point), &base, 2, 4));
    near("both lights", both, (a.0 + b.0, a.1.hypot(b.1)), 0.02);
}

/// An area emitter so small that it is nearly a point, which eye paths find by themselves: the hit points of narrow lobes, rough
/// glass among them, add nothing to it, and a point light in its place gives the same light.
#[test]
fn photons_in_narrow_gloss_bring_what_eye_paths_would_of_an_area_emitter() {
    let rough_glass = |alpha: f32| {
        Bsdf::Dielectric(Dielectric {
            int_ior: 1.5,
            ext_ior: 1.0,
            specular_reflectance: WHITE,
            specular_transmittance: WHITE,
            roughness: Some(Microfacets::isotropic(MicrofacetDistribution::Ggx, alpha)),
        })
    };
    let scene = |material, below: bool, point: bool| {
        let s = Sketch::default()
            .camera(DVec3::new(2.0, 3.0, 0.0), DVec3::ZERO, 16.0, 6)
            .rectangle(DVec3::ZERO, DVec3::X * 2.0, DVec3::NEG_Z * 2.0, material, None)
            .max_depth(8);
        // A mirror beside the emitter casts its light on the sheet, from above or from below.
        let side = if below { -1.0 } else { 1.0 };
        let at = DVec3::new(-1.0, side * 1.5, 0.0);
        let s =
            s.rectangle(DVec3::new(-1.5, side * 1.5, 0.0), DVec3::NEG_Z * 1.5, DVec3::Y * 1.3, MIRROR, None);
        if point {
            return s.point(at, 100.0);
        }
        let radius = 0.12;
        let radiance = 100.0 / (4.0 * PI * PI * radius * radius);
        s.sphere(at, radius, grey(0.0), Some(Rgb::splat(radiance as f32)))
    };
    for (material, below) in
        [(white_metal(0.09), false), (rough_glass(0.25), false), (rough_glass(0.25), true)]
    {
        let few = RenderSettings {
            ppm: PpmSettings { radius: Some(0.05), ..settings(60_000, 16).ppm },
            ..settings(60_000, 16)
        };
        let by_point = seeds(&scene(material, below, true), &few, 3, 4);
        let many = settings(10_000, 256);
        let by_area = seeds(&scene(material, below, false), &many, 1, 4);
        near(&format!("{material:?} {below}"), by_point, by_area, 0.03);
    }
}
