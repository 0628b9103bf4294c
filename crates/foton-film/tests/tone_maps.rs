//! The tone maps and the sRGB curve against values worked out by hand and the properties their sources promise.

use foton_film::ToneMap;
use foton_film::tone_map::{
    BRIGHTEST, NOT_FINITE, agx, agx_curve, display, expose, pbr_neutral, quantise, srgb_encode,
};
use foton_math::Rgb;

#[track_caller]
fn assert_close(found: Rgb, expected: [f32; 3]) {
    for (a, b) in found.to_array().into_iter().zip(expected) {
        assert!((a - b).abs() < 2e-6, "{found:?} is not {expected:?}");
    }
}

/// Numbers from 0 to 20 that crowd near 0, in rising order.
fn rising() -> impl Iterator<Item = f32> {
    (0..=2000u16).map(|i| 20.0 * (f32::from(i) / 2000.0).powi(3))
}

#[test]
fn neutral_only_subtracts_its_toe_below_the_start_of_compression() {
    // f = 0.04 once the smallest channel is above 0.08.
    assert_close(pbr_neutral(Rgb::new(0.08, 0.3, 0.8)), [0.04, 0.26, 0.76]);
    // x = 0.04: f = 0.04 − 0.0016/0.16 = 0.03.
    assert_close(pbr_neutral(Rgb::new(0.04, 0.5, 0.2)), [0.01, 0.47, 0.17]);
    // x = 0: f = 0.
    assert_close(pbr_neutral(Rgb::new(0.0, 0.76, 0.3)), [0.0, 0.76, 0.3]);
    assert_eq!(pbr_neutral(Rgb::BLACK), Rgb::BLACK);
}

#[test]
fn neutral_matches_values_worked_out_by_hand() {
    // White: p = 0.96, p_n = 1 − 0.0576/0.44.
    assert_close(pbr_neutral(Rgb::WHITE), [0.869_090_9; 3]);
    // Red 4: p = 4, p_n = 1 − 0.0576/3.48 = 0.983448, g = 1/(0.15·3.016552 + 1) = 0.688476.
    assert_close(pbr_neutral(Rgb::new(4.0, 0.0, 0.0)), [0.983_448_3, 0.306_367_4, 0.306_367_4]);
    // (2, 1, 0.5): f = 0.04, p = 1.96, p_n = 1 − 0.0576/1.44 = 0.96, g = 1/(0.15·1 + 1) = 20/23;
    // green = 0.96·(0.96/1.96·g + 1 − g), blue = 0.96·(0.46/1.96·g + 1 − g).
    assert_close(pbr_neutral(Rgb::new(2.0, 1.0, 0.5)), [0.96, 0.534_090_5, 0.321_135_76]);
}

#[test]
fn neutral_is_continuous_where_compression_starts() {
    for at in [Rgb::new(0.8, 0.5, 0.2), Rgb::new(0.76, 0.0, 0.0)] {
        let below = pbr_neutral(at * 0.999_999);
        assert_close(pbr_neutral(at * 1.000_001), below.to_array());
    }
}

#[test]
fn neutral_of_grey_rises_and_stays_below_one() {
    let mut last = -1.0;
    for v in rising().chain([100.0, 1e4, BRIGHTEST]) {
        let mapped = pbr_neutral(Rgb::splat(v)).r;
        assert!(mapped >= last && mapped <= 1.0, "{v} → {mapped} after {last}");
        last = mapped;
    }
}

#[test]
fn neutral_of_any_colour_stays_in_the_cube_and_its_peak_rises() {
    for hue in [[1.0, 0.0, 0.0], [0.2, 1.0, 0.0], [0.7, 0.4, 1.0], [1.0, 0.99, 0.98]] {
        let mut last = -1.0;
        for v in rising().chain([BRIGHTEST]) {
            let mapped = pbr_neutral(Rgb::from_array(hue) * v);
            assert!(mapped.to_array().iter().all(|c| (0.0..=1.0).contains(c)), "{hue:?}·{v} → {mapped:?}");
            assert!(mapped.max_component() >= last - 1e-7, "{hue:?}·{v}");
            last = mapped.max_component();
        }
    }
}

#[test]
fn agx_leaves_black_and_white_and_puts_middle_grey_at_half() {
    assert_eq!(agx(Rgb::BLACK), Rgb::BLACK);
    // Ten stops below middle grey and darker is black, 6.5 above and brighter is white.
    assert_close(agx(Rgb::splat(0.18 / 1024.0)), [0.0; 3]);
    assert_close(agx(Rgb::splat(0.18 * 6.5f32.exp2())), [1.0; 3]);
    assert_close(agx(Rgb::splat(0.18)), [0.5f32.powf(2.2); 3]);
}

#[test]
fn agx_matches_values_worked_out_by_hand() {
    // By the matrices from the primaries of sRGB and of sRGB drawn a fifth to white, in double precision, not by w and m.
    assert_close(agx(Rgb::new(1.0, 0.0, 0.0)), [0.720041, 0.039344, 0.039344]);
    assert_close(agx(Rgb::new(0.2, 0.5, 0.05)), [0.247263, 0.448220, 0.097755]);
    assert_close(agx(Rgb::new(4.0, 2.0, 1.0)), [0.887074, 0.754679, 0.614973]);
}

