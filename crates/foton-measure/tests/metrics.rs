//! Figures against values worked out by hand; FLIP against its reference implementation.

use foton_film::{Image, Plane, ToneMap, tone_map};
use foton_math::Rgb;
use foton_measure::{Channels, CompareError, NonFinite, Pair, heat, scale_top, viridis};

fn row(pixels: &[Rgb]) -> Image {
    Image { width: pixels.len() as u32, height: 1, pixels: pixels.to_vec() }
}

fn constant(width: u32, height: u32, color: Rgb) -> Image {
    Image { width, height, pixels: vec![color; width as usize * height as usize] }
}

/// A plane that depends on nothing but its formula.
fn drawn(width: u32, height: u32, color: impl Fn(u32, u32) -> Rgb) -> Image {
    let pixels =
        (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| color(x, y)).collect();
    Image { width, height, pixels }
}

fn close(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance, "{found}, expected {expected}");
}

fn all_close(found: Channels, rgb: [f64; 3], all: f64) {
    for (found, expected) in found.rgb.into_iter().zip(rgb) {
        close(found, expected, 1e-6);
    }
    close(found.all, all, 1e-6);
}

#[test]
fn figures_are_those_worked_out_by_hand() {
    let a = row(&[Rgb::new(1.0, 0.5, 0.0), Rgb::new(3.0, 0.5, 0.0)]);
    let b = row(&[Rgb::new(2.0, 0.5, 0.1), Rgb::new(1.0, 0.5, 0.3)]);
    let pair = Pair::new(&a, &b).unwrap();
    // Squares: red 1 and 4, green 0 and 0, blue 0.01 and 0.09.
    all_close(pair.rmse(), [2.5f64.sqrt(), 0.0, 0.05f64.sqrt()], (2.55f64 / 3.0).sqrt());
    // Over y² + 0.01: red 1/4.01 and 4/1.01, blue 0.01/0.02 and 0.09/0.10.
    let (red, blue) = ((1.0 / 4.01 + 4.0 / 1.01) / 2.0, f64::midpoint(0.5, 0.9));
    all_close(pair.rel_mse(), [red, 0.0, blue], (red + blue) / 3.0);
    all_close(pair.mean_a(), [2.0, 0.5, 0.0], 2.5 / 3.0);
    all_close(pair.mean_b(), [1.5, 0.5, 0.2], 2.2 / 3.0);
    all_close(pair.ratio(), [4.0 / 3.0, 1.0, 0.0], 2.5 / 2.2);
    assert_eq!(pair.difference().pixels, [Rgb::new(-1.0, 0.0, -0.1), Rgb::new(2.0, 0.0, -0.3)]);
    let map = pair.relative_error();
    close(map.values[0].into(), ((1.0 / 4.01 + 0.5) / 3.0f64).sqrt(), 1e-6);
    close(map.values[1].into(), ((4.0 / 1.01 + 0.9) / 3.0f64).sqrt(), 1e-6);
}

#[test]
fn equal_images_do_not_differ() {
    let image = drawn(9, 7, |x, y| Rgb::new(x as f32, y as f32, 0.1 * x as f32));
    let pair = Pair::new(&image, &image).unwrap();
    assert_eq!(
        (pair.rmse().all, pair.rel_mse().all, pair.ratio().all, pair.flip().mean),
        (0.0, 0.0, 1.0, 0.0)
    );
}

#[test]
fn pixels_that_are_not_finite_are_counted_and_left_out() {
    let (nan, infinite) = (Rgb::new(f32::NAN, 9.0, 9.0), Rgb::new(9.0, 9.0, f32::NEG_INFINITY));
    let a = row(&[Rgb::splat(0.5), nan, nan, Rgb::splat(0.25)]);
    let b = row(&[Rgb::splat(0.25), infinite, Rgb::splat(0.7), Rgb::splat(0.25)]);
    let pair = Pair::new(&a, &b).unwrap();
    assert_eq!(pair.non_finite(), NonFinite { a: 2, b: 1, either: 2 });
    all_close(pair.rmse(), [0.031_25f64.sqrt(); 3], 0.031_25f64.sqrt());
    all_close(pair.mean_b(), [0.25; 3], 0.25);
    let (error, flip) = (pair.relative_error().values, pair.flip());
    let left_out = |values: &[f32]| values.iter().map(|v| v.is_nan()).collect::<Vec<_>>();
    assert_eq!(left_out(&error), [false, true, true, false]);
    assert_eq!(left_out(&flip.map.values), [false, true, true, false]);
    assert!(flip.mean > 0.0 && flip.mean < 1.0, "{}", flip.mean);
}

