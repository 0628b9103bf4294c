//! Passes that are longer than a person waits: pause, choice and change come in the middle of one, and change no bit of it.

use std::num::NonZeroU32;

use foton_edit::DragMode;
use foton_integrator::{Alpha, PpmSettings, RenderSettings, SettingChange};
use foton_scene::Scene;
use foton_session::engine::{Activity, Command, Configuration, Event, Frame, SceneEdit, ViewMode};
use foton_session::{Session, StopRule};

use crate::rig::{BALL, Folder, Rig, headless, image, room, settings};

/// Passes of many slices, in two batches.
fn long() -> RenderSettings {
    let photons = NonZeroU32::new((1 << 20) + (1 << 17)).expect("not zero");
    RenderSettings {
        ppm: PpmSettings { photons_per_pass: photons, first_pass: photons, ..settings().ppm },
        ..settings()
    }
}

/// Paused in the middle of a pass that is not the first.
fn paused_in_the_second_pass() -> (Rig, Frame) {
    let rig = Rig::new(long(), None);
    // On one thread a pass has many slices on any machine.
    rig.send(Command::Configure(Configuration::of(&long(), Some(1), None)));
    rig.open("room");
    rig.until("the second pass", |f| f.stats.passes == 1 && f.pass_share > 0.0);
    rig.send(Command::Pause);
    let paused = rig.until("the pause", |f| f.activity == Activity::Paused);
    assert!(paused.stats.passes == 1 && paused.pass_share > 0.0 && paused.pass_share < 1.0);
    (rig, paused)
}

#[test]
fn a_pause_holds_the_pass_where_it_is_and_what_is_asked_meanwhile_is_answered() {
    let (rig, paused) = paused_in_the_second_pass();
    rig.send(Command::Choose(Some(BALL)));
    let chosen = rig.until("the choice", |f| f.selection.is_some());
    rig.send(Command::SetView(ViewMode::PhotonCount));
    let counts = rig.until("the view", |f| f.view == ViewMode::PhotonCount);
    for frame in [&chosen, &counts] {
        assert_eq!((frame.activity, frame.stats.passes), (Activity::Paused, 1));
        assert!(frame.pass_share == paused.pass_share, "no photon is traced meanwhile");
    }
    // It takes effect with the third pass.
    let alpha = SettingChange::Alpha(Alpha::new(0.4).expect("in range"));
    rig.send(Command::Steer(alpha));
    rig.send(Command::SetView(ViewMode::Radiance));
    rig.send(Command::StopAt(StopRule::passes(3)));
    rig.send(Command::Resume);
    let done = rig.done(3);
    assert_eq!(done.render, paused.render);
    let straight = headless(3, long(), |pass, session| {
        if pass == 2 {
            session.render_mut().change(alpha);
        }
    });
    assert_eq!(*image(&done), straight.render().image());
}

#[test]
fn a_step_from_within_a_pass_ends_it() {
    let (rig, _) = paused_in_the_second_pass();
    rig.send(Command::Step);
    let stepped = rig.until("the step", |f| f.activity == Activity::Paused && f.stats.passes > 1);
    assert_eq!((stepped.stats.passes, stepped.pass_share), (2, 0.0));
}

#[test]
fn a_checkpoint_from_within_a_pass_is_of_the_last_whole_one() {
    let folder = Folder::new("within");
    let (rig, paused) = paused_in_the_second_pass();
    let file = folder.0.join("within.ckpt");
    rig.send(Command::KeepCheckpoint(file.clone()));
    assert_eq!(rig.saved(), std::slice::from_ref(&file));
    rig.send(Command::ResumeCheckpoint(file));
    let resumed = rig.until("the checkpoint", |f| f.render != paused.render && f.stats.passes >= 1);
    // A pass that had refined hit points was finished for it.
    assert!((1..=2).contains(&resumed.stats.passes));
    rig.send(Command::StopAt(StopRule::passes(2)));
    rig.send(Command::Resume);
    let done = rig.done(2);
    assert_eq!(*image(&done), headless(2, long(), |_, _| ()).render().image());
}

#[test]
fn undoing_an_edit_brings_the_render_back_as_it_was() {
    let (rig, before) = Rig::at_pass(5);
    rig.send(Command::Choose(Some(BALL)));
    rig.send(Command::StopAt(StopRule::passes(2)));
    rig.send(Command::Edit(SceneEdit::Nudge { steps: [20.0, 0.0], mode: DragMode::Horizontal }));
    let edited = rig.until("the edit", |f| f.render != before.render && f.activity == Activity::Done);
    assert_eq!(edited.stats.passes, 2);
    rig.send(Command::Edit(SceneEdit::Undo));
    // Rendered once more it would stop at two passes.
    let back = rig.until("the render from before", |f| f.render != edited.render && f.stats.passes > 0);
    assert_eq!((back.stats.passes, back.activity), (5, Activity::Done));
    assert_eq!(image(&back), image(&before));
    rig.send(Command::StopAt(StopRule::passes(6)));
    assert_eq!(*image(&rig.done(6)), headless(6, settings(), |_, _| ()).render().image());
    rig.send(Command::Edit(SceneEdit::Redo));
    let again = rig.until("the edited one", |f| f.render > back.render && f.stats.passes > 1);
    assert!(again.stats.passes >= 2 && image(&again) != image(&back));
}

#[test]
fn undo_does_not_end_a_pause() {
    let (rig, _) = paused_in_the_second_pass();
    rig.send(Command::Choose(Some(BALL)));
    let chosen = rig.until("the choice", |f| f.selection.is_some());
    rig.send(Command::Edit(SceneEdit::Nudge { steps: [20.0, 0.0], mode: DragMode::Horizontal }));
    rig.send(Command::Edit(SceneEdit::Undo));
    let back = rig.until("the render from before", |f| f.render > chosen.render + 1 && f.stats.passes == 1);
    assert_eq!((back.activity, back.pass_share), (Activity::Paused, chosen.pass_share));
}

#[test]
fn what_has_no_room_is_not_kept_and_that_is_said() {
    // So many hit points that little else counts: the estimate is then near to what the render takes. The window sums light by path
    // class, too.
    let samples_per_pixel = NonZeroU32::new(16).expect("not zero");
    let settings = RenderSettings { samples_per_pixel, layers: true, ..settings() };
    let scene = Scene::build(&room()).expect("builds");
    let estimate = Session::estimate_memory(&scene, &settings, None).peak_bytes();
    let rig = Rig::new(settings, Some(1.01 * estimate));
    rig.open("room");
    rig.send(Command::StopAt(StopRule::passes(2)));
    let before = rig.done(2);
    rig.send(Command::Choose(Some(BALL)));
    let another =
        |last: &Frame| rig.until("the edit", |f| f.render > last.render && f.activity == Activity::Done);
    let mut last = before.clone();
    for _ in 0..6 {
        rig.send(Command::Edit(SceneEdit::Nudge { steps: [5.0, 0.0], mode: DragMode::Horizontal }));
        last = another(&last);
    }
    rig.hear("that one is gone", |event| match event {
        Event::Notice(text) => text.contains("undo restarts").then_some(()),
        _ => None,
    });
    for _ in 0..6 {
        rig.send(Command::Edit(SceneEdit::Undo));
        last = another(&last);
    }
    assert_eq!(image(&last), image(&before), "kept or not");
}
