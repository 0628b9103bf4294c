//! Separable filters of planes whose edge pixels go on for ever.

/// A one-dimensional filter of odd length, centred.
pub(crate) type Kernel = Vec<f32>;

/// `weight(x)` for x = −radius … radius.
pub(crate) fn kernel(radius: usize, weight: impl Fn(f64) -> f64) -> Vec<f64> {
    let r = radius as i32;
    (-r..=r).map(|x| weight(f64::from(x))).collect()
}

/// `kernel` with its positive weights scaled to sum to 1 and its negative ones to −1.
pub(crate) fn normalised(kernel: &[f64]) -> Kernel {
    let sum = |sign: f64| kernel.iter().filter(|w| **w * sign > 0.0).sum::<f64>().abs();
    let (positive, negative) = (sum(1.0), sum(-1.0));
    kernel
        .iter()
        .map(|&w| (w / if w > 0.0 { positive } else { negative.max(f64::MIN_POSITIVE) }) as f32)
        .collect()
}

/// `plane`, of `width` values in a row, filtered by `across` along x and by `down` along y.
pub(crate) fn separable(plane: &[f32], width: usize, across: &[f32], down: &[f32]) -> Vec<f32> {
    let mut rows = vec![0.0; plane.len()];
    let margin = across.len() / 2;
    let mut padded = vec![0.0; width + 2 * margin];
    for (to, from) in rows.chunks_exact_mut(width).zip(plane.chunks_exact(width)) {
        padded[..margin].fill(from[0]);
        padded[margin..margin + width].copy_from_slice(from);
        padded[margin + width..].fill(from[width - 1]);
        for (shift, &weight) in across.iter().enumerate() {
            add_scaled(to, weight, &padded[shift..]);
        }
    }
    let mut result = vec![0.0; plane.len()];
    let last = plane.len() / width - 1;
    for (y, to) in result.chunks_exact_mut(width).enumerate() {
        for (shift, &weight) in down.iter().enumerate() {
            let row = (y + shift).saturating_sub(down.len() / 2).min(last);
            add_scaled(to, weight, &rows[row * width..]);
        }
    }
    result
}

/// `to += weight · from`.
fn add_scaled(to: &mut [f32], weight: f32, from: &[f32]) {
    for (to, from) in to.iter_mut().zip(from) {
        *to += weight * from;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_go_on_for_ever() {
        let plane = [1.0, 2.0, 4.0, 8.0, 16.0, 32.0];
        let shift = [1.0, 0.0, 0.0];
        assert_eq!(separable(&plane, 3, &shift, &[1.0]), [1.0, 1.0, 2.0, 8.0, 8.0, 16.0]);
        assert_eq!(separable(&plane, 3, &[1.0], &shift), [1.0, 2.0, 4.0, 1.0, 2.0, 4.0]);
        // A filter wider than the image, over a constant.
        assert_eq!(separable(&[3.0; 6], 2, &[0.125; 8], &[0.25; 4]), [3.0; 6]);
    }

    #[test]
    fn each_sign_of_a_normalised_kernel_sums_to_one() {
        let derivative = normalised(&kernel(2, |x| x));
        assert_eq!(derivative, [-2.0 / 3.0, -1.0 / 3.0, 0.0, 1.0 / 3.0, 2.0 / 3.0]);
        assert_eq!(normalised(&kernel(1, |_| 2.0)), [1.0 / 3.0; 3]);
    }
}
