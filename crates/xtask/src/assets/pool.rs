//! The water and the tiles of `pool`: a basin 6 long (x), 4 wide (z) and 1.5 deep, its rim at y = 0.
//!
//! The walls behind the tiles are cubes in the scene file; what is here lies in front of them.

use super::mesh::Mesh;

const HALF_LENGTH: f64 = 3.0;
const HALF_WIDTH: f64 = 2.0;
const DEPTH: f64 = 1.5;

/// Waves as (amplitude, x and z of the wave vector, phase).
///
/// Air to water, a crest of curvature a·k² focuses parallel light at depth 4 / (a·k²): where the crests of several
/// waves meet, that is about the depth of the basin.
const WAVES: [[f64; 4]; 8] = [
    [0.0255, 3.8, 1.8, 0.3],
    [0.0206, -2.5, 4.8, 1.9],
    [0.0149, 5.8, -3.1, 4.1],
    [0.0112, 1.6, 7.7, 2.6],
    [0.0083, -8.6, 3.1, 5.2],
    [0.0058, 7.1, 7.9, 0.9],
    [0.0041, 4.1, -11.4, 3.5],
    [0.0026, 13.9, 1.9, 1.2],
];

/// The surface of the water about y = 0, open, facing up. It reaches into the walls, so that no light slips past it.
pub(super) fn water() -> Mesh {
    const INTO_THE_WALL: f64 = 0.06;
    const CELLS: [usize; 2] = [120, 80];
    let mut mesh = Mesh::default();
    let at = |i: usize, axis: usize, half: f64| {
        (half + INTO_THE_WALL) * (2.0 * i as f64 / CELLS[axis] as f64 - 1.0)
    };
    for j in 0..=CELLS[1] {
        for i in 0..=CELLS[0] {
            let (x, z) = (at(i, 0, HALF_LENGTH), at(j, 1, HALF_WIDTH));
            let (height, [slope_x, slope_z]) = wave(x, z);
            let length = (1.0 + slope_x * slope_x + slope_z * slope_z).sqrt();
            mesh.positions.push([x, height, z]);
            mesh.normals.push([-slope_x / length, 1.0 / length, -slope_z / length]);
        }
    }
    for j in 0..CELLS[1] {
        for i in 0..CELLS[0] {
            let corner = |i: usize, j: usize| [j * (CELLS[0] + 1) + i; 2];
            let [a, b, c, d] = [corner(i, j), corner(i, j + 1), corner(i + 1, j + 1), corner(i + 1, j)];
            mesh.faces.extend([vec![a, b, c], vec![a, c, d]]);
        }
    }
    mesh
}

/// The height of the water and its slopes along x and z.
fn wave(x: f64, z: f64) -> (f64, [f64; 2]) {
    let mut height = 0.0;
    let mut slope = [0.0; 2];
    for [amplitude, kx, kz, phase] in WAVES {
        let (sin, cos) = (kx * x + kz * z + phase).sin_cos();
        height += amplitude * sin;
        slope[0] += amplitude * kx * cos;
        slope[1] += amplitude * kz * cos;
    }
    (height, slope)
}

/// One side of the basin: a corner, two directions whose cross product points inwards, and its columns and rows of tiles.
struct Side {
    corner: [f64; 3],
    right: [f64; 3],
    up: [f64; 3],
    columns: u32,
    rows: u32,
}

impl Side {
    /// Adds a rectangle between two distances to the right and two upwards.
    fn add(&self, mesh: &mut Mesh, [left, right]: [f64; 2], [bottom, top]: [f64; 2]) {
        let at = |a: f64, b: f64| {
            [0, 1, 2].map(|axis| self.corner[axis] + a * self.right[axis] + b * self.up[axis])
        };
        mesh.flat_face(&[at(left, bottom), at(right, bottom), at(right, top), at(left, top)]);
    }
}

/// The floor and the four walls, a little in front of the cubes that hold them.
fn sides() -> [Side; 5] {
    const LIFT: f64 = 0.004;
    const COLUMNS: [u32; 2] = [24, 16];
    const ROWS: u32 = 6;
    let (x, z, y) = (HALF_LENGTH, HALF_WIDTH, -DEPTH);
    let up = [0.0, 1.0, 0.0];
    let side = |corner, right, up, columns, rows| Side { corner, right, up, columns, rows };
    [
        side([-x, y + LIFT, z], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0], COLUMNS[0], COLUMNS[1]),
        side([-x, y, -z + LIFT], [1.0, 0.0, 0.0], up, COLUMNS[0], ROWS),
        side([x, y, z - LIFT], [-1.0, 0.0, 0.0], up, COLUMNS[0], ROWS),
        side([-x + LIFT, y, z], [0.0, 0.0, -1.0], up, COLUMNS[1], ROWS),
        side([x - LIFT, y, -z], [0.0, 0.0, 1.0], up, COLUMNS[1], ROWS),
    ]
}

