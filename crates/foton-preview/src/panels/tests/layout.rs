//! Nothing that is shown moves the picture, and nothing is cut off, in windows of any usual size.

use foton_session::ErrorEstimate;

use super::*;

/// A window of a size.
fn sized(size: egui::Vec2, scale: f32, change: impl FnOnce(&mut State)) -> Harness<'static, State> {
    let mut state = State::new(Preferences::default(), built_in());
    state.frame = Some(frame());
    change(&mut state);
    let builder = Harness::builder().with_size(size).with_pixels_per_point(scale).allow_missing_glyphs();
    let mut harness = builder.build_ui_state(crate::panels::show, state);
    crate::themes::dress(&harness.ctx);
    settle(&mut harness);
    harness
}

fn canvas(harness: &Harness<'_, State>) -> egui::Rect {
    harness.state().places.iter().find(|(name, _)| *name == "canvas").expect("a canvas").1
}

/// Everything that can be long or large.
pub(super) fn fill(state: &mut State) {
    let frame = state.frame.as_mut().expect("there");
    let mut scene = SceneFacts::clone(&frame.scene);
    scene.name = "a scene whose name is as long as names of files may be, and then some ".repeat(3) + ".xml";
    scene.sensors[0].name = "the camera above the door at the far end of the long corridor".repeat(2);
    scene.title = scene.name.clone();
    let long = |mut item: Item| {
        item.name = format!("{} with a name that no panel has room for", item.name).repeat(2);
        item
    };
    scene.contents = Arc::new(contents().into_iter().map(long).collect());
    frame.scene = Arc::new(scene);
    frame.stats.passes = 123_456_789;
    frame.stats.photons = u64::MAX / 3;
    frame.stats.hit_points = 1_234_567_890;
    frame.stats.radii.median = 1.234_567e-9;
    frame.stats.radii.largest = 9.876_543e12;
    frame.stats.bytes = usize::MAX / 7;
    frame.settings.ppm.photons_per_pass = NonZeroU32::MAX;
    frame.stop = StopRule {
        passes: Some(1_000_000_000),
        time: Some(Duration::from_secs(9_999_999)),
        error: Some(0.0123),
    };
    frame.stats.error = Some(ErrorEstimate {
        total: 0.123_456,
        noise: 0.1,
        bias: 0.07,
        low: 0.1,
        high: 0.5,
        focus: 0.4,
        unknown_share: 0.01,
        effective_passes: 9.0,
        mean_luminance: 1.0,
        classes: None,
    });
    let mut selection = selection();
    selection.inspection.title = "a ball whose name goes on and on and on and on".repeat(3);
    selection.inspection.fields[0].value = Value::Number(-987_654.321);
    frame.selection = Some(selection);
    state.adapter = "llvmpipe (LLVM 15.0.6, 256 bits), a software adapter with a long name".into();
}

#[test]
fn nothing_that_is_shown_moves_the_picture() {
    for size in [[900.0, 600.0], [1280.0, 800.0]] {
        let mut harness = sized(size.into(), 1.0, |_| ());
        let before = canvas(&harness);
        fill(harness.state_mut());
        settle(&mut harness);
        assert_eq!(canvas(&harness), before, "long numbers, long names and a selection at {size:?}");
        harness.state_mut().frame.as_mut().expect("there").opening = Some("slow ".repeat(60));
        harness.state_mut().changed_on_disk = true;
        harness.state_mut().view = ViewMode::Radius;
        harness.state_mut().draft = Some((
            Configuration::of(&RenderSettings::default(), None, None),
            Configuration { seed: 77, ..Configuration::of(&RenderSettings::default(), None, None) },
        ));
        settle(&mut harness);
        assert_eq!(canvas(&harness), before, "a scene that opens, a measure and a draft at {size:?}");
        harness.state_mut().frame.as_mut().expect("there").activity = Activity::Paused;
        harness.state_mut().pinned = Some(crate::state::Pinned {
            picture: frame().picture.expect("one"),
            label: "pass 3".into(),
            entry: None,
        });
        settle(&mut harness);
        assert_eq!(canvas(&harness), before, "paused and pinned at {size:?}");
    }
}

/// Controls and words that lie neither in the window nor where they can be scrolled to.
fn cut_off(harness: &Harness<'_, State>, size: egui::Vec2) -> Vec<String> {
    let window = egui::Rect::from_min_size(egui::Pos2::ZERO, size).expand(0.5);
    let canvas = canvas(harness);
    let mut cut = Vec::new();
    for node in harness.root().children_recursive() {
        let inner = node.accesskit_node();
        let (role, label) = (inner.role(), inner.label().or_else(|| inner.value()).unwrap_or_default());
        let is_seen = matches!(
            role,
            Role::Button
                | Role::CheckBox
                | Role::ComboBox
                | Role::Slider
                | Role::SpinButton
                | Role::TextInput
                | Role::Label
        );
        if !is_seen {
            continue;
        }
        let rect = node.rect();
        // Panels scroll up and down: what is in them is cut off only at their sides.
        let [left, right] = match rect.center().x {
            _ if rect.top() < canvas.top() || rect.top() >= canvas.bottom() => {
                [window.left(), window.right()]
            }
            x if x < canvas.left() => [window.left(), canvas.left() - 7.5],
            x if x > canvas.right() => [canvas.right(), window.right() - 7.5],
            _ => [canvas.left(), canvas.right()],
        };
        let is_within = rect.left() >= left && rect.right() <= right;
        if !(rect.is_positive() && is_within) {
            cut.push(format!("{role:?} “{label}” {rect:?}"));
        }
    }
    cut
}

#[test]
fn nothing_is_cut_off_in_small_windows_and_at_high_resolutions() {
    for (size, scale) in [([900.0, 600.0], 1.0), ([1280.0, 800.0], 1.0), ([720.0, 450.0], 2.0)] {
        for is_full in [false, true] {
            let harness = sized(size.into(), scale, |state| {
                if is_full {
                    fill(state);
                }
            });
            assert_eq!(cut_off(&harness, size.into()), [""; 0], "{size:?}, full: {is_full}");
            let canvas = canvas(&harness);
            assert!(canvas.width() > 150.0 && canvas.height() > 300.0, "{canvas:?} at {size:?}");
        }
    }
}

#[test]
fn windows_over_the_panels_fit_into_small_ones() {
    let size = egui::vec2(720.0, 450.0);
    let within = egui::Rect::from_min_size(egui::Pos2::ZERO, size);
    let mut harness = sized(size, 2.0, |state| state.show_help = true);
    harness.run_steps(4);
    let overlay = find(&harness, Role::Window, "Keys and gestures");
    assert!(within.contains_rect(overlay.rect()), "{:?}", overlay.rect());
    harness.state_mut().show_help = false;
    harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::O);
    harness.run_steps(4);
    for label in ["Up", "Cancel", "Open"] {
        let rect = find(&harness, Role::Button, label).rect();
        assert!(within.contains_rect(rect), "{label} {rect:?}");
    }
}
