//! Fields of materials, by the parameters that their BSDFs declare: what they are, and setting them.

use foton_math::Rgb;
use foton_scene::bsdf::{MicrofacetDistribution, Microfacets};
use foton_scene::description::{Bsdf, Coating, Colour, Material, Number};
use foton_scene::metals::METALS;
use foton_scene::parameter::{Binding, Kind, Parameter, Role, Slot};
use foton_scene::plugins::wrappers::OPACITY;

use super::field::{FieldId, Fields, Property, Side, Value};

/// Everyday names of metals.
const NAMES: [(&str, &str); 8] = [
    ("Ag", "silver"),
    ("Al", "aluminium"),
    ("Au", "gold"),
    ("Cr", "chromium"),
    ("Cu", "copper"),
    ("Hg", "mercury"),
    ("Ir", "iridium"),
    ("W", "tungsten"),
];
const WHITE: Colour = Colour::Constant(Rgb::WHITE);
/// Labels of the channels of a metal's index of refraction.
const CHANNELS: [(&str, [&str; 3]); 2] =
    [("eta", ["eta red", "eta green", "eta blue"]), ("k", ["k red", "k green", "k blue"])];

/// The place of a BSDF's model among [`Bsdf::defaults`].
fn kind_of(bsdf: &Bsdf) -> usize {
    let is_same = |b: &Bsdf| std::mem::discriminant(b) == std::mem::discriminant(bsdf);
    Bsdf::defaults(false).iter().position(is_same).unwrap_or(0)
}

/// The kind of a material in words: `smooth conductor`, and of a blend that of its first component.
pub(crate) fn kind_name(material: &Material) -> String {
    let info = material.front.info();
    let label = info.label.to_lowercase();
    match (material.front.roughness(), info.rough_plugin) {
        (Some(_), _) => format!("rough {label}"),
        (None, Some(_)) => format!("smooth {label}"),
        (None, None) => label,
    }
}

/// Appends a material's fields. Whether some values come from textures, which cannot be edited.
pub(crate) fn fields(material: &Material, out: &mut Fields) -> bool {
    let mut textured = side_fields(&material.front, Side::Front, out);
    if let Some(back) = material.back.filter(|b| *b != material.front && !material.front.has_two_sides()) {
        textured |= side_fields(&back, Side::Back, out);
    }
    let [over_front, over_back] = material.coatings;
    let is_coated = over_front.is_some() || over_back.is_some();
    let help =
        "A clear layer over the surface, as of varnish or lacquer: it reflects light, and may absorb it.";
    out.toggle(FieldId::Material(Side::Coating, Property::Coated), "Coat", is_coated, help);
    let behind = over_back.filter(|_| over_back != over_front);
    for (coating, side) in [(over_front, Side::Coating), (behind, Side::CoatingBehind)] {
        if let Some(mut coating) = coating {
            textured |= binding_fields(coating.parameters(), side, out);
        }
    }
    match material.opacity.unwrap_or(WHITE) {
        Colour::Constant(c) => out.parameter(FieldId::Opacity, &OPACITY, f64::from(c.mean())),
        Colour::Texture(_) => textured = true,
    }
    textured
}

fn side_fields(bsdf: &Bsdf, side: Side, out: &mut Fields) -> bool {
    let id = |p| FieldId::Material(side, p);
    let label = if side == Side::Front { "Kind" } else { "Kind behind" };
    let kinds = Bsdf::defaults(false).map(|b| b.info().label.to_owned()).to_vec();
    out.choice(id(Property::Kind), label, kind_of(bsdf), kinds, "What the surface is made of.");
    let mut bsdf = *bsdf;
    binding_fields(bsdf.parameters(), side, out)
}

