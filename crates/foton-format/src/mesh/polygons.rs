//! Polygons to triangles: fans where a fan covers the polygon once, ears where it does not.
//!
//! Faces may name vertices that come later in the file, so readers push fans as they go and have them mended at the end.
//! A polygon lies in a plane as far as its vector area says: the sum of the cross products of its fan. Ears are cut by the
//! crate `earcut` in the coordinate plane that it faces most.

use earcut::Earcut;
use foton_math::Cancel;
use foton_math::glam::{DVec2, DVec3};

use crate::mesh::tally::Tally;
use crate::mesh::words::Problem;

/// How much of a polygon's area a triangle may lie on the wrong side, or the triangles may be off together: rounding.
const ROUNDING: f64 = 1e-6;

/// Concave faces of more corners stay fans: cutting ears takes the square of their number.
const MAX_CORNERS: usize = 1 << 15;

/// The faces of a mesh with more than three corners.
#[derive(Default)]
pub(crate) struct Polygons {
    runs: Vec<Run>,
}

/// Faces with the same number of corners, each behind the other's fan.
struct Run {
    first: usize,
    corners: usize,
    faces: usize,
}

/// What came of the polygons that are no fans.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct Mended {
    /// Triangles that are gone, since corners on an edge need none: their numbers before that.
    pub(crate) gone: Vec<usize>,
    /// How many polygons have edges that cross: triangles do not cover them once.
    pub(crate) crossed: usize,
    /// How many polygons have too many corners to be mended.
    pub(crate) large: usize,
}

impl Mended {
    /// What is to be warned of.
    pub(crate) fn warnings(&self) -> impl Iterator<Item = Problem> {
        let (mut crossed, mut large) = (Tally::default(), Tally::default());
        crossed.add_many(self.crossed, Problem::default);
        large.add_many(self.large, Problem::default);
        let crossed = crossed.warning("face has", "faces have", CROSSED);
        let large = large.warning("concave face has", "concave faces have", LARGE);
        crossed.into_iter().chain(large)
    }
}

const CROSSED: &str = "edges that cross: what is filled may not be what was meant";
const LARGE: &str = "more than 32,768 corners: triangles overlap there";

impl Polygons {
    /// Notes a face whose fan begins with that triangle.
    pub(crate) fn note(&mut self, first: usize, corners: usize) {
        if corners <= 3 {
            return;
        }
        match self.runs.last_mut() {
            Some(run) if run.corners == corners && run.first + run.faces * (corners - 2) == first => {
                run.faces += 1;
            }
            _ => self.runs.push(Run { first, corners, faces: 1 }),
        }
    }

    /// Puts ears in the place of the fans that do not cover their polygon once.
    /// Once cancelled all others stay fans.
    pub(crate) fn mend<C: Copy>(
        &self,
        triangles: &mut Vec<[C; 3]>,
        position: impl Fn(C) -> DVec3,
        cancel: &Cancel,
    ) -> Mended {
        let mut mended = Mended::default();
        let mut cutter = Earcut::new();
        for run in &self.runs {
            let size = run.corners - 2;
            for first in (0..run.faces).map(|face| run.first + face * size) {
                // One with many corners takes long by itself.
                if cancel.is_requested() {
                    return mended;
                }
                let fan = &mut triangles[first..first + size];
                let Some(area) = wrong_area(fan, &position) else { continue };
                if run.corners > MAX_CORNERS {
                    mended.large += 1;
                    continue;
                }
                let (ears, is_crossed) = ears(&mut cutter, fan, area, &position);
                mended.crossed += usize::from(is_crossed);
                if !ears.is_empty() {
                    fan[..ears.len()].copy_from_slice(&ears);
                    mended.gone.extend(first + ears.len()..first + size);
                }
            }
        }
        if !mended.gone.is_empty() {
            let (mut at, mut gone) = (0, mended.gone.iter().copied().peekable());
            triangles.retain(|_| {
                at += 1;
                gone.next_if_eq(&(at - 1)).is_none()
            });
        }
        mended
    }
}

