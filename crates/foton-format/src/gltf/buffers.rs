//! The bytes that a file names: those behind its description, inside of it, and of other files.

use std::borrow::Cow;
use std::path::PathBuf;

use foton_input::quoted;

use super::container::{data_of, unescaped};
use super::json::At;
use crate::diagnostic::{Place, Report};
use crate::files::Files;

/// What compresses the bytes of meshes so that they are not read here, and what it is called.
const PACKED: [&str; 2] = ["EXT_meshopt_compression", "KHR_meshopt_compression"];

/// What can be done about meshes that are packed.
pub(super) const UNPACK: &str =
    "import the file in Blender, for example, and export it as glTF without compression";

/// Buffers by their numbers; `None`: what it is was said.
pub(super) struct Buffers<'a> {
    all: Vec<Option<Cow<'a, [u8]>>>,
    /// How many bytes there are in all of them.
    pub(super) bytes: u64,
}

/// A part of a buffer.
#[derive(Clone, Copy)]
pub(super) struct View<'a> {
    pub(super) bytes: &'a [u8],
    /// From one element to the next, where that is stated.
    pub(super) stride: Option<usize>,
}

impl<'a> Buffers<'a> {
    /// Reads all buffers.
    pub(super) fn read(
        root: &At<'_>,
        binary: Option<&'a [u8]>,
        files: &mut Files<'_>,
        report: &mut Report,
    ) -> Self {
        let (mut all, mut bytes) = (Vec::new(), 0);
        for (i, buffer) in root.items("buffers", report).iter().enumerate() {
            let read = read_buffer(buffer, binary.filter(|_| i == 0), files, report);
            bytes += read.as_ref().map_or(0, |read| read.len() as u64);
            all.push(read);
        }
        Self { all, bytes }
    }

    /// The part of a buffer that a `bufferView` says.
    pub(super) fn view(&self, view: &At<'_>, root: &At<'_>, report: &mut Report) -> Option<View<'_>> {
        if let Some(packed) = PACKED.iter().find_map(|name| view.extension(name)) {
            // Where the buffer stands there unpacked as well, it is read.
            let has_bytes =
                view.index("buffer", report).is_some_and(|i| self.all.get(i).is_some_and(Option::is_some));
            if !has_bytes {
                packed.error(report, "meshes packed by meshopt are not read");
                report.help(UNPACK);
                return None;
            }
        }
        let (index, _) = view.named("buffer", "buffers", root, report)?;
        let bytes = self.all.get(index)?.as_deref()?;
        let offset = view.index("byteOffset", report).unwrap_or(0);
        let Some(length) = view.index("byteLength", report) else {
            view.error(report, "needs a \"byteLength\"");
            return None;
        };
        let end = offset.checked_add(length);
        let Some(bytes) = end.and_then(|end| bytes.get(offset..end)) else {
            let message =
                format!("{length} bytes from byte {offset} are not in a buffer of {} bytes", bytes.len());
            view.error(report, message);
            return None;
        };
        let stride = view.index("byteStride", report).filter(|stride| *stride > 0);
        Some(View { bytes, stride })
    }
}

fn read_buffer<'a>(
    buffer: &At<'_>,
    binary: Option<&'a [u8]>,
    files: &mut Files<'_>,
    report: &mut Report,
) -> Option<Cow<'a, [u8]>> {
    let Some(uri) = buffer.text("uri", report) else {
        // Buffers without bytes stand for what an extension packed.
        let is_packed = PACKED.iter().any(|name| buffer.extension(name).is_some());
        if binary.is_none() && !is_packed {
            buffer.error(report, "needs a \"uri\": the file has no bytes behind its description");
        }
        return binary.map(Cow::Borrowed);
    };
    let bytes = contents(uri, buffer, "the meshes in it are left out", files, report)?.1;
    let stated = buffer.index("byteLength", report).unwrap_or(0);
    if bytes.len() < stated {
        buffer.error(report, format!("has {} bytes and says that it has {stated}", bytes.len()));
        return None;
    }
    Some(Cow::Owned(bytes))
}

/// The bytes of an address, and its path if it is one of a file; `None` where there are none, which was said.
pub(super) fn contents(
    uri: &str,
    at: &At<'_>,
    instead: &str,
    files: &mut Files<'_>,
    report: &mut Report,
) -> Option<(PathBuf, Vec<u8>)> {
    if let Some(data) = data_of(uri) {
        return match data {
            Ok(bytes) => Some((PathBuf::new(), bytes)),
            Err(message) => {
                at.error(report, message);
                None
            }
        };
    }
    if let Some((scheme, _)) = uri.split_once("://") {
        let message = format!("{} is on the web: foton downloads nothing", quoted(uri));
        at.error(
            report,
            if scheme == "file" { "addresses of the form file:// are not read".to_owned() } else { message },
        );
        report.help("put the file beside the scene, and its name into \"uri\"");
        return None;
    }
    let name = String::from_utf8_lossy(&unescaped(uri)).into_owned();
    // Some exporters write names as they are, with a percent sign that means itself.
    let is_plain = name != uri
        && !files.is_there(&name, Place::default(), report)
        && files.is_there(uri, Place::default(), report);
    let name = if is_plain { uri } else { &name };
    files.read_or_do_without(name, Place::default(), instead, report)?.ok()
}
