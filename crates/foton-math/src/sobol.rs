//! Sobol' points: of each 2^k in a row one lies in each of 2^k equal intervals, in every dimension, and in the first two in each
//! of 2^k equal boxes, whatever their shape. `[SOB67]`
//!
//! A scramble flips the same digits of all points, which keeps that: for a random one each point is uniform.

/// Dimensions of a point.
pub const DIMENSIONS: usize = 4;

/// For each bit of an index, what it adds to each coordinate.
const COLUMNS: [[u32; DIMENSIONS]; 32] = columns();

/// Degree, inner coefficients and first odd numbers of the primitive polynomials of all dimensions but the first. `[JK08]`
const POLYNOMIALS: [(usize, u32, [u32; 3]); DIMENSIONS - 1] =
    [(1, 0, [1, 0, 0]), (2, 1, [1, 3, 0]), (3, 1, [1, 3, 1])];

const fn columns() -> [[u32; DIMENSIONS]; 32] {
    let mut columns = [[0u32; DIMENSIONS]; 32];
    let mut i = 0;
    while i < 32 {
        columns[i][0] = 1 << (31 - i);
        let mut d = 1;
        while d < DIMENSIONS {
            let (degree, inner, first) = POLYNOMIALS[d - 1];
            columns[i][d] = if i < degree {
                first[i] << (31 - i)
            } else {
                let mut sum = columns[i - degree][d] ^ (columns[i - degree][d] >> degree);
                let mut k = 1;
                while k < degree {
                    if (inner >> (degree - 1 - k)) & 1 == 1 {
                        sum ^= columns[i - k][d];
                    }
                    k += 1;
                }
                sum
            };
            d += 1;
        }
        i += 1;
    }
    columns
}

/// The point of an index, as binary fractions of 32 digits, scrambled.
#[must_use]
#[inline]
pub fn point(index: u32, scramble: [u32; DIMENSIONS]) -> [u32; DIMENSIONS] {
    let (mut point, mut left) = (scramble, index);
    while left != 0 {
        let column = &COLUMNS[left.trailing_zeros() as usize];
        point.iter_mut().zip(column).for_each(|(x, c)| *x ^= c);
        left &= left - 1;
    }
    point
}

/// An index in another order, in which each 4^k in a row, from a multiple of that on, are the same 4^k: all strata stay, and beside the
/// points of another sequence they pair up by chance. In one order, what is drawn from the one would follow from the other.
///
/// Each digit of the index in base 4 is permuted, by a permutation that the digits above it choose. Nested like that, Owen (1998)
/// permutes the digits of coordinates. `[OWE98]`
#[must_use]
#[inline]
pub const fn reordered(index: u32, order: u32) -> u32 {
    let mut result = index & (u32::MAX << (2 * DIGITS));
    let mut digit = 0;
    while digit < DIGITS {
        let (value, above) = ((index >> (2 * digit)) & 3, index >> (2 * digit) >> 2);
        result |= permuted(value, chance(order, digit, above)) << (2 * digit);
        digit += 1;
    }
    result
}

/// Digits that are permuted: the order of 4⁸ points repeats.
const DIGITS: u32 = 8;

/// A number that looks like chance, of a digit and those above it. Source: the last steps of MurmurHash3.
const fn chance(order: u32, digit: u32, above: u32) -> u32 {
    let mut x = order ^ above.wrapping_mul(0x9e37_79b9) ^ digit.wrapping_mul(0x7feb_352d);
    x = (x ^ (x >> 16)).wrapping_mul(0x85eb_ca6b);
    x = (x ^ (x >> 13)).wrapping_mul(0xc2b2_ae35);
    x ^ (x >> 16)
}

/// What the `chance`-th of the 24 permutations of four values makes of one.
const fn permuted(value: u32, chance: u32) -> u32 {
    (PERMUTATIONS[(chance % 24) as usize] >> (2 * value)) as u32 & 3
}

