//! glTF files: those that `tests/scenes/gltf/make.py` makes, what comes of them, and files with something wrong.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use foton_format::{OpenError, Opened, Options, open};
use foton_math::Rgb;
use foton_math::glam::DVec3;
use foton_scene::description::{
    Bitmap, Bsdf, Colour, Dielectric, EmitterKind, FovAxis, Geometry, Material, Mesh, Number, Principled,
    PrincipledThin, Projection, ShapeDescription, Texture, TextureKind, ThinDielectric, Wrap,
};

mod faults;
mod surfaces;

fn scene_path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/scenes/gltf").join(name)
}

fn opened(name: &str) -> Opened {
    open(&scene_path(name), &Options::default()).unwrap_or_else(|e| panic!("{name}: {e}"))
}

fn said(opened: &Opened) -> Vec<String> {
    opened.warnings.iter().map(|w| w.message.clone()).collect()
}

fn shape<'a>(opened: &'a Opened, name: &str) -> &'a ShapeDescription {
    opened.description.shapes.iter().find(|s| s.name == name).unwrap_or_else(|| panic!("no shape {name}"))
}

fn mesh<'a>(opened: &'a Opened, name: &str) -> &'a Arc<Mesh> {
    let Geometry::Mesh(mesh) = &shape(opened, name).geometry else { panic!("{name} is no mesh") };
    mesh
}

fn material<'a>(opened: &'a Opened, name: &str) -> &'a Material {
    opened
        .description
        .materials
        .iter()
        .find(|m| m.name == name)
        .unwrap_or_else(|| panic!("no material {name}"))
}

fn principled(opened: &Opened, name: &str) -> Principled {
    let Bsdf::Principled(model) = material(opened, name).front else { panic!("{name}") };
    model
}

fn texture(opened: &Opened, index: usize) -> (&Texture, &Bitmap) {
    let texture = &opened.description.textures[index];
    let TextureKind::Bitmap { bitmap, .. } = &texture.kind else { panic!("{texture:?}") };
    (texture, bitmap)
}

fn assert_near(found: f64, wanted: f64, within: f64) {
    assert!((found - wanted).abs() <= within, "{found} is not {wanted}");
}

