//! Scenes of pbrt: what their directives make of a description. Materials, lights and faults are in files of their own.

mod faults;
mod lights;
mod materials;
mod shapes;

use std::io;
use std::path::Path;
use std::sync::Arc;

use foton_format::{Opened, Options, Suggested, open_from};
use foton_math::glam::{DAffine3, DVec3};
use foton_scene::description::{Crop, Filter, FovAxis, Geometry, Lens, Projection, SceneDescription};

const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
    element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

/// A picture of 2 × 1 pixels in Radiance's format without packing: red 1 and green 2.
fn picture() -> Vec<u8> {
    let mut bytes = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n".to_vec();
    bytes.extend([128, 0, 0, 129, 0, 128, 0, 130]);
    bytes
}

fn packed(bytes: &[u8]) -> Vec<u8> {
    let mut packer = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    io::Write::write_all(&mut packer, bytes).expect("memory");
    packer.finish().expect("memory")
}

fn files(path: &Path) -> io::Result<Vec<u8>> {
    match path.to_str() {
        Some("t.ply" | "parts/t.ply") => Ok(PLY.into()),
        Some("t.ply.gz") => Ok(packed(PLY.as_bytes())),
        Some("light.spd") => Ok(b"# nm\n400 1\n700 1\n".to_vec()),
        Some("two.hdr") => Ok(picture()),
        Some("square.pfm") => Ok(lights::square_of_directions()),
        Some("one.hdr") => Ok(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n\x80\x80\x80\x81".to_vec()),
        Some("parts/sphere.pbrt") => Ok(
            b"# inside\nTranslate 1 0 0\nShape \"sphere\"\nShape \"plymesh\" \"string filename\" \"t.ply\""
                .to_vec(),
        ),
        Some("circle.pbrt") => Ok(b"Include \"circle.pbrt\"".to_vec()),
        Some("other.pbrt") => Ok(b"secret 1".to_vec()),
        _ => Err(io::ErrorKind::NotFound.into()),
    }
}

fn opened(text: &str, options: &Options) -> Result<Opened, foton_format::OpenError> {
    let with_main = |path: &Path| {
        if path == Path::new("s.pbrt") { Ok(text.as_bytes().to_vec()) } else { files(path) }
    };
    open_from(Path::new("s.pbrt"), &with_main, options)
}

/// A scene of version 4 with a camera and a film.
fn whole(text: &str) -> String {
    format!("Film \"rgb\" Camera \"perspective\" WorldBegin\n{text}")
}

/// The description, and what is warned of.
fn read_with(text: &str) -> (SceneDescription, Vec<String>) {
    let opened = opened(text, &Options::default()).unwrap_or_else(|e| panic!("{text}: {e}"));
    (opened.description, opened.warnings.iter().map(ToString::to_string).collect())
}

/// The description of a scene of which nothing is warned.
fn read(text: &str) -> SceneDescription {
    let (description, warnings) = read_with(text);
    assert_eq!(warnings, Vec::<String>::new(), "{text}");
    description
}

fn close(a: DAffine3, b: DAffine3) -> bool {
    a.to_cols_array().iter().zip(b.to_cols_array()).all(|(x, y)| (x - y).abs() < 1e-9)
}

#[test]
fn a_camera_has_its_right_where_pbrt_has_it() {
    let scene = read("LookAt 0 0 -5  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 30\nFilm \"rgb\"");
    let sensor = &scene.sensors[0];
    let [x, y, z] = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| sensor.to_world.transform_vector3(axis));
    // The sensor's x points to the left of the image: pbrt has +x to the right here.
    assert_eq!((x, y, z), (DVec3::NEG_X, DVec3::Y, DVec3::Z));
    assert_eq!(sensor.to_world.translation, DVec3::new(0.0, 0.0, -5.0));
    assert_eq!((sensor.width, sensor.height, sensor.fov_axis), (1280, 720, FovAxis::Smaller));
    assert!((sensor.fov_degrees - 30.0).abs() < 1e-9);
    // Exporters from right-handed worlds mirror x, and the sensor is then not mirrored.
    let mirrored = read("Scale -1 1 1 LookAt 0 0 -5  0 0 0  0 1 0\nCamera \"perspective\" Film \"rgb\"");
    assert!(mirrored.sensors[0].to_world.matrix3.determinant() > 0.0);
}

