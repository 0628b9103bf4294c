//! A cut stone: the facets of a round brilliant, each flat.

use std::f64::consts::FRAC_PI_8;

use super::lathe::around;
use super::mesh::Mesh;

/// A round brilliant of radius 1 with its girdle about y = 0: table up, culet down.
///
/// The eight kites of the crown and of the pavilion are flat because the middle corner of each lies on the plane
/// through its two end corners that is symmetric about the kite's axis.
pub(super) fn gem() -> Mesh {
    const TABLE: f64 = 0.56;
    const CROWN_SLOPE: f64 = 0.7;
    const PAVILION_SLOPE: f64 = 0.863;
    const GIRDLE: f64 = 0.025;
    let corner = |r: f64, y: f64, eighths: usize| around(r, y, FRAC_PI_8 * eighths as f64);
    let height = |from: f64, slope: f64, r: f64| from + slope * (1.0 - r * FRAC_PI_8.cos());
    let star = |i| corner(0.8, height(GIRDLE, CROWN_SLOPE, 0.8), i);
    let table = |i| corner(TABLE, GIRDLE + CROWN_SLOPE * (1.0 - TABLE), i);
    let lower = |i| corner(0.3, height(-GIRDLE, -PAVILION_SLOPE, 0.3), i);
    let upper_girdle = |i| corner(1.0, GIRDLE, i);
    let lower_girdle = |i| corner(1.0, -GIRDLE, i);
    let culet = [0.0, -GIRDLE - PAVILION_SLOPE, 0.0];

    let mut gem = Mesh::default();
    gem.flat_face(&[0, 14, 12, 10, 8, 6, 4, 2].map(table));
    for i in (0..16).step_by(2) {
        let [before, next, after] = [(i + 15) % 16, i + 1, (i + 2) % 16];
        gem.flat_face(&[table(i), table(after), star(next)]);
        gem.flat_face(&[table(i), star(next), upper_girdle(i), star(before)]);
        gem.flat_face(&[upper_girdle(i), star(next), upper_girdle(next)]);
        gem.flat_face(&[upper_girdle(next), star(next), upper_girdle(after)]);
        gem.flat_face(&[lower_girdle(i), upper_girdle(i), upper_girdle(next), lower_girdle(next)]);
        gem.flat_face(&[lower_girdle(next), upper_girdle(next), upper_girdle(after), lower_girdle(after)]);
        gem.flat_face(&[lower_girdle(i), lower_girdle(next), lower(next)]);
        gem.flat_face(&[lower_girdle(next), lower_girdle(after), lower(next)]);
        gem.flat_face(&[culet, lower(before), lower_girdle(i), lower(next)]);
    }
    gem
}