/// From one joint's middle to the next.
const TILE: f64 = 0.25;
const HALF_JOINT: f64 = 0.006;

/// Tiles of three tints, light to dark; the row at the water's edge is dark. Open; they face into the basin.
pub(super) fn tiles() -> [Mesh; 3] {
    let mut tints = [Mesh::default(), Mesh::default(), Mesh::default()];
    let mut number = 0;
    let between_joints =
        |index: u32| [f64::from(index) * TILE + HALF_JOINT, f64::from(index + 1) * TILE - HALF_JOINT];
    for (index, side) in sides().iter().enumerate() {
        for row in 0..side.rows {
            for column in 0..side.columns {
                number += 1;
                let at_the_edge = index > 0 && row + 1 == side.rows;
                let tint = if at_the_edge { 2 } else { tint(number) };
                side.add(&mut tints[tint], between_joints(column), between_joints(row));
            }
        }
    }
    tints
}

/// The tint of a tile: most are light, one in thirty is dark.
fn tint(number: u32) -> usize {
    match number.wrapping_mul(0x9e37_79b1).rotate_left(15).wrapping_mul(0x85eb_ca77) >> 16 & 0xff {
        0..150 => 0,
        150..247 => 1,
        _ => 2,
    }
}

/// What is between the tiles, in their plane: photons on a tile then count at its joints, and the joints are not darkened.
pub(super) fn joints() -> Mesh {
    let mut mesh = Mesh::default();
    for side in &sides() {
        let joint = |index: u32, last: u32| {
            let middle = f64::from(index) * TILE;
            [(middle - HALF_JOINT).max(0.0), (middle + HALF_JOINT).min(f64::from(last) * TILE)]
        };
        let whole = [0.0, f64::from(side.columns) * TILE];
        for row in 0..=side.rows {
            side.add(&mut mesh, whole, joint(row, side.rows));
        }
        for row in 0..side.rows {
            let height = [joint(row, side.rows)[1], joint(row + 1, side.rows)[0]];
            for column in 0..=side.columns {
                side.add(&mut mesh, joint(column, side.columns), height);
            }
        }
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::super::mesh::{cross, dot, sub};
    use super::*;

    #[test]
    fn tiles_and_joints_cover_the_basin_once() {
        let area = |mesh: &Mesh| -> f64 {
            let quad = |face: &Vec<[usize; 2]>| {
                let [a, b, d] = [0, 1, 3].map(|i| mesh.positions[face[i][0]]);
                let normal = cross(sub(b, a), sub(d, a));
                dot(normal, normal).sqrt()
            };
            mesh.faces.iter().map(quad).sum()
        };
        let covered = tiles().iter().map(area).sum::<f64>() + area(&joints());
        let (length, width) = (2.0 * HALF_LENGTH, 2.0 * HALF_WIDTH);
        let basin = length * width + 2.0 * (length + width) * DEPTH;
        assert!((covered - basin).abs() < 1e-9, "{covered} of {basin}");
    }

    #[test]
    fn the_water_ends_inside_the_walls() {
        let water = water();
        for (x, z) in [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)] {
            let beyond = |p: &[f64; 3]| p[0] * x > HALF_LENGTH && p[2] * z > HALF_WIDTH;
            assert!(water.positions.iter().any(beyond), "corner {x} {z}");
        }
    }

    #[test]
    fn slopes_are_those_of_the_heights() {
        const STEP: f64 = 1e-5;
        for (x, z) in [(0.0, 0.0), (1.3, -0.7), (-2.9, 1.9)] {
            let (_, slope) = wave(x, z);
            let along_x = (wave(x + STEP, z).0 - wave(x - STEP, z).0) / (2.0 * STEP);
            let along_z = (wave(x, z + STEP).0 - wave(x, z - STEP).0) / (2.0 * STEP);
            assert!((slope[0] - along_x).abs() < 1e-8 && (slope[1] - along_z).abs() < 1e-8, "{x} {z}");
        }
    }
}
