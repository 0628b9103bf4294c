//! Every reader once or twice, on inputs of a few bytes from memory: small enough for Miri (`cargo xtask miri`).
//!
//! What readers make of them is tested elsewhere; here it counts that they end, and in which of two ways.

use std::io;
use std::path::Path;

use foton_format::{Options, read_str};

const OBJ: &[u8] = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.4 0.5 0\nvt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1\nf 1//1 3//1 4//1\nf 1 2 5 4\nf -1 -2 -3\n";
const STL: &[u8] = b"solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid s\n";
const PLY: &str = "ply\nformat FORMAT 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
    element face 1\nproperty list uchar int vertex_indices\nend_header\n";

/// A file and whether it is one.
type File = (&'static str, Vec<u8>, bool);

fn numbers(big: bool) -> Vec<u8> {
    let floats = [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    let mut bytes: Vec<u8> =
        floats.iter().flat_map(|f| if big { f.to_be_bytes() } else { f.to_le_bytes() }).collect();
    bytes.push(3);
    bytes.extend([0_i32, 1, 2].iter().flat_map(|i| if big { i.to_be_bytes() } else { i.to_le_bytes() }));
    bytes
}

fn binary_stl() -> Vec<u8> {
    let mut bytes = vec![0; 80];
    bytes.extend(1_u32.to_le_bytes());
    let corners = [0.0_f32, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    bytes.extend(corners.iter().flat_map(|c| c.to_le_bytes()));
    bytes.extend([0; 2]);
    bytes
}

/// Deflate without compression, so that writing it is no work.
fn stored(bytes: &[u8]) -> Vec<u8> {
    let length = u16::try_from(bytes.len()).expect("few");
    let sums = bytes.iter().fold((1_u32, 0_u32), |(a, b), &byte| {
        let a = (a + u32::from(byte)) % 65521;
        (a, (b + a) % 65521)
    });
    let mut packed = vec![0x78, 0x01, 1];
    packed.extend(length.to_le_bytes());
    packed.extend((!length).to_le_bytes());
    packed.extend(bytes);
    packed.extend((sums.1 << 16 | sums.0).to_be_bytes());
    packed
}

fn serialized() -> Vec<u8> {
    let mut mesh = 0x1000_u32.to_le_bytes().to_vec();
    mesh.extend(b"name\0");
    mesh.extend([3_u64, 1].iter().flat_map(|n| n.to_le_bytes()));
    mesh.extend([0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].iter().flat_map(|f| f.to_le_bytes()));
    mesh.extend([0_u32, 1, 2].iter().flat_map(|i| i.to_le_bytes()));
    [&[0x1c, 0x04, 4, 0], &stored(&mesh)[..]].concat()
}

fn png() -> Vec<u8> {
    let crc = |bytes: &[u8]| {
        !bytes.iter().fold(!0_u32, |crc, byte| {
            (0..8)
                .fold(crc ^ u32::from(*byte), |c, _| if c & 1 == 1 { (c >> 1) ^ 0xedb8_8320 } else { c >> 1 })
        })
    };
    let chunk = |kind: &[u8], data: &[u8]| {
        let body = [kind, data].concat();
        [&u32::try_from(data.len()).expect("few").to_be_bytes()[..], &body, &crc(&body).to_be_bytes()]
            .concat()
    };
    let header = [0, 0, 0, 2, 0, 0, 0, 1, 8, 2, 0, 0, 0];
    let rows = stored(&[0, 255, 0, 0, 0, 0, 255]);
    [&b"\x89PNG\r\n\x1a\n"[..], &chunk(b"IHDR", &header), &chunk(b"IDAT", &rows), &chunk(b"IEND", &[])]
        .concat()
}

fn with(bytes: &[u8], at: usize, value: u8) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    bytes[at] = value;
    bytes
}

fn files() -> Vec<File> {
    let ply = |format: &str, body: &[u8]| [PLY.replace("FORMAT", format).as_bytes(), body].concat();
    let ascii = ply("ascii", b"0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    let pnm = b"P6 2 1 255\n\xff\0\0\0\0\xff".to_vec();
    let hdr = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n\x80\x80\x80\x81".to_vec();
    vec![
        ("obj", OBJ.to_vec(), true),
        ("obj", OBJ[..56].to_vec(), false),
        ("obj", b"v 1 2\nf a/b 9 \\\n-9 \xff\nv nan 1 1\nvn x\n".to_vec(), false),
        ("ply", ascii.clone(), true),
        ("ply", ascii[..ascii.len() - 6].to_vec(), false),
        ("ply", ply("binary_little_endian", &numbers(false)), true),
        ("ply", ply("binary_big_endian", &numbers(true)), true),
        ("ply", ply("binary_big_endian", &numbers(false)), false),
        ("ply", ply("binary_little_endian", &numbers(false)[..40]), false),
        ("stl", STL.to_vec(), true),
        ("stl", STL[..70].to_vec(), false),
        ("stl", binary_stl(), true),
        ("stl", with(&binary_stl(), 80, 9), false),
        ("serialized", serialized(), true),
        ("serialized", with(&serialized(), 12, 200), false),
        ("serialized", serialized()[..40].to_vec(), false),
        ("bitmap", png(), true),
        ("bitmap", png()[..50].to_vec(), false),
        ("bitmap", with(&png(), 16, 200), false),
        ("bitmap", pnm, true),
        ("bitmap", hdr.clone(), true),
        ("bitmap", hdr[..hdr.len() - 3].to_vec(), false),
        ("spectrum", b"400 0.1\n700 0.2\n".to_vec(), true),
        ("spectrum", b"400 1\n700\n".to_vec(), false),
        ("include", b"<bsdf version='3.0.0' type='diffuse'/>".to_vec(), true),
        ("include", b"<bsdf version='3.0.0' type='diffuse'>".to_vec(), false),
    ]
}

#[test]
fn every_reader_ends_on_small_inputs() {
    for (i, (kind, bytes, is_good)) in files().into_iter().enumerate() {
        let inside = match kind {
            "bitmap" => "<texture type='bitmap'><string name='filename' value='f'/></texture>".to_owned(),
            "spectrum" => {
                "<bsdf type='diffuse'><spectrum name='reflectance' filename='f'/></bsdf>".to_owned()
            }
            "include" => "<include filename='f'/>".to_owned(),
            mesh => format!("<shape type='{mesh}'><string name='filename' value='f'/></shape>"),
        };
        let xml = format!("<scene version='3.0.0'><sensor type='perspective'/>{inside}</scene>");
        let files = |_: &Path| Ok(bytes.clone());
        let read = read_str("s.xml", &xml, &files, &Options::default());
        assert_eq!(read.is_ok(), is_good, "{i}: {kind}: {:?}", read.err());
    }
}

#[test]
fn scenes_of_a_few_bytes_are_read_or_refused() {
    let no_files = |_: &Path| Err(io::ErrorKind::NotFound.into());
    for (xml, is_good) in [
        ("<scene version='3.0.0'/>", true),
        ("\u{feff}<!-- c --><scene version='0.6.0'><default name='a' value='$b'/></scene>", false),
        (
            "<scene version='3.0.0'><default name='a' value='2'/><shape type='sphere'><float name='radius' value='$a'/></shape></scene>",
            true,
        ),
        (
            "<scene version='3.0.0'><shape type='cube' id='c'><ref id='d'/></shape><bsdf type='plastic' id='d'/></scene>",
            true,
        ),
        (
            "<scene version='3.0.0'><shape type='cube' id='c'><ref id='c'/></shape><bsdf type='plastik'/></scene>",
            false,
        ),
        (
            "<scene version='3.0.0'><sensor type='perspective'><transform name='to_world'><lookat origin='0 0 1' target='0 0 0' up='0 1 0'/></transform></sensor></scene>",
            true,
        ),
        ("<scene version='3.0.0'>&amp;&#65;&#x1F980;<![CDATA[<]]></scene>", true),
        ("<scene version='3.0.0'>&x;</scene>", false),
        ("<!DOCTYPE a [<!ENTITY b 'cc'>]><a>&b;</a>", false),
        ("<scene version='3.0.0", false),
        ("", false),
    ] {
        assert_eq!(read_str("s.xml", xml, &no_files, &Options::default()).is_ok(), is_good, "{xml}");
    }
}
