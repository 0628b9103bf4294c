//! What the tree is made of: eight boxes side by side, and four triangles side by side.
//!
//! Four lanes of single precision are what every machine in question has without asking; wider ones gain little here.

use foton_math::glam::{Vec3, Vec4};
use foton_math::{Aabb, Ray};

use crate::primitive::ShearedRay;

/// Children of a node.
pub(super) const WIDTH: usize = 8;

/// Triangles in a leaf.
pub(super) const QUAD: usize = 4;

/// A far distance counts as longer by this factor: the test's own rounding errors, with a margin. Ize (2013). `[IZE13]`
const ROUNDING: f32 = 1.0 + 8.0 * f32::EPSILON;

/// What a slot of a node holds: its kind in the two highest bits, an index in the others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Child(u32);

/// A child, taken apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Target {
    /// A node's index.
    Node(usize),
    /// A quad's index.
    Quad(usize),
    /// The index of a primitive that is no triangle.
    Other(usize),
    /// An instance's index.
    Instance(usize),
}

impl Child {
    /// Nothing: its box is empty.
    pub(super) const NONE: Self = Self(u32::MAX);
    const INDEX: u32 = (1 << 30) - 1;

    pub(super) const fn node(index: usize) -> Self {
        Self(index as u32 & Self::INDEX)
    }

    pub(super) const fn quad(index: usize) -> Self {
        Self((index as u32 & Self::INDEX) | 1 << 30)
    }

    pub(super) const fn other(index: usize) -> Self {
        Self((index as u32 & Self::INDEX) | 2 << 30)
    }

    pub(super) const fn instance(index: usize) -> Self {
        Self((index as u32 & Self::INDEX) | 3 << 30)
    }

    #[inline(always)]
    pub(super) const fn target(self) -> Target {
        let index = (self.0 & Self::INDEX) as usize;
        match self.0 >> 30 {
            0 => Target::Node(index),
            1 => Target::Quad(index),
            2 => Target::Other(index),
            _ => Target::Instance(index),
        }
    }
}

/// Eight boxes and what is in them.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(super) struct Node {
    /// Low and high x, low and high y, low and high z.
    bounds: [[Vec4; 2]; 6],
    pub(super) children: [Child; WIDTH],
}

impl Node {
    /// No children: a ray enters none of its boxes.
    pub(super) const EMPTY: Self = {
        let (low, high) = ([Vec4::INFINITY; 2], [Vec4::NEG_INFINITY; 2]);
        Self { bounds: [low, high, low, high, low, high], children: [Child::NONE; WIDTH] }
    };

    pub(super) fn set(&mut self, slot: usize, child: Child, min: Vec3, max: Vec3) {
        self.children[slot] = child;
        for axis in 0..3 {
            self.bounds[2 * axis][slot / 4][slot % 4] = min[axis];
            self.bounds[2 * axis + 1][slot / 4][slot % 4] = max[axis];
        }
    }

    /// Where the ray enters each box, and a bit for each box that it enters before `t_max`.
    #[inline(always)]
    pub(super) fn enter(&self, ray: &BoxRay, t_max: f32) -> ([Vec4; 2], u32) {
        let [x0, x1] = self.pair(0, ray);
        let [y0, y1] = self.pair(1, ray);
        let [z0, z1] = self.pair(2, ray);
        let half = |h: usize| {
            let at = |side: &[Vec4; 2], axis: usize| (side[h] - ray.origin[axis]) * ray.inverse[axis];
            let near = at(x0, 0).max(at(y0, 1)).max(at(z0, 2).max(Vec4::splat(ray.t_min)));
            let far = at(x1, 0).min(at(y1, 1)).min(at(z1, 2).min(Vec4::splat(t_max)));
            (near, near.cmple(far * ROUNDING).bitmask())
        };
        let ((near0, entered0), (near1, entered1)) = (half(0), half(1));
        ([near0, near1], entered0 | entered1 << 4)
    }

    /// A bit for each child whose box meets another.
    pub(super) fn near(&self, near: &Aabb) -> u32 {
        let half = |h: usize| {
            let meets = |axis: usize| {
                let (low, high) = (&self.bounds[2 * axis][h], &self.bounds[2 * axis + 1][h]);
                low.cmple(Vec4::splat(near.max[axis])) & high.cmpge(Vec4::splat(near.min[axis]))
            };
            (meets(0) & meets(1) & meets(2)).bitmask()
        };
        half(0) | half(1) << 4
    }

