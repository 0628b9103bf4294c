//! `foton info`: what a scene contains, what that switches on, and what a render of it would take.

use std::num::NonZeroU32;
use std::sync::Arc;

use foton_integrator::{Cancel, DirectLight, Feature, Method, PpmSettings, Render, RenderSettings};
use foton_scene::description::SceneDescription;
use foton_scene::{Scene, Sensor};
use foton_session::Session;
use serde_json::{Value, json};

use crate::args::Info;
use crate::console::{Console, Failure};
use crate::opening::{Bounds, build, choose_sensor, file_name, open, refuse_two_roles};

/// Longest side, in pixels, of the picture that tells what each emitter's photons are good for.
const PROBE_SIZE: u32 = 64;
const PROBE_PHOTONS: NonZeroU32 = NonZeroU32::new(1 << 14).expect("above 0");

/// Runs `foton info`.
pub(crate) fn print(args: &Info, console: &Console) -> Result<(), Failure> {
    // A signal ends the program at once: there is nothing to save.
    let cancel = Cancel::default();
    let opened = open(&args.scene, &args.scene_options.read, args.memory, console, &cancel)?;
    refuse_two_roles(args.roles(), &opened)?;
    let name = file_name(&args.scene);
    let sensor = choose_sensor(&opened, args.scene_options.sensor.as_deref())?;
    let mut probed = opened.description.clone();
    let bounds = Bounds { size: None, region: args.region, memory: args.memory };
    let (scene, identity) = build(opened, &name, sensor, bounds, console, &cancel)?;
    let settings = RenderSettings { sensor, ..RenderSettings::default() };
    console.of_settings(&scene, &settings);
    if args.json {
        console.event(&as_json(&scene, &settings, &name, identity.hash));
    } else {
        for line in as_text(&scene, &settings, &name, identity.hash) {
            console.out(&line);
        }
    }
    if let Some(region) = args.region {
        // It was checked when the scene was built.
        let _ = probed.sensors[sensor].show_only(region);
    }
    // The probe builds its own: both at once would take twice the memory that was asked for.
    drop(scene);
    if let Some(probe) = probe(probed, &settings) {
        console.starved_emitters(&probe);
    }
    Ok(())
}

/// One pass of few photons at few pixels; `None` where nothing emits light.
fn probe(mut description: SceneDescription, settings: &RenderSettings) -> Option<Render> {
    for sensor in &mut description.sensors {
        let longest = f64::from(sensor.width.max(sensor.height));
        let shrunk = |side: u32| (f64::from(side) * f64::from(PROBE_SIZE) / longest).ceil().max(1.0) as u32;
        if longest > f64::from(PROBE_SIZE) {
            sensor.resize(shrunk(sensor.width), shrunk(sensor.height));
        }
    }
    let scene = Scene::build(&description).ok()?;
    if scene.emitters().is_empty() {
        return None;
    }
    let settings = RenderSettings {
        samples_per_pixel: NonZeroU32::MIN,
        ppm: PpmSettings {
            first_pass: PROBE_PHOTONS,
            photons_per_pass: PROBE_PHOTONS,
            // Whether they come near anything that is seen, however they got there.
            direct_light: DirectLight::Photons,
            ..settings.ppm
        },
        ..settings.clone()
    };
    let cancel = Cancel::default();
    let mut render = Render::start(Arc::new(scene), settings, &mut |_| {}, &cancel).ok()?;
    render.advance(&mut |_| {}, &cancel).ok()?;
    Some(render)
}

