//! Two-pass photon mapping: the same light as by progressive photon mapping and by path tracing, maps that outlive their render.

use std::num::NonZeroU32;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use foton_format::{Options, open};
use foton_integrator::{
    Cancel, DirectLight, LayerKind, MapDisplay, Method, PhotonMapSettings, PpmSettings, RadiusFloor,
    RadiusScale, Render, RenderSettings,
};
use foton_math::glam::DVec3;
use foton_scene::Scene;
use foton_session::maps::{self, MapsError};
use foton_tests::{Sketch, glass, grey};

const ASSETS: [&str; 5] = ["cornell-diffuse", "cornell-spheres", "box-spheres", "pool", "glass-and-ring"];

fn number(n: u32) -> NonZeroU32 {
    NonZeroU32::new(n).expect("above 0")
}

fn asset(name: &str) -> Arc<Scene> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../assets/{name}/scene.xml"));
    let mut scene = open(&path, &Options::default()).expect("a sound file").description;
    let sensor = &mut scene.sensors[0];
    (sensor.width, sensor.height) = (30, 20);
    Arc::new(Scene::build(&scene).expect("a sound scene"))
}

fn after(scene: &Arc<Scene>, settings: RenderSettings, passes: u32) -> Render {
    let cancel = Cancel::default();
    let mut render = Render::start(Arc::clone(scene), settings, &mut |_| (), &cancel).expect("not cancelled");
    for _ in 0..passes {
        render.advance(&mut |_| (), &cancel).expect("a pass");
    }
    render
}

fn by_maps(photon_map: PhotonMapSettings) -> RenderSettings {
    RenderSettings {
        method: Method::PhotonMap,
        samples_per_pixel: NonZeroU32::MIN,
        layers: true,
        photon_map,
        ..RenderSettings::default()
    }
}

/// Radii so small that there is hardly any bias: the mean over the image needs no single pixel to be smooth.
fn by_small_discs() -> RenderSettings {
    RenderSettings {
        samples_per_pixel: number(16),
        layers: true,
        ppm: PpmSettings {
            photons_per_pass: number(50_000),
            first_pass: number(50_000),
            radius_scale: RadiusScale::new(0.05).expect("above 0"),
            radius_floor: RadiusFloor::new(0.0).expect("no floor"),
            direct_light: DirectLight::ShadowRays,
            ..PpmSettings::default()
        },
        ..RenderSettings::default()
    }
}

/// The mean luminance of light that surfaces reflect: where emitters are seen, eye samples that stand still miss the rim of a small lamp.
fn reflected(render: &Render) -> f64 {
    let of = |kind| {
        let layer = render.colour_layer(kind).expect("summed");
        layer.pixels.iter().map(|p| f64::from(p.luminance())).sum::<f64>() / layer.pixels.len() as f64
    };
    [LayerKind::Direct, LayerKind::Caustic, LayerKind::Indirect].map(of).iter().sum()
}

#[test]
fn maps_show_the_light_that_progressive_photon_mapping_converges_to() {
    for name in ASSETS {
        let scene = asset(name);
        let expected = reflected(&after(&scene, by_small_discs(), 50));
        for (display, most) in [(MapDisplay::FinalGathering, 0.012), (MapDisplay::Direct, 0.03)] {
            let settings = by_maps(PhotonMapSettings { display, ..PhotonMapSettings::default() });
            let found = reflected(&after(&scene, settings, 120));
            let off = found / expected - 1.0;
            assert!(off.abs() < most, "{name}, {}: off by {:.2} %", display.name(), 100.0 * off);
        }
    }
}

/// A room without caustics is where a path tracer is exact.
#[test]
fn final_gathering_shows_the_light_that_path_tracing_finds() {
    let scene = asset("cornell-diffuse");
    let path = RenderSettings { method: Method::Path, ..by_maps(PhotonMapSettings::default()) };
    let [expected, found] =
        [path, by_maps(PhotonMapSettings::default())].map(|s| reflected(&after(&scene, s, 300)));
    let off = found / expected - 1.0;
    assert!(off.abs() < 0.01, "off by {:.2} %", 100.0 * off);
}

/// What is shown of the map itself is blurred over the disc of each estimate: the more photons, the less.
#[test]
fn direct_display_comes_closer_with_more_photons() {
    let scene = asset("cornell-diffuse");
    let layer = |photon_map: PhotonMapSettings, passes| {
        let render = after(&scene, by_maps(photon_map), passes);
        render.colour_layer(LayerKind::Indirect).expect("summed").pixels
    };
    let truth =
        layer(PhotonMapSettings { global_photons: number(400_000), ..PhotonMapSettings::default() }, 200);
    let error = |photons: u32| {
        let settings = PhotonMapSettings {
            global_photons: number(photons),
            display: MapDisplay::Direct,
            ..PhotonMapSettings::default()
        };
        let shown = layer(settings, 30);
        let squares = shown.iter().zip(&truth).map(|(a, b)| f64::from((*a - *b).luminance()).powi(2));
        squares.sum::<f64>().sqrt()
    };
    let errors = [2_000, 20_000, 200_000].map(error);
    assert!(errors[1] < 0.8 * errors[0] && errors[2] < 0.8 * errors[1], "{errors:?}");
}

