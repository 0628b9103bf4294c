//! The engine as a window steers it: commands in, frames and events out. Scenes are made in code; what is compared is bits.

mod checkpoints;
mod edits;
mod history;
mod pausing;
mod regions;
mod rig;
mod rounds;
mod things;

use std::num::NonZeroU32;
use std::path::PathBuf;
use std::time::Duration;

use foton_film::ToneMap;
use foton_integrator::{Method, PpmSettings};
use foton_session::engine::{Activity, Command, Configuration, Event, Picture, SurfaceNames, ViewMode};
use foton_session::findings::{self, FindingKind};
use foton_session::snapshot::{self, Format, Look};
use foton_session::{Alpha, DirectLight, RenderSettings, SettingChange, Shown, StopRule};
use rig::{Folder, Rig, SIZE, headless, identity, image, settings};

fn alpha(alpha: f64) -> Alpha {
    Alpha::new(alpha).expect("an alpha")
}

#[test]
fn a_scene_opens_and_frames_come_until_the_stop_rule() {
    let rig = Rig::new(settings(), None);
    rig.send(Command::StopAt(StopRule::passes(3)));
    rig.open("room");
    let opened = rig.hear("of the scene", |event| match event {
        Event::Opened { name, warnings } => Some((name.clone(), warnings.len())),
        _ => None,
    });
    assert_eq!(opened, ("room.xml".to_owned(), 1));
    let frame = rig.done(3);
    assert_eq!((frame.size, frame.scene.shapes), (SIZE, 2));
    assert_eq!(frame.stats.photons, 4096 + 2 * 8192, "passes grow to what was asked for");
    assert_eq!(*image(&frame), headless(3, settings(), |_, _| ()).render().image());
    // More may be asked for, and time is a rule, too; there is always one pass.
    rig.send(Command::StopAt(StopRule::passes(5)));
    assert_eq!(rig.done(5).render, frame.render);
    rig.send(Command::StopAt(StopRule::time(Duration::from_nanos(1))));
    rig.send(Command::Restart);
    let again = rig.done(1);
    assert_ne!(again.render, frame.render);
}

#[test]
fn alpha_and_photons_change_at_the_next_pass_of_the_same_render() {
    let (rig, before) = Rig::at_pass(2);
    let photons = NonZeroU32::new(20_000).expect("not zero");
    let changes = [SettingChange::Alpha(alpha(0.25)), SettingChange::PhotonsPerPass(photons)];
    for change in changes {
        rig.send(Command::Steer(change));
    }
    rig.send(Command::StopAt(StopRule::passes(4)));
    let after = rig.done(4);
    assert_eq!(after.render, before.render);
    assert_eq!((after.settings.ppm.alpha, after.settings.ppm.photons_per_pass), (alpha(0.25), photons));
    let steered = headless(4, settings(), |pass, session| {
        if pass == 2 {
            changes.into_iter().for_each(|change| session.render_mut().change(change));
        }
    });
    assert_eq!(*image(&after), steered.render().image());
    assert_ne!(
        *image(&after),
        headless(4, settings(), |_, _| ()).render().image(),
        "the changes change something"
    );
}

#[test]
fn a_configuration_restarts_the_render() {
    let (rig, before) = Rig::at_pass(2);
    let configuration = Configuration {
        seed: 5,
        direct_light: DirectLight::ShadowRays,
        radius: Some(0.125),
        threads: Some(1),
        ..Configuration::of(&before.settings, before.threads, None)
    };
    rig.send(Command::Configure(configuration.clone()));
    let after = rig.until("another render", |f| f.render != before.render && f.activity == Activity::Done);
    assert_eq!(Configuration::of(&after.settings, after.threads, after.region), configuration);
    let asked = RenderSettings {
        seed: 5,
        ppm: PpmSettings { direct_light: DirectLight::ShadowRays, radius: Some(0.125), ..settings().ppm },
        ..settings()
    };
    assert_eq!(*image(&after), headless(2, asked, |_, _| ()).render().image());
}