    /// The sides by which the ray enters and leaves along an axis.
    #[inline(always)]
    fn pair(&self, axis: usize, ray: &BoxRay) -> [&[Vec4; 2]; 2] {
        let from_high = ray.from_high[axis] & 1;
        [&self.bounds[2 * axis + from_high], &self.bounds[2 * axis + (from_high ^ 1)]]
    }
}

/// A ray prepared for boxes.
#[derive(Clone, Copy, Debug)]
pub(super) struct BoxRay {
    origin: [f32; 3],
    /// Finite, so that a ray in the plane of a side is inside: zero times infinity would be NaN.
    inverse: [f32; 3],
    /// 1 where the ray runs downwards and enters by the high side.
    from_high: [usize; 3],
    t_min: f32,
}

impl BoxRay {
    #[inline(always)]
    pub(super) fn new(ray: &Ray) -> Self {
        let d = ray.direction.recip().clamp(Vec3::splat(-f32::MAX), Vec3::splat(f32::MAX));
        let from_high = |x: f32| (x.to_bits() >> 31) as usize;
        Self {
            origin: ray.origin.to_array(),
            inverse: d.to_array(),
            from_high: [from_high(d.x), from_high(d.y), from_high(d.z)],
            t_min: ray.t_min,
        }
    }
}

/// Up to four triangles side by side.
#[derive(Clone, Debug)]
pub(super) struct Quad {
    /// Vertex, axis, lane. NaN in empty lanes: nothing hits them.
    pub(super) vertices: [[Vec4; 3]; 3],
    /// Index of the first one's primitive; the others follow.
    pub(super) first: u32,
}

impl Quad {
    pub(super) fn new(first: usize, triangles: impl Iterator<Item = [Vec3; 3]>) -> Self {
        let mut vertices = [[Vec4::NAN; 3]; 3];
        for (lane, triangle) in triangles.enumerate() {
            for (rows, vertex) in vertices.iter_mut().zip(triangle) {
                for (axis, row) in rows.iter_mut().enumerate() {
                    row[lane] = vertex[axis];
                }
            }
        }
        Self { vertices, first: first as u32 }
    }

    /// How many triangles there are.
    pub(super) fn len(&self) -> usize {
        let x = &self.vertices[0][0];
        (0..QUAD).filter(|&lane| !x[lane].is_nan()).count()
    }

    /// The vertices of one triangle.
    #[inline(always)]
    pub(super) fn triangle(&self, lane: u32) -> [Vec3; 3] {
        let lane = lane as usize & (QUAD - 1);
        let [a, b, c] = &self.vertices;
        let vertex = |rows: &[Vec4; 3]| {
            Vec3::new(rows[0].as_ref()[lane], rows[1].as_ref()[lane], rows[2].as_ref()[lane])
        };
        [vertex(a), vertex(b), vertex(c)]
    }

    /// The first vertex of one triangle.
    #[inline(always)]
    pub(super) fn corner(&self, lane: u32) -> Vec3 {
        let (lane, [x, y, z]) = (lane as usize & (QUAD - 1), &self.vertices[0]);
        Vec3::new(x.as_ref()[lane], y.as_ref()[lane], z.as_ref()[lane])
    }

    /// A bit for each triangle that the ray's line may meet, and a bit for each of which single precision cannot say.
    ///
    /// A product's rounding keeps order, so a difference of two products has the right sign or is zero: the first are all that
    /// the exact test accepts and, but for the second, no others.
    #[inline(always)]
    pub(super) fn met(&self, ray: &ShearedRay) -> (u32, u32) {
        let [kx, ky, kz] = ray.axes();
        let (origin, shear) = (ray.permuted_origin(), ray.shear());
        let sheared = |rows: &[Vec4; 3]| {
            let z = rows[kz] - origin[2];
            ((rows[kx] - origin[0]) - z * shear.x, (rows[ky] - origin[1]) - z * shear.y)
        };
        let [a, b, c] = &self.vertices;
        let ((ax, ay), (bx, by), (cx, cy)) = (sheared(a), sheared(b), sheared(c));
        let u = cx * by - cy * bx;
        let v = ax * cy - ay * cx;
        let w = bx * ay - by * ax;
        let zero = Vec4::ZERO;
        let front = u.cmpge(zero) & v.cmpge(zero) & w.cmpge(zero);
        let back = u.cmple(zero) & v.cmple(zero) & w.cmple(zero);
        let unsure = u.cmpeq(zero) | v.cmpeq(zero) | w.cmpeq(zero);
        ((front | back).bitmask(), unsure.bitmask())
    }
}
