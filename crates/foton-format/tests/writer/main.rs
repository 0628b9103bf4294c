//! What is written reads back as an equal description.

mod materials;
mod same;

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use foton_format::{Options, open, write_scene};
use foton_math::Rgb;
use foton_math::glam::{DAffine2, DAffine3, DVec2, DVec3};
use foton_scene::description::{
    Attribute, Bitmap, Colour, Crop, EmitterDescription, EmitterKind, Filter, FovAxis, Geometry, Hidden,
    Keyframes, Lens, Mesh, Motion, SceneDescription, SensorDescription, ShapeDescription, Texture,
    TextureKind, Wrap,
};

use materials::{COMPONENTS, materials};
use same::assert_same;

/// A folder of a test's own, removed when the test is over.
struct Folder(PathBuf);

impl Folder {
    fn new(test: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("foton-writer-{}-{test}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        Self(folder)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn read(path: &Path) -> SceneDescription {
    let opened = open(path, &Options::default()).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(opened.warnings, [], "{}", path.display());
    opened.description
}

fn written_and_read(scene: &SceneDescription, folder: &Folder, name: &str) -> SceneDescription {
    let path = folder.0.join(name);
    write_scene(scene, &path, &[]).unwrap();
    read(&path)
}

/// Numbers that no few decimals express.
fn odd(i: u32) -> f64 {
    (f64::from(i) + 0.1).sin()
}

fn odd_transform() -> DAffine3 {
    let turn = DAffine3::from_axis_angle(DVec3::new(odd(1), odd(2), odd(3)).normalize(), odd(4));
    DAffine3::from_translation(DVec3::new(odd(5), 1e-9 * odd(6), 1e17 * odd(7))) * turn
}

fn odd_attributes() -> Vec<Attribute> {
    let of = |name: &str, channels, numbers: usize| Attribute {
        name: name.to_owned(),
        channels,
        values: (0..numbers).map(|i| odd(i as _) as f32).collect(),
    };
    vec![of("vertex_color", 3, 12), of("vertex_w", 1, 4), of("face_color", 3, 6)]
}

fn odd_mesh(narrow: bool, normals: bool) -> Geometry {
    let value = |i| if narrow { f64::from(odd(i) as f32) } else { odd(i) };
    let positions = (0..4).map(|i| DVec3::new(value(i), value(i + 4), value(i + 8))).collect();
    let normals = if normals { vec![DVec3::new(odd(1), odd(2), odd(3)); 4] } else { Vec::new() };
    let texture_coordinates = vec![DVec2::new(odd(1), 0.5); if narrow { 0 } else { 4 }];
    Geometry::Mesh(Arc::new(Mesh {
        positions,
        normals,
        texture_coordinates,
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        attributes: if narrow { odd_attributes() } else { Vec::new() },
    }))
}

fn shapes(materials: usize) -> Vec<ShapeDescription> {
    let shared = odd_mesh(false, true);
    let geometries = [
        Geometry::Sphere { centre: DVec3::new(odd(1), odd(2), odd(3)), radius: 1.0 / 3.0 },
        Geometry::Disc,
        Geometry::Cylinder { from: DVec3::ZERO, to: DVec3::new(0.0, odd(2), 0.1), radius: 0.1 },
        Geometry::Mesh(Arc::new(Mesh::rectangle())),
        Geometry::Mesh(Arc::new(Mesh::cube())),
        odd_mesh(true, false),
        odd_mesh(false, false),
        shared.clone(),
        shared,
    ];
    let mirror = DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0));
    let shape = |i: usize| ShapeDescription {
        name: if i.is_multiple_of(2) { String::new() } else { "ä/b".to_owned() },
        geometry: geometries[i % geometries.len()].clone(),
        to_world: if i % 4 < 2 { odd_transform() } else { odd_transform() * mirror },
        flip_normals: i.is_multiple_of(3),
        material: i % materials,
        radiance: i
            .is_multiple_of(5)
            .then(|| if i == 5 { Colour::Texture(1) } else { Rgb::new(0.1, 1e-12, 1e12).into() }),
    };
    (0..24).map(shape).collect()
}

