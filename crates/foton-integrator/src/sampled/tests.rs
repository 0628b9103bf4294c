//! Passes by samples: bits, breaks and cancellation, for each estimator.

use std::num::NonZeroU32;
use std::sync::atomic::{AtomicU64, Ordering};

use foton_transport::{Cancel, Halt};

use crate::LayerKind;
use crate::photon_map::PhotonMapSettings;
use crate::render::Render;
use crate::settings::{Method, RenderSettings};
use crate::test_scene::scene;

const METHODS: [Method; 3] = [Method::Path, Method::Whitted, Method::PhotonMap];

fn render(method: Method) -> Render {
    let settings = RenderSettings {
        method,
        samples_per_pixel: method.default_samples(),
        layers: true,
        error: true,
        max_depth: Some(12),
        photon_map: few_photons(),
        ..RenderSettings::default()
    };
    Render::start(scene(), settings, &mut |_| (), &Cancel::default()).expect("not cancelled")
}

fn few_photons() -> PhotonMapSettings {
    let number = |n| NonZeroU32::new(n).expect("above 0");
    PhotonMapSettings {
        global_photons: number(4000),
        caustic_photons: 2000,
        neighbours: number(20),
        ..PhotonMapSettings::default()
    }
}

fn advance(render: &mut Render, passes: u32) {
    for _ in 0..passes {
        render.advance(&mut |_| (), &Cancel::default()).expect("a pass");
    }
}

fn all(render: &Render) -> Vec<u8> {
    render.save()
}

#[test]
fn a_pass_that_makes_way_anywhere_has_the_bits_of_one_that_does_not() {
    for method in METHODS {
        let mut whole = render(method);
        advance(&mut whole, 3);
        for every in [1, 2, 3] {
            let (mut broken, asked) = (render(method), AtomicU64::new(0));
            let should_suspend = || asked.fetch_add(1, Ordering::Relaxed) % (every + 1) == every;
            let mut breaks = 0;
            while broken.passes() < 3 {
                match broken.advance_unless(&should_suspend, &mut |_| (), &Cancel::default()) {
                    Err(Halt::Suspended(_)) => breaks += 1,
                    outcome => drop(outcome.expect("a pass")),
                }
            }
            assert!(breaks > 0 && all(&broken) == all(&whole), "{method:?} {every}");
        }
    }
}

#[test]
fn a_cancelled_pass_has_not_happened_and_a_discarded_one_neither() {
    for method in METHODS {
        let mut whole = render(method);
        advance(&mut whole, 2);
        let before = all(&whole);
        let halted = whole.advance(&mut |_| (), &Cancel::after(2));
        assert!(matches!(halted, Err(Halt::Cancelled(_))));
        assert!(all(&whole) == before, "{method:?}");
        let asked = AtomicU64::new(0);
        let once = || asked.fetch_add(1, Ordering::Relaxed) > 0;
        assert!(matches!(
            whole.advance_unless(&once, &mut |_| (), &Cancel::default()),
            Err(Halt::Suspended(_))
        ));
        assert!(whole.pass_share() > 0.0 && whole.discard_pass() && !whole.discard_pass());
        advance(&mut whole, 1);
        let mut other = render(method);
        advance(&mut other, 3);
        assert!(all(&other) == all(&whole), "{method:?}");
    }
}

#[test]
fn a_restored_state_goes_on_with_the_same_bits_and_no_other_is_read() {
    for method in METHODS {
        let mut whole = render(method);
        advance(&mut whole, 2);
        let state = all(&whole);
        let mut resumed = render(method);
        resumed.restore(&state).expect("its own state");
        for render in [&mut whole, &mut resumed] {
            advance(render, 2);
        }
        assert!(all(&whole) == all(&resumed));
        assert_eq!(whole.error(), resumed.error());
        assert!(render(method).restore(&state[..state.len() - 1]).is_err());
        assert!(render(method).restore(&[&state[..], &[0]].concat()).is_err());
    }
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    for method in METHODS {
        let on = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            pool.install(|| {
                let mut render = render(method);
                advance(&mut render, 2);
                all(&render)
            })
        };
        assert!(on(1) == on(3), "{method:?}");
    }
}

#[test]
fn layers_of_light_add_up_to_the_image() {
    for method in METHODS {
        let mut render = render(method);
        advance(&mut render, 500);
        let kinds = [LayerKind::Direct, LayerKind::Caustic, LayerKind::Indirect, LayerKind::Emission];
        let layers = kinds.map(|kind| render.colour_layer(kind).expect("summed").pixels);
        for (pixel, light) in render.image().pixels.iter().enumerate() {
            let sum = layers.iter().map(|layer| layer[pixel]).sum::<foton_math::Rgb>();
            let most = light.max_component().max(1e-6);
            assert!((sum - *light).to_array().iter().all(|d| d.abs() < 1e-5 * most), "{pixel}");
        }
        let light = |layer: usize| layers[layer].iter().map(|c| c.luminance()).sum::<f32>();
        assert!(light(0) > 0.0 && light(3) > 0.0);
        // A ray tracer without photons sees neither caustics nor light from wall to wall.
        assert_eq!(light(1) > 0.0, method != Method::Whitted);
        assert_eq!(light(2) > 0.0, method != Method::Whitted);
    }
}

#[test]
fn the_noise_is_that_of_many_renders() {
    let seeds = 24;
    let runs: Vec<Render> = (0..seeds)
        .map(|seed| {
            let settings = RenderSettings { seed, ..render(Method::Path).settings().clone() };
            let mut run = Render::start(scene(), settings, &mut |_| (), &Cancel::default()).expect("started");
            advance(&mut run, 8);
            run
        })
        .collect();
    let images: Vec<Vec<f64>> = runs
        .iter()
        .map(|run| run.image().pixels.iter().map(|c| f64::from(c.luminance())).collect())
        .collect();
    let mean = |pixel: usize| images.iter().map(|image| image[pixel]).sum::<f64>() / seeds as f64;
    let truth: f64 = (0..images[0].len())
        .map(|pixel| images.iter().map(|i| (i[pixel] - mean(pixel)).powi(2)).sum::<f64>())
        .sum::<f64>()
        / (seeds - 1) as f64;
    let estimated: f64 = runs
        .iter()
        .map(|run| {
            let noise = run.error_plane(LayerKind::ErrorNoise).expect("estimated");
            noise.iter().map(|n| f64::from(*n).powi(2)).sum::<f64>()
        })
        .sum::<f64>()
        / seeds as f64;
    let ratio = (estimated / truth).sqrt();
    assert!((0.9..1.1).contains(&ratio), "{ratio}");
}