/// A box with a ball of glass under a lamp of a single point, seen from one of two places.
fn glass_box(from_the_side: bool) -> Arc<Scene> {
    let eye = if from_the_side { DVec3::new(0.9, 0.3, 0.0) } else { DVec3::new(0.0, 0.0, 0.95) };
    let sketch = Sketch::default()
        .camera(eye, DVec3::new(0.0, -0.3, -0.2), 70.0, 24)
        .room(grey(0.6), None)
        .sphere(DVec3::new(0.1, -0.5, 0.0), 0.35, glass(1.5), None)
        .point(DVec3::new(0.3, 0.8, 0.2), 2.0);
    sketch.build().expect("sound")
}

fn few_photons() -> PhotonMapSettings {
    PhotonMapSettings { global_photons: number(5000), caustic_photons: 5000, ..PhotonMapSettings::default() }
}

fn path(name: &str) -> PathBuf {
    std::env::temp_dir().join(format!("foton-{}-{name}.maps", std::process::id()))
}

#[test]
fn maps_in_a_file_show_what_they_show_in_the_render_that_made_them_from_any_camera() {
    let (front, side) = (glass_box(false), glass_box(true));
    assert_eq!(front.fingerprint(), side.fingerprint(), "cameras make no other scene");
    let path = path("kept");
    let made = after(&front, by_maps(few_photons()), 2);
    maps::write(&path, &made.maps().expect("maps"), &front).expect("written");
    let max_depth = by_maps(few_photons()).max_depth_in(&front);
    let kept = maps::read(&path, &front, max_depth).expect("its own");
    for scene in [front, side] {
        let (cancel, settings) = (Cancel::default(), by_maps(few_photons()));
        let mut again =
            Render::start_with_maps(Arc::clone(&scene), settings.clone(), &kept, &mut |_| (), &cancel)
                .expect("not cancelled");
        for _ in 0..2 {
            again.advance(&mut |_| (), &cancel).expect("a pass");
        }
        let own = after(&scene, settings, 2);
        assert!(again.image() == own.image() && again.save() == own.save());
        assert_eq!((again.ledger(), again.photons_emitted()), (own.ledger(), own.photons_emitted()));
        assert!(own.ledger().imbalance().abs() < 1e-6, "{}", own.ledger().imbalance());
        let caustic = own.colour_layer(LayerKind::Caustic).expect("summed");
        assert!(caustic.pixels.iter().any(|p| p.luminance() > 0.0));
    }
    let _ = std::fs::remove_file(path);
}

#[test]
fn maps_of_another_scene_or_depth_and_damaged_ones_are_refused() {
    let scene = glass_box(false);
    let path = path("refused");
    let made = after(&scene, by_maps(few_photons()), 0).maps().expect("maps");
    maps::write(&path, &made, &scene).expect("written");
    let depth = made.max_depth();
    assert!(matches!(
        maps::read(&path, &scene, 5),
        Err(MapsError::OtherDepth { found, wanted: 5, .. }) if found == depth
    ));
    let mut brighter = Sketch::default().camera(DVec3::ZERO, DVec3::Z, 70.0, 8).room(grey(0.61), None);
    brighter = brighter.point(DVec3::new(0.3, 0.8, 0.2), 2.0);
    let other = brighter.build().expect("sound");
    assert!(matches!(maps::read(&path, &other, depth), Err(MapsError::OtherScene { .. })));
    let bytes = std::fs::read(&path).expect("there");
    let read = |bytes: &[u8]| {
        std::fs::write(&path, bytes).expect("written");
        maps::read(&path, &scene, depth)
    };
    for at in (0..bytes.len()).step_by(bytes.len() / 61 + 1) {
        let mut bad = bytes.clone();
        bad[at] ^= 0x10;
        assert!(read(&bad).is_err(), "byte {at}");
        assert!(read(&bytes[..at]).is_err(), "cut at {at}");
    }
    assert!(matches!(read(b"<scene/>"), Err(MapsError::NoMaps { .. })));
    let mut newer = bytes.clone();
    newer[8] = 9;
    assert!(matches!(read(&newer), Err(MapsError::Version { found: 9, .. })));
    assert!(read(&bytes).is_ok());
    std::fs::remove_file(&path).expect("there");
    assert!(matches!(maps::read(&path, &scene, depth), Err(MapsError::Read { .. })));
}