fn sensors() -> Vec<SensorDescription> {
    let sensor = |fov_axis, filter, near_clip: Option<f64>| SensorDescription {
        name: "sensor".to_owned(),
        to_world: DAffine3::from_axis_angle(DVec3::Y, odd(1)),
        fov_degrees: 40.0 + odd(2),
        fov_axis,
        width: 320,
        height: 200,
        crop: None,
        filter,
        near_clip,
        far_clip: near_clip.map(|near| near + 100.0),
        lens: None,
    };
    vec![
        sensor(FovAxis::Larger, Filter::Box { radius: 0.5 }, Some(odd(1))),
        SensorDescription {
            crop: Some(Crop { x: 10, y: 20, width: 100, height: 80 }),
            lens: Some(Lens { aperture_radius: odd(3), focus_distance: odd(4).abs() }),
            ..sensor(FovAxis::X, Filter::Box { radius: 0.5 }, None)
        },
        sensor(FovAxis::Diagonal, Filter::Tent { radius: 1.1 }, None),
        sensor(FovAxis::Y, Filter::Gaussian { stddev: 0.3 }, None),
    ]
}

fn everything() -> SceneDescription {
    let pixels = (0..6).map(|i| Rgb::new(i as f32 / 7.0, 0.1, 1.0 / 3.0)).collect();
    let bitmap = Arc::new(Bitmap::new(3, 2, pixels));
    let to_uv = DAffine2::from_scale_angle_translation(DVec2::new(2.0, -4.0), 0.0, DVec2::new(0.5, 0.25));
    let textures = [
        TextureKind::Bitmap { bitmap: Arc::clone(&bitmap), wrap: Wrap::Mirror, bilinear: false },
        TextureKind::Checkerboard { colours: [Rgb::new(0.1, 0.2, 0.3).into(), Colour::Texture(0)] },
        TextureKind::Bitmap { bitmap: Arc::clone(&bitmap), wrap: Wrap::Clamp, bilinear: true },
    ];
    let shown = TextureKind::Attribute { name: "vertex_color".to_owned(), scale: 0.3, most: 1.0 };
    let attribute = Texture { name: "t".to_owned(), to_uv: DAffine2::IDENTITY, kind: shown };
    let kinds = [
        EmitterKind::Point { position: DVec3::new(odd(1), 2.0, 3.0), intensity: Rgb::new(0.1, 0.2, 0.3) },
        EmitterKind::Spot {
            to_world: odd_transform(),
            intensity: Rgb::splat(10.0),
            cutoff_degrees: 30.0 + odd(1),
            beam_degrees: 20.0,
        },
        EmitterKind::Directional {
            direction: DVec3::new(odd(1), odd(2), odd(3)),
            irradiance: Rgb::splat(0.3),
        },
        EmitterKind::Environment { to_world: DAffine3::from_rotation_y(odd(1)), bitmap, scale: 0.7 },
    ];
    let materials = materials();
    let mut shapes = shapes(materials.len() - COMPONENTS);
    shapes[2].to_world = flight().all()[0].1;
    SceneDescription {
        sensors: sensors(),
        shapes,
        materials,
        textures: textures
            .map(|kind| Texture { name: "t".to_owned(), to_uv, kind })
            .into_iter()
            .chain([attribute])
            .collect(),
        emitters: kinds.map(|kind| EmitterDescription { name: "light".to_owned(), kind }).to_vec(),
        max_depth: Some(7),
        hidden: Hidden { shapes: [1, 3].into(), emitters: [2].into() },
        motion: Motion {
            shapes: [(2, flight())].into(),
            sensors: [].into(),
            shutters: [(0, [0.25, odd(3).abs() + 1.0])].into(),
        },
    }
}

/// From one odd place to another.
fn flight() -> Keyframes {
    let at =
        |i| DAffine3::from_rotation_y(odd(i)) * DAffine3::from_translation(DVec3::new(odd(i), 0.5, odd(1)));
    Keyframes::new(vec![(-0.5, at(1)), (0.25, at(2)), (2.0, at(3))]).expect("sound")
}

#[test]
fn everything_that_a_description_can_hold_is_written() {
    let (folder, scene) = (Folder::new("everything"), everything());
    let once = written_and_read(&scene, &folder, "all of it.xml");
    assert_same(&scene, &once);
    // Names have become ids, so that nothing changes any more.
    let twice = written_and_read(&once, &folder, "all of it.xml");
    assert_same(&once, &twice);
    let names = |scene: &SceneDescription| scene.shapes.iter().map(|s| s.name.clone()).collect::<Vec<_>>();
    assert_eq!(names(&once), names(&twice));
    assert_eq!(names(&once)[..4], ["unnamed", "ä/b", "unnamed-2", "ä/b-2"]);
    let empty = SceneDescription { sensors: scene.sensors, ..SceneDescription::default() };
    assert_same(&empty, &written_and_read(&empty, &folder, "empty.xml"));
}

