//! A render that is taken up from a checkpoint has the bits of one that was never stopped; nothing else is taken up.

use std::fs;
use std::num::NonZeroU32;
use std::path::PathBuf;
use std::time::Duration;

use foton_integrator::{
    Alpha, Cancel, DirectLight, LayerKind, Method, PpmSettings, RadiusRule, Render, RenderSettings,
    SettingChange,
};
use foton_math::glam::DVec3;
use foton_session::checkpoint::{self, ResumeError};
use foton_session::{SceneIdentity, Session};
use foton_tests::{Sketch, glass, grey};

fn scene() -> Sketch {
    Sketch::default()
        .camera(DVec3::new(0.0, 0.0, 0.95), DVec3::new(0.0, -0.2, -1.0), 70.0, 24)
        .room(grey(0.6), None)
        .sphere(DVec3::new(0.4, -0.6, 0.0), 0.35, glass(1.5), None)
        .point(DVec3::new(0.7, 0.7, 0.7), 2.0)
}

fn settings() -> RenderSettings {
    let number = |n| NonZeroU32::new(n).expect("above 0");
    RenderSettings {
        samples_per_pixel: number(2),
        error: true,
        ppm: PpmSettings {
            photons_per_pass: number(5000),
            first_pass: number(1000),
            ..PpmSettings::default()
        },
        ..RenderSettings::default()
    }
}

fn identity() -> SceneIdentity {
    SceneIdentity { name: "sketch".into(), hash: 7 }
}

fn start(settings: &RenderSettings, threads: usize) -> Session {
    let scene = scene().build().expect("sound");
    Session::start(scene, settings.clone(), Some(threads), &Cancel::default()).expect("starts")
}

fn advance(session: &mut Session, passes: u64) {
    for _ in 0..passes {
        session.advance(&Cancel::default()).expect("not cancelled");
    }
}

fn path(name: &str) -> PathBuf {
    std::env::temp_dir().join(format!("foton-{}-{name}.checkpoint", std::process::id()))
}

fn keep(session: &Session, name: &str) -> PathBuf {
    let path = path(name);
    checkpoint::write(&path, session.render(), session.elapsed(), session.rays(), &identity())
        .expect("written");
    path
}

fn bits(render: &Render) -> (Vec<u8>, Vec<[u32; 3]>) {
    let image = render.image();
    (render.save(), image.pixels.iter().map(|p| p.to_array().map(f32::to_bits)).collect())
}

#[test]
fn a_render_that_was_taken_up_has_the_bits_of_one_that_never_stopped() {
    let settings = settings();
    let others = [
        settings.clone(),
        RenderSettings {
            layers: true,
            ppm: PpmSettings { direct_light: DirectLight::ShadowRays, ..settings.ppm },
            ..settings.clone()
        },
        RenderSettings {
            ppm: PpmSettings { radius_rule: RadiusRule::Adaptive, ..settings.ppm },
            ..settings.clone()
        },
        RenderSettings {
            method: Method::Sppm,
            layers: true,
            ppm: PpmSettings { direct_light: DirectLight::ShadowRays, ..settings.ppm },
            ..settings
        },
    ];
    for (i, settings) in others.into_iter().enumerate() {
        let mut whole = start(&settings, 2);
        advance(&mut whole, 3);
        whole.render_mut().change(SettingChange::Alpha(Alpha::new(0.9).expect("in range")));
        whole.render_mut().change(SettingChange::PhotonsPerPass(NonZeroU32::new(7000).expect("above 0")));
        advance(&mut whole, 2);
        let path = keep(&whole, &format!("whole-{i}"));
        let (elapsed, rays) = (whole.elapsed(), whole.rays());
        advance(&mut whole, 4);
        let mut taken_up = start(&settings, 1);
        checkpoint::resume(&path, &mut taken_up, &identity(), false).expect("taken up");
        assert_eq!((taken_up.elapsed(), taken_up.rays()), (elapsed, rays));
        assert_eq!(taken_up.render().changes(), whole.render().changes());
        if settings.method == Method::Sppm {
            // The hit points of the last pass are followed again, to be shown.
            assert!((0..24 * 24).any(|pixel| !taken_up.render().discs(pixel).is_empty()));
        }
        advance(&mut taken_up, 4);
        // How many photons start where no disc is may differ, since cells are marked anew; no sum may.
        let (whole, taken_up) = (bits(whole.render()), bits(taken_up.render()));
        assert!(whole.1 == taken_up.1, "the images are equal");
        assert_eq!(whole.0.len(), taken_up.0.len());
        let _ = fs::remove_file(path);
    }
}

