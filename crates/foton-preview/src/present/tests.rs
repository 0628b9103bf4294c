//! The shader against the tone maps of `foton-film` and against pixels worked out here, drawn off screen by whatever adapter
//! there is. Without one the tests fail: nobody would notice a shader that is never run.

mod callback;
mod device;
mod pixels;
mod shaders;

use foton_film::{Image, Plane, ToneMap, tone_map};
use foton_math::Rgb;

use super::*;
use device::Screen;

/// Radiance at scale 1 in the top left corner.
fn plain(width: u32, height: u32) -> View {
    View {
        exposure_stops: 0.0,
        tone_map: ToneMap::Linear,
        mode: Mode::Radiance,
        marks_clipping: false,
        image_rect: rect(0.0, 0.0, width as f32, height as f32),
        wipe: None,
        background: egui::Color32::from_rgb(10, 20, 30),
    }
}

fn rect(x: f32, y: f32, width: f32, height: f32) -> egui::Rect {
    egui::Rect::from_min_size(egui::pos2(x, y), egui::vec2(width, height))
}

fn rgb(width: u32, pixels: Vec<Rgb>) -> Picture {
    Picture::Rgb(Arc::new(Image { width, height: pixels.len() as u32 / width, pixels }))
}

fn scalar(width: u32, values: Vec<f32>) -> Picture {
    Picture::Scalar(Arc::new(Plane { width, height: values.len() as u32 / width, values }))
}

/// A colour that no neighbour shares.
fn unlike_neighbours(i: usize) -> Rgb {
    Rgb::new((i % 7) as f32 / 7.0, (i % 5) as f32 / 5.0, (i % 11) as f32 / 11.0)
}

/// Numbers in [0, 1) that look random, the same in every run.
fn noise() -> impl Iterator<Item = f32> {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    std::iter::from_fn(move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        Some((state >> 40) as f32 / (1u64 << 24) as f32)
    })
}

/// Fails if a channel differs by more than one step.
#[track_caller]
fn assert_shows(found: [u8; 3], expected: [u8; 3], what: impl std::fmt::Debug) {
    let near = found.iter().zip(expected).all(|(a, b)| a.abs_diff(b) <= 1);
    assert!(near, "{found:?} is not {expected:?}: {what:?}");
}

#[test]
fn at_scale_one_every_pixel_is_what_the_png_writer_makes() {
    const SIDE: u32 = 64;
    let mut noise = noise();
    let mut next = || noise.next().expect("it has no end");
    // Most between 1e-5 and 1e5, some negative, some that no map may stumble over.
    let mut channel = || {
        let v = 10f32.powf(10.0 * next() - 5.0);
        let odd = [-1.0, f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, f32::MIN, 1e-40, 0.0];
        let kind = (next() * 200.0) as usize;
        odd.get(kind).copied().unwrap_or(if kind < 16 { -v } else { v })
    };
    let pixels: Vec<Rgb> = (0..SIDE * SIDE).map(|_| Rgb::new(channel(), channel(), channel())).collect();
    assert!(pixels.iter().filter(|c| !c.is_finite()).count() > 20);
    let picture = rgb(SIDE, pixels.clone());
    let mut screen = Screen::new([SIDE, SIDE]);
    for tone_map in ToneMap::ALL {
        for exposure_stops in [-13.0, -3.3, 0.0, 1.7, 12.0] {
            let drawn = screen.draw(&View { exposure_stops, tone_map, ..plain(SIDE, SIDE) }, &picture, None);
            for (&c, found) in pixels.iter().zip(drawn) {
                assert_shows(
                    found,
                    tone_map::display(c, tone_map, exposure_stops),
                    (c, tone_map, exposure_stops),
                );
            }
        }
    }
}

#[test]
fn dark_and_middle_tones_agree_in_every_step() {
    // Where a step of a byte is small in light: 4096 greys and saturated colours from black to white.
    const SIDE: u32 = 64;
    let light = |i: u32| (i as f32 / 4095.0).powi(2) * 1.2;
    let grey = (0..SIDE * SIDE).map(|i| Rgb::splat(light(i))).collect::<Vec<_>>();
    let green = (0..SIDE * SIDE).map(|i| Rgb::new(0.1 * light(i), light(i), 0.02)).collect::<Vec<_>>();
    let mut screen = Screen::new([SIDE, SIDE]);
    for pixels in [grey, green] {
        let picture = rgb(SIDE, pixels.clone());
        for tone_map in ToneMap::ALL {
            let drawn = screen.draw(&View { tone_map, ..plain(SIDE, SIDE) }, &picture, None);
            for (&c, found) in pixels.iter().zip(drawn) {
                assert_shows(found, tone_map::display(c, tone_map, 0.0), (c, tone_map));
            }
        }
    }
}

