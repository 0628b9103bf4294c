//! What is written reads back as an equal description.

mod instances;
mod parts;
mod same;

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use foton_format::{Options, open, write_scene};
use foton_math::Rgb;
use foton_math::glam::{DAffine2, DAffine3, DVec2, DVec3};
use foton_scene::description::{
    Attribute, Bitmap, Blend, Bsdf, Coating, Colour, Conductor, Crop, Dielectric, Diffuse,
    DiffuseTransmitter, EmitterDescription, EmitterKind, Filter, FovAxis, Geometry, Hidden, Keyframes, Lens,
    Material, Mesh, MicrofacetDistribution, Microfacets, Mirror, Motion, Null, Number, Phong, Plastic,
    Principled, PrincipledThin, Projection, Relief, ReliefKind, RoughDiffuse, SceneDescription,
    SensorDescription, ShapeDescription, Texture, TextureKind, ThinDielectric, Ward, Wrap,
};

use parts::{emitters, sensors, shapes};
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
        principled(),
        sheet(),
    ]
}

fn sheet() -> Bsdf {
    Bsdf::PrincipledThin(PrincipledThin {
        base_color: colour(0.1, 0.2, 0.3),
        roughness: 0.11.into(),
        anisotropic: 0.12.into(),
        spec_trans: 0.13.into(),
        diff_trans: 1.14.into(),
        eta: Number::Texture(1),
        spec_tint: 0.15.into(),
        sheen: 0.16.into(),
        sheen_tint: 0.17.into(),
        flatness: 0.18.into(),
    })
}

fn principled() -> Bsdf {
    Bsdf::Principled(Principled {
        base_color: Colour::Texture(0),
        roughness: Number::Texture(1),
        anisotropic: 0.21.into(),
        metallic: 0.22.into(),
        spec_trans: Number::Texture(0),
        eta: 1.23,
        spec_tint: 0.24.into(),
        sheen: 2.5.into(),
        sheen_tint: 0.26.into(),
        flatness: 0.27.into(),
        clearcoat: 0.28.into(),
        clearcoat_gloss: Number::Texture(1),
    })
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

fn materials() -> Vec<Material> {
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
const COMPONENTS: usize = 2;

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
        emitters: emitters(&bitmap),
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
    const OURS: &str = "written by foton for s.xml";
    let marked: Vec<PathBuf> = meshes.iter().chain(&["textures/s-t.exr"]).map(|f| folder.0.join(f)).collect();
    let are_marked = || marked.iter().all(|file| fs::read(file).unwrap() == OURS.as_bytes());
    for file in &marked {
        fs::write(file, OURS).unwrap();
    }
    write_scene(&opened.description, &path, &opened.files).unwrap();
    assert!(are_marked());
    assert_same(&opened.description, &read(&path));
    // Without a word they are replaced, as those of an earlier conversion are.
    write_scene(&opened.description, &path, &[]).unwrap();
    assert!(!are_marked());
}

/// How many files there are in the folders beside a scene.
fn files_beside(folder: &Folder) -> usize {
    let inside = ["meshes", "textures"].map(|inside| fs::read_dir(folder.0.join(inside)).unwrap().count());
    inside.iter().sum()
}

#[test]
fn files_of_an_earlier_conversion_to_the_same_file_are_replaced_and_no_others() {
    let folder = Folder::new("twice");
    write_scene(&everything(), &folder.0.join("s.xml"), &[]).unwrap();
    let before = files_beside(&folder);
    write_scene(&everything(), &folder.0.join("s.xml"), &[]).unwrap();
    assert_eq!(files_beside(&folder), before);
    // Another scene file whose parts would have the same names.
    write_scene(&everything(), &folder.0.join("s.XML"), &[]).unwrap();
    assert_eq!(files_beside(&folder), 2 * before);
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
