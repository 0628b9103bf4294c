//! Shapes and cameras of all kinds, with numbers that no text of few digits has.

use super::*;

fn odd_attributes() -> Vec<Attribute> {
    let of = |name: &str, channels, numbers: usize| Attribute {
        name: name.to_owned(),
        channels,
        values: (0..numbers).map(|i| odd(i as _) as f32).collect(),
    };
    vec![of("vertex_color", 3, 12), of("vertex_w", 1, 4), of("face_color", 3, 6)]
}

fn odd_mesh(narrow: bool, normals: bool) -> Geometry {
    let value = |i| if narrow { f64::from(odd(i) as f32) } else { odd(i) };
    let positions = (0..4).map(|i| DVec3::new(value(i), value(i + 4), value(i + 8))).collect();
    let normals = if normals { vec![DVec3::new(odd(1), odd(2), odd(3)); 4] } else { Vec::new() };
    let texture_coordinates = vec![DVec2::new(odd(1), 0.5); if narrow { 0 } else { 4 }];
    Geometry::Mesh(Arc::new(Mesh {
        positions,
        normals,
        texture_coordinates,
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        attributes: if narrow { odd_attributes() } else { Vec::new() },
    }))
}

pub(super) fn shapes(materials: usize) -> Vec<ShapeDescription> {
    let shared = odd_mesh(false, true);
    let geometries = [
        Geometry::Sphere { centre: DVec3::new(odd(1), odd(2), odd(3)), radius: 1.0 / 3.0 },
        Geometry::Disc,
        Geometry::Cylinder { from: DVec3::ZERO, to: DVec3::new(0.0, odd(2), 0.1), radius: 0.1 },
        Geometry::Mesh(Arc::new(Mesh::rectangle())),
        Geometry::Mesh(Arc::new(Mesh::cube())),
        odd_mesh(true, false),
        odd_mesh(false, false),
        shared.clone(),
        shared,
    ];
    let mirror = DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0));
    let shape = |i: usize| ShapeDescription {
        name: if i.is_multiple_of(2) { String::new() } else { "ä/b".to_owned() },
        geometry: geometries[i % geometries.len()].clone(),
        to_world: if i % 4 < 2 { odd_transform() } else { odd_transform() * mirror },
        flip_normals: i.is_multiple_of(3),
        material: i % materials,
        radiance: i
            .is_multiple_of(5)
            .then(|| if i == 5 { Colour::Texture(1) } else { Rgb::new(0.1, 1e-12, 1e12).into() }),
    };
    (0..24).map(shape).collect()
}

pub(super) fn sensors() -> Vec<SensorDescription> {
    let sensor = |fov_axis, filter, near_clip: Option<f64>| SensorDescription {
        name: "sensor".to_owned(),
        to_world: DAffine3::from_axis_angle(DVec3::Y, odd(1)),
        fov_degrees: 40.0 + odd(2),
        fov_axis,
        width: 320,
        height: 200,
        filter,
        near_clip,
        far_clip: near_clip.map(|near| near + 100.0),
        principal_point_offset: [odd(3), odd(4)],
        ..SensorDescription::default()
    };
    vec![
        sensor(FovAxis::Larger, Filter::Box { radius: 0.5 }, Some(odd(1))),
        SensorDescription {
            crop: Some(Crop { x: 10, y: 20, width: 100, height: 80 }),
            lens: Some(Lens { aperture_radius: odd(3), focus_distance: odd(4).abs() }),
            ..sensor(FovAxis::X, Filter::Box { radius: 0.5 }, None)
        },
        sensor(FovAxis::Diagonal, Filter::Tent { radius: 1.1 }, None),
        SensorDescription {
            to_world: odd_transform() * DAffine3::from_scale(DVec3::new(3.0, 2.5, 1.0)),
            projection: Projection::Orthographic,
            ..sensor(FovAxis::X, Filter::Box { radius: 0.5 }, Some(odd(1)))
        },
        SensorDescription {
            projection: Projection::Orthographic,
            lens: Some(Lens { aperture_radius: odd(3), focus_distance: odd(4).abs() }),
            ..sensor(FovAxis::X, Filter::Box { radius: 0.5 }, None)
        },
        sensor(FovAxis::Y, Filter::Gaussian { stddev: 0.3 }, None),
    ]
}

/// Emitters of each kind, some of which have the second and third texture of the scene.
pub(super) fn emitters(bitmap: &Arc<Bitmap>) -> Vec<EmitterDescription> {
    let kinds = vec![
        EmitterKind::Point { position: DVec3::new(odd(1), 2.0, 3.0), intensity: Rgb::new(0.1, 0.2, 0.3) },
        EmitterKind::Spot {
            to_world: odd_transform(),
            intensity: Rgb::splat(10.0),
            cutoff_degrees: 30.0 + odd(1),
            beam_degrees: 20.0,
            texture: None,
        },
        EmitterKind::Spot {
            to_world: odd_transform(),
            intensity: Rgb::splat(10.0),
            cutoff_degrees: 30.0,
            beam_degrees: 20.0,
            texture: Some(1),
        },
        EmitterKind::Projector {
            to_world: odd_transform(),
            irradiance: Colour::Texture(2),
            scale: odd(3),
            fov_degrees: 40.0 + odd(2),
            fov_axis: FovAxis::Diagonal,
        },
        EmitterKind::Projector {
            to_world: DAffine3::IDENTITY,
            irradiance: colour(0.1, 2.5, 1e-7),
            scale: 1.0,
            fov_degrees: 33.0,
            fov_axis: FovAxis::Y,
        },
        EmitterKind::Goniometric { to_world: odd_transform(), bitmap: Arc::clone(bitmap), scale: 0.3 },
        EmitterKind::Directional {
            direction: DVec3::new(odd(1), odd(2), odd(3)),
            irradiance: Rgb::splat(0.3),
        },
        EmitterKind::Environment {
            to_world: DAffine3::from_rotation_y(odd(1)),
            bitmap: Arc::clone(bitmap),
            scale: 0.7,
        },
    ];
    kinds.into_iter().map(|kind| EmitterDescription { name: "light".to_owned(), kind }).collect()
}
