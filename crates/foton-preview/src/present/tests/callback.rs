//! The callback inside a real frame of egui.

use egui_kittest::Harness;
use egui_kittest::wgpu::{WgpuTestRenderer, create_render_state, default_wgpu_setup};

use super::*;

#[test]
fn a_frame_of_egui_shows_the_picture_where_the_panel_put_it() {
    let state = create_render_state(default_wgpu_setup(), egui_wgpu::RendererOptions::PREDICTABLE);
    let presenter = Presenter::new(&state.device, &state.queue, state.target_format);
    state.renderer.write().callback_resources.insert(presenter);
    let picture = rgb(2, vec![Rgb::new(1.0, 0.0, 0.0), Rgb::new(0.0, 1.0, 0.0)]);
    let pinned = rgb(1, vec![Rgb::new(0.0, 0.0, 1.0)]);
    let mut harness = Harness::builder()
        .with_size(egui::vec2(60.0, 40.0))
        .with_pixels_per_point(2.0)
        .renderer(WgpuTestRenderer::from_render_state(state))
        .build_ui(|ui| {
            // The view lies 10 to 50 points across, the image 20 to 100 pixels: twice two points to the pixel.
            let area = rect(10.0, 10.0, 40.0, 20.0);
            let view = View { image_rect: rect(20.0, 20.0, 80.0, 40.0), wipe: Some(0.75), ..plain(2, 1) };
            let pinned = Some(pinned.clone());
            let callback = PresentCallback { view, picture: picture.clone(), pinned, rect: area };
            ui.painter_at(area).add(egui_wgpu::Callback::new_paint_callback(area, callback));
        });
    harness.run_steps(2);
    let frame = harness.render().expect("a frame");
    let at = |x, y| {
        let [r, g, b, _] = frame.get_pixel(x, y).0;
        [r, g, b]
    };
    assert_eq!((frame.width(), frame.height()), (120, 80));
    assert_eq!([at(21, 21), at(58, 58)], [[255, 0, 0]; 2]);
    assert_eq!([at(61, 21), at(77, 58)], [[0, 255, 0]; 2]);
    assert_eq!([at(80, 40), at(83, 21), at(98, 58)], [[255; 3], [0, 0, 255], [0, 0, 255]]);
    // Outside of the callback's rectangle is egui's own ground.
    assert!(at(17, 40) == at(110, 70) && at(17, 40) != [255, 0, 0]);
}
