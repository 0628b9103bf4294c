//! Shapes of scene files, with their parameters.

use super::Plugin;
use crate::parameter::{Kind, Parameter};

/// Lengths are above zero.
const LENGTH: (f64, f64) = (f64::MIN_POSITIVE, f64::MAX);

/// Where a shape stands.
pub const TO_WORLD: Parameter =
    Parameter::other("to_world", Kind::Transform, "identity").help("Shape to world.");

/// Whether inside and outside are swapped.
pub const FLIP_NORMALS: Parameter = Parameter::boolean("flip_normals").help("Swaps inside and outside.");

/// The file of a mesh.
pub const FILENAME: Parameter =
    Parameter::other("filename", Kind::File, "required").help("The file, looked for beside the scene.");

/// Whether a mesh has flat faces.
pub const FACE_NORMALS: Parameter =
    Parameter::boolean("face_normals").help("Makes faces flat: normals of vertices are not used.");

/// Whether v of texture coordinates is turned around.
pub const FLIP_TEX_COORDS: Parameter = Parameter::boolean("flip_tex_coords")
    .help("Turns v of texture coordinates around.")
    .default_text("true in `obj`, else false");

/// Which mesh of a file.
pub const SHAPE_INDEX: Parameter =
    Parameter { range: (0.0, u32::MAX as f64), ..Parameter::other("shape_index", Kind::Integer, "0") }
        .help("Which mesh of several in the file, from 0.");

/// The centre of a sphere.
pub const CENTER: Parameter = Parameter::other("center", Kind::Vector, "0, 0, 0").help("Its centre.");

/// The radius of a sphere or cylinder.
pub const RADIUS: Parameter = Parameter::number("radius", 1.0, LENGTH).help("Its radius.");

/// One end of a cylinder.
pub const P0: Parameter = Parameter::other("p0", Kind::Vector, "0, 0, 0").help("One end of its axis.");

/// The other end.
pub const P1: Parameter = Parameter::other("p1", Kind::Vector, "0, 0, 1").help("The other end of its axis.");

const SAMPLING_WEIGHT: Parameter =
    Parameter::ignored("silhouette_sampling_weight", "It steers another renderer's sampling.");
const FLAT: Parameter = Parameter::ignored("face_normals", "Its faces are always flat.");

/// Shapes for instances.
pub const SHAPEGROUP: Plugin = Plugin {
    name: "shapegroup",
    label: "",
    help: "Around shapes that instances show; by itself it is not seen.",
    parameters: &[],
};

/// Shapes of a group at another place.
pub const INSTANCE: Plugin = Plugin {
    name: "instance",
    label: "",
    help: "Around a `shapegroup` or a reference to one: its shapes once more, at another place. Many instances of a large mesh share one tree over it.",
    parameters: &[TO_WORLD],
};

/// Shapes from files and shapes by formula.
pub const ALL: &[Plugin] = &[
    Plugin {
        name: "obj",
        label: "",
        help: "A mesh in a Wavefront OBJ file. In a scene its materials come from the scene, not from MTL files.",
        parameters: &[FILENAME, FACE_NORMALS, FLIP_TEX_COORDS, FLIP_NORMALS, TO_WORLD, SAMPLING_WEIGHT],
    },
    Plugin {
        name: "ply",
        label: "",
        help: "A mesh in a PLY file, of text or binary.",
        parameters: &[FILENAME, FACE_NORMALS, FLIP_TEX_COORDS, FLIP_NORMALS, TO_WORLD, SAMPLING_WEIGHT],
    },
    Plugin {
        name: "stl",
        label: "",
        help: "A mesh in an STL file, of text or binary.",
        parameters: &[FILENAME, FACE_NORMALS, FLIP_TEX_COORDS, FLIP_NORMALS, TO_WORLD, SAMPLING_WEIGHT],
    },
    Plugin {
        name: "serialized",
        label: "",
        help: "A mesh in a file of Mitsuba 0.6's compressed format.",
        parameters: &[
            FILENAME,
            SHAPE_INDEX,
            FACE_NORMALS,
            FLIP_TEX_COORDS,
            FLIP_NORMALS,
            TO_WORLD,
            SAMPLING_WEIGHT,
        ],
    },
    Plugin {
        name: "rectangle",
        label: "",
        help: "The square from −1 to 1 in the xy plane, its normal +z.",
        parameters: &[FLIP_NORMALS, TO_WORLD, FLAT, SAMPLING_WEIGHT],
    },
    Plugin {
        name: "cube",
        label: "",
        help: "The cube from −1 to 1 along each axis.",
        parameters: &[FLIP_NORMALS, TO_WORLD, FLAT, SAMPLING_WEIGHT],
    },
    Plugin {
        name: "sphere",
        label: "",
        help: "A sphere. It can be turned, moved and scaled evenly, but not stretched.",
        parameters: &[CENTER, RADIUS, FLIP_NORMALS, TO_WORLD, SAMPLING_WEIGHT],
    },
    Plugin {
        name: "disk",
        label: "",
        help: "The disc of radius 1 in the xy plane, its normal +z.",
        parameters: &[FLIP_NORMALS, TO_WORLD, SAMPLING_WEIGHT],
    },
    Plugin {
        name: "cylinder",
        label: "",
        help: "The side of a cylinder, without caps.",
        parameters: &[P0, P1, RADIUS, FLIP_NORMALS, TO_WORLD, SAMPLING_WEIGHT],
    },
    SHAPEGROUP,
    INSTANCE,
];
