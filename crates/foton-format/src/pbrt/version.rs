//! Which version of pbrt a file is for: some words mean something else in each.

use foton_math::Cancel;

use super::tokens::{Token, Tokens};

/// A version of pbrt.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Version {
    /// Version 3; files of version 2 are read as far as they are alike.
    Three,
    /// Version 4.
    Four,
}

/// Directives and plugins that version 3 alone has.
const OLD: [(&str, &[&str]); 6] = [
    ("WorldEnd", &[]),
    ("Film", &["image"]),
    ("Camera", &["environment"]),
    ("Sampler", &["lowdiscrepancy", "02sequence", "maxmindist", "random"]),
    ("Integrator", &["directlighting", "whitted", "ao"]),
    ("Material", OLD_MATERIALS),
];

const OLD_MATERIALS: &[&str] = &[
    "matte",
    "plastic",
    "metal",
    "glass",
    "mirror",
    "uber",
    "substrate",
    "translucent",
    "disney",
    "fourier",
    "kdsubsurface",
    "none",
    "",
];

/// Directives and plugins that version 4 alone has.
const NEW: [(&str, &[&str]); 9] = [
    ("Option", &[]),
    ("Attribute", &[]),
    ("ColorSpace", &[]),
    ("Import", &[]),
    ("Film", &["rgb", "gbuffer", "spectral"]),
    ("Camera", &["spherical"]),
    ("Sampler", &["independent", "zsobol", "paddedsobol", "pmj02bn"]),
    ("Integrator", &["simplepath", "simplevolpath", "lightpath", "randomwalk", "ambientocclusion"]),
    ("Material", NEW_MATERIALS),
];

const NEW_MATERIALS: &[&str] = &[
    "diffuse",
    "coateddiffuse",
    "coatedconductor",
    "conductor",
    "dielectric",
    "thindielectric",
    "diffusetransmission",
    "interface",
    "measured",
];

impl Version {
    /// The version that the first word says which only one of them has; the newer where none does.
    pub(crate) fn of(text: &str, cancel: &Cancel) -> Self {
        let mut tokens = Tokens::new(text, 0).flatten().map(|(token, _)| token).peekable();
        let mut count = 0;
        while let Some(token) = tokens.next() {
            count += 1;
            if cancel.check_at(count).is_err() {
                break;
            }
            let Token::Word(word) = token else { continue };
            let plugin = match tokens.peek() {
                Some(Token::Text(text)) => text.as_ref(),
                _ => "",
            };
            let says = |table: &[(&str, &[&str])]| {
                table.iter().any(|(known, plugins)| {
                    *known == word && (plugins.is_empty() || plugins.contains(&plugin))
                })
            };
            if says(&NEW) {
                return Self::Four;
            }
            if says(&OLD) {
                return Self::Three;
            }
        }
        Self::Four
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_word_of_one_version_alone_decides() {
        for (text, version) in [
            ("Camera \"perspective\" Film \"image\" Option \"x\"", Version::Three),
            ("# Film \"image\"\nFilm \"rgb\" Material \"matte\"", Version::Four),
            ("Shape \"sphere\" Material \"glass\"", Version::Three),
            ("Shape \"sphere\"", Version::Four),
        ] {
            assert_eq!(Version::of(text, &Cancel::default()), version, "{text}");
        }
    }
}
