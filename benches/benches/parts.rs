//! The parts of a pass on the benchmark box, one thread: `cargo xtask bench parts`, or `cargo bench` in this folder.
//!
//! Rays and directions are those of photons on their way, so caches and branches see what they see in a render. Stages that only a
//! pass can show (tracing, sorting, gathering with refining, adding up) are timed inside passes after the sixteenth; criterion
//! then tells the time of a photon or a pixel.

use std::hint::black_box;
use std::num::NonZeroU32;
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use foton_film::ToneMap;
use foton_format::Options;
use foton_integrator::{Cancel, PpmSettings, Render, RenderSettings, Stage};
use foton_math::glam::{Vec2, Vec3};
use foton_math::{Purpose, Ray, Rgb, Stream};
use foton_scene::description::{Bsdf, Conductor, Dielectric, Diffuse, MicrofacetDistribution, Microfacets, Plastic};
use foton_scene::{LobeFlags, Scattering, Scene, Transport};

const SIDE: u32 = 512;
const PHOTONS: u32 = 1 << 18;
const RAYS: usize = 1 << 14;

fn scene() -> Arc<Scene> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("benches/ lies in the repository");
    let path = root.join("assets/box-spheres/scene.xml");
    let mut description = foton_format::open(&path, &Options::default()).expect("an asset").description;
    for sensor in &mut description.sensors {
        sensor.resize(SIDE, SIDE);
    }
    Arc::new(Scene::build(&description).expect("a sound asset"))
}

/// Rays along photon paths of up to four edges that turn anywhere above a surface.
fn rays(scene: &Scene) -> Vec<Ray> {
    let mut rays = Vec::new();
    for index in 0.. {
        let mut numbers = Stream::new(1, Purpose::Test, 0, index);
        let (emitter, _) = scene.choose_emitter(f64::from(numbers.next_1d())).expect("a lamp");
        let start = scene.emitters()[emitter].emit(numbers.next_1d(), numbers.next_2d(), numbers.next_2d());
        let mut ray = Ray::new(start.origin, start.direction);
        for _ in 0..4 {
            if rays.len() == RAYS {
                return rays;
            }
            rays.push(ray);
            let Some(surface) = scene.nearest(ray) else { break };
            let sphere = foton_math::warp::square_to_sphere(numbers.next_2d());
            let side = -ray.direction.dot(surface.normal).signum();
            let direction = sphere * (sphere.dot(surface.normal) * side).signum();
            ray = Ray::new(surface.ray_origin(direction), direction);
        }
    }
    rays
}

fn of_rays(criterion: &mut Criterion) {
    let scene = scene();
    let rays = rays(&scene);
    let mut group = criterion.benchmark_group("rays");
    group.throughput(Throughput::Elements(RAYS as u64));
    group.bench_function("nearest", |b| {
        b.iter(|| rays.iter().filter(|ray| scene.nearest_hit(**ray).is_some()).count());
    });
    group.bench_function("nearest and its surface", |b| {
        b.iter(|| rays.iter().filter_map(|ray| scene.nearest(*ray)).map(|s| s.position).sum::<Vec3>());
    });
    let shadows: Vec<Ray> = rays.iter().map(|ray| Ray { t_max: 0.5, ..*ray }).collect();
    group.bench_function("shadow", |b| {
        b.iter(|| shadows.iter().filter(|ray| scene.occluded(**ray)).count());
    });
    group.bench_function("emission", |b| {
        let emitter = &scene.emitters()[0];
        b.iter(|| {
            for index in 0..RAYS as u64 {
                let mut numbers = Stream::new(1, Purpose::Test, 0, index);
                black_box(emitter.emit(numbers.next_1d(), numbers.next_2d(), numbers.next_2d()));
            }
        });
    });
}

