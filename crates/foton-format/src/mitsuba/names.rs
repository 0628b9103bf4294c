//! The names that Mitsuba 3 knows.

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
        "merge",
        "blender",
        "bsplinecurve",
        "linearcurve",
        "sdfgrid",
        "ellipsoids",
        "ellipsoidsmesh",
        "hair",
        "heightfield",
        "deformable",
    ],
};

pub(crate) const BSDFS: Plugins = Plugins { kind: "bsdf", supported: || bsdfs().collect(), elsewhere: &[] };

pub(crate) const TEXTURES: Plugins = Plugins {
    kind: "texture",
    supported: || plugins::names(plugins::textures::ALL).collect(),
    elsewhere: &["volume", "wireframe", "curvature"],
};

pub(crate) const EMITTERS: Plugins = Plugins {
    kind: "emitter",
    supported: || plugins::names(plugins::emitters::ALL).collect(),
    elsewhere: &["directionalarea", "timed_sunsky", "collimated"],
};

pub(crate) const SENSORS: Plugins = Plugins {
    kind: "sensor",
    supported: || plugins::names(plugins::sensors::ALL).collect(),
    elsewhere: &[
        "perspective_rdist",
        "spherical",
        "fluencemeter",
        "radiancemeter",
        "irradiancemeter",
        "distant",
        "batch",
    ],
};

pub(crate) const FILMS: Plugins =
    Plugins { kind: "film", supported: || vec!["hdrfilm", "ldrfilm"], elsewhere: &["specfilm"] };

pub(crate) const FILTERS: Plugins = Plugins {
    kind: "rfilter",
    supported: || vec!["box", "tent", "gaussian"],
    elsewhere: &["mitchell", "catmullrom", "lanczos"],
};

/// Plugins of BSDFs: those of models, those that stand around others, and those for which others stand in.
fn bsdfs() -> impl Iterator<Item = &'static str> {
    let models = Bsdf::defaults(false).into_iter().chain(Bsdf::defaults(true)).map(|b| b.plugin());
    let stand_ins = plugins::stand_ins::ALL.iter().map(|s| s.name);
    plugins::names(plugins::wrappers::ALL).chain(models).chain(stand_ins)
}

/// Tags of single values.
pub(crate) const VALUE_TAGS: &[&str] = &[
    "boolean",
    "integer",
    "float",
    "string",
    "point",
    "vector",
    "spectrum",
    "rgb",
    "srgb",
    "blackbody",
    "transform",
    "animation",
];

/// Tags of nested plugins.
pub(crate) const OBJECT_TAGS: &[&str] = &[
    "shape",
    "bsdf",
    "subsurface",
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
    "subsurface",
];

/// Plugins of spectra: textures that are the same everywhere.
pub(crate) const SPECTRUM_PLUGINS: &[&str] =
    &["uniform", "rawconstant", "srgb", "d65", "blackbody", "regular", "irregular"];

/// Whether a file means the parameter of that name: case and underscores do not count, so that `toWorld` is `to_world`.
pub(crate) fn is_called(given: &str, name: &str) -> bool {
    given == name || letters(given).eq(letters(name))
}

fn letters(text: &str) -> impl Iterator<Item = u8> {
    text.bytes().filter(|&b| b != b'_').map(|b| b.to_ascii_lowercase())
}

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
