//! What mutation starts from: small files of every kind, written here or made by our own writers.

/// A closed room with a lamp and a glass ball.
pub const ROOM: &str = "<scene version='3.0.0'><sensor type='perspective'><film type='hdrfilm'>
<integer name='width' value='4'/><integer name='height' value='4'/></film>
<transform name='to_world'><lookat origin='0 0 3' target='0 0 0' up='0 1 0'/></transform></sensor>
<shape type='cube'><transform name='to_world'><scale value='4'/></transform><boolean name='flip_normals' value='true'/></shape>
<shape type='sphere'><bsdf type='dielectric'/></shape>
<emitter type='point'><point name='position' value='0 3 0'/><rgb name='intensity' value='9 9 9'/></emitter></scene>";

/// One of everything that an XML file may say.
const WHOLE: &str = "<scene version='0.6.0'><default name='r' value='2'/><path value='.'/>
<integrator type='sppm'><integer name='photonCount' value='9'/><float name='alpha' value='.7'/></integrator>
<texture type='bitmap' id='t'><string name='filename' value='red.png'/><float name='uscale' value='2'/></texture>
<bsdf type='mask' id='m'><ref id='t' name='opacity'/><bsdf type='twosided'><bsdf type='roughplastic'>
<spectrum name='diffuseReflectance' value='400:0.1 500:0.2'/><float name='alpha' value='$r'/></bsdf></bsdf></bsdf>
<alias id='m' as='n'/><include filename='sub.xml'/><include filename='f.xml'/>
<shape type='cylinder'><ref id='n'/><transform name='toWorld'><lookAt origin='0 0 1' target='0 0 0' up='0 1 0'/>
<matrix value='1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1'/><rotate x='1' angle='30'/><scale x='2' y='2' z='2'/></transform></shape>
<shape type='obj'><string name='filename' value='good.obj'/><emitter type='area'><srgb name='radiance' value='#ff0000'/></emitter></shape>
<shape type='sphere'><point name='center' x='1' y='2' z='3'/><float name='radius' value='$r'/><bsdf type='roughconductor'>
<string name='material' value='Au'/><float name='alpha' value='0.2'/></bsdf></shape>
<emitter type='envmap'><string name='filename' value='red.png'/></emitter><emitter type='spot'><float name='cutoffAngle' value='20'/>
<rgb name='intensity' value='1 2 3'/></emitter><sensor type='perspective'><float name='fov' value='45'/>
<film type='ldrfilm'><integer name='width' value='8'/><integer name='cropWidth' value='4'/></film></sensor></scene>";

const OBJ: &str = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0.5\nv 0 1 0\nvt 0 0\nvt 1 0\nvn 0 0 1\nusemtl a\nf 1/1/1 2/2/1 3/1/1\n\
    f -4 -3 -2 -1\nf 1//1 3//1 4//1 # a comment\ng x\ns off\nv 2 2 2 \\\n 1\nf 1 2 5\n";

const PLY: &str = "ply\nformat ascii 1.0\ncomment c\nelement vertex 4\nproperty float x\nproperty double y\nproperty float z\n\
    property float nx\nproperty float ny\nproperty float nz\nproperty uchar red\nelement face 2\n\
    property list uchar int vertex_indices\nproperty list uchar float w\nend_header\n\
    0 0 0 0 0 1 9\n1 0 0 0 0 1 9\n1 1 0 0 0 1 9\n0 1 0 0 0 1 9\n3 0 1 2 0\n4 0 1 2 3 1 0.5\n";

const STL: &str = "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid s\n";

const OFF: &str = "COFF\n4 2 0\n0 0 0 255 0 0 255\n1 0 0 0 255 0 255\n1 1 0 0 0 255 255\n0 1 0 9 9 9 255\n4 0 1 2 3\n3 0 1 2 1.0 0 0\n";

/// A file that scenes name.
pub fn file(name: &str) -> Option<Vec<u8>> {
    match name {
        "good.obj" => Some(OBJ.into()),
        "m.mtl" => Some(b"newmtl a\nKd 0.5 0.5 0.5\nKs 0 0 0\nNi 1.5\nillum 2\n".to_vec()),
        "sub.xml" => Some(ROOM.into()),
        "red.png" => Some(png()),
        _ => None,
    }
}

fn scratch(extension: &str) -> std::path::PathBuf {
    std::env::temp_dir().join(format!("foton-seed-{}.{extension}", std::process::id()))
}

fn picture() -> foton_film::Image {
    let mut image = foton_film::Image::black(5, 3);
    for (i, p) in image.pixels.iter_mut().enumerate() {
        p.r = i as f32 / 15.0;
        p.b = 1.0 - p.r;
    }
    image
}

fn png() -> Vec<u8> {
    let path = scratch("png");
    let image = picture();
    let _ = foton_film::write_png(
        &path,
        &image,
        foton_film::ToneMap::default(),
        0.0,
        &foton_film::Metadata::default(),
    );
    let bytes = std::fs::read(&path).unwrap_or_default();
    let _ = std::fs::remove_file(path);
    bytes
}

