//! The hall of `museum`, after the scene that the photon map was first shown with `[JEN96]`: floor, ceiling, columns, frames, a procedural
//! sculpture and a vase of glass. Balls, lamps and plinths stand in the scene file.
//!
//! The hall reaches from −5 to 5 in x, from 0 to 5 in y and from −8 to 8 in z.

use super::lathe::Profile;
use super::mesh::Mesh;

const HALF_WIDTH: f64 = 5.0;
const HALF_LENGTH: f64 = 8.0;
const HEIGHT: f64 = 5.0;

/// The tiles of the floor, light and dark, 0.5 across.
pub(super) fn tiles() -> [Mesh; 2] {
    const TILE: f64 = 0.5;
    let mut tints = [Mesh::default(), Mesh::default()];
    let count = |half: f64| (2.0 * half / TILE) as usize;
    for j in 0..count(HALF_LENGTH) {
        for i in 0..count(HALF_WIDTH) {
            let at = |i: usize, j: usize| [i as f64 * TILE - HALF_WIDTH, 0.0, j as f64 * TILE - HALF_LENGTH];
            tints[(i + j) % 2].flat_face(&[at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)]);
        }
    }
    tints
}

/// A ceiling of 8 × 12 coffers. Open; it faces down.
pub(super) fn ceiling() -> Mesh {
    const COFFERS: [usize; 2] = [8, 12];
    const BEAM: f64 = 0.18;
    const DEPTH: f64 = 0.22;
    let mut mesh = Mesh::default();
    let size = [2.0 * HALF_WIDTH / COFFERS[0] as f64, 2.0 * HALF_LENGTH / COFFERS[1] as f64];
    for j in 0..COFFERS[1] {
        for i in 0..COFFERS[0] {
            let corner = |k: usize, inset: f64, y: f64| {
                // Clockwise seen from above: counter-clockwise from below.
                let (right, far) = ([false, true, true, false][k % 4], [false, false, true, true][k % 4]);
                let side = |at: usize, size: f64, half: f64, end: bool| {
                    let edge = (at + usize::from(end)) as f64 * size - half;
                    if end { edge - inset } else { edge + inset }
                };
                [side(i, size[0], HALF_WIDTH, right), y, side(j, size[1], HALF_LENGTH, far)]
            };
            for k in 0..4 {
                let (beam, rim) = (|k| corner(k, 0.0, HEIGHT), |k| corner(k, BEAM, HEIGHT));
                let top = |k| corner(k, BEAM, HEIGHT + DEPTH);
                mesh.flat_face(&[beam(k), beam(k + 1), rim(k + 1), rim(k)]);
                mesh.flat_face(&[rim(k), rim(k + 1), top(k + 1), top(k)]);
            }
            mesh.flat_face(&[0, 1, 2, 3].map(|k| corner(k, BEAM, HEIGHT + DEPTH)));
        }
    }
    mesh
}

/// A column from the floor almost to the ceiling: a base, a shaft that narrows, a capital.
pub(super) fn column() -> Profile {
    Profile::start([0.0, 0.0])
        .line([0.38, 0.0])
        .line([0.38, 0.2])
        .arc([0.32, 0.26], 90.0, 4)
        .line([0.27, 0.32])
        .bezier([0.27, 1.6], [0.26, 2.9], [0.22, 4.5], 2)
        .line([0.25, 4.56])
        .line([0.36, 4.78])
        .line([0.36, 4.96])
        .line([0.0, 4.96])
}

/// A vase of solid glass with a hollow, 1.1 high.
pub(super) fn vase() -> Profile {
    Profile::start([0.0, 0.0])
        .line([0.2, 0.0])
        .arc([0.2, 0.02], 165.0, 6)
        .bezier([0.16, 0.15], [0.4, 0.2], [0.4, 0.45], 6)
        .bezier([0.38, 0.72], [0.13, 0.75], [0.18, 1.05], 6)
        .arc([0.165, 1.06], 170.0, 6)
        .bezier([0.11, 0.8], [0.28, 0.7], [0.28, 0.45], 6)
        .bezier([0.28, 0.24], [0.15, 0.16], [0.0, 0.16], 5)
}

/// Menger's sponge of the second level, an edge of 1, on y = 0: a cube of which seven of 27 parts are cut out, and of each that is left
/// again. Its edges join four faces in places.
pub(super) fn sponge() -> Mesh {
    const SIDE: i32 = 9;
    let is_solid = |cell: [i32; 3]| {
        let inside = cell.iter().all(|c| (0..SIDE).contains(c));
        let is_cut = |scale: i32| cell.iter().filter(|&&c| c / scale % 3 == 1).count() >= 2;
        inside && !is_cut(1) && !is_cut(3)
    };
    let mut mesh = Mesh::default();
    for n in 0..SIDE.pow(3) {
        let cell = [n % SIDE, n / SIDE % SIDE, n / (SIDE * SIDE)];
        for (axis, step) in [0, 1, 2].into_iter().flat_map(|axis| [(axis, -1), (axis, 1)]) {
            let mut beside = cell;
            beside[axis] += step;
            if is_solid(cell) && !is_solid(beside) {
                mesh.flat_face(&side(cell, axis, step > 0).map(|p| {
                    let [x, y, z] = p.map(|c| f64::from(c) / f64::from(SIDE));
                    [x - 0.5, y, z - 0.5]
                }));
            }
        }
    }
    mesh
}

/// A side of a cell, counter-clockwise seen from outside.
fn side(cell: [i32; 3], axis: usize, is_upper: bool) -> [[i32; 3]; 4] {
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    let mut corners = [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[du, dv]| {
        let mut corner = cell;
        corner[axis] += i32::from(is_upper);
        corner[u] += du;
        corner[v] += dv;
        corner
    });
    if !is_upper {
        corners.reverse();
    }
    corners
}

/// A picture frame around 2 × 1.4, its back on z = 0. Open at the back; it faces +z.
pub(super) fn frame() -> Mesh {
    let mut mesh = Mesh::default();
    let corner = |k: usize, inset: f64, z: f64| {
        let (right, up) = ([false, true, true, false][k % 4], [false, false, true, true][k % 4]);
        let at = |half: f64, end: bool| if end { half - inset } else { inset - half };
        [at(1.12, right), at(0.82, up), z]
    };
    let profile = [(0.0, 0.0), (0.0, 0.05), (0.04, 0.09), (0.09, 0.07), (0.12, 0.02)];
    for pair in profile.windows(2) {
        let [(outer, low), (inner, high)] = [pair[0], pair[1]];
        for k in 0..4 {
            mesh.flat_face(&[
                corner(k, outer, low),
                corner(k + 1, outer, low),
                corner(k + 1, inner, high),
                corner(k, inner, high),
            ]);
        }
    }
    mesh
}
