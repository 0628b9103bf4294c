//! What a person reads when a file is wrong: the exact message and place of each problem.

mod parts;
mod strangers;
mod textures;

use std::io;
use std::path::Path;

use foton_format::{Options, Severity, read_str};

/// A PNG file that claims to be `size` × `size` pixels large.
fn png(size: u32) -> Vec<u8> {
    let mut bytes = Vec::new();
    image::RgbImage::from_pixel(1, 1, image::Rgb([255, 0, 0]))
        .write_to(&mut io::Cursor::new(&mut bytes), image::ImageFormat::Png)
        .unwrap();
    if size != 1 {
        bytes[16..20].copy_from_slice(&size.to_be_bytes());
        bytes[20..24].copy_from_slice(&size.to_be_bytes());
        let crc = crc32(&bytes[12..29]);
        bytes[29..33].copy_from_slice(&crc.to_be_bytes());
    }
    bytes
}

/// The checksum of PNG chunks.
fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0_u32, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |c, _| if c & 1 == 1 { (c >> 1) ^ 0xedb8_8320 } else { c >> 1 })
    })
}

/// Some files that are fine, and many that are not.
fn files(path: &Path) -> io::Result<Vec<u8>> {
    let text = |text: &str| Ok(text.as_bytes().to_vec());
    match path.to_str() {
        Some("bad.obj") => Ok(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n".to_vec()),
        Some("good.obj") => Ok(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n".to_vec()),
        Some("red.png") => Ok(png(1)),
        Some("wide.png") => Ok(png(65_536)),
        Some("lying.png") => Ok(png(16_384)),
        Some("latin.xml") => Ok(b"<scene version='3.0.0'><!-- caf\xe9 --></scene>".to_vec()),
        Some("empty.exr") => Ok(vec![0x76, 0x2f, 0x31, 0x01]),
        Some("nan.hdr") => text("#?RADIANCE\n\n-Y 1"),
        Some("loop.xml") => text("<scene version='3.0.0'>\n<!-- -->\n<include filename='loop.xml'/></scene>"),
        Some("open.xml") => text("<scene version='3.0.0'>\n"),
        Some("future.xml") => text("<bsdf version='7.0.0' type='diffuse' id='a'/>"),
        Some("bare.xml") => text("<bsdf type='diffuse'/>"),
        Some("sub/bad.xml") => text(
            "<scene version='3.0.0'>\n<bsdf type='diffuse'>\n<float name='reflectance' value='x'/>\n</bsdf>\n<shape type='spere'/>\n</scene>",
        ),
        Some("twice.xml") => text("<scene version='3.0.0'>\n<bsdf type='diffuse' id='a'/>\n</scene>"),
        _ => Err(io::Error::new(io::ErrorKind::NotFound, "no such file")),
    }
}

/// Errors and warnings of a file, by place.
fn found(xml: &str, options: &Options) -> Vec<String> {
    let findings = match read_str("s.xml", xml, &files, options) {
        Ok(opened) => opened.warnings,
        Err(error) => error.diagnostics().to_vec(),
    };
    let text = |severity| if severity == Severity::Error { "" } else { "warning: " };
    findings.iter().map(|d| format!("{}{d}", text(d.severity))).collect()
}

/// Of a scene with a sensor in the first line; the snippet is the second.
fn problems(snippet: &str) -> Vec<String> {
    let xml = format!("<scene version='3.0.0'><sensor type='perspective'/>\n{snippet}\n</scene>");
    found(&xml, &Options::default())
}

fn assert_all(table: &[(&str, &[&str])]) {
    let wrong = table.iter().filter_map(|(snippet, wanted)| {
        let found = problems(snippet);
        (found != *wanted).then(|| format!("of {snippet}\n found {found:#?}\n wanted {wanted:#?}\n"))
    });
    let wrong: Vec<_> = wrong.collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn unknown_names_come_with_the_nearest_known_one() {
    assert_all(&[
        (
            "<bsdf type='dielectrc'/>",
            &["s.xml:2:13: unknown bsdf \"dielectrc\", did you mean \"dielectric\"?"],
        ),
        ("<bsdf type='velvet'/>", &["s.xml:2:13: unknown bsdf \"velvet\""]),
        ("<texture type='wireframe'/>", &["s.xml:2:16: texture \"wireframe\" is not supported yet"]),
        ("<shape type='spere'/>", &["s.xml:2:14: unknown shape \"spere\", did you mean \"sphere\"?"]),
        ("<shape type='sdfgrid'/>", &["s.xml:2:14: shape \"sdfgrid\" is not supported yet"]),
        (
            "<shape type='instance'/>",
            &["s.xml:2:1: an instance needs one shapegroup inside, or a reference to one"],
        ),
        ("<emitter type='collimated'/>", &["s.xml:2:16: emitter \"collimated\" is not supported yet"]),
        ("<emitter type='pont'/>", &["s.xml:2:16: unknown emitter \"pont\", did you mean \"point\"?"]),
        ("<sensor type='distant'/>", &["s.xml:2:15: sensor \"distant\" is not supported yet"]),
        ("<shap type='sphere'/>", &["s.xml:2:1: unknown element <shap>, did you mean \"shape\"?"]),
        (
            "<shape type='sphere'><float name='radus' value='2'/></shape>",
            &["warning: s.xml:2:35: unknown property \"radus\" of \"sphere\", did you mean \"radius\"?"],
        ),
        (
            "<shape type='sphere'><float name='colour' value='2'/></shape>",
            &["warning: s.xml:2:35: unknown property \"colour\" of \"sphere\""],
        ),
        (
            "<shape type='sphere'><float nam='radius' value='2'/></shape>",
            &["s.xml:2:29: unknown attribute \"nam\" of <float>, did you mean \"name\"?"],
        ),
        (
            "<bsdf type='diffuse' id='grey'/><shape type='cube'><ref id='gray'/></shape>",
            &["s.xml:2:61: unknown id \"gray\", did you mean \"grey\"?"],
        ),
        (
            "<default name='size' value='1'/><shape type='sphere'><float name='radius' value='$sise'/></shape>",
            &["s.xml:2:82: unknown parameter \"$sise\", did you mean \"$size\"?"],
        ),
        (
            "<bsdf type='dielectric'><string name='int_ior' value='watr'/></bsdf>",
            &["s.xml:2:55: no index of refraction is known for \"watr\", did you mean \"water\"?"],
        ),
        (
            "<integrator type='any'><integer name='max_dept' value='3'/><integer name='other' value='3'/></integrator>",
            &[
                "warning: s.xml:2:39: unknown property \"max_dept\" of \"integrator\", did you mean \"max_depth\"?",
            ],
        ),
    ]);
}

#[test]
fn values_out_of_range_are_errors() {
    let diffuse =
        |value: &str| format!("<bsdf type='diffuse'><rgb name='reflectance' value='{value}'/></bsdf>");
    let area = |value: &str| {
        format!(
            "<shape type='cube'><emitter type='area'><rgb name='radiance' value='{value}'/></emitter></shape>"
        )
    };
    let range = "s.xml:2:53: \"reflectance\" of \"diffuse\" must lie between 0 and 1";
    assert_all(&[
        (&diffuse("1.5"), &[range]),
        (&diffuse("0.1 -0.2 0.3"), &[range]),
        (&diffuse("nan"), &["s.xml:2:53: \"nan\" is not a finite number"]),
        (&diffuse("0.1 0.2"), &["s.xml:2:53: one or three numbers are needed, not 2"]),
        (&diffuse("#ff00"), &["s.xml:2:53: \"#ff00\" is not a colour such as #ff8000"]),
        (&area("-1"), &["s.xml:2:69: \"radiance\" must not be negative"]),
        (&area("1e39"), &["s.xml:2:69: \"1e39\" is too large"]),
        (
            "<bsdf type='diffuse'><float name='reflectance' value='2'/></bsdf>",
            &["s.xml:2:55: \"reflectance\" of \"diffuse\" must lie between 0 and 1"],
        ),
        (
            "<bsdf type='dielectric'><float name='int_ior' value='0'/></bsdf>",
            &["s.xml:2:54: an index of refraction must be above zero"],
        ),
        (
            "<shape type='sphere'><float name='radius' value='-1'/></shape>",
            &["s.xml:2:50: \"radius\" must be above zero"],
        ),
        (
            "<shape type='sphere'><float name='radius' value='2m'/></shape>",
            &["s.xml:2:50: \"2m\" is not a number"],
        ),
    ]);
}

#[test]
fn sensors_and_lights_out_of_range_are_errors() {
    assert_all(&[
        (
            "<sensor type='perspective'><float name='fov' value='180'/></sensor>",
            &["s.xml:2:53: \"fov\" must lie between 0 and 180 degrees"],
        ),
        (
            "<sensor type='perspective'><float name='fov' value='45deg'/></sensor>",
            &["s.xml:2:53: \"45deg\" is not a number"],
        ),
        (
            "<sensor type='perspective'><string name='fov_axis' value='z'/></sensor>",
            &["s.xml:2:59: \"fov_axis\" must be x, y, diagonal, smaller or larger"],
        ),
        (
            "<sensor type='perspective'><float name='near_clip' value='2'/><float name='far_clip' value='1'/></sensor>",
            &["s.xml:2:93: \"far_clip\" must be farther than \"near_clip\""],
        ),
        (
            "<sensor type='perspective'><transform name='to_world'><scale x='2'/></transform></sensor>",
            &["s.xml:2:28: the transform of a camera must not scale or shear"],
        ),
        (
            "<sensor type='orthographic'><transform name='to_world'><matrix value='1 1 0 0  0 1 0 0  0 0 1 0  0 0 0 1'/></transform></sensor>",
            &["s.xml:2:29: the transform of a camera must not shear"],
        ),
        (
            "<sensor type='perspective'><film type='hdrfilm'><integer name='width' value='0'/></film></sensor>",
            &["s.xml:2:78: \"width\" must lie between 1 and 65536 pixels"],
        ),
        (
            "<sensor type='perspective'><film type='hdrfilm'><integer name='crop_width' value='9'/></film></sensor>",
            &[],
        ),
        (
            "<sensor type='perspective'><film type='hdrfilm'><integer name='width' value='9'/><integer name='crop_width' value='9'/><integer name='crop_offset_x' value='1'/></film></sensor>",
            &["s.xml:2:116: the crop reaches from 1 over 9 pixels, but the image has 9"],
        ),
        (
            "<integrator type='path'><integer name='max_depth' value='-2'/></integrator>",
            &["s.xml:2:58: \"max_depth\" must be -1 (no bound), 0 or more"],
        ),
        (
            "<emitter type='spot'><float name='cutoff_angle' value='0'/></emitter>",
            &["s.xml:2:56: \"cutoff_angle\" must be above 0 and at most 180 degrees"],
        ),
        (
            "<emitter type='spot'><transform name='to_world'><scale x='-2' z='0.3'/></transform></emitter>",
            &[
                "s.xml:2:22: a spot can be turned, moved and scaled evenly, but not stretched or sheared: its cone must stay round",
            ],
        ),
        (
            "<emitter type='spot'><float name='beam_width' value='30'/></emitter>",
            &["warning: s.xml:2:54: \"beam_width\" is larger than \"cutoff_angle\" (20) and is cut to it"],
        ),
    ]);
}

#[test]
fn transforms_that_cannot_be_are_errors() {
    let on = |shape: &str, steps: &str| {
        format!("<shape type='{shape}'><transform name='to_world'>{steps}</transform></shape>")
    };
    assert_all(&[
        (&on("cube", "<scale z='0'/>"), &["s.xml:2:20: the transform is singular: it flattens everything"]),
        (&on("disk", "<scale z='2'/>"), &[]),
        (
            &on("cube", "<rotat x='1' angle='2'/>"),
            &["s.xml:2:47: unknown step <rotat> of a transform, did you mean \"rotate\"?"],
        ),
        (&on("cube", "<rotate x='1' angle='1.57rad'/>"), &["s.xml:2:68: \"1.57rad\" is not a number"]),
        (&on("cube", "<rotate x='1' angle='nan'/>"), &["s.xml:2:68: \"nan\" is not a finite number"]),
        (&on("cube", "<translate x='1e400'/>"), &["s.xml:2:61: \"1e400\" is not a finite number"]),
        (&on("cube", "<rotate x='1'/>"), &["s.xml:2:47: <rotate> needs the attribute \"angle\""]),
        (&on("cube", "<rotate angle='2'/>"), &["s.xml:2:47: a rotation needs an axis other than zero"]),
        (
            &on("cube", "<rotate value='1 1 0' angle='2'/>"),
            &[
                "warning: s.xml:2:47: the axis has length 1.4142, not 1; it is scaled here, but not in Mitsuba",
            ],
        ),
        (&on("cube", "<matrix value='1 2 3'/>"), &["s.xml:2:62: a matrix has 9 or 16 numbers, not 3"]),
        (
            &on("cube", "<matrix value='1 0 0 0 0 1 0 0 0 0 1 0 0 0 1 1'/>"),
            &["s.xml:2:62: the last row of a 4×4 matrix must be 0 0 0 1"],
        ),
        (
            &on("cube", "<lookat origin='1 1 1' target='1 1 1'/>"),
            &["s.xml:2:47: the origin and the target of this lookat are the same point"],
        ),
        (
            &on("cube", "<lookat origin='0 1 0' target='0 0 0' up='0 1 0'/>"),
            &["s.xml:2:47: the up vector of this lookat is parallel to its direction"],
        ),
        (
            &on("cube", "<translate value='1' x='2'/>"),
            &["s.xml:2:68: <translate> has both \"value\" and \"x\""],
        ),
        (
            "<sensor type='perspective'><transform name='to_world'><scale value='2'/></transform></sensor>",
            &["s.xml:2:28: the transform of a camera must not scale or shear"],
        ),
    ]);
}

#[test]
fn plugins_in_the_wrong_place_or_number_are_errors() {
    assert_all(&[
        (
            "<bsdf type='twosided'><bsdf type='dielectric'/></bsdf>",
            &["s.xml:2:23: a dielectric transmits light and cannot stand inside a twosided bsdf"],
        ),
        ("<bsdf type='twosided'/>", &["s.xml:2:1: a twosided bsdf needs one or two bsdfs inside, not 0"]),
        (
            "<bsdf type='twosided' id='a'><ref id='a'/></bsdf>",
            &["s.xml:2:39: this bsdf is made of itself, or of too long a chain of others"],
        ),
        (
            "<shape type='cube'><bsdf type='diffuse'/><bsdf type='diffuse'/></shape>",
            &["s.xml:2:42: a shape has only one bsdf"],
        ),
        (
            "<shape type='cube'><emitter type='point'/></shape>",
            &["s.xml:2:20: only an area emitter can stand inside a shape, not a point emitter"],
        ),
        (
            "<emitter type='area'/>",
            &["warning: s.xml:2:1: this area emitter belongs to no shape and lights nothing"],
        ),
        (
            "<emitter type='constant'/><emitter type='constant'/>",
            &["s.xml:2:27: a scene has only one emitter around it"],
        ),
        (
            "<bsdf type='diffuse' id='a'/><bsdf type='diffuse' id='a'/>",
            &["s.xml:2:55: the id \"a\" is taken since line 2"],
        ),
        (
            "<shape type='sphere'><float name='radius' value='1'/><float name='radius' value='2'/></shape>",
            &["s.xml:2:54: \"radius\" of \"sphere\" is given twice"],
        ),
        (
            "<shape type='sphere'><string name='radius' value='1'/></shape>",
            &["s.xml:2:22: \"radius\" of \"sphere\" must be given as <float>, not <string>"],
        ),
        (
            "<shape type='cube'><boolean name='flip_normals' value='yes'/></shape>",
            &["s.xml:2:56: \"yes\" is neither \"true\" nor \"false\""],
        ),
        (
            "<integrator type='path'><boolean name='hide_emitters' value='true'/></integrator>",
            &["warning: s.xml:2:62: \"hide_emitters\" is not supported, emitters stay visible"],
        ),
    ]);
}
