//! Wavefront MTL to materials, roughly: the format describes looks of the nineties, not scattering.
//!
//! | statements | material |
//! |---|---|
//! | `illum` 3 or 5, `Ks` above zero | a mirror of `Ks` |
//! | `illum` 4, 6, 7 or 9 unless `Ni` is 1; or `d` below 1 and `Ni` above 1 | clear glass of `Ni`; 1.5 where `Ni` is absent |
//! | `illum` 2, `Ks` above zero | a rough coat of `Ni` (1.5 unless above 1) times `Ks` over a diffuse `Kd`, α = √(2 / (Ns + 2)) |
//! | anything else | diffuse `Kd` |
//! | `d` below 1 otherwise | that share of the light meets the surface |
//! | `Ke` above zero | the surface emits that radiance besides |
//!
//! All but glass look the same from both sides. `Tf` is not used: files disagree on whether 0 is clear or black.
//! Textures are not read. Nothing here is an error: what is not understood is a warning, and the rest holds.
//!
//! Exporters write statements that would make a model vanish, and mean that it is opaque. What is assumed of them is a warning:
//! - Maya writes `illum 4` for every material, with `Ni 1`: glass that refracts nothing is taken as opaque.
//! - `Tr` is the share that passes, by most exporters, or the share that does not. Where `d` stands beside it, `d` holds. Where it
//!   stands alone, the file's other materials say which it is: those with both, or else one with `Tr 1` while none has `Tr 0`.
//!   What then would be invisible by `Tr` is opaque all the same.
//! - `d 0` in all materials of a file.

use foton_input::quoted;
use foton_math::{Cancel, Rgb};
use foton_scene::description::{
    Bsdf, Colour, Dielectric, Diffuse, Material, MicrofacetDistribution, Microfacets, Mirror, Plastic,
};

use crate::diagnostic::Place;
use crate::mesh::words::{Problem, Word, Words, shown};

/// A material of a file.
#[derive(Clone, Debug)]
pub(crate) struct Entry {
    /// How it scatters; its name is that of the file.
    pub(crate) material: Material,
    /// What it emits (W·m⁻²·sr⁻¹), if anything.
    pub(crate) radiance: Option<Rgb>,
}

/// The materials of a file in its order, and what is wrong with it or had to be assumed.
pub(crate) fn parse(bytes: &[u8], cancel: &Cancel) -> (Vec<Entry>, Vec<Problem>) {
    let mut statements: Vec<Statements> = Vec::new();
    let mut warnings = Vec::new();
    let mut words = Words::new(bytes, cancel);
    while words.next_line() {
        let Some(keyword) = words.next() else { continue };
        if keyword.text == b"newmtl" {
            statements.push(Statements::named(unquoted(&words.rest_of_line())));
        } else if let Some(current) = statements.last_mut() {
            warnings.extend(current.read(keyword, &mut words).err());
        }
    }
    let reading = Reading::of(&statements);
    let mut assumed: Vec<(Assumed, Place, String, usize)> = Vec::new();
    let entries = statements.iter().map(|s| {
        s.entry(&reading, &mut |what, place| match assumed.iter_mut().find(|a| a.0 == what) {
            Some(known) => known.3 += 1,
            None => assumed.push((what, place, s.name.clone(), 0)),
        })
    });
    let entries = entries.collect();
    warnings.extend(assumed.into_iter().map(|(what, place, name, more)| {
        let more = if more == 0 { String::new() } else { format!(" and of {more} more") };
        (place, what.message(&format!("{}{more}", quoted(&name))))
    }));
    (entries, warnings)
}

/// A name without the quotes around it that some exporters write.
pub(crate) fn unquoted(name: &str) -> &str {
    name.strip_prefix('"').and_then(|n| n.strip_suffix('"')).unwrap_or(name)
}

/// What was assumed of a material.
#[derive(Clone, Copy, PartialEq)]
enum Assumed {
    /// Glass that refracts nothing is opaque.
    NoGlass,
    /// `Tr` does not go with `d`.
    TrBesideD,
    /// `Tr` is an opacity.
    TrIsOpacity,
    /// `Tr` would make it invisible either way.
    TrIsNothing,
    /// `d` would make everything invisible.
    DIsNothing,
}

