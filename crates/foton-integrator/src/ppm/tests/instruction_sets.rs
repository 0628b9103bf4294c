//! No instruction set changes a bit: what is compiled for wide vectors against what every machine runs.

use std::num::NonZeroU32;
use std::sync::Arc;

use foton_scene::Scene;
use foton_transport::Cancel;
use pulp::Arch;

use crate::ppm::settings::PpmSettings;
use crate::ppm::{EyeSamples, Ppm};
use crate::settings::RenderSettings;
use crate::test_scene::scene;

/// Bits of the image after three passes, and photons found.
fn render(scene: &Arc<Scene>, arch: Arch) -> (Vec<[u32; 3]>, u64) {
    let settings = RenderSettings {
        ppm: PpmSettings {
            photons_per_pass: NonZeroU32::new(20_000).expect("above 0"),
            ..PpmSettings::default()
        },
        ..RenderSettings::default()
    };
    let cancel = Cancel::default();
    let mut ppm = Ppm::start(EyeSamples::new(scene.clone(), settings), &|_| (), &mut |_| (), &cancel)
        .expect("not cancelled");
    ppm.arch = arch;
    let accepted =
        (0..3).map(|_| ppm.advance(&mut |_| (), &cancel, &|| false).expect("not cancelled").accepted).sum();
    let image = ppm.image();
    (image.pixels.iter().map(|p| p.to_array().map(f32::to_bits)).collect(), accepted)
}

#[test]
fn the_widest_instruction_set_and_the_plainest_give_the_same_bits() {
    let scene = scene();
    let (plain, found) = render(&scene, Arch::Scalar);
    assert!(found > 10_000, "{found}");
    let (wide, found_wide) = render(&scene, Arch::new());
    assert!(plain == wide && found == found_wide, "{:?} differs", Arch::new());
    #[cfg(target_arch = "x86_64")]
    if let Some(v3) = pulp::x86::V3::try_new() {
        assert!(plain == render(&scene, Arch::V3(v3)).0, "AVX2 differs");
    }
}
