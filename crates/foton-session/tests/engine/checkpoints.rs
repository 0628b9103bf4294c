//! A render that has a checkpoint goes on from there, in another window or in none.

use std::path::{Path, PathBuf};
use std::time::Duration;

use foton_edit::DragMode;
use foton_session::engine::{Command, Event, Frame, Gesture, SceneEdit};
use foton_session::{StopRule, checkpoint};

use crate::rig::{BALL, Folder, Rig, headless, identity, image, scene_file, settings};

/// What went wrong.
fn failure(rig: &Rig) -> String {
    rig.hear("of a failure", |event| match event {
        Event::Failed(message) => Some(message.clone()),
        _ => None,
    })
}

fn passes(path: &Path) -> u64 {
    let mut session = headless(0, settings(), |_, _| ());
    checkpoint::resume(path, &mut session, &identity(), false).expect("of the room");
    session.render().passes()
}

#[test]
fn a_checkpoint_is_resumed_with_the_same_bits_and_written_at_the_end() {
    let folder = Folder::new("keep");
    let path = folder.0.join("room.checkpoint");
    let (rig, _) = Rig::at_pass(2);
    rig.send(Command::KeepCheckpoint(path.clone()));
    assert_eq!(rig.saved(), std::slice::from_ref(&path));
    assert_eq!(passes(&path), 2);
    rig.send(Command::StopAt(StopRule::passes(3)));
    rig.done(3);
    rig.engine.finish_writing();
    assert_eq!(passes(&path), 3);

    let (other, first) = Rig::at_pass(1);
    other.send(Command::StopAt(StopRule::passes(5)));
    other.done(5);
    other.send(Command::ResumeCheckpoint(path));
    let after = other.until("the rest", |f: &Frame| f.render != first.render && f.stats.passes == 5);
    let straight = headless(5, settings(), |_, _| ());
    assert_eq!(*image(&after), straight.render().image());
    assert_eq!(after.stats.photons, straight.render().photons_emitted());
}

/// Rates and stop rules go by the checkpoint's clock, which may show less than the eye pass has just taken, or much more.
#[test]
fn a_checkpoint_of_any_age_is_resumed() {
    let folder = Folder::new("age");
    let path = folder.0.join("room.checkpoint");
    let two = headless(2, settings(), |_, _| ());
    for elapsed in [Duration::ZERO, Duration::from_nanos(1), Duration::MAX] {
        checkpoint::write(&path, two.render(), elapsed, 0, &identity()).expect("written");
        let (rig, first) = Rig::at_pass(1);
        rig.send(Command::StopAt(StopRule::passes(9)));
        rig.send(Command::ResumeCheckpoint(path.clone()));
        let after = rig.until("the rest", |f| f.render != first.render && f.stats.passes == 9);
        assert_eq!(*image(&after), headless(9, settings(), |_, _| ()).render().image());
        // What the checkpoint brings was not made in this window.
        let made = after.stats.photons - two.render().photons_emitted();
        let seconds = after.stats.elapsed.saturating_sub(elapsed).as_secs_f64();
        // Rates are those of the last two seconds, which on a busy machine may be above the mean of a longer render.
        if elapsed < Duration::from_secs(1) && seconds < 2.0 {
            assert!(after.stats.photons_per_s * seconds <= 1.001 * made as f64, "{:?}", after.stats);
        }
    }
}

#[test]
fn a_render_that_restarts_leaves_the_checkpoint_of_the_one_before() {
    let folder = Folder::new("leave");
    let path = folder.0.join("room.checkpoint");
    let (rig, _) = Rig::at_pass(1);
    rig.send(Command::KeepCheckpoint(path.clone()));
    rig.saved();
    rig.send(Command::StopAt(StopRule::passes(4)));
    let before = rig.done(4);
    rig.send(Command::Restart);
    rig.hear("of the end of keeping", |event| {
        matches!(event, Event::Notice(text) if text.contains("room.checkpoint")).then_some(())
    });
    rig.until("the next render", |f| f.render != before.render && f.stats.passes == 4);
    assert_eq!(passes(&path), 4);
}

