//! Files as exporters write them: not what the formats say, but what is meant is clear enough.

use super::*;

/// A cube of one material, bare, with its file of materials: the material, and what was said about it.
fn material(mtl: &str) -> (foton_scene::description::Material, Vec<String>) {
    let folder =
        Folder::new(&format!("mtl-{:x}", mtl.bytes().fold(7_u64, |h, b| h.wrapping_mul(31) + u64::from(b))));
    folder.file("m.mtl", mtl.as_bytes());
    let name = mtl.split_whitespace().nth(1).unwrap();
    let obj = format!(
        "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl {name}\nf 1 2 3\nf 1 3 4\nf 2 3 4\n"
    );
    let opened = open(&folder.file("m.obj", obj.as_bytes()), &Options::default()).unwrap();
    let scene = &opened.description;
    let said = warnings(&opened).into_iter().filter(|w| w.starts_with("m.mtl"));
    (scene.materials[scene.shapes[0].material].clone(), said.collect())
}

#[test]
fn a_material_of_maya_is_opaque_and_that_is_said() {
    let (found, said) = material("newmtl lambert\nillum 4\nKd 0.7 0.2 0.1\nKa 0 0 0\nTf 1 1 1\nNi 1.00\n");
    assert_eq!(found.front, Bsdf::Diffuse(Diffuse { reflectance: Rgb::new(0.7, 0.2, 0.1).into() }));
    assert_eq!((found.back, found.opacity), (Some(found.front), None));
    assert_eq!(
        said,
        [
            "m.mtl:2: \"illum\" of \"lambert\" asks for glass, but \"Ni\" says that it refracts nothing: taken as opaque; \
          \"Ni 1.5\" makes it glass"
        ]
    );
    // The same with an index that nothing has, and of several materials.
    let (found, said) = material("newmtl a\nillum 9\nNi 0\nnewmtl b\nillum 6\nNi 1\n");
    assert!(matches!(found.front, Bsdf::Diffuse(Diffuse { .. })));
    assert!(said.len() == 1 && said[0].contains("of \"a\" and of 1 more asks"), "{said:?}");
    for glass in
        ["illum 4\nNi 1.5", "illum 7", "illum 6\nNi 1.33\nTf 0 0 0", "illum 4\nNi 0.75", "d 0.2\nNi 1.5"]
    {
        let (found, said) = material(&format!("newmtl g\n{glass}\n"));
        assert!(
            matches!(found.front, Bsdf::Dielectric(Dielectric { .. })) && said.is_empty(),
            "{glass}: {found:?} {said:?}"
        );
    }
}

