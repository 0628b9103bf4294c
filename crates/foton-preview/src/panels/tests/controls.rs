//! Sliders, stop rules and the settings that restart the render.

use super::*;

#[test]
fn sliders_steer_the_next_pass() {
    let mut harness = window(|_| ());
    find(&harness, Role::Slider, "α").set_value_accesskit(0.3);
    assert_asked(&mut harness, &alpha(0.3));
    find(&harness, Role::Slider, "photons a pass").set_value_accesskit(65_536.0);
    let photons = NonZeroU32::new(65_536).expect("not zero");
    assert_asked(&mut harness, &Command::Steer(SettingChange::PhotonsPerPass(photons)));
}

#[test]
fn values_are_typed_and_what_is_out_of_range_goes_to_its_end() {
    let half = Alpha::new(0.5).expect("an alpha");
    let mut harness = window(|state| state.frame.as_mut().expect("there").settings.ppm.alpha = half);
    type_number(&mut harness, "α", "0.45");
    assert!(asked(&mut harness).contains(&format!("{:?}", alpha(0.45))));
    type_number(&mut harness, "α", "7");
    let typed = asked(&mut harness);
    assert!(typed.contains(&format!("{:?}", alpha(1.0))), "{typed:?}");
    type_number(&mut harness, "α", "nonsense");
    assert_eq!(asked(&mut harness), [""; 0]);
    type_number(&mut harness, "photons a pass", "1000000");
    assert!(asked(&mut harness).pop().is_some_and(|a| a.contains("1000000")));
}

#[test]
fn stop_rules_are_switched_and_typed() {
    let mut harness = window(|_| ());
    click(&mut harness, Role::CheckBox, "after passes");
    assert_asked(&mut harness, &Command::StopAt(StopRule::passes(64)));
    click(&mut harness, Role::CheckBox, "after time");
    assert_asked(&mut harness, &Command::StopAt(StopRule::time(Duration::from_secs(60))));
    harness.state_mut().frame.as_mut().expect("there").stop = StopRule::passes(64);
    settle(&mut harness);
    type_number(&mut harness, "after passes", "200");
    let last = asked(&mut harness).pop();
    assert_eq!(last, Some(format!("{:?}", Command::StopAt(StopRule::passes(200)))));
    click(&mut harness, Role::CheckBox, "after passes");
    assert_asked(&mut harness, &Command::StopAt(StopRule::default()));
}

#[test]
fn what_restarts_the_render_says_so_and_is_sent_once_it_is_let_go() {
    let now = Configuration::of(&RenderSettings::default(), None, None);
    let mut harness = window(|_| ());
    click(&mut harness, Role::Button, "shadow rays");
    let shadow_rays = Configuration { direct_light: DirectLight::ShadowRays, ..now };
    assert_asked(&mut harness, &Command::Configure(shadow_rays));
    assert!(harness.state().messages.iter().any(|m| m.text.contains("Restarted")));
    click(&mut harness, Role::Button, "together");
    let together = Configuration { radius_rule: RadiusRule::Global, ..now };
    assert_asked(&mut harness, &Command::Configure(together));

    // While a number is typed nothing starts; then once.
    type_into(&mut harness, "Seed", "12");
    assert_eq!(asked(&mut harness), [""; 0]);
    harness.key_press(egui::Key::Enter);
    assert_asked(&mut harness, &Command::Configure(Configuration { seed: 12, ..now }));
    type_into(&mut harness, "Smallest radius", "0.5");
    assert_eq!(asked(&mut harness), [""; 0]);
    harness.key_press(egui::Key::Enter);
    let radius_floor = RadiusFloor::new(0.5).expect("not below 0");
    assert_asked(&mut harness, &Command::Configure(Configuration { radius_floor, ..now }));

    click(&mut harness, Role::CheckBox, "first radius");
    assert!(asked(&mut harness)[0].contains("radius: Some("));
    find(&harness, Role::Slider, "hit points a pixel").set_value_accesskit(16.0);
    let sixteen = NonZeroU32::new(16).expect("not zero");
    assert_asked(&mut harness, &Command::Configure(Configuration { samples_per_pixel: sixteen, ..now }));
    choose(&mut harness, "Camera of the scene", "top");
    assert_asked(&mut harness, &Command::Configure(Configuration { sensor: 1, ..now }));
}
