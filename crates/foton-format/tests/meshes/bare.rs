//! A mesh file as the whole scene.

use super::*;
use foton_scene::description::Colour;

const MTL: &str = "newmtl wall\nKd 0.5 0.25 0.125 # comment\nKs 0 0 0\nillum 2\nmap_Kd bricks.png\n\
    newmtl mirror\nKd 0 0 0\nKs 0.9 0.9 0.9\nillum 5\nnewmtl glass\nillum 7\nNi 1.33\nTf 0 0 0\n\
    newmtl pane\nd 0.25\nNi 1.5\nnewmtl veil\nKd 1 1 1\nTr 0.75\nnewmtl varnish\nKd 0.5\nKs 0.5 0.5 0.5\nNs 198\n\
    newmtl lamp\nKd 0 0 0\nKe 17 12 4\nNs x\n";

/// A light's radiance, the same everywhere.
fn light(radiance: Colour) -> Rgb {
    let Colour::Constant(radiance) = radiance else { panic!("{radiance:?}") };
    radiance
}

#[test]
fn materials_of_an_obj_file_become_ours() {
    let folder = Folder::new("mtl");
    let names = ["wall", "mirror", "glass", "pane", "veil", "varnish", "lamp", "lost", "wall"];
    let mut obj = "mtllib a file.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n".to_owned();
    for name in names {
        obj += &format!("usemtl {name}\nf -4 -3 -2\nf -4 -2 -1\n");
    }
    let path = folder.file("m.obj", obj.as_bytes());
    folder.file("a file.mtl", MTL.as_bytes());
    let opened = open(&path, &Options::default()).unwrap_or_else(|e| panic!("{e}"));
    let scene = &opened.description;
    let found: Vec<_> = scene.shapes.iter().map(|s| s.name.as_str()).collect();
    assert_eq!(found, &names[..8], "a shape for each material");
    assert_eq!((mesh(&opened, 0).triangles.len(), mesh(&opened, 1).triangles.len()), (4, 2));
    let material = |i: usize| &scene.materials[scene.shapes[i].material];
    let diffuse = |r, g, b| Bsdf::Diffuse(Diffuse { reflectance: Rgb::new(r, g, b).into() });
    assert_eq!(material(0).front, diffuse(0.5, 0.25, 0.125));
    assert_eq!(material(0).back, Some(material(0).front));
    assert_eq!(material(1).front, Bsdf::Mirror(Mirror { reflectance: Rgb::splat(0.9).into() }));
    for (i, ior) in [(2, 1.33), (3, 1.5)] {
        let glass = material(i);
        assert!(
            matches!(glass.front, Bsdf::Dielectric(Dielectric { int_ior, ext_ior: 1.0, .. }) if int_ior == ior)
        );
        assert_eq!((glass.back, glass.opacity), (None, None));
    }
    assert_eq!(material(4).opacity, Some(Rgb::splat(0.25).into()));
    let Bsdf::Plastic(Plastic { roughness: Some(facets), .. }) = material(5).front else {
        panic!("{:?}", material(5))
    };
    let alpha = facets.alpha_u.constant().expect("a number");
    assert!((alpha - 0.1).abs() < 1e-6, "√(2 / 200)");
    assert_eq!(material(7).front, diffuse(0.5, 0.5, 0.5));
    let emitting: Vec<_> = scene.shapes.iter().filter_map(|s| s.radiance).map(light).collect();
    assert_eq!(emitting, [Rgb::new(17.0, 12.0, 4.0)]);
    assert_eq!(
        warnings(&opened),
        [
            "m.obj: there is no material \"lost\": it is grey",
            "m.obj: a mesh file has no camera: one is placed straight in front",
            "a file.mtl:5: \"map_Kd\" of \"wall\" is not read",
            "a file.mtl:27: \"x\" is not a number, its line is ignored",
        ]
    );
    assert!(opened.warnings.iter().all(|w| w.severity == Severity::Warning));
}

/// The largest share of half the image, along either side, that a point in view reaches.
fn extent(opened: &Opened, points: &[DVec3]) -> f64 {
    let camera = &opened.description.sensors[0];
    let tangent = (0.5 * camera.fov_degrees).to_radians().tan();
    let aspect = f64::from(camera.width) / f64::from(camera.height);
    let to_camera = camera.to_world.inverse();
    let seen = points.iter().map(|p| {
        let p = to_camera.transform_point3(*p);
        assert!(p.z > 0.0, "behind the camera");
        (p.x.abs() / (p.z * tangent * aspect)).max(p.y.abs() / (p.z * tangent))
    });
    seen.fold(0.0, f64::max)
}