#[test]
fn edited_scenes_and_other_files_are_refused_and_the_render_goes_on() {
    let folder = Folder::new("refuse");
    let path = folder.0.join("room.checkpoint");
    std::fs::write(&path, "not one").expect("written");
    let (rig, before) = Rig::at_pass(2);
    rig.send(Command::ResumeCheckpoint(path.clone()));
    assert!(failure(&rig).contains("this is no checkpoint"));
    let after = rig.until("a render all the same", |f| f.render != before.render && f.stats.passes == 2);
    assert_eq!(image(&after), image(&before));

    rig.send(Command::Choose(Some(BALL)));
    rig.send(Command::Edit(SceneEdit::Nudge { steps: [3.0, 0.0], mode: DragMode::Horizontal }));
    rig.until("the edit", |f| f.scene.is_edited && f.stats.passes == 2);
    rig.send(Command::KeepCheckpoint(path.clone()));
    assert!(failure(&rig).contains("save it"));
    rig.send(Command::Edit(SceneEdit::Undo));
    rig.send(Command::Camera { gesture: Gesture::Zoom(1.1), moving: false });
    rig.until("the camera", |f| f.scene.is_edited && f.stats.passes == 2);
    rig.send(Command::KeepCheckpoint(path.clone()));
    assert!(failure(&rig).contains("save it"));
    assert_eq!(std::fs::read_to_string(&path).expect("still there"), "not one");
}

#[test]
fn a_folder_that_vanishes_costs_its_checkpoint_and_the_render_goes_on() {
    let folder = Folder::new("vanish");
    let path = folder.0.join("room.checkpoint");
    let (rig, before) = Rig::at_pass(2);
    rig.send(Command::KeepCheckpoint(path.clone()));
    rig.saved();
    std::fs::remove_dir_all(&folder.0).expect("ours");
    rig.send(Command::StopAt(StopRule::passes(4)));
    let after = rig.done(4);
    assert_eq!(after.render, before.render);
    // The checkpoint is written for the last time when another is asked for; neither has a place.
    rig.send(Command::KeepCheckpoint(path.clone()));
    let expected =
        format!("cannot write {}: the folder {} does not exist", path.display(), folder.0.display());
    let [last, next] = [failure(&rig), failure(&rig)];
    assert_eq!(next, expected);
    // What was owed to the file is not lost.
    let spare = last.strip_prefix(&format!("{expected}; the render is in "));
    let spare =
        PathBuf::from(spare.and_then(|s| s.strip_suffix(" instead")).unwrap_or_else(|| panic!("{last}")));
    assert_eq!((spare.parent(), passes(&spare)), (Some(&*std::env::temp_dir()), 4));
    std::fs::remove_file(&spare).expect("ours");
    rig.send(Command::StopAt(StopRule::passes(5)));
    assert_eq!(rig.done(5).render, before.render);
    // Once the folder is there again, so is the checkpoint.
    std::fs::create_dir(&folder.0).expect("a folder");
    rig.send(Command::KeepCheckpoint(path.clone()));
    rig.saved();
    assert_eq!(passes(&path), 5);
}

/// Not even by a link: the scene's own files stay, and so does a checkpoint where pictures go.
#[test]
fn nothing_is_written_over_what_the_scene_is_read_from_or_its_checkpoint() {
    let folder = Folder::new("over");
    let last = folder.0.join("room.checkpoint");
    std::fs::write(scene_file(), "the scene").expect("written");
    let (rig, _) = Rig::at_pass(2);
    rig.send(Command::KeepCheckpoint(last.clone()));
    rig.saved();
    let over = |path: &Path, file: &Path| {
        format!("cannot write {}: the scene reads that file ({})", path.display(), file.display())
    };
    rig.send(Command::KeepCheckpoint(scene_file()));
    assert_eq!(failure(&rig), over(&scene_file(), &scene_file()));
    // The checkpoint before still follows the render.
    rig.send(Command::SaveScene(last.clone()));
    let busy =
        |path: &Path| format!("cannot write {}: it is the checkpoint {}", path.display(), last.display());
    assert_eq!(failure(&rig), busy(&last));
    let [exr, png] = ["exr", "png"].map(|e| folder.0.join(format!("room-002-p000004.{e}")));
    rig.send(Command::AutoSnapshots(Some(folder.0.clone())));
    std::fs::hard_link(scene_file(), folder.0.join("room-001-p000002.exr")).expect("a link");
    std::fs::hard_link(scene_file(), &exr).expect("a link");
    std::fs::hard_link(&last, &png).expect("a link");
    rig.send(Command::StopAt(StopRule::passes(4)));
    rig.done(4);
    let made = ["exr", "png"].map(|e| folder.0.join(format!("room-003-p000004.{e}")));
    assert_eq!(rig.saved(), made, "beside them");
    assert_eq!(std::fs::read_to_string(scene_file()).expect("there"), "the scene");
    assert_eq!(passes(&last), 2);
    std::fs::remove_file(scene_file()).expect("ours");
}
