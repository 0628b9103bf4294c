//! Eye samples that are followed in steps are those that are followed at once; a render over some of them is one of the same picture.

use std::num::NonZeroU32;
use std::sync::Arc;

use foton_math::Rgb;
use foton_scene::description::{Bsdf, Conductor, MicrofacetDistribution, Microfacets};
use foton_scene::{Scene, description};
use foton_transport::Cancel;

use crate::layers::LayerKind;
use crate::ppm::settings::PpmSettings;
use crate::ppm::{EyeSamples, Ppm};
use crate::settings::RenderSettings;
use crate::test_scene as scene;

const SAMPLES: u32 = 6;

/// With all that eye paths find: hit points of both kinds, splitting at glass, emission, highlights in narrow gloss.
fn scene() -> Arc<Scene> {
    let mut description = scene::description();
    let metal = |alpha| {
        Bsdf::Conductor(Conductor {
            eta: Rgb::new(0.2, 0.9, 1.1),
            k: Rgb::new(3.9, 2.4, 2.2),
            specular_reflectance: Rgb::WHITE.into(),
            roughness: Some(Microfacets::isotropic(MicrofacetDistribution::Ggx, alpha)),
        })
    };
    let [chalk, glass] = &mut description.materials[..] else { panic!("two materials") };
    let narrow = description::Material { name: "narrow".into(), front: metal(0.05), ..glass.clone() };
    let wide = description::Material { name: "wide".into(), front: metal(0.4), ..chalk.clone() };
    description.materials.extend([narrow, wide]);
    let ball = description.shapes[1].clone();
    description.shapes[1].material = 3;
    description.shapes.push(description::ShapeDescription {
        geometry: description::Geometry::Sphere { centre: [0.0, 0.3, 0.5].into(), radius: 0.3 },
        material: 2,
        ..ball.clone()
    });
    description.shapes.push(description::ShapeDescription {
        geometry: description::Geometry::Sphere { centre: [0.6, 0.6, 0.6].into(), radius: 0.1 },
        radiance: Some(Rgb::new(3.0, 2.0, 1.0).into()),
        material: 0,
        ..ball
    });
    Arc::new(Scene::build(&description).expect("a sound scene"))
}

fn settings() -> RenderSettings {
    let photons = NonZeroU32::new(20_000).expect("above 0");
    RenderSettings {
        layers: true,
        error: true,
        samples_per_pixel: NonZeroU32::new(SAMPLES).expect("above 0"),
        ppm: PpmSettings { photons_per_pass: photons, first_pass: photons, ..PpmSettings::default() },
        ..RenderSettings::default()
    }
}

fn start(eye: EyeSamples) -> Ppm {
    Ppm::start(eye, &|_| (), &mut |_| (), &Cancel::default()).expect("not cancelled")
}

fn start_with_some(eye: &mut EyeSamples, samples: u32, widened: f32) -> Ppm {
    let with = (settings(), widened);
    Ppm::start_with_some((eye, samples), with, &|_| (), &mut |_| (), &Cancel::default())
        .expect("not cancelled")
}

fn after(mut ppm: Ppm, passes: u32) -> Ppm {
    for _ in 0..passes {
        ppm.advance(&mut |_| (), &Cancel::default(), &|| false).expect("neither cancelled nor suspended");
    }
    ppm
}

/// All that passes have changed, and all that is shown.
fn state(ppm: &Ppm) -> (Vec<u8>, String) {
    let layers: Vec<_> = LayerKind::ALL.into_iter().map(|kind| ppm.layer(kind)).collect();
    (ppm.save(), format!("{:?} {:?} {layers:?}", ppm.start_report(), ppm.image()))
}

#[test]
fn a_render_whose_samples_were_followed_in_steps_has_the_bits_of_one_at_once() {
    let at_once = after(start(EyeSamples::new(scene(), settings())), 2);
    assert!(!at_once.hit_points.gloss.is_empty() && at_once.hit_points.first_glossy > 0);
    assert!(at_once.light.emission().iter().any(|e| e.r > 0.0));
    for steps in [&[1][..], &[1, 4], &[1, 2, 3, 4, 5], &[6]] {
        let mut eye = EyeSamples::new(scene(), settings());
        for &samples in steps {
            let some = after(start_with_some(&mut eye, samples, 1.0), 2);
            assert_eq!(eye.followed(), samples);
            // Of all of them it is the whole render.
            assert_eq!(state(&some) == state(&at_once), samples == SAMPLES, "{steps:?}");
        }
        assert!(state(&after(start(eye), 2)) == state(&at_once), "{steps:?}");
    }
}

/// Within what eye samples and photons scatter by.
#[test]
fn a_render_over_some_samples_shows_the_same_light() {
    let mean = |ppm: &Ppm| {
        let pixels = ppm.image().pixels;
        pixels.iter().map(|p| f64::from(p.luminance())).sum::<f64>() / pixels.len() as f64
    };
    let mut eye = EyeSamples::new(scene(), settings());
    let [first, wide] = [1.0, 2.0].map(|widened| start_with_some(&mut eye, 1, widened));
    assert!((wide.radii().median / first.radii().median - 2.0).abs() < 1e-5);
    let [first, wide, whole] = [first, wide, start(eye)].map(|ppm| after(ppm, 12));
    let unlit = |ppm: &Ppm| ppm.unknown_share().iter().sum::<f32>();
    assert!(unlit(&wide) <= unlit(&first), "{} {}", unlit(&wide), unlit(&first));
    let sigma = |ppm: &Ppm| {
        let error = ppm.error().expect("enough passes");
        error.total * error.mean_luminance / f64::from(32 * 32).sqrt()
    };
    let (a, b) = (mean(&first), mean(&whole));
    assert!((a - b).abs() < 3.0 * (sigma(&first) + sigma(&whole)) + 0.02 * b, "{a} {b}");
    assert!((mean(&wide) / b - 1.0).abs() < 0.05, "{} {b}", mean(&wide));
}

#[test]
fn samples_whose_following_is_cancelled_are_followed_anew() {
    let tell: &(dyn Fn(f64) + Sync) = &|_| ();
    let mut eye = EyeSamples::new(scene(), settings());
    eye.follow(2, &Cancel::default(), tell).expect("not cancelled");
    assert!(eye.bytes() > 0);
    let cancel = Cancel::default();
    cancel.request();
    assert!(eye.follow_all(&cancel, tell).is_err());
    assert_eq!((eye.followed(), eye.bytes()), (0, 0));
    let at_once = start(EyeSamples::new(scene(), settings()));
    assert!(state(&start(eye)) == state(&at_once));
}

#[test]
fn what_is_told_is_the_share_of_all_samples() {
    use std::sync::Mutex;
    let told = Mutex::new(Vec::new());
    let tell = |share: f64| told.lock().expect("whole").push(share);
    let mut eye = EyeSamples::new(scene(), settings());
    eye.follow(2, &Cancel::default(), &tell).expect("not cancelled");
    let first = std::mem::take(&mut *told.lock().expect("whole"));
    eye.follow_all(&Cancel::default(), &tell).expect("not cancelled");
    let rest = told.into_inner().expect("whole");
    let largest = |shares: &[f64]| shares.iter().copied().fold(0.0, f64::max);
    assert!((largest(&first) - 2.0 / 6.0).abs() < 1e-12, "{first:?}");
    assert!(rest.iter().all(|&share| share >= 2.0 / 6.0) && largest(&rest) == 1.0, "{rest:?}");
}
