//! EXR files: what comes back is what went in, bit for bit, and equal input gives equal bytes.

mod common;

use std::fs;

use common::Folder;
use exr::prelude::{FlatSamples, read_first_flat_layer_from_file};
use foton_film::{
    ContentError, Image, Layer, LayerData, Metadata, MetadataError, Plane, ReadError, WriteError, read_exr,
    write_exr,
};
use foton_math::Rgb;

/// Values that a careless path would change: NaN with a payload, a negative NaN, infinities, denormals, −0.
const AWKWARD: [u32; 9] = [
    0x7fc1_2345,
    0xffc0_0001,
    0x7f80_0000,
    0xff80_0000,
    0x0000_0001,
    0x807f_ffff,
    0x8000_0000,
    0x7f7f_ffff,
    0x3f80_0001,
];

/// 21 × 37 pixels that differ by `key`, with every awkward value.
fn image(key: u32) -> Image {
    let value = |i: u32| match AWKWARD.get(i as usize) {
        Some(&bits) => f32::from_bits(bits),
        None => (i.wrapping_mul(2_654_435_761) ^ key) as f32 * 1e-7,
    };
    let pixels = (0..21 * 37).map(|i| Rgb::new(value(i), value(i + 3), value(i + 5))).collect();
    Image { width: 21, height: 37, pixels }
}

fn bits(values: impl IntoIterator<Item = f32>) -> Vec<u32> {
    values.into_iter().map(f32::to_bits).collect()
}

fn rgb_bits(image: &Image) -> Vec<u32> {
    bits(image.pixels.iter().flat_map(|c| c.to_array()))
}

fn layers() -> Vec<Layer> {
    let radius = (0..21 * 37).map(|i| f32::from_bits(AWKWARD[i % AWKWARD.len()])).collect();
    let count = (0..21 * 37).map(|i| u32::MAX - i).collect();
    let layer = |name: &str, channels| Layer { name: name.into(), channels };
    vec![
        layer("direct", LayerData::Rgb(image(1))),
        layer("caustic", LayerData::Rgb(image(2))),
        layer("radius", LayerData::F32(Plane { width: 21, height: 37, values: radius })),
        layer("photon_count", LayerData::U32(Plane { width: 21, height: 37, values: count })),
    ]
}

fn metadata() -> Metadata {
    let mut metadata = Metadata::default();
    for i in 0..40 {
        metadata.set(format!("foton:key_{}", (i * 7) % 40), i);
    }
    metadata.set("foton:scene", "scènes/日本.xml");
    metadata.set("foton:changes", "12 alpha 0.7\n30 photons 1000000");
    metadata.set("foton:a_key_of_more_than_thirty_one_characters", "");
    metadata
}

#[test]
fn every_bit_of_an_image_comes_back() {
    let folder = Folder::new("bits");
    let path = folder.file("out.exr");
    for layers in [vec![], layers()] {
        write_exr(&path, &image(0), &layers, &Metadata::default()).unwrap();
        let (again, text) = read_exr(&path).unwrap();
        assert_eq!((again.width, again.height), (21, 37));
        assert_eq!(rgb_bits(&again), rgb_bits(&image(0)));
        assert_eq!(text, Metadata::default());
    }
}

#[test]
fn layers_become_prefixed_channels_with_every_bit() {
    let folder = Folder::new("layers");
    let path = folder.file("out.exr");
    write_exr(&path, &image(0), &layers(), &Metadata::default()).unwrap();
    let part = read_first_flat_layer_from_file(&path).unwrap().layer_data;
    let channels = &part.channel_data.list;
    let names: Vec<_> = channels.iter().map(|channel| channel.name.to_string()).collect();
    let expected = "B G R caustic.B caustic.G caustic.R direct.B direct.G direct.R photon_count.Y radius.Y";
    assert_eq!(names.join(" "), expected);
    let samples = |name: &str| &channels.iter().find(|channel| channel.name == *name).unwrap().sample_data;
    for layer in layers() {
        match layer.channels {
            LayerData::Rgb(image) => {
                let FlatSamples::F32(green) = samples(&format!("{}.G", layer.name)) else { panic!() };
                assert_eq!(bits(green.iter().copied()), bits(image.pixels.iter().map(|c| c.g)));
            }
            LayerData::F32(plane) => {
                let FlatSamples::F32(found) = samples("radius.Y") else { panic!("not floats") };
                assert_eq!(bits(found.iter().copied()), bits(plane.values));
            }
            LayerData::U32(plane) => {
                let FlatSamples::U32(found) = samples("photon_count.Y") else { panic!("not integers") };
                assert_eq!(*found, plane.values);
            }
        }
    }
}

#[test]
fn metadata_comes_back_in_its_order() {
    let folder = Folder::new("metadata");
    let path = folder.file("out.exr");
    write_exr(&path, &image(0), &[], &metadata()).unwrap();
    assert_eq!(read_exr(&path).unwrap().1, metadata());
}

#[test]
fn two_writes_give_the_same_bytes() {
    let folder = Folder::new("same");
    let write = |name: &str| {
        write_exr(&folder.file(name), &image(0), &layers(), &metadata()).unwrap();
        fs::read(folder.file(name)).unwrap()
    };
    let first = write("a.exr");
    for _ in 0..4 {
        assert!(write("b.exr") == first);
    }
    let elsewhere = std::thread::scope(|scope| {
        let jobs: Vec<_> = (0..4).map(|i| scope.spawn(move || write(&format!("{i}.exr")))).collect();
        jobs.into_iter().map(|job| job.join().unwrap()).collect::<Vec<_>>()
    });
    assert!(elsewhere.iter().all(|bytes| *bytes == first));
}

