//! Files that foton does not read, known by their names: what they are, and what can be done.

use std::path::Path;

/// Kinds of files: their extensions, what they are, and what can be done.
const KINDS: &[(&[&str], &str, &str)] = &[
    (&["3mf"], "3MF files", "the program that wrote it exports the same model as STL or OBJ"),
    (
        &["step", "stp", "iges", "igs", "brep", "sat", "x_t"],
        "files of CAD programs, which hold curved surfaces instead of triangles,",
        "export it from a CAD program, FreeCAD for example, as OBJ or STL",
    ),
    (&["blend"], "Blender's own files", "export it from Blender: File > Export > glTF 2.0"),
    (
        &["fbx", "usd", "usda", "usdc", "usdz", "dae", "abc", "3ds", "x3d", "wrl", "lwo", "bvh", "vrm"],
        "files of this kind",
        "import it in Blender and export it as glTF 2.0",
    ),
    (
        &["max", "ma", "mb", "c4d", "skp", "3dm", "hip", "ztl", "f3d", "sldprt"],
        "files of this program",
        "export it from the program that wrote it as glTF 2.0 or OBJ",
    ),
    (
        &["zip", "7z", "rar", "tar", "gz", "tgz", "zst"],
        "archives",
        "unpack it and open the scene file inside",
    ),
];

/// What a file is that is not read, and what can be done; `None` where its name says nothing of that kind.
pub(crate) fn refused(path: &Path) -> Option<(String, &'static str)> {
    let extension = path.extension()?.to_str()?.to_ascii_lowercase();
    let (_, what, way_out) = KINDS.iter().find(|(names, ..)| names.contains(&extension.as_str()))?;
    Some((format!("{what} (.{extension}) are not read"), way_out))
}
