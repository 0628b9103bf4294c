//! Pixels that say more of filters than of light: those that see an emitter brighter than white, and their neighbours.

use foton_film::Image;
use foton_integrator::WHITE;

/// Pixels that do not see an emitter brighter than white, and have no neighbour that does. `emission` has what is seen of emitters, `image`
/// all light.
#[must_use]
pub fn without_bright_emitters(emission: &Image, image: &Image) -> Vec<bool> {
    let light = |pixel: usize| f64::from(image.pixels[pixel].luminance());
    let seen = |pixel: usize| f64::from(emission.pixels[pixel].luminance());
    let dark = (0..image.pixels.len()).filter(|&pixel| seen(pixel) <= 0.0);
    let (sum, count) = dark.fold((0.0, 0.0), |(sum, count), pixel| (sum + light(pixel), count + 1.0));
    let white = WHITE * sum / f64::max(count, 1.0);
    let (width, height) = (image.width as usize, image.height as usize);
    let is_bright = |x: usize, y: usize| seen(y * width + x) > white;
    let near = |at: usize, end: usize| at.saturating_sub(1)..(at + 2).min(end);
    let counts = |pixel: usize| {
        let (x, y) = (pixel % width, pixel / width);
        !near(y, height).any(|y| near(x, width).any(|x| is_bright(x, y)))
    };
    (0..image.pixels.len()).map(counts).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use foton_math::Rgb;

    #[test]
    fn a_bright_lamp_and_its_neighbours_are_left_out_and_a_dim_one_is_not() {
        let mut emission = Image::black(5, 4);
        let mut image = Image { width: 5, height: 4, pixels: vec![Rgb::splat(1.0); 20] };
        (emission.pixels[0], image.pixels[0]) = (Rgb::splat(100.0), Rgb::splat(100.0));
        (emission.pixels[19], image.pixels[19]) = (Rgb::splat(4.0), Rgb::splat(4.0));
        let left_out: Vec<usize> = without_bright_emitters(&emission, &image)
            .iter()
            .enumerate()
            .filter(|(_, c)| !**c)
            .map(|(i, _)| i)
            .collect();
        assert_eq!(left_out, [0, 1, 5, 6]);
    }
}