#[test]
fn a_pixel_that_is_left_out_does_not_disturb_its_neighbours() {
    let b = drawn(30, 20, |x, y| Rgb::new(x as f32 / 30.0, y as f32 / 20.0, 0.5));
    let mut a = b.clone();
    a.pixels[10 * 30 + 15] = Rgb::splat(f32::NAN);
    assert_eq!(Pair::new(&a, &b).unwrap().flip().mean, 0.0);
    assert_eq!(Pair::new(&b, &a).unwrap().flip().mean, 0.0);
}

#[test]
fn images_that_cannot_be_compared_are_refused() {
    let (a, b) = (Image::black(4, 3), Image::black(3, 4));
    let error = Pair::new(&a, &b).unwrap_err();
    assert_eq!(error, CompareError::Sizes { a: (4, 3), b: (3, 4) });
    assert_eq!(error.to_string(), "A is 4 × 3 pixels, B is 3 × 4: only images of one size can be compared");
    let nothing = constant(2, 2, Rgb::splat(f32::NAN));
    assert_eq!(Pair::new(&nothing, &nothing).unwrap_err(), CompareError::NothingFinite { pixels: 4 });
    let empty = Image::black(0, 0);
    assert_eq!(Pair::new(&empty, &empty).unwrap_err(), CompareError::NothingFinite { pixels: 0 });
}

/// Constant pictures have no features, so FLIP is the colour difference alone: HyAB^0.7, of which 0.4 of the largest
/// stands at 0.95.
#[test]
fn flip_of_constant_pictures_is_their_colour_difference() {
    let flip = |a: Rgb, b: Rgb| {
        let (a, b) = (constant(5, 3, a), constant(5, 3, b));
        Pair::new(&a, &b).unwrap().flip().mean
    };
    // L*a*b* of green is (87.735, −86.183, 83.179), of blue (32.297, 79.188, −107.860); chroma times 0.01 L*.
    close(flip(Rgb::new(0.0, 1.0, 0.0), Rgb::new(0.0, 0.0, 1.0)), 1.0, 1e-5);
    let chroma = f64::hypot(0.877_35 * -86.183 - 0.322_97 * 79.188, 0.877_35 * 83.179 - 0.322_97 * -107.860);
    let largest = (87.735 - 32.297 + chroma).powf(0.7);
    // White from black: L* from 0 to 100, above the knee.
    let white = 100f64.powf(0.7);
    let expected = 0.95 + 0.05 * (white - 0.4 * largest) / (0.6 * largest);
    close(flip(Rgb::BLACK, Rgb::WHITE), expected, 1e-4);
    // Greys of L* = 50 (Y = ((50 + 16)/116)³) and 60: HyAB is 10, below the knee.
    let grey = |lightness: f32| Rgb::splat(((lightness + 16.0) / 116.0).powi(3));
    close(flip(grey(50.0), grey(60.0)), 0.95 * 10f64.powf(0.7) / (0.4 * largest), 1e-4);
    // Beyond white there is nothing to see.
    close(flip(Rgb::splat(3.0), Rgb::WHITE), 0.0, 0.0);
}

