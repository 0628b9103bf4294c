//! Fields of materials: what they are, and setting them.

use foton_math::Rgb;
use foton_scene::description::{
    Bsdf, Colour, Conductor, Dielectric, Diffuse, Material, MicrofacetDistribution, Microfacets, Mirror,
    Null, Plastic, ThinDielectric,
};
use foton_scene::metals::METALS;

use super::field::{FieldId, Fields, Property, Side, Value};

/// Kinds of materials, in the order of [`kind_of`].
const KINDS: [&str; 7] = ["matte", "glass", "thin glass", "mirror", "metal", "plastic", "invisible"];
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
const GOLD: &str = "Au";
const WHITE: Colour = Colour::Constant(Rgb::WHITE);
/// How rough a surface becomes that is made rough.
const NEW_ROUGHNESS: Microfacets =
    Microfacets { distribution: MicrofacetDistribution::Ggx, alpha_u: 0.1, alpha_v: 0.1 };

fn kind_of(bsdf: &Bsdf) -> usize {
    match bsdf {
        Bsdf::Diffuse(Diffuse { .. }) => 0,
        Bsdf::Dielectric(Dielectric { .. }) => 1,
        Bsdf::ThinDielectric(ThinDielectric { .. }) => 2,
        Bsdf::Mirror(Mirror { .. }) => 3,
        Bsdf::Conductor(Conductor { .. }) => 4,
        Bsdf::Plastic(Plastic { .. }) => 5,
        Bsdf::Null(Null) => 6,
    }
}

/// The kind of a material in a word.
pub(crate) fn kind_name(material: &Material) -> &'static str {
    KINDS[kind_of(&material.front)]
}

fn is_clear(bsdf: &Bsdf) -> bool {
    matches!(
        bsdf,
        Bsdf::Dielectric(Dielectric { .. }) | Bsdf::ThinDielectric(ThinDielectric { .. }) | Bsdf::Null(Null)
    )
}

/// Appends a material's fields. Whether some colours come from textures, which cannot be edited.
pub(crate) fn fields(material: &Material, out: &mut Fields) -> bool {
    let mut textured = side_fields(&material.front, Side::Front, out);
    if let Some(back) = material.back.filter(|b| *b != material.front && !is_clear(&material.front)) {
        textured |= side_fields(&back, Side::Back, out);
    }
    match material.opacity.unwrap_or(WHITE) {
        Colour::Constant(c) => out.number(
            FieldId::Opacity,
            ("Opacity", ""),
            f64::from(c.mean()),
            (0.0, 1.0, false),
            "Share of light that meets the surface; the rest passes straight through.",
        ),
        Colour::Texture(_) => textured = true,
    }
    textured
}

