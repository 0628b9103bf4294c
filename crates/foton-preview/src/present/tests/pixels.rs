//! Zoom, pan and pictures of many sizes: which pixels of a picture a pixel of the screen shows.

use super::*;

/// The encoded colour of the mean of a picture's pixels over a box, exact to rounding.
fn mean_over(pixels: &[Rgb], width: usize, [left, top, right, bottom]: [f32; 4]) -> [u8; 3] {
    let share = |i: usize, low: f32, high: f32| (high.min(i as f32 + 1.0) - low.max(i as f32)).max(0.0);
    let mut sum = Rgb::BLACK;
    for (i, &c) in pixels.iter().enumerate() {
        sum += c * (share(i % width, left, right) * share(i / width, top, bottom));
    }
    tone_map::display(sum * (1.0 / ((right - left) * (bottom - top))), ToneMap::Linear, 0.0)
}

#[test]
fn magnified_pixels_are_squares_of_their_own_colour() {
    let pixels: Vec<Rgb> = (0..48).map(unlike_neighbours).collect();
    let picture = rgb(8, pixels.clone());
    let mut screen = Screen::new([64, 48]);
    for (zoom, left, top) in [(7.0, 3.0, 2.0), (5.0, -11.0, -4.0), (6.3, 1.25, 0.5), (31.0, -100.0, -60.0)] {
        let image_rect = rect(left, top, 8.0 * zoom, 6.0 * zoom);
        let drawn = screen.draw(&View { image_rect, ..plain(8, 6) }, &picture, None);
        for (i, found) in drawn.into_iter().enumerate() {
            let texel = |at: usize, first: f32| ((at as f32 + 0.5 - first) / zoom).floor();
            let (x, y) = (texel(i % 64, left), texel(i / 64, top));
            let inside = (0.0..8.0).contains(&x) && (0.0..6.0).contains(&y);
            let expected = if inside {
                tone_map::display(pixels[y as usize * 8 + x as usize], ToneMap::Linear, 0.0)
            } else {
                [10, 20, 30]
            };
            assert_shows(found, expected, (zoom, i % 64, i / 64));
        }
    }
}

#[test]
fn minified_pixels_are_means_over_boxes() {
    let pixels: Vec<Rgb> = (0..600).map(unlike_neighbours).collect();
    let picture = rgb(30, pixels.clone());
    let mut screen = Screen::new([12, 8]);
    // Boxes of 3 by 4 pixels, then of 2.5 by 2.5.
    for (across, down) in [(3.0, 4.0), (2.5, 2.5)] {
        let view = View { image_rect: rect(0.0, 0.0, 30.0 / across, 20.0 / down), ..plain(30, 20) };
        let drawn = screen.draw(&view, &picture, None);
        for (i, found) in drawn.into_iter().enumerate() {
            let (x, y) = ((i % 12) as f32, (i / 12) as f32);
            if (x + 1.0) * across <= 30.0 && (y + 1.0) * down <= 20.0 {
                let area = [x * across, y * down, (x + 1.0) * across, (y + 1.0) * down];
                assert_shows(found, mean_over(&pixels, 30, area), (across, x, y));
            }
        }
    }
}

#[test]
fn each_side_of_the_wipe_shrinks_by_its_own_size() {
    let stripes = |width: usize| {
        let pixels = (0..width * 4).map(|i| Rgb::splat((i % 2) as f32)).collect();
        rgb(width as u32, pixels)
    };
    let (fits, large) = (stripes(40), stripes(80));
    let mut screen = Screen::new([40, 4]);
    let view = View { wipe: Some(0.5), ..plain(40, 4) };
    let grey = tone_map::display(Rgb::splat(0.5), ToneMap::Linear, 0.0);
    for is_first_large in [false, true] {
        let [first, second] = if is_first_large { [&large, &fits] } else { [&fits, &large] };
        let drawn = screen.draw(&view, first, Some(second));
        for x in (0..18).chain(22..40) {
            let striped = [255 * (x % 2) as u8; 3];
            let expected = if (x < 20) == is_first_large { grey } else { striped };
            assert_shows(drawn[x], expected, (is_first_large, x));
        }
    }
}

#[test]
fn a_box_with_a_pixel_that_is_not_finite_is_magenta_and_a_bright_one_stays_finite() {
    let mut pixels = vec![Rgb::splat(0.25); 64];
    pixels[9] = Rgb::new(0.0, f32::NAN, 0.0);
    pixels[36] = Rgb::splat(f32::MAX);
    pixels[37] = Rgb::splat(f32::MAX);
    let mut screen = Screen::new([2, 2]);
    let view = View { image_rect: rect(0.0, 0.0, 2.0, 2.0), ..plain(8, 8) };
    let drawn = screen.draw(&view, &rgb(8, pixels), None);
    assert_eq!([drawn[0], drawn[3]], [tone_map::NOT_FINITE, [255; 3]]);
    assert_shows(drawn[1], tone_map::display(Rgb::splat(0.25), ToneMap::Linear, 0.0), "plain");
}