#[test]
fn files_that_several_things_share_are_written_once() {
    let folder = Folder::new("shared");
    write_scene(&everything(), &folder.0.join("s.xml"), &[]).unwrap();
    let names = |inside: &str| {
        let mut names: Vec<_> = fs::read_dir(folder.0.join(inside))
            .unwrap()
            .map(|f| f.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    };
    assert_eq!(names("textures"), ["s-t.exr"]);
    assert_eq!(names("meshes"), ["s-__b-3.ply", "s-__b-4.ply", "s-unnamed-4.ply"]);
    assert_eq!(names(""), ["meshes", "s.xml", "textures"]);
}

/// A scene's own meshes and images stay when it is written beside them under its own name.
#[test]
fn files_that_a_scene_is_made_of_are_known_and_not_written_to() {
    let folder = Folder::new("kept");
    let path = folder.0.join("s.xml");
    write_scene(&everything(), &path, &[]).unwrap();
    let opened = open(&path, &Options::default()).unwrap_or_else(|e| panic!("{e}"));
    let mut files: Vec<String> = opened
        .files
        .iter()
        .map(|f| f.strip_prefix(&folder.0).unwrap().display().to_string().replace('\\', "/"))
        .collect();
    files.sort();
    files.dedup();
    let meshes = ["meshes/s-__b-3.ply", "meshes/s-__b-4.ply", "meshes/s-unnamed-4.ply"];
    assert_eq!(files, [&meshes[..], &["s.xml", "textures/s-t.exr"]].concat());
    // Whatever was overwritten would not be this any more.
    let marked: Vec<PathBuf> = meshes.iter().chain(&["textures/s-t.exr"]).map(|f| folder.0.join(f)).collect();
    for file in &marked {
        fs::write(file, "kept").unwrap();
    }
    write_scene(&opened.description, &path, &opened.files).unwrap();
    for file in &marked {
        assert_eq!(fs::read_to_string(file).unwrap(), "kept", "{}", file.display());
    }
    assert_same(&opened.description, &read(&path));
    // Without a word they are replaced, as those of an earlier conversion are.
    write_scene(&opened.description, &path, &[]).unwrap();
    assert!(marked.iter().all(|file| fs::read(file).unwrap() != b"kept"));
}

#[test]
fn a_scene_that_cannot_be_written_leaves_no_scene_file() {
    let folder = Folder::new("no-folder");
    fs::write(folder.0.join("meshes"), "in the way").unwrap();
    let error = write_scene(&everything(), &folder.0.join("s.xml"), &[]).unwrap_err().to_string();
    assert!(error.starts_with("cannot write ") && error.contains("meshes"), "{error}");
    assert!(!folder.0.join("s.xml").exists());
}

/// All scene files in a folder and the folders in it.
fn scene_files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() {
            scene_files(&path, found);
        } else if path.extension().is_some_and(|e| e == "xml" || e == "obj") {
            found.push(path);
        }
    }
}

/// Our own scenes, and those made by others beside the checkout, where there are any.
#[test]
fn scenes_that_are_written_read_back_equal() {
    let crate_folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folder = Folder::new("scenes");
    let mut paths = Vec::new();
    scene_files(&crate_folder.join("../../assets"), &mut paths);
    scene_files(&crate_folder.join("../../tests/scenes"), &mut paths);
    scene_files(&crate_folder.join("../../../shared/scenes"), &mut paths);
    // Meshes of other scenes are no scenes of their own, nor are the parts that they include.
    paths.retain(|p| {
        !["meshes", "models", "parts"].iter().any(|f| p.components().any(|c| c.as_os_str() == *f))
    });
    for (i, path) in paths.iter().enumerate() {
        let scene = open(path, &Options::default()).unwrap_or_else(|e| panic!("{e}")).description;
        let again = written_and_read(&scene, &folder, &format!("{i}.xml"));
        assert_same(&scene, &again);
    }
}