#[test]
fn another_method_restarts_the_render_and_the_first_has_its_bits_when_it_is_back() {
    let (rig, before) = Rig::at_pass(2);
    let ppm = Configuration::of(&before.settings, before.threads, None);
    let path = Configuration { method: Method::Path, samples_per_pixel: NonZeroU32::MIN, ..ppm };
    rig.send(Command::Configure(path));
    let after = rig.until("another render", |f| f.render != before.render && f.activity == Activity::Done);
    assert_eq!(after.settings.method, Method::Path);
    let asked = RenderSettings { method: Method::Path, samples_per_pixel: NonZeroU32::MIN, ..settings() };
    assert_eq!(*image(&after), headless(2, asked, |_, _| ()).render().image());
    rig.send(Command::Configure(ppm));
    let back = rig.until("the first", |f| f.render != after.render && f.activity == Activity::Done);
    assert_eq!(image(&back), image(&before));
}

#[test]
fn a_render_pauses_steps_and_goes_on() {
    let rig = Rig::new(settings(), None);
    rig.open("room");
    rig.until("a pass", |f| f.activity == Activity::Rendering && f.stats.passes > 1);
    rig.send(Command::Pause);
    let paused = rig.until("the pause", |f| f.activity == Activity::Paused);
    let passes = paused.stats.passes;
    // Whatever makes it draw again, no pass comes.
    rig.send(Command::Probe(Some([3, 4])));
    let probed = rig.until("the probe", |f| f.probe.is_some());
    assert_eq!((probed.activity, probed.stats.passes), (Activity::Paused, passes));
    for step in 1..=2 {
        rig.send(Command::Step);
        let stepped = rig.until("a step", |f| f.activity == Activity::Paused && f.stats.passes > passes);
        assert_eq!(stepped.stats.passes, passes + step);
    }
    rig.send(Command::Resume);
    let on = rig.until("it going on", |f| f.activity == Activity::Rendering && f.stats.passes > passes + 3);
    assert_eq!(on.render, paused.render);
}

#[test]
fn a_snapshot_is_the_file_that_a_headless_render_writes() {
    let folder = Folder::new("snapshot");
    let (rig, _) = Rig::at_pass(3);
    rig.send(Command::Snapshot(folder.0.clone()));
    rig.send(Command::Snapshot(folder.0.clone()));
    let names = |stem: &str| ["exr", "png"].map(|e| folder.0.join(format!("{stem}.{e}"))).to_vec();
    assert_eq!(rig.saved(), names("room-001-p000003"));
    assert_eq!(rig.saved(), names("room-001-p000003-2"), "nothing is written over");
    let session = headless(3, settings(), |_, _| ());
    let same = |look, of: &str| {
        for (extension, format) in [("exr", Format::Exr), ("png", Format::Png)] {
            let expected = folder.0.join("expected").with_extension(extension);
            snapshot::write(&expected, format, (session.render(), &Shown::All), &[], look, &identity())
                .expect("written");
            let read = |path: PathBuf| std::fs::read(path).expect("it is there");
            assert!(read(folder.0.join(format!("{of}.{extension}"))) == read(expected), "{of}.{extension}");
        }
    };
    same(Look::default(), "room-001-p000003");
    // As shown: the PNG has the exposure and the tone map of the screen, and the EXR stays linear.
    let look = Look { tone_map: ToneMap::AgX, exposure_stops: 1.5 };
    rig.send(Command::SetLook(look));
    rig.send(Command::Snapshot(folder.0.join("made/when needed")));
    let made = "made/when needed/room-001-p000003";
    assert_eq!(rig.saved(), names(made));
    same(look, made);
    let metadata = png_text(&folder.0.join(format!("{made}.png")));
    assert!(metadata.contains("exposure=1.5 tone_map=agx"), "{metadata}");
    rig.send(Command::Snapshot(folder.0.join("expected.png/no folder")));
    assert!(rig.failure().contains("expected.png/no folder for pictures"));
}

