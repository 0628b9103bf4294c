//! Spectra that pbrt 4 knows by name: metals, glasses and illuminants.

use foton_math::Rgb;
use foton_math::glam::DVec3;

use crate::mitsuba::read::metals;

/// Brass, which Mitsuba does not name: refractiveindex.info, measured by Querry 1985, at 650, 550 and 450 nm.
const BRASS: [Rgb; 2] = [Rgb::new(0.444, 0.527, 1.094), Rgb::new(3.695, 2.765, 1.829)];

/// Glasses of Schott's catalogue: their index at the d line, 587.6 nm.
const GLASSES: [(&str, f32); 9] = [
    ("glass-BK7", 1.5168),
    ("glass-BAF10", 1.6700),
    ("glass-F5", 1.6034),
    ("glass-F11", 1.6206),
    ("glass-FK51A", 1.4866),
    ("glass-LASF9", 1.8503),
    ("glass-SF5", 1.6727),
    ("glass-SF10", 1.7283),
    ("glass-SF11", 1.7847),
];

/// Metals in both parts, and what Mitsuba calls them.
const METALS: [(&str, &str); 6] =
    [("Ag", "Ag"), ("Al", "Al"), ("Au", "Au"), ("Cu", "Cu"), ("MgO", "MgO"), ("TiO2", "TiO2")];

/// Chromaticities of illuminants under the 2° observer. `[CIE15]`
const ILLUMINANTS: [(&str, [f64; 2]); 18] = [
    ("stdillum-A", [0.447_58, 0.407_45]),
    ("stdillum-D50", [0.345_67, 0.358_50]),
    ("stdillum-D55", [0.332_42, 0.347_43]),
    ("stdillum-D65", [0.312_72, 0.329_03]),
    ("stdillum-D75", [0.299_02, 0.314_85]),
    ("stdillum-F1", [0.313_10, 0.337_27]),
    ("stdillum-F2", [0.372_08, 0.375_29]),
    ("stdillum-F3", [0.409_10, 0.394_30]),
    ("stdillum-F4", [0.440_18, 0.403_29]),
    ("stdillum-F5", [0.313_79, 0.345_31]),
    ("stdillum-F6", [0.377_90, 0.388_35]),
    ("stdillum-F7", [0.312_92, 0.329_33]),
    ("stdillum-F8", [0.345_88, 0.358_75]),
    ("stdillum-F9", [0.374_17, 0.372_81]),
    ("stdillum-F10", [0.346_09, 0.359_86]),
    ("stdillum-F11", [0.380_52, 0.377_13]),
    ("stdillum-F12", [0.436_95, 0.404_41]),
    ("illum-acesD60", [0.321_68, 0.337_67]),
];

/// What a name stands for.
pub(crate) enum Substance {
    /// An index of refraction, or a part of one.
    Index(Rgb),
    /// Light of luminance 1, in CIE XYZ.
    Light(DVec3),
}

/// The spectrum of that name.
pub(crate) fn find(name: &str) -> Option<Substance> {
    if let Some((_, ior)) = GLASSES.iter().find(|(known, _)| *known == name) {
        return Some(Substance::Index(Rgb::splat(*ior)));
    }
    if let Some((_, [x, y])) = ILLUMINANTS.iter().find(|(known, _)| *known == name) {
        return Some(Substance::Light(DVec3::new(x / y, 1.0, (1.0 - x - y) / y)));
    }
    let (metal, part) = name.strip_prefix("metal-")?.rsplit_once('-')?;
    let part = ["eta", "k"].iter().position(|known| *known == part)?;
    if metal == "CuZn" {
        return Some(Substance::Index(BRASS[part]));
    }
    let (_, metal) = METALS.iter().find(|(known, _)| *known == metal)?;
    let (eta, k) = metals::find(metal).ok()?;
    Some(Substance::Index([eta, k][part]))
}

/// All names.
pub(crate) fn names() -> Vec<String> {
    let metals = METALS.iter().map(|(name, _)| *name).chain(["CuZn"]);
    let metals = metals.flat_map(|metal| ["eta", "k"].map(|part| format!("metal-{metal}-{part}")));
    let others = GLASSES.iter().map(|(name, _)| *name).chain(ILLUMINANTS.iter().map(|(name, _)| *name));
    metals.chain(others.map(str::to_owned)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_stands_for_something() {
        for name in names() {
            assert!(find(&name).is_some(), "{name}");
        }
        assert!(find("metal-Cu").is_none() && find("metal-Xx-eta").is_none());
    }
}
