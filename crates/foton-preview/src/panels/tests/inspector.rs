//! The inspector over a selection that was made up.

use foton_edit::Make;
use foton_session::engine::SceneEdit;

use super::*;

fn chosen() -> Harness<'static, State> {
    window(|state| state.frame.as_mut().expect("there").selection = Some(selection()))
}

fn set(id: FieldId, value: Value) -> Command {
    Command::Edit(SceneEdit::SetField { field: id, value, done: true })
}

const fn material(property: Property) -> FieldId {
    FieldId::Material(Side::Front, property)
}

#[test]
fn it_says_what_is_chosen_and_who_shares_its_material() {
    let mut harness = chosen();
    for text in ["ball", "glass sphere", "Material glass", "shared by 2 shapes"] {
        assert!(harness.query_all_by_label_contains(text).next().is_some(), "{text}");
    }
    click(&mut harness, Role::Button, "Make its own");
    assert_asked(&mut harness, &Command::Edit(SceneEdit::OwnMaterial));
    click(&mut harness, Role::Button, "Undo");
    assert_asked(&mut harness, &Command::Edit(SceneEdit::Undo));
    assert!(find(&harness, Role::Button, "Redo").accesskit_node().is_disabled());
    click(&mut harness, Role::Button, "Deselect");
    assert_asked(&mut harness, &Command::Choose(None));
}

#[test]
fn numbers_are_set_by_slider_and_by_typing() {
    let mut harness = chosen();
    find(&harness, Role::Slider, "IOR inside").set_value_accesskit(2.0);
    assert_asked(&mut harness, &set(material(Property::Parameter("int_ior")), Value::Number(2.0)));
    type_number(&mut harness, "Radius", "2.5");
    let last = asked(&mut harness).pop();
    assert_eq!(last, Some(format!("{:?}", set(FieldId::Radius, Value::Number(2.5)))));
    type_number(&mut harness, "X", "-3");
    let last = asked(&mut harness).pop();
    assert_eq!(last, Some(format!("{:?}", set(FieldId::Position(0), Value::Number(-3.0)))));
}

#[test]
fn a_slider_that_is_dragged_is_done_when_it_is_let_go() {
    let mut harness = chosen();
    let slider = find(&harness, Role::Slider, "IOR inside").rect();
    harness.drag_at(slider.left_center() + egui::vec2(10.0, 0.0));
    harness.run_steps(2);
    harness.hover_at(slider.center());
    harness.run_steps(2);
    let moving = asked(&mut harness);
    assert!(!moving.is_empty() && moving.iter().all(|a| a.contains("done: false")), "{moving:?}");
    harness.drop_at(slider.center());
    let ended = asked(&mut harness);
    assert!(ended.last().is_some_and(|a| a.contains("done: true")), "{ended:?}");
}

#[test]
fn choices_switches_and_colours_are_set() {
    let mut harness = chosen();
    click(&mut harness, Role::CheckBox, "Rough");
    assert_asked(&mut harness, &set(material(Property::Rough), Value::Toggle(true)));
    // The colour button opens a picker, whose channels are numbers.
    find(&harness, Role::ColorWell, "Transmission").click();
    settle(&mut harness);
    let before = harness.query_all_by_role(Role::SpinButton).count();
    assert!(before > 0);
    assert_eq!(asked(&mut harness), [""; 0], "looking is not setting");
}

#[test]
fn without_a_choice_there_is_no_inspector() {
    let harness = window(|_| ());
    assert!(harness.query_by_label("Deselect").is_none());
    assert!(harness.query_by_label_contains("Nothing selected").is_some());
}

fn remake(make: Make, name: &str, all: bool) -> Command {
    Command::Edit(SceneEdit::Remake { make, name: name.into(), all })
}

#[test]
fn another_kind_asks_for_the_name_of_the_new_material() {
    let mut harness = chosen();
    choose(&mut harness, "Kind", "diffuse");
    assert_eq!(asked(&mut harness), [""; 0], "nothing before it has a name");
    click(&mut harness, Role::Button, "Cancel");
    assert_eq!(asked(&mut harness), [""; 0]);
    assert!(harness.state().editing.remaking.is_none());
    let mut harness = chosen();
    choose(&mut harness, "Kind", "diffuse");
    settle(&mut harness);
    harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::A);
    harness.event(egui::Event::Text("chalk".into()));
    settle(&mut harness);
    click(&mut harness, Role::CheckBox, "For all 2 shapes that share it");
    click(&mut harness, Role::Button, "Apply");
    assert_asked(&mut harness, &remake(Make::Kind(Side::Front, 0), "chalk", true));
}

#[test]
fn presets_have_pictures_and_are_taken_under_their_name() {
    let mut harness = chosen();
    for (i, preset) in foton_edit::presets().iter().enumerate() {
        click(&mut harness, Role::Button, "Presets");
        find(&harness, Role::Button, preset.name).click();
        settle(&mut harness);
        click(&mut harness, Role::Button, "Apply");
        let name = preset.name.replace(' ', "-");
        let last = asked(&mut harness).pop();
        assert_eq!(last, Some(format!("{:?}", remake(Make::Preset(i), &name, false))));
        assert!(crate::panels::presets::texture_of(&harness.ctx, preset.name).is_some(), "{}", preset.name);
    }
}

#[test]
fn complex_indices_are_advanced() {
    let mut harness = window(|state| {
        let mut selection = selection();
        let index = field(
            material(Property::Channel("k", 0)),
            "k red",
            Value::Number(3.0),
            Control::Number { min: 0.0, max: 10.0, logarithmic: false },
        );
        selection.inspection.fields.push(Field { is_advanced: true, ..index });
        state.frame.as_mut().expect("there").selection = Some(selection);
    });
    assert!(harness.query_by_role_and_label(Role::SpinButton, "k red").is_none());
    harness.get_by_label("Advanced").click_accesskit();
    harness.run_steps(20);
    assert!(harness.query_by_role_and_label(Role::SpinButton, "k red").is_some());
}

#[test]
fn a_camera_is_looked_through_and_views_go_along_the_axes() {
    let mut harness = window(|state| {
        let camera = Selection {
            target: Target::Sensor(1),
            inspection: Inspection { material: None, fields: Vec::new(), ..selection().inspection },
            gizmo: None,
            ..selection()
        };
        state.frame.as_mut().expect("there").selection = Some(camera);
    });
    click(&mut harness, Role::Button, "Look through it");
    assert!(asked(&mut harness)[0].contains("sensor: 1"));
    click(&mut harness, Role::Button, "Top");
    let gesture = foton_session::engine::Gesture::Face(foton_edit::ViewSide::Top);
    assert_asked(&mut harness, &Command::Camera { gesture, moving: false });
}
