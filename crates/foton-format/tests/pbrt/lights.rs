//! Lights: where they shine, in which direction and how brightly, by the units of each version.

use std::f64::consts::PI;

use foton_math::Rgb;
use foton_math::glam::DVec3;
use foton_scene::description::{Colour, EmitterKind, FovAxis, SceneDescription, TextureKind};

use super::{read, whole};

fn emitter(scene: &SceneDescription) -> &EmitterKind {
    &scene.emitters[0].kind
}

fn radiance(text: &str) -> Rgb {
    match read(text).shapes[0].radiance {
        Some(Colour::Constant(radiance)) => radiance,
        ref other => panic!("{text}: {other:?}"),
    }
}

fn assert_close(found: Rgb, wanted: [f32; 3]) {
    for (a, b) in found.to_array().iter().zip(wanted) {
        assert!((a - b).abs() <= 2e-3 * b.abs().max(0.1), "{found:?} is not {wanted:?}");
    }
}

#[test]
fn lamps_of_version_4_have_luminance_1_before_their_scale_and_power() {
    let lamp = |parameters: &str| {
        radiance(&whole(&format!("AreaLightSource \"diffuse\" {parameters} Shape \"sphere\"")))
    };
    assert_close(lamp("\"rgb L\" [1 2 3] \"float scale\" 2"), [2.0, 4.0, 6.0]);
    assert_close(lamp("\"spectrum L\" \"stdillum-D65\" \"float scale\" 3"), [3.0; 3]);
    for parameters in ["\"blackbody L\" 3000", "\"spectrum L\" [400 7 700 9]"] {
        let found = lamp(parameters);
        assert!((found.luminance() - 1.0).abs() < 1e-3, "{found:?}");
        assert!(found.r > found.b, "{found:?}");
    }
    // A sphere of area 4π with radiance 1 emits 4π² on one side.
    assert_close(lamp(&format!("\"float power\" {}", 4.0 * PI * PI)), [1.0; 3]);
    let text = whole(&format!(
        "Scale 3 3 3 AreaLightSource \"diffuse\" \"float power\" {} Shape \"disk\"",
        9.0 * PI * PI
    ));
    assert_close(radiance(&text), [1.0; 3]);
}

#[test]
fn lamps_of_version_3_are_as_bright_as_their_spectra() {
    let lamp = |parameters: &str| {
        radiance(&format!(
            "Film \"image\" Camera \"perspective\" WorldBegin AreaLightSource \"diffuse\" {parameters} Shape \"sphere\""
        ))
    };
    assert_close(lamp("\"color L\" [1 2 3] \"rgb scale\" [2 2 1]"), [2.0, 4.0, 3.0]);
    // The same at every wavelength, reddish beside D65.
    assert_close(lamp("\"spectrum L\" [400 2 700 2]"), [2.409_6, 1.896_6, 1.817_8]);
    assert_close(lamp("\"spectrum L\" \"light.spd\""), [1.2046, 0.9482, 0.9088]);
    // A black body is 1 at its peak, which green lies near at 5300 K.
    let found = lamp("\"blackbody L\" [5300 2]");
    assert!((found.luminance() / 2.0 - 0.98).abs() < 0.03, "{found:?}");
}

#[test]
fn a_lamp_of_two_sides_is_two_shapes() {
    let scene = read(&whole("AreaLightSource \"diffuse\" \"bool twosided\" true Shape \"disk\""));
    let sides: Vec<bool> = scene.shapes.iter().map(|s| s.flip_normals).collect();
    assert_eq!((sides, scene.shapes.iter().all(|s| s.radiance.is_some())), (vec![true, false], true));
}

#[test]
fn points_and_spots_stand_where_they_shine_from() {
    let scene =
        read(&whole("Translate 1 2 3 LightSource \"point\" \"rgb I\" [4 5 6] \"point3 from\" [1 0 0]"));
    let EmitterKind::Point { position, intensity } = emitter(&scene) else { panic!("{:?}", emitter(&scene)) };
    assert_eq!((*position, *intensity), (DVec3::new(2.0, 2.0, 3.0), Rgb::new(4.0, 5.0, 6.0)));
    let text = format!(
        "Rotate 90 0 0 1 LightSource \"spot\" \"point3 from\" [1 0 0] \"point3 to\" [1 5 0] \"float coneangle\" 60 \
         \"float conedeltaangle\" 20 \"float power\" {}",
        2.0 * PI
    );
    let scene = read(&whole(&text));
    let EmitterKind::Spot { to_world, intensity, cutoff_degrees, beam_degrees, .. } = emitter(&scene) else {
        panic!("no spot")
    };
    assert_eq!((*cutoff_degrees, *beam_degrees), (60.0, 40.0));
    assert!(
        (to_world.translation - DVec3::Y).length() < 1e-9
            && (to_world.matrix3.z_axis - DVec3::NEG_X).length() < 1e-9
    );
    let solid = (1.0 - 40f64.to_radians().cos()) + 0.5 * (40f64.to_radians().cos() - 0.5);
    assert_close(*intensity, [(1.0 / solid) as f32; 3]);
}

