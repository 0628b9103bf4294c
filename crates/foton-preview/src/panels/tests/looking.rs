//! Looking closer: exposure, histogram, clipping, numbers in pixels, regions.

use egui::{Key, Modifiers, MouseWheelUnit, PointerButton, TouchPhase, pos2, vec2};
use foton_session::engine::Region;

use super::*;
use crate::state::Placement;

fn turn_wheel(harness: &mut Harness<'_, State>, at: egui::Pos2, by: f32) {
    harness.hover_at(at);
    settle(harness);
    harness.event(egui::Event::MouseWheel {
        unit: MouseWheelUnit::Point,
        delta: vec2(0.0, by),
        modifiers: Modifiers::NONE,
        phase: TouchPhase::Move,
        source: egui::MouseWheelSource::Wheel,
    });
    harness.run_steps(30);
}

#[test]
fn the_wheel_over_the_exposure_changes_it_and_nothing_else() {
    let mut harness = window(|_| ());
    let at = find(&harness, Role::Slider, "Exposure").rect().center();
    turn_wheel(&mut harness, at, 200.0);
    let brighter = harness.state().exposure_stops;
    assert!(brighter > 0.5 && brighter < 1.5, "{brighter}");
    turn_wheel(&mut harness, at, -400.0);
    assert!(harness.state().exposure_stops < -0.5);
    let asked = asked(&mut harness);
    assert!(asked.iter().all(|a| a.starts_with("SetLook")), "{asked:?}");
}

#[test]
fn the_histogram_says_what_is_above_white_and_is_dragged_to_expose() {
    let mut harness = window(|_| ());
    harness.key_press(Key::L);
    settle(&mut harness);
    assert!(harness.query_by_label_contains("0.0 % above white").is_some());
    let rect = find(&harness, Role::Image, "Histogram").rect();
    harness.drag_at(rect.center());
    settle(&mut harness);
    harness.hover_at(rect.center() + vec2(40.0, 0.0));
    settle(&mut harness);
    harness.drop_at(rect.center() + vec2(40.0, 0.0));
    settle(&mut harness);
    // 32 stops across 256 points.
    assert!((harness.state().exposure_stops - 5.0).abs() < 0.21, "{}", harness.state().exposure_stops);
    assert!(harness.query_by_label_contains("100.0 % above white").is_some());
    assert!(asked(&mut harness).iter().all(|a| a.starts_with("SetLook")), "the picture below is not turned");
}

fn canvas(harness: &Harness<'_, State>) -> egui::Rect {
    harness.state().places.iter().find(|(name, _)| *name == "canvas").expect("a canvas").1
}

#[test]
fn a_region_is_dragged_out_and_given_back() {
    let mut harness = window(|_| ());
    let region_entry = |harness: &mut Harness<'_, State>, name: &str| {
        // A screen reader's click leaves the menu open.
        if harness.query_by_role_and_label(Role::Button, name).is_none() {
            click(harness, Role::Button, "View");
        }
        click(harness, Role::Button, name);
        harness.key_press(Key::Escape);
        settle(harness);
    };
    region_entry(&mut harness, "Render a region…");
    let canvas = canvas(&harness);
    let scale = (canvas.width() / SIZE[0] as f32).min(canvas.height() / SIZE[1] as f32);
    let at =
        |x: f32, y: f32| canvas.center() + scale * (vec2(x, y) - vec2(SIZE[0] as f32, SIZE[1] as f32) * 0.5);
    let drag = |harness: &mut Harness<'_, State>, from: egui::Pos2, to: egui::Pos2| {
        harness.hover_at(from);
        settle(harness);
        harness.event(egui::Event::PointerButton {
            pos: from,
            button: PointerButton::Primary,
            pressed: true,
            modifiers: Modifiers::NONE,
        });
        settle(harness);
        harness.hover_at(to);
        settle(harness);
        harness.drop_at(to);
        settle(harness);
    };
    drag(&mut harness, at(40.5, 30.5), at(10.5, 12.5));
    let region = Region { x: 10, y: 12, width: 31, height: 19 };
    let configure = |region| {
        format!("{:?}", Command::Configure(Configuration::of(&RenderSettings::default(), None, region)))
    };
    let commands = asked(&mut harness);
    assert!(commands.contains(&configure(Some(region))), "{commands:?}");
    let else_ =
        commands.iter().any(|c| c.starts_with("Camera") || c.starts_with("Choose") || c.starts_with("Edit"));
    assert!(!else_, "the scene is left alone: {commands:?}");
    // Once the engine renders it, the way back is there.
    harness.state_mut().frame.as_mut().expect("there").region = Some(region);
    settle(&mut harness);
    region_entry(&mut harness, "Render the whole image");
    assert!(asked(&mut harness).contains(&configure(None)));
    // Escape gives it up, and a slip of the hand is none.
    harness.state_mut().frame.as_mut().expect("there").region = None;
    settle(&mut harness);
    region_entry(&mut harness, "Render a region…");
    harness.key_press(Key::Escape);
    settle(&mut harness);
    assert!(harness.state().looking.choosing_region.is_none());
    region_entry(&mut harness, "Render a region…");
    drag(&mut harness, at(20.2, 20.2), at(21.5, 20.4));
    let commands = asked(&mut harness);
    assert!(commands.iter().all(|c| !c.starts_with("Configure")), "{commands:?}");
}

