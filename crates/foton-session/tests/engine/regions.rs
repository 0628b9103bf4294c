//! Renders of a part of the image.

use std::sync::Arc;

use foton_film::Image;
use foton_integrator::Cancel;
use foton_scene::Scene;
use foton_session::Session;
use foton_session::engine::{Command, Configuration, Region};

use crate::rig::{BALL, Folder, Rig, SIZE, image, room, settings};

/// The image of a room of which a part is rendered, as `foton render --region` makes it.
fn headless_region(region: Region, passes: u64) -> Image {
    let mut room = room();
    room.sensors[0].show_only(region).expect("inside");
    let scene = Arc::new(Scene::build(&room).expect("builds"));
    let cancel = Cancel::default();
    let mut session = Session::start(scene, settings(), Some(1), &cancel).expect("starts");
    for _ in 0..passes {
        session.advance(&cancel).expect("nobody cancels");
    }
    session.render().image()
}

#[test]
fn a_region_is_rendered_alone_where_it_lies_as_without_a_window() {
    let folder = Folder::new("region");
    let (rig, before) = Rig::at_pass(2);
    assert_eq!((before.window.width, before.window.height, before.region), (SIZE[0], SIZE[1], None));
    let region = Region { x: 70, y: 90, width: 40, height: 24 };
    let configure = |region| {
        let now = Configuration::of(&before.settings, before.threads, region);
        rig.send(Command::Configure(now));
    };
    configure(Some(region));
    let frame = rig.done(2);
    assert_eq!((frame.size, frame.window, frame.region), (SIZE, region, Some(region)));
    assert!(*image(&frame) == headless_region(region, 2), "the same bits, on any number of threads");
    assert!(frame.stats.hit_points < before.stats.hit_points / 10, "{}", frame.stats.hit_points);
    // Pixels are those of the whole image, for the pointer as for clicks.
    rig.send(Command::Probe(Some([90, 110])));
    let probe = rig.until("the probe", |f| f.probe.is_some()).probe.expect("there");
    assert_eq!(probe.radiance, image(&frame).pixels[(20 * region.width + 20) as usize]);
    assert_eq!(probe.surface.map(|names| names.shape).as_deref(), Some("floor"));
    rig.send(Command::Choose(Some(BALL)));
    let chosen = rig.until("a choice", |f| f.selection.is_some()).selection.expect("there");
    assert_eq!(chosen.inspection.title, "ball");
    rig.send(Command::Snapshot(folder.0.clone()));
    let (_, metadata) = foton_film::read_exr(&rig.saved()[0]).expect("an EXR");
    let settings = metadata.get("foton:settings").expect("there");
    assert!(settings.ends_with("region=70,90,40,24 of=180x120"), "{settings}");
    // It belongs to no file, and what is no part of the image is refused.
    assert!(!frame.scene.is_edited);
    configure(Some(Region { x: 170, ..region }));
    assert!(rig.failure().contains("the region 170,90,40,24 is not inside the image of 180 x 120 pixels"));
    assert_eq!(rig.done(2).region, Some(region));
    configure(None);
    let whole = rig.done(2);
    assert!(whole.window == before.window && image(&whole) == image(&before));
}

#[test]
fn a_checkpoint_of_a_region_is_of_that_region() {
    let folder = Folder::new("region-checkpoint");
    let path = folder.0.join("room.checkpoint");
    let (rig, before) = Rig::at_pass(2);
    let configure = |region| {
        rig.send(Command::Configure(Configuration::of(&before.settings, before.threads, region)));
        rig.done(2)
    };
    let region = Region { x: 70, y: 90, width: 40, height: 24 };
    configure(Some(region));
    rig.send(Command::KeepCheckpoint(path.clone()));
    rig.saved();
    configure(Some(Region { x: 71, ..region }));
    rig.send(Command::ResumeCheckpoint(path));
    let said = rig.failure();
    assert!(said.contains("size 40x24 at 70,90 of 180x120, not 40x24 at 71,90 of 180x120"), "{said}");
}
