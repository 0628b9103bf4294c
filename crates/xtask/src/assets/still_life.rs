//! What lies on the table in `glass-and-ring` and `ring`: a goblet, rings, and the sheet of paper below them.

use std::f64::consts::TAU;

use super::lathe::Profile;
use super::mesh::Mesh;

/// A goblet of rippled glass, 2.6 high: a foot, a stem with a knop, a bowl with a thick bottom and a rounded rim.
pub(super) fn goblet() -> Profile {
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
pub(super) fn ring() -> Profile {
    rounded_band(0.03, 1.13, 0.38)
}

/// A higher and heavier ring, whose wall draws the whole of its caustic.
pub(super) fn band() -> Profile {
    rounded_band(0.05, 1.2, 0.5)
}

/// A ring of inner radius 1 with rounded edges; `bulge` draws its outside, as a control point does.
fn rounded_band(edge: f64, bulge: f64, height: f64) -> Profile {
    Profile::start([1.0, edge])
        .arc([1.0 + edge, edge], 90.0, 4)
        .bezier([bulge, 0.0], [bulge, height], [1.0 + edge, height], 14)
        .arc([1.0 + edge, height - edge], 90.0, 4)
        .line([1.0, edge])
}

/// A sheet of paper on the table y = 0, 28 wide, that curves up into a wall behind z = -8. Open; it faces up and to the front.
pub(super) fn backdrop() -> Mesh {
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
