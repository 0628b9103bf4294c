//! How many photons the first pass has where discs are so wide that each photon is tested against many hit points: so few that a first
//! picture is there after about a second whatever radius and photons a scene file asks for. By counts, never by clocks.

use std::num::NonZeroU32;

use foton_transport::photon_map::{Grid, Packet};

use super::settings::PpmSettings;

/// About this many packets stand for all of them.
const PROBED: usize = 4096;

/// Tests of a photon against a packet of hit points that a first pass may cost: about a processor second.
const TESTS: f64 = 5e7;

/// A first pass has no fewer photons than this.
const FEWEST: f64 = 64.0;

/// Places at which a photon is stored, about.
const STORED: f64 = 2.0;

/// Lets the first pass have fewer photons than asked for where they would be tested against too many packets.
pub(super) fn begin_small(settings: &mut PpmSettings, packets: &[Packet], grid: &Grid) {
    let fitting = (TESTS / (STORED * packets_of_a_photon(packets, grid)).max(f64::MIN_POSITIVE)).max(FEWEST);
    let photons = &mut settings.first_pass;
    // Halved as often as needed: passes double from there, and meet the sizes that they would have had.
    while photons.get() > 1 && f64::from(photons.get()) > fitting {
        *photons = NonZeroU32::new(photons.get() / 2).unwrap_or(NonZeroU32::MIN);
    }
}

/// Packets that a photon is tested against wherever it is stored, if photons are spread evenly over touched cells.
fn packets_of_a_photon(packets: &[Packet], grid: &Grid) -> f64 {
    let step = packets.len().div_ceil(PROBED).max(1);
    let mut cells = 0u64;
    for packet in packets.iter().step_by(step) {
        grid.for_each_run(&packet.bounds(), |first, end| cells += u64::from(end - first));
    }
    cells as f64 * step as f64 / f64::from(grid.touched().max(1))
}

#[cfg(test)]
mod tests {
    use foton_transport::Cancel;

    use super::*;
    use crate::ppm::{EyeSamples, Ppm};
    use crate::settings::RenderSettings;
    use crate::test_scene::scene;

    fn start(radius: Option<f64>, samples: u32) -> Ppm {
        let number = |n| NonZeroU32::new(n).expect("above 0");
        let settings = RenderSettings {
            samples_per_pixel: number(samples),
            ppm: PpmSettings { photons_per_pass: number(5_000_000), radius, ..PpmSettings::default() },
            ..RenderSettings::default()
        };
        Ppm::start(EyeSamples::new(scene(), settings), &|_| (), &mut |_| (), &Cancel::default())
            .expect("not cancelled")
    }

    #[test]
    fn passes_begin_small_where_each_photon_meets_many_discs_and_grow_as_ever() {
        assert_eq!(start(None, 4).settings().ppm.first_pass, PpmSettings::default().first_pass);
        let mut wide = start(Some(10.0), 256);
        let first = wide.settings().ppm.first_pass;
        assert!(first < PpmSettings::default().first_pass && first.get() >= 64, "{first}");
        assert!(first.get().is_power_of_two(), "{first}");
        let mut photons = Vec::new();
        let mut tests = Vec::new();
        for _ in 0..3 {
            let report = wide.advance(&mut |_| (), &Cancel::default(), &|| false).expect("not cancelled");
            photons.push(report.photons_in_pass);
            tests.push(report.candidates as f64);
        }
        let first = u64::from(first.get());
        assert_eq!(photons, [first, 2 * first, 4 * first]);
        assert!(tests[0] < 2.0 * TESTS && tests[0] > 0.1 * TESTS, "{tests:?}");
    }
}
