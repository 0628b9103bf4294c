//! How bright emitters count that are seen.

/// White, over the mean reflected luminance: that of middle grey is a fifth of it. Emitters that are seen are often a hundred times as
/// bright as what they light; where an error includes them, they count as no brighter than this, as they look.
pub const WHITE: f64 = 5.0;