#[test]
fn scales_of_a_camera_are_in_its_view() {
    let lens = "\"float lensradius\" 0.1 \"float focaldistance\" 3";
    let scene =
        read(&format!("Scale 0.5 0.5 0.25 Camera \"perspective\" \"float fov\" 90 {lens} Film \"rgb\""));
    let sensor = &scene.sensors[0];
    // Twice as far across and four times along the view: half of the tangent.
    assert!((sensor.fov_degrees - 2.0 * 0.5_f64.atan().to_degrees()).abs() < 1e-9, "{}", sensor.fov_degrees);
    assert_eq!(sensor.lens, Some(Lens { aperture_radius: 0.2, focus_distance: 12.0 }));
    assert!((sensor.to_world.matrix3.determinant().abs() - 1.0).abs() < 1e-9);
}

#[test]
fn windows_films_and_filters_are_those_of_their_version() {
    let old = read(
        "Film \"image\" \"integer xresolution\" 200 \"integer yresolution\" 100 \"float cropwindow\" [0.25 0.5 0 0.501]\n\
         PixelFilter \"gaussian\" \"float xwidth\" 2 \"float ywidth\" 2 \"float alpha\" 8\n\
         Camera \"perspective\" \"float screenwindow\" [-1 3 -0.5 1.5]",
    );
    let sensor = &old.sensors[0];
    assert_eq!((sensor.width, sensor.height), (200, 100));
    assert_eq!(sensor.crop, Some(Crop { x: 50, y: 0, width: 50, height: 51 }));
    assert_eq!(sensor.filter, Filter::Gaussian { stddev: 0.25 });
    // The middle of the window is a quarter of its width to the right and a quarter of its height above.
    assert_eq!(sensor.principal_point_offset, [0.25, -0.25]);
    assert!((sensor.fov_degrees - 90.0).abs() < 1e-9);
    let plain = read("Film \"image\" Camera \"perspective\"");
    assert_eq!((plain.sensors[0].width, plain.sensors[0].height), (640, 480));
    assert_eq!(plain.sensors[0].filter, Filter::Box { radius: 0.5 });
    let flat = read("Film \"rgb\" Camera \"orthographic\" \"float screenwindow\" [-4 4 -2.25 2.25]");
    let flat = &flat.sensors[0];
    assert_eq!(flat.projection, Projection::Orthographic);
    assert!(close(flat.to_world, DAffine3::from_scale(DVec3::new(-4.0, 4.0, 1.0))), "{}", flat.to_world);
}

#[test]
fn transforms_are_multiplied_in_the_order_of_the_file() {
    let scene = read(&whole(
        "Translate 1 2 3 Rotate 90 0 0 1 Scale 2 2 2 CoordinateSystem \"here\"\n\
         AttributeBegin Identity Shape \"sphere\" AttributeEnd\n\
         TransformBegin Transform [1 0 0 0 0 1 0 0 0 0 1 0 5 6 7 1] Shape \"sphere\" TransformEnd\n\
         ConcatTransform [1 0 0 0 0 1 0 0 0 0 1 0 1 0 0 1] Shape \"sphere\"\n\
         Identity CoordSysTransform \"here\" Shape \"sphere\"",
    ));
    let centres: Vec<DVec3> = scene.shapes.iter().map(|s| s.to_world.translation).collect();
    let wanted =
        [DVec3::ZERO, DVec3::new(5.0, 6.0, 7.0), DVec3::new(1.0, 4.0, 3.0), DVec3::new(1.0, 2.0, 3.0)];
    assert!(centres.iter().zip(wanted).all(|(a, b)| (*a - b).length() < 1e-9), "{centres:?}");
}

