//! What plugins declare of their parameters is what is read, and what `docs/plugins.md` says.

use std::path::Path;

use foton_format::Options;
use foton_scene::parameter::{Kind, Parameter};
use foton_tests::plugins::{Declared, declared, document};

#[test]
fn the_page_of_plugins_is_what_they_declare() {
    let path =
        Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("in the workspace").join("docs/plugins.md");
    let page = std::fs::read_to_string(path).expect("the page is there");
    assert!(page == document(), "cargo run -p foton-tests --example plugins > docs/plugins.md");
}

/// A value as a file states it.
fn value(parameter: &Parameter) -> String {
    let Parameter { name, default, kind, .. } = *parameter;
    match kind {
        Kind::Share | Kind::Colour => format!(r#"<rgb name="{name}" value="0.5"/>"#),
        Kind::Number => format!(r#"<float name="{name}" value="{}"/>"#, default.max(0.1)),
        Kind::Refraction => format!(r#"<float name="{name}" value="{default}"/>"#),
        Kind::Integer => format!(r#"<integer name="{name}" value="0"/>"#),
        Kind::Boolean => format!(r#"<boolean name="{name}" value="true"/>"#),
        Kind::Choice(words) => format!(r#"<string name="{name}" value="{}"/>"#, words[words.len() - 1]),
        Kind::Millimetres => format!(r#"<string name="{name}" value="35mm"/>"#),
        Kind::Metal => format!(r#"<string name="{name}" value="Au"/>"#),
        Kind::Vector => format!(r#"<point name="{name}" value="0, 0, 2"/>"#),
        Kind::Transform => format!(r#"<transform name="{name}"><translate x="1"/></transform>"#),
        Kind::Numbers => format!(r#"<string name="{name}" value="1"/>"#),
        Kind::Texture => format!(r#"<texture name="{name}" type="checkerboard"/>"#),
        Kind::File => format!(r#"<string name="{name}" value="absent"/>"#),
        Kind::Name => format!(r#"<string name="{name}" value="vertex_color"/>"#),
        Kind::Ignored | Kind::Unsupported => format!(r#"<string name="{name}" value="anything"/>"#),
    }
}

/// A triangle with colours of its vertices.
const LEAF: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty float r\n\
    property float g\nproperty float b\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n\
    0 0 0 1 0 0\n1 0 0 0 1 0\n0 1 0 0 0 1\n3 0 1 2\n";

/// What is said of a scene in which a plugin has some contents.
fn said(plugin: &Declared, contents: &str) -> String {
    let inside = match plugin.name {
        "mask" | "twosided" | "mixturebsdf" | "coating" | "roughcoating" => r#"<bsdf type="diffuse"/>"#,
        "instance" => r#"<shape type="shapegroup"><shape type="cube"/></shape>"#,
        "blendbsdf" => r#"<bsdf type="diffuse"/><bsdf type="diffuse"/>"#,
        "bumpmap" => r#"<texture type="checkerboard"/><bsdf type="diffuse"/>"#,
        "normalmap" if contents.contains("checkerboard") || contents.contains("filename") => {
            r#"<bsdf type="diffuse"/>"#
        }
        "normalmap" => r#"<texture type="checkerboard"/><bsdf type="diffuse"/>"#,
        "thinlens" | "telecentric" if !contents.contains("aperture_radius") => {
            r#"<float name="aperture_radius" value="0.1"/>"#
        }
        "scale" => r#"<texture type="checkerboard"/>"#,
        "mesh_attribute" if !contents.contains("\"name\"") => r#"<string name="name" value="vertex_color"/>"#,
        _ => "",
    };
    let Declared { tag, name, .. } = plugin;
    let element = |attribute: &str| format!(r#"<{tag} type="{name}"{attribute}>{contents}{inside}</{tag}>"#);
    let body = match (*tag, *name) {
        ("bsdf", _) | ("emitter", "area") => format!(r#"<shape type="sphere">{}</shape>"#, element("")),
        ("texture", _) => format!(
            r#"<shape type="ply"><string name="filename" value="leaf.ply"/><bsdf type="diffuse">{}</bsdf></shape>"#,
            element(r#" name="reflectance""#)
        ),
        _ => element(""),
    };
    let xml = format!(r#"<scene version="3.0.0"><sensor type="perspective"/>{body}</scene>"#);
    let files = |path: &Path| match path.ends_with("leaf.ply") {
        true => Ok(LEAF.into()),
        false => Err(std::io::ErrorKind::NotFound.into()),
    };
    let all = match foton_format::read_str("plugin", &xml, &files, &Options::default()) {
        Ok(opened) => opened.warnings,
        Err(error) => error.diagnostics().to_vec(),
    };
    all.iter().map(|d| format!("{d}\n")).collect()
}

#[test]
fn every_declared_parameter_is_read() {
    for plugin in declared() {
        for parameter in &plugin.parameters {
            let mut contents = value(parameter);
            // Both axes of a roughness are said together, and an axis of the angle of view with the angle.
            let pair = match parameter.name {
                "alpha_u" => Some("alpha_v"),
                "alpha_v" => Some("alpha_u"),
                "fov_axis" => Some("fov"),
                _ => None,
            };
            contents.extend(plugin.parameters.iter().filter(|p| Some(p.name) == pair).map(value));
            let said = said(&plugin, &contents);
            let subject = format!("{} of {}: {said}", parameter.name, plugin.name);
            assert!(!said.contains("unknown"), "{subject}");
            let is_refused =
                said.contains(&format!("\"{}\" of \"{}\" is not supported", parameter.name, plugin.name));
            assert_eq!(is_refused, parameter.kind == Kind::Unsupported, "{subject}");
            let is_of_a_file = plugin.parameters.iter().any(|p| p.kind == Kind::File);
            assert!(said.is_empty() || is_refused || is_of_a_file, "{subject}");
        }
    }
}

#[test]
fn what_is_not_declared_is_reported() {
    for plugin in declared() {
        let said = said(&plugin, r#"<float name="nonsense" value="1"/>"#);
        assert!(said.contains("unknown property \"nonsense\""), "{}: {said}", plugin.name);
    }
}

#[test]
fn values_outside_of_a_declared_range_are_refused() {
    for plugin in declared() {
        for parameter in &plugin.parameters {
            let (min, max) = parameter.range;
            let tag = match parameter.kind {
                Kind::Share | Kind::Colour => "rgb",
                Kind::Number | Kind::Refraction => "float",
                _ => continue,
            };
            // Old files state any offset and scale; a beam wider than its cone is cut with a warning.
            for outside in [min - 1.0, 2.0 * max] {
                let is_open = !outside.is_finite()
                    || outside.abs() > 1e37
                    || parameter.name == "beam_width" && outside > 0.0;
                let contents = format!(r#"<{tag} name="{}" value="{outside}"/>"#, parameter.name);
                if is_open {
                    continue;
                }
                let said = said(&plugin, &contents);
                let is_refused = ["must", "rough surface has"].iter().any(|word| said.contains(word));
                assert!(is_refused, "{} of {} = {outside}: {said}", parameter.name, plugin.name);
            }
        }
    }
}
