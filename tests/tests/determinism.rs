//! The same scene, seed and settings give the same bits, whatever the number of threads.

use std::num::NonZeroU32;
use std::sync::Arc;

use foton_film::Image;
use foton_integrator::{
    Alpha, Cancel, DirectLight, LayerKind, Method, PpmSettings, RadiusRule, RadiusScale, Render,
    RenderSettings, SettingChange, Variants,
};
use foton_math::Rgb;
use foton_math::glam::{DAffine3, DVec3};
use foton_scene::description::{Geometry, Mesh};
use foton_tests::{Sketch, glass, grey};

/// A ball of triangles with smooth normals.
fn ball() -> Mesh {
    let (rings, sectors) = (12u32, 24u32);
    let at = |ring: u32, sector: u32| {
        let theta = std::f64::consts::PI * f64::from(ring) / f64::from(rings);
        let phi = 2.0 * std::f64::consts::PI * f64::from(sector) / f64::from(sectors);
        DVec3::new(theta.sin() * phi.cos(), theta.cos(), theta.sin() * phi.sin())
    };
    let positions: Vec<DVec3> = (0..=rings).flat_map(|r| (0..=sectors).map(move |s| at(r, s))).collect();
    let index = |r: u32, s: u32| r * (sectors + 1) + s;
    let triangles = (0..rings)
        .flat_map(|r| (0..sectors).map(move |s| (r, s)))
        .flat_map(|(r, s)| {
            [
                [index(r, s), index(r, s + 1), index(r + 1, s)],
                [index(r, s + 1), index(r + 1, s + 1), index(r + 1, s)],
            ]
        })
        .collect();
    Mesh { normals: positions.clone(), positions, triangles, ..Mesh::default() }
}

fn scene() -> Sketch {
    let place =
        DAffine3::from_translation(DVec3::new(-0.4, -0.6, -0.2)) * DAffine3::from_scale(DVec3::splat(0.4));
    Sketch::default()
        .camera(DVec3::new(0.0, 0.0, 0.95), DVec3::new(0.0, -0.2, -1.0), 70.0, 48)
        .room(grey(0.6), None)
        .shape(Geometry::Mesh(Arc::new(ball())), place, grey(0.8), None)
        .sphere(DVec3::new(0.4, -0.6, 0.0), 0.35, glass(1.5), None)
        .sphere(DVec3::new(0.0, 0.8, 0.0), 0.1, grey(0.0), Some(Rgb::new(40.0, 30.0, 20.0)))
        .point(DVec3::new(0.7, 0.7, 0.7), 2.0)
}

/// More than one batch of photons and of hit points.
fn settings(direct_light: DirectLight) -> RenderSettings {
    RenderSettings {
        samples_per_pixel: NonZeroU32::new(3).expect("above 0"),
        layers: true,
        seed: 42,
        ppm: PpmSettings {
            photons_per_pass: NonZeroU32::new(30_001).expect("above 0"),
            first_pass: NonZeroU32::new(30_001).expect("above 0"),
            direct_light,
            ..PpmSettings::default()
        },
        ..RenderSettings::default()
    }
}

/// FNV-1a over all bits of an image.
fn hash(image: &Image) -> u64 {
    let bits = image.pixels.iter().flat_map(|p| p.to_array()).flat_map(|c| c.to_bits().to_le_bytes());
    bits.fold(0xcbf2_9ce4_8422_2325, |h, b| (h ^ u64::from(b)).wrapping_mul(0x0100_0000_01b3))
}

fn state(render: &Render) -> (u64, String, String) {
    let layers: Vec<_> = LayerKind::ALL.into_iter().map(|k| render.layer(k)).collect();
    (hash(&render.image()), format!("{layers:?}"), format!("{:?}", render.ledger()))
}

#[test]
fn one_two_and_seven_threads_give_the_same_bits() {
    let lights = [DirectLight::Photons, DirectLight::ShadowRays];
    let methods = [Method::Ppm, Method::Sppm];
    for (method, direct_light) in methods.into_iter().flat_map(|method| lights.map(|light| (method, light))) {
        let run = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            state(&pool.install(|| scene().render(RenderSettings { method, ..settings(direct_light) }, 5)))
        };
        let one = run(1);
        assert!(one == run(2) && one == run(7), "{method:?}, {direct_light:?}");
    }
}

