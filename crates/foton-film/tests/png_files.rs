//! PNG files: the documented 8-bit values, the sRGB mark and the metadata.

mod common;

use std::fs::{self, File};
use std::io::BufReader;
use std::path::Path;

use common::Folder;
use foton_film::{Image, Metadata, ReadError, ToneMap, read_png, tone_map, write_png};
use foton_math::Rgb;

/// The header and the pixels, three bytes each.
fn decode(path: &Path) -> (png::Info<'static>, Vec<u8>) {
    let mut reader = png::Decoder::new(BufReader::new(File::open(path).unwrap())).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut pixels).unwrap();
    (reader.info().clone(), pixels)
}

fn image() -> Image {
    let pixels = vec![
        Rgb::new(0.0, 0.25, 0.5),
        Rgb::new(1.0, 2.0, -1.0),
        Rgb::splat(0.75),
        Rgb::new(f32::NAN, 0.5, 0.5),
        Rgb::new(0.0, f32::INFINITY, 0.0),
        Rgb::new(0.0, 0.0, f32::NEG_INFINITY),
    ];
    Image { width: 2, height: 3, pixels }
}

#[test]
fn linear_pixels_are_clipped_srgb_from_the_top_left() {
    let folder = Folder::new("linear");
    let path = folder.file("out.png");
    write_png(&path, &image(), ToneMap::Linear, 0.0, &Metadata::default()).unwrap();
    let (info, pixels) = decode(&path);
    assert_eq!((info.width, info.height), (2, 3));
    let magenta = [255, 0, 255];
    let expected = [[0, 137, 188], [255, 255, 0], [225, 225, 225], magenta, magenta, magenta];
    assert_eq!(pixels, expected.as_flattened());
}

#[test]
fn every_pixel_is_what_display_says() {
    let folder = Folder::new("display");
    let path = folder.file("out.png");
    for (tone_map, stops) in [(ToneMap::PbrNeutral, 0.0), (ToneMap::PbrNeutral, 1.5), (ToneMap::Linear, -2.0)]
    {
        write_png(&path, &image(), tone_map, stops, &Metadata::default()).unwrap();
        let shown = |&c: &Rgb| tone_map::display(c, tone_map, stops);
        let expected: Vec<u8> = image().pixels.iter().flat_map(shown).collect();
        assert_eq!(decode(&path).1, expected);
    }
}

#[test]
fn the_file_says_that_it_is_srgb() {
    let folder = Folder::new("srgb");
    let path = folder.file("out.png");
    write_png(&path, &image(), ToneMap::default(), 0.0, &Metadata::default()).unwrap();
    let (info, _) = decode(&path);
    assert_eq!(info.srgb, Some(png::SrgbRenderingIntent::Perceptual));
    assert_eq!(info.gama_chunk.map(png::ScaledFloat::into_scaled), Some(45455));
    assert_eq!((info.color_type, info.bit_depth), (png::ColorType::Rgb, png::BitDepth::Eight));
}

#[test]
fn metadata_stands_in_text_chunks() {
    let folder = Folder::new("text");
    let path = folder.file("out.png");
    let mut metadata = Metadata::default();
    metadata.set("foton:passes", 64);
    metadata.set("foton:scene", "日本.xml");
    metadata.set("foton:changes", "12 alpha 0.7\n30 photons 1000000 (é)");
    write_png(&path, &image(), ToneMap::default(), 0.0, &metadata).unwrap();
    let (info, _) = decode(&path);
    let latin1: Metadata =
        info.uncompressed_latin1_text.iter().map(|chunk| (chunk.keyword.as_str(), &chunk.text)).collect();
    assert_eq!(latin1.get("foton:passes"), Some("64"));
    assert_eq!(latin1.get("foton:changes"), metadata.get("foton:changes"));
    assert_eq!(info.utf8_text[0].keyword, "foton:scene");
    assert_eq!(info.utf8_text[0].get_text().unwrap(), "日本.xml");
}

#[test]
fn two_writes_give_the_same_bytes() {
    let folder = Folder::new("png-same");
    let write = |name: &str| {
        let metadata = [("foton:a", 1), ("foton:b", 2)].into_iter().collect();
        write_png(&folder.file(name), &image(), ToneMap::default(), 0.0, &metadata).unwrap();
        fs::read(folder.file(name)).unwrap()
    };
    assert_eq!(write("a.png"), write("b.png"));
}

