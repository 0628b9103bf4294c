//! The directive `Texture`: what a name stands for.

use std::rc::Rc;

use foton_input::quoted;
use foton_math::Rgb;
use foton_math::glam::{DAffine2, DVec2};
use foton_scene::description::Wrap;

use super::colours::Meaning;
use super::parameters::{Kind, Parameters};
use super::reader::Reader;
use super::texture::{ImageFile, Picture};
use crate::diagnostic::Place;
use crate::image::Curve;
use crate::mitsuba::read::properties::Located;
use crate::spelling::did_you_mean;

/// Textures of both versions.
const PLUGINS: [&str; 14] = [
    "constant",
    "scale",
    "mix",
    "bilerp",
    "imagemap",
    "checkerboard",
    "directionmix",
    "dots",
    "fbm",
    "wrinkled",
    "marble",
    "windy",
    "ptex",
    "uv",
];

impl Reader<'_> {
    /// Defines a texture: of numbers (0) or colours (1).
    pub(crate) fn define_texture(&mut self, name: Located<String>, kind: &Located<String>, p: &Parameters) {
        let of_colours = match kind.value.as_str() {
            "float" => 0,
            "spectrum" | "color" => 1,
            other => {
                let hint = did_you_mean(other, ["float", "spectrum"]);
                self.report.error(
                    kind.place,
                    format!("a texture is of \"float\" or \"spectrum\", not {}{hint}", quoted(other)),
                );
                p.ignore_rest();
                return;
            }
        };
        let picture = self.texture_picture(p, of_colours == 1);
        p.finish(&mut self.report);
        // One that is not valid stands for something, so that nothing is said of its name.
        let picture = picture.unwrap_or_else(|| Rc::new(Picture::Constant(Rgb::BLACK)));
        self.textures[of_colours].define(name.value, picture);
    }

    fn texture_picture(&mut self, p: &Parameters, of_colours: bool) -> Option<Rc<Picture>> {
        match p.plugin.as_str() {
            "constant" => Some(self.part(p, "value", 1.0, of_colours)),
            "scale" => {
                // Version 4 calls the factor "scale", which is a number.
                let factor = if p.has("scale") { self.number_picture(p, "scale") } else { None };
                let first = self.part(p, if p.has("tex1") { "tex1" } else { "tex" }, 1.0, of_colours);
                let factor = match factor {
                    Some(factor) => factor,
                    None => self.part(p, "tex2", 1.0, of_colours),
                };
                Some(Picture::product(first, factor))
            }
            "mix" => {
                let ends = [self.part(p, "tex1", 0.0, of_colours), self.part(p, "tex2", 1.0, of_colours)];
                let amount = self
                    .number_picture(p, "amount")
                    .unwrap_or_else(|| Rc::new(Picture::Constant(Rgb::splat(0.5))));
                Some(mixed(ends, amount))
            }
            "directionmix" => {
                p.ignore(&["dir"]);
                self.report
                    .warning(p.place, "a texture that goes by the direction of the surface is mixed evenly");
                let ends = [self.part(p, "tex1", 0.0, of_colours), self.part(p, "tex2", 1.0, of_colours)];
                Some(mixed(ends, Rc::new(Picture::Constant(Rgb::splat(0.5)))))
            }
            "checkerboard" => Some(self.checkerboard(p, of_colours)),
            "bilerp" => {
                let corners = [("v00", 0.0), ("v01", 1.0), ("v10", 0.0), ("v11", 1.0)];
                let colours = corners.map(|(name, default)| {
                    self.part(p, name, default, of_colours).constant().unwrap_or_default()
                });
                let to_st = self.mapping(p);
                Some(Rc::new(Picture::Corners { to_st, colours }))
            }
            "imagemap" => self.image_map(p),
            "dots" | "fbm" | "wrinkled" | "windy" | "marble" | "ptex" | "uv" => {
                Some(self.mean_of_texture(p, of_colours))
            }
            other => {
                let hint = did_you_mean(other, PLUGINS);
                self.report.error(p.place, format!("unknown texture {}{hint}", quoted(other)));
                p.ignore_rest();
                None
            }
        }
    }

    /// What stands for a texture that is not rendered.
    fn mean_of_texture(&mut self, p: &Parameters, of_colours: bool) -> Rc<Picture> {
        if p.plugin == "dots" {
            p.ignore(&["inside"]);
            p.ignore(MAPPING);
            self.stands_in(p.place, "dots", "the colour outside of them");
            return self.part(p, "outside", 0.0, of_colours);
        }
        p.ignore_rest();
        let mean = match p.plugin.as_str() {
            "fbm" | "windy" => Rgb::BLACK,
            "wrinkled" => Rgb::splat(0.3),
            "marble" => Rgb::new(0.6, 0.59, 0.58),
            _ => Rgb::splat(0.5),
        };
        self.stands_in(p.place, &p.plugin, "its mean");
        Rc::new(Picture::Constant(mean))
    }

    fn stands_in(&mut self, place: Place, plugin: &str, what: &str) {
        self.report
            .warn_once(place, format!("textures of \"{plugin}\" are not rendered: {what} stands for them"));
    }

    /// What a texture is made of, by name.
    fn part(&mut self, p: &Parameters, name: &'static str, default: f32, of_colours: bool) -> Rc<Picture> {
        let found =
            if of_colours { self.picture_of(p, name, Meaning::Index) } else { self.number_picture(p, name) };
        found.unwrap_or_else(|| Rc::new(Picture::Constant(Rgb::splat(default))))
    }

    fn checkerboard(&mut self, p: &Parameters, of_colours: bool) -> Rc<Picture> {
        let squares = [self.part(p, "tex1", 1.0, of_colours), self.part(p, "tex2", 0.0, of_colours)];
        p.ignore(&["aamode"]);
        let dimension = p.integer("dimension", &mut self.report).map_or(2, |d| d.value);
        if dimension != 2 {
            p.ignore(MAPPING);
            self.stands_in(p.place, "checkerboard", "in space the mean of its colours");
            return mixed(squares, Rc::new(Picture::Constant(Rgb::splat(0.5))));
        }
        let to_st = self.mapping(p);
        Rc::new(Picture::Squares { to_st, squares })
    }

    fn image_map(&mut self, p: &Parameters) -> Option<Rc<Picture>> {
        let to_st = self.mapping(p);
        p.ignore(&["maxanisotropy", "trilinear"]);
        let bilinear = p.text("filter", &mut self.report).is_none_or(|filter| filter.value != "point");
        let scale = p.number_or("scale", 1.0, &mut self.report) as f32;
        let invert = p.boolean("invert", &mut self.report).unwrap_or(false);
        let wrap = self.wrap(p);
        let encoding = self.encoding(p);
        let Some(filename) = p.text("filename", &mut self.report) else {
            if !p.has("filename") {
                self.report.error(p.place, "an imagemap needs a \"filename\"");
            }
            return None;
        };
        // In version 3 PNG and TGA are sRGB, the rest is linear; in version 4 whatever has bytes is sRGB.
        let curve = encoding.unwrap_or(Curve::Srgb);
        Some(Rc::new(Picture::Image(ImageFile { filename, curve, scale, invert, wrap, bilinear, to_st })))
    }

    fn wrap(&mut self, p: &Parameters) -> Wrap {
        let Some(wrap) = p.text("wrap", &mut self.report) else { return Wrap::Repeat };
        match wrap.value.as_str() {
            "repeat" => Wrap::Repeat,
            "clamp" => Wrap::Clamp,
            "black" | "octahedralsphere" => {
                let message =
                    format!("the wrap mode {} is not supported, clamp is taken", quoted(&wrap.value));
                self.report.warning(wrap.place, message);
                Wrap::Clamp
            }
            _ => {
                let hint = did_you_mean(&wrap.value, ["repeat", "clamp", "black"]);
                self.report.error(wrap.place, format!("\"wrap\" must be repeat, clamp or black{hint}"));
                Wrap::Repeat
            }
        }
    }

    /// What bytes mean, where a file says it.
    fn encoding(&mut self, p: &Parameters) -> Option<Curve> {
        if let Some(gamma) = p.boolean("gamma", &mut self.report) {
            return Some(if gamma { Curve::Srgb } else { Curve::Power(1.0) });
        }
        let encoding = p.text("encoding", &mut self.report)?;
        let gamma = encoding.value.strip_prefix("gamma").and_then(|rest| rest.trim().parse::<f32>().ok());
        match (encoding.value.as_str(), gamma) {
            ("sRGB" | "srgb", _) => Some(Curve::Srgb),
            ("linear", _) => Some(Curve::Power(1.0)),
            (_, Some(gamma)) if (1e-3..1e3).contains(&gamma) => Some(Curve::Power(gamma)),
            _ => {
                self.report.error(
                    encoding.place,
                    "\"encoding\" must be sRGB, linear, or gamma with a number such as 2.2",
                );
                None
            }
        }
    }

    /// What makes texture coordinates of those of the surface.
    fn mapping(&mut self, p: &Parameters) -> DAffine2 {
        let kind = p.text("mapping", &mut self.report);
        if let Some(kind) = kind.filter(|kind| kind.value != "uv") {
            let known = ["uv", "spherical", "cylindrical", "planar"];
            if known.contains(&kind.value.as_str()) {
                let message = format!(
                    "the mapping {} is not supported: texture coordinates of the surface are taken",
                    quoted(&kind.value)
                );
                self.report.warning(kind.place, message);
            } else {
                let hint = did_you_mean(&kind.value, known);
                self.report.error(kind.place, format!("unknown mapping {}{hint}", quoted(&kind.value)));
            }
            p.ignore(MAPPING);
            return DAffine2::IDENTITY;
        }
        let [su, sv] = ["uscale", "vscale"].map(|name| p.number(name, &mut self.report).map(|n| n.value));
        let [du, dv] = ["udelta", "vdelta"].map(|name| p.number_or(name, 0.0, &mut self.report));
        p.ignore(&["v1", "v2"]);
        let scale = DVec2::new(su.unwrap_or(1.0), sv.unwrap_or(1.0));
        DAffine2::from_scale_angle_translation(scale, 0.0, DVec2::new(du, dv))
    }

    /// What the textures that parameters name stand for now.
    pub(crate) fn resolve_textures(&mut self, p: &mut Parameters) {
        for parameter in p.list.iter_mut().filter(|parameter| parameter.kind == Kind::Texture) {
            let super::parameters::Values::Texts(names) = &parameter.values else { continue };
            let [name] = &names[..] else {
                self.report.error(parameter.place, "a texture is one name in quotes");
                continue;
            };
            parameter.pictures = [0, 1].map(|i| self.textures[i].find(&name.value).cloned());
            // A texture of numbers stands for greys where there is no other one, and the other way around.
            if let [Some(found), None] | [None, Some(found)] = parameter.pictures.clone() {
                parameter.pictures = [Some(Rc::clone(&found)), Some(found)];
            }
            if parameter.pictures[0].is_none() {
                let names = self.textures.iter().flat_map(super::names::Names::all).collect::<Vec<_>>();
                let hint = self.report.did_you_mean(&name.value, names);
                self.report.error(name.place, format!("there is no texture {}{hint}", quoted(&name.value)));
            }
        }
    }
}

/// Parameters of mappings.
const MAPPING: &[&str] = &["mapping", "uscale", "vscale", "udelta", "vdelta", "v1", "v2"];

/// A mixture of two pictures; a colour where all is constant.
fn mixed(ends: [Rc<Picture>; 2], amount: Rc<Picture>) -> Rc<Picture> {
    match (ends[0].constant(), ends[1].constant(), amount.constant()) {
        (Some(a), Some(b), Some(t)) => Rc::new(Picture::Constant(a * (1.0 - t.mean()) + b * t.mean())),
        (_, _, Some(t)) if t.mean() <= 0.0 => Rc::clone(&ends[0]),
        (_, _, Some(t)) if t.mean() >= 1.0 => Rc::clone(&ends[1]),
        _ => Rc::new(Picture::Mix { ends, amount }),
    }
}
