//! What a person selects and edits.

/// Something that can be selected.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Target {
    /// Index into the description's shapes.
    Shape(usize),
    /// Index into the description's emitters: a light without a surface.
    Emitter(usize),
    /// Index into the description's sensors.
    Sensor(usize),
}
