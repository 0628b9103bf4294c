//! Passes of few photons: what they bring nothing to stays as it is, and need not be summed again.

use std::num::NonZeroU32;

use foton_transport::Cancel;

use crate::ppm::settings::{DirectLight, PpmSettings, RadiusRule};
use crate::ppm::{EyeSamples, Ppm};
use crate::settings::RenderSettings;
use crate::test_scene::scene;

fn start(radius_rule: RadiusRule, direct_light: DirectLight) -> Ppm {
    let photons = NonZeroU32::new(40).expect("above 0");
    let ppm = PpmSettings {
        photons_per_pass: photons,
        first_pass: photons,
        radius_rule,
        direct_light,
        // The mean power of photons would be that of those which are stored.
        guided: false,
        ..PpmSettings::default()
    };
    let settings = RenderSettings { error: true, ppm, ..RenderSettings::default() };
    Ppm::start(EyeSamples::new(scene(), settings), &|_| (), &mut |_| (), &Cancel::default())
        .expect("not cancelled")
}

/// A render that has been restored knows nothing of the pixels that were dark in the pass before, and sums them again.
#[test]
fn what_is_kept_of_dark_pixels_is_what_would_be_summed_again() {
    for rule in [RadiusRule::Adaptive, RadiusRule::Local, RadiusRule::Global] {
        for direct in [DirectLight::Photons, DirectLight::ShadowRays] {
            let (mut straight, mut again) = (start(rule, direct), start(rule, direct));
            for pass in 0..13 {
                for render in [&mut straight, &mut again] {
                    let report = render.advance(&mut |_| (), &Cancel::default(), &|| false);
                    let report = report.expect("not cancelled");
                    assert!(report.no_photon_share > 0.05, "dark pixels are what this is about");
                }
                // Cells are marked again in a render that is restored, so that fewer photons are stored in vain and counted.
                let known =
                    [&straight, &again].map(|ppm| format!("{:?} {:?}", ppm.error(), ppm.error_tiles()));
                assert!(
                    known[0] == known[1] && straight.image() == again.image(),
                    "{rule:?}, {direct:?}, pass {pass}"
                );
                again = start(rule, direct);
                again.restore(&straight.save()).expect("its own");
            }
        }
    }
}
