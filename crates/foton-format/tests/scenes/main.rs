//! What a scene file means: every element against values worked out by hand or printed by Mitsuba 3.9.1.

mod cameras;
mod leniency;
mod lights;

use std::io;
use std::path::Path;
use std::sync::Arc;

use foton_format::{Node, Opened, Options, open, read_str};
use foton_math::Rgb;
use foton_math::glam::{DMat3, DVec3};
use foton_scene::description::{
    Bsdf, Colour, Dielectric, Diffuse, EmitterKind, Filter, FovAxis, Geometry, Lens, Mesh, Mirror, Projection,
};

const LAMP: &[u8] = b"IESNA:LM-63-1995\nTILT=NONE\n1 -1 1 2 1 1 1 0 0 0 1 1 0\n0 180\n0\n10 30";

const TRIANGLE: &[u8] = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1\n";

fn files(path: &Path) -> io::Result<Vec<u8>> {
    match path.to_str() {
        Some("t.obj") => Ok(TRIANGLE.to_vec()),
        Some("t.IES") => Ok(LAMP.to_vec()),
        Some("broken.ies") => Ok(LAMP[..50].to_vec()),
        _ => Err(io::ErrorKind::NotFound.into()),
    }
}

fn read_with(snippet: &str, defines: &[(&str, &str)]) -> Opened {
    let xml = format!("<scene version='3.0.0'>{snippet}</scene>");
    let defines = defines.iter().map(|(n, v)| ((*n).to_owned(), (*v).to_owned())).collect();
    read_str("s.xml", &xml, &files, &Options { defines, ..Options::default() })
        .unwrap_or_else(|e| panic!("{snippet}: {e}"))
}

/// Reads a scene without a sensor: that is its only warning.
fn read(snippet: &str) -> Opened {
    let opened = read_with(snippet, &[]);
    let warnings: Vec<_> = opened.warnings.iter().map(|w| w.message.as_str()).collect();
    assert!(warnings.iter().all(|w| *w == "the scene has no sensor"), "{snippet}: {warnings:?}");
    opened
}

fn bsdf(snippet: &str) -> (Bsdf, Option<Bsdf>) {
    let opened = read(&format!("<shape type='cube'>{snippet}</shape>"));
    let material = &opened.description.materials[opened.description.shapes[0].material];
    (material.front, material.back)
}

fn grey(value: f32) -> Bsdf {
    Bsdf::Diffuse(Diffuse { reflectance: Rgb::splat(value).into() })
}

fn mesh(geometry: &Geometry) -> &Arc<Mesh> {
    match geometry {
        Geometry::Mesh(mesh) => mesh,
        other => panic!("not a mesh: {other:?}"),
    }
}

#[test]
fn reflectance_is_read_from_every_tag() {
    assert_eq!(bsdf("<bsdf type='diffuse'/>"), (grey(0.5), None));
    for value in ["<rgb name='reflectance' value='0.3'/>", "<float name='reflectance' value='0.3'/>"] {
        assert_eq!(bsdf(&format!("<bsdf type='diffuse'>{value}</bsdf>")).0, grey(0.3));
    }
    assert_eq!(bsdf("<bsdf type='diffuse'><spectrum name='reflectance' value='0.3'/></bsdf>").0, grey(0.3));
    let colour = bsdf("<bsdf type='diffuse'><rgb name='reflectance' value='.1 .2, .3'/></bsdf>").0;
    assert_eq!(colour, Bsdf::Diffuse(Diffuse { reflectance: Rgb::new(0.1, 0.2, 0.3).into() }));
}

#[test]
fn a_shape_without_a_bsdf_is_grey_and_an_emitter_black() {
    assert_eq!(bsdf(""), (grey(0.5), None));
    assert_eq!(bsdf("<emitter type='area'/>"), (grey(0.0), None));
    assert_eq!(bsdf("<emitter type='area'/><bsdf type='diffuse'/>"), (grey(0.5), None));
}

#[test]
fn two_sides_come_from_one_bsdf_or_two() {
    let mirror = Bsdf::Mirror(Mirror { reflectance: Rgb::splat(0.25).into() });
    let conductor = "<bsdf type='conductor'><string name='material' value='none'/>\
                     <rgb name='specular_reflectance' value='0.25'/></bsdf>";
    assert_eq!(bsdf(conductor), (mirror, None));
    assert_eq!(bsdf(&format!("<bsdf type='twosided'>{conductor}</bsdf>")), (mirror, Some(mirror)));
    let two = format!("<bsdf type='twosided'><bsdf type='diffuse'/>{conductor}</bsdf>");
    assert_eq!(bsdf(&two), (grey(0.5), Some(mirror)));
    assert_eq!(bsdf(&format!("<bsdf type='twosided'>{two}</bsdf>")), (grey(0.5), Some(grey(0.5))));
}