/// The permutations of four values, two binary digits for what each makes of a value.
const PERMUTATIONS: [u8; 24] = permutations();

const fn permutations() -> [u8; 24] {
    let mut all = [0; 24];
    let mut n = 0;
    while n < 24 {
        let mut left = [0u8, 1, 2, 3];
        let (mut rest, mut i) = (n, 0);
        while i < 3 {
            let other = i + rest % (4 - i);
            rest /= 4 - i;
            (left[i], left[other]) = (left[other], left[i]);
            i += 1;
        }
        all[n] = left[0] | left[1] << 2 | left[2] << 4 | left[3] << 6;
        n += 1;
    }
    all
}

/// A binary fraction as a number in [0, 1).
#[must_use]
#[inline]
pub const fn unit(fraction: u32) -> f32 {
    (fraction >> 8) as f32 * (1.0 / (1 << 24) as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_power_of_two_of_points_is_stratified_in_every_dimension() {
        let scramble = [0x1234_5678, 0x9abc_def0, 0x0f1e_2d3c, 0xdead_beef];
        for k in 0..8 {
            for block in 0..4 {
                for d in 0..DIMENSIONS {
                    let mut found = vec![false; 1 << k];
                    for i in 0..1 << k {
                        let x = point((block << k) + i, scramble)[d];
                        found[if k == 0 { 0 } else { (x >> (32 - k)) as usize }] = true;
                    }
                    assert!(found.iter().all(|f| *f), "dimension {d}, block {block} of {}", 1 << k);
                }
            }
        }
    }

    #[test]
    fn the_first_two_dimensions_are_stratified_in_boxes_of_all_shapes() {
        for across in 0..=6u32 {
            let down = 6 - across;
            let mut found = [false; 64];
            for i in 0..64 {
                let p = point(i + 128, [0xaaaa_5555, 0x1357_9bdf, 0, 0]).map(|x| u64::from(x) << 32);
                let cell = |x: u64, bits: u32| if bits == 0 { 0 } else { (x >> (64 - bits)) as usize };
                found[cell(p[0], across) << down | cell(p[1], down)] = true;
            }
            assert!(found.iter().all(|f| *f), "{across} digits by {down}");
        }
    }

    #[test]
    fn another_order_keeps_blocks_together_and_mixes_them() {
        for order in [1, 77, 0x9e37_79b9, u32::MAX] {
            for k in [0, 2, 4, 6, 8] {
                for block in 0..4 {
                    let all: Vec<u32> = (0..1 << k).map(|i| reordered((block << k) + i, order)).collect();
                    let mut low: Vec<u32> = all.iter().map(|x| x & ((1 << k) - 1)).collect();
                    low.sort_unstable();
                    assert!(low.iter().copied().eq(0..1 << k), "each once");
                    assert!(all.iter().all(|x| x >> k == all[0] >> k), "in one block");
                }
            }
        }
        // Pairs of points that two orders make fall into all boxes of the plane of their first coordinates.
        let mut boxes = [0; 64];
        for i in 0..4096 {
            let x = |order| (reordered(i, order).reverse_bits() >> 29) as usize;
            boxes[x(0x1234_5678) * 8 + x(0x0bad_cafe)] += 1;
        }
        assert!(boxes.iter().all(|n| (32..=128).contains(n)), "{boxes:?}");
    }

    #[test]
    fn each_permutation_of_four_is_one_of_twenty_four() {
        let all: std::collections::HashSet<_> =
            (0..24).map(|n| [0, 1, 2, 3].map(|v| permuted(v, n))).collect();
        assert_eq!(all.len(), 24);
        assert!(
            all.iter().all(|p| p.iter().sum::<u32>() == 6 && p.iter().fold(0, |bits, v| bits | 1 << v) == 15)
        );
    }

    #[test]
    fn fractions_become_numbers_below_one() {
        assert_eq!((unit(0), unit(1 << 31)), (0.0, 0.5));
        assert!(unit(u32::MAX) < 1.0);
    }
}