#[test]
fn a_tiny_picture_of_a_large_one_still_shows_its_mean() {
    // 200 pixels in one: more than the shader looks at along an axis.
    let pixels: Vec<Rgb> =
        (0..200 * 200).map(|i| Rgb::splat(if i / 200 < 100 { 0.2 } else { 0.6 })).collect();
    let mut screen = Screen::new([1, 1]);
    let view = View { image_rect: rect(0.0, 0.0, 1.0, 1.0), ..plain(1, 1) };
    let drawn = screen.draw(&view, &rgb(200, pixels), None);
    assert!(drawn[0][0].abs_diff(tone_map::display(Rgb::splat(0.4), ToneMap::Linear, 0.0)[0]) <= 4);
}

#[test]
fn pictures_of_other_sizes_and_kinds_replace_each_other() {
    let mut screen = Screen::new([16, 8]);
    for (width, count) in [(8, 64), (16, 64), (3, 6), (16, 64), (1, 1)] {
        let pixels: Vec<Rgb> = (0..count).map(|i| unlike_neighbours(i + width as usize)).collect();
        let drawn = screen.draw(&plain(width, count as u32 / width), &rgb(width, pixels.clone()), None);
        for (i, &c) in pixels.iter().enumerate() {
            let found = drawn[i / width as usize * 16 + i % width as usize];
            assert_shows(found, tone_map::display(c, ToneMap::Linear, 0.0), (width, i));
        }
        let grey = screen.draw(&plain(2, 1), &scalar(2, vec![0.0, 1.0]), None);
        assert_eq!(grey[..2], [[0; 3], [255; 3]]);
    }
    // Nothing to be drawn leaves what was shown.
    let nothing = Picture::Rgb(Arc::new(Image { width: 0, height: 0, pixels: Vec::new() }));
    assert_eq!(screen.draw(&plain(2, 1), &nothing, None)[..2], [[0; 3], [255; 3]]);
}

#[test]
fn a_picture_larger_than_textures_may_be_is_shown_reduced_and_in_place() {
    // Where a device takes 256 texels, as many as the colour map has, 600 pixels become 200: each texel is a mean of nine, and a
    // pixel of the screen is one texel.
    const LARGEST: u32 = 256;
    let pixels: Vec<Rgb> = (0..600 * 31).map(unlike_neighbours).collect();
    let picture = rgb(600, pixels.clone());
    let mut screen = Screen::with_largest_texture([200, 11], LARGEST);
    let view = View { image_rect: rect(0.0, 0.0, 200.0, 31.0 / 3.0), ..plain(1, 1) };
    let drawn = screen.draw(&view, &picture, None);
    assert_eq!(reduction(picture.size(), LARGEST), 3);
    for (i, found) in drawn.into_iter().take(2000).enumerate() {
        let (x, y) = (3.0 * (i % 200) as f32, 3.0 * (i / 200) as f32);
        assert_shows(found, mean_over(&pixels, 600, [x, y, x + 3.0, y + 3.0]), (x, y));
    }
    assert_eq!(reduction([256, 256], LARGEST), 1);
    assert_eq!(reduction([257, 1], LARGEST), 2);
}

/// Adapters in software hold megabytes of machine code for each.
#[test]
fn however_many_views_a_person_tries_few_pipelines_are_kept() {
    let pixels: Vec<Rgb> = (0..64).map(unlike_neighbours).collect();
    let picture = rgb(8, pixels.clone());
    let mut screen = Screen::new([8, 8]);
    for _ in 0..2 {
        for tone_map in ToneMap::ALL {
            for (side, pinned) in [(8.0, None), (4.0, None), (8.0, Some(&picture)), (4.0, Some(&picture))] {
                let wipe = pinned.map(|_| 0.5);
                let view = View { tone_map, wipe, image_rect: rect(0.0, 0.0, side, side), ..plain(8, 8) };
                let drawn = screen.draw(&view, &picture, pinned);
                // The wipe draws a line.
                if side == 8.0 && pinned.is_none() {
                    for (&c, found) in pixels.iter().zip(drawn) {
                        assert_shows(found, tone_map::display(c, tone_map, 0.0), (c, view));
                    }
                }
                assert!(screen.presenter.kept_pipelines() <= 4);
            }
        }
    }
}