#[test]
fn setting_a_key_again_keeps_its_place() {
    let mut metadata: Metadata = [("a", 1), ("b", 2)].into_iter().collect();
    metadata.set("a", 3);
    assert_eq!(metadata.iter().collect::<Vec<_>>(), [("a", "3"), ("b", "2")]);
}

/// The reason for which the content is refused, after checking that nothing was written.
fn refusal(folder: &Folder, image: &Image, layers: &[Layer], metadata: &Metadata) -> ContentError {
    let path = folder.file("refused.exr");
    let error = write_exr(&path, image, layers, metadata).unwrap_err();
    assert!(error.to_string().contains("refused.exr: "), "{error}");
    assert!(folder.names().is_empty());
    let WriteError::Content { reason, .. } = error else { panic!("{error}") };
    reason
}

#[test]
fn content_that_does_not_fit_is_refused() {
    let folder = Folder::new("refused");
    let none = Metadata::default();
    let empty = Image::black(0, 3);
    assert_eq!(refusal(&folder, &empty, &[], &none), ContentError::Empty { width: 0, height: 3 });
    let short = Image { width: 2, height: 2, pixels: vec![Rgb::BLACK; 3] };
    let expected = ContentError::PixelCount { width: 2, height: 2, found: 3 };
    assert_eq!(refusal(&folder, &short, &[], &none), expected);
    let layer = |name: &str| Layer { name: name.into(), channels: LayerData::Rgb(image(0)) };
    let small = Image::black(2, 2);
    assert!(matches!(refusal(&folder, &small, &[layer("a")], &none), ContentError::LayerSize { .. }));
    assert!(matches!(refusal(&folder, &image(0), &[layer("")], &none), ContentError::LayerName { .. }));
    let twice = [layer("a"), layer("a")];
    assert!(matches!(refusal(&folder, &image(0), &twice, &none), ContentError::LayerTwice { .. }));
}

#[test]
fn keys_that_a_format_cannot_carry_are_refused() {
    let folder = Folder::new("keys");
    let long = "k".repeat(80);
    for key in ["", "two words", "schlüssel", "a\0b", &long] {
        let metadata = [(key, 1)].into_iter().collect();
        let reason = refusal(&folder, &image(0), &[], &metadata);
        assert_eq!(reason, MetadataError::Key { key: key.into() }.into());
    }
    let reserved = [("owner", "me")].into_iter().collect();
    let reason = refusal(&folder, &image(0), &[], &reserved);
    assert_eq!(reason, MetadataError::Reserved { key: "owner".into() }.into());
    let nul = [("foton:a", "\0")].into_iter().collect();
    assert_eq!(refusal(&folder, &image(0), &[], &nul), MetadataError::Nul { key: "foton:a".into() }.into());
}

/// Writes two by two pixels of 0, 1, 2, 3 in each channel.
fn write_channels(path: &std::path::Path, names: &[&str]) {
    use exr::prelude::{AnyChannel, AnyChannels, WritableImage};
    let channel = |name: &&str| AnyChannel::new(*name, FlatSamples::F32(vec![0.0, 1.0, 2.0, 3.0]));
    let channels = AnyChannels::sort(names.iter().map(channel).collect());
    exr::prelude::Image::from_channels((2, 2), channels).write().to_file(path).unwrap();
}

#[test]
fn files_without_rgb_say_what_they_have() {
    let folder = Folder::new("depth");
    let path = folder.file("depth.exr");
    for (names, wanted) in [(&["Z"][..], "Z"), (&["Y", "RY", "BY"], "BY, RY, Y"), (&["R", "G"], "G, R")] {
        write_channels(&path, names);
        let error = read_exr(&path).unwrap_err();
        assert!(matches!(&error, ReadError::NoRgb { channels, .. } if channels == wanted), "{error}");
    }
}

#[test]
fn a_luminance_alone_is_grey() {
    let folder = Folder::new("luminance");
    let path = folder.file("y.exr");
    for names in [&["Y"][..], &["A", "Y", "Z"]] {
        write_channels(&path, names);
        let (image, _) = read_exr(&path).unwrap();
        assert_eq!(image.pixels, [0.0, 1.0, 2.0, 3.0].map(Rgb::splat), "{names:?}");
    }
}

#[test]
fn broken_files_are_errors_and_not_panics() {
    let folder = Folder::new("broken");
    let path = folder.file("broken.exr");
    assert!(matches!(read_exr(&path).unwrap_err(), ReadError::Io { .. }));
    write_exr(&path, &image(0), &[], &metadata()).unwrap();
    let whole = fs::read(&path).unwrap();
    for length in (0..whole.len()).step_by(97) {
        fs::write(&path, &whole[..length]).unwrap();
        let error = read_exr(&path).unwrap_err();
        assert!(matches!(error, ReadError::Malformed { .. }), "{length}: {error}");
    }
}

#[test]
fn a_header_that_claims_too_many_pixels_is_an_error() {
    let folder = Folder::new("huge");
    let path = folder.file("huge.exr");
    write_exr(&path, &image(0), &[], &Metadata::default()).unwrap();
    let mut bytes = fs::read(&path).unwrap();
    let window = b"dataWindow\0box2i\0";
    let at = bytes.windows(window.len()).position(|w| w == window).unwrap() + window.len() + 4;
    bytes[at + 8..at + 12].copy_from_slice(&1_000_000_000_i32.to_le_bytes());
    fs::write(&path, &bytes).unwrap();
    let error = read_exr(&path).unwrap_err();
    assert!(error.to_string().contains("cannot be in"), "{error}");
}