fn of_bsdfs(criterion: &mut Criterion) {
    let rough = Some(Microfacets { distribution: MicrofacetDistribution::Ggx, alpha_u: 0.3, alpha_v: 0.3 });
    let white = Rgb::splat(0.8);
    let glass = |roughness| Bsdf::Dielectric(Dielectric {
        int_ior: 1.5,
        ext_ior: 1.0,
        specular_reflectance: white,
        specular_transmittance: white,
        roughness,
    });
    let bsdfs = [
        ("diffuse", Bsdf::Diffuse(Diffuse { reflectance: white })),
        ("glass", glass(None)),
        ("rough glass", glass(rough)),
        (
            "rough metal",
            Bsdf::Conductor(Conductor {
                eta: Rgb::splat(0.2),
                k: Rgb::splat(3.9),
                specular_reflectance: white,
                roughness: rough,
            }),
        ),
        (
            "plastic",
            Bsdf::Plastic(Plastic {
                int_ior: 1.5,
                ext_ior: 1.0,
                diffuse_reflectance: white,
                specular_reflectance: white,
                nonlinear: false,
                roughness: None,
            }),
        ),
    ];
    let mut numbers = Stream::new(1, Purpose::Test, 0, 0);
    let drawn: Vec<(Vec3, f32, Vec2)> = (0..RAYS)
        .map(|_| {
            let wo = foton_math::warp::square_to_cosine_hemisphere(numbers.next_2d());
            (wo, numbers.next_1d(), numbers.next_2d())
        })
        .collect();
    let mut group = criterion.benchmark_group("BSDF sampling");
    group.throughput(Throughput::Elements(RAYS as u64));
    for (name, bsdf) in bsdfs {
        let scattering = Scattering { bsdf, opacity: 1.0, coat: None };
        group.bench_function(name, |b| {
            b.iter(|| {
                for &(wo, u_lobe, u) in &drawn {
                    black_box(scattering.sample(wo, Transport::Importance, u_lobe, u, LobeFlags::NONE));
                }
            });
        });
    }
}

/// A render after its sixteenth pass.
fn warm(scene: &Arc<Scene>, error: bool) -> Render {
    let photons = NonZeroU32::new(PHOTONS).expect("above 0");
    let settings = RenderSettings { samples_per_pixel: NonZeroU32::MIN, error, ppm: PpmSettings { photons_per_pass: photons, first_pass: photons, radius: Some(0.455), ..PpmSettings::default() }, ..RenderSettings::default() };
    let cancel = Cancel::default();
    let mut render = Render::start(Arc::clone(scene), settings, &mut |_| (), &cancel).expect("nobody cancels");
    for _ in 0..16 {
        render.advance(&mut |_| (), &cancel).expect("nobody cancels");
    }
    render
}

/// Time of one stage in so many passes.
fn in_passes(render: &mut Render, wanted: Stage, passes: u64) -> Duration {
    let mut spent = Duration::ZERO;
    for _ in 0..passes {
        let mut running: Option<(Stage, Instant)> = None;
        let mut end = |running: Option<(Stage, Instant)>| {
            if let Some((stage, begin)) = running
                && stage == wanted
            {
                spent += begin.elapsed();
            }
        };
        let next = &mut |stage| end(running.replace((stage, Instant::now())));
        render.advance(next, &Cancel::default()).expect("nobody cancels");
        end(running);
    }
    spent
}

fn of_passes(criterion: &mut Criterion) {
    let scene = scene();
    let pixels = u64::from(SIDE * SIDE);
    let mut group = criterion.benchmark_group("a pass");
    group.sample_size(10).measurement_time(Duration::from_secs(6));
    for error in [false, true] {
        let mut render = warm(&scene, error);
        let stages = [
            ("trace", Stage::Trace, u64::from(PHOTONS)),
            ("sort", Stage::Sort, u64::from(PHOTONS)),
            ("gather and refine", Stage::Gather, u64::from(PHOTONS)),
            ("radiance", Stage::Radiance, pixels),
        ];
        for (name, stage, elements) in stages {
            group.throughput(Throughput::Elements(elements));
            let id = BenchmarkId::new(name, if error { "with the live error" } else { "plain" });
            group.bench_function(id, |b| b.iter_custom(|passes| in_passes(&mut render, stage, passes)));
        }
    }
}

fn of_images(criterion: &mut Criterion) {
    let scene = scene();
    let mut group = criterion.benchmark_group("images");
    group.sample_size(10).throughput(Throughput::Elements(u64::from(SIDE * SIDE)));
    let settings = RenderSettings { samples_per_pixel: NonZeroU32::MIN, ..RenderSettings::default() };
    group.bench_function("eye pass", |b| {
        b.iter(|| Render::start(Arc::clone(&scene), settings.clone(), &mut |_| (), &Cancel::default()).is_ok());
    });
    let colours: Vec<Rgb> = (0..SIDE * SIDE).map(|i| Rgb::new(i as f32 * 1e-5, 0.5, 2.0)).collect();
    for tone_map in [ToneMap::Linear, ToneMap::PbrNeutral, ToneMap::AgX] {
        group.bench_function(BenchmarkId::new("tone map", tone_map.name()), |b| {
            b.iter(|| {
                for &colour in &colours {
                    black_box(foton_film::tone_map::display(colour, tone_map, 0.5));
                }
            });
        });
    }
}

/// On one thread, where a part's own time shows.
fn on_one_thread() -> Criterion {
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global().ok();
    Criterion::default()
}

criterion_group! { name = parts; config = on_one_thread(); targets = of_rays, of_bsdfs, of_passes, of_images }
criterion_main!(parts);