#[test]
fn light_from_afar_goes_from_the_first_point_to_the_second() {
    let scene = read(&whole(
        "Scale 1 1 2 LightSource \"distant\" \"point3 from\" [0 0 1] \"point3 to\" [0 0 -1] \"float illuminance\" 5",
    ));
    let EmitterKind::Directional { direction, irradiance } = emitter(&scene) else {
        panic!("no distant light")
    };
    assert_eq!((direction.normalize(), *irradiance), (DVec3::NEG_Z, Rgb::splat(5.0)));
}

#[test]
fn light_from_all_around_adds_up_and_has_a_picture_where_pbrt_has_it() {
    let scene = read(&whole(
        "LightSource \"infinite\" \"rgb L\" [1 2 3] LightSource \"infinite\" \"float illuminance\" 3.14159265",
    ));
    let EmitterKind::Constant { radiance } = emitter(&scene) else { panic!("no constant light") };
    assert_close(*radiance, [2.0, 3.0, 4.0]);
    // Latitudes begin at +z; the first half of the columns lies towards +y, where the angle from +x has grown to a quarter turn.
    for (mirror, left) in [("", false), ("Scale 1 -1 1", true)] {
        let scene = read(&whole(&format!(
            "{mirror} LightSource \"infinite\" \"string mapname\" \"two.hdr\" \"float scale\" 2"
        )));
        let EmitterKind::Environment { to_world, bitmap, .. } = emitter(&scene) else { panic!("no picture") };
        // In a description the middle of the right half lies towards −x of the map, as in Mitsuba.
        let right = to_world.transform_vector3(DVec3::NEG_X);
        let red_is_left = bitmap.pixels[0].r > 0.0;
        let red = if red_is_left { -right } else { right };
        let wanted = if left { DVec3::NEG_Y } else { DVec3::Y };
        assert!((red - wanted).length() < 1e-9, "{mirror}: {red}");
        assert!((to_world.transform_vector3(DVec3::Y) - DVec3::Z).length() < 1e-9);
        assert!(to_world.matrix3.determinant() > 0.0);
        assert_eq!(bitmap.pixels.iter().map(|p| p.max_component()).fold(0.0, f32::max), 4.0);
    }
}

#[test]
fn lamps_shine_by_their_pictures() {
    let old = "Film \"image\" Camera \"perspective\" WorldBegin Translate 1 2 3";
    let scene =
        read(&format!("{old} LightSource \"goniometric\" \"string mapname\" \"two.hdr\" \"rgb I\" [2 2 2]"));
    let EmitterKind::Goniometric { to_world, bitmap, .. } = emitter(&scene) else { panic!("no lamp") };
    // Rows are angles from +y, and columns grow from +x towards +z.
    assert_eq!(to_world.matrix3.to_cols_array(), [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0]);
    assert_eq!((to_world.translation, bitmap.pixels[1].g), (DVec3::new(1.0, 2.0, 3.0), 4.0));
    let scene = read(&whole("LightSource \"goniometric\" \"string filename\" \"one.hdr\""));
    let EmitterKind::Goniometric { bitmap, .. } = emitter(&scene) else { panic!("no lamp") };
    assert!(bitmap.pixels.iter().all(|p| *p == Rgb::WHITE), "{:?}", bitmap.pixels);
}