#[test]
fn summing_path_classes_separately_does_not_change_a_photon() {
    let apart = scene().render(settings(DirectLight::Photons), 3);
    let whole = scene().render(RenderSettings { layers: false, ..settings(DirectLight::Photons) }, 3);
    // Nor a bit of the image, or of what is known of it.
    let facts = |r: &Render| (hash(&r.image()), r.mean_radii(), r.error(), *r.ledger());
    assert!(facts(&apart) == facts(&whole));
    let of = |layers, direct| scene().render(RenderSettings { layers, ..settings(direct) }, 3);
    let [apart_rays, whole_rays] = [true, false].map(|layers| of(layers, DirectLight::ShadowRays));
    assert!(facts(&apart_rays) == facts(&whole_rays));
    assert!(whole.layer(LayerKind::Caustic).is_none());
    let sum = |kind| match apart.layer(kind).expect("summed").channels {
        foton_film::LayerData::Rgb(image) => image.pixels.iter().map(|p| f64::from(p.g)).sum::<f64>(),
        _ => f64::NAN,
    };
    let parts: f64 = [LayerKind::Direct, LayerKind::Caustic, LayerKind::Indirect, LayerKind::Emission]
        .map(sum)
        .iter()
        .sum();
    let all: f64 = apart.image().pixels.iter().map(|p| f64::from(p.g)).sum();
    assert!((parts / all - 1.0).abs() < 1e-5 && sum(LayerKind::Caustic) > 0.0);
}

#[test]
fn the_image_is_the_mean_of_the_passes_weighted_by_photons_while_settings_change() {
    let cancel = Cancel::default();
    let start = settings(DirectLight::Photons);
    let scene = scene().build().expect("sound");
    let mut render = Render::start(scene, start, &mut |_| (), &cancel).expect("starts");
    let mut sum = vec![0.0f64; 48 * 48];
    for pass in 0..6u32 {
        if pass == 2 {
            // A slider on its way, and one that goes back to where it was.
            render.change(SettingChange::Alpha(Alpha::new(0.3).expect("in range")));
            render.change(SettingChange::PhotonsPerPass(NonZeroU32::new(90_000).expect("above 0")));
            render.change(SettingChange::Alpha(Alpha::new(0.9).expect("in range")));
            render.change(SettingChange::PhotonsPerPass(NonZeroU32::new(70_000).expect("above 0")));
        }
        let report = render.advance(&mut |_| (), &cancel).expect("not cancelled");
        assert_eq!(report.photons_in_pass, if pass < 2 { 30_001 } else { 70_000 });
        for (sum, p) in sum.iter_mut().zip(&render.last_pass().pixels) {
            *sum += f64::from(p.g) * report.photons_in_pass as f64;
        }
    }
    let effective = [(2, "alpha=0.9".to_owned()), (2, "photons=70000".to_owned())];
    assert_eq!(
        render.changes().iter().map(|(pass, c)| (*pass, c.to_string())).collect::<Vec<_>>(),
        effective
    );
    render.change(SettingChange::Alpha(Alpha::new(0.5).expect("in range")));
    render.change(SettingChange::Alpha(Alpha::new(0.9).expect("in range")));
    assert_eq!(render.changes().len(), 2, "what leads back is no change");
    let Some(foton_film::LayerData::Rgb(emission)) = render.layer(LayerKind::Emission).map(|l| l.channels)
    else {
        panic!("emission is colour")
    };
    for ((sum, p), e) in sum.iter().zip(&render.image().pixels).zip(&emission.pixels) {
        let expected = sum / render.photons_emitted() as f64 + f64::from(e.g);
        assert!((f64::from(p.g) - expected).abs() <= 1e-5 * expected.max(1e-3));
    }
}

#[test]
fn a_cancelled_pass_has_not_happened() {
    let cancel = Cancel::default();
    let mut render = scene().render(settings(DirectLight::Photons), 2);
    let before = state(&render);
    cancel.request();
    assert!(render.advance(&mut |_| (), &cancel).is_err());
    assert!(before == state(&render) && render.passes() == 2);
    render.advance(&mut |_| (), &Cancel::default()).expect("not cancelled");
    assert!(state(&render) == state(&scene().render(settings(DirectLight::Photons), 3)));
}