#[test]
fn a_bare_mesh_is_in_view_lit_and_on_a_floor() {
    let folder = Folder::new("bare");
    let (_, bytes) = all_ply().into_iter().next().unwrap();
    let path = folder.file("m.ply", &bytes);
    let opened = open(&path, &Options::default()).unwrap_or_else(|e| panic!("{e}"));
    let scene = &opened.description;
    let names: Vec<_> = scene.shapes.iter().map(|s| s.name.as_str()).collect();
    assert_eq!(names, ["mesh", "default-light", "default-floor"]);
    assert!(scene.shapes[1].radiance.map(light).is_some_and(|r| r.is_finite() && r.r > 0.0));
    assert!(matches!(scene.emitters[0].kind, EmitterKind::Constant { .. }));
    let reach = extent(&opened, &points());
    assert!(reach > 0.6 && reach < 1.0, "{reach}");
    let normal = |i: usize| scene.shapes[i].to_world.transform_vector3(DVec3::Z).normalize();
    assert!((normal(1) + DVec3::Y).length() < 1e-12 && (normal(2) - DVec3::Y).length() < 1e-12);
    assert!(scene.shapes[2].to_world.translation.y < 0.0);
    assert_eq!(
        warnings(&opened),
        [
            "m.ply: a mesh file has no camera: one is placed three quarters in front",
            "m.ply: nothing in the file emits light: a light, a dim sky and a floor are added"
        ]
    );
    assert!(
        matches!(&opened.origin, Origin::Foreign(scene) if scene.kind == "a mesh file")
            && opened.description.shapes.len() == 3
    );
    let other = folder.file("other.ply", &[&bytes[..], b"\n"].concat());
    assert_ne!(open(&other, &Options::default()).unwrap().source_hash, opened.source_hash);
    let defines = Options { defines: vec![("r".to_owned(), "1".to_owned())], ..Options::default() };
    let error = open(&path, &defines).unwrap_err().to_string();
    assert!(error.ends_with("m.ply: -D r=1: a mesh file has no parameters"), "{error}");
}

#[test]
fn a_face_without_area_far_away_does_not_move_the_camera() {
    let folder = Folder::new("far-face");
    let sound = "v -1 -1 0\nv 1 -1 0\nv 1 1 0.5\nv -1 1 0\nf 1 2 3\nf 1 3 4\n";
    let cameras = [sound.to_owned(), format!("{sound}v 1e8 1e8 1e8\nf 1 5 5\n")].map(|obj| {
        let opened = open(&folder.file("m.obj", obj.as_bytes()), &Options::default()).unwrap();
        opened.description.sensors[0].to_world
    });
    assert_eq!(cameras[0], cameras[1]);
}

#[test]
fn a_box_is_looked_into_through_its_open_side() {
    let folder = Folder::new("box");
    let corners = "v -1 0 -1\nv 1 0 -1\nv 1 2 -1\nv -1 2 -1\nv -1 0 1\nv 1 0 1\nv 1 2 1\nv -1 2 1\n";
    let faces = [("front", "5 6 7 8"), ("right", "2 3 7 6"), ("back", "1 4 3 2"), ("left", "1 5 8 4")];
    let lids = "f 1 2 6 5\nf 4 8 7 3\n";
    let towards = [DVec3::NEG_Z, DVec3::NEG_X, DVec3::Z, DVec3::X];
    for (open_face, forward) in faces.iter().zip(towards) {
        let closed = faces.iter().filter(|face| face.0 != open_face.0);
        let obj = closed.fold(format!("{corners}{lids}"), |obj, (_, face)| format!("{obj}f {face}\n"));
        let path = folder.file(&format!("{}.obj", open_face.0), obj.as_bytes());
        let opened = open(&path, &Options::default()).unwrap_or_else(|e| panic!("{e}"));
        let camera = opened.description.sensors[0].to_world;
        assert!((camera.matrix3.z_axis - forward).length() < 1e-12, "{}: {camera:?}", open_face.0);
        let reach = extent(&opened, &mesh(&opened, 0).positions);
        assert!(reach > 0.9 && reach < 1.0, "{}: {reach}", open_face.0);
        assert_eq!(opened.description.shapes.len(), 2, "a light under the lid, and no floor");
        assert!((opened.description.shapes[1].to_world.translation.y - 1.9).abs() < 1e-12);
    }
}

