//! The maps of a small scene.

use std::num::NonZeroU32;

use foton_math::Rgb;
use foton_scene::Sources;
use foton_transport::Cancel;
use foton_transport::guide::Cells;
use foton_transport::kd_tree::MapClass;
use foton_transport::photon_map::PathClass;

use super::settings::PhotonMapSettings;
use super::shoot::Wanted;
use super::{KeptMaps, MapDisplay};
use crate::ppm::LOBE_POLICY;
use crate::render::Render;
use crate::settings::{Method, RenderSettings};
use crate::test_scene::scene;

fn number(n: u32) -> NonZeroU32 {
    NonZeroU32::new(n).expect("above 0")
}

fn few() -> PhotonMapSettings {
    PhotonMapSettings {
        global_photons: number(20_000),
        caustic_photons: 10_000,
        display: MapDisplay::Direct,
        ..PhotonMapSettings::default()
    }
}

/// The render after some passes, and its rays.
fn after(photon_map: PhotonMapSettings, passes: u32) -> (Render, u64) {
    let settings = RenderSettings {
        method: Method::PhotonMap,
        samples_per_pixel: NonZeroU32::MIN,
        max_depth: Some(12),
        photon_map,
        ..RenderSettings::default()
    };
    let cancel = Cancel::default();
    let mut render = Render::start(scene(), settings, &mut |_| (), &cancel).expect("not cancelled");
    let rays = (0..passes).map(|_| render.advance(&mut |_| (), &cancel).expect("a pass").rays).sum();
    (render, rays)
}

fn maps(photon_map: PhotonMapSettings) -> KeptMaps {
    after(photon_map, 0).0.maps().expect("maps")
}

#[test]
fn maps_have_the_same_bytes_on_any_number_of_threads_and_come_back_from_them() {
    let settings = PhotonMapSettings { shadow_photons: true, ..few() };
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| maps(settings).to_bytes())
    };
    let bytes = on(1);
    assert!(bytes == on(3));
    let again = KeptMaps::from_bytes(&bytes).expect("its own");
    assert!(again.to_bytes() == bytes);
    assert!(again.global_photons() >= 20_000 && again.caustic_photons() >= 10_000 && !again.0.lit.is_empty());
    for at in (0..bytes.len()).step_by(bytes.len() / 97 + 1) {
        assert!(KeptMaps::from_bytes(&bytes[..at]).is_err(), "cut at {at}");
        let mut bad = bytes.clone();
        // Whatever comes of it, it is no panic.
        bad[at] ^= 0xff;
        let _ = KeptMaps::from_bytes(&bad);
    }
}

/// The power of packed photons is rounded; the sum over a map is not.
#[test]
fn the_power_of_a_map_is_that_of_its_photons() {
    let kept = maps(few());
    let maps = &kept.0;
    let sum = |wanted: MapClass| {
        let of_class = maps.global.nodes().iter().filter(|photon| photon.class() == wanted);
        of_class.map(|photon| f64::from(photon.light().mean())).sum::<f64>()
    };
    // All light that leaves the emitters falls on a surface of the closed box first, or on glass.
    let emitted = maps.account.ledger.emitted / maps.account.emitted[0] as f64;
    let direct = sum(MapClass::Direct);
    assert!(direct > 0.7 * emitted && direct < 1.001 * emitted, "{direct} of {emitted}");
}

/// Photons of the caustic map start where emitters see glass, and bring what all of them bring.
#[test]
fn aimed_photons_bring_the_caustics_that_unaimed_ones_bring() {
    let scene = scene();
    let shoot = |sources: &Sources, cells: &Cells| {
        let wanted =
            Wanted { scene: &scene, sources, cells, caustics: true, photons: 20_000, max_depth: 12, seed: 1 };
        let shot = wanted.shoot(&Cancel::default()).expect("not cancelled");
        assert!(shot.photons.iter().all(|photon| photon.class() == PathClass::Caustic));
        let power: f64 = shot.photons.iter().map(|photon| f64::from(photon.power.mean())).sum();
        (power / shot.emitted as f64, shot.photons.len() as f64 / shot.emitted as f64)
    };
    let (plain, by_direction) = (scene.sources(&[]), scene.sources(&[]).by_direction());
    let (power, share) = shoot(&plain, &Cells::unguided(&plain));
    let (aimed, aimed_share) =
        shoot(&by_direction, &Cells::towards_casters(&scene, &by_direction, &LOBE_POLICY));
    assert!((aimed / power - 1.0).abs() < 0.04, "{aimed} {power}");
    assert!(aimed_share > 10.0 * share, "{aimed_share} {share}");
}

#[test]
fn shadow_photons_save_rays_and_hardly_change_the_image() {
    let (plain, rays) = after(few(), 16);
    let (helped, fewer) = after(PhotonMapSettings { shadow_photons: true, ..few() }, 16);
    // Of some two shadow rays for each eye sample, about a third; rays of other kinds stay.
    let shadow_rays = 2 * 16 * plain.image().pixels.len() as u64;
    assert!(fewer < rays - shadow_rays / 4, "{} of {shadow_rays}", rays - fewer);
    let mean = |render: &Render| {
        let image = render.image();
        image.pixels.iter().copied().sum::<Rgb>() / image.pixels.len() as f32
    };
    let (a, b) = (mean(&plain), mean(&helped));
    assert!((a.g / b.g - 1.0).abs() < 0.01, "{a:?} {b:?}");
}
