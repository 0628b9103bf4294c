//! From linear radiance to 8-bit sRGB: exposure, tone map, transfer function, rounding. Pure functions of one pixel.
//!
//! The preview's shader computes the same and must agree to 1/255, so each step is public and has one definition.

use foton_math::Rgb;

/// What a pixel with a NaN or infinite channel is shown as: magenta, so that a mistake is seen and not taken for black.
pub const NOT_FINITE: [u8; 3] = [255, 0, 255];

/// Radiance above this counts as this: the largest half-precision number, where every map has long reached white.
pub const BRIGHTEST: f32 = 65504.0;

/// How linear radiance is brought into [0, 1].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ToneMap {
    /// Each channel is clipped to [0, 1].
    Linear,
    /// Khronos PBR Neutral: faithful up to 0.8, then compressed and desaturated toward white.
    #[default]
    PbrNeutral,
    /// The base look of AgX: 16.5 stops of light on an S-shaped curve, colours toward white as they brighten.
    AgX,
}

impl ToneMap {
    /// Every map, in the order in which a person is offered them.
    pub const ALL: [Self; 3] = [Self::Linear, Self::PbrNeutral, Self::AgX];

    /// What a person calls it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Linear => "Linear",
            Self::PbrNeutral => "PBR Neutral",
            Self::AgX => "AgX",
        }
    }

    /// Its name in metadata and on the command line.
    #[must_use]
    pub const fn key(self) -> &'static str {
        match self {
            Self::Linear => "linear",
            Self::PbrNeutral => "pbr-neutral",
            Self::AgX => "agx",
        }
    }

    /// The mapped colour, linear in [0, 1]³, of a colour in [0, [`BRIGHTEST`]]³.
    #[must_use]
    pub fn apply(self, c: Rgb) -> Rgb {
        match self {
            Self::Linear => c.map(|v| v.clamp(0.0, 1.0)),
            Self::PbrNeutral => pbr_neutral(c),
            Self::AgX => agx(c),
        }
    }
}

/// The 8-bit sRGB pixel that shows the radiance `c` at an exposure of `stops` (each doubles the light).
///
/// A pixel that is not finite becomes [`NOT_FINITE`]; a negative channel counts as zero.
#[must_use]
pub fn display(c: Rgb, tone_map: ToneMap, stops: f32) -> [u8; 3] {
    if !c.is_finite() {
        return NOT_FINITE;
    }
    tone_map.apply(expose(c, stops)).to_array().map(|v| quantise(srgb_encode(v)))
}

/// `c · 2^stops`, each channel clamped to [0, [`BRIGHTEST`]].
#[must_use]
pub fn expose(c: Rgb, stops: f32) -> Rgb {
    (c * stops.exp2()).map(|v| v.clamp(0.0, BRIGHTEST))
}

/// The Khronos PBR Neutral tone mapper \[KPN24\] of a colour in [0, [`BRIGHTEST`]]³, linear with sRGB primaries.
///
/// With x the smallest channel, F₉₀ = 0.04, K_s = 0.8 − F₉₀ and K_d = 0.15:
///
/// - toe: f = x − x²/(4·F₉₀) if x ≤ 2·F₉₀, else F₉₀; it takes away the glare of a dielectric under white light;
/// - peak p = max(c) − f; up to p = K_s the result is c − f;
/// - above: p_n = 1 − (1 − K_s)²/(p + 1 − 2·K_s) and g = 1/(K_d·(p − p_n) + 1), and the result is
///   (c − f)·(p_n/p)·g + p_n·(1 − g), below 1 in every channel and toward white as p grows.
#[must_use]
pub fn pbr_neutral(c: Rgb) -> Rgb {
    const F90: f32 = 0.04;
    const K_S: f32 = 0.8 - F90;
    const K_D: f32 = 0.15;
    let x = c.r.min(c.g).min(c.b);
    let f = if x <= 2.0 * F90 { x - x * x / (4.0 * F90) } else { F90 };
    let c = c - Rgb::splat(f);
    let p = c.max_component();
    if p <= K_S {
        return c;
    }
    let p_n = 1.0 - (1.0 - K_S) * (1.0 - K_S) / (p + 1.0 - 2.0 * K_S);
    let g = 1.0 / (K_D * (p - p_n) + 1.0);
    c * (p_n / p * g) + Rgb::splat(p_n * (1.0 - g))
}

/// The base look of AgX \[AGX22\], with the inverse inset and power of \[WRE23\], of a colour in [0, [`BRIGHTEST`]]³.
///
/// With g(c) = w·c, a grey in which w sums to one, and m = 0.2:
///
/// - inset: c ← (1 − m)·c + m·g(c); it moves the primaries of sRGB a fifth of the way to white, so that g keeps its value;
/// - curve: y = [`agx_curve`]((log₂(c/0.18) + 10)/16.5) in each channel, from 10 stops below middle grey to 6.5 above;
/// - outset, the inverse of the inset, clamped, and raised to 2.2, from encoded to linear: ((y − m·g(y))/(1 − m))^2.2.
#[must_use]
pub fn agx(c: Rgb) -> Rgb {
    const MIX: f32 = 0.2;
    let grey = |c: Rgb| 0.211_994_6 * c.r + 0.392_150_8 * c.g + 0.395_854_6 * c.b;
    let inset = c * (1.0 - MIX) + Rgb::splat(MIX * grey(c));
    let y = inset.map(|v| agx_curve((v.max(1e-10) / 0.18).log2().clamp(-10.0, 6.5) / 16.5 + 10.0 / 16.5));
    let outset = (y - Rgb::splat(MIX * grey(y))) * (1.0 / (1.0 - MIX));
    outset.map(|v| v.clamp(0.0, 1.0).powf(2.2))
}

/// The S-shaped curve of AgX \[AGX22\], from [0, 1] onto [0, 1]: y = 1/2 + 2·d/(1 + k·|d|^p)^(1/p) with d = x − 10/16.5.
///
/// The slope at middle grey is 2. p is 3 below it and 3.25 above, and k = 4^p − X^(−p), where X is the way from middle grey
/// to the end of that side, takes the curve through (0, 0) and (1, 1).
#[must_use]
pub fn agx_curve(x: f32) -> f32 {
    let d = x - 10.0 / 16.5;
    let (p, k) = if d < 0.0 { (3.0, 59.507_875) } else { (3.25, 69.862_79) };
    0.5 + 2.0 * d / (1.0 + k * d.abs().powf(p)).powf(1.0 / p)
}

/// The transfer function of sRGB (IEC 61966-2-1), exact and piecewise, from linear to encoded, on [0, 1].
#[must_use]
pub fn srgb_encode(v: f32) -> f32 {
    if v <= 0.003_130_8 { 12.92 * v } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 }
}

/// The inverse of [`srgb_encode`]: from encoded to linear, on [0, 1].
#[must_use]
pub fn srgb_decode(v: f32) -> f32 {
    if v <= 0.040_45 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
}

/// The nearest of the 256 steps of [0, 1]; values outside are clamped.
#[must_use]
pub fn quantise(v: f32) -> u8 {
    (255.0 * v).round() as u8
}
