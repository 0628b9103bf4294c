//! Products and mixtures of textures as one bitmap over the unit square, which repeats.

use std::rc::Rc;
use std::sync::Arc;

use foton_math::Rgb;
use foton_math::glam::{DAffine2, DVec2};
use foton_scene::description::{Bitmap, Wrap};

use super::pictures::Wanted;
use super::reader::Reader;
use super::texture::Picture;
use crate::image::Purpose;

/// Sides of bitmaps in pixels: as many as the largest picture inside has, within these.
const SIDES: [u32; 2] = [256, 2048];
/// Textures may stand so deep inside one another.
const DEEPEST: usize = 16;

/// A picture with its pixels at hand.
enum Ready {
    Constant(Rgb),
    Pixels(Arc<Bitmap>, DAffine2, Wrap),
    Squares(DAffine2, Box<[Self; 2]>),
    Product(Box<[Self; 2]>),
    Mix(Box<[Self; 3]>),
    Curved(Box<Self>, fn(f32) -> f32),
    Corners(DAffine2, [Rgb; 4]),
}

impl Reader<'_> {
    /// The bitmap of a picture that is composed of others.
    pub(super) fn baked(&mut self, picture: &Rc<Picture>, wanted: Wanted) -> Option<Bitmap> {
        let message =
            "textures that are multiplied or mixed become one picture over the unit square, which repeats"
                .to_owned();
        self.report.warn_once(wanted.place, message);
        let ready = self.ready(picture, 0, wanted)?;
        let side = ready.side().clamp(SIDES[0], SIDES[1]);
        if !self.take(u64::from(side) * u64::from(side) * size_of::<Rgb>() as u64, wanted.place) {
            return None;
        }
        let most = if wanted.purpose == Purpose::Share { 1.0 } else { f32::MAX };
        let middle = |i: u32| (f64::from(i) + 0.5) / f64::from(side);
        let mut pixels = Vec::with_capacity((side * side) as usize);
        for y in 0..side {
            if self.files.cancel().is_requested() {
                return None;
            }
            let v = 1.0 - middle(y);
            let colour = |x| (ready.at(DVec2::new(middle(x), v)) * wanted.factor).map(|c| c.clamp(0.0, most));
            pixels.extend((0..side).map(colour));
        }
        Some(Bitmap::new(side, side, pixels))
    }

    /// A number that no channel of a picture exceeds, at most 1.
    pub(super) fn most(&mut self, picture: &Rc<Picture>, wanted: Wanted) -> f32 {
        self.ready(picture, 0, wanted).map_or(1.0, |ready| ready.most().clamp(0.0, 1.0))
    }

    /// A picture with the pixels of its files.
    fn ready(&mut self, picture: &Picture, depth: usize, wanted: Wanted) -> Option<Ready> {
        if depth > DEEPEST {
            self.report.error(wanted.place, format!("more than {DEEPEST} textures stand inside one another"));
            return None;
        }
        let mut inner = |picture: &Rc<Picture>| self.ready(picture, depth + 1, wanted);
        Some(match picture {
            Picture::Constant(colour) => Ready::Constant(*colour),
            Picture::Image(file) => {
                let bitmap = self.bitmap(file, Rgb::WHITE, Purpose::Number)?;
                Ready::Pixels(bitmap, file.to_st, file.wrap)
            }
            Picture::Squares { to_st, squares: [a, b] } => {
                Ready::Squares(*to_st, Box::new([inner(a)?, inner(b)?]))
            }
            Picture::Product([a, b]) => Ready::Product(Box::new([inner(a)?, inner(b)?])),
            Picture::Mix { ends: [a, b], amount } => {
                Ready::Mix(Box::new([inner(a)?, inner(b)?, inner(amount)?]))
            }
            Picture::Curved { of, by } => Ready::Curved(Box::new(inner(of)?), *by),
            Picture::Corners { to_st, colours } => Ready::Corners(*to_st, *colours),
        })
    }
}

impl Ready {
    /// A number that no channel exceeds.
    fn most(&self) -> f32 {
        let of_all = |all: &[Self]| all.iter().map(Self::most).fold(0.0, f32::max);
        match self {
            Self::Constant(colour) => colour.max_component(),
            Self::Pixels(bitmap, ..) => bitmap.pixels.iter().map(|p| p.max_component()).fold(0.0, f32::max),
            Self::Squares(_, squares) => of_all(&squares[..]),
            Self::Product(factors) => factors[0].most() * factors[1].most(),
            Self::Mix(parts) => of_all(&parts[..2]),
            Self::Curved(of, by) => by(of.most()),
            Self::Corners(_, colours) => colours.iter().map(|c| c.max_component()).fold(0.0, f32::max),
        }
    }

    /// The largest side of a bitmap inside.
    fn side(&self) -> u32 {
        let of_all = |all: &[Self]| all.iter().map(Self::side).max().unwrap_or_default();
        match self {
            Self::Pixels(bitmap, ..) => bitmap.width.max(bitmap.height),
            Self::Squares(_, squares) => of_all(&squares[..]).max(1024),
            Self::Product(factors) => of_all(&factors[..]),
            Self::Mix(parts) => of_all(&parts[..]),
            Self::Curved(of, _) => of.side(),
            Self::Constant(_) | Self::Corners(..) => 0,
        }
    }

    fn at(&self, uv: DVec2) -> Rgb {
        let mix = |a: Rgb, b: Rgb, t: f32| a * (1.0 - t) + b * t;
        match self {
            Self::Constant(colour) => *colour,
            Self::Pixels(bitmap, to_st, wrap) => pixel(bitmap, to_st.transform_point2(uv), *wrap),
            Self::Squares(to_st, squares) => {
                let st = to_st.transform_point2(uv).floor();
                squares[usize::from((st.x + st.y).rem_euclid(2.0) >= 1.0)].at(uv)
            }
            Self::Product(factors) => factors[0].at(uv) * factors[1].at(uv),
            Self::Mix(parts) => mix(parts[0].at(uv), parts[1].at(uv), parts[2].at(uv).mean().clamp(0.0, 1.0)),
            Self::Curved(of, by) => of.at(uv).map(by),
            Self::Corners(to_st, [a, b, c, d]) => {
                let st = to_st.transform_point2(uv).as_vec2();
                mix(mix(*a, *b, st.y), mix(*c, *d, st.y), st.x)
            }
        }
    }
}

/// The pixel of a bitmap at a place, v pointing up.
fn pixel(bitmap: &Bitmap, st: DVec2, wrap: Wrap) -> Rgb {
    let inside = |x: f64| if wrap == Wrap::Clamp { x.clamp(0.0, 1.0) } else { x.rem_euclid(1.0) };
    let index = |x: f64, size: u32| ((x * f64::from(size)) as u32).min(size - 1) as usize;
    let (x, y) = (index(inside(st.x), bitmap.width), index(1.0 - inside(st.y), bitmap.height));
    bitmap.pixels[y * bitmap.width as usize + x]
}