/// The fields of parameters; whether some come from textures.
fn binding_fields(mut bindings: Vec<Binding<'_>>, side: Side, out: &mut Fields) -> bool {
    let id = |p| FieldId::Material(side, p);
    let mut textured = false;
    bindings.sort_by_key(|binding| rank(&binding.slot));
    for Binding { parameters, slot } in bindings {
        let parameter = &parameters[0];
        let own = id(Property::Parameter(parameter.name));
        match slot {
            Slot::Share(Colour::Constant(c)) => {
                out.colour(own, parameter.label, c.to_array(), parameter.help);
                // White is physical.
                if parameter.role.is_none() && parameter.name == "specular_reflectance" {
                    out.advance();
                }
            }
            Slot::Share(Colour::Texture(_)) | Slot::Number(Number::Texture(_)) => textured = true,
            Slot::Number(Number::Constant(x)) | Slot::Refraction(x) | Slot::Reflectivity(x) => {
                out.parameter(own, parameter, f64::from(*x));
                // Outside is nearly always air.
                if parameter.role == Some(Role::OutsideIor) || parameter.advanced {
                    out.advance();
                }
            }
            Slot::Boolean(on) => {
                out.toggle(own, parameter.label, *on, parameter.help);
                out.advance();
            }
            Slot::Choice(i) => {
                if let Kind::Choice(words) = parameter.kind {
                    let words = words.iter().map(|word| (*word).to_owned()).collect();
                    out.choice(own, parameter.label, *i, words, parameter.help);
                    out.advance();
                }
            }
            Slot::Metal { eta, k } => metal_fields(side, parameters, [*eta, *k], out),
            Slot::Roughness(roughness) => textured |= roughness_fields(side, parameters, *roughness, out),
        }
    }
    textured
}

/// What people look for first: the index of refraction or the metal, then roughness, then colours.
const fn rank(slot: &Slot<'_>) -> u8 {
    match slot {
        Slot::Refraction(_) | Slot::Reflectivity(_) | Slot::Number(_) | Slot::Metal { .. } => 0,
        Slot::Roughness(_) => 1,
        Slot::Share(_) => 2,
        Slot::Boolean(_) | Slot::Choice(_) => 3,
    }
}

