//! What a checkpoint must share with the render that resumes it, and when it is written.

use std::num::NonZeroU32;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use foton_integrator::{Cancel, PpmSettings, RenderSettings};
use foton_math::Rgb;

use super::identity::difference;
use super::*;
use crate::test_scene::discs;

fn session(passes: u64) -> Session {
    let cancel = Cancel::default();
    let photons_per_pass = NonZeroU32::new(1000).expect("not zero");
    let ppm = PpmSettings { photons_per_pass, ..PpmSettings::default() };
    let settings = RenderSettings { ppm, ..RenderSettings::default() };
    let scene = Arc::new(discs(Some(Rgb::WHITE)));
    let mut session = Session::start(scene, settings, Some(1), &cancel).expect("not cancelled");
    for _ in 0..passes {
        session.advance(&cancel).expect("a pass");
    }
    session
}

fn identity() -> SceneIdentity {
    SceneIdentity { name: "discs".into(), hash: 7 }
}

/// Passes of a checkpoint.
fn passes(path: &Path) -> u64 {
    let mut session = session(0);
    resume(path, &mut session, &identity(), false).expect("of the discs");
    session.render().passes()
}

#[test]
fn a_state_that_could_not_be_written_is_written_at_the_end() {
    let folder = std::env::temp_dir().join(format!("foton-keeper-{}", std::process::id()));
    let path = folder.join("discs.checkpoint");
    let session = session(2);
    let mut keeper = Keeper::new(&path, identity(), Duration::ZERO, Duration::ZERO);
    assert!(keeper.is_due(session.elapsed()));
    assert!(keeper.write(session.render(), session.elapsed(), session.rays()).is_err(), "there is no folder");
    std::fs::create_dir(&folder).expect("a folder");
    keeper.write_last(&session).expect("written");
    assert_eq!(passes(&path), 2);
    // The file has this state: it is not written again.
    std::fs::remove_file(&path).expect("ours");
    keeper.write_last(&session).expect("nothing to write");
    assert!(!path.exists());
    std::fs::remove_dir(&folder).expect("empty");
}

#[test]
fn what_differs_is_said_by_name() {
    let stored = "scene=12\nseed=7\nspp=2\nhit points=5\n";
    let said = |here: &str| difference(stored, here);
    assert_eq!(said(stored), None);
    let seed = "was made with seed 7, not 0, which cannot change on the way";
    assert_eq!(said("scene=12\nseed=0\nspp=2\nhit points=5\n").as_deref(), Some(seed));
    let both = "was made with seed 7, not 0; spp 2, not 4, which cannot change on the way";
    assert_eq!(said("scene=12\nseed=0\nspp=4\nhit points=9\n").as_deref(), Some(both));
    let points = "was made with hit points 5, not 9, which cannot change on the way";
    assert_eq!(said("scene=12\nseed=7\nspp=2\nhit points=9\n").as_deref(), Some(points));
    assert!(said("scene=13\nseed=0\nspp=2\nhit points=5\n").is_some_and(|s| s.contains("another scene")));
    assert_eq!(said("").as_deref(), Some("is of another render"));
}
