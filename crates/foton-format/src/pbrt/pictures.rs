//! Pictures to textures of the description. What that cannot compose becomes one bitmap (`baked.rs`).

use std::rc::Rc;
use std::sync::Arc;

use foton_math::Rgb;
use foton_math::glam::{DAffine2, DVec2};
use foton_scene::description::{Bitmap, Colour, Number, Texture, TextureKind, Wrap};

use super::made::Coordinates;
use super::reader::Reader;
use super::texture::{ImageFile, Picture};
use crate::diagnostic::Place;
use crate::image::{Purpose, Reading};

/// What a picture is for.
#[derive(Clone, Copy)]
pub(crate) struct Wanted {
    pub(crate) purpose: Purpose,
    pub(crate) factor: Rgb,
    pub(crate) coordinates: Coordinates,
    /// Of what has the picture, for what is wrong with its colours.
    pub(crate) place: Place,
}

impl Wanted {
    const fn key(&self, picture: *const Picture) -> super::made::TextureKey {
        let [r, g, b] = self.factor.to_array();
        (picture, [r.to_bits(), g.to_bits(), b.to_bits()], self.purpose, self.coordinates)
    }
}

impl Reader<'_> {
    /// A share of light; black where the picture is not valid, which was reported.
    pub(crate) fn share(
        &mut self,
        picture: &Rc<Picture>,
        factor: f32,
        coordinates: Coordinates,
        place: Place,
    ) -> Colour {
        let wanted = Wanted { purpose: Purpose::Share, factor: Rgb::splat(factor), coordinates, place };
        self.made(picture, wanted).unwrap_or(Colour::Constant(Rgb::BLACK))
    }

    /// A number.
    pub(crate) fn number(&mut self, picture: &Rc<Picture>, coordinates: Coordinates, place: Place) -> Number {
        let wanted = Wanted { purpose: Purpose::Number, factor: Rgb::WHITE, coordinates, place };
        match self.made(picture, wanted) {
            Some(Colour::Constant(c)) => Number::Constant(c.mean()),
            Some(Colour::Texture(i)) => Number::Texture(i),
            None => Number::Constant(0.0),
        }
    }

    /// The colour that a picture becomes.
    pub(crate) fn made(&mut self, picture: &Rc<Picture>, wanted: Wanted) -> Option<Colour> {
        if let Some(constant) = picture.constant() {
            return Some(Colour::Constant(self.within(constant * wanted.factor, wanted)));
        }
        let key = wanted.key(Rc::as_ptr(picture));
        if let Some(known) = self.made_textures.indices.get(&key) {
            return known.map(Colour::Texture);
        }
        let factor_inside = |[a, b]: &[Rc<Picture>; 2]| match (a.constant(), b.constant()) {
            (Some(factor), None) => Some((Rc::clone(b), factor)),
            (None, Some(factor)) => Some((Rc::clone(a), factor)),
            _ => None,
        };
        if let Picture::Product(factors) = &**picture
            && let Some((inner, factor)) = factor_inside(factors)
        {
            return self.made(&inner, Wanted { factor: wanted.factor * factor, ..wanted });
        }
        let made = self.texture(picture, wanted);
        self.made_textures.pictures.push(Rc::clone(picture));
        self.made_textures.indices.insert(key, made);
        made.map(Colour::Texture)
    }

    /// A colour within what its purpose allows.
    fn within(&mut self, colour: Rgb, wanted: Wanted) -> Rgb {
        if wanted.purpose == Purpose::Share && colour.max_component() > 1.0 {
            if colour.max_component() > 1.0001 {
                let message = "a share of light is larger than 1, it is cut to that".to_owned();
                self.report.warn_once(wanted.place, message);
            }
            return colour.map(|c| c.min(1.0));
        }
        colour
    }

    /// The texture that a picture becomes.
    fn texture(&mut self, picture: &Rc<Picture>, wanted: Wanted) -> Option<usize> {
        let (name, to_st, kind) = match &**picture {
            Picture::Image(file) => {
                let bitmap = self.bitmap(file, wanted.factor, wanted.purpose)?;
                let kind = TextureKind::Bitmap { bitmap, wrap: file.wrap, bilinear: file.bilinear };
                ("imagemap", file.to_st, kind)
            }
            Picture::Squares { to_st, squares } => {
                let [a, b] = [0, 1].map(|i| self.made(&squares[i], wanted));
                // Ours has two squares to the unit.
                let to_st = DAffine2::from_scale(DVec2::splat(0.5)) * *to_st;
                ("checkerboard", to_st, TextureKind::Checkerboard { colours: [a?, b?] })
            }
            Picture::Corners { to_st, colours } => {
                // Rows begin at the top, where v is 1, and colours stand in the middle of pixels.
                let [below_left, above_left, below_right, above_right] =
                    colours.map(|c| self.within(c * wanted.factor, wanted));
                let pixels = vec![above_left, above_right, below_left, below_right];
                let bitmap = Arc::new(Bitmap::new(2, 2, pixels));
                let inner =
                    DAffine2::from_scale_angle_translation(DVec2::splat(0.5), 0.0, DVec2::splat(0.25));
                ("bilerp", inner * *to_st, TextureKind::Bitmap { bitmap, wrap: Wrap::Clamp, bilinear: true })
            }
            Picture::Curved { of, by } if matches!(**of, Picture::Image(_)) => {
                let Picture::Image(file) = &**of else { return None };
                let plain = self.bitmap(file, Rgb::WHITE, Purpose::Number)?;
                if !self.take(size_of_val(&plain.pixels[..]) as u64, wanted.place) {
                    return None;
                }
                let pixels = plain.pixels.iter().map(|p| p.map(by) * wanted.factor).collect();
                let bitmap = Arc::new(Bitmap::new(plain.width, plain.height, pixels));
                (
                    "imagemap",
                    file.to_st,
                    TextureKind::Bitmap { bitmap, wrap: file.wrap, bilinear: file.bilinear },
                )
            }
            Picture::Constant(_) | Picture::Product(_) | Picture::Mix { .. } | Picture::Curved { .. } => {
                let baked = self.baked(picture, wanted)?;
                let bitmap = Arc::new(baked);
                (
                    "mix",
                    DAffine2::IDENTITY,
                    TextureKind::Bitmap { bitmap, wrap: Wrap::Repeat, bilinear: true },
                )
            }
        };
        let index = self.description.textures.len();
        let name = format!("{name}-{}", index + 1);
        let to_uv = to_st * wanted.coordinates.to_pbrt();
        self.description.textures.push(Texture { name, to_uv, kind });
        Some(index)
    }

    /// The pixels of a file, times a factor.
    pub(super) fn bitmap(&mut self, file: &ImageFile, factor: Rgb, purpose: Purpose) -> Option<Arc<Bitmap>> {
        let ImageFile { filename, curve, scale, invert, .. } = file;
        let factor = factor * *scale;
        if !invert {
            let reading = Reading { curve: *curve, channel: None, factor, purpose };
            return self.images.read(filename, reading, &mut self.files, &mut self.report);
        }
        let reading = Reading { curve: *curve, channel: None, factor: Rgb::WHITE, purpose: Purpose::Number };
        let bitmap = self.images.read(filename, reading, &mut self.files, &mut self.report)?;
        if !self.take(size_of_val(&bitmap.pixels[..]) as u64, filename.place) {
            return None;
        }
        let most = if purpose == Purpose::Share { 1.0 } else { f32::MAX };
        let inverted = |p: &Rgb| (p.map(|c| 1.0 - c) * factor).map(|c| c.clamp(0.0, most));
        let pixels = bitmap.pixels.iter().map(inverted).collect();
        Some(Arc::new(Bitmap::new(bitmap.width, bitmap.height, pixels)))
    }
}