/// The parameter of a name among those that say one thing together.
fn named(parameters: &'static [Parameter], name: &str) -> Option<&'static Parameter> {
    parameters.iter().find(|p| p.name == name)
}

fn metal_fields(side: Side, parameters: &'static [Parameter], [eta, k]: [Rgb; 2], out: &mut Fields) {
    let known = METALS.iter().position(|m| (m.1, m.2) == (eta.to_array(), k.to_array()));
    let everyday = |symbol: &str| NAMES.iter().find(|(s, _)| *s == symbol);
    let label = |symbol: &str| match everyday(symbol) {
        Some((_, name)) => format!("{name} ({symbol})"),
        None => symbol.to_owned(),
    };
    let names = METALS.iter().map(|m| label(m.0));
    let options = std::iter::once("custom".to_owned()).chain(names).collect();
    let id = |p| FieldId::Material(side, p);
    if let Some(metal) = named(parameters, "material") {
        let chosen = known.map_or(0, |i| i + 1);
        out.choice(id(Property::Parameter("material")), metal.label, chosen, options, metal.help);
    }
    for channel in 0..3u8 {
        for ((name, labels), value) in CHANNELS.into_iter().zip([eta, k]) {
            let Some(parameter) = named(parameters, name) else { continue };
            let i = usize::from(channel);
            let parameter = Parameter { label: labels[i], ..*parameter };
            out.parameter(id(Property::Channel(name, channel)), &parameter, f64::from(value.to_array()[i]));
            out.advance();
        }
    }
}

/// The fields of a roughness; whether it comes from a texture.
fn roughness_fields(
    side: Side,
    parameters: &'static [Parameter],
    roughness: Option<Microfacets>,
    out: &mut Fields,
) -> bool {
    let id = |p| FieldId::Material(side, p);
    let help = "A smooth surface makes sharp images and caustics; a rough one blurs both.";
    let [rough, amount, facets] = match side {
        Side::Front | Side::Back => ["Rough", "", ""],
        Side::Coating | Side::CoatingBehind => ["Coat rough", "Coat roughness", "Coat facets"],
    };
    let labelled = |parameter: &'static Parameter, label: &'static str| {
        if label.is_empty() { *parameter } else { Parameter { label, ..*parameter } }
    };
    out.toggle(id(Property::Rough), rough, roughness.is_some(), help);
    let Some(Microfacets { distribution, alpha_u, alpha_v }) = roughness else { return false };
    let alphas: &[(&'static str, Number)] = if alpha_u == alpha_v {
        &[("alpha", alpha_u)]
    } else {
        &[("alpha_u", alpha_u), ("alpha_v", alpha_v)]
    };
    let mut textured = false;
    for &(name, value) in alphas {
        match (named(parameters, name), value) {
            (Some(parameter), Number::Constant(x)) => {
                let parameter = labelled(parameter, amount);
                out.parameter(id(Property::Parameter(name)), &parameter, f64::from(x));
            }
            (_, Number::Texture(_)) => textured = true,
            (None, _) => {}
        }
    }
    if let Some(parameter) = named(parameters, "distribution") {
        let options = MicrofacetDistribution::ALL.map(|d| d.label().to_owned()).to_vec();
        let id = id(Property::Parameter("distribution"));
        let parameter = labelled(parameter, facets);
        out.choice(id, parameter.label, distribution as usize, options, parameter.help);
        out.advance();
    }
    textured
}

/// Sets what a field of a side says; the value fits the field.
pub(crate) fn set(material: &mut Material, side: Side, property: Property, value: Value) {
    if let (Property::Coated, Value::Toggle(on)) = (property, value) {
        // Both sides of glass have the coating of its front.
        let coating = on.then(|| Coating::default(false));
        material.coatings = [coating, coating.filter(|_| material.back.is_some())];
        return;
    }
    let [over_front, over_back] = &mut material.coatings;
    let alike = material.back == Some(material.front);
    let bsdf = match side {
        Side::Coating | Side::CoatingBehind => {
            let both = over_front == over_back;
            let coating = if side == Side::Coating { &mut *over_front } else { &mut *over_back };
            if let Some(coating) = coating {
                set_bindings(coating.parameters(), property, value);
            }
            if both && side == Side::Coating {
                *over_back = *over_front;
            }
            return;
        }
        Side::Front => &mut material.front,
        Side::Back => match &mut material.back {
            Some(back) => back,
            None => return,
        },
    };
    let was_clear = bsdf.has_two_sides();
    set_side(bsdf, property, value);
    if side == Side::Front && alike {
        material.back = Some(material.front);
    }
    if material.front.has_two_sides() {
        material.back = None;
    } else if was_clear && side == Side::Front {
        // Glass has two sides; what takes its place gets them, too.
        material.back = Some(material.front);
        material.coatings[1] = material.coatings[0];
    }
    if material.back.is_some_and(|b| b.has_two_sides()) {
        material.back = None;
    }
}

/// Makes a side of another kind.
pub(crate) fn set_kind(material: &mut Material, side: Side, kind: usize) {
    set(material, side, Property::Kind, Value::Choice(kind));
}

fn set_side(bsdf: &mut Bsdf, property: Property, value: Value) {
    if let (Property::Kind, Value::Choice(kind)) = (property, value) {
        *bsdf = of_kind(kind, bsdf);
        return;
    }
    set_bindings(bsdf.parameters(), property, value);
}

/// Sets the parameter that a property says.
fn set_bindings(bindings: Vec<Binding<'_>>, property: Property, value: Value) {
    for Binding { parameters, slot } in bindings {
        let is_it = property == Property::Parameter(parameters[0].name);
        match (slot, value) {
            (Slot::Share(share), Value::Colour(c)) if is_it => *share = Rgb::from_array(c).into(),
            (Slot::Number(place), Value::Number(x)) if is_it => *place = (x as f32).into(),
            (Slot::Refraction(place) | Slot::Reflectivity(place), Value::Number(x)) if is_it => {
                *place = x as f32;
            }
            (Slot::Boolean(flag), Value::Toggle(on)) if is_it => *flag = on,
            (Slot::Choice(place), Value::Choice(i)) if is_it => *place = i,
            (Slot::Metal { eta, k }, _) => set_metal([eta, k], property, value),
            (Slot::Roughness(roughness), _) => set_roughness(roughness, property, value),
            _ => {}
        }
    }
}

fn set_metal([eta, k]: [&mut Rgb; 2], property: Property, value: Value) {
    match (property, value) {
        (Property::Parameter("material"), Value::Choice(i)) => {
            if let Some(metal) = i.checked_sub(1).and_then(|i| METALS.get(i)) {
                (*eta, *k) = (Rgb::from_array(metal.1), Rgb::from_array(metal.2));
            }
        }
        (Property::Channel(name, channel), Value::Number(x)) => {
            let colour = if name == "eta" { eta } else { k };
            let mut channels = colour.to_array();
            channels[usize::from(channel.min(2))] = x as f32;
            *colour = Rgb::from_array(channels);
        }
        _ => {}
    }
}

fn set_roughness(roughness: &mut Option<Microfacets>, property: Property, value: Value) {
    match (property, value, roughness) {
        (Property::Rough, Value::Toggle(on), roughness) => {
            *roughness = on.then(|| roughness.unwrap_or(Microfacets::PRESET));
        }
        (Property::Parameter("alpha"), Value::Number(x), Some(r)) => {
            let alpha = Number::Constant(x as f32);
            (r.alpha_u, r.alpha_v) = (alpha, alpha);
        }
        (Property::Parameter("alpha_u"), Value::Number(x), Some(r)) => r.alpha_u = (x as f32).into(),
        (Property::Parameter("alpha_v"), Value::Number(x), Some(r)) => r.alpha_v = (x as f32).into(),
        (Property::Parameter("distribution"), Value::Choice(i), Some(r)) => {
            r.distribution = MicrofacetDistribution::ALL[i.min(MicrofacetDistribution::ALL.len() - 1)];
        }
        _ => {}
    }
}

/// A material of a kind that keeps what it can of another.
fn of_kind(kind: usize, old: &Bsdf) -> Bsdf {
    if kind == kind_of(old) {
        return *old;
    }
    let Some(model) = Bsdf::defaults(false).get(kind).copied() else { return *old };
    let (mut old, mut new) = (*old, model.preset());
    let before = old.parameters();
    for Binding { parameters, slot } in new.parameters() {
        let Some(role) = parameters[0].role else { continue };
        let is_same = |b: &&Binding<'_>| b.parameters[0].role == Some(role);
        let is_akin = |b: &&Binding<'_>| b.parameters[0].role.is_some_and(|old| is_roughness(old, role));
        let from = before.iter().find(is_same).or_else(|| before.iter().find(is_akin));
        if let Some(from) = from {
            keep(Binding { parameters, slot }, from);
        }
    }
    new
}

/// Whether both are a roughness, α or its square root.
fn is_roughness(a: Role, b: Role) -> bool {
    [a, b].iter().all(|role| matches!(role, Role::Roughness | Role::RootRoughness))
}

/// Takes over the value of a parameter of the same role.
fn keep(new: Binding<'_>, old: &Binding<'_>) {
    let (parameters, is_same) = (new.parameters, new.parameters[0].role == old.parameters[0].role);
    match (new.slot, &old.slot) {
        (Slot::Share(new), Slot::Share(old)) => *new = **old,
        (Slot::Number(new), Slot::Number(old)) if is_same => *new = **old,
        (
            Slot::Refraction(new) | Slot::Reflectivity(new),
            Slot::Refraction(old) | Slot::Reflectivity(old),
        ) => *new = **old,
        (Slot::Roughness(new), Slot::Roughness(old)) => {
            let is_isotropic = named(parameters, "alpha_v").is_none();
            *new = old.map(|r| if is_isotropic { Microfacets { alpha_v: r.alpha_u, ..r } } else { r });
        }
        (Slot::Number(new), Slot::Roughness(Some(Microfacets { alpha_u: Number::Constant(alpha), .. }))) => {
            *new = alpha.sqrt().min(1.0).into();
        }
        (Slot::Roughness(new), Slot::Number(Number::Constant(root))) => {
            let alpha = (root * root).max(1e-3);
            *new = Some(Microfacets { alpha_u: alpha.into(), alpha_v: alpha.into(), ..Microfacets::PRESET });
        }
        _ => {}
    }
}