fn side_fields(bsdf: &Bsdf, side: Side, out: &mut Fields) -> bool {
    let id = |p| FieldId::Material(side, p);
    let label = if side == Side::Front { "Material" } else { "Material behind" };
    let kinds = KINDS.map(str::to_owned).to_vec();
    out.choice(id(Property::Kind), label, kind_of(bsdf), kinds, "What the surface is made of.");
    let mut textured = false;
    let mut colour = |out: &mut Fields, property, label, value: Colour, help| match value {
        Colour::Constant(c) => out.colour(id(property), label, c.to_array(), help),
        Colour::Texture(_) => textured = true,
    };
    let own = "Share of light reflected, by channel. Above 0.9 light bounces long and passes get slower.";
    match *bsdf {
        Bsdf::Diffuse(Diffuse { reflectance }) => colour(out, Property::Colour, "Colour", reflectance, own),
        Bsdf::Mirror(Mirror { reflectance }) => colour(out, Property::Colour, "Colour", reflectance, own),
        Bsdf::Dielectric(Dielectric { specular_reflectance, specular_transmittance, .. })
        | Bsdf::ThinDielectric(ThinDielectric { specular_reflectance, specular_transmittance, .. }) => {
            let help = "Factor on light that passes; white is physical, a tint colours every crossing alike.";
            colour(out, Property::Transmission, "Transmitted", specular_transmittance, help);
            let help = "Factor on reflected light; white is physical.";
            colour(out, Property::Reflections, "Reflected", specular_reflectance, help);
        }
        Bsdf::Conductor(Conductor { specular_reflectance, eta, k, .. }) => {
            metal_fields(side, eta, k, out);
            let help = "Factor on reflected light; white is physical.";
            colour(out, Property::Reflections, "Tint", specular_reflectance, help);
        }
        Bsdf::Plastic(Plastic { diffuse_reflectance, specular_reflectance, nonlinear, .. }) => {
            colour(out, Property::Colour, "Base colour", diffuse_reflectance, own);
            let help = "Factor on light reflected by the coat; white is physical.";
            colour(out, Property::Reflections, "Reflected", specular_reflectance, help);
            let help =
                "Light reflected inside the coat takes on the base's colour each time: deeper colours.";
            out.toggle(id(Property::Nonlinear), "Deep colour", nonlinear, help);
        }
        Bsdf::Null(Null) => {}
    }
    if let Some((inside, outside)) = iors(bsdf) {
        let range = (1.0, 4.0, false);
        let help = "How strongly light bends: water 1.33, window glass 1.52, sapphire 1.77, diamond 2.42.";
        out.number(id(Property::InsideIor), ("Index of refraction", ""), f64::from(inside), range, help);
        let help = "Index of refraction of what surrounds it: air 1, water 1.33.";
        out.number(id(Property::OutsideIor), ("Index outside", ""), f64::from(outside), range, help);
    }
    if let Some(roughness) = roughness(bsdf) {
        roughness_fields(side, roughness, out);
    }
    textured
}

fn metal_fields(side: Side, eta: Rgb, k: Rgb, out: &mut Fields) {
    let known = METALS.iter().position(|m| (m.1, m.2) == (eta.to_array(), k.to_array()));
    let everyday = |symbol: &str| NAMES.iter().find(|(s, _)| *s == symbol);
    let label = |symbol: &str| match everyday(symbol) {
        Some((_, name)) => format!("{name} ({symbol})"),
        None => symbol.to_owned(),
    };
    let names = METALS.iter().map(|m| label(m.0));
    let options = std::iter::once("custom".to_owned()).chain(names).collect();
    let chosen = known.map_or(0, |i| i + 1);
    let id = |p| FieldId::Material(side, p);
    out.choice(id(Property::Metal), "Metal", chosen, options, "Measured indices of refraction by name.");
    let range = (0.0, 12.0, false);
    let labels = [["eta red", "eta green", "eta blue"], ["k red", "k green", "k blue"]];
    for (i, (eta, k)) in (0u8..).zip(eta.to_array().into_iter().zip(k.to_array())) {
        let [eta_labels, k_labels] = labels;
        let help = "Real part of the index of refraction.";
        out.number(id(Property::Eta(i)), (eta_labels[usize::from(i)], ""), f64::from(eta), range, help);
        let help = "Imaginary part of the index of refraction: larger reflects more.";
        out.number(id(Property::K(i)), (k_labels[usize::from(i)], ""), f64::from(k), range, help);
    }
}

fn roughness_fields(side: Side, roughness: Option<Microfacets>, out: &mut Fields) {
    let id = |p| FieldId::Material(side, p);
    let help = "A smooth surface makes sharp images and caustics; a rough one blurs both.";
    out.toggle(id(Property::Rough), "Rough", roughness.is_some(), help);
    let Some(Microfacets { distribution, alpha_u, alpha_v }) = roughness else { return };
    let range = (0.001, 1.0, true);
    let mut number = |property, label, value: f32| {
        let help =
            "Spread of the surface's slopes. Up to 0.1 eye paths follow the gloss; above, photons show it.";
        out.number(id(property), (label, ""), f64::from(value), range, help);
    };
    if alpha_u == alpha_v {
        number(Property::Roughness, "Roughness", alpha_u);
    } else {
        number(Property::RoughnessU, "Roughness along u", alpha_u);
        number(Property::RoughnessV, "Roughness along v", alpha_v);
    }
    let options = ["Beckmann", "GGX"].map(str::to_owned).to_vec();
    let chosen = usize::from(distribution == MicrofacetDistribution::Ggx);
    out.choice(id(Property::Distribution), "Distribution", chosen, options, "GGX has longer tails of gloss.");
}

