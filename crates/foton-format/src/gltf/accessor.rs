//! Numbers in buffers: whole ones, those that stand for fractions, and those that replace a few of others.
//!
//! An accessor is checked once, against the bytes that it names; then its elements are read one by one, so that nothing is
//! copied that no triangle uses.

use super::buffers::{Buffers, UNPACK, View};
use super::json::At;
use crate::diagnostic::Report;

/// Kinds of numbers, by the code that files have for each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Component {
    Byte,
    UnsignedByte,
    Short,
    UnsignedShort,
    UnsignedInt,
    Float,
}

impl Component {
    fn of(code: usize) -> Option<Self> {
        Some(match code {
            5120 => Self::Byte,
            5121 => Self::UnsignedByte,
            5122 => Self::Short,
            5123 => Self::UnsignedShort,
            5125 => Self::UnsignedInt,
            5126 => Self::Float,
            _ => return None,
        })
    }

    const fn size(self) -> usize {
        match self {
            Self::Byte | Self::UnsignedByte => 1,
            Self::Short | Self::UnsignedShort => 2,
            Self::UnsignedInt | Self::Float => 4,
        }
    }

    /// The largest number, which stands for 1 where numbers stand for fractions.
    const fn one(self) -> f64 {
        match self {
            Self::Byte => 127.0,
            Self::UnsignedByte => 255.0,
            Self::Short => 32_767.0,
            Self::UnsignedShort => 65_535.0,
            Self::UnsignedInt => 4_294_967_295.0,
            Self::Float => 1.0,
        }
    }

    /// The number at the beginning of some bytes; 0 where they are too few.
    fn read(self, bytes: &[u8]) -> f64 {
        let two = || bytes.first_chunk::<2>().copied().unwrap_or_default();
        let four = || bytes.first_chunk::<4>().copied().unwrap_or_default();
        let one = bytes.first().copied().unwrap_or_default();
        match self {
            Self::Byte => f64::from(one.cast_signed()),
            Self::UnsignedByte => f64::from(one),
            Self::Short => f64::from(i16::from_le_bytes(two())),
            Self::UnsignedShort => f64::from(u16::from_le_bytes(two())),
            Self::UnsignedInt => f64::from(u32::from_le_bytes(four())),
            Self::Float => f64::from(f32::from_le_bytes(four())),
        }
    }
}

/// Elements of some numbers each, one after the other.
#[derive(Clone, Copy)]
struct Run<'a> {
    bytes: &'a [u8],
    stride: usize,
}

/// Elements that replace those of a run.
struct Sparse<'a> {
    /// Their numbers, in order.
    indices: Vec<u32>,
    values: Run<'a>,
}

/// A list of elements of some numbers each.
pub(super) struct Accessor<'a> {
    pub(super) count: usize,
    pub(super) width: usize,
    pub(super) component: Component,
    is_normalised: bool,
    /// `None`: zeros.
    run: Option<Run<'a>>,
    sparse: Option<Sparse<'a>>,
}

/// What is known where an accessor is read.
pub(super) struct Source<'a, 'b> {
    pub(super) root: &'b At<'a>,
    pub(super) buffers: &'b Buffers<'a>,
}

