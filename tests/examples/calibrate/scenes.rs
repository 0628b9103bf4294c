//! Scenes whose wrong pictures once claimed small errors: surfaces closer than a radius, light narrower than the gaps between eye
//! samples, and light from so far that hardly a photon arrives.

use foton_math::Rgb;
use foton_math::glam::{DAffine3, DQuat, DVec3};
use foton_scene::description::{EmitterDescription, EmitterKind};
use foton_tests::{Sketch, grey};

/// The scene of that name, seen by `side`² pixels.
pub(crate) fn of(name: &str, side: u32) -> Option<Sketch> {
    match name {
        "decal" => Some(decal(side)),
        "narrow-lights" => Some(narrow_lights(side)),
        "far-lamp" => Some(far_emitter(side)),
        _ => None,
    }
}

fn floor(sketch: Sketch, half: f64) -> Sketch {
    sketch.rectangle(DVec3::ZERO, DVec3::Z * half, DVec3::X * half, grey(0.5), None)
}

/// Half-transparent and opaque cards a millimetre above a floor, under an emitter.
fn decal(side: u32) -> Sketch {
    let mut sketch = floor(
        Sketch::default().camera(DVec3::new(3.0, 4.5, 6.0), DVec3::new(0.0, 0.3, 0.0), 40.0, side),
        5.0,
    );
    for (x, opacity) in [(-1.2, 0.5), (1.2, 1.0)] {
        let centre = DVec3::new(x, 1e-3, 0.0);
        sketch = sketch.rectangle(centre, DVec3::Z, DVec3::X, grey(0.5), None);
        let material = sketch.0.materials.last_mut().expect("a material");
        material.back = Some(material.front);
        material.opacity = Some(Rgb::splat(opacity).into());
    }
    sketch.rectangle(DVec3::Y * 5.0, DVec3::X, DVec3::Z, grey(0.0), Some(Rgb::splat(5.0))).max_depth(16)
}

/// Beams that light less than a pixel each, one in every few pixels, over a floor in soft light.
fn narrow_lights(side: u32) -> Sketch {
    let camera = Sketch::default().camera(DVec3::new(0.0, 5.0, 0.0), DVec3::ZERO, 20.0, side);
    let mut sketch = floor(camera, 4.0).point(DVec3::new(0.0, 3.0, 0.0), 0.02).max_depth(2);
    let to_floor = 5.0 * 10f64.to_radians().tan();
    let down = DQuat::from_rotation_x(std::f64::consts::FRAC_PI_2);
    for i in 0..100u32 {
        let place = |k: u32| to_floor * ((f64::from(k) + 0.513) / 5.0 - 1.0);
        let at = DVec3::new(place(i % 10), 3.0, place(i / 10));
        let to_world = DAffine3::from_rotation_translation(down, at);
        // A radius of two fifths of a pixel on the floor, three metres below.
        let degrees = (0.8 * to_floor / f64::from(side) / 3.0).atan().to_degrees();
        let (cutoff_degrees, beam_degrees) = (degrees, degrees);
        let kind = EmitterKind::Spot {
            to_world,
            intensity: Rgb::WHITE,
            cutoff_degrees,
            beam_degrees,
            texture: None,
        };
        sketch.0.emitters.push(EmitterDescription { name: format!("beam {i}"), kind });
    }
    sketch
}

/// A corner under an emitter a thousand times its size away.
fn far_emitter(side: u32) -> Sketch {
    Sketch::default()
        .camera(DVec3::new(0.0, 0.0, 4.4), DVec3::ZERO, 40.0, side)
        .rectangle(DVec3::new(0.0, -1.0, 0.0), DVec3::Z * 2.0, DVec3::X * 2.0, grey(0.7), None)
        .rectangle(DVec3::new(0.0, 0.0, -1.0), DVec3::X * 2.0, DVec3::Y * 2.0, grey(0.7), None)
        .sphere(DVec3::new(300.0, 800.0, 500.0), 50.0, grey(0.0), Some(Rgb::splat(100.0)))
}
