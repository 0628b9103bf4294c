//! Files with something wrong: errors by the path of each value, and neither a panic, a hang nor much memory.

use std::fmt::Write;

use foton_math::Cancel;

use super::*;

/// A triangle of 36 bytes, and what stands around it.
const TRIANGLE: &str = r#"{"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
    "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
    "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],
    "bufferViews":[{"buffer":0,"byteLength":36}],
    "buffers":[{"byteLength":36,"uri":"data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]}"#;

fn read(name: &str, text: impl AsRef<[u8]>) -> Result<Opened, OpenError> {
    let folder = Folder::new(name);
    open(&folder.file("f.gltf", text), &Options::default())
}

/// The errors of a file, without its name.
fn errors(name: &str, text: impl AsRef<[u8]>) -> Vec<String> {
    let error = read(name, text).err().unwrap_or_else(|| panic!("{name}: it is read"));
    let lines = error.to_string();
    lines
        .lines()
        .map(|line| line.split_once("f.gltf:").map_or(line, |(_, rest)| rest).trim().to_owned())
        .collect()
}

#[test]
fn a_triangle_is_read() {
    let opened = read("triangle", TRIANGLE).unwrap_or_else(|e| panic!("{e}"));
    let Geometry::Mesh(mesh) = &opened.description.shapes[0].geometry else { panic!() };
    assert_eq!(mesh.positions, [DVec3::ZERO, DVec3::X, DVec3::Y]);
    assert_eq!(opened.description.shapes[0].name, "mesh-0");
}

/// What the accessor states of its numbers.
const STATED: &str = r#""componentType":5126,"count":3,"type":"VEC3""#;

/// What is replaced in the triangle, by what, and what is said then.
const FAULTS: &[(&str, &str, &str)] = &[
    ("\"2.0\"", "\"1.0\"", "asset: version \"1.0\" of glTF is not read, only 2.0"),
    ("\"asset\"", "\"a\"", "the file is no glTF 2.0 file: it has no \"asset\" with a \"version\""),
    ("\"nodes\":[0]", "\"nodes\":[7]", "scenes[0].nodes: there is no nodes[7]: the file has 1 of them"),
    ("\"mesh\":0", "\"mesh\":2", "nodes[0].mesh: there is no meshes[2]: the file has 1 of them"),
    ("\"mesh\":0", "\"mesh\":\"a\"", "nodes[0].mesh: must be a whole number from 0"),
    (
        "\"POSITION\":0",
        "\"POSITION\":1",
        "meshes[0].primitives[0].attributes.POSITION: there is no accessors[1]: the file has 1 of them",
    ),
    ("\"POSITION\":0", "\"A\":0", "meshes[0].primitives[0].attributes: needs a \"POSITION\""),
    ("}}]}]", "},\"mode\":9}]}]", "meshes[0].primitives[0]: there is no mode 9"),
    (
        "}}]}]",
        "},\"material\":0}]}]",
        "meshes[0].primitives[0].material: there is no materials[0]: the file has 0 of them",
    ),
    (
        "}}]}]",
        "},\"indices\":0}]}]",
        "meshes[0].primitives[0].indices: must be unsigned whole numbers, one each",
    ),
    (
        STATED,
        r#""componentType":5130,"count":3,"type":"VEC3""#,
        "accessors[0]: needs a \"componentType\" and a \"type\" of glTF 2.0",
    ),
    (
        STATED,
        r#""componentType":5126,"count":3,"type":"VEC2""#,
        "meshes[0].primitives[0].attributes.POSITION: needs 3 numbers for each vertex, not 2",
    ),
    (
        STATED,
        r#""componentType":5126,"count":0,"type":"VEC3""#,
        "accessors[0]: needs a \"count\" from 1 to 4,294,967,295",
    ),
    (
        STATED,
        r#""componentType":5126,"count":4,"type":"VEC3""#,
        "accessors[0]: 4 elements of 12 bytes, 12 apart, are not in bufferViews[0] of 36 bytes from byte 0",
    ),
    (
        STATED,
        r#""componentType":5126,"count":4000000000,"type":"VEC3""#,
        "accessors[0]: 4000000000 elements of 12 bytes, 12 apart, are not in bufferViews[0] of 36 bytes from byte 0",
    ),
    ("\"bufferView\":0,", "", "the model has no extent"),
    (
        "\"bufferView\":0,",
        "\"byteOffset\":18446744073709551615,\"bufferView\":0,",
        "accessors[0]: 3 elements of 12 bytes, 12 apart, are not in bufferViews[0] of 36 bytes from byte 18446744073709551615",
    ),
    (
        "\"byteLength\":36}]",
        "\"byteLength\":37}]",
        "bufferViews[0]: 37 bytes from byte 0 are not in a buffer of 36 bytes",
    ),
    ("\"byteLength\":36,", "\"byteLength\":40,", "buffers[0]: has 36 bytes and says that it has 40"),
    ("AAAA\"", "*AAA\"", "buffers[0]: character 45 of its data is not of base64"),
    (
        "data:;",
        "http://a/;",
        "buffers[0]: \"http://a/;base64,AAAAAAAAAAAAAAAAAACAPw…\" is on the web: foton downloads nothing",
    ),
    ("AACAPwAA", "AADAfwAA", "meshes[0].primitives[0]: the position of vertex 1 is no number"),
    (
        "\"mesh\":0",
        "\"mesh\":0,\"children\":[0]",
        "nodes[0]: stands in two places of the tree, or within itself",
    ),
    ("\"mesh\":0", "\"mesh\":0,\"matrix\":[1]", "nodes[0].matrix: must be a list of 16 numbers"),
    (
        "\"mesh\":0",
        "\"mesh\":0,\"matrix\":[1,0,0,1,0,1,0,0,0,0,1,0,0,0,0,1]",
        "nodes[0].matrix: must be affine: 0 0 0 1 in the last row",
    ),
];

#[test]
fn each_fault_is_named_by_its_path() {
    for (from, to, said) in FAULTS {
        let text = TRIANGLE.replacen(from, to, 1);
        assert_ne!(text, TRIANGLE, "{from}");
        assert_eq!(errors("fault", &text)[0], *said, "{from} → {to}");
    }
}

#[test]
fn all_faults_are_found_in_one_go() {
    let text = r#"{"asset":{"version":"2.0"},"nodes":[{"mesh":0},{"mesh":9},{"camera":0},{"scale":[1,2]},
        {"extensions":{"KHR_lights_punctual":{"light":0}}}],
        "cameras":[{"type":"perspective","perspective":{"yfov":4}}],
        "extensionsRequired":["KHR_materials_irridescence","KHR_texture_basisu"],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0}},{"attributes":{"POSITION":"x"}}]}],
        "accessors":[{"count":3}]}"#;
    assert_eq!(
        errors("all", text),
        [
            "extensionsRequired[0]: the file cannot be shown without \"KHR_materials_irridescence\", which is not read, did you mean \"KHR_materials_iridescence\"?",
            "extensionsRequired[1]: images of the format KTX2 (KHR_texture_basisu) are not read",
            "nodes[3].scale: must be a list of 3 numbers",
            "accessors[0]: needs a \"componentType\" and a \"type\" of glTF 2.0",
            "meshes[0].primitives[1].attributes.POSITION: must be a whole number from 0",
            "nodes[1].mesh: there is no meshes[9]: the file has 1 of them",
            "cameras[0].perspective: needs a \"yfov\" above 0 and below π",
            "nodes[4].extensions.KHR_lights_punctual: the file has no lights",
            "the model has no extent",
        ]
    );
}