fn iors(bsdf: &Bsdf) -> Option<(f32, f32)> {
    match *bsdf {
        Bsdf::Dielectric(Dielectric { int_ior, ext_ior, .. })
        | Bsdf::ThinDielectric(ThinDielectric { int_ior, ext_ior, .. })
        | Bsdf::Plastic(Plastic { int_ior, ext_ior, .. }) => Some((int_ior, ext_ior)),
        _ => None,
    }
}

fn roughness(bsdf: &Bsdf) -> Option<Option<Microfacets>> {
    match *bsdf {
        Bsdf::Dielectric(Dielectric { roughness, .. })
        | Bsdf::Conductor(Conductor { roughness, .. })
        | Bsdf::Plastic(Plastic { roughness, .. }) => Some(roughness),
        _ => None,
    }
}

/// Sets what a field of a side says; the value fits the field.
pub(crate) fn set(material: &mut Material, side: Side, property: Property, value: Value) {
    let alike = material.back == Some(material.front);
    let bsdf = match side {
        Side::Front => &mut material.front,
        Side::Back => match &mut material.back {
            Some(back) => back,
            None => return,
        },
    };
    let was_clear = is_clear(bsdf);
    set_side(bsdf, property, value);
    if side == Side::Front && alike {
        material.back = Some(material.front);
    }
    if is_clear(&material.front) {
        material.back = None;
    } else if was_clear && side == Side::Front {
        // Glass has two sides; what takes its place gets them, too.
        material.back = Some(material.front);
    }
    if material.back.is_some_and(|b| is_clear(&b)) {
        material.back = None;
    }
}

fn set_side(bsdf: &mut Bsdf, property: Property, value: Value) {
    match (property, value) {
        (Property::Kind, Value::Choice(kind)) => *bsdf = of_kind(kind, bsdf),
        (Property::Metal, Value::Choice(i)) => {
            if let (Bsdf::Conductor(Conductor { eta, k, .. }), Some(metal)) =
                (bsdf, i.checked_sub(1).and_then(|i| METALS.get(i)))
            {
                (*eta, *k) = (Rgb::from_array(metal.1), Rgb::from_array(metal.2));
            }
        }
        (Property::Distribution, Value::Choice(i)) => {
            let kinds = [MicrofacetDistribution::Beckmann, MicrofacetDistribution::Ggx];
            with_roughness(bsdf, |r| r.distribution = kinds[i.min(1)]);
        }
        (_, Value::Colour(c)) => set_colour(bsdf, property, Colour::Constant(Rgb::from_array(c))),
        (_, Value::Number(x)) => set_number(bsdf, property, x as f32),
        (Property::Rough, Value::Toggle(on)) => {
            if let Bsdf::Dielectric(Dielectric { roughness, .. })
            | Bsdf::Conductor(Conductor { roughness, .. })
            | Bsdf::Plastic(Plastic { roughness, .. }) = bsdf
            {
                *roughness = on.then(|| roughness.unwrap_or(NEW_ROUGHNESS));
            }
        }
        (Property::Nonlinear, Value::Toggle(on)) => {
            if let Bsdf::Plastic(Plastic { nonlinear, .. }) = bsdf {
                *nonlinear = on;
            }
        }
        _ => {}
    }
}

fn set_colour(bsdf: &mut Bsdf, property: Property, colour: Colour) {
    let place = match (property, bsdf) {
        (Property::Colour, Bsdf::Diffuse(Diffuse { reflectance }) | Bsdf::Mirror(Mirror { reflectance })) => {
            reflectance
        }
        (Property::Colour, Bsdf::Plastic(Plastic { diffuse_reflectance, .. })) => diffuse_reflectance,
        (
            Property::Reflections,
            Bsdf::Dielectric(Dielectric { specular_reflectance, .. })
            | Bsdf::ThinDielectric(ThinDielectric { specular_reflectance, .. })
            | Bsdf::Conductor(Conductor { specular_reflectance, .. })
            | Bsdf::Plastic(Plastic { specular_reflectance, .. }),
        ) => specular_reflectance,
        (
            Property::Transmission,
            Bsdf::Dielectric(Dielectric { specular_transmittance, .. })
            | Bsdf::ThinDielectric(ThinDielectric { specular_transmittance, .. }),
        ) => specular_transmittance,
        _ => return,
    };
    *place = colour;
}

