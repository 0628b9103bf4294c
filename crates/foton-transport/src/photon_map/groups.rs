//! Which hit points go into a packet together: those that are close to each other.

use foton_math::glam::Vec3;
use foton_math::{Aabb, Cancel, Cancelled};
use rayon::prelude::*;

use super::packet::LANES;
use crate::camera_paths::HitPoint;

/// A packet is split further while it is wider than this many of its largest radius: most photons near a wide packet are near
/// none of its discs.
const MAX_WIDTH: f32 = 6.0;

/// Hit points of one task, in sample order, where they are laid out once: they come from some rows of pixels and are close together
/// already.
pub const BAND: usize = 1 << 16;

/// Groups of up to [`LANES`] hit points, as indices.
#[derive(Debug, Default)]
pub struct Groups {
    /// Group by group.
    members: Vec<u32>,
    /// How many each has.
    counts: Vec<u8>,
}

impl Groups {
    /// How many groups there are.
    pub const fn count(&self) -> usize {
        self.counts.len()
    }

    /// The members of each group.
    pub fn iter(&self) -> impl Iterator<Item = &[u32]> {
        let mut rest = &self.members[..];
        self.counts.iter().map(move |&count| {
            let (group, others) = rest.split_at(usize::from(count));
            rest = others;
            group
        })
    }
}

/// A hit point on its way into a group.
#[derive(Clone, Copy)]
struct Point {
    position: Vec3,
    radius: f32,
    index: u32,
}

/// Groups the hit points that `belongs` selects into packets, band by band of so many in sample order: halved at the median of the longest axis until at most
/// [`LANES`] are close together. The same for any number of threads.
///
/// # Errors
/// When cancelled.
pub fn group(
    found: &[HitPoint],
    belongs: impl Fn(&HitPoint) -> bool + Sync,
    in_band: usize,
    cancel: &Cancel,
) -> Result<Groups, Cancelled> {
    let of_band = |(band, found): (usize, &[HitPoint])| {
        let selected = found.iter().enumerate().filter(|(_, h)| belongs(h));
        let index = |i: usize| (band * in_band + i) as u32;
        let mut points: Vec<Point> = selected
            .map(|(i, h)| Point { position: h.position, radius: h.radius2.sqrt(), index: index(i) })
            .collect();
        let mut counts = Vec::with_capacity(2 * points.len() / LANES);
        halve(&mut points, &mut counts, cancel)?;
        Ok(Groups { members: points.iter().map(|p| p.index).collect(), counts })
    };
    let bands: Vec<Groups> =
        found.par_chunks(in_band.max(1)).enumerate().map(of_band).collect::<Result<_, _>>()?;
    Ok(bands.into_iter().fold(Groups::default(), |mut all, band| {
        all.members.extend(band.members);
        all.counts.extend(band.counts);
        all
    }))
}

fn halve(points: &mut [Point], counts: &mut Vec<u8>, cancel: &Cancel) -> Result<(), Cancelled> {
    if points.is_empty() {
        return Ok(());
    }
    cancel.check()?;
    let bounds = points.iter().fold(Aabb::EMPTY, |b, p| b.with(p.position));
    let size = bounds.size();
    if points.len() <= LANES {
        let radius = points.iter().fold(0f32, |r, p| r.max(p.radius));
        if points.len() == 1 || size.max_element() <= MAX_WIDTH * radius {
            counts.push(points.len() as u8);
            return Ok(());
        }
    }
    let axis = size.max_position();
    // Whole packets to the left, so that few are left part empty.
    let half = points.len().div_ceil(2);
    let middle = if points.len() > LANES { half.next_multiple_of(LANES).min(points.len() - 1) } else { half };
    let by_axis =
        |a: &Point, b: &Point| a.position[axis].total_cmp(&b.position[axis]).then(a.index.cmp(&b.index));
    points.select_nth_unstable_by(middle, by_axis);
    let (left, right) = points.split_at_mut(middle);
    halve(left, counts, cancel)?;
    halve(right, counts, cancel)
}

#[cfg(test)]
mod tests;