/// Twice the vector area of a fan that has triangles on both sides; `None` for one that covers its polygon once.
fn wrong_area<C: Copy>(fan: &[[C; 3]], position: &impl Fn(C) -> DVec3) -> Option<DVec3> {
    let cross = |corners: &[C; 3]| {
        let [a, b, c] = corners.map(position);
        (b - a).cross(c - a)
    };
    let area: DVec3 = fan.iter().map(cross).sum();
    let (square, mut folded) = (area.length_squared(), false);
    let is_wrong = fan.iter().any(|corners| {
        let part = cross(corners);
        // Faces that fold back on themselves have no area together.
        folded |= part.length_squared() > square;
        part.dot(area) < -ROUNDING * square
    });
    (is_wrong || (square == 0.0 && folded)).then_some(area)
}

/// The triangles of a polygon, in its own sense, and whether they fail to cover it once. Empty where there is no plane.
fn ears<C: Copy>(
    cutter: &mut Earcut<f64>,
    fan: &[[C; 3]],
    area: DVec3,
    position: &impl Fn(C) -> DVec3,
) -> (Vec<[C; 3]>, bool) {
    let first = [fan[0][0], fan[0][1]];
    let corners: Vec<C> = first.into_iter().chain(fan.iter().map(|corners| corners[2])).collect();
    let across = area.abs();
    let flat = |p: DVec3| {
        if across.z >= across.x && across.z >= across.y {
            DVec2::new(p.x, p.y)
        } else if across.x >= across.y {
            DVec2::new(p.y, p.z)
        } else {
            DVec2::new(p.z, p.x)
        }
    };
    let points: Vec<DVec2> = corners.iter().map(|&c| flat(position(c))).collect();
    let cross = |[a, b, c]: [usize; 3]| (points[b] - points[a]).perp_dot(points[c] - points[a]);
    let whole: f64 = (2..points.len()).map(|i| cross([0, i - 1, i])).sum();
    let mut indices: Vec<usize> = Vec::new();
    cutter.earcut(points.iter().map(|p| p.to_array()), &[], &mut indices);
    let (mut covered, mut triangles) = (0.0, Vec::with_capacity(fan.len()));
    for ear in indices.chunks_exact(3) {
        let mut ear = [ear[0], ear[1], ear[2]];
        let area = cross(ear);
        if area * whole < 0.0 {
            ear.swap(1, 2);
        }
        covered += area.abs();
        triangles.push(ear.map(|i| corners[i]));
    }
    let fits = (covered - whole.abs()).abs() <= ROUNDING * covered && covered > 0.0;
    if !fits && fan.len() == 2 {
        // Two corners that changed places; with ears half of it would be gone.
        triangles = fan.to_vec();
    }
    (triangles, !fits)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A polygon's triangles, and what was said of them.
    fn triangles(points: &[DVec3]) -> (Vec<[usize; 3]>, Mended) {
        let mut triangles: Vec<[usize; 3]> = (2..points.len()).map(|i| [0, i - 1, i]).collect();
        let mut polygons = Polygons::default();
        polygons.note(0, points.len());
        let mended = polygons.mend(&mut triangles, |i| points[i], &Cancel::default());
        (triangles, mended)
    }

    /// The sum of the triangles' areas, and the length of the sum of their vector areas.
    fn areas(points: &[DVec3], triangles: &[[usize; 3]]) -> (f64, f64) {
        let cross = |t: &[usize; 3]| {
            let [a, b, c] = t.map(|i| points[i]);
            0.5 * (b - a).cross(c - a)
        };
        (
            triangles.iter().map(|t| cross(t).length()).sum(),
            triangles.iter().map(cross).sum::<DVec3>().length(),
        )
    }

    fn polygon(corners: &[[f64; 2]]) -> Vec<DVec3> {
        corners.iter().map(|&[x, y]| DVec3::new(x, y, 0.0)).collect()
    }

    const LETTER: [[f64; 2]; 8] =
        [[0., 0.], [3., 0.], [3., 3.], [0., 3.], [0., 2.], [2., 2.], [2., 1.], [0., 1.]];

    #[test]
    fn a_concave_polygon_is_covered_once_wherever_it_begins_and_however_it_lies() {
        for turn in 0..8 {
            for backwards in [false, true] {
                let mut corners = LETTER;
                corners.rotate_left(turn);
                if backwards {
                    corners.reverse();
                }
                for axis in [DVec3::X, DVec3::Y, DVec3::new(0.3, -0.5, 0.9).normalize()] {
                    let turn = foton_math::glam::DMat3::from_axis_angle(axis, 1.3);
                    let points: Vec<_> = polygon(&corners).into_iter().map(|p| turn * p).collect();
                    let (triangles, mended) = triangles(&points);
                    let (all, together) = areas(&points, &triangles);
                    assert!((all - 7.0).abs() < 1e-9 && (together - 7.0).abs() < 1e-9, "{all} {together}");
                    assert_eq!(mended, Mended::default());
                }
            }
        }
    }

    #[test]
    fn fans_that_cover_their_polygon_once_stay_as_they_are() {
        let round: Vec<_> = (0..12)
            .map(|i| [f64::from(i) * std::f64::consts::FRAC_PI_6])
            .map(|[a]| [a.cos(), a.sin()])
            .collect();
        let square_with_corners_on_edges =
            [[0., 0.], [1., 0.], [2., 0.], [2., 2.], [1., 2.], [0., 2.], [0., 1.]];
        let arrow_from_its_notch = [[1., 1.], [3., 0.], [0., 3.], [0., 0.]];
        for corners in [&round[..], &square_with_corners_on_edges, &arrow_from_its_notch[..3]] {
            let (found, mended) = triangles(&polygon(corners));
            let fan: Vec<_> = (2..corners.len()).map(|i| [0, i - 1, i]).collect();
            assert_eq!((found, mended), (fan, Mended::default()));
        }
        // A square that is bent along either diagonal.
        let mut bent = polygon(&[[0., 0.], [1., 0.], [1., 1.], [0., 1.]]);
        bent[2].z = 0.8;
        assert_eq!(triangles(&bent).0, [[0, 1, 2], [0, 2, 3]]);
        bent[3].z = -0.8;
        assert_eq!(triangles(&bent).0, [[0, 1, 2], [0, 2, 3]]);
    }

    #[test]
    fn a_dart_is_cut_through_its_notch() {
        let dart = polygon(&[[0., 0.], [2., 1.], [0., 2.], [0.5, 1.]]);
        for turn in 0..4 {
            let mut dart = dart.clone();
            dart.rotate_left(turn);
            let (found, _) = triangles(&dart);
            let (all, together) = areas(&dart, &found);
            assert!((all - 1.5).abs() < 1e-12 && (together - 1.5).abs() < 1e-12, "{turn}: {found:?} {all}");
        }
    }

    #[test]
    fn corners_on_an_edge_that_need_no_triangle_are_told() {
        let mut corners = LETTER.to_vec();
        corners.insert(6, [2.0, 1.5]);
        let points = polygon(&corners);
        let (found, mended) = triangles(&points);
        assert_eq!(found.len() + mended.gone.len(), corners.len() - 2);
        assert!((areas(&points, &found).0 - 7.0).abs() < 1e-12);
    }

    #[test]
    fn polygons_whose_edges_cross_are_told() {
        for crossed in
            [&[[0., 0.], [1., 1.], [1., 0.], [0., 1.]][..], &[[0., 0.], [3., 3.], [3., 0.], [0., 1.]]]
        {
            assert_eq!(triangles(&polygon(crossed)).1.crossed, 1, "{crossed:?}");
        }
        // Without any area there is nothing to cross.
        let (found, mended) = triangles(&polygon(&[[0., 0.], [1., 0.], [2., 0.], [1., 0.]]));
        assert_eq!((found.len(), mended), (2, Mended::default()));
    }

    #[test]
    fn concave_polygons_of_too_many_corners_are_told() {
        let comb: Vec<_> = (0..MAX_CORNERS).map(|i| [i as f64, (i % 2) as f64]).collect();
        let closed = [&[[MAX_CORNERS as f64, -1.0], [-1.0, -1.0]], &comb[..]].concat();
        let (found, mended) = triangles(&polygon(&closed));
        assert_eq!((found.len(), mended.large), (closed.len() - 2, 1));
        assert_eq!(mended.warnings().count(), 1);
    }

    #[test]
    fn a_polygon_with_a_bridge_to_its_hole_is_covered_once() {
        let ring = polygon(&[
            [0., 0.],
            [4., 0.],
            [4., 4.],
            [0., 4.],
            [0., 0.],
            [1., 1.],
            [1., 3.],
            [3., 3.],
            [3., 1.],
            [1., 1.],
        ]);
        let (found, mended) = triangles(&ring);
        let (all, together) = areas(&ring, &found);
        assert!((all - 12.0).abs() < 1e-12 && (together - 12.0).abs() < 1e-12, "{all} {together}");
        assert_eq!(mended.crossed, 0);
    }
}