#[test]
fn packed_meshes_are_refused_by_name_with_the_way_out() {
    for (extension, name) in [("KHR_draco_mesh_compression", "Draco"), ("EXT_meshopt_compression", "meshopt")]
    {
        let required = format!("\"asset\":{{\"version\":\"2.0\"}},\"extensionsRequired\":[\"{extension}\"]");
        let text = TRIANGLE.replacen("\"asset\":{\"version\":\"2.0\"}", &required, 1);
        let Err(OpenError::Faults(found)) = read("packed", text) else { panic!() };
        assert_eq!(found.len(), 1);
        assert_eq!(
            found[0].message,
            format!("extensionsRequired[0]: meshes packed by {name} ({extension}) are not read")
        );
        assert!(found[0].help.as_ref().is_some_and(|help| help.contains("Blender")));
    }
    let view = "\"bufferViews\":[{\"extensions\":{\"EXT_meshopt_compression\":{}},\"buffer\":1,";
    let text = TRIANGLE.replacen("\"bufferViews\":[{\"buffer\":0,", view, 1);
    assert_eq!(
        errors("packed-view", text)[0],
        "bufferViews[0].extensions.EXT_meshopt_compression: meshes packed by meshopt are not read"
    );
}

#[test]
fn text_that_is_no_json_is_shown_with_its_line() {
    let Err(OpenError::Faults(found)) = read("json", "{\n  \"asset\": {]\n}") else { panic!() };
    assert_eq!((found[0].line, found[0].column), (2, 13));
    assert!(found[0].excerpt.as_ref().is_some_and(|e| e.line.contains("asset")));
    assert!(errors("empty", "")[0].contains("not well-formed"));
    let deep = format!("{{\"asset\":{}", "[".repeat(1_000_000));
    assert!(errors("deep", deep)[0].contains("recursion limit"));
    let folder = Folder::new("binary");
    let path = folder.file("f.glb", b"glTF\x02\0\0\0\x20\0\0\0");
    assert!(open(&path, &Options::default()).unwrap_err().to_string().contains("says that it has 32"));
}