#[test]
fn transparency_as_exporters_mean_it_makes_no_model_vanish() {
    let red = "Kd 1 0 0";
    let tr_is_opacity = "taken as opacity, 1 for opaque";
    for (mtl, opacity, wanted) in [
        // Alone.
        ("newmtl a\nTr 0", None, ""),
        ("newmtl a\nTr 1", None, tr_is_opacity),
        ("newmtl a\nTr 0.75", Some(0.25), ""),
        ("newmtl a\nTr 1\nnewmtl b\nTr 0", None, "\"Tr\" of \"a\" would make it invisible"),
        ("newmtl a\nTr 0.75\nnewmtl b\nTr 1", Some(0.75), tr_is_opacity),
        ("newmtl a\nTr 0.75\nnewmtl b\nTr 0", Some(0.25), ""),
        // Beside `d`, whose word holds, and beside materials that have both.
        ("newmtl a\nd 1\nTr 1", None, "\"Tr\" of \"a\" contradicts \"d\" beside it"),
        ("newmtl a\nTr 1\nd 1", None, "\"Tr\" of \"a\" contradicts \"d\" beside it"),
        ("newmtl a\nd 0.75\nTr 0.25", Some(0.75), ""),
        ("newmtl a\nTr 0.75\nd 0.25", Some(0.25), ""),
        ("newmtl a\nTr 0.75\nnewmtl b\nd 1\nTr 0", Some(0.25), ""),
        ("newmtl a\nTr 0.75\nnewmtl b\nTr 0.5\nnewmtl c\nd 0.25\nTr 0.25", Some(0.75), tr_is_opacity),
        // `d`.
        ("newmtl a\nd 0.5", Some(0.5), ""),
        ("newmtl a\nd -halo 0.5", Some(0.5), ""),
        ("newmtl a\nd 0\nnewmtl b\nd 1", Some(0.0), ""),
        (
            "newmtl a\nd 0\nnewmtl b\nd 0",
            None,
            "\"d\" of \"a\" and of 1 more would make the whole file invisible",
        ),
    ] {
        let (found, said) = material(&format!("{}\n", mtl.replace("newmtl a", &format!("newmtl a\n{red}"))));
        assert_eq!(found.opacity, opacity.map(|o: f32| Rgb::splat(o).into()), "{mtl}: {said:?}");
        assert_eq!(
            found.front,
            Bsdf::Diffuse(Diffuse { reflectance: Rgb::new(1.0, 0.0, 0.0).into() }),
            "{mtl}"
        );
        let about_a: Vec<_> = said.iter().filter(|w| w.contains("\"a\"")).collect();
        assert_eq!(about_a.len(), usize::from(!wanted.is_empty()), "{mtl}: {said:?}");
        assert!(about_a.iter().all(|w| w.contains(wanted)), "{mtl}: {said:?}");
    }
}

#[test]
fn files_of_materials_are_found_by_every_way_to_name_them() {
    let folder = Folder::new("mtllib");
    for (file, name, kd) in [("one.mtl", "a b", 0.1), ("two two.mtl", "\"q\"", 0.2), ("three", "c", 0.3)] {
        folder.file(file, format!("newmtl {name}\nKd {kd} 0 0\n").as_bytes());
    }
    let uses = [("a b", 0.1), ("\"a b\"", 0.1), ("q", 0.2), ("c # of three", 0.3)];
    for line in [
        "one.mtl two two.mtl three",
        "\"one.mtl\" \"two two.mtl\" three # all of them",
        "three \"two two.mtl\" one.mtl",
        "one.mtl three\nmtllib two two.mtl",
        "\"one.mtl\"\nmtllib \"two two.mtl\"\nmtllib three",
    ] {
        let mut obj = format!("mtllib {line}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n");
        uses.iter().for_each(|(name, _)| obj += &format!("usemtl {name}\nf 1 2 3\nf 1 3 4\n"));
        let opened = open(&folder.file("m.obj", obj.as_bytes()), &Options::default()).unwrap();
        let scene = &opened.description;
        for (shape, (name, kd)) in scene.shapes.iter().zip(uses) {
            let wanted = Bsdf::Diffuse(Diffuse { reflectance: Rgb::new(kd, 0.0, 0.0).into() });
            assert_eq!(
                scene.materials[shape.material].front,
                wanted,
                "{line}: {name}: {:?}",
                warnings(&opened)
            );
        }
    }
    let lost = folder
        .file("lost.obj", b"mtllib one.mtl no where.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 1\nusemtl a b\nf 1 2 3\n");
    let said = warnings(&open(&lost, &Options::default()).unwrap());
    assert_eq!(said.concat().matches("is not there: its materials are grey").count(), 2, "{said:?}");
}

/// The sum of a mesh's areas.
fn area(mesh: &Mesh) -> f64 {
    let of = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
        0.5 * (b - a).cross(c - a).length()
    };
    mesh.triangles.iter().map(of).sum()
}

/// A square of nine with a bite of two out of its left: a letter C of area 7.
const LETTER: [[f32; 2]; 8] =
    [[0., 0.], [3., 0.], [3., 3.], [0., 3.], [0., 2.], [2., 2.], [2., 1.], [0., 1.]];

