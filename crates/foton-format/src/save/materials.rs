//! Changed materials in a document: the values that changed, or where their structure did, the whole element anew.

use foton_scene::description::{
    Bsdf, Colour, Conductor, Dielectric, Diffuse, Material, MicrofacetDistribution, Microfacets, Mirror,
    Null, Plastic, ThinDielectric,
};

use super::tree::Obstacle;
use crate::document::{Document, NodeId};
use crate::write::material_xml;
use crate::write::surfaces::{mean, plugin};
use crate::write::xml::{colour, single};

/// A value of a bsdf as it stands in a file: tag, name and text.
type Stated = (&'static str, &'static str, String);

/// Names that cannot stand beside each other: where one is written, the others go.
const ALTERNATIVES: [&[&str]; 2] = [&["eta", "k", "material", "ext_eta"], &["alpha", "alpha_u", "alpha_v"]];

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
    let mut textured = matches!(new.opacity, Some(Colour::Texture(_)));
    for bsdf in [Some(new.front), new.back].into_iter().flatten() {
        let _ = bsdf.map(|c| textured |= matches!(c, Colour::Texture(_)));
    }
    if textured {
        return Err(format!("the material \"{}\" has textures and changed its kind", new.name));
    }
    let text = material_xml(new).trim_end().replace('\n', &format!("\n{indentation}"));
    let element = Document::parse(&text).map_err(|(_, message)| message)?;
    let (_, root) = document.append(element, 0).ok_or("the file has too many elements")?;
    Ok(root)
}

/// Changes values alone; `None` where that is not enough.
fn change_values(document: &mut Document, node: NodeId, old: &Material, new: &Material) -> Option<()> {
    let mut node = node;
    if kind(document, node)? == "mask" {
        match (new.opacity, old.opacity) {
            (new, old) if new == old => {}
            (Some(Colour::Texture(_)), _) => return None,
            (new, _) => {
                let share = new.map_or(1.0, |c| if let Colour::Constant(c) = c { mean(c) } else { 1.0 });
                document.set_value(node, "float", "opacity", Some(&single(share))).ok()?;
            }
        }
        node = *inside(document, node)?.first()?;
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
    (std::mem::discriminant(old) == std::mem::discriminant(new)).then_some(())?;
    // The file's own name of the plugin may be another one that means the same.
    if plugin(old) != plugin(new) {
        document.set_attribute(node, "type", plugin(new));
    }
    let (before, after) = (stated(old)?, stated(new)?);
    let mut changed: Vec<&Stated> = after.iter().filter(|s| !before.contains(s)).collect();
    let gone = before.iter().filter(|b| !after.iter().any(|a| a.1 == b.1)).map(|b| b.1);
    for group in ALTERNATIVES {
        let touched = changed.iter().map(|s| s.1).chain(gone.clone()).any(|name| group.contains(&name));
        if touched {
            // A metal that had a name gets both of its indices.
            changed.extend(after.iter().filter(|s| group.contains(&s.1)));
            for name in group {
                if !after.iter().any(|s| s.1 == *name) {
                    document.set_value(node, "", name, None).ok()?;
                }
            }
        }
    }
    for name in gone {
        document.set_value(node, "", name, None).ok()?;
    }
    for (tag, name, value) in changed {
        document.set_value(node, tag, name, Some(value)).ok()?;
    }
    Some(())
}

/// All values of a bsdf; textures stay out, and with them what they stand for stays as it is.
fn stated(bsdf: &Bsdf) -> Option<Vec<Stated>> {
    let mut all: Vec<Stated> = Vec::new();
    let mut colours = Vec::new();
    let _ = bsdf.map(|c| colours.push(c));
    let names: &[&'static str] = match bsdf {
        Bsdf::Diffuse(Diffuse { .. }) => &["reflectance"],
        Bsdf::Dielectric(Dielectric { .. }) | Bsdf::ThinDielectric(ThinDielectric { .. }) => {
            &["specular_reflectance", "specular_transmittance"]
        }
        Bsdf::Mirror(Mirror { .. }) | Bsdf::Conductor(Conductor { .. }) => &["specular_reflectance"],
        Bsdf::Plastic(Plastic { .. }) => &["diffuse_reflectance", "specular_reflectance"],
        Bsdf::Null(Null) => &[],
    };
    for (name, value) in names.iter().zip(colours) {
        if let Colour::Constant(c) = value {
            all.push(("rgb", name, colour(c)));
        }
    }
    match *bsdf {
        Bsdf::Dielectric(Dielectric { int_ior, ext_ior, .. })
        | Bsdf::ThinDielectric(ThinDielectric { int_ior, ext_ior, .. })
        | Bsdf::Plastic(Plastic { int_ior, ext_ior, .. }) => {
            all.extend([("float", "int_ior", single(int_ior)), ("float", "ext_ior", single(ext_ior))]);
        }
        Bsdf::Conductor(Conductor { eta, k, .. }) => {
            all.extend([("rgb", "eta", colour(eta)), ("rgb", "k", colour(k))]);
        }
        _ => {}
    }
    if let Bsdf::Plastic(Plastic { nonlinear, .. }) = *bsdf {
        all.push(("boolean", "nonlinear", nonlinear.to_string()));
    }
    if let Bsdf::Dielectric(Dielectric { roughness: Some(r), .. })
    | Bsdf::Conductor(Conductor { roughness: Some(r), .. })
    | Bsdf::Plastic(Plastic { roughness: Some(r), .. }) = *bsdf
    {
        all.extend(stated_roughness(&r));
    }
    Some(all)
}

fn stated_roughness(r: &Microfacets) -> Vec<Stated> {
    let name = match r.distribution {
        MicrofacetDistribution::Beckmann => "beckmann",
        MicrofacetDistribution::Ggx => "ggx",
    };
    let distribution = ("string", "distribution", name.to_owned());
    if r.alpha_u == r.alpha_v {
        return vec![distribution, ("float", "alpha", single(r.alpha_u))];
    }
    let along = |name, alpha| ("float", name, single(alpha));
    vec![distribution, along("alpha_u", r.alpha_u), along("alpha_v", r.alpha_v)]
}