#[test]
fn pictures_are_thrown_with_the_intensity_that_they_have() {
    let scene = read(&whole(
        "LightSource \"projection\" \"string filename\" \"two.hdr\" \"float fov\" 90 \"float scale\" 3",
    ));
    let EmitterKind::Projector { to_world, irradiance, fov_degrees, fov_axis, .. } = emitter(&scene) else {
        panic!("no projector")
    };
    assert_eq!((*fov_degrees, *fov_axis), (90.0, FovAxis::Smaller));
    // The picture's left is towards −x, as it is for a camera of pbrt.
    assert_eq!(to_world.matrix3.x_axis, DVec3::NEG_X);
    let Colour::Texture(i) = irradiance else { panic!("no texture") };
    let TextureKind::Bitmap { bitmap, .. } = &scene.textures[*i].kind else { panic!("no picture") };
    // The middle of the left pixel lies at (−1, 0) on the plane: cos³ θ is 2^(−3/2) there.
    let wanted = 3.0 * 2f64.powf(-1.5) / PI;
    assert!((f64::from(bitmap.pixels[0].r) - wanted).abs() < 1e-6, "{:?}", bitmap.pixels);
    // On a scale of its own, by its power in all directions.
    let scene = read(&whole("LightSource \"projection\" \"string filename\" \"one.hdr\" \"float power\" 10"));
    let TextureKind::Bitmap { bitmap, .. } = &scene.textures[0].kind else { panic!("no picture") };
    let solid = 4.0;
    assert!((f64::from(bitmap.pixels[0].r) * PI - 10.0 / solid).abs() < 1e-5, "{:?}", bitmap.pixels);
}

/// The direction of a point of a square of equal areas, by Clarberg's forward mapping. `[CLA08]`
fn of_square(st: [f64; 2]) -> DVec3 {
    let [u, v] = st.map(|c| 2.0 * c - 1.0);
    let distance = 1.0 - (u.abs() + v.abs());
    let r = 1.0 - distance.abs();
    let phi = if r == 0.0 { 0.0 } else { ((v.abs() - u.abs()) / r + 1.0) * 0.25 * PI };
    let across = r * (2.0 - r * r).sqrt();
    DVec3::new(
        (across * phi.cos()).copysign(u),
        (across * phi.sin()).copysign(v),
        (1.0 - r * r).copysign(distance),
    )
}

/// A square of equal areas whose colours are the directions: (1 + d)/2.
pub(super) fn square_of_directions() -> Vec<u8> {
    const SIDE: u32 = 64;
    let mut bytes = format!("PF\n{SIDE} {SIDE}\n-1.0\n").into_bytes();
    let middle = |i: u32| (f64::from(i) + 0.5) / f64::from(SIDE);
    // Rows of such a file begin at the bottom.
    for (y, x) in (0..SIDE).rev().flat_map(|y| (0..SIDE).map(move |x| (y, x))) {
        let colour = 0.5 + 0.5 * of_square([middle(x), middle(y)]);
        bytes.extend(colour.to_array().iter().flat_map(|c| (*c as f32).to_le_bytes()));
    }
    bytes
}

#[test]
fn squares_of_equal_areas_shine_from_where_they_say() {
    for (transform, to_light) in
        [("", [1.0, 1.0, 1.0]), ("Scale -1 1 1", [-1.0, 1.0, 1.0]), ("Scale 1 1 -1", [1.0, 1.0, -1.0])]
    {
        for plugin in ["infinite", "goniometric"] {
            let light = format!("{transform} LightSource \"{plugin}\" \"string filename\" \"square.pfm\"");
            let scene = read(&whole(&light));
            let (to_world, bitmap, is_sky) = match emitter(&scene) {
                EmitterKind::Environment { to_world, bitmap, .. } => (to_world, bitmap, true),
                EmitterKind::Goniometric { to_world, bitmap, .. } => (to_world, bitmap, false),
                other => panic!("{other:?}"),
            };
            for (i, pixel) in bitmap.pixels.iter().enumerate().step_by(97) {
                let (x, y) = (i as u32 % bitmap.width, i as u32 / bitmap.width);
                let phi = 2.0 * PI * (f64::from(x) + 0.5) / f64::from(bitmap.width);
                let theta = PI * f64::from(y) / f64::from(bitmap.height - 1);
                let (sin, cos) = theta.sin_cos();
                // As the description says where columns and rows of both lie.
                let own = if is_sky {
                    DVec3::new(sin * phi.sin(), cos, -sin * phi.cos())
                } else {
                    DVec3::new(sin * phi.cos(), sin * phi.sin(), cos)
                };
                let wanted = to_world.transform_vector3(own) * DVec3::from(to_light);
                let found = pixel.to_array().map(|c| 2.0 * f64::from(c) - 1.0);
                assert!(
                    (DVec3::from(found) - wanted).length() < 0.05,
                    "{plugin} {transform}: {found:?} {wanted}"
                );
            }
        }
    }
}