#[test]
fn a_concave_polygon_has_its_own_area_in_every_format() {
    let obj = LETTER.iter().fold(String::new(), |text, [x, y]| format!("{text}v {x} {y} 0\n"))
        + "f 1 2 3 4 5 6 7 8\n";
    let ply = |order: &str| {
        let vertices = "element vertex 8\nproperty float x\nproperty float y\nproperty float z\n";
        let faces = "element face 1\nproperty list uchar int vertex_indices\n";
        let points = LETTER.iter().fold(String::new(), |text, [x, y]| format!("{text}{x} {y} 0\n"));
        let (head, body) = match order {
            "faces last" => ([vertices, faces].concat(), points + "8 0 1 2 3 4 5 6 7\n"),
            _ => ([faces, vertices].concat(), format!("8 0 1 2 3 4 5 6 7\n{points}")),
        };
        format!("ply\nformat ascii 1.0\n{head}end_header\n{body}")
    };
    for (plugin, text) in [("obj", obj), ("ply", ply("faces last")), ("ply", ply("faces first"))] {
        let mesh = shape(plugin, text.as_bytes(), "").unwrap();
        assert!((area(&mesh) - 7.0).abs() < 1e-12, "{plugin}: {}", area(&mesh));
        assert!(
            mesh.normals.iter().all(|n| (*n - DVec3::Z).length() < 1e-12),
            "{plugin}: {:?}",
            mesh.normals
        );
        let folder = Folder::new(&format!("concave-{plugin}-{}", text.len()));
        let opened =
            open(&folder.file(&format!("m.{plugin}"), text.as_bytes()), &Options::default()).unwrap();
        assert!((area(super::mesh(&opened, 0)) - 7.0).abs() < 1e-12, "{plugin}");
    }
}

/// What is warned of in a mesh file, and the mesh.
fn mended(plugin: &str, bytes: &[u8]) -> (Mesh, Vec<String>) {
    let files = |_: &Path| Ok(bytes.to_vec());
    let xml = format!(
        "<scene version='3.0.0'><sensor type='perspective'/><shape type='{plugin}'><string name='filename' value='m'/></shape></scene>"
    );
    let opened = read_str("s.xml", &xml, &files, &Options::default()).unwrap_or_else(|e| panic!("{e}"));
    (mesh(&opened, 0).clone(), warnings(&opened))
}

const SQUARE: &str = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
                      element face 2\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\nend_header\n\
                      -1 -1 0\n1 -1 0\n1 1 0\n-1 1 0\n";

#[test]
fn texture_coordinates_of_corners_are_those_of_vertices_that_are_split_where_they_differ() {
    let uv = |mesh: &Mesh| -> Vec<Vec<[f64; 2]>> {
        mesh.triangles
            .iter()
            .map(|t| t.map(|i| mesh.texture_coordinates[i as usize].to_array()).to_vec())
            .collect()
    };
    let (mesh, said) =
        mended("ply", format!("{SQUARE}3 0 1 2 6 0 0 1 0 1 1\n3 0 2 3 6 0 0 1 1 0 1\n").as_bytes());
    assert_eq!(uv(&mesh), [[[0., 0.], [1., 0.], [1., 1.]], [[0., 0.], [1., 1.], [0., 1.]]]);
    assert_eq!((mesh.positions.len(), said), (4, vec![]), "no seam, no more vertices");
    let (mesh, _) =
        mended("ply", format!("{SQUARE}3 0 1 2 6 0 0 1 0 1 1\n3 0 2 3 6 5 5 1 1 0 1\n").as_bytes());
    assert_eq!(uv(&mesh)[1], [[5., 5.], [1., 1.], [0., 1.]]);
    assert_eq!(mesh.positions.len(), 5);
    let corner = |i: usize| mesh.positions[mesh.triangles[i][0] as usize];
    assert_eq!((corner(0), corner(1)), (DVec3::new(-1.0, -1.0, 0.0), DVec3::new(-1.0, -1.0, 0.0)));
    // A quad, of which the second face has too few of them.
    let (mesh, said) =
        mended("ply", format!("{SQUARE}4 0 1 2 3 8 0 0 1 0 1 1 0 1\n3 0 1 2 2 7 7\n").as_bytes());
    assert_eq!(
        uv(&mesh),
        [[[0., 0.], [1., 0.], [1., 1.]], [[0., 0.], [1., 1.], [0., 1.]], [[0., 0.]; 3]].map(Vec::from)
    );
    assert_eq!(
        said,
        [
            "m:16: 1 face has texture coordinates that are not finite or do not fit the corners: those of the vertices are taken"
        ]
    );
}

