//! What a scene does not need is left out without a trace: modelling it all the same gives the same picture.

use std::num::NonZeroU32;
use std::sync::Arc;

use foton_film::Image;
use foton_integrator::{Cancel, DirectLight, LightUse, PpmSettings, Render, RenderSettings};
use foton_math::Rgb;
use foton_math::glam::DVec3;
use foton_scene::{BsdfKind, BuildOptions, Census, LobeFlags, Scene};
use foton_tests::{Sketch, grey};

/// A lit room of plain walls with a ball in it, and no more.
fn room() -> Sketch {
    let (x, y, z) = (DVec3::X, DVec3::Y, DVec3::Z);
    Sketch::default()
        .camera(DVec3::new(0.3, 0.4, 2.6), DVec3::ZERO, 50.0, 24)
        .rectangle(-y, -z, -x, grey(0.6), None)
        .rectangle(-z, x, y, grey(0.4), None)
        .rectangle(x, z, y, grey(0.7), None)
        .rectangle(0.9 * y, 0.3 * x, 0.3 * z, grey(0.0), Some(Rgb::splat(9.0)))
        .sphere(DVec3::new(-0.3, -0.6, 0.1), 0.4, grey(0.5), None)
}

fn settings() -> RenderSettings {
    RenderSettings {
        ppm: PpmSettings {
            photons_per_pass: NonZeroU32::new(20_000).expect("above 0"),
            ..PpmSettings::default()
        },
        ..RenderSettings::default()
    }
}

fn render(sketch: &Sketch, forced: Census) -> Image {
    let scene = Scene::build_with(&sketch.0, &BuildOptions { forced, ..BuildOptions::default() })
        .expect("the room is sound");
    let cancel = Cancel::default();
    let mut render = Render::start(Arc::new(scene), settings(), &mut |_| {}, &cancel).expect("not cancelled");
    for _ in 0..4 {
        render.advance(&mut |_| {}, &cancel).expect("not cancelled");
    }
    render.image()
}

#[test]
fn modelling_what_a_scene_does_not_need_gives_the_same_bits() {
    let room = room();
    let plain = render(&room, Census::default());
    let none = Census::default();
    let kind = |flags, roughness, interpolated_normals| BsdfKind {
        flags,
        roughness,
        interpolated_normals,
        lambertian: true,
        masked: false,
    };
    let diffuse = LobeFlags::DIFFUSE | LobeFlags::REFLECTION;
    let smooth = vec![kind(diffuse, None, true)];
    let narrow = vec![kind(LobeFlags::GLOSSY | LobeFlags::REFLECTION, Some(0.05), false)];
    for (name, forced) in [
        ("textures", Census { textures: true, ..none.clone() }),
        ("blends", Census { mixtures: true, ..none.clone() }),
        ("bump and normal maps", Census { reliefs: true, ..none.clone() }),
        ("anisotropic frames", Census { anisotropy: true, ..none.clone() }),
        ("environment", Census { environment: true, ..none.clone() }),
        ("shading normals' correction", Census { bsdfs: smooth, ..none.clone() }),
        ("rough coats", Census { rough_coats: true, ..none.clone() }),
        ("looking at lights from narrow gloss", Census { bsdfs: narrow, delta_emitters: true, ..none }),
    ] {
        assert!(render(&room, forced).pixels == plain.pixels, "{name}");
    }
    assert!(plain.pixels.iter().map(|p| p.mean()).sum::<f32>() > 1.0, "the room is lit");
}

#[test]
fn a_light_behind_a_wall_is_starved_and_the_one_in_the_room_is_not() {
    let (x, z) = (DVec3::X, DVec3::Z);
    let hidden = DVec3::new(0.0, -9.0, 0.0);
    let sketch = room().rectangle(hidden, 0.3 * z, 0.3 * x, grey(0.0), Some(Rgb::splat(18.0)));
    let scene = Arc::new(Scene::build(&sketch.0).expect("sound"));
    let cancel = Cancel::default();
    // Behind shadow rays, photons that come straight from an emitter reach nothing that they could bring light to.
    let ppm = PpmSettings { direct_light: DirectLight::Photons, ..settings().ppm };
    let settings = RenderSettings { ppm, ..settings() };
    let mut render = Render::start(scene, settings, &mut |_| {}, &cancel).expect("not cancelled");
    render.advance(&mut |_| {}, &cancel).expect("not cancelled");
    let [room, hidden] = [0, 1].map(|i| render.light_use()[i]);
    assert_eq!(room.emitted + hidden.emitted, render.photons_emitted());
    assert!(room.hit_rate() > 0.5 && !room.is_starved(20_000), "{room:?}");
    assert_eq!((hidden.reached, hidden.is_starved(20_000)), (0, true), "{hidden:?}");
    // A light with few photons, or few photons in all, is not worth a word.
    let small = LightUse { emitted: 1_500, ..LightUse::default() };
    assert!(!small.is_starved(20_000) && !small.is_starved(2_000));
}