/// Expected values: NVIDIA's flip-evaluator 1.7 on the same arrays, its LDR-FLIP with default settings.
#[test]
fn flip_agrees_with_the_reference_implementation() {
    let stripes =
        drawn(48, 32, |x, y| Rgb::from_array([0, 5, 10].map(|c| ((7 * x + 13 * y + c) % 32) as f32 / 31.0)));
    let with_disc = drawn(48, 32, |x, y| {
        let inside = (f64::from(x) - 20.0).powi(2) + (f64::from(y) - 15.0).powi(2) < 64.0;
        let color = stripes.pixels[(48 * y + x) as usize];
        if inside { color * 0.5 + Rgb::new(0.25, 0.0, 0.0) } else { color }
    });
    let flip = Pair::new(&with_disc, &stripes).unwrap().flip();
    close(flip.mean, 0.105_621, 2e-5);
    let at = |x: usize, y: usize| f64::from(flip.map.values[48 * y + x]);
    for (found, expected) in [(at(20, 15), 0.561_666), (at(12, 15), 0.317_245), (at(24, 8), 0.399_363)] {
        close(found, expected, 1e-4);
    }
    assert_eq!(at(0, 0), 0.0);

    let ramp = drawn(48, 32, |x, _| Rgb::new(1.0, 0.5, 0.25) * (x as f32 / 47.0));
    let brighter_below =
        drawn(48, 32, |x, y| ramp.pixels[(48 * y + x) as usize] * if y < 16 { 1.0 } else { 1.25 });
    let flip = Pair::new(&brighter_below, &ramp).unwrap().flip();
    close(flip.mean, 0.160_844, 2e-5);
    close(flip.map.values[48 * 15 + 20].into(), 0.178_194, 1e-4);
    close(flip.map.values[48 * 31 + 47].into(), 0.344_973, 1e-4);
}

#[test]
fn flip_does_not_care_which_image_comes_first() {
    let a = drawn(20, 10, |x, y| Rgb::new(x as f32 / 20.0, 0.3, y as f32 / 10.0));
    let b = drawn(20, 10, |x, y| Rgb::new(0.5, (x * y % 7) as f32 / 7.0, 0.2));
    let (forth, back) = (Pair::new(&a, &b).unwrap().flip(), Pair::new(&b, &a).unwrap().flip());
    assert_eq!(forth, back);
    assert!(forth.map.values.iter().all(|v| (0.0..=1.0).contains(v)));
}

#[test]
fn viridis_has_its_known_colours_and_its_lightness_rises() {
    // Of the table of 256: first, middle and last.
    for (t, expected) in
        [(0.0, [0.267, 0.005, 0.329]), (0.5, [0.128, 0.567, 0.551]), (1.0, [0.993, 0.906, 0.144])]
    {
        for (found, expected) in viridis(t).into_iter().zip(expected) {
            close(found.into(), expected, 0.013);
        }
    }
    let luminance = |step: u8| {
        let color = viridis(f32::from(step) / 100.0).map(tone_map::srgb_decode);
        Rgb::from_array(color).luminance()
    };
    assert!((1..=100).all(|step| luminance(step) > luminance(step - 1)));
}

#[test]
fn a_heat_map_is_shown_as_it_is_and_left_out_pixels_are_magenta() {
    let plane = Plane { width: 5, height: 1, values: vec![0.0, 1.0, 2.0, 7.0, f32::NAN] };
    let shown: Vec<[u8; 3]> =
        heat(&plane, 2.0).pixels.iter().map(|&c| tone_map::display(c, ToneMap::Linear, 0.0)).collect();
    let direct = |t: f32| viridis(t).map(tone_map::quantise);
    assert_eq!(shown, [direct(0.0), direct(0.5), direct(1.0), direct(1.0), tone_map::NOT_FINITE]);
}

#[test]
fn a_scale_ends_at_a_round_number_above_all_but_a_hundredth() {
    let top = |values: Vec<f32>| scale_top(&Plane { width: values.len() as u32, height: 1, values });
    assert_eq!((top(vec![0.0; 9]), top(vec![f32::NAN]), top(Vec::new())), (1.0, 1.0, 1.0));
    assert_eq!((top(vec![0.3]), top(vec![1.0]), top(vec![0.011]), top(vec![70.0])), (0.5, 1.0, 0.02, 100.0));
    let mut with_fireflies: Vec<f32> = vec![0.15; 1000];
    with_fireflies[3..8].fill(900.0);
    with_fireflies[9] = f32::NAN;
    assert_eq!(top(with_fireflies), 0.2);
    // One wrong pixel among equal ones still has a scale.
    let mut one = vec![0.0; 1000];
    one[0] = 0.04;
    assert_eq!(top(one), 0.05);
}
