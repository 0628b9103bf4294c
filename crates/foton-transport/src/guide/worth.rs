//! What light is worth where a photon is stored: its part in the squared noise of the picture.
//!
//! A photon of power Φ adds w Φ/(π r²) to a pixel that sees its place with the weight w. Squared and summed over the discs that
//! hold it, whose area r² and whose number both go by a the area that the pixel covers there, that is about (w/a)² Φ². Footprints
//! stand in for discs, so that what is learnt depends on no radius, α or picture, and is the same for all runs of a sweep.

use foton_math::Aabb;
use foton_math::glam::Vec3;

use crate::camera_paths::HitPoint;

/// About so many hit points stand for all.
const MAX_POINTS: usize = 1 << 16;

/// Leaves hold up to twice as many points.
const IN_LEAF: usize = 4;

/// Discs are about so many times as wide as footprints: photons beyond are worth nothing.
const REACH: f32 = 2.5;

/// The mean over directions of a BSDF that is no constant.
const GLOSSY_WEIGHT: f32 = 0.3;

/// One of the points that stand for all.
#[derive(Clone, Copy)]
struct Point {
    position: Vec3,
    weight: f32,
    footprint: f32,
}

#[derive(Clone, Copy)]
struct Leaf {
    bounds: Aabb,
    worth: f32,
}

/// Hit points that stand for all that is seen, by one camera or by several.
#[derive(Default)]
pub struct WorthPoints(Vec<Point>);

impl WorthPoints {
    /// Adds those of a camera.
    pub fn add(&mut self, hit_points: &[HitPoint], is_specular: impl Fn(&HitPoint) -> bool) {
        let step = hit_points.len().div_ceil(MAX_POINTS).max(1);
        let point = |h: &HitPoint| {
            let factor = if h.gloss.is_some() { GLOSSY_WEIGHT } else { 1.0 };
            let (weight, footprint) = (factor * h.weight.luminance(), h.footprint.max(f32::MIN_POSITIVE));
            let counts = weight > 0.0 && weight.is_finite() && footprint.is_finite() && !is_specular(h);
            counts.then_some(Point { position: h.position, weight, footprint })
        };
        self.0.extend(hit_points.iter().step_by(step).filter_map(point));
    }
}

/// A balanced tree over hit points: small leaves where the view is close.
#[derive(Default)]
pub struct Worth {
    /// Levels of inner nodes.
    levels: u32,
    /// Axis and place of each split; the parts of node i are nodes 2i + 1 and 2i + 2.
    splits: Vec<(u8, f32)>,
    leaves: Vec<Leaf>,
}

impl Worth {
    /// Of what is seen.
    #[must_use]
    pub fn new(hit_points: &[HitPoint], is_specular: impl Fn(&HitPoint) -> bool) -> Self {
        let mut points = WorthPoints::default();
        points.add(hit_points, is_specular);
        Self::over(points)
    }

    /// Of what several cameras see.
    #[must_use]
    pub fn over(points: WorthPoints) -> Self {
        let step = points.0.len().div_ceil(MAX_POINTS).max(1);
        let mut points: Vec<Point> = points.0.into_iter().step_by(step).collect();
        let levels = (points.len() / IN_LEAF).checked_ilog2().unwrap_or(0);
        if points.is_empty() {
            return Self::default();
        }
        let mut tree = Self { levels, splits: vec![(0, 0.0); (1 << levels) - 1], leaves: Vec::new() };
        tree.divide(0, 0, &mut points);
        tree
    }

    fn divide(&mut self, node: usize, level: u32, points: &mut [Point]) {
        if level == self.levels {
            self.leaves.push(Leaf::of(points));
            return;
        }
        let bounds = points.iter().fold(Aabb::EMPTY, |b, p| b.with(p.position));
        let axis = (bounds.max - bounds.min).max_position();
        let middle = points.len() / 2;
        let by_axis = |a: &Point, b: &Point| a.position[axis].total_cmp(&b.position[axis]);
        let split = points.select_nth_unstable_by(middle, by_axis).1.position[axis];
        self.splits[node] = (axis as u8, split);
        let (below, above) = points.split_at_mut(middle);
        self.divide(2 * node + 1, level + 1, below);
        self.divide(2 * node + 2, level + 1, above);
    }

    /// What a photon of power 1 is worth at `position`; 0 where no disc is.
    #[must_use]
    pub fn at(&self, position: Vec3) -> f32 {
        let mut node = 0;
        for _ in 0..self.levels {
            let (axis, split) = self.splits[node];
            node = 2 * node + if position[usize::from(axis)] < split { 1 } else { 2 };
        }
        let leaf = self.leaves.get(node - self.splits.len());
        let contains = |b: &Aabb| position.cmpge(b.min).all() && position.cmple(b.max).all();
        leaf.filter(|leaf| contains(&leaf.bounds)).map_or(0.0, |leaf| leaf.worth)
    }

    /// Bytes held.
    #[must_use]
    pub const fn bytes(&self) -> usize {
        self.splits.capacity() * size_of::<(u8, f32)>() + self.leaves.capacity() * size_of::<Leaf>()
    }

    /// The largest number of bytes that one takes.
    pub const MAX_BYTES: usize = MAX_POINTS / IN_LEAF * (size_of::<Leaf>() + size_of::<(u8, f32)>());
}

impl Leaf {
    fn of(points: &[Point]) -> Self {
        let mut bounds = Aabb::EMPTY;
        let (mut squares, mut area) = (0.0, 0.0);
        for p in points {
            let reach = Vec3::splat(REACH * p.footprint.sqrt());
            bounds = bounds.union(Aabb { min: p.position - reach, max: p.position + reach });
            squares += f64::from(p.weight).powi(2) / f64::from(p.footprint);
            area += f64::from(p.footprint);
        }
        Self { bounds, worth: (squares / area) as f32 }
    }
}