#[test]
fn a_region_other_settings_keep() {
    let region = Region { x: 10, y: 12, width: 31, height: 19 };
    let mut harness = window(|state| state.frame.as_mut().expect("there").region = Some(region));
    type_number(&mut harness, "Seed", "9");
    click(&mut harness, Role::Button, "Apply and restart");
    let now = Configuration { seed: 9, ..Configuration::of(&RenderSettings::default(), None, Some(region)) };
    assert!(asked(&mut harness).contains(&format!("{:?}", Command::Configure(now))));
}

#[test]
fn pixels_show_their_numbers_once_there_is_room() {
    let colours = |zoom: f32| {
        let (at, canvas) = picture::drawn(|state| {
            state.placement = Placement { zoom: Some(zoom), centre: [0.5, 0.5] };
        });
        let inside = canvas.shrink(60.0);
        let of_row = |y: f32| (inside.left() as u32..inside.right() as u32).map(move |x| pos2(x as f32, y));
        let rows = (inside.top() as u32..inside.bottom() as u32).flat_map(|y| of_row(y as f32));
        rows.map(&at).collect::<std::collections::BTreeSet<[u8; 3]>>().len()
    };
    assert_eq!(colours(20.0), 1, "one colour of all pixels");
    assert!(colours(30.0) > 3 && colours(60.0) > 3, "and ink");
}

#[test]
fn clipped_pixels_are_marked_in_the_picture() {
    let (at, canvas) = picture::drawn(|state| {
        state.exposure_stops = 12.0;
        state.tone_map = ToneMap::Linear;
        state.looking.marks_clipping = true;
    });
    let row: Vec<_> = (0..16).map(|x| at(canvas.center() + vec2(x as f32, 0.0))).collect();
    assert!(row.contains(&[255, 0, 0]) && row.contains(&[255, 255, 255]), "{row:?}");
}

#[test]
fn the_picture_of_a_region_lies_where_the_region_is() {
    let window = Region { x: 30, y: 0, width: 30, height: 40 };
    let (at, canvas) = picture::drawn(|state| {
        let frame = state.frame.as_mut().expect("there");
        let mut image = Image::black(30, 40);
        image.pixels.fill(Rgb::splat(0.5));
        frame.picture = Some(Picture::Colour(Arc::new(image)));
        (frame.window, frame.region) = (window, Some(window));
    });
    let shown = foton_film::tone_map::display(Rgb::splat(0.5), ToneMap::default(), 0.0);
    assert_eq!(at(canvas.center() + vec2(40.0, 0.0)), shown, "the right half");
    assert_ne!(at(canvas.center() - vec2(40.0, 0.0)), shown, "not the left one");
}

#[test]
fn the_dots_of_photons_have_a_legend() {
    let white = |show: bool| {
        let (at, canvas) = picture::drawn(|state| state.show_photons = show);
        let corner = canvas.left_bottom() + vec2(10.0, -100.0);
        let area = (0..200).flat_map(|x| (0..70).map(move |y| corner + vec2(x as f32, y as f32)));
        area.map(&at).filter(|c| *c == [255, 215, 70]).count()
    };
    assert!(white(true) > 20 && white(false) == 0);
}

#[test]
fn the_first_times_a_line_says_what_to_do_and_fades() {
    let mut harness = window(|state| state.preferences.starts = 1);
    let since = harness.state().looking.hinted.expect("it was drawn");
    let drawn = |starts, later: f64| {
        let (at, canvas) = picture::drawn(|state| {
            state.preferences.starts = starts;
            state.looking.hinted = Some(-later);
        });
        let row = canvas.bottom() - 44.0;
        (0..300)
            .map(|x| at(pos2(canvas.center().x - 150.0 + x as f32, row)))
            .collect::<std::collections::BTreeSet<_>>()
            .len()
    };
    assert!(drawn(1, 0.0) > 4, "words");
    assert_eq!(drawn(1, 30.0), 1, "they are gone after a while");
    assert_eq!(drawn(99, 0.0), 1, "and are not for those who know");
    settle(&mut harness);
    assert_eq!(harness.state().looking.hinted, Some(since));
}