fn as_json(scene: &Scene, settings: &RenderSettings, name: &str, hash: u64) -> Value {
    let c = scene.census();
    let memory = Session::estimate_memory(scene, settings, None);
    let emitters: Vec<Value> = emitters(scene)
        .map(|(name, kind, watts, share)| json!({ "name": name, "type": kind, "watts": watts, "share": share }))
        .collect();
    let parts: Vec<Value> = Render::features(scene, settings)
        .iter()
        .map(|f| {
            json!({
                "name": f.name, "on": f.on, "why": f.why, "cost": f.cost,
                "bytes_per_hit_point": f.bytes_per_hit_point, "bytes_per_pixel": f.bytes_per_pixel,
            })
        })
        .collect();
    json!({
        "event": "info",
        "scene": name,
        "hash": format!("{hash:016x}"),
        "census": {
            "shapes": scene.shapes().len(), "triangles": c.triangles, "spheres": c.spheres, "discs": c.discs,
            "tubes": c.cylinders, "instances": c.instances, "degenerate_triangles": c.degenerate_triangles,
            "emitters": c.emitters,
        },
        "sensors": scene.sensors().iter().map(|s| sensor(scene, s)).collect::<Vec<_>>(),
        "emitters": emitters,
        "integrator": Method::chosen_for(scene, settings.sensor).0.name(),
        "features": parts,
        "memory": {
            "bytes": memory.peak_bytes(), "scene": memory.scene_bytes, "hit_points": memory.hit_point_bytes,
            "pixels": memory.pixel_bytes, "photons": memory.photon_bytes, "layout": memory.layout_bytes,
            "expected_hit_points": memory.hit_points,
        },
    })
}

fn as_text(scene: &Scene, settings: &RenderSettings, name: &str, hash: u64) -> Vec<String> {
    let c = scene.census();
    let mut lines = vec![
        format!("{name}  (hash {hash:016x})"),
        format!(
            "{} shapes: {} triangles, {} spheres, {} discs, {} tubes; {} triangles without area left out",
            scene.shapes().len(),
            c.triangles,
            c.spheres,
            c.discs,
            c.cylinders,
            c.degenerate_triangles
        ),
    ];
    if c.instances > 0 {
        lines
            .push(format!("{} of the shapes are instances: they share trees over their meshes", c.instances));
    }
    for s in scene.sensors() {
        let mut line = format!("sensor {}: {} x {} pixels", s.name, s.width, s.height);
        if let Some([radius, focus]) = lens(scene, s) {
            line += &format!(", a lens of radius {radius:.4} focused at {focus:.4}");
        }
        lines.push(line);
    }
    for (name, kind, watts, share) in emitters(scene) {
        lines.push(format!("emitter {name} ({kind}): {watts:.4} W, {:.1} % of the photons", share * 100.0));
    }
    let (method, why) = Method::chosen_for(scene, settings.sensor);
    lines.push(format!("--integrator auto would take {}: {why}", method.name()));
    let on = |f: &Feature| if f.on { "on " } else { "off" };
    for f in Render::features(scene, settings) {
        let mut line = format!("{}  {}: {}", on(&f), f.name, f.why);
        if f.on {
            line += &format!("; costs {}", f.cost);
            if f.bytes_per_hit_point + f.bytes_per_pixel > 0 {
                line +=
                    &format!(" ({} B a hit point, {} B a pixel)", f.bytes_per_hit_point, f.bytes_per_pixel);
            }
        }
        lines.push(line);
    }
    lines.push(format!("memory: about {}", Session::estimate_memory(scene, settings, None)));
    lines
}

/// Radius and focus distance of a camera's lens in world units, if it has one.
fn lens(scene: &Scene, sensor: &Sensor) -> Option<[f64; 2]> {
    let world = |length: f32| scene.normalisation().world_length(f64::from(length));
    sensor.lens().map(|lens| lens.map(world))
}

fn sensor(scene: &Scene, sensor: &Sensor) -> Value {
    let mut value = json!({ "name": sensor.name, "width": sensor.width, "height": sensor.height });
    if let Some([radius, focus]) = lens(scene, sensor) {
        value["lens"] = json!({ "aperture_radius": radius, "focus_distance": focus });
    }
    value
}

/// Name, kind, power (mean of the channels, W) and share of the photons of each emitter.
fn emitters(scene: &Scene) -> impl Iterator<Item = (&str, &'static str, f64, f64)> {
    let area = scene.normalisation().scale().powi(2);
    scene.emitters().iter().enumerate().map(move |(i, e)| {
        (e.name.as_str(), e.kind_name(), f64::from(e.power().mean()) / area, scene.emitter_share(i))
    })
}
