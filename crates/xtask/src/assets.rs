//! The meshes of the scenes in `assets/`, made from a few numbers: what lies there is what [`write_all`] writes.
//!
//! Not a modeller: bodies of revolution, one cut gem and one curved backdrop, as Wavefront OBJ with normals.

use std::f64::consts::{FRAC_PI_8, TAU};
use std::fmt::Write as _;
use std::path::Path;
use std::{fs, io};

/// Writes every generated file below `dir`, the folder `assets/`, and makes the folders that are missing.
///
/// # Errors
/// What the file system says.
pub(crate) fn write_all(dir: &Path) -> io::Result<()> {
    let meshes = dir.join("glass-and-ring").join("meshes");
    fs::create_dir_all(&meshes)?;
    fs::write(meshes.join("backdrop.obj"), backdrop().to_obj())?;
    for (name, solid) in solids() {
        fs::write(meshes.join(name), solid.to_obj())?;
    }
    Ok(())
}

/// The closed meshes, each with its file name. All but the gem stand on y = 0; the outside is air.
fn solids() -> [(&'static str, Mesh); 3] {
    [("goblet.obj", goblet().revolve(96)), ("ring.obj", ring().revolve(160)), ("gem.obj", gem())]
}

/// A goblet of rippled glass, 2.6 high: a foot, a stem with a knop, a bowl with a thick bottom and a rounded rim.
fn goblet() -> Profile {
    const RIPPLES: u32 = 9;
    let stem = Profile::start([0.0, 0.0])
        .line([0.78, 0.0])
        .arc([0.78, 0.035], 165.0, 6)
        .bezier([0.45, 0.16], [0.13, 0.13], [0.1, 0.45], 14)
        .bezier([0.095, 0.5], [0.1, 0.56], [0.13, 0.6], 4)
        .bezier([0.235, 0.68], [0.235, 0.84], [0.13, 0.92], 12)
        .bezier([0.1, 0.96], [0.1, 1.0], [0.105, 1.05], 4);
    let mut bowl = stem.bezier([0.12, 1.15], [0.6, 1.08], [0.76, 1.32], 16);
    for ripple in 1..=RIPPLES {
        // Each ripple is a weak lens that draws an arc of light into the goblet's shadow.
        let y = 1.32 + 1.2 * f64::from(ripple) / f64::from(RIPPLES);
        let ([r0, y0], r1) = (bowl.end(), 0.88 - 0.36 * (y - 1.9) * (y - 1.9));
        let between = |share: f64| [r0 + share * (r1 - r0) + 0.005, y0 + share * (y - y0)];
        bowl = bowl.bezier(between(0.3), between(0.7), [r1, y], 6);
    }
    bowl.bezier([0.738, 2.54], [0.732, 2.56], [0.73, 2.58], 2)
        .arc([0.71, 2.576], 180.0, 8)
        .bezier([0.74, 2.35], [0.8, 2.1], [0.79, 1.88], 12)
        .bezier([0.77, 1.6], [0.45, 1.5], [0.0, 1.5], 16)
}

/// A broad polished ring: its inside is a straight wall, which draws the caustic; its outside is rounded.
fn ring() -> Profile {
    Profile::start([1.0, 0.03])
        .arc([1.03, 0.03], 90.0, 4)
        .bezier([1.13, 0.0], [1.13, 0.38], [1.03, 0.38], 14)
        .arc([1.03, 0.35], 90.0, 4)
        .line([1.0, 0.03])
}

/// A curve in the half-plane of (distance from the axis, height), drawn so that the outside of the solid is on its right.
struct Profile {
    points: Vec<[f64; 2]>,
    /// The normals at the two ends of the span that begins at each point; they differ along a bend.
    normals: Vec<[[f64; 2]; 2]>,
}

impl Profile {
    fn start(point: [f64; 2]) -> Self {
        Self { points: vec![point], normals: Vec::new() }
    }

    fn end(&self) -> [f64; 2] {
        self.points[self.points.len() - 1]
    }

    /// Follows `point(t)` with direction `tangent(t)` for t in (0, 1].
    fn follow(
        mut self,
        steps: u32,
        point: impl Fn(f64) -> [f64; 2],
        tangent: impl Fn(f64) -> [f64; 2],
    ) -> Self {
        let right_of = |[r, y]: [f64; 2]| [y / r.hypot(y), -r / r.hypot(y)];
        let t = |step: u32| f64::from(step) / f64::from(steps);
        for step in 0..steps {
            self.points.push(point(t(step + 1)));
            self.normals.push([right_of(tangent(t(step))), right_of(tangent(t(step + 1)))]);
        }
        self
    }

    fn line(self, to: [f64; 2]) -> Self {
        let from = self.end();
        self.follow(1, |_| to, |_| [to[0] - from[0], to[1] - from[1]])
    }

    /// Turns counter-clockwise around `centre`.
    fn arc(self, centre: [f64; 2], degrees: f64, steps: u32) -> Self {
        let [r, y] = [self.end()[0] - centre[0], self.end()[1] - centre[1]];
        let turn = move |t: f64| {
            let (sin, cos) = (degrees.to_radians() * t).sin_cos();
            [r * cos - y * sin, r * sin + y * cos]
        };
        let point = |t| [centre[0] + turn(t)[0], centre[1] + turn(t)[1]];
        self.follow(steps, point, |t| [-turn(t)[1], turn(t)[0]])
    }

    /// A cubic Bézier curve with the control points `c1` and `c2`.
    fn bezier(self, c1: [f64; 2], c2: [f64; 2], to: [f64; 2], steps: u32) -> Self {
        let from = self.end();
        let weigh = move |w: [f64; 4]| {
            [0, 1].map(|axis| w[0] * from[axis] + w[1] * c1[axis] + w[2] * c2[axis] + w[3] * to[axis])
        };
        let point = move |t: f64| {
            let s = 1.0 - t;
            weigh([s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t])
        };
        let tangent = move |t: f64| {
            let s = 1.0 - t;
            weigh([-s * s, s * s - 2.0 * s * t, 2.0 * s * t - t * t, t * t])
        };
        self.follow(steps, point, tangent)
    }

    /// Where two spans meet at less than this angle, the surface is smooth across them; else it has an edge.
    const CREASE_DEGREES: f64 = 25.0;

    /// The normals, with the two at each smooth joint replaced by their mean.
    fn smooth_normals(&self) -> Vec<[[f64; 2]; 2]> {
        let mut smooth = self.normals.clone();
        for joint in 1..smooth.len() {
            let ([a, b], [c, d]) = (smooth[joint - 1][1], smooth[joint][0]);
            if a * c + b * d > Self::CREASE_DEGREES.to_radians().cos() {
                let length = (a + c).hypot(b + d);
                let mean = [(a + c) / length, (b + d) / length];
                (smooth[joint - 1][1], smooth[joint][0]) = (mean, mean);
            }
        }
        smooth
    }

    /// Turns the curve about the y axis. It must begin and end on the axis, or end where it began.
    fn revolve(&self, segments: usize) -> Mesh {
        let mut mesh = Mesh::default();
        let mut circles: Vec<_> =
            self.points.iter().map(|&p| Circle::push(&mut mesh.positions, p, segments)).collect();
        let last = circles.len() - 1;
        if self.points[last][0] > 0.0 {
            mesh.positions.truncate(circles[last].first);
            circles[last] = circles[0];
        }
        let mut previous = None;
        for (i, [start, end]) in self.smooth_normals().into_iter().enumerate() {
            let from = match previous {
                Some((normal, circle)) if normal == start => circle,
                _ => Circle::push(&mut mesh.normals, start, segments),
            };
            let to = Circle::push(&mut mesh.normals, end, segments);
            previous = Some((end, to));
            for k in 0..segments {
                let corner = |j: usize, normals: Circle, k| [circles[j].at(k), normals.at(k)];
                let mut face = vec![
                    corner(i, from, k),
                    corner(i + 1, to, k),
                    corner(i + 1, to, k + 1),
                    corner(i, from, k + 1),
                ];
                face.dedup_by_key(|c| c[0]);
                if face[0][0] == face[face.len() - 1][0] {
                    face.pop();
                }
                mesh.faces.push(face);
            }
        }
        mesh
    }
}

/// The vectors that one point of a profile becomes: a run of them around the axis, or a single one on it.
#[derive(Clone, Copy)]
struct Circle {
    first: usize,
    count: usize,
}

impl Circle {
    fn push(list: &mut Vec<[f64; 3]>, [r, y]: [f64; 2], segments: usize) -> Self {
        let circle = Self { first: list.len(), count: if r.abs() < 1e-9 { 1 } else { segments } };
        list.extend((0..circle.count).map(|k| around(r, y, TAU * k as f64 / segments as f64)));
        circle
    }

    fn at(self, k: usize) -> usize {
        self.first + k % self.count
    }
}

fn around(r: f64, y: f64, angle: f64) -> [f64; 3] {
    [r * angle.cos(), y, r * angle.sin()]
}

/// A round brilliant of radius 1 with its girdle about y = 0: table up, culet down.
///
/// The eight kites of the crown and of the pavilion are flat because the middle corner of each lies on the plane
/// through its two end corners that is symmetric about the kite's axis.
fn gem() -> Mesh {
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

/// A sheet of paper on the table y = 0, 28 wide, that curves up into a wall behind z = -8. Open; it faces up and to the front.
fn backdrop() -> Mesh {
    const HALF_WIDTH: f64 = 14.0;
    const STEPS: u32 = 24;
    let mut sheet = vec![([14.0, 0.0], [0.0, 1.0])];
    for step in 0..=STEPS {
        let (sin, cos) = (f64::from(step) / f64::from(STEPS) * TAU / 4.0).sin_cos();
        sheet.push(([-5.0 - 5.0 * sin, 5.0 - 5.0 * cos], [sin, cos]));
    }
    sheet.push(([-10.0, 12.0], [1.0, 0.0]));
    let mut mesh = Mesh::default();
    for ([z, y], [nz, ny]) in sheet {
        mesh.positions.extend([[-HALF_WIDTH, y, z], [HALF_WIDTH, y, z]]);
        mesh.normals.push([0.0, ny, nz]);
    }
    for i in 0..mesh.normals.len() - 1 {
        mesh.faces.push(vec![[2 * i, i], [2 * i + 1, i], [2 * i + 3, i + 1], [2 * i + 2, i + 1]]);
    }
    mesh
}

/// Flat convex polygons, counter-clockwise seen from outside.
#[derive(Default)]
struct Mesh {
    positions: Vec<[f64; 3]>,
    normals: Vec<[f64; 3]>,
    /// The (position, normal) indices of each corner.
    faces: Vec<Vec<[usize; 2]>>,
}

impl Mesh {
    /// Adds a face with its own normal, sharing positions with the faces that are there.
    fn flat_face(&mut self, corners: &[[f64; 3]]) {
        let normal = cross(sub(corners[1], corners[0]), sub(corners[2], corners[0]));
        let length = dot(normal, normal).sqrt();
        self.normals.push(normal.map(|x| x / length));
        let mut face = Vec::new();
        for &corner in corners {
            let near = |&p: &[f64; 3]| dot(sub(p, corner), sub(p, corner)) < 1e-18;
            let position = self.positions.iter().position(near).unwrap_or_else(|| {
                self.positions.push(corner);
                self.positions.len() - 1
            });
            face.push([position, self.normals.len() - 1]);
        }
        self.faces.push(face);
    }

    /// Wavefront OBJ text, five decimals for positions and four for normals.
    fn to_obj(&self) -> String {
        let mut text = String::from("# Made by `cargo xtask assets`.\n");
        let mut list = |tag, vectors: &[[f64; 3]], scale: f64| {
            for v in vectors {
                // Adding zero turns -0 into 0.
                let [x, y, z] = v.map(|c| (c * scale).round() / scale + 0.0);
                writeln!(text, "{tag} {x} {y} {z}").expect("a String takes all text");
            }
        };
        list("v", &self.positions, 1e5);
        list("vn", &self.normals, 1e4);
        for face in &self.faces {
            text.push('f');
            for [position, normal] in face {
                write!(text, " {}//{}", position + 1, normal + 1).expect("a String takes all text");
            }
            text.push('\n');
        }
        text
    }
}

fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[cfg(test)]
mod tests {
    use std::collections::HashMap;

    use super::*;

    fn edges(face: &[[usize; 2]]) -> impl Iterator<Item = (usize, usize)> + '_ {
        (0..face.len()).map(|i| (face[i][0], face[(i + 1) % face.len()][0]))
    }

    #[test]
    fn every_edge_of_a_solid_joins_two_faces_that_agree_on_its_outside() {
        for (name, solid) in solids() {
            let mut uses = HashMap::new();
            for edge in solid.faces.iter().flat_map(|face| edges(face)) {
                *uses.entry(edge).or_insert(0) += 1;
            }
            for (&(a, b), &count) in &uses {
                assert_eq!((count, uses.get(&(b, a))), (1, Some(&1)), "{name}: edge {a}-{b}");
            }
        }
    }

    #[test]
    fn the_outside_of_a_solid_is_outside() {
        for (name, solid) in solids() {
            let mut volume = 0.0;
            for face in &solid.faces {
                for pair in face[1..].windows(2) {
                    let [a, b, c] = [face[0][0], pair[0][0], pair[1][0]].map(|i| solid.positions[i]);
                    volume += dot(a, cross(b, c)) / 6.0;
                }
            }
            assert!(volume > 0.1, "{name}: volume {volume}");
        }
    }

    #[test]
    fn normals_agree_with_their_faces() {
        for (name, mesh) in solids().into_iter().chain([("backdrop.obj", backdrop())]) {
            for face in &mesh.faces {
                let [a, b, c] = [0, 1, 2].map(|i| mesh.positions[face[i][0]]);
                let flat = cross(sub(b, a), sub(c, a));
                let length = dot(flat, flat).sqrt();
                for &[_, normal] in face {
                    let cos = dot(flat, mesh.normals[normal]) / length;
                    assert!(cos > 0.9, "{name}: face {face:?} is {cos} off its normal");
                }
            }
        }
    }

    #[test]
    fn faces_are_flat_and_convex() {
        for (name, solid) in solids() {
            for face in &solid.faces {
                let normal = solid.normals[face[0][1]];
                let at = |i: usize| solid.positions[face[i % face.len()][0]];
                let [first, second, third] = [at(0), at(1), at(2)];
                let flat = cross(sub(second, first), sub(third, first));
                for i in 0..face.len() {
                    assert!(dot(flat, sub(at(i), first)).abs() < 1e-9, "{name}: {face:?} is bent");
                    let turn = cross(sub(at(i + 1), at(i)), sub(at(i + 2), at(i + 1)));
                    assert!(dot(turn, normal) > 0.0, "{name}: {face:?} is not convex");
                }
            }
        }
    }

    #[test]
    fn the_files_in_the_tree_are_what_is_written() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/glass-and-ring/meshes");
        for (name, mesh) in solids().into_iter().chain([("backdrop.obj", backdrop())]) {
            let text = fs::read_to_string(folder.join(name)).expect("every mesh is committed");
            assert!(text == mesh.to_obj(), "{name} differs: run `cargo xtask assets`");
        }
    }
}