fn set_number(bsdf: &mut Bsdf, property: Property, x: f32) {
    let channel = |c: &mut Rgb, i: u8| match i {
        0 => c.r = x,
        1 => c.g = x,
        _ => c.b = x,
    };
    match (property, &mut *bsdf) {
        (
            Property::InsideIor,
            Bsdf::Dielectric(Dielectric { int_ior, .. })
            | Bsdf::ThinDielectric(ThinDielectric { int_ior, .. })
            | Bsdf::Plastic(Plastic { int_ior, .. }),
        ) => *int_ior = x,
        (
            Property::OutsideIor,
            Bsdf::Dielectric(Dielectric { ext_ior, .. })
            | Bsdf::ThinDielectric(ThinDielectric { ext_ior, .. })
            | Bsdf::Plastic(Plastic { ext_ior, .. }),
        ) => *ext_ior = x,
        (Property::Eta(i), Bsdf::Conductor(Conductor { eta, .. })) => channel(eta, i),
        (Property::K(i), Bsdf::Conductor(Conductor { k, .. })) => channel(k, i),
        (Property::Roughness, _) => with_roughness(bsdf, |r| (r.alpha_u, r.alpha_v) = (x, x)),
        (Property::RoughnessU, _) => with_roughness(bsdf, |r| r.alpha_u = x),
        (Property::RoughnessV, _) => with_roughness(bsdf, |r| r.alpha_v = x),
        _ => {}
    }
}

fn with_roughness(bsdf: &mut Bsdf, change: impl FnOnce(&mut Microfacets)) {
    if let Bsdf::Dielectric(Dielectric { roughness: Some(r), .. })
    | Bsdf::Conductor(Conductor { roughness: Some(r), .. })
    | Bsdf::Plastic(Plastic { roughness: Some(r), .. }) = bsdf
    {
        change(r);
    }
}

/// A material of a kind that keeps what it can of another.
fn of_kind(kind: usize, old: &Bsdf) -> Bsdf {
    if kind == kind_of(old) {
        return *old;
    }
    let colour = match *old {
        Bsdf::Diffuse(Diffuse { reflectance }) | Bsdf::Mirror(Mirror { reflectance }) => reflectance,
        Bsdf::Plastic(Plastic { diffuse_reflectance, .. }) => diffuse_reflectance,
        _ => Colour::Constant(Rgb::splat(0.8)),
    };
    let (int_ior, ext_ior) = iors(old).unwrap_or((1.5, 1.0));
    let roughness = roughness(old).flatten();
    let (specular_reflectance, specular_transmittance) = (WHITE, WHITE);
    match kind {
        0 => Bsdf::Diffuse(Diffuse { reflectance: colour }),
        1 => Bsdf::Dielectric(Dielectric {
            int_ior,
            ext_ior,
            specular_reflectance,
            specular_transmittance,
            roughness,
        }),
        2 => Bsdf::ThinDielectric(ThinDielectric {
            int_ior,
            ext_ior,
            specular_reflectance,
            specular_transmittance,
        }),
        3 => Bsdf::Mirror(Mirror { reflectance: colour }),
        4 => {
            let gold = METALS.iter().find(|m| m.0 == GOLD);
            let (eta, k) = gold.map_or(([0.2; 3], [3.0; 3]), |m| (m.1, m.2));
            let (eta, k) = (Rgb::from_array(eta), Rgb::from_array(k));
            Bsdf::Conductor(Conductor { eta, k, specular_reflectance, roughness })
        }
        5 => Bsdf::Plastic(Plastic {
            int_ior,
            ext_ior,
            diffuse_reflectance: colour,
            specular_reflectance,
            nonlinear: false,
            roughness: roughness.map(|r| Microfacets { alpha_v: r.alpha_u, ..r }),
        }),
        _ => Bsdf::Null(Null),
    }
}
