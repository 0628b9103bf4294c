//! `<texture>` elements. A texture that several materials refer to for one purpose stands once.
//!
//! Mitsuba's texture coordinate v begins at a bitmap's *top*; in a description it points up. Meshes keep Mitsuba's
//! coordinates, and a bitmap's `to_uv` here ends with the turn v → 1 − v. What Mitsuba 3 does not have is made of what it
//! has: a factor is put into the colours, and a grid becomes a bitmap.

use std::sync::Arc;

use foton_input::quoted;
use foton_math::Rgb;
use foton_math::glam::{DAffine2, DAffine3, DMat2, DVec2};
use foton_scene::description::{Bitmap, Colour, Texture, TextureKind, Wrap};
use foton_scene::parameter::Parameter;
use foton_scene::plugins::textures::{
    ATTRIBUTE_SCALE, BACKGROUND, BITMAP, CHANNEL, CHANNELS, COLOR0, COLOR1, FILENAME, FILTER_TYPE, GAMMA,
    LINE_WIDTH, LINES, NAME, RAW, SCALE, TO_UV, UOFFSET, USCALE, VOFFSET, VSCALE, WRAP_MODE, WRAP_MODE_U,
    WRAP_MODE_V,
};

use crate::image::{Channel, Curve, Purpose, Reading};
use crate::mitsuba::names::TEXTURES;
use crate::mitsuba::read::properties::{Object, Properties};
use crate::mitsuba::read::reader::Reader;

/// v → 1 − v.
pub(crate) const TURN: DAffine2 =
    DAffine2 { matrix2: DMat2::from_cols(DVec2::X, DVec2::NEG_Y), translation: DVec2::Y };

/// Textures may stand so deep inside one another.
const MAX_DEPTH: usize = 8;

/// The most pixels along a side of a grid's bitmap.
const MAX_GRID: u32 = 1024;

/// What a texture is for, and a factor on it.
#[derive(Clone, Copy)]
struct Wanted {
    purpose: Purpose,
    factor: Rgb,
}

type Kind = (DAffine2, TextureKind);