#[test]
fn left_of_the_wipe_is_the_picture_and_right_of_it_the_pinned_one() {
    let red = rgb(4, vec![Rgb::new(1.0, 0.0, 0.0); 8]);
    let green = rgb(2, vec![Rgb::new(0.0, 1.0, 0.0); 2]);
    let mut screen = Screen::new([40, 10]);
    let view = View { wipe: Some(0.5), image_rect: rect(0.0, 0.0, 40.0, 8.0), ..plain(4, 2) };
    let drawn = screen.draw(&view, &red, Some(&green));
    for (i, found) in drawn.iter().enumerate() {
        let (x, y) = (i % 40, i / 40);
        let around = if y < 8 { None } else { Some([10, 20, 30]) };
        match x {
            0..18 => assert_eq!(*found, around.unwrap_or([255, 0, 0]), "at {x}, {y}"),
            18 | 21 => assert_eq!(*found, [0, 0, 0], "at {x}, {y}"),
            19 | 20 => assert_eq!(*found, [255, 255, 255], "at {x}, {y}"),
            _ => assert_eq!(*found, around.unwrap_or([0, 255, 0]), "at {x}, {y}"),
        }
    }
    // Without one of the two there is no line.
    let all_red = |drawn: Vec<[u8; 3]>| drawn[..320].iter().all(|found| *found == [255, 0, 0]);
    assert!(all_red(screen.draw(&view, &red, None)));
    assert!(all_red(screen.draw(&View { wipe: None, ..view }, &red, Some(&green))));
}

#[test]
fn a_measure_runs_over_the_colour_map_and_stops_at_its_ends() {
    let [low, high] = [colour_map::at(0.0), colour_map::at(1.0)];
    let values = vec![2.0, 8.0, 4.0, 5.0, 1.0, 1e30, -5.0, f32::NAN];
    let mut screen = Screen::new([8, 1]);
    let mut draw = |logarithmic, values: Vec<f32>| {
        let mode = Mode::FalseColour { low: 2.0, high: 8.0, logarithmic };
        // Exposure is not for measures.
        screen.draw(&View { mode, exposure_stops: 3.0, ..plain(8, 1) }, &scalar(8, values), None)
    };
    let missing = tone_map::NOT_FINITE;
    let third = colour_map::at(1.0 / 3.0);
    let half = colour_map::at(0.5);
    assert_eq!(draw(false, values.clone()), [low, high, third, half, low, high, low, missing]);
    let five = colour_map::at(2.5f32.log(4.0));
    assert_eq!(draw(true, values), [low, high, half, five, low, high, low, missing]);
    // A range that is none is a step.
    let mode = Mode::FalseColour { low: 3.0, high: 3.0, logarithmic: false };
    let drawn = screen.draw(&View { mode, ..plain(2, 1) }, &scalar(2, vec![2.9, 3.1]), None);
    assert_eq!(drawn[..2], [low, high]);
}

#[test]
fn false_colour_of_light_is_that_of_its_luminance() {
    let c = Rgb::new(0.9, 0.3, 0.6);
    let mut screen = Screen::new([2, 2]);
    let mode = Mode::FalseColour { low: 0.0, high: 1.0, logarithmic: false };
    let drawn = screen.draw(&View { mode, ..plain(2, 2) }, &rgb(2, vec![c; 4]), None);
    assert_eq!(drawn, [colour_map::at(c.luminance()); 4]);
}

/// What is marked is what the PNG writer writes as 255 in a channel, or as black.
#[test]
fn clipping_is_marked_where_bytes_are_at_their_ends() {
    let light = [0.0, 1e-5, 1e-3, 0.2, 0.9, 0.999, 1.0, 8.0];
    let pixels: Vec<Rgb> = light.iter().map(|&v| Rgb::new(v, 0.5 * v, 0.25 * v)).collect();
    let picture = rgb(8, pixels.clone());
    let mut screen = Screen::new([64, 8]);
    for exposure_stops in [-2.0, 0.0, 3.0] {
        let image_rect = rect(0.0, 0.0, 64.0, 8.0);
        let view = View { marks_clipping: true, exposure_stops, image_rect, ..plain(8, 1) };
        let drawn = screen.draw(&view, &picture, None);
        for (i, &c) in pixels.iter().enumerate() {
            let of_pixel: Vec<[u8; 3]> = (0..64).map(|p| drawn[(p / 8) * 64 + 8 * i + p % 8]).collect();
            let shown = tone_map::display(c, ToneMap::Linear, exposure_stops);
            let has = |colour: [u8; 3]| of_pixel.iter().filter(|found| **found == colour).count();
            let (black, red) = (has([0, 51, 204]), has([255, 0, 0]));
            assert_eq!(black == 64, shown == [0; 3], "{c:?} at {exposure_stops}: {shown:?}");
            let stripes = if shown.contains(&255) { 32 } else { 0 };
            assert_eq!(red, stripes, "{c:?} at {exposure_stops}: {shown:?}");
        }
    }
    // Measures have no ends.
    let mode = Mode::FalseColour { low: 0.0, high: 1.0, logarithmic: false };
    let drawn = screen.draw(&View { mode, marks_clipping: true, ..plain(8, 1) }, &picture, None);
    assert_eq!(drawn[7], colour_map::at(1.0));
}
