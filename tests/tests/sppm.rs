//! Stochastic progressive photon mapping: what stands still with eye samples that are followed once converges; means are those of closed
//! forms and of progressive photon mapping; and the error includes what eye samples bring.

use std::f64::consts::PI;
use std::num::NonZeroU32;

use foton_film::Image;
use foton_integrator::{
    Alpha, Cancel, DirectLight, LayerKind, Method, PpmSettings, RadiusRule, Render, RenderSettings,
};
use foton_math::Rgb;
use foton_math::glam::DVec3;
use foton_scene::description::{Bsdf, Colour, Conductor, MicrofacetDistribution, Microfacets};
use foton_tests::{Sketch, glass, grey, mean, seeds};

fn settings(method: Method, photons: u32) -> RenderSettings {
    let photons = NonZeroU32::new(photons).expect("above 0");
    RenderSettings {
        method,
        samples_per_pixel: method.default_samples(),
        error: true,
        ppm: PpmSettings { photons_per_pass: photons, first_pass: photons, ..PpmSettings::default() },
        ..RenderSettings::default()
    }
}

/// A lamp fills the left of the picture up to x = 0.1 on a plane whose pixels are 0.25 wide: a column of pixels sees 0.4 of it.
#[test]
fn the_coverage_of_an_edge_converges_where_four_samples_stay_as_they_fell() {
    let sketch = Sketch::default().camera(DVec3::ZERO, -DVec3::Z, 90.0, 8).rectangle(
        DVec3::new(-3.9, 0.0, -1.0),
        DVec3::X * 4.0,
        DVec3::Y * 4.0,
        grey(0.0),
        Some(Rgb::WHITE),
    );
    let column = |render: &Render| -> Vec<f64> {
        (0..8).map(|row| f64::from(render.image().pixels[row * 8 + 4].g)).collect()
    };
    let frozen = column(&sketch.render(settings(Method::Ppm, 100), 64));
    assert!(frozen.iter().all(|p| (4.0 * p).fract() == 0.0), "{frozen:?}");
    let few = column(&sketch.render(settings(Method::Sppm, 100), 2));
    let many = column(&sketch.render(settings(Method::Sppm, 100), 64));
    let worst = |pixels: &[f64]| pixels.iter().map(|p| (p - 0.4).abs()).fold(0.0, f64::max);
    assert!(worst(&frozen) > 0.09 && worst(&few) > 0.09 && worst(&many) < 0.05, "{few:?} {many:?}");
}

/// As in `analytic.rs`: E = Φ/(4πR²(1−ρ)) inside a sphere, where discs have no curvature bias.
#[test]
fn an_integrating_sphere_has_the_irradiance_of_its_closed_form_while_radii_shrink() {
    let (radius, albedo, power) = (2.0, 0.6, 5.0);
    let sketch = Sketch::default()
        .camera(DVec3::new(0.5, 0.2, 0.1), DVec3::new(1.0, 0.0, 0.3), 90.0, 16)
        .sphere(DVec3::ZERO, radius, grey(albedo as f32), None)
        .inside_out()
        .point(DVec3::ZERO, power);
    let expected = albedo / PI * power / (4.0 * PI * radius * radius * (1.0 - albedo));
    for (radius_rule, direct_light) in
        [(RadiusRule::Local, DirectLight::Photons), (RadiusRule::Adaptive, DirectLight::ShadowRays)]
    {
        let base = settings(Method::Sppm, 20_000);
        let ppm = PpmSettings { radius: Some(radius / 4.0), radius_rule, direct_light, ..base.ppm };
        let (got, sigma) = seeds(&sketch, &RenderSettings { ppm, ..base }, 4, 6);
        assert!(
            (got - expected).abs() < 4.0 * sigma + 1e-3 * expected,
            "{got} ± {sigma}, expected {expected}"
        );
        assert!(sigma < 0.01 * expected, "the test must be able to tell: {sigma}");
    }
}