#[test]
fn indices_of_refraction_are_numbers_or_substances() {
    let iors = |inside: &str| match bsdf(&format!("<bsdf type='dielectric'>{inside}</bsdf>")).0 {
        Bsdf::Dielectric(Dielectric { int_ior, ext_ior, .. }) => (int_ior, ext_ior),
        other => panic!("{other:?}"),
    };
    assert_eq!(iors(""), (1.5046, 1.000_277));
    assert_eq!(
        iors("<string name='int_ior' value='Water'/><integer name='ext_ior' value='1'/>"),
        (1.333, 1.0)
    );
    let tinted = bsdf("<bsdf type='dielectric'><rgb name='specular_transmittance' value='0 1 0'/></bsdf>").0;
    let Bsdf::Dielectric(Dielectric { specular_reflectance, specular_transmittance, .. }) = tinted else {
        panic!("{tinted:?}")
    };
    assert_eq!(
        (specular_reflectance, specular_transmittance),
        (Rgb::WHITE.into(), Rgb::new(0.0, 1.0, 0.0).into())
    );
}

#[test]
fn a_material_stands_once_however_often_it_is_referred_to() {
    let opened = read(
        "<shape type='cube'><ref id='a'/></shape><bsdf type='diffuse' id='a'/>\
         <bsdf type='twosided' id='b'><ref name='bsdf' id='a'/></bsdf>\
         <shape type='cube'><ref id='b'/></shape><shape type='cube'><ref id='a'/></shape>\
         <shape type='cube'/><shape type='cube'/>",
    );
    let names: Vec<_> = opened.description.materials.iter().map(|m| m.name.as_str()).collect();
    assert_eq!(names, ["a", "b", "default-grey"]);
    let used: Vec<_> = opened.description.shapes.iter().map(|s| s.material).collect();
    assert_eq!(used, [0, 1, 0, 2, 2]);
}

#[test]
fn shapes_keep_their_names_elements_and_flags() {
    let opened = read(
        "<shape type='sphere' id='ball'><point name='center' x='1' y='2' z='3'/><float name='radius' value='4'/></shape>\
         <shape type='disk'><boolean name='flip_normals' value='True'/></shape><shape type='rectangle'/>",
    );
    let shapes = &opened.description.shapes;
    assert_eq!(shapes.iter().map(|s| s.name.as_str()).collect::<Vec<_>>(), ["ball", "shape-2", "shape-3"]);
    assert_eq!(shapes.iter().map(|s| s.flip_normals).collect::<Vec<_>>(), [false, true, false]);
    let Geometry::Sphere { centre, radius } = shapes[0].geometry else { panic!("{:?}", shapes[0]) };
    assert_eq!((centre, radius), (DVec3::new(1.0, 2.0, 3.0), 4.0));
    assert!(matches!(shapes[1].geometry, Geometry::Disc));
    assert_eq!(mesh(&shapes[2].geometry).triangles.len(), 2);
    let scene = opened.origin.mitsuba().expect("a Mitsuba scene");
    let types = scene.nodes.shapes.iter().filter_map(|&n| scene.document.element(n)?.attribute("type"));
    assert_eq!(types.map(|t| t.value.as_str()).collect::<Vec<_>>(), ["sphere", "disk", "rectangle"]);
}

#[test]
fn mirrored_shapes_have_mitsubas_outside() {
    let flipped = |shape: &str, inside: &str| {
        let scale = "<transform name='to_world'><scale x='-1'/></transform>";
        read(&format!("<shape type='{shape}'>{scale}{inside}</shape>")).description.shapes[0].flip_normals
    };
    let file = "<string name='filename' value='t.obj'/>";
    let flat = format!("{file}<boolean name='face_normals' value='true'/>");
    let inside_out = [
        ("sphere", ""),
        ("disk", ""),
        ("cube", ""),
        ("rectangle", ""),
        ("obj", file),
        ("obj", flat.as_str()),
    ]
    .map(|(shape, inside)| flipped(shape, inside));
    assert_eq!(inside_out, [true, false, false, false, false, true]);
    assert!(!flipped("sphere", "<boolean name='flip_normals' value='true'/>"));
}

#[test]
fn a_mesh_file_is_read_once() {
    let obj = "<shape type='obj'><string name='filename' value='t.obj'/></shape>";
    let opened = read(&format!(
        "{obj}{obj}<shape type='obj'><string name='filename' value='t.obj'/>\
        <boolean name='face_normals' value='true'/><boolean name='flip_tex_coords' value='true'/></shape>"
    ));
    let meshes: Vec<_> = opened.description.shapes.iter().map(|s| mesh(&s.geometry)).collect();
    assert!(Arc::ptr_eq(meshes[0], meshes[1]));
    assert_eq!(meshes[0].normals, [DVec3::Z; 3]);
    assert_eq!((meshes[2].positions.len(), meshes[2].normals.len()), (3, 0));
}

#[test]
fn an_area_emitter_stands_in_its_shape_or_is_referred_to() {
    let opened = read(
        "<emitter type='area' id='e'><rgb name='radiance' value='2'/></emitter>\
         <shape type='cube'><ref id='e'/></shape>\
         <shape type='cube'><emitter type='area'><float name='radiance' value='3'/></emitter></shape><shape type='cube'/>",
    );
    let radiances: Vec<_> = opened.description.shapes.iter().map(|s| s.radiance).collect();
    assert_eq!(radiances, [Some(Rgb::splat(2.0).into()), Some(Rgb::splat(3.0).into()), None]);
    assert!(opened.description.emitters.is_empty());
}