impl<'b> Source<'_, 'b> {
    /// The accessor whose number stands `at` a place under a name; `None` where there is none or where something is wrong with it, which is said.
    pub(super) fn accessor(&self, at: &At<'_>, key: &str, report: &mut Report) -> Option<Accessor<'b>> {
        let index = at.index(key, report)?;
        let Some(accessor) = self.root.get("accessors").and_then(|all| all.item(index)) else {
            let message = format!(
                "there is no accessors[{index}]: the file has {} of them",
                self.root.count("accessors")
            );
            at.get(key).unwrap_or_else(|| at.clone()).error(report, message);
            return None;
        };
        let component = accessor.index("componentType", report).and_then(Component::of);
        let width = accessor.text("type", report).and_then(width_of);
        let (Some(component), Some(width)) = (component, width) else {
            accessor.error(report, "needs a \"componentType\" and a \"type\" of glTF 2.0");
            return None;
        };
        let count = accessor.index("count", report).filter(|count| *count > 0);
        let Some(count) = count.filter(|count| u32::try_from(*count).is_ok()) else {
            accessor.error(report, "needs a \"count\" from 1 to 4,294,967,295");
            return None;
        };
        let run = match accessor.get("bufferView") {
            Some(_) => Some(self.run(&accessor, (count, width, component), report)?),
            None => None,
        };
        let sparse = match accessor.get("sparse") {
            Some(sparse) => Some(self.sparse(&sparse, (count, width, component), report)?),
            None => None,
        };
        if run.is_none() && count as u64 > self.buffers.bytes {
            accessor.error(report, format!("has {count} elements and no \"bufferView\" with them"));
            report.help(UNPACK);
            return None;
        }
        let is_normalised = accessor.is("normalized", report);
        Some(Accessor { count, width, component, is_normalised, run, sparse })
    }

    /// The bytes of a number of elements.
    fn run(
        &self,
        at: &At<'_>,
        (count, width, component): (usize, usize, Component),
        report: &mut Report,
    ) -> Option<Run<'b>> {
        let (_, view) = at.named("bufferView", "bufferViews", self.root, report)?;
        let View { bytes, stride } = self.buffers.view(&view, self.root, report)?;
        let offset = at.index("byteOffset", report).unwrap_or(0);
        let size = width * component.size();
        let stride = stride.unwrap_or(size);
        let last = (count - 1).checked_mul(stride).and_then(|last| last.checked_add(offset));
        let end = last.and_then(|last| last.checked_add(size));
        if end.is_none_or(|end| end > bytes.len()) {
            let message = format!(
                "{count} elements of {size} bytes, {stride} apart, are not in {} of {} bytes from byte {offset}",
                view.path(),
                bytes.len()
            );
            at.error(report, message);
            return None;
        }
        Some(Run { bytes: &bytes[offset..], stride })
    }

    fn sparse(
        &self,
        at: &At<'_>,
        (count, width, component): (usize, usize, Component),
        report: &mut Report,
    ) -> Option<Sparse<'b>> {
        let replaced = at.index("count", report).filter(|replaced| (1..=count).contains(replaced));
        let (Some(indices), Some(values), Some(replaced)) = (at.get("indices"), at.get("values"), replaced)
        else {
            at.error(
                report,
                "needs \"indices\", \"values\", and a \"count\" of as many elements as there are at most",
            );
            return None;
        };
        let of_indices = indices.index("componentType", report).and_then(Component::of);
        let of_indices =
            of_indices.filter(|c| !matches!(c, Component::Float | Component::Byte | Component::Short));
        let Some(of_indices) = of_indices else {
            indices.error(report, "needs the \"componentType\" of a whole number");
            return None;
        };
        let run = self.run(&indices, (replaced, 1, of_indices), report)?;
        let values = self.run(&values, (replaced, width, component), report)?;
        let number = |i: usize| of_indices.read(&run.bytes[i * run.stride..]) as u32;
        let numbers: Vec<u32> = (0..replaced).map(number).collect();
        let in_order = numbers.windows(2).all(|pair| pair[0] < pair[1]);
        if !in_order || numbers.last().is_some_and(|last| *last as usize >= count) {
            indices.error(report, format!("must grow from one to the next and be smaller than {count}"));
            return None;
        }
        Some(Sparse { indices: numbers, values })
    }

    /// An attribute of vertices, of at least so many numbers each; `Some(None)` where there is none, `None` where it is wrong, which is said.
    pub(super) fn of_vertices(
        &self,
        attributes: &At<'_>,
        name: &str,
        (width, count): (usize, usize),
        report: &mut Report,
    ) -> Option<Option<Accessor<'b>>> {
        let Some(at) = attributes.get(name) else { return Some(None) };
        let accessor = self.accessor(attributes, name, report)?;
        if accessor.width < width {
            at.error(report, format!("needs {width} numbers for each vertex, not {}", accessor.width));
            return None;
        }
        if accessor.count < count {
            at.error(report, format!("has {} elements for {count} vertices", accessor.count));
            return None;
        }
        Some(Some(accessor))
    }
}

impl Accessor<'_> {
    /// The bytes of an element; `None`: zeros.
    fn element(&self, index: usize) -> Option<&[u8]> {
        if let Some(sparse) = &self.sparse
            && let Ok(place) = sparse.indices.binary_search(&(index as u32))
        {
            return sparse.values.bytes.get(place * sparse.values.stride..);
        }
        self.run.as_ref()?.bytes.get(index * self.run.as_ref()?.stride..)
    }

    /// The first numbers of an element; what it lacks is 0.
    pub(super) fn read<const N: usize>(&self, index: usize) -> [f64; N] {
        let Some(bytes) = self.element(index) else { return [0.0; N] };
        let size = self.component.size();
        std::array::from_fn(|i| {
            let bytes = if i < self.width { bytes.get(i * size..).unwrap_or_default() } else { &[] };
            let number = self.component.read(bytes);
            if self.is_normalised { (number / self.component.one()).max(-1.0) } else { number }
        })
    }

    /// An element that is a number of something.
    pub(super) fn index(&self, index: usize) -> u32 {
        self.element(index).map_or(0, |bytes| self.component.read(bytes) as u32)
    }

    /// Whether elements are whole numbers that are not below zero.
    pub(super) fn is_of_indices(&self) -> bool {
        let is_whole = matches!(
            self.component,
            Component::UnsignedByte | Component::UnsignedShort | Component::UnsignedInt
        );
        self.width == 1 && is_whole
    }
}

/// How many numbers an element of a type has.
fn width_of(name: &str) -> Option<usize> {
    Some(match name {
        "SCALAR" => 1,
        "VEC2" => 2,
        "VEC3" => 3,
        "VEC4" | "MAT2" => 4,
        "MAT3" => 9,
        "MAT4" => 16,
        _ => return None,
    })
}