/// The bytes of a PNG's texts, as far as they are letters.
fn png_text(path: &std::path::Path) -> String {
    String::from_utf8_lossy(&std::fs::read(path).expect("it is there")).into_owned()
}

#[test]
fn snapshots_come_by_themselves_at_powers_of_two_and_no_run_writes_over_another() {
    let folder = Folder::new("powers");
    // Somebody's, from an earlier day, by the name that the first run would have had.
    let earlier = folder.0.join("room-001-p000002.png");
    std::fs::write(&earlier, "somebody's").expect("written");
    let rig = Rig::new(settings(), None);
    rig.send(Command::AutoSnapshots(Some(folder.0.clone())));
    rig.send(Command::StopAt(StopRule::passes(5)));
    rig.open("room");
    let saves = |run: u32| {
        for pass in [1, 2, 4] {
            assert_eq!(rig.saved()[0], folder.0.join(format!("room-{run:03}-p{pass:06}.exr")));
        }
        rig.done(5);
    };
    saves(2);
    let before = std::fs::read(folder.0.join("room-002-p000004.exr")).expect("there");
    rig.send(Command::Configure(Configuration { seed: 9, ..Configuration::of(&settings(), None, None) }));
    saves(3);
    rig.open("room");
    saves(4);
    assert_eq!(std::fs::read_dir(&folder.0).expect("there").count(), 3 * 6 + 1);
    assert!(std::fs::read(folder.0.join("room-002-p000004.exr")).expect("there") == before);
    assert_eq!(std::fs::read_to_string(&earlier).expect("there"), "somebody's");
}

#[test]
fn a_scene_that_fails_leaves_the_last_one_running() {
    let rig = Rig::new(settings(), None);
    rig.open("room");
    let before = rig.until("a pass", |f| f.activity == Activity::Rendering);
    rig.open("ruin");
    assert_eq!(rig.failure(), "ruin:3:7: there is no such scene");
    let after = rig.until("more passes", |f| f.stats.passes > before.stats.passes + 1 && f.opening.is_none());
    assert_eq!((after.render, &after.scene.name), (before.render, &before.scene.name));
}

#[test]
fn a_fault_of_our_own_is_said_the_picture_stays_and_the_next_scene_opens() {
    let rig = Rig::new(settings(), None);
    rig.open("room");
    let before = rig.until("a pass", |f| f.activity == Activity::Rendering && f.picture.is_some());
    rig.open("faulty");
    assert_eq!(rig.failure(), "faulty: foton has a fault: this loader has a fault");
    rig.until("more passes", |f| f.stats.passes > before.stats.passes);
    rig.open("sensorless");
    assert!(rig.failure().starts_with("foton has a fault and the render stops"));
    rig.open("room");
    rig.until("passes again", |f| f.activity == Activity::Rendering && f.stats.passes > 1);
}

#[test]
fn opening_can_be_called_off_and_passes_go_on_meanwhile() {
    let rig = Rig::new(settings(), None);
    rig.open("room");
    rig.until("a pass", |f| f.activity == Activity::Rendering);
    rig.open("slow");
    let opening = rig.until("the opening", |f| f.opening.as_deref() == Some("slow"));
    let later = rig.until("more passes", |f| f.stats.passes > opening.stats.passes);
    rig.send(Command::CancelOpen);
    let off = rig.until("it called off", |f| f.opening.is_none());
    rig.go.send(()).expect("it waits");
    let after = rig.until("more passes", |f| f.stats.passes > off.stats.passes + 1);
    assert_eq!((after.render, after.opening), (later.render, None));
}