#[test]
fn the_curve_of_agx_rises_from_its_ends_and_follows_the_published_fit() {
    let mut last = -1e-6;
    for i in 0..=1000u16 {
        let x = f32::from(i) / 1000.0;
        let y = agx_curve(x);
        assert!(y > last && y < 1.0 + 1e-6, "{x} → {y} after {last}");
        last = y;
        // [WRE23] gives a polynomial fit of a mean squared error of 3.7e-6.
        let fit =
            [15.5, -40.14, 31.96, -6.868, 0.4298, 0.1191, -0.00232].iter().fold(0.0, |sum, a| sum * x + a);
        assert!((y - fit).abs() < 0.007, "{x} → {y}, the fit says {fit}");
    }
    assert!(agx_curve(0.0).abs() < 1e-6 && (agx_curve(1.0) - 1.0).abs() < 1e-6);
}

#[test]
fn agx_turns_bright_colours_to_white_and_keeps_greys_grey() {
    assert_close(agx(Rgb::new(BRIGHTEST, 0.0, 0.0)), [1.0; 3]);
    for v in rising() {
        let Rgb { r, g, b } = agx(Rgb::splat(v));
        assert!((r - g).abs() < 1e-6 && (g - b).abs() < 1e-6, "{v} → {r}, {g}, {b}");
    }
}

#[test]
fn maps_of_grey_rise_from_black_to_one() {
    for map in ToneMap::ALL {
        let mut last = 0.0;
        for v in rising().chain([100.0, 1e4, BRIGHTEST]) {
            let Rgb { r, .. } = map.apply(Rgb::splat(v));
            assert!(r >= last && r <= 1.0, "{}: {v} → {r} after {last}", map.name());
            last = r;
        }
        assert_eq!(map.apply(Rgb::BLACK), Rgb::BLACK);
    }
}

#[test]
fn maps_of_any_colour_stay_in_the_cube() {
    for map in ToneMap::ALL {
        for hue in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.2, 1.0, 0.0], [1.0, 0.99, 0.98]] {
            for v in rising().chain([BRIGHTEST]) {
                let mapped = map.apply(Rgb::from_array(hue) * v);
                let inside = mapped.to_array().iter().all(|c| (0.0..=1.0).contains(c));
                assert!(inside, "{}: {hue:?}·{v} → {mapped:?}", map.name());
            }
        }
    }
}

#[test]
fn srgb_has_its_known_values() {
    for (linear, encoded) in [
        (0.0, 0.0),
        (0.003_130_8, 0.040_449_936),
        (0.214_041_14, 0.5),
        (0.18, 0.461_356),
        (0.5, 0.735_357),
        (1.0, 1.0),
    ] {
        assert!((srgb_encode(linear) - encoded).abs() < 1e-6, "{linear} → {}", srgb_encode(linear));
    }
    // The inverse of every 8-bit value leads back to it.
    for byte in 0..=255u8 {
        let v = f64::from(byte) / 255.0;
        let linear = if v <= 0.04045 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) };
        assert_eq!(quantise(srgb_encode(linear as f32)), byte);
    }
}

#[test]
fn steps_are_rounded_to_the_nearest() {
    assert_eq!([0.0, 0.49 / 255.0, 0.51 / 255.0, 254.4 / 255.0, 1.0].map(quantise), [0, 0, 1, 254, 255]);
    assert_eq!([-1.0, 2.0].map(quantise), [0, 255]);
}

#[test]
fn a_stop_doubles_the_light() {
    let c = Rgb::new(0.1, 0.2, 0.3);
    assert_eq!(expose(c, 1.0), c * 2.0);
    assert_eq!(expose(c, -3.0), c * 0.125);
    assert_eq!(display(c, ToneMap::Linear, 1.0), display(c * 2.0, ToneMap::Linear, 0.0));
}

#[test]
fn pixels_that_are_not_finite_are_magenta() {
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        for c in [Rgb::new(bad, 0.0, 0.0), Rgb::new(0.5, bad, 0.5), Rgb::new(0.0, 1.0, bad)] {
            assert_eq!(display(c, ToneMap::PbrNeutral, 0.0), NOT_FINITE);
            assert_eq!(display(c, ToneMap::Linear, -4.0), NOT_FINITE);
        }
    }
}

#[test]
fn negative_channels_count_as_zero_and_the_brightest_is_white() {
    for map in ToneMap::ALL {
        assert_eq!(display(Rgb::new(-1.0, -1e30, 0.5), map, 0.0), display(Rgb::new(0.0, 0.0, 0.5), map, 0.0));
        assert_eq!(display(Rgb::splat(f32::MAX), map, 10.0), [255; 3]);
    }
    assert_eq!(display(Rgb::new(f32::MAX, 0.0, 0.0), ToneMap::PbrNeutral, 0.0), [255; 3]);
    assert_eq!(display(Rgb::new(f32::MAX, 0.0, 0.0), ToneMap::Linear, 0.0), [255, 0, 0]);
}