#[test]
fn an_image_without_pixels_is_refused() {
    let folder = Folder::new("png-empty");
    let path = folder.file("out.png");
    let error = write_png(&path, &Image::black(0, 0), ToneMap::default(), 0.0, &Metadata::default());
    let message = error.unwrap_err().to_string();
    assert!(message.ends_with("out.png: an image of 0 × 0 pixels has nothing to store"), "{message}");
    assert!(folder.names().is_empty());
}

/// Writes samples as they are, to read files that we do not write.
fn encode(path: &Path, color: png::ColorType, depth: png::BitDepth, palette: &[u8], samples: &[u8]) {
    let mut encoder = png::Encoder::new(File::create(path).unwrap(), 2, 1);
    encoder.set_color(color);
    encoder.set_depth(depth);
    if !palette.is_empty() {
        encoder.set_palette(palette);
    }
    encoder.write_header().unwrap().write_image_data(samples).unwrap();
}

#[test]
fn a_clipped_picture_comes_back_to_half_a_step_of_255() {
    let folder = Folder::new("png-back");
    let path = folder.file("out.png");
    let pixels = (0..=255u8).map(|v| Rgb::new(f32::from(v) / 255.0, 1.5, -1.0)).collect();
    let image = Image { width: 16, height: 16, pixels };
    write_png(&path, &image, ToneMap::Linear, 0.0, &Metadata::default()).unwrap();
    let again = read_png(&path).unwrap();
    assert_eq!((again.width, again.height), (16, 16));
    for (read, written) in again.pixels.iter().zip(&image.pixels) {
        assert_eq!((read.g, read.b), (1.0, 0.0));
        let steps = 255.0 * (tone_map::srgb_encode(read.r) - tone_map::srgb_encode(written.r));
        assert!(steps.abs() <= 0.5001, "{read:?} for {written:?}");
    }
}

#[test]
fn grey_palettes_transparency_and_sixteen_bits_are_read() {
    let folder = Folder::new("png-kinds");
    let path = folder.file("in.png");
    // sRGB 188 is 0.5029 linear (the table of IEC 61966-2-1), and 0x0A0A of 0xFFFF is 10/255 on the linear toe.
    let half = |v: f32| (v - 0.502_9).abs() < 1e-4;
    let toe = |v: f32| (v - 10.0 / 255.0 / 12.92).abs() < 1e-7;
    use png::{BitDepth, ColorType};

    encode(&path, ColorType::GrayscaleAlpha, BitDepth::Eight, &[], &[188, 0, 255, 7]);
    let image = read_png(&path).unwrap();
    assert!(half(image.pixels[0].r) && half(image.pixels[0].b) && image.pixels[1] == Rgb::WHITE);

    encode(&path, ColorType::Indexed, BitDepth::One, &[0, 0, 0, 255, 0, 188], &[0b0100_0000]);
    let image = read_png(&path).unwrap();
    assert!(image.pixels[0] == Rgb::BLACK && image.pixels[1].r == 1.0 && half(image.pixels[1].b));

    let samples = [10, 10, 0, 0, 255, 255, 0, 0, 10, 10, 0, 0];
    encode(&path, ColorType::Rgb, BitDepth::Sixteen, &[], &samples);
    let image = read_png(&path).unwrap();
    assert!(toe(image.pixels[0].r) && image.pixels[0].b == 1.0 && toe(image.pixels[1].g), "{image:?}");
}

#[test]
fn a_broken_picture_is_refused_with_its_name() {
    let folder = Folder::new("png-broken");
    let path = folder.file("in.png");
    assert!(matches!(read_png(&path).unwrap_err(), ReadError::Io { .. }));
    write_png(&path, &image(), ToneMap::Linear, 0.0, &Metadata::default()).unwrap();
    let whole = fs::read(&path).unwrap();
    for length in [0, 7, 20, 60, whole.len() / 2] {
        fs::write(&path, &whole[..length]).unwrap();
        let message = read_png(&path).unwrap_err().to_string();
        assert!(message.contains("in.png as PNG: "), "{length}: {message}");
    }
}

#[test]
fn decoding_undoes_encoding() {
    for step in 0..=1000u16 {
        let v = f32::from(step) / 1000.0;
        assert!((tone_map::srgb_decode(tone_map::srgb_encode(v)) - v).abs() < 1e-6, "{v}");
    }
    assert_eq!((tone_map::srgb_decode(0.0), tone_map::srgb_decode(1.0)), (0.0, 1.0));
}
