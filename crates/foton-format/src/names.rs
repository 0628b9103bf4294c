//! The names that Mitsuba 3 knows, and the nearest of them to a misspelt one.

use foton_scene::description::Bsdf;
use foton_scene::plugins;

/// Plugins of one kind: those read here, and those that only Mitsuba has.
pub(crate) struct Plugins {
    /// The tag of the elements that name them.
    pub(crate) kind: &'static str,
    /// Plugins that are read.
    pub(crate) supported: fn() -> Vec<&'static str>,
    /// Plugins of Mitsuba 3 that are not.
    pub(crate) elsewhere: &'static [&'static str],
}

pub(crate) const SHAPES: Plugins = Plugins {
    kind: "shape",
    supported: || plugins::names(plugins::shapes::ALL).collect(),
    elsewhere: &[
        "instance",
        "shapegroup",
        "merge",
        "blender",
        "bsplinecurve",
        "linearcurve",
        "sdfgrid",
        "ellipsoids",
        "ellipsoidsmesh",
    ],
};

pub(crate) const BSDFS: Plugins = Plugins {
    kind: "bsdf",
    supported: || bsdfs().collect(),
    elsewhere: &[
        "pplastic",
        "principled",
        "principledthin",
        "blendbsdf",
        "bumpmap",
        "normalmap",
        "hair",
        "measured",
        "measured_polarized",
        "polarizer",
        "retarder",
        "circular",
        "roughdiffuse",
        "coating",
        "roughcoating",
        "mixturebsdf",
        "phong",
        "ward",
        "difftrans",
    ],
};

pub(crate) const TEXTURES: Plugins = Plugins {
    kind: "texture",
    supported: || plugins::names(plugins::textures::ALL).collect(),
    elsewhere: &[
        "mesh_attribute",
        "volume",
        "uniform",
        "regular",
        "irregular",
        "rawconstant",
        "srgb",
        "d65",
        "blackbody",
        "scale",
        "vertexcolors",
        "gridtexture",
        "wireframe",
        "curvature",
    ],
};

pub(crate) const EMITTERS: Plugins = Plugins {
    kind: "emitter",
    supported: || plugins::names(plugins::emitters::ALL).collect(),
    elsewhere: &["directionalarea", "projector", "sunsky", "timed_sunsky", "sky", "sun", "collimated"],
};

pub(crate) const SENSORS: Plugins = Plugins {
    kind: "sensor",
    supported: || vec!["perspective"],
    elsewhere: &["thinlens", "orthographic", "radiancemeter", "irradiancemeter", "distant", "batch"],
};

pub(crate) const FILMS: Plugins =
    Plugins { kind: "film", supported: || vec!["hdrfilm"], elsewhere: &["specfilm"] };

pub(crate) const FILTERS: Plugins = Plugins {
    kind: "rfilter",
    supported: || vec!["box", "tent", "gaussian"],
    elsewhere: &["mitchell", "catmullrom", "lanczos"],
};

/// Plugins of BSDFs: those of models, and those that stand around others.
fn bsdfs() -> impl Iterator<Item = &'static str> {
    let models = Bsdf::defaults(false).into_iter().chain(Bsdf::defaults(true)).map(|b| b.plugin());
    plugins::names(plugins::wrappers::ALL).chain(models)
}

/// Tags of single values.
pub(crate) const VALUE_TAGS: &[&str] =
    &["boolean", "integer", "float", "string", "point", "vector", "spectrum", "rgb", "srgb", "transform"];

/// Tags of nested plugins.
pub(crate) const OBJECT_TAGS: &[&str] = &[
    "shape",
    "bsdf",
    "emitter",
    "sensor",
    "film",
    "rfilter",
    "sampler",
    "integrator",
    "texture",
    "medium",
    "phase",
    "volume",
];

/// Indices of refraction by name: Mitsuba's table, after Hecht, "Optics", 4th edition.
pub(crate) const REFRACTION: &[(&str, f32)] = &[
    ("vacuum", 1.0),
    ("helium", 1.000_036),
    ("hydrogen", 1.000_132),
    ("air", 1.000_277),
    ("carbon dioxide", 1.000_45),
    ("water", 1.333),
    ("acetone", 1.36),
    ("ethanol", 1.361),
    ("carbon tetrachloride", 1.461),
    ("glycerol", 1.4729),
    ("benzene", 1.501),
    ("silicone oil", 1.520_45),
    ("bromine", 1.661),
    ("water ice", 1.31),
    ("fused quartz", 1.458),
    ("pyrex", 1.47),
    ("acrylic glass", 1.49),
    ("polypropylene", 1.49),
    ("bk7", 1.5046),
    ("sodium chloride", 1.544),
    ("amber", 1.55),
    ("pet", 1.575),
    ("diamond", 2.419),
];

/// `, did you mean "…"?` with the known name nearest to `name`, or nothing where none is near.
pub(crate) fn did_you_mean<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    nearest(name, known).map_or_else(String::new, |near| format!(", did you mean \"{near}\"?"))
}

/// The known name within a third of the letters (at least one edit) of `name`.
pub(crate) fn nearest<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let letters = name.chars().count();
    if letters > 64 {
        return None;
    }
    let budget = (letters / 3).max(1);
    known
        .into_iter()
        .filter(|candidate| candidate.chars().count().abs_diff(letters) <= budget)
        .map(|candidate| (edits(name, candidate), candidate))
        .filter(|&(edits, candidate)| edits <= budget && edits < candidate.chars().count())
        .min_by_key(|&(edits, _)| edits)
        .map(|(_, candidate)| candidate)
}

/// The number of inserted, removed, changed and swapped letters (optimal string alignment), upper case ignored.
fn edits(a: &str, b: &str) -> usize {
    let [a, b] = [a, b].map(|s| s.to_lowercase().chars().collect::<Vec<_>>());
    let mut rows = vec![vec![0; b.len() + 1]; a.len() + 1];
    for i in 0..=a.len() {
        for j in 0..=b.len() {
            rows[i][j] = if i == 0 || j == 0 {
                i + j
            } else {
                let changed = rows[i - 1][j - 1] + usize::from(a[i - 1] != b[j - 1]);
                let one_less = rows[i - 1][j].min(rows[i][j - 1]) + 1;
                let swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
                let swap = if swapped { rows[i - 2][j - 2] + 1 } else { usize::MAX };
                changed.min(one_less).min(swap)
            };
        }
    }
    rows[a.len()][b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edits_count_insertions_removals_changes_and_swaps() {
        for (a, b, count) in [
            ("", "abc", 3),
            ("abc", "abc", 0),
            ("abc", "ABC", 0),
            ("abd", "abc", 1),
            ("bac", "abc", 1),
            ("kitten", "sitting", 3),
        ] {
            assert_eq!(edits(a, b), count, "{a} {b}");
        }
    }

    #[test]
    fn only_a_near_name_is_offered() {
        assert_eq!(nearest("dielectrc", bsdfs()), Some("dielectric"));
        assert_eq!(nearest("velvet", bsdfs()), None);
        assert_eq!(nearest("x", ["y", "z"]), None);
    }
}
