//! The strip of passes that were kept.

use foton_session::engine::{HistoryEntry, Region, Thumbnail};

use super::*;
use crate::looking::Compare;

/// An entry whose picture is in a file of its own.
fn entry(id: u64, passes: u64) -> HistoryEntry {
    let picture = std::env::temp_dir().join(format!("foton-strip-{}-{id}.exr", std::process::id()));
    let mut image = Image::black(SIZE[0], SIZE[1]);
    image.pixels.fill(Rgb::splat(0.25));
    foton_film::write_exr(&picture, &image, &[], &foton_film::Metadata::default()).expect("written");
    HistoryEntry {
        id,
        render: 1,
        passes,
        photons: 1000 * passes,
        elapsed: Duration::from_secs(2),
        error: Some(0.034),
        scene: "room".into(),
        settings: "α 0.67".into(),
        window: Region { x: 0, y: 0, width: SIZE[0], height: SIZE[1] },
        thumbnail: Arc::new(Thumbnail { size: [6, 4], rgb: vec![90; 72] }),
        picture,
    }
}

fn strip(entries: Vec<HistoryEntry>) -> Harness<'static, State> {
    window(|state| {
        state.looking.show_history = true;
        state.preferences.snapshot_folder = "/pictures".into();
        state.frame.as_mut().expect("there").history = Arc::new(entries);
    })
}

#[test]
fn passes_are_kept_returned_to_and_made_into_films() {
    let mut harness = strip(vec![entry(3, 16)]);
    for (label, command) in [
        ("Keep this pass", Command::Remember),
        ("Return", Command::ReturnTo(3)),
        ("Export film", Command::ExportFilm { of: 3, folder: "/pictures".into() }),
        (
            "Turntable",
            Command::Turntable {
                steps: NonZeroU32::new(24).expect("above 0"),
                passes: 16,
                folder: "/pictures".into(),
            },
        ),
    ] {
        click(&mut harness, Role::Button, label);
        assert_asked(&mut harness, &command);
    }
    harness.state_mut().frame.as_mut().expect("there").turntable = Some([3, 24]);
    settle(&mut harness);
    assert!(harness.query_by_label_contains("3 of 24 frames").is_some());
    click(&mut harness, Role::Button, "End turntable");
    assert_asked(&mut harness, &Command::EndTurntable);
    harness.key_press(egui::Key::T);
    settle(&mut harness);
    assert!(harness.query_by_label("Keep this pass").is_none());
    let empty = strip(Vec::new());
    assert!(empty.query_by_label_contains("Snapshots appear here").is_some());
    assert!(find(&empty, Role::Button, "Export film").accesskit_node().is_disabled());
}

#[test]
fn a_pass_is_compared_with_by_wipe_and_by_difference() {
    let mut harness = strip(vec![entry(4, 1), entry(5, 2)]);
    click(&mut harness, Role::Button, "room pass 2");
    assert!(
        harness.state().pinned.as_ref().is_some_and(|p| p.entry == Some(5) && p.label.contains("pass 2"))
    );
    click(&mut harness, Role::Button, "difference");
    assert_eq!(harness.state().looking.compare, Compare::Difference);
    let apart = harness.state().looking.difference.as_ref().map(|d| d.plane.values[0]);
    let expected = (Rgb::new(0.5, 0.25, 0.125).luminance() - 0.25).abs();
    assert!(apart.is_some_and(|d| (d - expected).abs() < 1e-6), "{apart:?}");
    click(&mut harness, Role::Button, "room pass 1");
    assert!(harness.state().pinned.as_ref().is_some_and(|p| p.entry == Some(4)));
    click(&mut harness, Role::Button, "room pass 1");
    assert!(harness.state().pinned.is_none(), "a second click ends it");
    assert_eq!(asked(&mut harness), [""; 0], "nothing of that is the engine's business");
    // What shows another part is not compared with.
    let mut other = entry(6, 3);
    other.window.width = 9;
    let mut harness = strip(vec![other]);
    click(&mut harness, Role::Button, "room pass 3");
    assert!(harness.state().pinned.is_none());
    assert!(harness.query_by_label_contains("another part of the image").is_some());
}

#[test]
fn a_pass_whose_file_is_gone_says_so() {
    let gone = entry(7, 4);
    std::fs::remove_file(&gone.picture).expect("ours");
    let mut harness = strip(vec![gone]);
    click(&mut harness, Role::Button, "room pass 4");
    assert!(harness.state().pinned.is_none());
    assert!(harness.query_by_label_contains("cannot be shown yet").is_some());
}