#[test]
fn a_scene_that_is_opened_is_given_up_for_another_when_called_off_and_at_the_end() {
    let rig = Rig::new(settings(), None);
    let patience = Duration::from_secs(120);
    let given_up = rig.given_up.clone();
    let opening = |what: &str| rig.until(what, |f| f.opening.as_deref() == Some("endless"));
    rig.open("endless");
    opening("the first");
    rig.send(Command::CancelOpen);
    given_up.recv_timeout(patience).expect("called off");
    rig.open("endless");
    opening("the second");
    rig.open("room");
    given_up.recv_timeout(patience).expect("another is opened");
    rig.until("a pass", |f| f.activity == Activity::Rendering);
    rig.open("endless");
    opening("the third");
    drop(rig);
    given_up.recv_timeout(patience).expect("the engine ends");
}

#[test]
fn renders_that_would_not_fit_are_refused_and_smaller_ones_are_not() {
    let rig = Rig::new(settings(), Some(1e4));
    rig.open("room");
    let text = rig.failure();
    assert!(text.contains("MiB may be used"), "{text}");
}

/// A small picture of it answers all the same, and the next scene opens.
#[test]
fn an_image_of_32768_by_32768_is_refused_with_the_numbers() {
    let rig = Rig::new(settings(), Some(64e9));
    rig.open("vast");
    let text = rig.failure();
    assert!(text.contains("M hit points") && text.contains("61035 MiB may be used"), "{text}");
    rig.send(Command::StopAt(StopRule::passes(1)));
    rig.open("room");
    rig.done(1);
}

/// Light that is cut off, a light that nothing seen gets, a goal beyond reach: frames carry what the console prints.
#[test]
fn frames_carry_what_the_console_warns_of() {
    let (rig, before) = Rig::at_pass(2);
    assert_eq!(before.scene.warnings[0], "room.xml:1:1: a warning");
    let now = Configuration::of(&before.settings, before.threads, None);
    rig.send(Command::Configure(Configuration { max_depth: Some(2), radius: Some(1e6), ..now }));
    let frame = rig.until("less depth", |f| f.activity == Activity::Done && f.settings.max_depth == Some(2));
    let headless = headless(2, frame.settings.clone(), |_, _| ());
    let names = &findings::SettingNames::CONTROLS;
    let mut console = findings::of_settings(headless.render().scene(), &frame.settings, names);
    console.extend(findings::of_ledger(headless.render(), names));
    console.extend(findings::of_emitters(headless.render()));
    assert_eq!(*frame.stats.findings, console);
    let kinds: Vec<FindingKind> = console.iter().map(|finding| finding.kind).collect();
    assert!(
        kinds.contains(&FindingKind::PowerCutOff) && kinds.contains(&FindingKind::RadiusBeyondScene),
        "{kinds:?}"
    );
}

#[test]
fn measures_and_kinds_of_light_are_shown_instead_of_radiance() {
    let (rig, before) = Rig::at_pass(2);
    for view in [ViewMode::Radius, ViewMode::PhotonCount, ViewMode::Luminance, ViewMode::Unknown] {
        rig.send(Command::SetView(view));
        let frame = rig.until("a measure", |f| f.view == view);
        let Some(Picture::Measure { plane, .. }) = &frame.picture else { panic!("{view:?} in colours") };
        assert!(plane.values.iter().any(|v| *v > 0.0), "{view:?}");
        assert_eq!(frame.render, before.render);
    }
    // Kinds of light are there from the first pass on, of whole and small pictures, and cost the radiance no bit.
    assert_eq!(*image(&before), headless(2, settings(), |_, _| ()).render().image());
    let one = |i: usize| ViewMode::Classes { reflected: std::array::from_fn(|k| k == i), emission: false };
    let mut sum = vec![0.0; image(&before).pixels.len()];
    for i in 0..3 {
        rig.send(Command::SetView(one(i)));
        let frame = rig.until("a kind of light", |f| f.view == one(i) && f.activity == Activity::Done);
        let kind = image(&frame);
        assert_eq!(frame.render, before.render, "a view restarts nothing");
        assert!(i == 2 || kind.pixels.iter().any(|c| c.luminance() > 0.0), "kind {i}");
        sum.iter_mut().zip(&kind.pixels).for_each(|(s, c)| *s += f64::from(c.luminance()));
    }
    for (s, c) in sum.iter().zip(&image(&before).pixels) {
        let all = f64::from(c.luminance());
        assert!((s - all).abs() <= 1e-4 * all.max(1e-3), "{s} is not {all}");
    }
}

