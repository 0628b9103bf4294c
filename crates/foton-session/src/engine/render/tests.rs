//! Eye samples are followed once, whatever is looked at in between; the better picture is shown.

use std::num::NonZeroU32;
use std::sync::Mutex;

use super::*;
use crate::test_scene::discs;
use crate::threads::{Rank, pool};

#[test]
fn a_level_goes_on_with_the_samples_of_the_one_before() {
    let samples_per_pixel = NonZeroU32::new(8).expect("not zero");
    let settings = RenderSettings { samples_per_pixel, ..RenderSettings::default() };
    let pool = pool(Some(2), Rank::Equal).expect("threads");
    let told = Mutex::new(Vec::new());
    let tell = |share: f64| told.lock().expect("whole").push(share);
    let collect = |level, followed| {
        LevelRender::collect(level, followed, &pool, &tell, &Cancel::default()).expect("not cancelled")
    };
    let mut some = collect(Level::Samples(2), Followed::none(Arc::new(discs(None)), settings));
    assert!(told.lock().expect("whole").drain(..).all(|share| share <= 2.0 / 8.0));
    let followed = some.take_followed().expect("they are kept");
    assert_eq!(followed.share(), 2.0 / 8.0);
    let took = followed.took;
    let whole = collect(Level::Whole, followed);
    assert!(told.lock().expect("whole").iter().all(|&share| share > 2.0 / 8.0), "none is followed again");
    assert!(
        whole.elapsed() > took && whole.session().stages().of(Stage::EyePass) > took,
        "all of the time counts"
    );
    let [of_some, of_all] = [&some, &whole].map(|level| level.render().start_report().hit_points);
    assert_eq!(4 * of_some, of_all);
}

/// As measured in the default scene: of passes 1 to 8 the seventh is the first with less error than the round before.
#[test]
fn a_picture_is_shown_once_it_is_better_than_the_one_before() {
    let round = Standing { unlit: 0.0127, found: 25.6 };
    let passes =
        [(0.83, 0.23), (0.64, 0.65), (0.46, 1.4), (0.30, 2.9), (0.16, 5.7), (0.098, 8.3), (0.063, 10.8)];
    let beats = passes.map(|(unlit, found)| Standing { unlit, found }.beats(round));
    assert_eq!(beats, [false, false, false, false, false, false, true]);
    let small = Standing { unlit: 0.05, found: 0.0 };
    assert!(Standing { unlit: 0.063, found: 0.1 }.beats(small), "photons of another size say nothing");
}
