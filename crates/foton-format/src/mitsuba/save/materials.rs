//! Changed materials in a document: the values that changed, or where their structure did, the whole element anew.

use foton_scene::description::{Bsdf, Colour, Material, Number};
use foton_scene::parameter::{Binding, Kind, Parameter, Slot};
use foton_scene::plugins::stand_ins;
use foton_scene::plugins::wrappers::{self, OPACITY};

use super::tree::Obstacle;
use crate::mitsuba::document::{Document, NodeId};
use crate::mitsuba::write::material_xml;
use crate::mitsuba::write::surfaces::{Stated, mean, stated, textures_of};
use crate::mitsuba::write::xml::single;

/// Makes the `<bsdf>` of one material that of another.
pub(super) fn change(
    document: &mut Document,
    node: NodeId,
    old: &Material,
    new: &Material,
) -> Result<(), Obstacle> {
    let mut tried = document.clone();
    if change_values(&mut tried, node, old, new).is_some() {
        *document = tried;
        return Ok(());
    }
    let parent = document.parent(node).ok_or("its material is the whole file")?;
    let indentation = document.indentation(parent, node);
    let attribute = |name| document.element(node)?.attribute(name).map(|a| a.value.clone());
    let kept: Vec<_> = ["id", "name"].into_iter().filter_map(|n| Some((n, attribute(n)?))).collect();
    let anew = build(document, new, &indentation)?;
    if let Some(element) = document.element_mut(anew) {
        element.attributes.retain(|a| a.name != "id");
    }
    for (name, value) in kept {
        document.set_attribute(anew, name, &value);
    }
    if let Some(element) = document.element_mut(parent) {
        let place = element.children.iter_mut().find(|c| **c == node);
        place.into_iter().for_each(|place| *place = anew);
    }
    Ok(())
}

/// A new `<bsdf>`, with an id that is like the material's name.
pub(super) fn build(document: &mut Document, new: &Material, indentation: &str) -> Result<NodeId, Obstacle> {
    let mut textured = matches!(new.opacity, Some(Colour::Texture(_))) || new.relief.is_some();
    for bsdf in [Some(new.front), new.back].into_iter().flatten() {
        let mut of_numbers = false;
        let is_texture = |n, _| of_numbers |= matches!(n, Number::Texture(_));
        let _ = bsdf.map(|c| textured |= matches!(c, Colour::Texture(_)), is_texture);
        textured |= of_numbers;
    }
    for coating in new.coatings.iter().flatten() {
        let mut of_numbers = false;
        let is_texture = |n, _| of_numbers |= matches!(n, Number::Texture(_));
        let _ = coating.map(|c| textured |= matches!(c, Colour::Texture(_)), is_texture);
        textured |= of_numbers;
    }
    if !new.mixture.is_empty() {
        return Err(format!("the material \"{}\" is a blend and changed its kind", new.name));
    }
    if textured {
        return Err(format!("the material \"{}\" has textures and changed its kind", new.name));
    }
    document.build_text(&material_xml(new), indentation)
}

/// Changes values alone; `None` where that is not enough.
fn change_values(document: &mut Document, node: NodeId, old: &Material, new: &Material) -> Option<()> {
    let is_same = old.relief == new.relief && old.mixture == new.mixture && old.coatings == new.coatings;
    is_same.then_some(())?;
    let mut node = first_inside(document, node)?;
    if kind(document, node)? == "mask" {
        match (new.opacity, old.opacity) {
            (new, old) if new == old => {}
            (Some(Colour::Texture(_)), _) => return None,
            (new, _) => {
                let share = new.map_or(1.0, |c| if let Colour::Constant(c) = c { mean(c) } else { 1.0 });
                document.set_value(node, "float", OPACITY.name, Some(&single(share))).ok()?;
            }
        }
        // Holes of a blend are those of all its components.
        (old.opacity == new.opacity || old.mixture.is_empty()).then_some(())?;
        node = first_inside(document, *inside(document, node)?.first()?)?;
    } else if old.opacity != new.opacity {
        return None;
    }
    if kind(document, node)? == "twosided" {
        let (old_back, new_back) = (old.back?, new.back?);
        return match inside(document, node)?[..] {
            [both] if new_back == new.front => change_side(document, both, &old.front, &new.front),
            [front, back] => {
                change_side(document, front, &old.front, &new.front)?;
                change_side(document, back, &old_back, &new_back)
            }
            _ => None,
        };
    }
    (old.back.is_none() && new.back.is_none()).then_some(())?;
    change_side(document, node, &old.front, &new.front)
}