#[test]
fn the_probe_says_what_the_picture_shows() {
    let (rig, _) = Rig::at_pass(2);
    rig.send(Command::ShowPhotons(true));
    let floor = [90, 110];
    rig.send(Command::Probe(Some(floor)));
    let frame = rig.until("the probe", |f| f.probe.is_some() && !f.dots.is_empty());
    let probe = frame.probe.as_ref().expect("asked for");
    let index = floor[1] as usize * SIZE[0] as usize + floor[0] as usize;
    assert_eq!(probe.radiance, image(&frame).pixels[index]);
    assert_eq!(probe.surface, Some(SurfaceNames { shape: "floor".into(), material: "grey".into() }));
    assert!(probe.hit_points == 1 && probe.disc.len() > 8 && probe.radius.is_some_and(|r| r > 0.0));
    assert!(probe.paths.is_empty(), "not asked for");
    rig.send(Command::ShowPaths(true));
    // Few pixels have gathered a photon of the last pass.
    let mut columns = 40..SIZE[0];
    let (with, pixel) = std::iter::from_fn(|| {
        let pixel = [columns.next()?, floor[1]];
        rig.send(Command::Probe(Some(pixel)));
        Some((rig.until("its probe", |f| f.probe.as_ref().is_some_and(|p| p.pixel == pixel)), pixel))
    })
    .find(|(frame, _)| frame.probe.as_ref().is_some_and(|probe| !probe.paths.is_empty()))
    .expect("a pixel with paths");
    assert_eq!((image(&with), with.render), (image(&frame), frame.render), "the picture is the same");
    for path in with.probe.as_ref().expect("asked for").paths.iter() {
        let [_, end] = *path.edges.last().expect("an edge");
        let off = [0, 1].map(|axis| (end[axis] - pixel[axis] as f32 - 0.5).abs());
        assert!(off.iter().all(|d| *d < 12.0), "{path:?} ends at the disc");
    }
    rig.send(Command::ShowPaths(false));
    rig.until("no paths", |f| f.probe.as_ref().is_some_and(|p| p.paths.is_empty()));
    rig.send(Command::Probe(Some([9999, 0])));
    rig.until("nothing outside", |f| f.probe.is_none());
}

#[test]
fn dropping_the_engine_ends_its_thread_without_the_pass_under_way() {
    let long = NonZeroU32::new(1 << 22).expect("not zero");
    let rig = Rig::new(
        RenderSettings {
            ppm: PpmSettings { photons_per_pass: long, first_pass: long, ..settings().ppm },
            ..settings()
        },
        None,
    );
    rig.open("room");
    // The small picture is there, and the first whole pass, of seconds, has begun or is about to.
    rig.until("first light", |f| f.activity == Activity::Collecting && f.picture.is_some());
    let Rig { engine, thread, .. } = rig;
    let frames = engine.frames().clone();
    drop(engine);
    let last = std::iter::from_fn(|| frames.recv_timeout(Duration::from_secs(120)).ok()).last();
    // On a busy machine the thread may still be on its way out after it let go of the frames.
    while thread.recv_timeout(Duration::from_secs(120)).is_ok() {}
    assert!(thread.try_recv().is_err_and(|e| e == crossbeam_channel::TryRecvError::Disconnected));
    assert!(last.is_none_or(|f| f.activity == Activity::Collecting), "the pass was finished first");
}
