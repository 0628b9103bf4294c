//! The window drawn by an adapter, its presenter beside egui's renderer: pixels, not promises.

use egui_kittest::wgpu::{WgpuTestRenderer, create_render_state, default_wgpu_setup};
use foton_film::{Plane, tone_map};

use super::*;
use crate::present::{Presenter, colour_map};

/// The window's pixels, and where its canvas is.
pub(super) fn drawn(change: impl FnOnce(&mut State)) -> (impl Fn(egui::Pos2) -> [u8; 3], egui::Rect) {
    let gpu = create_render_state(default_wgpu_setup(), egui_wgpu::RendererOptions::PREDICTABLE);
    let presenter = Presenter::new(&gpu.device, &gpu.queue, gpu.target_format);
    gpu.renderer.write().callback_resources.insert(presenter);
    let mut state = State::new(Preferences::default(), Vec::new());
    state.frame = Some(frame());
    change(&mut state);
    let mut harness = Harness::builder()
        .with_size(egui::vec2(1000.0, 600.0))
        .renderer(WgpuTestRenderer::from_render_state(gpu))
        .build_ui_state(crate::panels::show, state);
    harness.run_steps(4);
    let canvas = harness.state().places.iter().find(|(name, _)| *name == "canvas").expect("a canvas").1;
    let pixels = harness.render().expect("a picture");
    let at = move |p: egui::Pos2| {
        let [r, g, b, _] = pixels.get_pixel(p.x as u32, p.y as u32).0;
        [r, g, b]
    };
    (at, canvas)
}

#[test]
fn the_picture_is_shown_through_the_tone_map_between_the_panels() {
    let (at, canvas) = drawn(|state| state.exposure_stops = 1.0);
    let colour = Rgb::new(0.5, 0.25, 0.125);
    assert_eq!(at(canvas.center()), tone_map::display(colour, ToneMap::default(), 1.0));
    // Left of it are the panels' own grounds and words.
    let panel: std::collections::BTreeSet<[u8; 3]> =
        (20..250).flat_map(|x| (40..560).map(move |y| egui::pos2(x as f32, y as f32))).map(&at).collect();
    assert!(panel.len() > 20, "{} colours", panel.len());
}

#[test]
fn measures_are_shown_in_false_colours_with_a_legend() {
    let (at, canvas) = drawn(|state| {
        let values =
            (0..SIZE[0] * SIZE[1]).map(|i| if i % SIZE[0] < SIZE[0] / 2 { 1.0 } else { 8.0 }).collect();
        let plane = Arc::new(Plane { width: SIZE[0], height: SIZE[1], values });
        state.frame.as_mut().expect("there").picture = Some(Picture::Measure { label: "radius", plane });
    });
    let near = |a: [u8; 3], b: [u8; 3]| a.iter().zip(b).all(|(a, b)| a.abs_diff(b) <= 1);
    let left = at(canvas.center() - egui::vec2(40.0, 0.0));
    let right = at(canvas.center() + egui::vec2(40.0, 0.0));
    assert!(near(left, colour_map::at(1.0 / 8.0)) && near(right, colour_map::at(1.0)), "{left:?} {right:?}");
    // The legend runs through the colours from its bottom to its top.
    let x = canvas.right() - 85.0;
    let colours: std::collections::BTreeSet<[u8; 3]> =
        (0..canvas.height() as u32).map(|y| at(egui::pos2(x, canvas.top() + y as f32))).collect();
    assert!(colours.len() > 50, "{} colours", colours.len());
}

#[test]
fn the_outline_of_what_is_chosen_is_drawn_over_the_picture() {
    let (plain, canvas) = drawn(|_| ());
    let (chosen, same) = drawn(|state| state.frame.as_mut().expect("there").selection = Some(selection()));
    assert_eq!(same, canvas, "the picture stays where it is");
    let scale = (same.width() / SIZE[0] as f32).min(same.height() / SIZE[1] as f32);
    let edge = same.center() + egui::vec2(20.0 - 30.0, 20.0 - 20.0) * scale;
    let row = |at: &dyn Fn(egui::Pos2) -> [u8; 3]| {
        (-2..=2).map(|i| at(edge + egui::vec2(i as f32, 0.0))).collect::<Vec<_>>()
    };
    assert!(row(&chosen).iter().any(|c| c[0] > 200 && c[2] < 120), "{:?}", row(&chosen));
    assert!(row(&plain).iter().all(|c| *c == row(&plain)[0]));
}