impl Assumed {
    /// A warning about the material of that name, which may go on with others.
    fn message(self, of: &str) -> String {
        match self {
            Self::NoGlass => format!(
                "\"illum\" of {of} asks for glass, but \"Ni\" says that it refracts nothing: taken as opaque; \"Ni 1.5\" makes it glass"
            ),
            Self::TrBesideD => format!("\"Tr\" of {of} contradicts \"d\" beside it: \"d\" is taken"),
            Self::TrIsOpacity => format!(
                "\"Tr\" of {of} is taken as opacity, 1 for opaque, going by the other materials and so that none vanishes; \
                 \"d\" leaves no doubt"
            ),
            Self::TrIsNothing => {
                format!("\"Tr\" of {of} would make it invisible: taken as opaque; \"d 0\" makes it invisible")
            }
            Self::DIsNothing => {
                format!("\"d\" of {of} would make the whole file invisible: taken as opaque")
            }
        }
    }
}

/// How the statements of a file are meant, going by all of its materials.
struct Reading {
    /// Whether `Tr` is a share that does not pass.
    tr_is_opacity: bool,
    /// Whether `d` makes every material invisible.
    d_is_nothing: bool,
}

impl Reading {
    fn of(materials: &[Statements]) -> Self {
        let beside = |is: fn(f32, f32) -> bool| {
            materials.iter().any(|m| matches!((m.d, m.tr), (Some((_, d)), Some((_, tr))) if is(d, tr)))
        };
        let (opacity, transparency) =
            (beside(|d, tr| d == tr && tr != 0.5), beside(|d, tr| (d + tr - 1.0).abs() < 0.01));
        let alone =
            |value: f32| materials.iter().any(|m| m.d.is_none() && m.tr.is_some_and(|tr| tr.1 == value));
        let tr_is_opacity = if opacity == transparency { alone(1.0) && !alone(0.0) } else { opacity };
        let is_nothing = |m: &Statements| m.d.is_some_and(|d| d.1 == 0.0) && m.ior().is_none_or(|n| n <= 1.0);
        Self { tr_is_opacity, d_is_nothing: !materials.is_empty() && materials.iter().all(is_nothing) }
    }
}