fn exr() -> Vec<u8> {
    let path = scratch("exr");
    let _ = foton_film::write_exr(&path, &picture(), &[], &foton_film::Metadata::default());
    let bytes = std::fs::read(&path).unwrap_or_default();
    let _ = std::fs::remove_file(path);
    bytes
}

/// A Radiance picture of 8 × 2 pixels, one row packed and one plain.
fn hdr() -> Vec<u8> {
    let mut bytes = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 8\n".to_vec();
    bytes.extend([2, 2, 0, 8]);
    for channel in 0..4 {
        bytes.extend([128 + 5, 100 + channel, 3, 1, 2, 3]);
    }
    bytes.extend([9, 8, 7, 128].repeat(8));
    bytes
}

/// A portable pixmap of two pixels as text.
const PPM: &str = "P3 2 1 255 0 100 200 50 60 70\n";

/// A bitmap of a pixel.
fn bmp() -> Vec<u8> {
    let mut bytes = b"BM".to_vec();
    [58u32, 0, 54, 40, 1, 1].iter().for_each(|n| bytes.extend(n.to_le_bytes()));
    [1u16, 24].iter().for_each(|n| bytes.extend(n.to_le_bytes()));
    [0u32, 4, 0, 0, 0, 0].iter().for_each(|n| bytes.extend(n.to_le_bytes()));
    bytes.extend([50, 100, 200, 0]);
    bytes
}

/// A Targa picture of two packed pixels.
fn tga() -> Vec<u8> {
    let mut bytes = vec![0, 0, 10, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 1, 0, 24, 0];
    bytes.extend([0x81, 50, 100, 200]);
    bytes.extend([0; 8]);
    bytes.extend(b"TRUEVISION-XFILE.\0");
    bytes
}

/// Faces with texture coordinates for each corner, a concave one, and a strip.
const CORNERS: &str = "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n\
    element face 2\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\n\
    element tristrips 1\nproperty list int int vertex_indices\nend_header\n\
    0 0 0\n2 1 0\n0 2 0\n0.5 1 0\n5 5 1\n4 0 1 2 3 8 0 0 1 0 1 1 0 1\n3 0 1 2 0\n7 0 1 2 -1 2 1 0\n";

fn binary_ply() -> Vec<u8> {
    let mut bytes = b"ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
        element face 1\nproperty list uchar int vertex_indices\nend_header\n"
        .to_vec();
    for x in [0.0f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0] {
        bytes.extend(x.to_le_bytes());
    }
    bytes.push(3);
    [0i32, 1, 2].iter().for_each(|i| bytes.extend(i.to_le_bytes()));
    bytes
}

fn binary_stl() -> Vec<u8> {
    let mut bytes = vec![b' '; 80];
    bytes.extend(1u32.to_le_bytes());
    for x in [0.0f32, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0] {
        bytes.extend(x.to_le_bytes());
    }
    bytes.extend([0, 0]);
    bytes
}

/// The seeds of a target.
pub fn of(target: &str) -> Vec<Vec<u8>> {
    match target {
        "xml" => vec![ROOM.into(), WHOLE.into()],
        "pbrt" => crate::pbrt::seeds(),
        "obj" => vec![OBJ.into()],
        "ply" => vec![PLY.into(), CORNERS.into(), STL.into(), OFF.into(), binary_ply(), binary_stl()],
        "gltf" => crate::gltf::seeds(),
        "image" => vec![png(), exr(), hdr(), bmp(), tga(), PPM.into()],
        "checkpoint" => {
            let (file, state) = crate::genuine_checkpoint();
            vec![[&[0], &file[..]].concat(), [&[1], &state[..]].concat()]
        }
        _ => Vec::new(),
    }
}

/// Words that break things.
pub const WORDS: &[&str] = &[
    "nan",
    "inf",
    "-inf",
    "1e39",
    "1e309",
    "-1e-320",
    "-1",
    "0",
    "4294967295",
    "4294967296",
    "18446744073709551615",
    "9e99",
    "&amp;",
    "&#0;",
    "<!DOCTYPE a [<!ENTITY b 'c'>]>",
    "&b;",
    "..",
    "../../../etc/passwd",
    "$r",
    "'/>",
    "<scene version='3.0.0'>",
    "</scene>",
    "<include filename='f.xml'/>",
    "<ref id='m'/>",
    "<ref id='n'/>",
    "\u{feff}",
    "\u{0}",
    "1 0 0 0",
    "#ff00",
    "element vertex 99999999\n",
    "element face 4000000000\n",
    "property list uint double q\n",
    "f 1 2 3 4 5 6 7 8\n",
    "\\\n",
    "usemtl",
    "-2147483648",
    "65536",
    "0.5",
    "true",
    "id='t'",
    "name='radius'",
    "value=''",
    "AttributeBegin ",
    "Shape \"sphere\" ",
    "ObjectInstance \"o\" ",
    "Include \"f.pbrt\" ",
    "\"texture reflectance\" \"m\" ",
    "\"float roughness\" ",
    "[",
    "]",
    "\"",
    "#",
];
