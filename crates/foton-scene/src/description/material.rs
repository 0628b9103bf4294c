//! Materials: how surfaces scatter light.

use super::texture::Colour;
use crate::bsdf::Bsdf;

/// How a surface scatters, on each side.
#[derive(Clone, Debug)]
pub struct Material {
    /// The id in the file, or a name made from the type.
    pub name: String,
    /// On the side that the normal points to. A dielectric describes both sides by itself.
    pub front: Bsdf,
    /// On the other side. `None`: a reflector is black there.
    pub back: Option<Bsdf>,
    /// Share of light that meets the surface at all; the rest passes straight through. `None`: all. Of a colour the mean channel
    /// counts, of a bitmap's the luminance, as in Mitsuba 3.
    pub opacity: Option<Colour>,
}
