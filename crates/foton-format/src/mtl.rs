//! Wavefront MTL to materials, roughly: the format describes looks of the nineties, not scattering.
//!
//! | statements | material |
//! |---|---|
//! | `illum` 3 or 5, `Ks` above zero | a mirror of `Ks` |
//! | `illum` 4, 6, 7 or 9; or `d` below 1 (`Tr` above 0) and `Ni` above 1 | clear glass of `Ni`; 1.5 where `Ni` is absent |
//! | `illum` 2, `Ks` above zero | a rough coat of `Ni` (1.5 unless above 1) times `Ks` over a diffuse `Kd`, α = √(2 / (Ns + 2)) |
//! | anything else | diffuse `Kd` |
//! | `d` below 1 otherwise | that share of the light meets the surface |
//! | `Ke` above zero | the surface emits that radiance besides |
//!
//! All but glass look the same from both sides. `Tf` is not used: files disagree on whether 0 is clear or black.
//! Textures are not read. Nothing here is an error: what is not understood is a warning, and the rest holds.

use foton_math::Rgb;
use foton_scene::description::{Bsdf, Colour, Material, MicrofacetDistribution, Microfacets};

use crate::obj::{Problem, Word, Words, shown};

/// A material of a file.
#[derive(Clone, Debug)]
pub(crate) struct Entry {
    /// How it scatters; its name is that of the file.
    pub(crate) material: Material,
    /// What it emits (W·m⁻²·sr⁻¹), if anything.
    pub(crate) radiance: Option<Rgb>,
}

/// The materials of a file in its order, and what is wrong with it.
pub(crate) fn parse(bytes: &[u8]) -> (Vec<Entry>, Vec<Problem>) {
    let mut statements: Vec<Statements> = Vec::new();
    let mut warnings = Vec::new();
    let mut words = Words::new(bytes);
    while words.next_line() {
        let Some(keyword) = words.next() else { continue };
        if keyword.text == b"newmtl" {
            statements.push(Statements::named(&words.rest_of_line()));
        } else if let Some(current) = statements.last_mut() {
            warnings.extend(current.read(keyword, &mut words).err());
        }
    }
    (statements.iter().map(Statements::entry).collect(), warnings)
}

/// What a file says about one material.
struct Statements {
    name: String,
    kd: Rgb,
    ks: Rgb,
    ke: Rgb,
    ns: f32,
    ni: Option<f32>,
    d: f32,
    illum: u32,
}

impl Statements {
    fn named(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            kd: Rgb::splat(0.5),
            ks: Rgb::BLACK,
            ke: Rgb::BLACK,
            ns: 0.0,
            ni: None,
            d: 1.0,
            illum: 2,
        }
    }

    fn read(&mut self, keyword: Word<'_>, words: &mut Words<'_>) -> Result<(), Problem> {
        match keyword.text {
            b"Kd" => self.kd = clamped(colour(keyword, words)?),
            b"Ks" => self.ks = clamped(colour(keyword, words)?),
            b"Ke" => self.ke = colour(keyword, words)?.map(|c| c.max(0.0)),
            b"Ns" => self.ns = number(keyword, words)?.clamp(0.0, 1e6),
            b"Ni" => self.ni = Some(number(keyword, words)?).filter(|n| (0.1..=10.0).contains(n)),
            b"d" => self.d = number(keyword, words)?.clamp(0.0, 1.0),
            b"Tr" => self.d = 1.0 - number(keyword, words)?.clamp(0.0, 1.0),
            b"illum" => self.illum = number(keyword, words)? as u32,
            map if map.starts_with(b"map_") || matches!(map, b"bump" | b"disp" | b"decal" | b"norm") => {
                let message = format!("\"{}\" of \"{}\" is not read", shown(map), self.name);
                return Err((keyword.place, message));
            }
            _ => {}
        }
        Ok(())
    }

    fn entry(&self) -> Entry {
        let ni = self.ni.filter(|&n| n > 1.0);
        let is_glass = matches!(self.illum, 4 | 6 | 7 | 9) || (self.d < 1.0 && ni.is_some());
        let is_shiny = self.ks.max_component() > 0.0;
        let white = Colour::Constant(Rgb::WHITE);
        let front = match self.illum {
            3 | 5 if is_shiny => Bsdf::Mirror { reflectance: self.ks.into() },
            _ if is_glass => Bsdf::Dielectric {
                int_ior: self.ni.unwrap_or(1.5),
                ext_ior: 1.0,
                specular_reflectance: white,
                specular_transmittance: white,
                roughness: None,
            },
            2 if is_shiny => self.coated(ni.unwrap_or(1.5)),
            _ => Bsdf::Diffuse { reflectance: self.kd.into() },
        };
        let is_clear = matches!(front, Bsdf::Dielectric { .. });
        let opacity = (!is_clear && self.d < 1.0).then(|| Colour::Constant(Rgb::splat(self.d)));
        let back = (!is_clear).then_some(front);
        let material = Material { name: self.name.clone(), front, back, opacity };
        Entry { material, radiance: Some(self.ke).filter(|ke| ke.max_component() > 0.0) }
    }

    fn coated(&self, int_ior: f32) -> Bsdf {
        // The exponent of a Blinn highlight as the slope of Beckmann's facets (Walter et al. 2007, after eq. 33).
        let alpha = (2.0 / (self.ns + 2.0)).sqrt();
        let distribution = MicrofacetDistribution::Beckmann;
        Bsdf::Plastic {
            int_ior,
            ext_ior: 1.0,
            diffuse_reflectance: self.kd.into(),
            specular_reflectance: self.ks.into(),
            nonlinear: false,
            roughness: Some(Microfacets { distribution, alpha_u: alpha, alpha_v: alpha }),
        }
    }
}

fn clamped(colour: Rgb) -> Rgb {
    colour.map(|c| c.clamp(0.0, 1.0))
}

/// Three numbers, or one for all three.
fn colour(keyword: Word<'_>, words: &mut Words<'_>) -> Result<Rgb, Problem> {
    let r = number(keyword, words)?;
    let Some(second) = words.next() else { return Ok(Rgb::splat(r)) };
    Ok(Rgb::new(r, parsed(second)?, number(keyword, words)?))
}

fn number(keyword: Word<'_>, words: &mut Words<'_>) -> Result<f32, Problem> {
    let missing = || (keyword.place, format!("\"{}\" needs a number and is ignored", shown(keyword.text)));
    parsed(words.next().ok_or_else(missing)?)
}

fn parsed(word: Word<'_>) -> Result<f32, Problem> {
    let number = std::str::from_utf8(word.text).ok().and_then(|t| t.parse::<f32>().ok());
    number
        .filter(|n| n.is_finite())
        .ok_or_else(|| (word.place, format!("\"{}\" is not a number, its line is ignored", shown(word.text))))
}
