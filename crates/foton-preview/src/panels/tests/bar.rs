//! The bar on top, dialogs and messages.

use super::*;

#[test]
fn lists_choose_the_view_and_the_tone_map() {
    let mut harness = window(|_| ());
    choose(&mut harness, "Tone map", ToneMap::AgX.name());
    assert_eq!(asked(&mut harness), [""; 0], "nothing is rendered again");
    assert_eq!(harness.state().tone_map, ToneMap::AgX);
    choose(&mut harness, "View", "Radius");
    assert_asked(&mut harness, &Command::SetView(ViewMode::Radius));
    let exposure = find(&harness, Role::SpinButton, "Exposure").accesskit_node();
    assert!(exposure.is_disabled(), "measures are not exposed");
}

#[test]
fn kinds_of_light_are_switched_and_separate_from_then_on() {
    let mut harness = window(|_| ());
    click(&mut harness, Role::Button, "Light paths");
    click(&mut harness, Role::CheckBox, "Caustic");
    let view = ViewMode::Classes { reflected: [true, false, true], emission: true };
    let layers = Configuration { layers: true, ..Configuration::of(&RenderSettings::default(), None) };
    let expected = [Command::SetView(view), Command::Configure(layers)].map(|c| format!("{c:?}"));
    assert_eq!(asked(&mut harness), expected);
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
    click(&mut harness, Role::Button, "Built in");
    click(&mut harness, Role::Button, "ring");
    assert_asked(&mut harness, &Command::Open(Source::BuiltIn("ring".into())));
    click(&mut harness, Role::Button, "Pin");
    assert!(harness.state().pinned.as_ref().is_some_and(|p| p.label == "pass 12"));
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
        frame.building = Some(BuildProgress { step: BuildStep::Tree, share: 0.25 });
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