/// A room with glass, a chalk ball, a narrow metal and a lamp that is not as bright as white: brighter ones count in the error as white does.
fn room() -> Sketch {
    let metal = Bsdf::Conductor(Conductor {
        eta: Rgb::new(0.2, 0.9, 1.1),
        k: Rgb::new(3.9, 2.5, 2.1),
        // Highlights of the point count up to white, too.
        specular_reflectance: Colour::Constant(Rgb::splat(0.1)),
        roughness: Some(Microfacets::isotropic(MicrofacetDistribution::Ggx, 0.08)),
    });
    Sketch::default()
        .camera(DVec3::new(0.0, 0.0, 0.95), DVec3::new(0.0, -0.2, -1.0), 70.0, 24)
        .room(grey(0.6), None)
        .sphere(DVec3::new(0.4, -0.6, 0.0), 0.35, glass(1.5), None)
        .sphere(DVec3::new(-0.4, -0.6, -0.2), 0.35, metal, None)
        .sphere(DVec3::new(0.0, 0.7, -0.2), 0.15, grey(0.0), Some(Rgb::new(0.5, 0.4, 0.3)))
        .point(DVec3::new(0.3, 0.6, 0.4), 6.0)
}

#[test]
fn means_are_those_of_progressive_photon_mapping() {
    for direct_light in [DirectLight::Photons, DirectLight::ShadowRays] {
        let by = |method, passes| {
            let base = settings(method, 20_000);
            let samples_per_pixel =
                NonZeroU32::new(if method == Method::Ppm { 16 } else { 1 }).expect("above 0");
            let alpha = Alpha::new(1.0).expect("in range");
            // Equal radii for good: the same bias.
            let ppm = PpmSettings { direct_light, alpha, radius: Some(0.1), ..base.ppm };
            room().render(RenderSettings { samples_per_pixel, layers: true, ppm, ..base }, passes)
        };
        let (ppm, sppm) = (by(Method::Ppm, 12), by(Method::Sppm, 16));
        for kind in [LayerKind::Direct, LayerKind::Caustic, LayerKind::Indirect, LayerKind::Emission] {
            let [a, b] = [&ppm, &sppm].map(|render| mean(&render.colour_layer(kind).expect("summed")));
            let tolerance = 0.02 * a + 3e-3 * mean(&ppm.image());
            assert!((a - b).abs() < tolerance, "{direct_light:?}, {kind:?}: {a} {b}");
        }
        let parts: f64 = [LayerKind::Direct, LayerKind::Caustic, LayerKind::Indirect, LayerKind::Emission]
            .map(|kind| mean(&sppm.colour_layer(kind).expect("summed")))
            .iter()
            .sum();
        assert!((parts / mean(&sppm.image()) - 1.0).abs() < 1e-5, "layers add up to the image");
    }
}

fn rms(image: &Image, truth: &[f64]) -> f64 {
    let square: f64 =
        image.pixels.iter().zip(truth).map(|(p, t)| (f64::from(p.luminance()) - t).powi(2)).sum();
    (square / truth.len() as f64).sqrt()
}

/// Of the image and of all passes so far.
fn advance(render: &mut Render, passes: u32) {
    for _ in 0..passes {
        render.advance(&mut |_| (), &Cancel::default()).expect("not cancelled");
    }
}