/// The boxes made by others lie beside the checkout, where there are any.
#[test]
fn shared_boxes_open() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/scenes/mcguire-cornell");
    for (name, shapes, emits) in [
        ("Original", 8, true),
        ("Mirror", 7, false),
        ("Sphere", 7, false),
        ("Glossy", 8, false),
        ("Water", 10, true),
    ] {
        let path = folder.join(format!("CornellBox-{name}.obj"));
        if !path.exists() {
            continue;
        }
        let opened = open(&path, &Options::default()).unwrap_or_else(|e| panic!("{e}"));
        let scene = &opened.description;
        assert_eq!(scene.shapes.len(), shapes + usize::from(!emits), "{name}");
        assert_eq!(scene.emitters.is_empty(), emits, "{name}");
        let forward = scene.sensors[0].to_world.matrix3.z_axis;
        assert!((forward + DVec3::Z).length() < 1e-12, "{name}: {forward}");
        let model: Vec<DVec3> =
            (0..shapes).flat_map(|i| mesh(&opened, i).positions.iter().copied()).collect();
        let reach = extent(&opened, &model);
        assert!(reach > 0.9 && reach < 1.0, "{name}: {reach}");
    }
}

#[test]
fn a_mesh_in_several_shapes_is_stored_once() {
    let bytes = ply("binary_little_endian", little);
    let files = |_: &Path| Ok(bytes.clone());
    let one = |more: &str| format!("<shape type='ply'><string name='filename' value='m'/>{more}</shape>");
    let flat = one("<boolean name='face_normals' value='true'/>");
    let xml = format!("<scene version='3.0.0'><sensor type='perspective'/>{flat}{flat}</scene>");
    let opened = read_str("s.xml", &xml, &files, &Options::default()).unwrap();
    let [Geometry::Mesh(a), Geometry::Mesh(b)] =
        [0, 1].map(|i| opened.description.shapes[i].geometry.clone())
    else {
        panic!("not meshes")
    };
    assert!(Arc::ptr_eq(&a, &b));
}

/// Normals that are computed turn with the shape, but a stretched shape has others.
#[test]
fn a_mesh_without_normals_is_stored_once_for_all_turns_of_it() {
    let bytes = ply("binary_little_endian", little);
    let files = |_: &Path| Ok(bytes.clone());
    let one = |transform: &str| {
        format!(
            "<shape type='ply'><string name='filename' value='m'/><transform name='to_world'>{transform}</transform></shape>"
        )
    };
    let shapes = [
        "<rotate x='1' y='2' angle='33'/><scale value='0.3'/><translate x='4'/>",
        "<rotate z='1' angle='-70'/><scale value='7'/>",
        "<scale x='2'/>",
        "<scale x='-1'/>",
    ];
    let shapes = shapes.map(one).concat();
    let xml = format!("<scene version='3.0.0'><sensor type='perspective'/>{shapes}</scene>");
    let opened = read_str("s.xml", &xml, &files, &Options::default()).unwrap();
    let meshes = [0, 1, 2, 3].map(|i| &opened.description.shapes[i].geometry);
    let [Geometry::Mesh(turned), Geometry::Mesh(again), Geometry::Mesh(stretched), Geometry::Mesh(mirrored)] =
        meshes
    else {
        panic!("not meshes")
    };
    assert!(!turned.normals.is_empty() && Arc::ptr_eq(turned, again));
    assert!(!Arc::ptr_eq(turned, stretched) && !Arc::ptr_eq(turned, mirrored));
}

#[test]
fn an_off_file_with_colours_of_faces_is_painted_in_them() {
    let folder = Folder::new("off");
    let off = "OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2 255 0 0\n3 0 2 3\n";
    let opened = open(&folder.file("m.off", off.as_bytes()), &Options::default()).expect("a file");
    let scene = &opened.description;
    let reflectance = Colour::Texture(0);
    assert_eq!(scene.materials[0].front, Bsdf::Diffuse(Diffuse { reflectance }));
    let colours = &mesh(&opened, 0).attributes[0];
    assert_eq!((colours.name.as_str(), &colours.values[..3]), ("face_color", &[1.0, 0.0, 0.0][..]));
    foton_scene::Scene::build(scene).expect("a scene");
}

/// Scans state colours of their vertices, which are seen without asking.
#[test]
fn a_model_with_colours_of_vertices_is_painted_in_them() {
    let folder = Folder::new("colours");
    let obj = "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nf 1 2 3\nusemtl other\nf 3 2 1\n";
    let ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
        property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\n\
        property list uchar int vertex_indices\nend_header\n0 0 0 255 0 0\n1 0 0 0 255 0\n0 1 0 0 0 255\n3 0 1 2\n";
    for (name, text, parts) in [("m.obj", obj, 2), ("m.ply", ply, 1)] {
        let opened = open(&folder.file(name, text.as_bytes()), &Options::default()).unwrap();
        let scene = &opened.description;
        assert_eq!(scene.textures.len(), 1, "{name}");
        for part in 0..parts {
            let reflectance = Colour::Texture(0);
            assert_eq!(scene.materials[part].front, Bsdf::Diffuse(Diffuse { reflectance }), "{name}");
            assert_eq!(mesh(&opened, part).attributes[0].values.len(), 9, "{name}");
        }
        foton_scene::Scene::build(scene).unwrap();
    }
}