#[test]
fn instances_share_one_mesh_and_are_placed_before_their_own_transform() {
    let scene = read(&whole(
        "ObjectBegin \"o\" Translate 1 0 0 Shape \"plymesh\" \"string filename\" \"t.ply\"\n\
         Shape \"disk\" ObjectEnd\n\
         Scale 2 2 2 ObjectInstance \"o\" Translate 0 0 1 ObjectInstance \"o\"\n\
         Shape \"plymesh\" \"string filename\" \"t.ply.gz\"",
    ));
    let names: Vec<&str> = scene.shapes.iter().map(|s| s.name.as_str()).collect();
    assert_eq!(names, ["o-1/1", "o-1/2", "o-2/1", "o-2/2", "plymesh-5"]);
    let mesh = |i: usize| match &scene.shapes[i].geometry {
        Geometry::Mesh(mesh) => mesh,
        other => panic!("{other:?}"),
    };
    assert!(Arc::ptr_eq(mesh(0), mesh(2)));
    assert_eq!(mesh(4).positions, mesh(0).positions);
    let wanted =
        DAffine3::from_scale(DVec3::splat(2.0)) * DAffine3::from_translation(DVec3::new(1.0, 0.0, 1.0));
    assert!(close(scene.shapes[2].to_world, wanted), "{}", scene.shapes[2].to_world);
}

#[test]
fn a_file_that_is_included_changes_the_state_and_one_that_is_imported_does_not() {
    let centre = |word: &str| {
        let scene = read(&whole(&format!("{word} \"parts/sphere.pbrt\"\nShape \"sphere\"")));
        assert_eq!(scene.shapes.len(), 3);
        scene.shapes[2].to_world.translation.x
    };
    assert_eq!((centre("Include"), centre("Import")), (1.0, 0.0));
}

#[test]
fn a_scene_may_be_packed_and_tells_which_files_it_is_of() {
    let text = whole("Shape \"sphere\" Shape \"spere\"");
    let read = |text: &str| {
        let packed = packed(text.as_bytes());
        let with_main =
            |path: &Path| if path == Path::new("s.pbrt.gz") { Ok(packed.clone()) } else { files(path) };
        open_from(Path::new("s.pbrt.gz"), &with_main, &Options::default())
    };
    let opened = read(&whole("Shape \"sphere\"")).expect("sound");
    assert_eq!((opened.description.shapes.len(), opened.warnings.len()), (1, 0));
    let place = opened.finding(foton_format::Severity::Error, "s.pbrt.gz", Some("sphere-1"), "x".to_owned());
    assert_eq!(place.to_string(), "s.pbrt.gz:2:8: x");
    let Err(error) = read(&text) else { panic!("no such shape") };
    assert!(error.to_string().starts_with("s.pbrt.gz:2:23: unknown shape"), "{error}");
}

#[test]
fn what_an_integrator_asks_for_is_suggested() {
    let text = "Integrator \"sppm\" \"integer photonsperiteration\" 1000 \"integer numiterations\" 7 \"float radius\" .5 \
                \"integer maxdepth\" 6\nFilm \"image\" Camera \"perspective\"";
    let found = opened(text, &Options::default()).expect("sound");
    let wanted = Suggested {
        photons_per_pass: Some(1000),
        radius: Some(0.5),
        alpha: Some(2.0 / 3.0),
        passes: Some(7),
    };
    assert_eq!((found.suggested, found.description.max_depth), (wanted, Some(12)));
    assert_eq!(read("Integrator \"path\" Film \"rgb\" Camera \"perspective\"").max_depth, Some(6));
}

#[test]
fn what_moves_has_keyframes_at_both_times() {
    let scene = read(&whole(
        "TransformTimes 0 2 ActiveTransform EndTime Translate 1 0 0 ActiveTransform All Scale 2 2 2\nShape \"sphere\"",
    ));
    let keyframes = scene.motion.shapes[&0].all();
    let places: Vec<(f64, f64)> =
        keyframes.iter().map(|(time, place)| (*time, place.translation.x)).collect();
    assert_eq!(places, [(0.0, 0.0), (2.0, 1.0)]);
    assert_eq!(scene.motion.shutter(0), [0.0, 1.0]);
}

#[test]
fn names_of_version_3_have_their_old_meaning_behind_a_block() {
    let text = |film: &str| {
        format!(
            "Film \"{film}\" Camera \"perspective\" WorldBegin MakeNamedMaterial \"a\" \"string type\" \"mirror\"\n\
             AttributeBegin MakeNamedMaterial \"a\" \"string type\" \"glass\" AttributeEnd\n\
             NamedMaterial \"a\" Shape \"sphere\""
        )
    };
    let plugin = |film| read(&text(film)).materials[0].front.plugin();
    assert_eq!((plugin("image"), plugin("rgb")), ("conductor", "dielectric"));
}
