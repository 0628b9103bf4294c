//! Lookups at points and over areas.

use super::*;

fn texture(kind: TextureKind) -> Texture {
    Texture { name: "t".into(), to_uv: DAffine2::IDENTITY, kind }
}

fn sampler(kind: TextureKind) -> Sampler {
    (*samplers(&[texture(kind)], &[None])[0]).clone()
}

fn at(u: f32, v: f32) -> At {
    At { uv: Vec2::new(u, v), corner: Corner::default() }
}

#[test]
fn bitmaps_start_at_the_top_left_and_wrap_as_asked() {
    let pixels = [1.0, 2.0, 3.0, 4.0].map(Rgb::splat).to_vec();
    let bitmap = Arc::new(Bitmap::new(2, 2, pixels));
    let value = |wrap, bilinear, u, v| {
        sampler(TextureKind::Bitmap { bitmap: bitmap.clone(), wrap, bilinear }).colour(&at(u, v)).r
    };
    assert_eq!(value(Wrap::Repeat, false, 0.1, 0.9), 1.0);
    assert_eq!(value(Wrap::Repeat, false, 0.9, 0.1), 4.0);
    assert_eq!(value(Wrap::Repeat, false, 1.1, 0.9), 1.0);
    assert_eq!(value(Wrap::Clamp, false, 1.1, 0.9), 2.0);
    assert_eq!(value(Wrap::Mirror, false, 1.1, 0.9), 2.0);
    assert_eq!(value(Wrap::Mirror, false, -0.1, 0.9), 1.0);
    assert!((value(Wrap::Clamp, true, 0.5, 0.5) - 2.5).abs() < 1e-6);
    assert!((value(Wrap::Repeat, true, 0.0, 0.75) - 1.5).abs() < 1e-6);
}

/// A mesh may have coordinates of 10³⁰⁰, a transform may magnify them, and between two infinities lies no number.
#[test]
fn coordinates_beyond_all_fractions_have_a_colour_all_the_same() {
    let bitmap = Arc::new(Bitmap::new(2, 2, vec![Rgb::splat(0.5); 4]));
    for far in [1e13, -1e30, f32::MAX, f32::INFINITY, f32::NEG_INFINITY, f32::NAN] {
        for wrap in [Wrap::Repeat, Wrap::Clamp, Wrap::Mirror] {
            for bilinear in [false, true] {
                let kind = TextureKind::Bitmap { bitmap: bitmap.clone(), wrap, bilinear };
                for uv in [Vec2::new(far, 0.3), Vec2::new(0.3, far), Vec2::splat(far)] {
                    assert_eq!(
                        sampler(kind.clone()).colour(&at(uv.x, uv.y)),
                        Rgb::splat(0.5),
                        "{uv} {wrap:?}"
                    );
                    let mut magnified = sampler(kind.clone());
                    magnified.to_uv = DAffine2::from_scale((1e300, 1e300).into());
                    assert_eq!(
                        magnified.colour(&at(uv.x, uv.y)),
                        Rgb::splat(0.5),
                        "{uv} {wrap:?}, magnified"
                    );
                }
            }
        }
    }
}

#[test]
fn the_checkerboards_first_field_is_at_the_origin() {
    let s = sampler(TextureKind::Checkerboard { colours: [Rgb::BLACK, Rgb::WHITE].map(Colour::from) });
    let value = |u, v| s.colour(&at(u, v)).r;
    assert_eq!((value(0.2, 0.2), value(0.7, 0.2), value(0.7, 0.7), value(1.2, 0.2)), (0.0, 1.0, 0.0, 0.0));
}

#[test]
fn textures_inside_a_checkerboard_take_the_coordinates_of_the_surface() {
    let ramp = Bitmap::new(2, 1, vec![Rgb::splat(0.25), Rgb::splat(0.75)]);
    let ramp = TextureKind::Bitmap { bitmap: Arc::new(ramp), wrap: Wrap::Repeat, bilinear: false };
    let colours = [Colour::Texture(0), Colour::Constant(Rgb::WHITE)];
    let board = Texture {
        to_uv: DAffine2::from_scale((4.0, 4.0).into()),
        ..texture(TextureKind::Checkerboard { colours })
    };
    let all = samplers(&[texture(ramp), board], &[None, None]);
    let value = |u, v| all[1].colour(&at(u, v)).r;
    assert_eq!([value(0.05, 0.05), value(0.55, 0.05), value(0.2, 0.05)], [0.25, 0.75, 1.0]);
    let axes = [Vec2::X * 0.25, Vec2::Y * 0.25];
    assert!((all[1].filtered(&at(0.25, 0.5), &axes).r - 0.625).abs() < 1e-6);
}

/// The mean of all that is filtered is the mean of all points, whatever the footprint.
#[test]
fn filtering_keeps_the_mean() {
    let pixels = (0..60).map(|i: u32| Rgb::splat((i * i * 7 % 23) as f32 / 23.0)).collect();
    let bitmap = Arc::new(Bitmap::new(10, 6, pixels));
    let kinds = [
        TextureKind::Bitmap { bitmap: Arc::clone(&bitmap), wrap: Wrap::Repeat, bilinear: true },
        TextureKind::Bitmap { bitmap: Arc::clone(&bitmap), wrap: Wrap::Repeat, bilinear: false },
        TextureKind::Checkerboard { colours: [0.1, 0.9].map(|c| Rgb::splat(c).into()) },
    ];
    for kind in kinds {
        let s = sampler(kind);
        let n = 120;
        let place = |i: i32| (i as f32 + 0.5) / n as f32;
        let mean = |look: &dyn Fn(&At) -> Rgb| {
            let sum: f32 = (0..n * n).map(|i| look(&at(place(i % n), place(i / n))).r).sum();
            sum / (n * n) as f32
        };
        let points = mean(&|at| s.colour(at));
        for axes in [
            [Vec2::new(0.3, 0.0), Vec2::new(0.0, 0.3)],
            [Vec2::new(0.9, 0.2), Vec2::new(0.01, 0.05)],
            [Vec2::new(3.0, 1.0), Vec2::new(0.5, 0.5)],
        ] {
            let filtered = mean(&|at| s.filtered(at, &axes));
            assert!((filtered / points - 1.0).abs() < 0.01, "{axes:?}: {filtered} {points}");
        }
    }
}

#[test]
fn a_footprint_within_a_pixel_changes_no_bit_and_one_over_all_has_the_mean() {
    let pixels = (0..64).map(|i: u32| Rgb::splat((i * 37 % 64) as f32 / 64.0)).collect();
    let bitmap = Arc::new(Bitmap::new(8, 8, pixels));
    for bilinear in [true, false] {
        let s = sampler(TextureKind::Bitmap { bitmap: Arc::clone(&bitmap), wrap: Wrap::Repeat, bilinear });
        let small = [Vec2::X * 0.08, Vec2::Y * 0.08];
        assert_eq!(s.filtered(&at(0.3, 0.6), &small), s.colour(&at(0.3, 0.6)));
        let all = [Vec2::X * 9.0, Vec2::Y * 8.0];
        let mean = bitmap.pixels.iter().map(|p| p.r).sum::<f32>() / 64.0;
        assert!((s.filtered(&at(0.3, 0.6), &all).r - mean).abs() < 1e-5);
        assert_eq!(s.filtered(&at(0.3, 0.6), &[Vec2::NAN; 2]), s.colour(&at(0.3, 0.6)));
    }
}