#[test]
fn the_depth_of_any_integrator_bounds_paths() {
    let depth = |value: &str| {
        let depth = format!("<integer name='max_depth' value='{value}'/>");
        read(&format!("<integrator type='sppm'>{depth}<integer name='rr_depth' value='5'/></integrator>"))
            .description
            .max_depth
    };
    assert_eq!((depth("-1"), depth("0"), depth("7")), (None, Some(0), Some(7)));
    let nested = "<integrator type='aov'><integrator type='path'><integer name='max_depth' value='3'/></integrator></integrator>";
    assert_eq!(read(nested).description.max_depth, Some(3));
}

#[test]
fn the_tree_keeps_what_the_scene_does_not_use() {
    let snippet = "<default name='r' value='1'/><!-- kept --><shape type='sphere'><float name='radius' value='$r'/></shape>";
    let opened = read(snippet);
    let scene = opened.origin.mitsuba().expect("a Mitsuba scene");
    let root = scene.document.element(scene.document.root()).unwrap();
    assert_eq!(scene.document.node(root.children[1]), &Node::Comment(" kept ".to_owned()));
    let (_, radius) = scene.document.elements_in(scene.nodes.shapes[0]).next().unwrap();
    assert_eq!(radius.attribute("value").unwrap().value, "$r", "parameters stay");
}

#[test]
fn the_hash_follows_everything_that_was_read() {
    let base =
        "<default name='r' value='1'/><shape type='obj'><string name='filename' value='t.obj'/></shape>";
    let hash = read_with(base, &[]).source_hash;
    assert_eq!(hash, read_with(base, &[]).source_hash);
    assert_ne!(hash, read_with(base, &[("r", "1")]).source_hash);
    assert_ne!(hash, read_with(&format!("{base} "), &[]).source_hash);
    let xml = format!("<scene version='3.0.0'>{base}</scene>");
    let other = |_: &Path| Ok([TRIANGLE, b"\n"].concat());
    assert_ne!(hash, read_str("s.xml", &xml, &other, &Options::default()).unwrap().source_hash);
}

/// The scenes made by others lie beside the checkout, where there are any.
#[test]
fn shared_scenes_open() {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/scenes");
    for (name, shapes, triangles) in [
        ("box-spheres", 9, 10),
        ("cornell-box", 8, 36),
        ("cornell-water", 9, 7088),
        ("ring-glass", 8, 18_893),
        ("veach-bidir", 14, 11_544),
        ("veach-mis", 9, 52),
    ] {
        let path = scenes.join(name).join("scene.xml");
        if !path.exists() {
            continue;
        }
        let opened = open(&path, &Options::default()).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(opened.warnings, [], "{name}");
        assert_eq!(
            (
                opened.description.shapes.len(),
                opened.origin.mitsuba().expect("a Mitsuba scene").nodes.shapes.len()
            ),
            (shapes, shapes),
            "{name}"
        );
        let count = opened.description.shapes.iter().map(|s| match &s.geometry {
            Geometry::Mesh(mesh) => mesh.triangles.len(),
            _ => 0,
        });
        assert_eq!(count.sum::<usize>(), triangles, "{name}");
        assert!(foton_scene::Scene::build(&opened.description).is_ok(), "{name}");
        let resized = Options { defines: vec![("resx".to_owned(), "64".to_owned())], ..Options::default() };
        assert_eq!(open(&path, &resized).unwrap().description.sensors[0].width, 64);
    }
}

#[test]
fn a_missing_file_is_an_error_with_its_name() {
    let error = open(Path::new("no-such-scene.xml"), &Options::default()).unwrap_err();
    assert!(error.to_string().starts_with("no-such-scene.xml: cannot be read: "), "{error}");
}

#[test]
fn instances_show_the_shapes_of_their_group_at_their_place() {
    let opened = read(
        "<shape type='shapegroup' id='pair'><shape type='cube' id='box'>\
         <transform name='to_world'><translate x='1'/></transform></shape>\
         <shape type='sphere' id='ball'/></shape>\
         <shape type='instance' id='one'><ref id='pair'/>\
         <transform name='to_world'><scale value='2'/></transform></shape>\
         <shape type='instance' id='two'><ref id='pair'/>\
         <transform name='to_world'><scale x='-1'/></transform></shape>",
    );
    let shapes = &opened.description.shapes;
    let found: Vec<_> = shapes
        .iter()
        .map(|s| (s.name.as_str(), s.to_world.transform_point3(DVec3::X).x, s.flip_normals))
        .collect();
    assert_eq!(
        found,
        [
            ("one/box", 4.0, false),
            ("one/ball", 2.0, false),
            ("two/box", -2.0, false),
            ("two/ball", -1.0, false)
        ]
    );
    assert_eq!(shapes[0].material, shapes[2].material);
}
