//! Skies of new and old files: which way is up, and where the sun is.

use std::f64::consts::PI;

use foton_format::{Options, read_str};
use foton_math::glam::DVec3;
use foton_scene::description::EmitterKind;

use super::files;

/// The direction in the world from which most light comes.
fn brightest(version: &str, emitter: &str) -> DVec3 {
    let xml = format!("<scene version='{version}'><sensor type='perspective'/>{emitter}</scene>");
    let opened = read_str("s.xml", &xml, &files, &Options::default()).unwrap_or_else(|e| panic!("{e}"));
    let EmitterKind::Environment { to_world, bitmap, .. } = &opened.description.emitters[0].kind else {
        panic!("a sky is an environment")
    };
    let all = bitmap.pixels.iter().enumerate();
    let (index, _) = all.max_by(|(_, a), (_, b)| a.g.total_cmp(&b.g)).expect("pixels");
    let (x, y) = (index as u32 % bitmap.width, index as u32 / bitmap.width);
    let theta = PI * f64::from(y) / f64::from(bitmap.height - 1);
    let phi = 2.0 * PI * (f64::from(x) + 0.5) / f64::from(bitmap.width);
    to_world.matrix3 * DVec3::new(phi.sin() * theta.sin(), theta.cos(), -phi.cos() * theta.sin())
}

#[test]
fn the_sun_stands_in_the_direction_that_the_file_says() {
    let wanted = DVec3::new(1.0, -2.0, 3.0).normalize();
    for plugin in ["sunsky", "sun"] {
        let new =
            format!("<emitter type='{plugin}'><vector name='sun_direction' x='1' y='-2' z='3'/></emitter>");
        assert!(brightest("3.0.0", &new).angle_between(wanted) < 0.01, "{plugin}");
        let turned = new.replace(
            "</emitter>",
            "<transform name='to_world'><rotate z='1' angle='70'/></transform></emitter>",
        );
        assert!(brightest("3.0.0", &turned).angle_between(wanted) < 0.01, "{plugin}, turned");
        // In old files +y is up.
        let old =
            format!("<emitter type='{plugin}'><vector name='sunDirection' x='1' y='3' z='2'/></emitter>");
        let wanted = DVec3::new(1.0, 3.0, 2.0).normalize();
        assert!(brightest("0.6.0", &old).angle_between(wanted) < 0.01, "{plugin} of old");
    }
    // In the afternoon of Tokyo's July: Mitsuba 3.9.1 prints this as `sun_direction`.
    let afternoon = brightest("3.0.0", "<emitter type='sunsky'/>");
    assert!(afternoon.angle_between(DVec3::new(0.051_385_4, 0.691_748, 0.720_308)) < 0.01, "{afternoon}");
}
