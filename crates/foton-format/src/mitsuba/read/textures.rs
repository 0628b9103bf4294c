//! `<texture>` elements: bitmap and checkerboard. A texture that several materials refer to stands once.
//!
//! Mitsuba's texture coordinate v begins at a bitmap's *top*; in a description it points up. Meshes keep Mitsuba's
//! coordinates, and a bitmap's `to_uv` here ends with the turn v → 1 − v.

use foton_input::quoted;
use foton_math::glam::{DAffine2, DAffine3, DMat2, DVec2};
use foton_scene::description::{Texture, TextureKind, Wrap};
use foton_scene::parameter::Parameter;
use foton_scene::plugins::textures::{
    BITMAP, COLOR0, COLOR1, FILENAME, FILTER_TYPE, GAMMA, RAW, TO_UV, UOFFSET, USCALE, VOFFSET, VSCALE,
    WRAP_MODE,
};

use crate::mitsuba::names::TEXTURES;
use crate::mitsuba::read::properties::{Object, Properties};
use crate::mitsuba::read::reader::Reader;

/// v → 1 − v.
pub(crate) const TURN: DAffine2 =
    DAffine2 { matrix2: DMat2::from_cols(DVec2::X, DVec2::NEG_Y), translation: DVec2::Y };

impl Reader<'_> {
    /// The index of the texture that an element describes.
    pub(crate) fn texture(&mut self, object: Object<'_>) -> Option<usize> {
        if let Some(&known) = self.textures.get(&object.node) {
            return known;
        }
        let index = self.read_texture(object);
        self.textures.insert(object.node, index);
        index
    }

    fn read_texture(&mut self, object: Object<'_>) -> Option<usize> {
        let plugin = self.plugin(object.element, &TEXTURES)?;
        let mut p = self.properties(object.node, plugin);
        let to_uv = self.uv_transform(&mut p);
        let texture = match plugin {
            "bitmap" => self.bitmap_texture(&mut p).map(|kind| (TURN * to_uv, kind)),
            _ => {
                let first = self.constant_share(&mut p, &COLOR0);
                let second = self.constant_share(&mut p, &COLOR1);
                Some((to_uv, TextureKind::Checkerboard { colours: [first, second] }))
            }
        };
        p.finish(&mut self.report);
        let (to_uv, kind) = texture?;
        let index = self.description.textures.len();
        let name = self.name(object.element, plugin, index + 1);
        self.description.textures.push(Texture { name, to_uv, kind });
        Some(index)
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

    fn bitmap_texture(&mut self, p: &mut Properties<'_>) -> Option<TextureKind> {
        let gamma = p.number(GAMMA.name, &mut self.report);
        let raw =
            p.boolean(RAW.name, &mut self.report).map_or(gamma.is_some_and(|g| g.value == 1.0), |r| r.value);
        let bilinear = self.filter_type(p);
        let wrap = self.wrap_mode(p);
        p.leave_out(BITMAP.parameters, &mut self.report);
        if !p.has(FILENAME.name) {
            self.report.error(p.place, "a bitmap texture needs a \"filename\"");
        }
        let filename = p.string(FILENAME.name, &mut self.report)?;
        let bitmap = self.images.read(&filename, raw, true, &mut self.files, &mut self.report)?;
        Some(TextureKind::Bitmap { bitmap, wrap, bilinear })
    }

    fn filter_type(&mut self, p: &mut Properties<'_>) -> bool {
        let Some(filter) = p.string(FILTER_TYPE.name, &mut self.report) else { return true };
        match filter.value.as_str() {
            "nearest" => return false,
            "bilinear" => {}
            "trilinear" | "ewa" => {
                let message = format!("filter {} is not supported, bilinear is taken", quoted(&filter.value));
                self.report.warning(filter.place, message);
            }
            _ => self.report.error(filter.place, "\"filter_type\" must be bilinear or nearest"),
        }
        true
    }

    fn wrap_mode(&mut self, p: &mut Properties<'_>) -> Wrap {
        let Some(wrap) = p.string(WRAP_MODE.name, &mut self.report) else { return Wrap::Repeat };
        match wrap.value.as_str() {
            "repeat" => Wrap::Repeat,
            "mirror" => Wrap::Mirror,
            "clamp" => Wrap::Clamp,
            _ => {
                self.report.error(wrap.place, "\"wrap_mode\" must be repeat, mirror or clamp");
                Wrap::Repeat
            }
        }
    }
}

/// What a transform of space does in the plane z = 0.
fn in_plane(t: &DAffine3) -> DAffine2 {
    let m = t.matrix3;
    DAffine2::from_cols(m.x_axis.truncate(), m.y_axis.truncate(), t.translation.truncate())
}