#[test]
fn a_number_of_vertices_that_lies_is_refused_before_faces_go_by_it() {
    let text = "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\n\
                element vertex 4294967295\nproperty float x\nproperty float y\nproperty float z\nend_header\n\
                3 0 1 2 6 0 0 1 0 1 1\n0 0 0\n1 0 0\n0 1 0\n";
    assert_eq!(problem("ply", text.as_bytes()), "m:11: the file is too short for 4294967295 × vertex");
}

#[test]
fn strips_of_triangles_keep_their_sides() {
    let text = "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n\
                element tristrips 1\nproperty list int int vertex_indices\nend_header\n\
                0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n1 2 0\n11 0 1 2 3 4 5 -1 0 1 1 2\n";
    let (mesh, said) = mended("ply", text.as_bytes());
    assert_eq!(mesh.triangles, [[0, 1, 2], [2, 1, 3], [2, 3, 4], [4, 3, 5]]);
    assert!(
        (area(&mesh) - 2.0).abs() < 1e-12 && mesh.normals.iter().all(|n| *n == DVec3::Z),
        "{:?}",
        mesh.normals
    );
    assert_eq!(said, Vec::<String>::new());
}

#[test]
fn strips_may_stand_beside_faces_with_texture_coordinates_for_their_corners() {
    for (faces, body) in [(0, ""), (1, "3 0 1 2 6 0.5 0 1 0 0 1\n")] {
        let text = format!(
            "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
             element face {faces}\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\n\
             element tristrips 1\nproperty list int int vertex_indices\nend_header\n\
             0 0 0\n1 0 0\n0 1 0\n1 1 0\n{body}4 0 1 2 3\n"
        );
        let (mesh, said) = mended("ply", text.as_bytes());
        assert_eq!((mesh.triangles.len(), said), (faces + 2, Vec::new()));
        let corners = |t: &[u32; 3]| t.map(|i| mesh.positions[i as usize]);
        let strip: Vec<_> = mesh.triangles[faces..].iter().map(corners).collect();
        assert_eq!(
            strip,
            [[DVec3::ZERO, DVec3::X, DVec3::Y], [DVec3::Y, DVec3::X, DVec3::new(1.0, 1.0, 0.0)]]
        );
    }
}

#[test]
fn what_exporters_get_wrong_in_a_ply_file_is_mended_and_counted() {
    let text = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
                property float nx\nproperty float ny\nproperty float nz\nproperty float s\nproperty float t\n\
                element face 4\nproperty list uchar int vertex_indices\nend_header\n\
                0 0 0 0 0 1 1 1\n1 0 0 -nan(ind) 0 0 nan 0\n0 1 0 0 0 0 0 1.#INF\n5 5 5 0 0 0 0 0\n3 0 1 2\n2 0 1\n1 0\n0\n";
    let (mesh, said) = mended("ply", text.as_bytes());
    assert_eq!(mesh.normals[..3], [DVec3::Z; 3]);
    assert_eq!(mesh.texture_coordinates, [DVec2::ONE, DVec2::ZERO, DVec2::ZERO, DVec2::ZERO]);
    assert_eq!(mesh.triangles, [[0, 1, 2]]);
    assert_eq!(
        said,
        [
            "m: 2 normals are zero or not finite: the faces around say where they point",
            "m: 2 texture coordinates are not finite and taken as zero",
            "m:20: 3 faces have fewer than three corners and are left out",
        ]
    );
}

