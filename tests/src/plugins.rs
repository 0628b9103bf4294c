//! `docs/plugins.md`, made from what plugins declare of their parameters.

use foton_scene::bsdf::Bsdf;
use foton_scene::parameter::{Binding, Kind, Parameter, Slot};
use foton_scene::plugins::{Plugin, emitters, sensors, shapes, stand_ins, textures, wrappers};

/// A plugin with the parameters that it declares.
pub struct Declared {
    /// Its tag in files.
    pub tag: &'static str,
    /// Its name in files.
    pub name: &'static str,
    /// What it is.
    pub help: &'static str,
    /// What it takes.
    pub parameters: Vec<Parameter>,
}

/// All plugins that declare their parameters.
#[must_use]
pub fn declared() -> Vec<Declared> {
    let of = |tag| {
        move |p: &Plugin| Declared { tag, name: p.name, help: p.help, parameters: p.parameters.to_vec() }
    };
    let mut all = bsdfs();
    all.extend(wrappers::ALL.iter().map(of("bsdf")));
    all.extend(sensors::ALL.iter().map(of("sensor")));
    all.extend(emitters::ALL.iter().map(of("emitter")));
    all.extend(shapes::ALL.iter().map(of("shape")));
    all.extend(textures::ALL.iter().map(of("texture")));
    all
}

fn bsdfs() -> Vec<Declared> {
    let models = Bsdf::defaults(false).into_iter().zip(Bsdf::defaults(true));
    let both = models.flat_map(|(smooth, rough)| {
        let rough = (rough.plugin() != smooth.plugin()).then_some(rough);
        std::iter::once(smooth).chain(rough)
    });
    both.filter(|bsdf| bsdf.info().stated.is_none())
        .map(|mut bsdf| {
            let (info, name, is_rough) = (bsdf.info(), bsdf.plugin(), bsdf.roughness().is_some());
            let bindings = bsdf.parameters();
            // Only rough surfaces have those of microfacets.
            let is_there = |b: &&Binding<'_>| is_rough || !matches!(b.slot, Slot::Roughness(_));
            let parameters = bindings.iter().filter(is_there).flat_map(|b| b.parameters).copied().collect();
            Declared { tag: "bsdf", name, help: info.help, parameters }
        })
        .collect()
}

/// The text of `docs/plugins.md`.
#[must_use]
pub fn document() -> String {
    let mut text = String::from(
        "# Plugins\n\n\
         What foton reads of a Mitsuba scene, and what its window edits: every plugin with the parameters that it declares in\n\
         `crates/foton-scene/src/bsdf/` and `crates/foton-scene/src/plugins/`. `cargo run -p foton-tests --example plugins` prints\n\
         this page, and a test compares.\n\n\
         An unlisted parameter is reported with its location; a texture where none is allowed is an error. Files of version 0\n\
         may name parameters in capitals (`intIOR`) and by the older names given here. \"Without effect\" means that the parameter is\n\
         read and affects only other renderers.\n",
    );
    let mut tag = "";
    for plugin in declared() {
        if plugin.tag != tag {
            tag = plugin.tag;
            text += &format!("\n## `<{tag}>`\n");
        }
        text += &format!("\n### `{}`\n\n{}\n", plugin.name, plugin.help);
        if !plugin.parameters.is_empty() {
            text +=
                "\n| parameter | type | range | default | texture | meaning |\n|---|---|---|---|---|---|\n";
            plugin.parameters.iter().for_each(|p| text += &row(p));
        }
    }
    text += &not_modelled();
    text
}

fn not_modelled() -> String {
    let mut text = String::from(
        "\n## What is not modelled\n\n\
         These BSDFs, and models of light below surfaces, are read as others, which take their place with what both have in\n\
         common. A warning says so where the first of a kind stands. Those without a stand-in are an error, or magenta with `--allow-missing`.\n\n\
         | plugin | instead | what is different |\n|---|---|---|\n",
    );
    for it in stand_ins::ALL {
        let instead = it.instead.map_or_else(|| "none".to_owned(), |name| format!("`{name}`"));
        text += &format!("| `{}` | {instead} | {} |\n", it.name, it.help);
    }
    text
}

fn row(parameter: &Parameter) -> String {
    let Parameter { name, help, unit, old_names, excludes, textured, .. } = parameter;
    let mut meaning = (*help).to_owned();
    for old in *old_names {
        meaning += &format!(" Once `{old}`.");
    }
    if !excludes.is_empty() {
        let others: Vec<String> = excludes.iter().map(|other| format!("`{other}`")).collect();
        meaning += &format!(" Not beside {}.", others.join(" or "));
    }
    let unit = if unit.is_empty() { String::new() } else { format!(", {unit}") };
    let texture = if *textured { "yes" } else { "" };
    let (kind, range, default) = (kind(parameter), range(parameter), default(parameter));
    format!("| `{name}` | {kind}{unit} | {range} | {default} | {texture} | {meaning} |\n")
}

fn kind(parameter: &Parameter) -> String {
    match parameter.kind {
        Kind::Share | Kind::Colour => "colour".to_owned(),
        Kind::Number => "number".to_owned(),
        Kind::Integer => "whole number".to_owned(),
        Kind::Refraction => "number, or the name of a substance".to_owned(),
        Kind::Boolean => "boolean".to_owned(),
        Kind::Choice(words) => words.iter().map(|w| format!("`{w}`")).collect::<Vec<_>>().join(" or "),
        Kind::Millimetres => "millimetres, such as `50mm`".to_owned(),
        Kind::Metal => "name of a metal".to_owned(),
        Kind::Vector => "point or vector".to_owned(),
        Kind::Transform => "transform".to_owned(),
        Kind::File => "path".to_owned(),
        Kind::Numbers => "numbers".to_owned(),
        Kind::Texture => "texture".to_owned(),
        Kind::Name => "name".to_owned(),
        Kind::Ignored => "without effect".to_owned(),
        Kind::Unsupported => "an error".to_owned(),
    }
}

fn range(parameter: &Parameter) -> String {
    let (min, max) = parameter.range;
    let is_tiny = min > 0.0 && min <= f64::from(f32::MIN_POSITIVE);
    let is_open = max >= f64::from(f32::MAX);
    match (is_tiny, is_open) {
        (true, true) => "above 0".to_owned(),
        (true, false) => format!("above 0, at most {max}"),
        (false, _) if min <= f64::from(f32::MIN) => String::new(),
        (false, true) => format!("at least {min}"),
        (false, false) => format!("{min} to {max}"),
    }
}

fn default(parameter: &Parameter) -> String {
    match (parameter.kind, parameter.default_text) {
        (Kind::Ignored | Kind::Unsupported, _) => String::new(),
        (Kind::Choice(_) | Kind::Boolean, text) if !text.contains(' ') => format!("`{text}`"),
        (_, "") => parameter.default.to_string(),
        (_, text) => text.to_owned(),
    }
}