impl Reader<'_> {
    /// The index of the texture that an element describes, whose colours are shares of light.
    pub(crate) fn texture(&mut self, object: Object<'_>) -> Option<usize> {
        self.texture_for(object, Purpose::Share)
    }

    /// Reads a texture of the scene itself, unless something that refers to it has done so.
    pub(crate) fn unused_texture(&mut self, object: Object<'_>) {
        if !self.textures.used.contains(&object.node) {
            self.texture(object);
        }
    }

    /// The index of the texture that an element describes.
    pub(crate) fn texture_for(&mut self, object: Object<'_>, purpose: Purpose) -> Option<usize> {
        let key = (object.node, purpose);
        if let Some(&known) = self.textures.indices.get(&key) {
            return known;
        }
        let index = self.new_texture(object, Wanted { purpose, factor: Rgb::WHITE });
        self.textures.indices.insert(key, index);
        index
    }

    fn new_texture(&mut self, object: Object<'_>, wanted: Wanted) -> Option<usize> {
        let (to_uv, kind) = self.texture_kind(object, wanted)?;
        let of_others = [Purpose::Share, Purpose::Light, Purpose::Number].map(|p| (object.node, p));
        let known = of_others.iter().filter_map(|key| *self.textures.indices.get(key)?);
        let same = |index: &usize| is_same(&self.description.textures[*index].kind, &kind);
        if let Some(index) = known.into_iter().find(same) {
            return Some(index);
        }
        let index = self.description.textures.len();
        self.textures.places.insert(index, object.element.place);
        let plugin = object.element.attribute("type").map_or("texture", |t| &t.value);
        let name = self.name(object.element, plugin, index + 1);
        self.description.textures.push(Texture { name, to_uv, kind });
        Some(index)
    }

    fn texture_kind(&mut self, object: Object<'_>, wanted: Wanted) -> Option<Kind> {
        let open = &mut self.textures.open;
        if open.contains(&object.node) || open.len() >= MAX_DEPTH {
            self.report
                .error(object.place, "this texture is made of itself, or of too many inside one another");
            return None;
        }
        open.push(object.node);
        self.textures.used.insert(object.node);
        let kind = self.read_texture(object, wanted);
        self.textures.open.pop();
        kind
    }

    fn read_texture(&mut self, object: Object<'_>, wanted: Wanted) -> Option<Kind> {
        let plugin = self.plugin(object.element, &TEXTURES)?;
        let mut p = self.properties(object.node, plugin);
        let read = match plugin {
            "bitmap" => {
                let to_uv = self.uv_transform(&mut p);
                self.bitmap_texture(&mut p, wanted).map(|kind| (TURN * to_uv, kind))
            }
            "checkerboard" => {
                let to_uv = self.uv_transform(&mut p);
                let colours = [&COLOR0, &COLOR1].map(|parameter| self.square(&mut p, parameter, wanted));
                let [first, second] = colours;
                first.zip(second).map(|(a, b)| (to_uv, TextureKind::Checkerboard { colours: [a, b] }))
            }
            "gridtexture" => {
                let to_uv = self.uv_transform(&mut p);
                Some((TURN * to_uv, self.grid(&mut p, wanted)))
            }
            "scale" => self.scaled(&mut p, wanted),
            _ => self.attribute(plugin, &mut p, wanted).map(|kind| (DAffine2::IDENTITY, kind)),
        };
        p.finish(&mut self.report);
        read
    }

    /// `to_uv`, or the offsets and scales of old files.
    fn uv_transform(&mut self, p: &mut Properties<'_>) -> DAffine2 {
        let to_uv = p.transform(TO_UV.name, &mut self.report).map(|t| in_plane(&t.value));
        let mut number = |parameter: &Parameter| {
            p.number(parameter.name, &mut self.report).map_or(parameter.default, |n| n.value)
        };
        let offset = DVec2::new(number(&UOFFSET), number(&VOFFSET));
        let scale = DVec2::new(number(&USCALE), number(&VSCALE));
        to_uv.unwrap_or_else(|| DAffine2::from_scale(scale) * DAffine2::from_translation(offset))
    }

    fn bitmap_texture(&mut self, p: &mut Properties<'_>, wanted: Wanted) -> Option<TextureKind> {
        let reading = Reading {
            curve: self.curve(p),
            channel: self.channel(p),
            factor: wanted.factor,
            purpose: wanted.purpose,
        };
        let bilinear = self.filter_type(p);
        let wrap = self.wrap_mode(p);
        p.leave_out(BITMAP.parameters, &mut self.report);
        if !p.has(FILENAME.name) {
            self.report.error(p.place, "a bitmap texture needs a \"filename\"");
        }
        let filename = p.string(FILENAME.name, &mut self.report)?;
        let bitmap = self.images.read(&filename, reading, &mut self.files, &mut self.report)?;
        Some(TextureKind::Bitmap { bitmap, wrap, bilinear })
    }

    /// What numbers of 8 and 16 bits mean.
    fn curve(&mut self, p: &mut Properties<'_>) -> Curve {
        let raw = p.boolean(RAW.name, &mut self.report);
        let gamma = p.number(GAMMA.name, &mut self.report);
        match (raw, gamma) {
            (Some(raw), _) if raw.value => Curve::Power(1.0),
            (None, Some(gamma)) if (1e-3..1e3).contains(&gamma.value) => Curve::Power(gamma.value as f32),
            (None, Some(gamma)) if gamma.value != -1.0 && gamma.value != 0.0 => {
                self.report
                    .error(gamma.place, "\"gamma\" must be −1 for sRGB's curve, or a power such as 2.2");
                Curve::Srgb
            }
            _ => Curve::Srgb,
        }
    }

    /// The channel that is taken, where it is one.
    fn channel(&mut self, p: &mut Properties<'_>) -> Option<Channel> {
        let channel = p.string(CHANNEL.name, &mut self.report)?;
        let number = CHANNELS.iter().position(|c| channel.value.eq_ignore_ascii_case(c));
        match number {
            Some(i @ 0..3) => Some(Channel::Rgb(i)),
            Some(3) => Some(Channel::Alpha),
            Some(i) => Some(Channel::Xyz(i - 4)),
            None if channel.value.is_empty() => None,
            None => {
                self.report.error(channel.place, "\"channel\" must be r, g, b, a, x, y or z");
                None
            }
        }
    }

    /// Whether pixels are interpolated.
    fn filter_type(&mut self, p: &mut Properties<'_>) -> bool {
        let Some(filter) = p.string(FILTER_TYPE.name, &mut self.report) else { return true };
        match filter.value.to_ascii_lowercase().as_str() {
            "nearest" => return false,
            "bilinear" | "trilinear" | "ewa" => {}
            _ => self.report.error(filter.place, "\"filter_type\" must be bilinear or nearest"),
        }
        true
    }

    fn wrap_mode(&mut self, p: &mut Properties<'_>) -> Wrap {
        let both = [(WRAP_MODE_U.name, WRAP_MODE_V.name)]
            .map(|(u, v)| [p.string(u, &mut self.report), p.string(v, &mut self.report)]);
        let [[along_u, along_v]] = both;
        if let (Some(u), Some(v)) = (&along_u, &along_v)
            && u.value != v.value
        {
            self.report.warning(v.place, "u and v wrap alike here, as \"wrap_mode_u\" says");
        }
        let wrap = p.string(WRAP_MODE.name, &mut self.report).or(along_u).or(along_v);
        let Some(wrap) = wrap else { return Wrap::Repeat };
        match wrap.value.to_ascii_lowercase().as_str() {
            "repeat" => Wrap::Repeat,
            "mirror" => Wrap::Mirror,
            "clamp" => Wrap::Clamp,
            "zero" | "one" => {
                let message = format!("wrap mode {} is not supported, clamp is taken", quoted(&wrap.value));
                self.report.warning(wrap.place, message);
                Wrap::Clamp
            }
            _ => {
                self.report.error(wrap.place, "\"wrap_mode\" must be repeat, mirror or clamp");
                Wrap::Repeat
            }
        }
    }

    /// A colour of a checkerboard.
    fn square(&mut self, p: &mut Properties<'_>, parameter: &Parameter, wanted: Wanted) -> Option<Colour> {
        if let Some(inner) = p.texture(parameter.name) {
            let plain = wanted.factor == Rgb::WHITE;
            let purpose = wanted.purpose;
            let index =
                if plain { self.texture_for(inner, purpose) } else { self.new_texture(inner, wanted) };
            return index.map(Colour::Texture);
        }
        Some(Colour::Constant(self.scaled_colour(p, parameter, wanted)))
    }

    /// A colour that is the same everywhere.
    fn scaled_colour(&mut self, p: &mut Properties<'_>, parameter: &Parameter, wanted: Wanted) -> Rgb {
        let colour = match wanted.purpose {
            Purpose::Share => self.constant_share(p, parameter),
            Purpose::Light => self.emission(p, parameter),
            Purpose::Number => self.optical(p, parameter),
        };
        let scaled = colour * wanted.factor;
        if wanted.purpose == Purpose::Share && scaled.max_component() > 1.0 && wanted.factor != Rgb::WHITE {
            let message =
                format!("\"{}\" times its factor is larger than 1, it is cut to that", parameter.name);
            self.report.warning(p.place, message);
            return scaled.map(|c| c.min(1.0));
        }
        scaled
    }

    /// Lines on a ground, as a bitmap whose pixels fit the lines.
    fn grid(&mut self, p: &mut Properties<'_>, wanted: Wanted) -> TextureKind {
        let ground = self.scaled_colour(p, &BACKGROUND, wanted);
        let line = self.scaled_colour(p, &LINES, wanted);
        let width = self.ranged(p, &LINE_WIDTH);
        let reach = |size: u32| (width * f64::from(size)).round();
        let error = |size: u32| (reach(size) / f64::from(size) - width).abs();
        let exact = (2..=MAX_GRID).find(|&size| reach(size) > 0.0 && error(size) < 1e-6);
        let size = exact.unwrap_or(MAX_GRID);
        let is_line = |i: u32| f64::from(i.min(size - 1 - i)) < reach(size);
        let pixel = |y: u32, x: u32| if is_line(x) || is_line(y) { line } else { ground };
        let pixels =
            (0..size).flat_map(|y| (0..size).map(move |x| (y, x))).map(|(y, x)| pixel(y, x)).collect();
        let bitmap = Arc::new(Bitmap::new(size, size, pixels));
        TextureKind::Bitmap { bitmap, wrap: Wrap::Repeat, bilinear: false }
    }

    /// A number within the range that it declares.
    pub(crate) fn ranged(&mut self, p: &mut Properties<'_>, parameter: &Parameter) -> f64 {
        let Parameter { name, range: (min, max), default, .. } = *parameter;
        let Some(number) = p.number(name, &mut self.report) else { return default };
        if parameter.holds(number.value) {
            return number.value;
        }
        self.report.error(number.place, format!("\"{name}\" must lie between {min} and {max}"));
        default
    }

    /// A factor on the texture inside.
    fn scaled(&mut self, p: &mut Properties<'_>, wanted: Wanted) -> Option<Kind> {
        let factor = self.optical(p, &SCALE);
        let nested = p.nested("texture");
        let [inner] = nested[..] else {
            let message = format!("a scale texture needs one texture inside, not {}", nested.len());
            self.report.error(p.place, message);
            return None;
        };
        self.texture_kind(inner, Wanted { factor: wanted.factor * factor, ..wanted })
    }

    /// What a mesh states.
    fn attribute(&mut self, plugin: &str, p: &mut Properties<'_>, wanted: Wanted) -> Option<TextureKind> {
        let most = if wanted.purpose == Purpose::Share { 1.0 } else { f32::INFINITY };
        let factor = wanted.factor;
        if factor != Rgb::splat(factor.r) {
            self.report.error(p.place, "a factor on what a mesh states must be the same for all channels");
        }
        if plugin == "vertexcolors" {
            return Some(TextureKind::Attribute { name: "vertex_color".to_owned(), scale: factor.r, most });
        }
        let scale = self.ranged(p, &ATTRIBUTE_SCALE) as f32;
        if !p.has(NAME.name) {
            self.report.error(p.place, "a mesh_attribute texture needs a \"name\"");
        }
        let name = p.string(NAME.name, &mut self.report)?;
        if !(name.value.starts_with("vertex_") || name.value.starts_with("face_")) {
            self.report.error(name.place, "the name of an attribute begins with \"vertex_\" or \"face_\"");
            return None;
        }
        Some(TextureKind::Attribute { name: name.value, scale: scale * factor.r, most })
    }
}

/// Whether textures of one element are the same for two purposes.
fn is_same(a: &TextureKind, b: &TextureKind) -> bool {
    use TextureKind::{Attribute, Bitmap, Checkerboard};
    match (a, b) {
        (Bitmap { bitmap: a, .. }, Bitmap { bitmap: b, .. }) => Arc::ptr_eq(a, b),
        (Checkerboard { colours: a }, Checkerboard { colours: b }) => a == b,
        (Attribute { most: a, scale: s, .. }, Attribute { most: b, scale: t, .. }) => (a, s) == (b, t),
        _ => false,
    }
}

/// What a transform of space does in the plane z = 0.
fn in_plane(t: &DAffine3) -> DAffine2 {
    let m = t.matrix3;
    DAffine2::from_cols(m.x_axis.truncate(), m.y_axis.truncate(), t.translation.truncate())
}
