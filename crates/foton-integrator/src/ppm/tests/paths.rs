//! Paths of photons to a pixel are those of the photons that it gathered, and looking at them changes nothing.

use std::num::NonZeroU32;
use std::sync::atomic::{AtomicU64, Ordering};

use foton_transport::Cancel;
use foton_transport::photon_map::PathClass;

use crate::ppm::settings::{Alpha, DirectLight, PpmSettings, RadiusRule};
use crate::ppm::{EyeSamples, Ppm};
use crate::settings::RenderSettings;
use crate::test_scene::scene;

fn start() -> Ppm {
    let photons = NonZeroU32::new(30_000).expect("above 0");
    let settings = RenderSettings {
        samples_per_pixel: NonZeroU32::MIN,
        ppm: PpmSettings {
            photons_per_pass: photons,
            first_pass: photons,
            // Radii stay as they are.
            alpha: Alpha::new(1.0).expect("in range"),
            radius_rule: RadiusRule::Local,
            // So that there are paths of all classes.
            direct_light: DirectLight::Photons,
            ..PpmSettings::default()
        },
        ..RenderSettings::default()
    };
    Ppm::start(EyeSamples::new(scene(), settings), &|_| (), &mut |_| (), &Cancel::default())
        .expect("not cancelled")
}

fn advance(ppm: &mut Ppm) {
    ppm.advance(&mut |_| (), &Cancel::default(), &|| false).expect("neither cancelled nor suspended");
}

#[test]
fn each_photon_that_a_pixel_gathered_has_its_path() {
    let mut ppm = start();
    assert!(ppm.paths_to(0, 64).is_empty(), "there is no pass yet");
    advance(&mut ppm);
    let found = ppm.photons_found();
    let (mut looked, mut classes) = (0, [0; 3]);
    for pixel in (0..found.len()).step_by(41) {
        // Of several discs one photon may count for more than one.
        let [disc] = ppm.discs(pixel)[..] else { continue };
        let paths = ppm.paths_to(pixel, usize::MAX);
        assert_eq!(paths.len(), found[pixel] as usize, "pixel {pixel}");
        for path in &paths {
            let [.., before, end] = path.points[..] else { panic!("two ends at least") };
            assert!(end.distance(disc.position) <= disc.radius * (1.0 + 1e-4));
            assert!(before.distance(end) > 0.0 && path.power.luminance() > 0.0);
            let is_straight = path.points.len() == 2;
            assert!(path.class != PathClass::Direct || is_straight, "{path:?}");
            classes[path.class as usize] += 1;
        }
        let few = ppm.paths_to(pixel, 2);
        assert!(few.len() == paths.len().min(2) && few == paths[..few.len()]);
        looked += 1;
    }
    assert!(looked > 4 && classes.iter().all(|n| *n > 0), "{looked} {classes:?}");
    assert!(ppm.paths_to(found.len(), 64).is_empty(), "beyond the image");
}

#[test]
fn looking_at_paths_changes_no_bit() {
    let (mut watched, mut alone) = (start(), start());
    for _ in 0..3 {
        advance(&mut watched);
        advance(&mut alone);
        let paths: usize = (0..6).map(|pixel| watched.paths_to(pixel * 37, 64).len()).sum();
        assert!(paths > 0);
        // Between the parts of a pass as well.
        let suspended = watched.advance(&mut |_| (), &Cancel::default(), &|| true);
        assert!(suspended.is_err());
        assert_eq!((0..6).map(|pixel| watched.paths_to(pixel * 37, 64).len()).sum::<usize>(), paths);
        // And in the middle, where some of its chunks are of the next pass.
        let asked = AtomicU64::new(0);
        let few = || asked.fetch_add(1, Ordering::Relaxed) >= 4;
        assert!(watched.advance(&mut |_| (), &Cancel::default(), &few).is_err());
        assert!((0..6).map(|pixel| watched.paths_to(pixel * 37, 64).len()).sum::<usize>() > 0);
        advance(&mut watched);
        advance(&mut alone);
        assert!(watched.save() == alone.save());
    }
}