/// A folder that goes with the test.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("foton-gltf-{name}-{}", std::process::id()));
        fs::create_dir_all(&folder).expect("a folder");
        Self(folder)
    }

    fn file(&self, name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
        let path = self.0.join(name);
        fs::write(&path, bytes).expect("room");
        path
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

#[test]
fn files_of_all_features_open_with_these_warnings() {
    let lights = "candela and lux of lights are divided by 683 lm/W, as Blender does";
    for (name, shapes, warnings) in [
        ("metallic-roughness.glb", 9, &[][..]),
        ("textures.gltf", 9, &[lights]),
        ("alpha.glb", 6, &[]),
        ("normal-map.glb", 3, &[lights]),
        (
            "emissive.glb",
            4,
            &["materials[3]: is unlit: it emits its base colour, which lights the scene as well"],
        ),
        ("glass.glb", 8, &["absorption in the volume is a tint"]),
        ("coats.glb", 8, &["left out", "sheen is Disney's", "variants of materials"]),
        ("lights.glb", 2, &["a spot fades linearly", lights]),
        ("instances.glb", 16, &[]),
        ("packed.glb", 6, &["points and lines are left out"]),
        ("cameras.gltf", 4, &[lights]),
        ("colours.glb", 6, &[]),
        ("pose.glb", 4, &["skins are shown as the nodes", "animations are left out"]),
        ("bare.glb", 4, &["the file has no camera", "nothing in the file emits light"]),
    ] {
        let opened = opened(name);
        let said = said(&opened);
        for warning in warnings {
            assert!(said.iter().any(|s| s.contains(warning)), "{name} does not say {warning:?}: {said:#?}");
        }
        assert!(said.len() <= warnings.len() + 1, "{name}: {said:#?}");
        assert_eq!(opened.description.shapes.len(), shapes, "{name}");
        foton_scene::Scene::build(&opened.description).unwrap_or_else(|e| panic!("{name}: {e}"));
    }
}

#[test]
fn nodes_and_instances_share_their_mesh() {
    let opened = opened("instances.glb");
    let of_corner = |s: &&ShapeDescription| match &s.geometry {
        Geometry::Mesh(m) => Arc::ptr_eq(m, mesh(&opened, "inner")),
        _ => false,
    };
    let shapes: Vec<_> = opened.description.shapes.iter().filter(of_corner).collect();
    assert_eq!(shapes.len(), 14);
    let names: Vec<_> = shapes.iter().map(|s| s.name.as_str()).collect();
    assert_eq!(names[..4], ["inner", "mirrored", "ring", "ring-2"]);
    // The group is turned by 0.4 around y and moved by −1.5 along z.
    let (sin, cos) = 0.4_f64.sin_cos();
    let corner = shapes[1].to_world.transform_point3(DVec3::X);
    assert!((corner - DVec3::new(-2.0 * cos, 0.0, 2.0 * sin - 1.5)).length() < 1e-7, "{corner}");
    assert!(shapes[1].to_world.matrix3.determinant() < 0.0 && !shapes[1].flip_normals);
    // The fourth instance is turned by a right angle.
    let fourth = shapes[5].to_world;
    assert!((fourth.translation - DVec3::new(0.0, 0.0, 2.5)).length() < 1e-6);
    assert!((fourth.matrix3 * DVec3::X - DVec3::new(0.0, 0.0, -0.49)).length() < 1e-4);
}

#[test]
fn cameras_and_lights_stand_where_their_nodes_do() {
    let opened = opened("cameras.gltf");
    let [front, side, plan] = &opened.description.sensors[..] else { panic!() };
    assert_eq!((front.name.as_str(), side.name.as_str()), ("front", "side"));
    assert_eq!((front.width, front.height, front.fov_axis), (768, 576, FovAxis::Y));
    assert_near(front.fov_degrees, 0.7_f64.to_degrees(), 1e-9);
    let looks = (DVec3::new(0.0, 0.5, 0.0) - DVec3::new(0.0, 2.0, 6.0)).normalize();
    assert!((front.to_world.matrix3 * DVec3::Z - looks).length() < 1e-9);
    // x points to the left of the image.
    assert!((front.to_world.matrix3 * DVec3::X + DVec3::X).length() < 1e-9);
    assert_eq!((side.near_clip, side.far_clip), (Some(0.1), Some(100.0)));
    let (sin, cos) = 1.2_f64.sin_cos();
    let origin = DVec3::new(6.0 * sin, 0.5, 6.0 * cos);
    assert!((side.to_world.translation - origin).length() < 1e-9, "{}", side.to_world.translation);
    assert_near(side.to_world.matrix3.determinant(), 1.0, 1e-9);
    assert_eq!((plan.projection, plan.width, plan.height), (Projection::Orthographic, 814, 544));
    // 6 units wide and 4 high, looking down with −z up.
    assert!((plan.to_world.matrix3 * DVec3::X - DVec3::new(-3.0, 0.0, 0.0)).length() < 1e-9);
    assert!((plan.to_world.matrix3 * DVec3::Y - DVec3::new(0.0, 0.0, -3.0)).length() < 1e-9);
    assert!((plan.to_world.matrix3 * DVec3::Z - DVec3::NEG_Y).length() < 1e-9);
}

#[test]
fn candela_and_lux_become_watts() {
    let emitters = opened("lights.glb").description.emitters;
    let near = |found: Rgb, wanted: [f32; 3]| {
        found.to_array().iter().zip(wanted).for_each(|(a, b)| assert_near((*a).into(), b.into(), 1e-5));
    };
    let EmitterKind::Point { position, intensity } = &emitters[0].kind else { panic!() };
    assert_eq!(*position, DVec3::new(-2.5, 1.5, 1.0));
    near(*intensity, [8.0, 2.4, 1.6]);
    let EmitterKind::Spot { to_world, intensity, cutoff_degrees, beam_degrees, .. } = &emitters[1].kind
    else {
        panic!()
    };
    near(*intensity, [8.0, 40.0, 12.0]);
    assert_near(*cutoff_degrees, 0.4_f64.to_degrees(), 1e-9);
    assert_near(*beam_degrees, 0.2_f64.to_degrees(), 1e-9);
    let down = DVec3::new(-1.5, -4.0, -0.5).normalize();
    assert!((to_world.matrix3 * DVec3::Z - down).length() < 1e-9);
    let EmitterKind::Directional { direction, irradiance } = &emitters[2].kind else { panic!() };
    assert!((*direction + DVec3::new(2.0, 3.0, 4.0).normalize()).length() < 1e-9);
    near(*irradiance, [0.32, 0.4, 0.8]);

    let defines = vec![("lumens_per_watt".to_owned(), "1".to_owned())];
    let raw = open(&scene_path("lights.glb"), &Options { defines, ..Options::default() }).expect("a file");
    let EmitterKind::Point { intensity, .. } = raw.description.emitters[0].kind else { panic!() };
    assert_near(intensity.r.into(), 8.0 * 683.0, 1e-2);
    assert!(raw.warnings.iter().all(|w| !w.message.contains("candela")));
    let defines = vec![("a".to_owned(), "1".to_owned()), ("lumens_per_watt".to_owned(), "-1".to_owned())];
    let error = open(&scene_path("lights.glb"), &Options { defines, ..Options::default() }).unwrap_err();
    assert_eq!(error.diagnostics().iter().filter(|d| d.message.contains("-D")).count(), 2, "{error}");
}

#[test]
fn packed_numbers_are_those_of_the_formula() {
    let opened = opened("packed.glb");
    let quantised = mesh(&opened, "quantised");
    assert_eq!(quantised.triangles.len(), 16 * 14);
    for ((position, normal), uv) in
        quantised.positions.iter().zip(&quantised.normals).zip(&quantised.texture_coordinates)
    {
        let (phi, theta) = (std::f64::consts::TAU * uv.x, std::f64::consts::PI * uv.y);
        let wanted = DVec3::new(theta.sin() * phi.sin(), theta.cos(), theta.sin() * phi.cos());
        assert!(
            (*position - wanted).length() < 3e-4 && (*normal - wanted).length() < 0.02,
            "{position} {wanted}"
        );
    }
    let sparse = mesh(&opened, "sparse");
    assert_eq!(sparse.positions[2], DVec3::new(1.0, 1.5, 1.0));
    assert_eq!(sparse.positions[1], DVec3::new(1.0, 0.0, -1.0));
    let strip = mesh(&opened, "strip");
    assert_eq!((strip.triangles.len(), strip.triangles[1]), (8, [1, 3, 2]));
    let fan = mesh(&opened, "fan");
    assert_eq!((fan.triangles.len(), fan.triangles[0]), (10, [1, 2, 0]));
    assert!(fan.normals.is_empty(), "flat without normals");
}

#[test]
fn skins_and_shapes_stand_as_the_nodes_do() {
    let opened = opened("pose.glb");
    // The upper joint is turned by −1 around z at (−1.2, 1, 0): what was straight above goes to the right.
    let post = mesh(&opened, "post");
    let top: Vec<DVec3> = post.positions[8 * 12..].to_vec();
    let centre = top.iter().sum::<DVec3>() / 12.0;
    let wanted = DVec3::new(-1.2 + 1.0_f64.sin(), 1.0 + 1.0_f64.cos(), 0.0);
    assert!((centre - wanted).length() < 1e-5, "{centre} {wanted}");
    let across = shape(&opened, "post").to_world;
    assert_eq!(across, foton_math::glam::DAffine3::IDENTITY, "the node of a skin does not count");
    // Normals of the top lie across the direction in which it points.
    let along = DVec3::new(1.0_f64.sin(), 1.0_f64.cos(), 0.0);
    assert!(post.normals[8 * 12..].iter().all(|n| n.dot(along).abs() < 1e-6));
    let cube = mesh(&opened, "cube");
    let high = cube.positions.iter().map(|p| p.y).fold(f64::MIN, f64::max);
    assert_near(high, 1.4, 1e-6);
}

#[test]
fn bytes_inside_beside_and_behind_are_the_same() {
    let folder = Folder::new("same");
    let bytes = fs::read(scene_path("textures.bin")).expect("a file");
    let text = fs::read_to_string(scene_path("textures.gltf")).expect("a file");
    let picture = fs::read(scene_path("textures colours.png")).expect("a file");
    let escaped: String = bytes.iter().map(|b| format!("%{b:02x}")).collect();
    let inside = folder.file("inside.gltf", text.replace("textures.bin", &format!("data:,{escaped}")));
    folder.file("textures colours.png", picture);
    let (beside, inside) = (opened("textures.gltf"), open(&inside, &Options::default()).expect("a file"));
    for (a, b) in beside.description.shapes.iter().zip(&inside.description.shapes) {
        let (Geometry::Mesh(a), Geometry::Mesh(b)) = (&a.geometry, &b.geometry) else { panic!() };
        assert_eq!((&a.positions, &a.triangles), (&b.positions, &b.triangles));
    }
    assert_eq!(beside.files.len(), 3, "itself, its bytes and its picture: {:?}", beside.files);
    assert_ne!(beside.source_hash, inside.source_hash);
    assert_eq!(beside.source_hash, opened("textures.gltf").source_hash);
}
