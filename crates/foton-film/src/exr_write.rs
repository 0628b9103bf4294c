//! EXR files: linear 32-bit floats as R, G, B, further layers as prefixed channels, metadata as text attributes.

use std::io::{Cursor, Write};
use std::path::Path;

use exr::prelude::{
    AnyChannel, AnyChannels, AttributeValue, Blocks, Compression, Encoding, FlatSamples, LayerAttributes,
    LineOrder, Text, WritableImage,
};
use foton_math::Rgb;

use crate::{ContentError, Image, Layer, LayerData, Metadata, WriteError, atomic_write, exr_header};

/// One scanline part, lossless. Run lengths shrink black and flat regions; on the noisy mantissas of a render ZIP saves
/// a few per cent more and takes ten times as long.
const ENCODING: Encoding =
    Encoding { compression: Compression::RLE, blocks: Blocks::ScanLines, line_order: LineOrder::Increasing };

/// Writes `image` with `layers` and `metadata` as an OpenEXR file; same input, same bytes.
///
/// The file has one part. The image is its channels `R`, `G`, `B`; a layer is `NAME.R`, `NAME.G`, `NAME.B` or, for
/// a plane, `NAME.Y`, all 32-bit. Every bit is kept: NaN and infinities are written as they are. Metadata becomes
/// text attributes in UTF-8 under its keys, in its order.
///
/// # Errors
/// [`WriteError`] with the path; the file that was there is then untouched.
pub fn write_exr(
    path: &Path,
    image: &Image,
    layers: &[Layer],
    metadata: &Metadata,
) -> Result<(), WriteError> {
    let bytes = encode(image, layers, metadata).map_err(WriteError::content(path))?;
    atomic_write(path, |file| file.write_all(&bytes))
}

/// The bytes of the file.
fn encode(image: &Image, layers: &[Layer], metadata: &Metadata) -> Result<Vec<u8>, ContentError> {
    image.check()?;
    metadata.check()?;
    for (i, layer) in layers.iter().enumerate() {
        layer.check(image)?;
        if layers[..i].iter().any(|other| other.name == layer.name) {
            return Err(ContentError::LayerTwice { name: layer.name.clone() });
        }
    }
    let mut channels = rgb_channels("", image);
    channels.extend(layers.iter().flat_map(layer_channels));
    let size = (image.width as usize, image.height as usize);
    let part = exr::prelude::Layer::new(
        size,
        attributes(metadata),
        ENCODING,
        AnyChannels::sort(channels.into_iter().collect()),
    );
    let mut bytes = Cursor::new(Vec::new());
    exr::prelude::Image::from_layer(part)
        .write()
        .to_buffered(&mut bytes)
        .map_err(|cause| ContentError::Encoder(cause.to_string()))?;
    let mut bytes = bytes.into_inner();
    exr_header::sort_attributes(&mut bytes, metadata)
        .ok_or_else(|| ContentError::Encoder("the encoder wrote a malformed header".into()))?;
    Ok(bytes)
}

/// The channels of one layer.
fn layer_channels(layer: &Layer) -> Vec<AnyChannel<FlatSamples>> {
    let scalar = |samples| vec![AnyChannel::new(text(&format!("{}.Y", layer.name)), samples)];
    match &layer.channels {
        LayerData::Rgb(image) => rgb_channels(&format!("{}.", layer.name), image),
        LayerData::F32(plane) => scalar(FlatSamples::F32(plane.values.clone())),
        LayerData::U32(plane) => scalar(FlatSamples::U32(plane.values.clone())),
    }
}

/// The three channels of an image, their names after `prefix`.
fn rgb_channels(prefix: &str, image: &Image) -> Vec<AnyChannel<FlatSamples>> {
    let channel = |name: &str, of: fn(&Rgb) -> f32| {
        let samples = FlatSamples::F32(image.pixels.iter().map(of).collect());
        AnyChannel::new(text(&format!("{prefix}{name}")), samples)
    };
    vec![channel("R", |c| c.r), channel("G", |c| c.g), channel("B", |c| c.b)]
}

/// The metadata as text attributes; their order comes later, since this is a hash map.
fn attributes(metadata: &Metadata) -> LayerAttributes {
    let other = metadata.iter().map(|(key, value)| (text(key), AttributeValue::Text(text(value)))).collect();
    LayerAttributes { other, ..LayerAttributes::default() }
}

/// The UTF-8 bytes of `s` as they are; the crate's own conversion knows Latin-1 only.
fn text(s: &str) -> Text {
    Text::from_slice_unchecked(s.as_bytes())
}
