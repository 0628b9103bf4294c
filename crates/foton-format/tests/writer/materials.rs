//! Materials of all kinds, with everything that a material can have.

use foton_math::Rgb;
use foton_scene::description::{
    Blend, Bsdf, Coating, Colour, Conductor, Dielectric, Diffuse, DiffuseTransmitter, Material,
    MicrofacetDistribution, Microfacets, Mirror, Null, Number, Phong, Plastic, Relief, ReliefKind,
    RoughDiffuse, ThinDielectric, Ward,
};

const fn colour(r: f32, g: f32, b: f32) -> Colour {
    Colour::Constant(Rgb::new(r, g, b))
}

fn bsdfs() -> Vec<Bsdf> {
    let roughness = |distribution, alpha_u: f32, alpha_v: f32| {
        Some(Microfacets { distribution, alpha_u: alpha_u.into(), alpha_v: alpha_v.into() })
    };
    let textured =
        |alpha_u, alpha_v| Some(Microfacets { distribution: MicrofacetDistribution::Ggx, alpha_u, alpha_v });
    let (specular_reflectance, specular_transmittance) = (colour(1.0, 1.0, 1.0), colour(0.5, 0.6, 0.7));
    let plastic = |nonlinear, roughness| {
        Bsdf::Plastic(Plastic {
            int_ior: 1.49,
            ext_ior: 1.000_277,
            diffuse_reflectance: Colour::Texture(1),
            specular_reflectance: colour(0.9, 0.8, 0.7),
            nonlinear,
            roughness,
        })
    };
    let glass = |roughness| {
        Bsdf::Dielectric(Dielectric {
            int_ior: 1.5046,
            ext_ior: 1.000_277,
            specular_reflectance,
            specular_transmittance,
            roughness,
        })
    };
    let metal = |roughness| {
        Bsdf::Conductor(Conductor {
            eta: Rgb::new(0.143_08, 0.374_95, 1.4424),
            k: Rgb::new(3.9831, 2.3857, 1.6032),
            specular_reflectance,
            roughness,
        })
    };
    let (int_ior, ext_ior) = (1.5, 1.0);
    let pane = ThinDielectric { int_ior, ext_ior, specular_reflectance, specular_transmittance };
    vec![
        plastic(false, None),
        plastic(true, roughness(MicrofacetDistribution::Ggx, 0.3, 0.3)),
        glass(None),
        glass(roughness(MicrofacetDistribution::Beckmann, 0.1, 0.2)),
        Bsdf::ThinDielectric(pane),
        Bsdf::Mirror(Mirror { reflectance: colour(0.999, 0.999, 0.999) }),
        metal(None),
        metal(roughness(MicrofacetDistribution::Ggx, 0.02, 0.02)),
        metal(textured(Number::Texture(0), Number::Texture(0))),
        glass(textured(Number::Constant(0.1), Number::Texture(1))),
        plastic(true, textured(Number::Texture(1), Number::Texture(1))),
        glass(roughness(MicrofacetDistribution::Phong, 0.1, 0.2)),
        Bsdf::Null(Null),
    ]
}

/// Those that Mitsuba 3 does not have.
fn old_bsdfs() -> Vec<Bsdf> {
    vec![
        Bsdf::RoughDiffuse(RoughDiffuse {
            reflectance: Colour::Texture(0),
            alpha: Number::Texture(1),
            use_fast_approx: true,
        }),
        Bsdf::Phong(Phong {
            exponent: 12.5.into(),
            specular_reflectance: colour(0.25, 0.5, 0.125),
            diffuse_reflectance: Colour::Texture(0),
        }),
        Bsdf::Ward(Ward {
            variant: 2,
            alpha_u: 0.25.into(),
            alpha_v: Number::Texture(1),
            specular_reflectance: colour(1.0, 1.0, 1.0),
            diffuse_reflectance: colour(0.5, 0.6, 0.7),
        }),
        Bsdf::DiffuseTransmitter(DiffuseTransmitter { transmittance: colour(0.5, 0.25, 0.75) }),
    ]
}

pub(super) fn materials() -> Vec<Material> {
    let diffuse = Bsdf::Diffuse(Diffuse { reflectance: colour(0.1, 0.63, 1.0 / 3.0) });
    let textured = Bsdf::Diffuse(Diffuse { reflectance: Colour::Texture(0) });
    let mut sides = vec![
        (diffuse, None, None),
        (diffuse, Some(diffuse), None),
        (diffuse, Some(textured), Some(colour(0.3, 0.3, 0.3))),
    ];
    sides.extend(bsdfs().into_iter().chain(old_bsdfs()).enumerate().map(|(i, front)| {
        let back = matches!(front, Bsdf::Conductor(Conductor { roughness: Some(_), .. })).then_some(diffuse);
        (front, back, (i == 0).then_some(Colour::Texture(2)))
    }));
    let material = |(front, back, opacity)| Material {
        // One name for all: ids must become different ones.
        name: "a \"strange\" <name> & $more".to_owned(),
        front,
        back,
        opacity,
        ..Material::default()
    };
    let mut materials: Vec<Material> = sides.into_iter().map(material).collect();
    let count = materials.len();
    let blend = |material, weight| Blend { material, weight };
    let relief = |kind, same_behind| Some(Relief { texture: 0, kind, same_behind });
    materials[0].mixture = vec![blend(count, Number::Constant(0.1)), blend(count + 1, Number::Texture(1))];
    materials[0].relief = relief(ReliefKind::Bump { scale: -1.0 / 3.0 }, false);
    materials[1].relief = relief(ReliefKind::Normal, true);
    materials[2].relief = relief(ReliefKind::Normal, false);
    let amber =
        Coating { thickness: 0.3.into(), sigma_a: colour(0.1, 2.5, 1.0 / 3.0), ..Coating::default(true) };
    let textured = Coating { sigma_a: Colour::Texture(0), ..Coating::default(false) };
    materials[0].coatings = [Some(textured), None];
    materials[1].coatings = [Some(amber); 2];
    materials[2].coatings = [None, Some(amber)];
    materials
        .push(Material { mixture: vec![blend(count + 1, Number::Constant(0.7))], ..materials[3].clone() });
    materials
        .push(Material { relief: relief(ReliefKind::Bump { scale: 2.0 }, true), ..materials[1].clone() });
    materials
}

/// Materials that are only blended with others, the last ones of [`materials`].
pub(super) const COMPONENTS: usize = 2;
