//! What a person selects and edits.

/// Something that can be chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Target {
    /// Index into the description's shapes.
    Shape(usize),
    /// Index into the description's emitters: a light without a surface.
    Emitter(usize),
}
