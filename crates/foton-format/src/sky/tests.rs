//! Values of skies and suns against those of Mitsuba 3.9.1.

use super::*;

fn sky(elevation: f64, turbidity: f64, albedo: f32, scales: [f64; 2]) -> Sky {
    let e = elevation.to_radians();
    // Mitsuba's +z is up, here +y is: its (x, y, z) is (x, z, −y).
    Sky {
        sun: DVec3::new(0.0, e.sin(), -e.cos()),
        turbidity,
        albedo: Rgb::splat(albedo),
        scales,
        aperture: APERTURE,
    }
}

/// Elevation, turbidity, albedo, direction, radiance.
type Looked = (f64, f64, f32, [f64; 3], [f64; 3]);

/// What Mitsuba prints for `sunsky` with `sun_scale` 0.
const SKIES: [Looked; 8] = [
    (60.0, 3.0, 0.3, [0.0, 0.0, 1.0], [0.036_503_24, 0.056_689_04, 0.106_840_32]),
    (60.0, 3.0, 0.3, [0.0, 1.0, 0.2], [0.118_735_97, 0.179_304_39, 0.273_946_32]),
    (60.0, 3.0, 0.3, [1.0, 0.0, 0.5], [0.047_036_09, 0.084_631_08, 0.156_978_98]),
    (20.0, 5.5, 0.1, [0.0, 1.0, 0.2], [1.046_203, 0.880_982_5, 0.559_495_15]),
    (20.0, 5.5, 0.1, [0.0, -1.0, 0.1], [0.101_384_85, 0.129_228_65, 0.144_034_48]),
    (5.0, 2.2, 0.8, [1.0, 0.0, 0.5], [0.024_438_81, 0.035_131_82, 0.042_197_53]),
    (85.0, 9.0, 0.3, [0.0, 0.0, 1.0], [0.845_587_85, 0.788_007_2, 0.687_400_1]),
    (85.0, 9.0, 0.3, [0.0, -1.0, 0.1], [0.153_465_52, 0.163_870_47, 0.180_913_05]),
];

#[test]
fn skies_have_mitsubas_radiance() {
    for (elevation, turbidity, albedo, [x, y, z], wanted) in SKIES {
        let sky = sky(elevation, turbidity, albedo, [1.0, 0.0]);
        let found = sky.radiance(&sky.model().expect("a sky"), DVec3::new(x, z, -y).normalize());
        for (found, wanted) in found.into_iter().zip(wanted) {
            assert!((found / wanted - 1.0).abs() < 1e-3, "{elevation} {turbidity}: {found}, not {wanted}");
        }
    }
}

#[test]
fn suns_have_mitsubas_radiance_and_all_of_their_power() {
    for (elevation, turbidity, wanted) in [
        (60.0, 3.0, [21_873.3, 18_316.1, 14_105.9]),
        (20.0, 5.5, [15_553.5, 11_236.2, 6458.9]),
        (5.0, 2.2, [10_778.0, 4870.0, 653.8]),
        (85.0, 9.0, [17_304.0, 14_269.3, 11_439.6]),
        (40.0, 3.0, [21_099.7, 17_149.7, 12_325.1]),
        (60.0, 10.0, [13_896.5, 11_088.3, 8761.4]),
    ] {
        let sun = sky(elevation, turbidity, 0.3, [0.0, 1.0]);
        let found = sun.sun_radiance();
        for (found, wanted) in found.iter().zip(wanted) {
            assert!((found / wanted - 1.0).abs() < 0.02, "{elevation} {turbidity}: {found}, not {wanted}");
        }
        // Over all directions, and of a sun of another size.
        for aperture in [APERTURE, 2.0] {
            let bitmap = Sky { aperture, ..sun }.bitmap();
            let pixel = PI / f64::from(bitmap.height - 1);
            let power: f64 = (0..bitmap.height)
                .map(|y| {
                    let row = &bitmap.pixels[(y * bitmap.width) as usize..][..bitmap.width as usize];
                    let sum: f64 = row.iter().map(|p| f64::from(p.g)).sum();
                    sum * pixel * pixel * (f64::from(y) * pixel).sin()
                })
                .sum();
            let wanted = found[1] * TAU * (1.0 - (0.5 * APERTURE).to_radians().cos());
            assert!((power / wanted - 1.0).abs() < 0.01, "{elevation}: {power}, not {wanted}");
        }
    }
}

/// Mitsuba's `sun_direction`, whose x is south and y west.
#[test]
fn the_sun_stands_where_mitsuba_puts_it() {
    let at = |latitude, longitude, timezone, date, time| {
        let sun = PlaceAndTime { latitude, longitude, timezone, date, time }.sun();
        DVec3::new(sun.z, -sun.x, sun.y)
    };
    let tokyo = |hour| at(35.6894, 139.6917, 9.0, [2010.0, 7.0, 10.0], [hour, 0.0, 0.0]);
    for (found, wanted) in [
        (tokyo(15.0), [0.051_385_4, 0.691_748, 0.720_308]),
        (tokyo(9.0), [0.095_695_2, -0.614_786, 0.782_867]),
        (tokyo(12.0), [0.231_117, 0.054_388_8, 0.971_405]),
        (at(-30.0, 20.0, 2.0, [2010.0, 1.0, 5.0], [10.0, 0.0, 0.0]), [-0.013_579_8, -0.609_486, 0.792_68]),
        (at(60.0, 10.0, 1.0, [2024.0, 3.0, 20.0], [16.0, 30.0, 15.0]), [0.420_982, 0.872_514, 0.247_981]),
    ] {
        assert!(found.distance(DVec3::from(wanted)) < 2e-3, "{found}, not {wanted:?}");
    }
}