#[test]
fn a_tree_of_any_depth_is_walked() {
    let count = 100_000;
    let mut nodes = String::new();
    for i in 0..count {
        write!(nodes, "{{\"children\":[{}],\"translation\":[0,0,1]}},", i + 1).expect("a string");
    }
    let text =
        TRIANGLE.replacen("\"nodes\":[{\"mesh\":0}]", &format!("\"nodes\":[{nodes}{{\"mesh\":0}}]"), 1);
    let opened = read("tree", &text).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(opened.description.shapes[0].to_world.translation, DVec3::new(0.0, 0.0, f64::from(count)));
    // A ring is no tree.
    let ring = text.replacen(&format!("[{count}]"), "[5]", 1);
    assert_eq!(errors("ring", ring)[0], "nodes[5]: stands in two places of the tree, or within itself");
}

#[test]
fn memory_is_counted_before_it_is_taken() {
    let folder = Folder::new("memory");
    let path = folder.file(
        "f.gltf",
        "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[".to_owned() + &"{},".repeat(100_000) + "{}]}",
    );
    let error = open(&path, &Options { memory: Some(8 << 20), ..Options::default() }).unwrap_err();
    assert!(error.to_string().contains("8 MiB may be used"), "{error}");
    // Many meshes of the same few bytes, each with indices of its own.
    let meshes = "{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]},".repeat(2000);
    let nodes: String = (0..2000).map(|i| format!("{{\"mesh\":{i}}},")).collect();
    let text = TRIANGLE
        .replacen("\"scenes\":[{\"nodes\":[0]}],", "", 1)
        .replacen("\"nodes\":[{\"mesh\":0}]", &format!("\"nodes\":[{nodes}{{}}]"), 1)
        .replacen("\"meshes\":[", &format!("\"meshes\":[{meshes}"), 1)
        .replacen("\"byteLength\":36", "\"byteLength\":48000", 1)
        .replacen("\"byteLength\":36", "\"byteLength\":48000", 1)
        .replacen("\"count\":3", "\"count\":4000", 1);
    let data = "A".repeat(48_000 / 3 * 4);
    let start = text.find("base64,").expect("there") + 7;
    let end = start + text[start..].find('"').expect("there");
    let text = format!("{}{data}{}", &text[..start], &text[end..]);
    let path = folder.file("many.gltf", text);
    let error = open(&path, &Options { memory: Some(64 << 20), ..Options::default() }).unwrap_err();
    assert!(error.to_string().contains("64 MiB may be used"), "{error}");
}

#[test]
fn reading_ends_where_it_is_cancelled() {
    for name in ["pose.glb", "textures.gltf", "instances.glb"] {
        let mut questions = 0;
        while questions < 10_000 {
            let options = Options { cancel: Cancel::after(questions), ..Options::default() };
            match open(&scene_path(name), &options) {
                Ok(_) => break,
                Err(OpenError::Cancelled(_)) => questions += 1,
                Err(other) => panic!("{name}, after {questions} questions: {other}"),
            }
        }
        assert!((10..10_000).contains(&questions), "{name}: {questions}");
    }
}

#[test]
fn files_that_are_not_there_are_named_or_done_without() {
    let folder = Folder::new("missing");
    let text = fs::read_to_string(scene_path("textures.gltf")).expect("a file");
    let path = folder.file("f.gltf", text);
    let error = open(&path, &Options::default()).unwrap_err().to_string();
    assert!(error.contains("textures.bin") && error.lines().count() >= 1, "{error}");
    folder.file("textures.bin", fs::read(scene_path("textures.bin")).expect("a file"));
    let error = open(&path, &Options::default()).unwrap_err().to_string();
    assert!(error.contains("textures colours.png"), "{error}");
    let opened = open(&path, &Options { allow_missing: true, ..Options::default() }).expect("allowed");
    let Bsdf::Principled(model) = material(&opened, "plain").front else { panic!() };
    assert_eq!(model.base_color, Rgb::new(1.0, 0.0, 1.0).into());
}

#[test]
fn files_of_other_programs_are_refused_by_name() {
    for (name, what, way_out) in [
        ("a.3mf", "3MF files (.3mf) are not read", "STL"),
        ("a.STEP", "curved surfaces", "FreeCAD"),
        ("a.fbx", "(.fbx) are not read", "Blender"),
        ("a.blend", "Blender's own files", "glTF"),
        ("a.usdz", "(.usdz) are not read", "glTF"),
        ("a.zip", "archives", "unpack"),
    ] {
        let Err(OpenError::Faults(found)) = open(Path::new(name), &Options::default()) else { panic!() };
        assert!(found[0].message.contains(what), "{}", found[0].message);
        assert!(found[0].help.as_ref().is_some_and(|help| help.contains(way_out)), "{:?}", found[0].help);
    }
}
