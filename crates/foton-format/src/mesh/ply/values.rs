//! Values that are skipped, and numbers that count.

use super::header::{Kind, Property};
use super::numbers::Numbers;
use crate::mesh::words::Problem;

pub(super) fn skip_value(property: &Property, numbers: &mut impl Numbers) -> Result<(), Problem> {
    match property.kind {
        Kind::Scalar(number) => numbers.next(number).map(|_| ()),
        Kind::List { count, item } => {
            for _ in 0..length(numbers.next(count)?, numbers)? {
                numbers.next(item)?;
            }
            Ok(())
        }
    }
}

/// The length of a list; more items than bytes are left run into the end of the file.
pub(super) fn length(count: f64, numbers: &impl Numbers) -> Result<u64, Problem> {
    whole(count).ok_or_else(|| numbers.problem(format!("{count} is not the length of a list")))
}

/// A number that counts, if it does; all types of a file but 64-bit floats fit.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the range is checked")]
pub(super) fn whole(number: f64) -> Option<u64> {
    ((0.0..=4_294_967_295.0).contains(&number) && number.fract() == 0.0).then_some(number as u64)
}
