//! Files of versions before 2: their names in the words of Mitsuba 3, as that reads them itself.
//!
//! Only names change here, places stay. What else old files have (`srgb`, hexadecimal colours, offsets and scales of
//! textures) is read in files of every version.

use foton_scene::description::Bsdf;

use crate::mitsuba::document::{Attribute, Element};

/// Tags that were other ones.
const TAGS: [(&str, &str); 3] = [("lookAt", "lookat"), ("camera", "sensor"), ("luminaire", "emitter")];

/// Plugins that had other names, by their tag.
const PLUGINS: [(&str, &str, &str); 11] = [
    // Both are images; ours is written as the command line says.
    ("film", "ldrfilm", "hdrfilm"),
    ("film", "pngfilm", "hdrfilm"),
    ("film", "exrfilm", "hdrfilm"),
    ("bsdf", "lambertian", "diffuse"),
    ("bsdf", "mirror", "conductor"),
    ("bsdf", "roughmetal", "roughconductor"),
    ("bsdf", "roughglass", "roughdielectric"),
    ("bsdf", "microfacet", "roughplastic"),
    ("bsdf", "composite", "mixturebsdf"),
    ("texture", "ldrtexture", "bitmap"),
    ("texture", "exrtexture", "bitmap"),
];

/// Parameters of other plugins than BSDFs that had other names.
const PARAMETERS: [(&str, &str, &str); 4] = [
    ("area", "intensity", "radiance"),
    ("constant", "intensity", "radiance"),
    ("directional", "intensity", "irradiance"),
    ("envmap", "intensity_scale", "scale"),
];

/// Renames what stands in an element of an old file; `parent` is the plugin around it.
pub(crate) fn element(element: &mut Element, parent: &str) {
    if let Some((_, now)) = TAGS.iter().find(|(once, _)| *once == element.name) {
        (*now).clone_into(&mut element.name);
    }
    match element.name.as_str() {
        "default" => return,
        "lookat" => gather_points(element),
        // The old renderers worked with red, green and blue: one number was a grey, and is white as light.
        "spectrum" if element.attribute("value").is_some_and(|a| a.value.trim().parse::<f64>().is_ok()) => {
            "rgb".clone_into(&mut element.name);
        }
        _ => {}
    }
    let tag = element.name.as_str();
    if let Some(kind) = element.attributes.iter_mut().find(|a| a.name == "type")
        && let Some((.., now)) = PLUGINS.iter().find(|(of, once, _)| *of == tag && *once == kind.value)
    {
        (*now).clone_into(&mut kind.value);
    }
    for attribute in element.attributes.iter_mut().filter(|a| a.name == "name") {
        attribute.value = snake_case(&attribute.value);
        let known = PARAMETERS.iter().find(|(of, once, _)| *of == parent && *once == attribute.value);
        if let Some(name) = known.map(|(.., now)| *now).or_else(|| name_now(parent, &attribute.value)) {
            attribute.value = name.to_owned();
        }
    }
}

/// `ox`, `oy` and `oz` of the oldest files to `origin`, and so on.
fn gather_points(element: &mut Element) {
    for (name, letter) in [("origin", 'o'), ("target", 't'), ("up", 'u')] {
        let axes = ["x", "y", "z"].map(|axis| format!("{letter}{axis}"));
        let [Some(x), Some(y), Some(z)] = axes.each_ref().map(|axis| element.attribute(axis).cloned()) else {
            continue;
        };
        element.attributes.retain(|a| !axes.contains(&a.name));
        let value = format!("{} {} {}", x.value, y.value, z.value);
        let broken = x.broken || y.broken || z.broken;
        element.attributes.push(Attribute { name: name.to_owned(), value, broken, ..x });
    }
}

/// The name of a BSDF's parameter that once had another one.
fn name_now(plugin: &str, once: &str) -> Option<&'static str> {
    let mut bsdf = Bsdf::of_plugin(plugin)?;
    let mut parameters = bsdf.parameters().into_iter().flat_map(|binding| binding.parameters);
    parameters.find(|p| p.old_names.contains(&once)).map(|p| p.name)
}

/// `intIOR` to `int_ior`: an underscore where capitals follow a small letter, and these made small.
fn snake_case(name: &str) -> String {
    let mut snake = String::with_capacity(name.len() + 4);
    let mut last = ' ';
    let mut inside = false;
    for c in name.chars() {
        if last.is_ascii_lowercase() && c.is_ascii_uppercase() {
            snake.push('_');
            inside = true;
        }
        inside &= c.is_ascii_uppercase();
        snake.push(if inside { c.to_ascii_lowercase() } else { c });
        last = c;
    }
    snake
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn camel_case_becomes_snake_case_as_in_mitsuba() {
        for (old, new) in [
            ("toWorld", "to_world"),
            ("intIOR", "int_ior"),
            ("maxDepth", "max_depth"),
            ("specularReflectance", "specular_reflectance"),
            ("alphaU", "alpha_u"),
            ("already_new", "already_new"),
            ("IOR", "IOR"),
        ] {
            assert_eq!(snake_case(old), new);
        }
    }
}
