//! The bar on top, dialogs and messages.

use super::*;

#[test]
fn lists_choose_the_view_and_the_tone_map() {
    let mut harness = window(|_| ());
    choose(&mut harness, "Tone map", ToneMap::AgX.name());
    let look = Look { tone_map: ToneMap::AgX, exposure_stops: 0.0 };
    assert_asked(&mut harness, &Command::SetLook(look));
    assert_eq!(harness.state().tone_map, ToneMap::AgX, "nothing is rendered again");
    choose(&mut harness, "View", "Radius");
    assert_asked(&mut harness, &Command::SetView(ViewMode::Radius));
    let exposure = find(&harness, Role::SpinButton, "Exposure").accesskit_node();
    assert!(exposure.is_disabled(), "measures are not exposed");
}

#[test]
fn kinds_of_light_are_a_view_that_restarts_nothing() {
    let mut harness = window(|_| ());
    click(&mut harness, Role::Button, "Light paths");
    click(&mut harness, Role::CheckBox, "Caustic");
    let view = ViewMode::Classes { reflected: [true, false, true], emission: true };
    assert_asked(&mut harness, &Command::SetView(view));
    click(&mut harness, Role::CheckBox, "Caustic");
    assert_asked(&mut harness, &Command::SetView(ViewMode::Radiance));
}

#[test]
fn the_bar_pauses_steps_restarts_saves_and_opens() {
    let mut harness = window(|state| state.preferences.snapshot_folder = "/pictures".into());
    for (label, command) in [
        ("Pause", Command::Pause),
        ("Restart", Command::Restart),
        ("Snapshot", Command::Snapshot("/pictures".into())),
        ("Photons", Command::ShowPhotons(true)),
    ] {
        click(&mut harness, Role::Button, label);
        assert_asked(&mut harness, &command);
    }
    assert!(find(&harness, Role::Button, "Step").accesskit_node().is_disabled());
    harness.state_mut().frame.as_mut().expect("there").activity = Activity::Paused;
    settle(&mut harness);
    for (label, command) in [("Resume", Command::Resume), ("Step", Command::Step)] {
        click(&mut harness, Role::Button, label);
        assert_asked(&mut harness, &command);
    }
    click(&mut harness, Role::Button, "File");
    click(&mut harness, Role::Button, "Gallery");
    click(&mut harness, Role::Button, "ring");
    assert_asked(&mut harness, &Command::Open(Source::BuiltIn("ring".into())));
    click(&mut harness, Role::Button, "Pin");
    assert!(harness.state().pinned.as_ref().is_some_and(|p| p.label == "ppm, pass 12"));
    click(&mut harness, Role::Button, "Unpin");
    assert!(harness.state().pinned.is_none());
    click(&mut harness, Role::Button, "Reset camera");
    assert_asked(&mut harness, &Command::ResetCamera);
    click(&mut harness, Role::CheckBox, "Snapshots at passes 1, 2, 4, 8, …");
    assert_asked(&mut harness, &Command::AutoSnapshots(Some("/pictures".into())));
}

#[test]
fn where_the_light_went_stands_among_the_diagnostics() {
    let mut harness = window(|_| ());
    click(&mut harness, Role::DisclosureTriangle, "Diagnostics");
    for text in ["Absorbed: 75.00 %", "Escaped: 23.75 %", "Truncated (max depth): 1.25 %", "Invalid: 0"] {
        assert!(harness.query_by_label(text).is_some(), "{text}");
    }
    let mut dark = window(|state| state.frame.as_mut().expect("there").stats.ledger = Ledger::default());
    click(&mut dark, Role::DisclosureTriangle, "Diagnostics");
    assert!(dark.query_by_label_contains("Absorbed").is_none(), "nothing was emitted");
}