/// Half of this room's error is that of edges, gloss and what is seen in glass. Radii stay, so that all runs have one limit.
#[test]
fn the_error_tells_how_far_the_image_is_from_its_limit_eye_samples_included() {
    let of = |seed| {
        let base = settings(Method::Sppm, 4_000);
        let alpha = Alpha::new(1.0).expect("in range");
        let ppm = PpmSettings { alpha, direct_light: DirectLight::ShadowRays, ..base.ppm };
        RenderSettings { seed, ppm, ..base }
    };
    let limit: Vec<f64> = {
        let render = room().render(of(1000), 1500);
        render.image().pixels.iter().map(|p| f64::from(p.luminance())).collect()
    };
    let (mut squares, mut estimates) = ([0.0; 2], [0.0; 2]);
    let mut bounds = 0;
    for seed in 0..8 {
        let mut render = room().render(of(seed), 0);
        for (i, passes) in [8, 24].into_iter().enumerate() {
            advance(&mut render, passes);
            let error = render.error().expect("known after 8 passes");
            let truth = rms(&render.image(), &limit) / error.mean_luminance;
            squares[i] += truth * truth;
            estimates[i] += error.noise * error.noise;
            bounds += u32::from(truth < error.high);
        }
    }
    for (square, estimate) in squares.into_iter().zip(estimates) {
        let ratio = (square / estimate).sqrt();
        assert!((0.85..1.18).contains(&ratio), "true over estimated: {ratio}");
    }
    assert!(bounds >= 13, "{bounds} of 16 below the upper end");
    // Antialiasing and gloss fall as independent samples do, or faster.
    let falls = (squares[0] / squares[1]).sqrt();
    assert!(falls > 1.7, "four times the passes: {falls}");
}

#[test]
fn error_planes_tell_the_noise_of_single_pixels() {
    let render = |seed| room().render(RenderSettings { seed, ..settings(Method::Sppm, 4_000) }, 16);
    let runs: Vec<Render> = (0..12).map(render).collect();
    let plane = |kind| -> Vec<f64> {
        let planes: Vec<Vec<f32>> =
            runs.iter().map(|run| run.error_plane(kind).expect("estimated")).collect();
        (0..planes[0].len())
            .map(|pixel| planes.iter().map(|plane| f64::from(plane[pixel]).powi(2)).sum::<f64>() / 12.0)
            .collect()
    };
    let told = plane(LayerKind::ErrorNoise);
    let found: Vec<f64> = (0..told.len())
        .map(|pixel| {
            let light: Vec<f64> =
                runs.iter().map(|run| f64::from(run.image().pixels[pixel].luminance())).collect();
            let mean = light.iter().sum::<f64>() / 12.0;
            light.iter().map(|l| (l - mean).powi(2)).sum::<f64>() / 11.0
        })
        .collect();
    // The noisiest tenth and the rest apart.
    let mut order: Vec<usize> = (0..told.len()).collect();
    order.sort_by(|a, b| found[*a].total_cmp(&found[*b]));
    let (calm, noisy) = order.split_at(order.len() * 9 / 10);
    for pixels in [calm, noisy] {
        let sum = |of: &[f64]| pixels.iter().map(|p| of[*p]).sum::<f64>();
        let ratio = (sum(&told) / sum(&found)).sqrt();
        assert!((0.6..1.7).contains(&ratio), "{ratio}");
    }
}

/// A pixel's hit points share the factor that r² has shrunk by, each from a first radius by its own footprint.
#[test]
fn radii_of_a_pixel_shrink_together_from_first_radii_of_their_own() {
    let base = settings(Method::Sppm, 4_000);
    let ppm = PpmSettings { radius_rule: RadiusRule::Local, ..base.ppm };
    let settings = RenderSettings { samples_per_pixel: NonZeroU32::new(4).expect("above 0"), ppm, ..base };
    // So many pixels that their footprints decide, not the size of the room.
    let mut sketch = room();
    sketch.0.sensors[0].resize(128, 128);
    let render = sketch.render(settings, 4);
    let mut spread = 0;
    for pixel in 0..128 * 128 {
        let discs = render.discs(pixel);
        let found: Vec<u64> = discs.iter().map(|disc| disc.photons_found).collect();
        assert!(found.windows(2).all(|pair| pair[0] == pair[1]), "of the pixel: {found:?}");
        let radius = |f: fn(f64, f64) -> f64| discs.iter().map(|disc| disc.radius).reduce(f).unwrap_or(1.0);
        spread += u32::from(radius(f64::max) > 1.2 * radius(f64::min));
    }
    assert!(spread > 20, "hit points of one pixel are near and far: {spread}");
    let found: u64 = render.photons_found().iter().map(|n| u64::from(*n)).sum();
    assert!(found > 0 && render.radii().largest > 0.0);
}
