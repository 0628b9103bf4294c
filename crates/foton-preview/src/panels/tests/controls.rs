//! What steers, what stops, and the settings that restart the render.

use super::*;

#[test]
fn sliders_steer_the_next_pass() {
    let mut harness = window(|_| ());
    find(&harness, Role::Slider, "α").set_value_accesskit(0.3);
    assert_asked(&mut harness, &alpha(0.3));
    find(&harness, Role::Slider, "Photons/pass").set_value_accesskit(65_536.0);
    assert_asked(&mut harness, &photons(65_536));
}

fn photons(n: u32) -> Command {
    Command::Steer(SettingChange::PhotonsPerPass(NonZeroU32::new(n).expect("not zero")))
}

#[test]
fn photons_are_steered_once_their_slider_is_let_go() {
    let mut harness = window(|_| ());
    let slider = find(&harness, Role::Slider, "Photons/pass").rect();
    harness.drag_at(slider.left_center() + egui::vec2(10.0, 0.0));
    harness.run_steps(2);
    harness.hover_at(slider.center());
    assert_eq!(asked(&mut harness), [""; 0], "nothing on the way");
    harness.drop_at(slider.center());
    let asked = asked(&mut harness);
    assert!(asked.len() == 1 && asked[0].contains("PhotonsPerPass"), "{asked:?}");
}

#[test]
fn stop_rules_are_switched_and_typed() {
    let mut harness = window(|_| ());
    click(&mut harness, Role::CheckBox, "Stop after passes");
    assert_asked(&mut harness, &Command::StopAt(StopRule::passes(64)));
    click(&mut harness, Role::CheckBox, "Stop after time");
    assert_asked(&mut harness, &Command::StopAt(StopRule::time(Duration::from_secs(60))));
    type_number(&mut harness, "Stop at error", "5 %");
    let rule = StopRule { error: Some(0.05), ..StopRule::default() };
    assert_asked(&mut harness, &Command::StopAt(rule));
    harness.state_mut().frame.as_mut().expect("there").stop = StopRule::passes(64);
    settle(&mut harness);
    type_number(&mut harness, "Stop after passes", "200");
    assert_asked(&mut harness, &Command::StopAt(StopRule::passes(200)));
    click(&mut harness, Role::CheckBox, "Stop after passes");
    assert_asked(&mut harness, &Command::StopAt(StopRule::default()));
}

#[test]
fn what_restarts_the_render_waits_to_be_applied_and_says_what_changes() {
    let now = Configuration::of(&RenderSettings::default(), None, None);
    let mut harness = window(|_| ());
    assert!(harness.query_by_label("Apply and restart").is_none(), "nothing to apply");
    choose(&mut harness, "Direct light", "Shadow rays");
    assert_eq!(asked(&mut harness), [""; 0]);
    choose(&mut harness, "Radius reduction", "Global");
    settle(&mut harness);
    type_number(&mut harness, "Seed", "12");
    type_number(&mut harness, "Smallest radius", "0.5");
    type_number(&mut harness, "Max depth", "7");
    find(&harness, Role::Slider, "Samples/pixel").set_value_accesskit(16.0);
    settle(&mut harness);
    choose(&mut harness, "Camera", "top");
    assert_eq!(asked(&mut harness), [""; 0]);
    for part in [
        "direct light by shadow rays",
        "global radius reduction",
        "16 samples/pixel",
        "seed 12",
        "max depth 7",
    ] {
        assert!(harness.query_by_label_contains(part).is_some(), "{part}");
    }
    click(&mut harness, Role::Button, "Apply and restart");
    let expected = Configuration {
        direct_light: DirectLight::ShadowRays,
        radius_rule: RadiusRule::Global,
        seed: 12,
        radius_floor: RadiusFloor::new(0.5).expect("not below 0"),
        max_depth: Some(7),
        samples_per_pixel: NonZeroU32::new(16).expect("not zero"),
        sensor: 1,
        ..now
    };
    assert_asked(&mut harness, &Command::Configure(expected));
    assert!(harness.state().messages.iter().any(|m| m.text.contains("Restarted")));
    assert!(harness.query_by_label("Apply and restart").is_none());
    click(&mut harness, Role::CheckBox, "First radius");
    click(&mut harness, Role::Button, "Revert");
    assert_eq!(asked(&mut harness), [""; 0]);
    assert!(harness.query_by_label("Revert").is_none());
}

