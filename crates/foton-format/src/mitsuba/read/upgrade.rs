//! Files of versions before 2: their names in the words of Mitsuba 3, as that reads them itself.
//!
//! Only names change here, places stay. What else old files have (`srgb`, hexadecimal colours, offsets and scales of
//! textures) is read in files of every version.

use foton_scene::description::Bsdf;

use crate::mitsuba::document::Element;

/// Renames what stands in an element of an old file; `parent` is the plugin around it.
pub(crate) fn element(element: &mut Element, parent: &str) {
    match element.name.as_str() {
        "lookAt" => element.name = "lookat".to_owned(),
        "default" => return,
        "film" => {
            let kind = element.attributes.iter_mut().find(|a| a.name == "type" && a.value == "ldrfilm");
            // Both are images; ours is written as the command line says.
            kind.into_iter().for_each(|kind| kind.value = "hdrfilm".to_owned());
        }
        _ => {}
    }
    for attribute in element.attributes.iter_mut().filter(|a| a.name == "name") {
        attribute.value = snake_case(&attribute.value);
        if let Some(name) = name_now(parent, &attribute.value) {
            attribute.value = name.to_owned();
        }
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
