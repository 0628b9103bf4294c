//! How bright a picture is: a histogram of its pixels in stops, made once for each picture.

use std::sync::Arc;

use foton_film::Image;

/// Stops of the scale: the first and the last, about 1 W/m²/sr.
pub(crate) const STOPS: std::ops::Range<i32> = -16..16;

/// Bars for each stop.
pub(crate) const PER_STOP: usize = 4;

/// Bars.
pub(crate) const BARS: usize = (STOPS.end - STOPS.start) as usize * PER_STOP;

/// Pixels that are looked at, at most: of larger pictures each n-th.
const PIXELS: usize = 1 << 18;

/// The histogram of a picture's luminance.
#[derive(Clone)]
pub(crate) struct LightScale {
    /// What it is of.
    picture: Arc<Image>,
    /// Shares of the pixels by luminance.
    pub(crate) bars: [f32; BARS],
    /// Shares that are darker, and brighter, than the scale.
    pub(crate) beyond: [f32; 2],
}

impl LightScale {
    pub(crate) fn of(picture: &Arc<Image>) -> Self {
        let step = (picture.pixels.len() / PIXELS).max(1);
        let mut scale = Self { picture: Arc::clone(picture), bars: [0.0; BARS], beyond: [0.0; 2] };
        let each = 1.0 / picture.pixels.len().div_ceil(step).max(1) as f32;
        for pixel in picture.pixels.iter().step_by(step) {
            let place = (pixel.luminance().log2() - STOPS.start as f32) * PER_STOP as f32;
            // What is black, negative or no number is darker than all.
            if place >= BARS as f32 {
                scale.beyond[1] += each;
            } else if place >= 0.0 {
                scale.bars[place as usize] += each;
            } else {
                scale.beyond[0] += each;
            }
        }
        scale
    }

    /// Whether it is of that picture.
    pub(crate) fn is_of(&self, picture: &Arc<Image>) -> bool {
        Arc::ptr_eq(&self.picture, picture)
    }

    /// The share of the pixels above white at an exposure.
    pub(crate) fn above_white(&self, stops: f32) -> f32 {
        let white = |i: usize| STOPS.start as f32 + i as f32 / PER_STOP as f32 >= -stops;
        let bars = self.bars.iter().enumerate().filter(|(i, _)| white(*i));
        self.beyond[1] + bars.map(|(_, bar)| bar).sum::<f32>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use foton_math::Rgb;

    fn picture(values: &[f32]) -> Arc<Image> {
        let pixels = values.iter().map(|&v| Rgb::splat(v)).collect();
        Arc::new(Image { width: values.len() as u32, height: 1, pixels })
    }

    #[test]
    fn pixels_are_counted_by_stops_and_what_is_none_is_dark() {
        let scale = LightScale::of(&picture(&[1.0, 1.01, 2.0, 0.0, -1.0, f32::NAN, f32::INFINITY, 4.0]));
        let at = |stops: i32| scale.bars[(stops - STOPS.start) as usize * PER_STOP];
        assert_eq!((at(0), at(1), at(2)), (0.25, 0.125, 0.125));
        assert_eq!(scale.beyond, [0.375, 0.125]);
        assert!(
            (scale.above_white(0.0) - 0.625).abs() < 1e-6 && (scale.above_white(-1.5) - 0.25).abs() < 1e-6
        );
    }
}
