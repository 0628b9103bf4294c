//! Colour spaces of `rgb` parameters, brought to linear sRGB.

use foton_math::glam::{DMat3, DVec3};

/// Chromaticities of red, green, blue and white.
type Primaries = [[f64; 2]; 4];

const D65: [f64; 2] = [0.3127, 0.3290];

/// Names and primaries: IEC 61966-2-1, SMPTE EG 432-1, ITU-R BT.2020, SMPTE ST 2065-1.
const SPACES: [(&str, Primaries); 4] = [
    ("srgb", [[0.64, 0.33], [0.30, 0.60], [0.15, 0.06], D65]),
    ("dci-p3", [[0.68, 0.32], [0.265, 0.69], [0.15, 0.06], D65]),
    ("rec2020", [[0.708, 0.292], [0.17, 0.797], [0.131, 0.046], D65]),
    ("aces2065-1", [[0.7347, 0.2653], [0.0, 1.0], [0.0001, -0.077], [0.32168, 0.33767]]),
];

/// Names of all spaces.
pub(crate) fn names() -> impl Iterator<Item = &'static str> {
    SPACES.iter().map(|(name, _)| *name)
}

/// A colour space by what makes linear sRGB of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ColourSpace(DMat3);

impl Default for ColourSpace {
    fn default() -> Self {
        Self(DMat3::IDENTITY)
    }
}

impl ColourSpace {
    /// The space of that name.
    pub(crate) fn of(name: &str) -> Option<Self> {
        let (_, primaries) = SPACES.iter().find(|(known, _)| known.eq_ignore_ascii_case(name))?;
        if *primaries == SPACES[0].1 {
            return Some(Self::default());
        }
        // White is white in all of them: a white surface or lamp stays colourless.
        let [to_xyz, srgb] = [primaries, &SPACES[0].1].map(to_xyz);
        let matrix = srgb.inverse() * to_xyz;
        let white = matrix * DVec3::ONE;
        Some(Self(DMat3::from_diagonal(white.recip()) * matrix))
    }

    /// Linear sRGB; colours that it does not have are those nearest without light below zero.
    pub(crate) fn to_srgb(self, colour: DVec3) -> DVec3 {
        if self.0 == DMat3::IDENTITY { colour } else { (self.0 * colour).max(DVec3::ZERO) }
    }
}

/// What makes CIE XYZ of a space, white having a luminance of 1.
fn to_xyz([red, green, blue, white]: &Primaries) -> DMat3 {
    let xyz = |[x, y]: [f64; 2]| DVec3::new(x / y, 1.0, (1.0 - x - y) / y);
    let columns = DMat3::from_cols(xyz(*red), xyz(*green), xyz(*blue));
    columns * DMat3::from_diagonal(columns.inverse() * xyz(*white))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_stays_white_and_rec2020_is_as_published() {
        for name in names() {
            let space = ColourSpace::of(name).unwrap();
            assert!((space.to_srgb(DVec3::ONE) - DVec3::ONE).abs().max_element() < 1e-12, "{name}");
        }
        // ITU-R BT.2087, inverted: the primaries of BT.709 in BT.2020.
        let red = ColourSpace::of("rec2020").unwrap().to_srgb(DVec3::new(0.6274, 0.0691, 0.0164));
        assert!((red - DVec3::X).abs().max_element() < 1e-3, "{red}");
    }
}
