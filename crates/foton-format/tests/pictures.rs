//! Picture files as textures: the formats that programs write, and files that end too early.

use std::io::{self, Cursor};
use std::path::Path;
use std::sync::Arc;

use foton_format::{Options, read_str};
use foton_math::Rgb;
use foton_scene::description::{Bitmap, TextureKind};
use image::ImageFormat;

/// What a texture of a file is, and what is warned of; or the errors.
fn read(name: &str, bytes: &[u8]) -> Result<(Arc<Bitmap>, Vec<String>), String> {
    let files = |path: &Path| match path.to_str() {
        Some(found) if found == name => Ok(bytes.to_vec()),
        _ => Err(io::ErrorKind::NotFound.into()),
    };
    let xml = format!(
        "<scene version='3.0.0'><sensor type='perspective'/>\
         <texture type='bitmap'><string name='filename' value='{name}'/></texture></scene>"
    );
    let opened = read_str("s.xml", &xml, &files, &Options::default()).map_err(|error| error.to_string())?;
    let warnings = opened.warnings.iter().map(ToString::to_string).collect();
    match &opened.description.textures[0].kind {
        TextureKind::Bitmap { bitmap, .. } => Ok((Arc::clone(bitmap), warnings)),
        other => panic!("{other:?}"),
    }
}

/// Three by two pixels of different colours.
fn shades() -> image::RgbImage {
    image::RgbImage::from_fn(3, 2, |x, y| image::Rgb([x as u8 * 100, y as u8 * 200, 50]))
}

fn written(format: ImageFormat) -> Vec<u8> {
    let mut bytes = Vec::new();
    shades().write_to(&mut Cursor::new(&mut bytes), format).unwrap();
    bytes
}

#[test]
fn every_format_has_the_colours_of_a_png() {
    let (wanted, _) = read("t.png", &written(ImageFormat::Png)).unwrap();
    let text = shades().pixels().fold("P3\n# made by hand\n3 2\n255\n".to_owned(), |text, p| {
        format!("{text}{} {} {}\n", p[0], p[1], p[2])
    });
    let in_255 = |c: f64| ((c + 0.055) / 1.055).powf(2.4) as f32;
    assert!((wanted.pixels[1].r - in_255(100.0 / 255.0)).abs() < 1e-6, "sRGB");
    let tga = written(ImageFormat::Tga);
    let marked = [&tga[..], &[0; 8], b"TRUEVISION-XFILE.\0"].concat();
    for (name, bytes) in [
        ("t.bmp", written(ImageFormat::Bmp)),
        ("t.tga", tga.clone()),
        ("T.TGA", tga.clone()),
        ("t", marked),
        ("t.ppm", written(ImageFormat::Pnm)),
        ("t.ppm", text.into_bytes()),
        ("misnamed.jpg", written(ImageFormat::Bmp)),
    ] {
        let (found, warnings) = read(name, &bytes).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert_eq!((found.width, found.height, &found.pixels), (3, 2, &wanted.pixels), "{name}");
        assert!(warnings.is_empty(), "{name}: {warnings:?}");
    }
    // A grey map and a black and white one.
    let grey = read("t.pgm", b"P2 2 1 100 0 100").unwrap().0;
    assert_eq!(grey.pixels, [Rgb::BLACK, Rgb::WHITE]);
    let bits = read("t.pbm", b"P1 2 1 0 1").unwrap().0;
    assert_eq!(bits.pixels, [Rgb::WHITE, Rgb::BLACK]);
    assert!(
        read("t.dds", &tga).unwrap_err().contains("it is no PNG, JPEG, WebP, BMP, TGA, PNM"),
        "no mark, no name"
    );
}

#[test]
fn radiance_files_may_have_other_names() {
    // One pixel of three shared exponents: 128/256 · 2 in red, and halves of it.
    for name in ["#?RADIANCE", "#?RGBE", "#?made by hand"] {
        let file =
            [name.as_bytes(), b"\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n", &[128, 64, 32, 129]].concat();
        let (found, warnings) = read("t.hdr", &file).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert!(warnings.is_empty(), "{warnings:?}");
        assert_eq!(found.pixels, [Rgb::new(1.0, 0.5, 0.25)], "{name}");
    }
}

#[test]
fn a_jpeg_that_ends_early_is_read_as_far_as_it_goes_and_that_is_said() {
    let mut bytes = Vec::new();
    let red = image::RgbImage::from_fn(128, 128, |x, y| image::Rgb([200, (x * y) as u8, 0]));
    red.write_to(&mut Cursor::new(&mut bytes), ImageFormat::Jpeg).unwrap();
    let (whole, warnings) = read("t.jpg", &bytes).unwrap();
    assert!(warnings.is_empty(), "{warnings:?}");
    let cut = bytes.len() * 3 / 4;
    let (found, warnings) = read("t.jpg", &bytes[..cut]).unwrap();
    assert_eq!(warnings, ["s.xml:1:106: t.jpg ends before its picture does: what is missing has no detail"]);
    assert_eq!((found.width, found.height, found.pixels[0]), (128, 128, whole.pixels[0]));
    let (_, warnings) = read("t.jpg", &bytes[..bytes.len() - 2]).unwrap();
    assert_eq!(warnings.len(), 1);
    assert!(read("t.jpg", &bytes[..100]).is_err(), "no picture at all");
}

#[test]
fn other_pictures_that_end_early_are_errors() {
    for (name, format) in [
        ("t.png", ImageFormat::Png),
        ("t.bmp", ImageFormat::Bmp),
        ("t.tga", ImageFormat::Tga),
        ("t.ppm", ImageFormat::Pnm),
    ] {
        let bytes = written(format);
        assert!(read(name, &bytes).is_ok(), "{name}");
        let error = read(name, &bytes[..bytes.len() - 12]).expect_err(name);
        assert!(error.contains(&format!("cannot read {name}: ")), "{name}: {error}");
    }
    // Headers that claim what cannot be there.
    let lies = [
        ("t.ppm", b"P6 16384 16384 255\n0000".to_vec()),
        ("t.tga", [&[0, 0, 2][..], &[0; 9], &[0, 64, 0, 64, 24, 0, 1, 2, 3]].concat()),
    ];
    for (name, bytes) in lies {
        let error = read(name, &bytes).expect_err(name);
        assert!(error.contains("16384 × 16384 pixels cannot be in"), "{name}: {error}");
    }
}

#[test]
fn damaged_pictures_are_read_or_refused_without_panic() {
    let formats = [
        ("t.bmp", ImageFormat::Bmp),
        ("t.tga", ImageFormat::Tga),
        ("t.ppm", ImageFormat::Pnm),
        ("t.jpg", ImageFormat::Jpeg),
    ];
    let wholes = formats.map(|(name, format)| (name, written(format)));
    let mut state = 1_u64;
    let mut random = |below: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (state >> 33) as usize % below
    };
    for round in 0..4000 {
        let (name, whole) = &wholes[round % wholes.len()];
        let mut bytes = whole.clone();
        for _ in 0..=random(4) {
            let at = random(bytes.len());
            match random(4) {
                0 => bytes.truncate(at + 1),
                // Headers say what may be believed.
                1 => bytes[at.min(30)] = random(256) as u8,
                2 => bytes[at] = random(256) as u8,
                _ => bytes.push(0),
            }
        }
        let _ = read(name, &bytes);
    }
}
