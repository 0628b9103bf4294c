//! Depth of field, and cameras without perspective, against closed forms.

use std::num::NonZeroU32;

use foton_integrator::{PpmSettings, RenderSettings};
use foton_math::Rgb;
use foton_math::glam::{DAffine3, DVec3};
use foton_scene::description::{Lens, Projection, SensorDescription};
use foton_tests::{Sketch, grey};

const PIXELS: u32 = 48;
const FOV_DEGREES: f64 = 20.0;
const DEPTH: f64 = 5.0;
/// Half a side of a bright square.
const HALF: f64 = 0.15;

/// Sum of the image and the mean square of the distance from its middle, in pixels, of a bright square that faces the camera.
fn spread(lens: Option<Lens>) -> [f64; 2] {
    spread_seen_by(|sensor| sensor.lens = lens)
}

fn spread_seen_by(change: impl FnOnce(&mut SensorDescription)) -> [f64; 2] {
    let mut sketch = Sketch::default()
        .camera(DVec3::new(0.0, 0.0, DEPTH), DVec3::ZERO, FOV_DEGREES, PIXELS)
        .rectangle(DVec3::ZERO, DVec3::X * HALF, DVec3::Y * HALF, grey(0.0), Some(Rgb::WHITE))
        .max_depth(1);
    change(&mut sketch.0.sensors[0]);
    let settings = RenderSettings {
        samples_per_pixel: NonZeroU32::new(256).expect("above 0"),
        ppm: PpmSettings { photons_per_pass: NonZeroU32::MIN, ..PpmSettings::default() },
        ..RenderSettings::default()
    };
    let image = sketch.render(settings, 1).image();
    let (mut sum, mut squares) = (0.0, 0.0);
    for (i, pixel) in (0..).zip(&image.pixels) {
        let [x, y] = [i % PIXELS, i / PIXELS].map(|v| f64::from(v) + 0.5 - 0.5 * f64::from(PIXELS));
        sum += f64::from(pixel.g);
        squares += f64::from(pixel.g) * (x * x + y * y);
    }
    [sum, squares / sum]
}

/// A thin lens of radius R focused at f spreads a point at depth z evenly over a disc of radius R|z/f − 1| there, whatever the
/// point: the image keeps its sum, and the mean square of distances, h²·2/3 for a square of half side h and 1/6 for a pixel, grows by
/// half the disc's squared radius.
#[test]
fn a_square_out_of_focus_spreads_over_the_circle_of_confusion_and_keeps_its_light() {
    let pixel = 2.0 * DEPTH * (0.5 * FOV_DEGREES).to_radians().tan() / f64::from(PIXELS);
    let area = (2.0 * HALF / pixel).powi(2);
    let sharp = 2.0 / 3.0 * (HALF / pixel).powi(2) + 1.0 / 6.0;
    for (aperture_radius, focus_distance) in [(0.0, 3.0), (0.6, 5.0), (0.6, 3.0), (0.15, 20.0)] {
        let confusion = aperture_radius * (DEPTH / focus_distance - 1.0f64).abs() / pixel;
        let [sum, square] = spread(Some(Lens { aperture_radius, focus_distance }));
        let expected = sharp + 0.5 * confusion * confusion;
        let subject = format!("{aperture_radius} at {focus_distance}: a disc of {confusion} pixels");
        assert!((sum / area - 1.0).abs() < 0.02, "{subject}: {sum}, expected {area}");
        assert!((square / expected - 1.0).abs() < 0.02, "{subject}: {square}, expected {expected}");
    }
    assert_eq!(spread(None), spread(Some(Lens { aperture_radius: 0.0, focus_distance: 3.0 })));
}

/// Parallel rays show it as large from anywhere: an image of w × h units has (2 half)² / (w h) of its pixels bright. A telecentric lens
/// spreads it as any lens does. An offset of the principal point moves the image by its share.
#[test]
fn a_square_without_perspective_has_its_own_size_at_any_distance() {
    let half_width = 0.8;
    let orthographic = |change: &dyn Fn(&mut SensorDescription)| {
        spread_seen_by(|sensor| {
            sensor.projection = Projection::Orthographic;
            sensor.to_world *= DAffine3::from_scale(DVec3::new(half_width, half_width, 1.0));
            change(sensor);
        })
    };
    let pixel = 2.0 * half_width / f64::from(PIXELS);
    let area = (2.0 * HALF / pixel).powi(2);
    let sharp = 2.0 / 3.0 * (HALF / pixel).powi(2) + 1.0 / 6.0;
    let close = |[sum, square]: [f64; 2], expected: f64, subject: &str| {
        assert!((sum / area - 1.0).abs() < 0.02, "{subject}: {sum}, expected {area}");
        assert!((square / expected - 1.0).abs() < 0.02, "{subject}: {square}, expected {expected}");
    };
    for nearer in [0.0, 3.0, 4.9] {
        close(orthographic(&|s| s.to_world.translation.z -= nearer), sharp, &format!("{nearer}"));
    }
    let lens = Some(Lens { aperture_radius: 0.4, focus_distance: 3.0 });
    let confusion = 0.4 * (DEPTH / 3.0 - 1.0) / pixel;
    close(orthographic(&|s| s.lens = lens), sharp + 0.5 * confusion * confusion, "telecentric");
    // Two ninths of 48 pixels to the left, and as many up.
    let shift = 2.0 / 9.0 * f64::from(PIXELS);
    let shifted = orthographic(&|s| s.principal_point_offset = [2.0 / 9.0; 2]);
    close(shifted, sharp + 2.0 * shift * shift, "shifted");
    let clipped = orthographic(&|s| s.near_clip = Some(DEPTH + 0.01));
    assert_eq!(clipped[0], 0.0, "nearer than the near clip");
    let clipped = orthographic(&|s| s.far_clip = Some(DEPTH - 0.01));
    assert_eq!(clipped[0], 0.0, "farther than the far clip");
}