/// What a file says about one material.
struct Statements {
    name: String,
    kd: Rgb,
    ks: Rgb,
    ke: Rgb,
    ns: f32,
    ni: Option<f32>,
    d: Option<(Place, f32)>,
    tr: Option<(Place, f32)>,
    illum: (Place, u32),
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
            d: None,
            tr: None,
            illum: (Place::default(), 2),
        }
    }

    fn read(&mut self, keyword: Word<'_>, words: &mut Words<'_>) -> Result<(), Problem> {
        let share = |words: &mut Words<'_>| Ok((keyword.place, number(keyword, words)?.clamp(0.0, 1.0)));
        match keyword.text {
            b"Kd" => self.kd = clamped(colour(keyword, words)?),
            b"Ks" => self.ks = clamped(colour(keyword, words)?),
            b"Ke" => self.ke = colour(keyword, words)?.map(|c| c.max(0.0)),
            b"Ns" => self.ns = number(keyword, words)?.clamp(0.0, 1e6),
            b"Ni" => self.ni = Some(number(keyword, words)?),
            b"d" => self.d = Some(share(words)?),
            b"Tr" => self.tr = Some(share(words)?),
            b"illum" => self.illum = (keyword.place, number(keyword, words)? as u32),
            map if map.starts_with(b"map_") || matches!(map, b"bump" | b"disp" | b"decal" | b"norm") => {
                let message = format!("\"{}\" of {} is not read", shown(map), quoted(&self.name));
                return Err((keyword.place, message));
            }
            _ => {}
        }
        Ok(())
    }

    /// The index of refraction that is stated; 1 for one that nothing has.
    fn ior(&self) -> Option<f32> {
        self.ni.map(|n| if (0.1..=10.0).contains(&n) { n } else { 1.0 })
    }

    /// The share of light that meets the surface.
    fn opacity(&self, reading: &Reading, assume: &mut impl FnMut(Assumed, Place)) -> f32 {
        match (self.d, self.tr) {
            (None, None) => 1.0,
            (Some((place, _)), _) if reading.d_is_nothing => {
                assume(Assumed::DIsNothing, place);
                1.0
            }
            (Some((_, d)), None) => d,
            (Some((_, d)), Some((place, tr))) => {
                if (d + tr - 1.0).abs() > 0.01 {
                    assume(Assumed::TrBesideD, place);
                }
                d
            }
            (None, Some((place, tr))) => {
                let opacity = if reading.tr_is_opacity { tr } else { 1.0 - tr };
                if opacity == 0.0 {
                    assume(Assumed::TrIsNothing, place);
                    return 1.0;
                }
                if reading.tr_is_opacity {
                    assume(Assumed::TrIsOpacity, place);
                }
                opacity
            }
        }
    }

    fn entry(&self, reading: &Reading, assume: &mut impl FnMut(Assumed, Place)) -> Entry {
        let opacity = self.opacity(reading, assume);
        let (place, illum) = self.illum;
        let ni = self.ior().filter(|&n| n > 1.0);
        let asks_for_glass = matches!(illum, 4 | 6 | 7 | 9);
        let refracts = self.ior().is_none_or(|n| (n - 1.0).abs() > 1e-3);
        let is_glass = (asks_for_glass && refracts) || (opacity < 1.0 && ni.is_some());
        let is_shiny = self.ks.max_component() > 0.0;
        if asks_for_glass && !refracts {
            assume(Assumed::NoGlass, place);
        }
        let white = Colour::Constant(Rgb::WHITE);
        let front = match illum {
            3 | 5 if is_shiny => Bsdf::Mirror(Mirror { reflectance: self.ks.into() }),
            _ if is_glass => Bsdf::Dielectric(Dielectric {
                int_ior: self.ior().unwrap_or(1.5),
                ext_ior: 1.0,
                specular_reflectance: white,
                specular_transmittance: white,
                roughness: None,
            }),
            2 if is_shiny => self.coated(ni.unwrap_or(1.5)),
            _ => Bsdf::Diffuse(Diffuse { reflectance: self.kd.into() }),
        };
        let is_clear = matches!(front, Bsdf::Dielectric(Dielectric { .. }));
        let opacity = (!is_clear && opacity < 1.0).then(|| Colour::Constant(Rgb::splat(opacity)));
        let back = (!is_clear).then_some(front);
        let material = Material { name: self.name.clone(), front, back, opacity, ..Material::default() };
        Entry { material, radiance: Some(self.ke).filter(|ke| ke.max_component() > 0.0) }
    }

    fn coated(&self, int_ior: f32) -> Bsdf {
        // The exponent of a Blinn highlight as the slope of Beckmann's facets (Walter et al. 2007, after eq. 33).
        let alpha = (2.0 / (self.ns + 2.0)).sqrt();
        let distribution = MicrofacetDistribution::Beckmann;
        Bsdf::Plastic(Plastic {
            int_ior,
            ext_ior: 1.0,
            diffuse_reflectance: self.kd.into(),
            specular_reflectance: self.ks.into(),
            nonlinear: false,
            roughness: Some(Microfacets::isotropic(distribution, alpha)),
        })
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
    let mut word = words.next().ok_or_else(missing)?;
    // `d -halo 0.5` is thinner towards its rim, which is left out.
    if word.text == b"-halo" {
        word = words.next().ok_or_else(missing)?;
    }
    parsed(word)
}

fn parsed(word: Word<'_>) -> Result<f32, Problem> {
    let number = std::str::from_utf8(word.text).ok().and_then(|t| t.parse::<f32>().ok());
    number
        .filter(|n| n.is_finite())
        .ok_or_else(|| (word.place, format!("\"{}\" is not a number, its line is ignored", shown(word.text))))
}
