//! Eye samples in rounds: a whole picture is there before all of them are followed, and no bit of what comes after is another for that.

use std::num::NonZeroU32;

use foton_integrator::{PpmSettings, RenderSettings};
use foton_session::engine::{Activity, Command};
use foton_session::{SettingChange, StopRule};

use crate::alpha;
use crate::rig::{Rig, SIZE, headless, image, settings};

/// So many eye samples that they come in rounds.
fn many() -> RenderSettings {
    let samples_per_pixel = NonZeroU32::new(20).expect("not zero");
    RenderSettings { samples_per_pixel, error: true, ..settings() }
}

#[test]
fn all_pixels_are_seen_before_all_samples_are_followed_and_the_whole_has_the_bits_of_one_without() {
    let rig = Rig::new(many(), None);
    rig.send(Command::StopAt(StopRule::passes(3)));
    rig.open("room");
    let early = rig.until("a picture of all pixels", |f| {
        f.picture.is_some() && f.pictured == f.render && [image(f).width, image(f).height] == SIZE
    });
    assert_eq!((early.activity, early.stats.passes), (Activity::Collecting, 0), "it is not the whole");
    let share = rig.until("how far it is", |f| f.collecting.is_some());
    assert!(
        share.collecting.is_some_and(|share| share >= 1.0 / 20.0),
        "of all samples: {:?}",
        share.collecting
    );
    let frame = rig.done(3);
    let straight = headless(3, many(), |_, _| ());
    assert!(*image(&frame) == straight.render().image());
    assert_eq!(frame.stats.error, straight.render().error());
    assert_eq!(frame.stats.hit_points, straight.render().start_report().hit_points);
}

#[test]
fn what_is_changed_while_samples_are_followed_is_changed_from_the_first_pass_on() {
    let rig = Rig::new(many(), None);
    rig.send(Command::StopAt(StopRule::passes(2)));
    rig.open("room");
    rig.until("a round", |f| f.activity == Activity::Collecting && f.collecting.is_some());
    rig.send(Command::Steer(SettingChange::Alpha(alpha(0.3))));
    let frame = rig.done(2);
    let ppm = PpmSettings { alpha: alpha(0.3), ..many().ppm };
    let straight = headless(2, RenderSettings { ppm, ..many() }, |_, _| ());
    assert!(*image(&frame) == straight.render().image());
}