#[test]
fn headers_of_ply_files_may_be_wrapped_and_lines_end_as_they_like() {
    let plain = "ply\nformat ascii 1.0\ncomment made by a program\nelement vertex 3\nproperty float x\nproperty float y\n\
                 property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    let (wanted, _) = mended("ply", plain.as_bytes());
    for end in ["\r", "\r\n"] {
        let (mesh, said) = mended("ply", plain.replace('\n', end).as_bytes());
        assert_eq!(
            (&mesh.positions, &mesh.triangles, said.len()),
            (&wanted.positions, &wanted.triangles, 0),
            "{end:?}"
        );
    }
    let wrapped = plain.replace("made by", "made\nby").replace("int vertex_indices", "int\n vertex_indices");
    let (mesh, said) = mended("ply", wrapped.as_bytes());
    assert_eq!((&mesh.positions, &mesh.triangles), (&wanted.positions, &wanted.triangles));
    assert_eq!(said, ["m:4: 2 lines of the header go on with the one before"]);
    // In bytes, with a zero of the first position right behind the header's end.
    let header =
        plain.split_inclusive("end_header\n").next().unwrap().replace("ascii", "binary_little_endian");
    let mut bytes = header.replace('\n', "\r").into_bytes();
    [10, 0, 0, 0].iter().for_each(|b| bytes.push(*b));
    [0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0_f32].iter().for_each(|f| bytes.extend(f.to_le_bytes()));
    bytes.push(3);
    [0, 1, 2_i32].iter().for_each(|i| bytes.extend(i.to_le_bytes()));
    assert_eq!(mended("ply", &bytes).0.positions[1..], wanted.positions[1..]);
}

#[test]
fn an_obj_file_with_lines_of_long_ago_is_the_same() {
    let text = "# a square\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
    let (wanted, _) = mended("obj", text.as_bytes());
    let (mesh, said) = mended("obj", text.replace('\n', "\r").as_bytes());
    assert_eq!((mesh.positions, mesh.triangles, said.len()), (wanted.positions, wanted.triangles, 0));
}

#[test]
fn stl_files_of_every_program_are_read() {
    let count = |bytes: &[u8]| {
        let (mesh, said) = mended("stl", bytes);
        assert_eq!(mesh.triangles.len(), 2, "{said:?}");
        said
    };
    let none = Vec::<String>::new();
    for text in [
        STL.to_uppercase(),
        format!("\u{feff}{STL}"),
        STL.replace("endsolid", "end solid").replace("endfacet", "end facet").replace("endloop", "end loop"),
        STL.replace('\n', "\r"),
        STL.replace("solid wedge\n facet", "solid\n facet"),
    ] {
        assert_eq!(count(text.as_bytes()), none, "{text}");
    }
    for header in ["solid made by a program", "SOLID", "no text"] {
        let whole = binary_stl(header.as_bytes(), 0);
        assert_eq!(count(&whole), none, "{header}");
        assert_eq!(count(&binary_stl(header.as_bytes(), 2)), none, "{header}");
        let said = count(&binary_stl(header.as_bytes(), 60));
        assert_eq!(
            said,
            ["m: the file has 2 triangles, as it says: 60 bytes behind them are not read"],
            "{header}"
        );
        for stated in [0, u32::MAX] {
            let mut bytes = whole.clone();
            bytes[80..84].copy_from_slice(&stated.to_le_bytes());
            let said = count(&bytes);
            assert_eq!(
                said,
                [format!("m: the file says that it has {stated} triangles: all 2 that are there are read")]
            );
        }
    }
}