#[test]
fn power_of_two_multiples_of_a_scene_give_the_same_bits() {
    let render = |scale: f64| {
        let mut sketch = scene();
        let scaling = DAffine3::from_scale(DVec3::splat(scale));
        for shape in &mut sketch.0.shapes {
            shape.to_world = scaling * shape.to_world;
        }
        for sensor in &mut sketch.0.sensors {
            sensor.to_world.translation *= scale;
        }
        for emitter in &mut sketch.0.emitters {
            if let foton_scene::description::EmitterKind::Point { position, intensity } = &mut emitter.kind {
                *position *= scale;
                *intensity *= (scale * scale) as f32;
            }
        }
        hash(&sketch.render(settings(DirectLight::Photons), 2).image())
    };
    let one = render(1.0);
    assert_eq!(one, render(2f64.powi(-14)));
    assert_eq!(one, render(2f64.powi(20)));
}

/// `base` by other rules and radii, over the same photons.
fn variants(base: &RenderSettings) -> [RenderSettings; 7] {
    let with = |change: fn(&mut RenderSettings)| {
        let mut settings = base.clone();
        change(&mut settings);
        settings
    };
    [
        base.clone(),
        with(|s| s.ppm.alpha = Alpha::new(0.3).expect("in range")),
        with(|s| s.ppm.alpha = Alpha::new(1.0).expect("in range")),
        with(|s| s.ppm.radius_scale = RadiusScale::new(0.25).expect("above 0")),
        with(|s| s.ppm.radius_scale = RadiusScale::new(4.0).expect("above 0")),
        with(|s| {
            (s.layers, s.error) = (false, true);
            s.ppm.radius_rule = RadiusRule::Global;
        }),
        with(|s| {
            s.error = true;
            s.ppm.radius_rule = RadiusRule::Adaptive;
        }),
    ]
}

/// Sharing photons must not change what a variant is: later passes too, when discs and with them marked cells have shrunk apart.
#[test]
fn variants_over_shared_photons_have_the_bits_of_runs_of_their_own() {
    let photons = |n| NonZeroU32::new(n).expect("above 0");
    let base = RenderSettings {
        samples_per_pixel: NonZeroU32::MIN,
        ppm: PpmSettings {
            photons_per_pass: photons(12_000),
            first_pass: photons(4_000),
            ..settings(DirectLight::Photons).ppm
        },
        ..settings(DirectLight::Photons)
    };
    let variants = variants(&base);
    let (scene, cancel) = (scene().build().expect("a sound scene"), Cancel::default());
    let together = |photons| {
        let started = Variants::start(&scene, &variants, photons, &mut |_| (), &cancel);
        let mut together = started.expect("not cancelled").expect("they share their photons");
        for _ in 0..6 {
            together.advance(&mut |_| (), &cancel).expect("not cancelled");
        }
        together
    };
    let shared = together(base.seed);
    for (i, settings) in variants.iter().enumerate() {
        let mut alone =
            Render::start(Arc::clone(&scene), settings.clone(), &mut |_| (), &cancel).expect("runs");
        for _ in 0..6 {
            alone.advance(&mut |_| (), &cancel).expect("not cancelled");
        }
        let run = &shared.runs()[i];
        assert_eq!(hash(&run.image()), hash(&alone.image()), "variant {i}");
        assert_eq!(run.layer(LayerKind::Radius), alone.layer(LayerKind::Radius), "variant {i}");
        assert_eq!((run.ledger(), run.error()), (alone.ledger(), alone.error()), "variant {i}");
    }
    let other = together(base.seed + 1);
    assert_ne!(hash(&other.runs()[0].image()), hash(&shared.runs()[0].image()), "photons of their own");
    let other_depth = RenderSettings { max_depth: Some(3), ..base };
    let refused = Variants::start(&scene, &[base, other_depth], 0, &mut |_| (), &cancel);
    assert!(refused.expect("not cancelled").is_none(), "other photons");
}
