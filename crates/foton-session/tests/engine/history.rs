//! Passes that are kept: returned to with the same bits, within a limit, and made into films.

use std::num::NonZeroU32;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use foton_edit::DragMode;
use foton_film::{read_exr, read_png};
use foton_session::StopRule;
use foton_session::engine::{Activity, Command, Configuration, Event, Frame, HistoryEntry, SceneEdit, Setup};

use crate::rig::{BALL, Folder, Rig, headless, image, settings};

/// An engine whose history is in a folder.
fn rig(folder: &Folder, change: impl FnOnce(Setup) -> Setup) -> (Rig, Frame) {
    let history_folder = Some(folder.0.join("history"));
    let rig = Rig::with(settings(), None, |setup| change(Setup { history_folder, ..setup }));
    rig.send(Command::StopAt(StopRule::passes(2)));
    rig.open("room");
    let frame = rig.done(2);
    (rig, frame)
}

/// Keeps the pass and waits until its files are there.
fn keep(rig: &Rig, count: usize) -> Arc<Vec<HistoryEntry>> {
    rig.send(Command::Remember);
    let history = rig.until("it kept", |f| f.history.len() == count).history;
    let state = history[count - 1].picture.with_extension("checkpoint");
    while !state.exists() {
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
    history
}

fn to_pass(rig: &Rig, passes: u64) -> Frame {
    rig.send(Command::StopAt(StopRule::passes(passes)));
    rig.done(passes)
}

#[test]
fn a_pass_that_was_kept_comes_back_and_goes_on_with_the_same_bits() {
    let folder = Folder::new("history");
    let (rig, _) = rig(&folder, |setup| setup);
    let kept = keep(&rig, 1);
    let [entry] = &kept[..] else { panic!("{kept:?}") };
    assert_eq!((entry.passes, entry.scene.as_str(), entry.thumbnail.size), (2, "room", [90, 60]));
    assert!(entry.settings.contains("8192 photons/pass") && entry.thumbnail.rgb.iter().any(|v| *v > 20));
    let (picture, _) = read_exr(&entry.picture).expect("an EXR");
    assert!(picture == headless(2, settings(), |_, _| ()).render().image());
    // The same pass is kept once; a later one beside it.
    rig.send(Command::Remember);
    let four = to_pass(&rig, 4);
    assert_eq!(keep(&rig, 2).len(), 2);
    // Another scene, seed and camera later it comes back with its own.
    rig.send(Command::Choose(Some(BALL)));
    rig.send(Command::Edit(SceneEdit::Nudge { steps: [9.0, 0.0], mode: DragMode::Horizontal }));
    let gesture = foton_session::engine::Gesture::Orbit { yaw: 0.3, pitch: 0.0 };
    rig.send(Command::Camera { gesture, moving: false });
    rig.send(Command::Configure(Configuration { seed: 5, ..Configuration::of(&settings(), None, None) }));
    let edited = rig.until("all of that", |f| f.activity == Activity::Done && f.settings.seed == 5);
    assert!(edited.scene.is_edited && image(&edited) != image(&four));
    rig.send(Command::ReturnTo(entry.id));
    let back = rig.until("the pass", |f| f.activity == Activity::Done && !f.scene.is_edited);
    assert_eq!((back.stats.passes, back.settings.seed), (4, 0), "it goes on to the stop rule");
    assert!(image(&back) == image(&four), "with the bits of a render that never stopped");
    // The edit is a step that can be made again.
    assert!(back.scene.redo.is_some());
    rig.send(Command::ReturnTo(99));
    assert!(rig.failure().contains("does not have that pass"));
}

#[test]
fn edited_scenes_and_regions_come_back_too() {
    let folder = Folder::new("history-edited");
    let (rig, _) = rig(&folder, |setup| setup);
    rig.send(Command::Choose(Some(BALL)));
    rig.send(Command::Edit(SceneEdit::Nudge { steps: [9.0, 0.0], mode: DragMode::Horizontal }));
    let region = Some(foton_session::engine::Region { x: 60, y: 40, width: 50, height: 40 });
    rig.send(Command::Configure(Configuration::of(&settings(), None, region)));
    let edited =
        rig.until("the edit", |f| f.activity == Activity::Done && f.scene.is_edited && f.region == region);
    keep(&rig, 1);
    rig.send(Command::Edit(SceneEdit::Undo));
    rig.send(Command::Configure(Configuration::of(&settings(), None, None)));
    rig.until("the file's", |f| f.activity == Activity::Done && !f.scene.is_edited && f.region.is_none());
    // The way there by redoing is cut off.
    rig.send(Command::Choose(Some(BALL)));
    rig.send(Command::Edit(SceneEdit::Nudge { steps: [0.0, 5.0], mode: DragMode::Horizontal }));
    rig.until("another edit", |f| f.activity == Activity::Done && f.scene.is_edited);
    rig.send(Command::ReturnTo(1));
    let back = rig.until("the edit", |f| f.activity == Activity::Done && f.region == region);
    assert!(back.stats.passes == 2 && image(&back) == image(&edited));
    assert_eq!(back.scene.undo.as_deref(), Some("return"), "and can be undone");
}

#[test]
fn the_history_keeps_within_its_limit_and_goes_with_the_engine() {
    let folder = Folder::new("history-limit");
    // Room for several passes: one alone takes more than a megabyte.
    let (rig, _) = rig(&folder, |setup| Setup { history_limit: 4 << 20, ..setup });
    let mut passes = 2;
    let removed = loop {
        rig.send(Command::Remember);
        passes += 1;
        to_pass(&rig, passes);
        assert!(passes < 60, "nothing is removed");
        if let Some(Event::Notice(text)) =
            rig.engine.events().try_iter().find(|e| matches!(e, Event::Notice(_)))
        {
            break text;
        }
    };
    assert!(removed.contains("were removed"), "{removed}");
    // What the thread that writes has removed is in a frame soon after: each answer to a probe is one.
    let history = (0..100)
        .map(|row| {
            rig.send(Command::Probe(Some([1, row])));
            rig.until("the probe", |f| f.probe.as_ref().is_some_and(|probe| probe.pixel == [1, row])).history
        })
        .find(|history| history.first().is_some_and(|first| first.id > 1))
        .expect("fewer entries");
    assert!(history.iter().all(|entry| entry.passes > 2), "the first went first");
    let room = history[0].picture.parent().expect("a folder").to_owned();
    let bytes = |room: &Path| -> u64 {
        room.read_dir()
            .into_iter()
            .flatten()
            .flatten()
            .filter_map(|e| e.metadata().ok())
            .map(|m| m.len())
            .sum()
    };
    assert!(bytes(&room) < 5 << 20, "{}", bytes(&room));
    rig.send(Command::ReturnTo(1));
    assert!(rig.failure().contains("does not have that pass any more"));
    rig.engine.finish_writing();
    assert!(!room.exists(), "nothing is left");
}

/// Frames of a film, by name.
fn frames(folder: &Path) -> Vec<PathBuf> {
    let mut all: Vec<PathBuf> = folder.read_dir().expect("a folder").flatten().map(|e| e.path()).collect();
    all.sort();
    all
}

#[test]
fn kept_passes_become_a_film_in_a_folder_of_its_own() {
    let folder = Folder::new("film");
    // What stands for ffmpeg says what it was asked for.
    let ffmpeg = folder.0.join("ffmpeg");
    std::fs::write(&ffmpeg, "#!/bin/sh\nfor last; do :; done\necho \"$@\" > \"$last\"\n").expect("written");
    #[cfg(unix)]
    std::fs::set_permissions(&ffmpeg, std::os::unix::fs::PermissionsExt::from_mode(0o755)).expect("ours");
    let (rig, _) = rig(&folder, |setup| Setup { ffmpeg, ..setup });
    keep(&rig, 1);
    to_pass(&rig, 3);
    keep(&rig, 2);
    let films = folder.0.join("films");
    rig.send(Command::ExportFilm { of: 2, folder: films.clone() });
    if cfg!(unix) {
        assert_eq!(rig.saved(), [films.join("room-film-001/film.mp4")]);
        let asked = std::fs::read_to_string(films.join("room-film-001/film.mp4")).expect("there");
        assert!(asked.contains("-i frame-%04d.png"), "{asked}");
    }
    let (first, _) = read_png(&films.join("room-film-001/frame-0001.png")).map(|i| (i, ())).expect("a PNG");
    assert_eq!((first.width, first.height), (180, 120));
    assert!(films.join("room-film-001/frame-0002.png").exists());
    // A second one goes beside it.
    rig.send(Command::ExportFilm { of: 1, folder: films.clone() });
    rig.hear("of the second", |_| films.join("room-film-002/frame-0002.png").exists().then_some(()));
}

#[test]
fn without_ffmpeg_frames_are_left_and_said() {
    let folder = Folder::new("no-ffmpeg");
    let (rig, _) = rig(&folder, |setup| Setup { ffmpeg: "no-such-program".into(), ..setup });
    keep(&rig, 1);
    rig.send(Command::ExportFilm { of: 1, folder: folder.0.clone() });
    let said = rig.hear("of frames", |event| match event {
        Event::Notice(text) if text.contains("frames are in") => Some(text.clone()),
        _ => None,
    });
    assert!(said.contains("1 frames are in") && said.contains("ffmpeg"), "{said}");
    assert_eq!(frames(&folder.0.join("room-film-001")).len(), 1);
}

#[test]
fn the_camera_goes_around_and_comes_back() {
    let folder = Folder::new("turntable");
    let (rig, before) = rig(&folder, |setup| Setup { ffmpeg: "no-such-program".into(), ..setup });
    let steps = NonZeroU32::new(3).expect("above 0");
    rig.send(Command::Turntable { steps, passes: 1, folder: folder.0.clone() });
    rig.until("it turning", |f| f.turntable.is_some_and(|[done, all]| done > 0 && all == 3));
    let after = rig.until("the end", |f| f.turntable.is_none() && f.activity == Activity::Done);
    let frames = frames(&folder.0.join("room-turntable-001"));
    assert_eq!(frames.len(), 3);
    let pictures: Vec<_> = frames.iter().map(|path| read_png(path).expect("a PNG")).collect();
    assert!(pictures[0] != pictures[1] && pictures[1] != pictures[2]);
    assert!(image(&after) == image(&before) && !after.scene.is_edited, "where it was");
    // Who takes the camera ends it.
    rig.send(Command::Turntable { steps, passes: 1000, folder: folder.0.clone() });
    rig.until("it turning", |f| f.turntable.is_some() && f.stats.passes > 0);
    rig.send(Command::ResetCamera);
    let said = rig.hear("of the end", |event| match event {
        Event::Notice(text) if text.starts_with("The turntable") => Some(text.clone()),
        _ => None,
    });
    assert_eq!(said, "The turntable ended after 0 of 3 frames");
    rig.until("the rest", |f| f.turntable.is_none() && f.activity == Activity::Done);
}
