//! Whether a file is an OBJ file at all, by its first statements.

use foton_math::Cancel;

use crate::mesh::words::Words;

/// Whether a file begins as an OBJ file does: its first statements are such that one has. An empty one may have been cut.
pub(super) fn is_of_kind(bytes: &[u8], cancel: &Cancel) -> bool {
    const KNOWN: &[&[u8]] = &[
        b"v",
        b"vn",
        b"vt",
        b"vp",
        b"f",
        b"fo",
        b"l",
        b"p",
        b"g",
        b"o",
        b"s",
        b"mg",
        b"mtllib",
        b"usemtl",
        b"maplib",
        b"usemap",
        b"bevel",
        b"c_interp",
        b"d_interp",
        b"lod",
        b"shadow_obj",
        b"trace_obj",
        b"ctech",
        b"stech",
        b"cstype",
        b"deg",
        b"bmat",
        b"step",
        b"curv",
        b"curv2",
        b"surf",
        b"parm",
        b"trim",
        b"hole",
        b"scrv",
        b"sp",
        b"end",
        b"con",
        b"call",
        b"csh",
    ];
    let (mut words, mut left) = (Words::new(bytes, cancel), FIRST_STATEMENTS);
    while left > 0 && words.next_line() {
        if let Some(keyword) = words.next() {
            if !KNOWN.contains(&keyword.text) {
                return false;
            }
            left -= 1;
        }
    }
    true
}

/// How many statements say whether a file is of this kind.
const FIRST_STATEMENTS: usize = 20;