/// Light by path class is beside the rest: with it or without, a state goes on with the same image.
#[test]
fn a_state_with_light_by_class_goes_on_without_and_the_other_way_round() {
    let with = |layers| RenderSettings { layers, ..settings() };
    let resumed = |from: bool, to: bool, needs_classes| {
        let mut session = start(&with(from), 2);
        advance(&mut session, 2);
        let path = keep(&session, &format!("classes-{from}-{to}-{needs_classes}"));
        let mut taken_up = start(&with(to), 2);
        let result = checkpoint::resume(&path, &mut taken_up, &identity(), needs_classes);
        let _ = fs::remove_file(path);
        result.map(|()| {
            advance(&mut taken_up, 2);
            taken_up
        })
    };
    let mut straight = start(&with(true), 2);
    advance(&mut straight, 4);
    let caustic = |session: &Session| session.render().colour_layer(LayerKind::Caustic);
    for (from, to) in [(true, false), (false, true), (true, true)] {
        let session = resumed(from, to, false).expect("taken up");
        assert_eq!(session.render().image(), straight.render().image(), "{from} {to}");
        let photons = session.render().photons_by_class();
        let all = session.render().photons_emitted();
        let counted = [None, Some(all)][usize::from(to)];
        if from {
            assert_eq!(photons, counted);
        } else {
            assert!(photons.is_some_and(|n| n > 0 && n < all), "{photons:?} of {all}");
        }
        assert!(!(from && to) || caustic(&session) == caustic(&straight));
    }
    assert!(resumed(true, true, true).is_ok());
    let refused = resumed(false, true, true).map(|_| ()).expect_err("it has none");
    assert!(refused.to_string().contains("kinds of light summed, not kept apart"), "{refused}");
}

#[test]
fn other_scenes_settings_and_versions_and_damaged_files_are_refused() {
    let mut session = start(&settings(), 2);
    advance(&mut session, 2);
    let path = keep(&session, "refused");
    let bytes = fs::read(&path).expect("there");
    let try_with = |settings: &RenderSettings, scene: &SceneIdentity| {
        checkpoint::resume(&path, &mut start(settings, 1), scene, false)
    };
    let other = RenderSettings { seed: 1, ..settings() };
    assert!(matches!(try_with(&other, &identity()), Err(ResumeError::OtherRender { .. })));
    let scene = SceneIdentity { hash: 8, ..identity() };
    assert!(matches!(try_with(&settings(), &scene), Err(ResumeError::OtherRender { .. })));
    // α and photons a pass may change while it runs: they come from the checkpoint.
    let steered = RenderSettings {
        ppm: PpmSettings { alpha: Alpha::new(0.5).expect("in range"), ..settings().ppm },
        ..settings()
    };
    assert!(try_with(&steered, &identity()).is_ok());

    let damage = |bytes: &[u8]| {
        fs::write(&path, bytes).expect("written");
        try_with(&settings(), &identity())
    };
    for at in (0..bytes.len()).step_by(bytes.len() / 97 + 1) {
        let mut bad = bytes.clone();
        bad[at] ^= 0x10;
        assert!(damage(&bad).is_err(), "byte {at}");
        assert!(damage(&bytes[..at]).is_err(), "cut at {at}");
    }
    assert!(matches!(damage(b"<scene/>"), Err(ResumeError::NoCheckpoint { .. })));
    let mut newer = bytes.clone();
    newer[8] = 99;
    assert!(matches!(damage(&newer), Err(ResumeError::Version { found: 99, .. })));
    assert!(damage(&bytes).is_ok());
    let _ = fs::remove_file(&path);
    assert!(matches!(try_with(&settings(), &identity()), Err(ResumeError::Read { .. })));
    assert!(session.elapsed() > Duration::ZERO);
}