/// The element of the first BSDF inside of blends and reliefs.
fn first_inside(document: &Document, mut node: NodeId) -> Option<NodeId> {
    let around = [
        wrappers::BLENDBSDF,
        wrappers::MIXTUREBSDF,
        wrappers::BUMPMAP,
        wrappers::NORMALMAP,
        wrappers::COATING_PLUGIN,
        wrappers::ROUGHCOATING_PLUGIN,
    ]
    .map(|p| p.name);
    while around.contains(&kind(document, node)?.as_str()) {
        node = *inside(document, node)?.first()?;
    }
    Some(node)
}

fn kind(document: &Document, node: NodeId) -> Option<String> {
    let element = document.element(node).filter(|e| e.name == "bsdf")?;
    Some(element.attribute("type")?.value.clone())
}

/// The bsdfs that stand inside one; `None` if there are references, whose targets others may use, too.
fn inside(document: &Document, node: NodeId) -> Option<Vec<NodeId>> {
    let referring = document.elements_in(node).any(|(_, e)| e.name == "ref" && e.attribute("name").is_none());
    let bsdfs = document.elements_in(node).filter(|(_, e)| e.name == "bsdf").map(|(node, _)| node);
    (!referring).then(|| bsdfs.collect())
}

fn change_side(document: &mut Document, node: NodeId, old: &Bsdf, new: &Bsdf) -> Option<()> {
    let node = first_inside(document, node)?;
    // What a stand-in was made of has other parameters.
    stand_ins::find(&kind(document, node)?).is_none().then_some(())?;
    (std::mem::discriminant(old) == std::mem::discriminant(new)).then_some(())?;
    // The file's own name of the plugin may be another one that means the same.
    if old.plugin() != new.plugin() {
        document.set_attribute(node, "type", new.plugin());
    }
    let (mut old, mut new) = (*old, *new);
    for (old, new) in old.parameters().iter().zip(&new.parameters()) {
        change_value(document, node, old, new)?;
    }
    Some(())
}

fn change_value(document: &mut Document, node: NodeId, old: &Binding<'_>, new: &Binding<'_>) -> Option<()> {
    let (before, after) = (stated(old), stated(new));
    let textures = textures_of(new);
    let textures_before = textures_of(old);
    if textures.iter().any(|texture| !textures_before.contains(texture)) {
        return None;
    }
    // A texture that gives the same value stays as it is.
    if (before == after) && textures == textures_before {
        return Some(());
    }
    let is_said = |name: &str| {
        after.iter().any(|s| s.name == name) || textures.iter().any(|(textured, _)| *textured == name)
    };
    for parameter in alternatives(new).filter(|p| !is_said(p.name)) {
        document.set_value(node, "", parameter.name, None).ok()?;
    }
    let names = before.iter().map(|s| s.name).chain(textures_before.iter().map(|(name, _)| *name));
    for gone in names.filter(|name| !is_said(name)) {
        document.set_value(node, "", gone, None).ok()?;
    }
    // A metal that had a name gets both of its indices; what else did not change may be said by a default.
    let is_metal = matches!(new.slot, Slot::Metal { .. });
    for Stated { tag, name, text } in after.iter().filter(|s| is_metal || !before.contains(s)) {
        document.set_value(node, tag, name, Some(text)).ok()?;
    }
    Some(())
}

/// Parameters that cannot stand beside each other: where one of them is written, the others go.
fn alternatives(binding: &Binding<'_>) -> impl Iterator<Item = &'static Parameter> {
    let is_one =
        |p: &&Parameter| matches!(p.kind, Kind::Metal | Kind::Colour | Kind::Refraction | Kind::Number);
    let parameters = if binding.parameters.len() > 1 { binding.parameters } else { &[] };
    parameters.iter().filter(is_one)
}