#[test]
fn a_first_radius_that_nobody_knows_yet_is_not_shown() {
    let mut harness = window(|state| state.frame.as_mut().expect("there").stats.radii = Radii::default());
    assert!(harness.query_by_role_and_label(Role::SpinButton, "First radius").is_none());
    assert!(harness.query_by_label_contains("e-9").is_none());
    harness.state_mut().show(frame());
    settle(&mut harness);
    assert!(harness.query_by_role_and_label(Role::SpinButton, "First radius").is_some());
}

#[test]
fn a_draft_keeps_what_was_changed_when_other_settings_change_meanwhile() {
    let mut harness = window(|_| ());
    type_number(&mut harness, "Seed", "5");
    harness.state_mut().frame.as_mut().expect("there").threads = Some(3);
    settle(&mut harness);
    click(&mut harness, Role::Button, "Apply and restart");
    let now = Configuration::of(&RenderSettings::default(), None, None);
    assert_asked(&mut harness, &Command::Configure(Configuration { seed: 5, threads: Some(3), ..now }));
}

#[test]
fn a_method_is_chosen_from_a_list_and_brings_its_own_number_of_samples() {
    let now = Configuration::of(&RenderSettings::default(), None, None);
    let mut harness = window(|_| ());
    choose(&mut harness, "Method", "Path tracing");
    settle(&mut harness);
    assert_eq!(asked(&mut harness), [""; 0]);
    assert!(harness.query_by_label_contains("with path tracing, 1 samples/pixel in each pass.").is_some());
    for gone in ["Direct light", "Radius reduction"] {
        assert!(
            harness.query_by_role_and_label(Role::ComboBox, gone).is_none(),
            "{gone} of a draft by path tracing"
        );
    }
    click(&mut harness, Role::Button, "Apply and restart");
    let path = Configuration { method: Method::Path, samples_per_pixel: NonZeroU32::MIN, ..now };
    assert_asked(&mut harness, &Command::Configure(path));
    // A number that someone has chosen stays.
    let samples_per_pixel = NonZeroU32::new(7).expect("above 0");
    let mut harness = window(|state| {
        state.frame.as_mut().expect("there").settings.samples_per_pixel = samples_per_pixel;
    });
    choose(&mut harness, "Method", "Whitted ray tracing");
    settle(&mut harness);
    click(&mut harness, Role::Button, "Apply and restart");
    let whitted = Configuration { method: Method::Whitted, samples_per_pixel, ..now };
    assert_asked(&mut harness, &Command::Configure(whitted));
}

#[test]
fn what_a_method_does_not_have_is_not_shown() {
    let mut harness = window(|_| ());
    click(&mut harness, Role::DisclosureTriangle, "Diagnostics");
    harness.run_steps(20);
    let is_there =
        |harness: &Harness<'_, State>, name: &str| harness.query_all_by_label_contains(name).next().is_some();
    let of_photons = ["α", "Photons/pass", "Photons/s", "Hit points", "Radius range", "Smallest radius"];
    for name in of_photons {
        assert!(is_there(&harness, name), "{name} of photon mapping");
    }
    harness.state_mut().choose_view(ViewMode::Radius);
    settle(&mut harness);
    harness.state_mut().frame.as_mut().expect("there").settings.method = Method::Path;
    settle(&mut harness);
    harness.run_steps(20);
    for name in of_photons {
        assert!(!is_there(&harness, name), "{name} of path tracing");
    }
    assert_eq!(harness.state().view, ViewMode::Radiance, "radii are gone");
    harness.key_press(egui::Key::Num3);
    settle(&mut harness);
    assert_eq!(harness.state().view, ViewMode::Radiance);
    for name in ["Rays/s", "Samples/pixel", "Seed", "Stop at error"] {
        assert!(is_there(&harness, name), "{name}");
    }
}
