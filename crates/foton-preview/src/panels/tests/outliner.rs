//! The list of what the scene has.

use foton_edit::NewThing;
use foton_session::engine::SceneEdit;

use super::*;

const BALL: Target = Target::Shape(2);

fn chosen() -> Harness<'static, State> {
    window(|state| state.frame.as_mut().expect("there").selection = Some(selection()))
}

fn edit(edit: SceneEdit) -> Command {
    Command::Edit(edit)
}

/// Clicks an entry of a menu, which closes it.
fn pick(harness: &mut Harness<'_, State>, label: &str) {
    find(harness, Role::Button, label).click();
    settle(harness);
}

#[test]
fn everything_is_in_the_list_and_selected_from_it() {
    let mut harness = window(|_| ());
    for name in
        ["floor, diffuse mesh", "table, plastic mesh, hidden", "ball, glass sphere", "lamp, point light"]
    {
        assert!(harness.query_by_role_and_label(Role::Button, name).is_some(), "{name}");
    }
    for heading in ["Shapes", "Lights", "Cameras"] {
        assert!(harness.query_by_label(heading).is_some(), "{heading}");
    }
    click(&mut harness, Role::Button, "lamp, point light");
    assert_asked(&mut harness, &Command::Select(Some(Target::Emitter(0))));
    // By the keyboard as well.
    find(&harness, Role::Button, "top, camera, 60 × 40").focus();
    settle(&mut harness);
    harness.key_press(egui::Key::Enter);
    assert_asked(&mut harness, &Command::Select(Some(Target::Sensor(1))));
}

#[test]
fn things_are_hidden_and_shown() {
    let mut harness = window(|_| ());
    click(&mut harness, Role::Button, "Hide ball");
    assert_asked(&mut harness, &edit(SceneEdit::Hide { target: BALL, hide: true }));
    click(&mut harness, Role::Button, "Show table");
    assert_asked(&mut harness, &edit(SceneEdit::Hide { target: Target::Shape(1), hide: false }));
    assert!(harness.query_by_label("Hide front").is_none(), "cameras are not seen anyway");
}

#[test]
fn what_is_selected_is_copied_and_deleted() {
    let mut harness = chosen();
    click(&mut harness, Role::Button, "Duplicate");
    assert_asked(&mut harness, &edit(SceneEdit::Duplicate(BALL)));
    click(&mut harness, Role::Button, "Delete");
    assert_asked(&mut harness, &edit(SceneEdit::Delete(BALL)));
    harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::D);
    assert_asked(&mut harness, &edit(SceneEdit::Duplicate(BALL)));
    harness.key_press(egui::Key::Delete);
    assert_asked(&mut harness, &edit(SceneEdit::Delete(BALL)));
    let nothing = window(|_| ());
    for action in ["Rename", "Duplicate", "Delete"] {
        assert!(find(&nothing, Role::Button, action).accesskit_node().is_disabled(), "{action}");
    }
}

#[test]
fn a_name_is_taken_by_enter_and_left_by_escape() {
    let mut harness = chosen();
    let typed = |harness: &mut Harness<'_, State>, name: &str| {
        click(harness, Role::Button, "Rename");
        harness.run_steps(2);
        harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::A);
        harness.event(egui::Event::Text(name.into()));
        settle(harness);
        assert_eq!(asked(harness), [""; 0], "nothing while it is typed");
    };
    typed(&mut harness, "pearl");
    harness.key_press(egui::Key::Enter);
    assert_asked(&mut harness, &edit(SceneEdit::Rename { target: BALL, name: "pearl".into() }));
    typed(&mut harness, "marble");
    harness.key_press(egui::Key::Escape);
    assert!(!asked(&mut harness).iter().any(|a| a.contains("Rename")));
    assert!(harness.state().editing.renaming.is_none());
}

#[test]
fn shapes_lights_and_meshes_are_added() {
    let mut harness = window(|_| ());
    for thing in NewThing::ALL {
        click(&mut harness, Role::Button, "Add");
        pick(&mut harness, thing.name());
        assert_asked(&mut harness, &edit(SceneEdit::Add(thing)));
    }
    click(&mut harness, Role::Button, "Add");
    pick(&mut harness, "Mesh from a file…");
    assert!(harness.state().dialog.is_some());
}
