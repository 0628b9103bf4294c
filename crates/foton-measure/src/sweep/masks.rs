//! The parts of the image with figures of their own: everywhere that anything reflects, where light is smooth, and the rest.

/// Pixels to each side that must show one shape, and over which light is compared.
const REACH: usize = 3;

/// A pixel is smooth if luminance around it differs by less than this share, or by less than at half of all pixels.
const SMOOTH: f64 = 0.25;

/// Which pixels count. Fixed before anything is measured, by shapes and by the reference alone.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Masks {
    /// Sees something that reflects.
    pub seen: Vec<bool>,
    /// Seen, of one shape for three pixels around, and among the smoother.
    pub smooth: Vec<bool>,
    /// Seen and not smooth.
    pub edge: Vec<bool>,
}

impl Masks {
    /// `shapes` and `luminance` of `width` pixels a row; luminance is of the reference's reflected light.
    pub(crate) fn new(seen: Vec<bool>, shapes: &[u32], luminance: &[f64], width: usize) -> Self {
        let height = seen.len() / width.max(1);
        let blurred = around(luminance, width, 1, |values| {
            let (sum, count) = values.fold((0.0, 0.0), |(s, n), v| (s + v, n + 1.0));
            sum / count
        });
        let contrast = around(&blurred, width, REACH, |values| {
            let (low, high) = values.fold((f64::MAX, 0f64), |(a, b), v| (a.min(v), b.max(v)));
            (high - low) / (0.5 * (high + low)).max(f64::MIN_POSITIVE)
        });
        let one_shape = |pixel: usize| {
            let (x, y) = (pixel % width, pixel / width);
            let columns = x.saturating_sub(REACH)..(x + REACH + 1).min(width);
            let mut rows = y.saturating_sub(REACH)..(y + REACH + 1).min(height);
            rows.all(|y| shapes[y * width..][columns.clone()].iter().all(|s| *s == shapes[pixel]))
        };
        let mut of_seen: Vec<f64> =
            contrast.iter().zip(&seen).filter(|(_, seen)| **seen).map(|(c, _)| *c).collect();
        of_seen.sort_unstable_by(f64::total_cmp);
        let median = of_seen.get(of_seen.len() / 2).copied().unwrap_or(0.0);
        let limit = SMOOTH.max(median);
        let smooth: Vec<bool> =
            (0..seen.len()).map(|p| seen[p] && contrast[p] <= limit && one_shape(p)).collect();
        let edge = seen.iter().zip(&smooth).map(|(seen, smooth)| *seen && !smooth).collect();
        Self { seen, smooth, edge }
    }

    /// All, smooth, edge.
    pub(crate) const fn all(&self) -> [&Vec<bool>; 3] {
        [&self.seen, &self.smooth, &self.edge]
    }

    /// Share of the seen pixels that are smooth.
    #[must_use]
    pub fn smooth_share(&self) -> f64 {
        let count = |mask: &[bool]| mask.iter().filter(|m| **m).count() as f64;
        count(&self.smooth) / count(&self.seen).max(1.0)
    }
}

/// `f` of the values within `reach` of each pixel.
fn around(
    values: &[f64],
    width: usize,
    reach: usize,
    f: impl Fn(&mut dyn Iterator<Item = f64>) -> f64,
) -> Vec<f64> {
    let height = values.len() / width.max(1);
    (0..values.len())
        .map(|pixel| {
            let (x, y) = (pixel % width, pixel / width);
            let columns = x.saturating_sub(reach)..(x + reach + 1).min(width);
            let rows = y.saturating_sub(reach)..(y + reach + 1).min(height);
            f(&mut rows.flat_map(|y| values[y * width..][columns.clone()].iter().copied()))
        })
        .collect()
}

/// The mean of `values` where `mask` says so; zero where nothing does.
pub(crate) fn mean(mask: &[bool], values: impl Iterator<Item = f64>) -> f64 {
    let picked = mask.iter().zip(values).filter(|(m, _)| **m);
    let (sum, count) = picked.fold((0.0, 0.0), |(sum, count), (_, v)| (sum + v, count + 1.0));
    if count > 0.0 { sum / count } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_of_shapes_and_of_light_are_not_smooth() {
        let (width, height) = (40, 30);
        let shapes: Vec<u32> = (0..width * height).map(|p| u32::from(p % width >= 20)).collect();
        // A gentle ramp, with a shadow's edge across the right half.
        let light: Vec<f64> = (0..width * height)
            .map(|p| if p % width >= 20 && p / width < 10 { 0.1 } else { 1.0 + 0.01 * (p / width) as f64 })
            .collect();
        let mut seen = vec![true; width * height];
        seen[0] = false;
        let masks = Masks::new(seen, &shapes, &light, width);
        let at = |x: usize, y: usize| y * width + x;
        assert!(masks.smooth[at(5, 15)] && masks.smooth[at(30, 25)] && masks.smooth[at(30, 3)]);
        assert!(masks.edge[at(19, 25)] && masks.edge[at(22, 25)] && masks.edge[at(30, 11)]);
        assert!(!masks.smooth[0] && !masks.edge[0], "unseen");
        assert!(masks.smooth_share() > 0.5);
        assert_eq!(mean(&[true, false, true], [1.0, 9.0, 3.0].into_iter()), 2.0);
    }
}