#[test]
fn checkpoints_are_written_and_resumed_by_the_file_dialog() {
    let folder = std::env::temp_dir().join(format!("foton-panels-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    // The dialog begins beside the scene's file.
    let beside = |state: &mut State| {
        let facts = Arc::make_mut(&mut state.frame.as_mut().expect("there").scene);
        facts.file = Some(folder.join("box.xml"));
    };
    let mut harness = window(beside);
    let stem = harness.state().frame.as_ref().expect("there").scene.name.replace(".xml", "");
    let path = folder.join(format!("{stem}.checkpoint"));
    click(&mut harness, Role::Button, "Keep checkpoint…");
    click(&mut harness, Role::Button, "Save");
    assert_asked(&mut harness, &Command::KeepCheckpoint(path.clone()));
    std::fs::write(&path, "").expect("written");
    let mut harness = window(beside);
    click(&mut harness, Role::Button, "Resume checkpoint…");
    find(&harness, Role::TextInput, "Name").focus();
    settle(&mut harness);
    harness.event(egui::Event::Text(path.display().to_string()));
    settle(&mut harness);
    click(&mut harness, Role::Button, "Open");
    assert_asked(&mut harness, &Command::ResumeCheckpoint(path));
    std::fs::remove_dir_all(folder).expect("removed");
}

#[test]
fn a_scene_that_opens_can_be_called_off_and_one_that_changed_reloaded() {
    let mut harness = window(|state| {
        let frame = state.frame.as_mut().expect("there");
        frame.opening = Some("slow.xml".into());
        frame.building = Some(BuildProgress { step: Some(BuildStep::Tree), share: 0.25 });
        state.changed_on_disk = true;
    });
    harness.get_by_role_and_label(Role::ProgressIndicator, BuildStep::Tree.text());
    click(&mut harness, Role::Button, "Cancel");
    assert_asked(&mut harness, &Command::CancelOpen);
    click(&mut harness, Role::Button, "Reload");
    assert_asked(&mut harness, &Command::Open(Source::File("/scenes/room.xml".into())));
    assert!(harness.query_by_label("Reload").is_none());
}

#[test]
fn a_file_that_is_read_shows_how_far_that_is() {
    let harness = window(|state| {
        let frame = state.frame.as_mut().expect("there");
        frame.opening = Some("slow.xml".into());
        frame.building = Some(BuildProgress { step: None, share: 0.25 });
    });
    harness.get_by_role_and_label(Role::ProgressIndicator, "reading the file");
}

#[test]
fn notices_go_and_errors_stay_until_they_are_closed() {
    let mut harness = window(|state| {
        state.hear(Event::Opened { name: "room.xml".into(), warnings: vec!["room.xml:2:2: odd".into()] });
        state.hear(Event::Failed("ruin.xml:3:7: unknown bsdf \"dielectrc\"".into()));
    });
    for text in ["Opened room.xml", "room.xml:2:2: odd", "ruin.xml:3:7"] {
        assert!(harness.query_by_label_contains(text).is_some(), "{text}");
    }
    for _ in 0..60 {
        let time = harness.input().time.unwrap_or_default();
        harness.input_mut().time = Some(time + 0.25);
        harness.step();
    }
    assert_eq!(harness.state().messages.len(), 1);
    click(&mut harness, Role::Button, "Dismiss");
    assert!(harness.state().messages.is_empty());
}

#[test]
fn lines_of_a_file_stand_letter_below_letter_in_a_message() {
    let marks = format!("  |{}^^^^^", " ".repeat(15));
    let line = "3 | <iiiiiiiiii='WWWWW'";
    let text =
        format!("ruin.xml:3:14: unknown\n  |\n{line}\n{marks}\n  = help: there is more\nruin.xml:4:1: other");
    let mut harness = window(|state| state.hear(Event::Failed(text)));
    assert!(harness.query_by_label("ruin.xml:4:1: other").is_some());
    assert_eq!(line.len(), marks.len());
    let [line, marks] = [line, &marks].map(|text| harness.get_by_label(text).rect());
    assert!((line.width() - marks.width()).abs() < 0.5 && line.left() == marks.left(), "{line} {marks}");
    assert!(line.bottom() <= marks.top() + 0.5);
    click(&mut harness, Role::Button, "Dismiss");
    assert!(harness.state().messages.is_empty());
}

#[test]
fn messages_of_very_many_lines_stay_in_the_window() {
    let text = (0..1000).map(|i| format!("ruin.xml:{i}:1: unknown\n")).collect::<String>();
    let mut harness = window(|state| state.hear(Event::Failed(text)));
    click(&mut harness, Role::Button, "Dismiss");
    assert!(harness.state().messages.is_empty());
}

#[test]
fn the_same_message_again_is_counted_and_not_piled_up() {
    let fail = |state: &mut State| state.hear(Event::Failed("no scene can be made of it".into()));
    let mut harness = window(|state| (0..7).for_each(|_| fail(state)));
    assert_eq!(harness.state().messages.len(), 1);
    assert!(harness.query_by_label("no scene can be made of it (7 times)").is_some());
    click(&mut harness, Role::Button, "Dismiss");
    assert!(harness.state().messages.is_empty());
    fail(harness.state_mut());
    settle(&mut harness);
    assert!(harness.query_by_label("no scene can be made of it").is_some(), "once is said without a count");
}

#[test]
fn the_engine_is_told_how_the_screen_shows_radiance_unless_pngs_are_plain() {
    let mut harness = window(|state| state.preferences.snapshot_folder = "/pictures".into());
    harness.state_mut().exposure_stops = 1.5;
    choose(&mut harness, "Tone map", ToneMap::AgX.name());
    settle(&mut harness);
    click(&mut harness, Role::Button, "Snapshot");
    let look =
        |tone_map, exposure_stops| format!("{:?}", Command::SetLook(Look { tone_map, exposure_stops }));
    let told = asked(&mut harness);
    let snapshot = format!("{:?}", Command::Snapshot("/pictures".into()));
    let default = ToneMap::default();
    assert_eq!(told, [look(default, 1.5), look(ToneMap::AgX, 1.5), snapshot]);
    click(&mut harness, Role::CheckBox, "PNG as shown");
    assert_eq!(asked(&mut harness), [look(default, 0.0)]);
    click(&mut harness, Role::CheckBox, "PNG as shown");
    assert_eq!(asked(&mut harness), [look(ToneMap::AgX, 1.5)]);
}

#[test]
fn exposure_and_kinds_of_light_are_those_of_one_scene() {
    let caustics = ViewMode::Classes { reflected: [false, true, false], emission: false };
    let change = |state: &mut State| {
        state.exposure_stops = 3.0;
        state.tone_map = ToneMap::Linear;
        state.view = caustics;
    };
    let opened = || Event::Opened { name: "pool".into(), warnings: Vec::new() };
    let mut harness = window(change);
    asked(&mut harness);
    harness.state_mut().hear(opened());
    let (state, view) = (harness.state(), ViewMode::Radiance);
    assert_eq!((state.exposure_stops, state.tone_map, state.view), (0.0, ToneMap::default(), view));
    assert!(asked(&mut harness).contains(&format!("{:?}", Command::SetView(view))));
    // The same scene, read again.
    let mut harness = window(change);
    harness.state_mut().changed_on_disk = true;
    settle(&mut harness);
    click(&mut harness, Role::Button, "Reload");
    harness.state_mut().hear(opened());
    assert_eq!((harness.state().exposure_stops, harness.state().view), (3.0, caustics));
}

#[test]
fn scenes_of_before_are_offered_again() {
    let menu = || {
        let mut harness = window(|state| {
            state.preferences.recent = vec!["/scenes/kitchen/scene.xml".into(), "/scenes/lamp.xml".into()];
        });
        click(&mut harness, Role::Button, "File");
        click(&mut harness, Role::Button, "Open recent");
        harness
    };
    let mut harness = menu();
    assert!(harness.query_by_role_and_label(Role::Button, "lamp.xml").is_some());
    // A file that is just called scene goes by its folder.
    click(&mut harness, Role::Button, "kitchen");
    assert_asked(&mut harness, &Command::Open(Source::File("/scenes/kitchen/scene.xml".into())));
    let mut harness = menu();
    click(&mut harness, Role::Button, "Forget these");
    assert!(harness.state().preferences.recent.is_empty());
}
