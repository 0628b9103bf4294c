//! Cameras as files state them.

use super::*;

#[test]
fn cameras_have_mitsubas_defaults() {
    let opened = read_with("<sensor type='perspective'/>", &[]);
    assert_eq!(opened.warnings, []);
    let camera = &opened.description.sensors[0];
    assert_eq!((camera.width, camera.height, camera.filter), (768, 576, Filter::Gaussian { stddev: 0.5 }));
    assert_eq!((camera.near_clip, camera.far_clip, camera.name.as_str()), (None, None, "sensor"));
    // 50 mm on 35 mm film; Mitsuba prints x_fov = 38.1848 for 768 × 576.
    assert_eq!(camera.fov_axis, FovAxis::Diagonal);
    let x_fov = 2.0 * (0.8 * (camera.fov_degrees / 2.0).to_radians().tan()).atan().to_degrees();
    assert!((x_fov - 38.1848).abs() < 1e-4, "{x_fov}");
}

#[test]
fn a_lens_is_focused_where_the_file_says_or_as_far_as_the_camera_sees() {
    let lens = |inside: &str| {
        let sensor = format!("<sensor type='thinlens'><float name='fov' value='40'/>{inside}</sensor>");
        let opened = read_with(&sensor, &[]);
        assert_eq!(opened.warnings, []);
        assert_eq!(opened.description.sensors[0].fov_degrees, 40.0);
        opened.description.sensors[0].lens.map(|lens| (lens.aperture_radius, lens.focus_distance))
    };
    let aperture = "<float name='aperture_radius' value='0.25'/>";
    assert_eq!(lens(&format!("{aperture}<float name='focus_distance' value='3'/>")), Some((0.25, 3.0)));
    assert_eq!(lens(&format!("{aperture}<float name='far_clip' value='90'/>")), Some((0.25, 90.0)));
    assert_eq!(lens(aperture), Some((0.25, 1e4)), "Mitsuba's own far_clip");
    let refused = |sensor: &str| {
        let xml = format!("<scene version='3.0.0'>{sensor}</scene>");
        match read_str("s.xml", &xml, &files, &Options::default()) {
            Ok(_) => panic!("{sensor}"),
            Err(error) => error.to_string(),
        }
    };
    let said = refused("<sensor type='thinlens'/>");
    assert!(said.contains("s.xml:1:24: a \"thinlens\" needs an \"aperture_radius\""), "{said}");
    let value = |name: &str, value: &str| {
        refused(&format!("<sensor type='thinlens'>{aperture}<float name='{name}' value='{value}'/></sensor>"))
    };
    assert!(value("focus_distance", "0").contains("\"focus_distance\" must be above zero"));
    let negative = refused("<sensor type='thinlens'><float name='aperture_radius' value='-1'/></sensor>");
    assert!(negative.contains("\"aperture_radius\" must not be negative"), "{negative}");
}

#[test]
fn a_camera_without_perspective_has_its_scale_and_a_lens_if_it_is_telecentric() {
    let sensor = |kind: &str, inside: &str| {
        let transform = "<scale x='3' y='2' z='5'/><lookat origin='0,0,9' target='0,0,0' up='0,1,0'/>";
        let xml = format!(
            "<sensor type='{kind}'><transform name='to_world'>{transform}</transform>{inside}</sensor>"
        );
        let opened = read_with(&xml, &[]);
        (opened.description.sensors[0].clone(), opened.warnings)
    };
    let clips = "<float name='near_clip' value='1'/><float name='far_clip' value='9'/>";
    let (camera, warnings) = sensor("orthographic", clips);
    assert_eq!((warnings, camera.projection, camera.lens), (vec![], Projection::Orthographic, None));
    let m = camera.to_world.matrix3;
    assert_eq!([m.x_axis, m.y_axis, m.z_axis].map(DVec3::length), [3.0, 2.0, 5.0]);
    // Mitsuba 3.9: its rays begin at depth 5 and go on for 8.
    assert_eq!((camera.near_clip, camera.far_clip), (Some(5.0), Some(13.0)));
    let (camera, warnings) = sensor("orthographic", "<float name='fov' value='40'/>");
    assert_eq!((camera.near_clip, camera.far_clip), (None, None));
    assert!(warnings[0].to_string().contains("\"fov\" has no effect"), "{warnings:?}");
    let lens = "<float name='aperture_radius' value='0.5'/><float name='focus_distance' value='3'/>";
    let (camera, warnings) = sensor("telecentric", lens);
    let expected = Lens { aperture_radius: 0.5, focus_distance: 3.0 };
    assert_eq!((warnings, camera.projection), (vec![], Projection::Orthographic));
    assert_eq!(camera.lens, Some(expected));
    let offset = "<float name='principalPointOffsetX' value='0.1'/><float name='principal_point_offset_y' value='-2'/>";
    let opened = read_with(&format!("<sensor type='perspective'>{offset}</sensor>"), &[]);
    assert_eq!(opened.description.sensors[0].principal_point_offset, [0.1, -2.0]);
}

#[test]
fn all_that_a_camera_states_is_read() {
    let film = |filter: &str| {
        let sensor = format!(
            "<sensor type='perspective' id='main'><float name='fov' value='40'/><string name='fov_axis' value='larger'/>\
             <float name='near_clip' value='0.5'/><float name='far_clip' value='9'/>\
             <transform name='to_world'><translate z='-5'/></transform>\
             <sampler type='independent'><integer name='sample_count' value='4'/></sampler>\
             <film type='hdrfilm'><integer name='width' value='20'/><integer name='height' value='10'/>\
             <string name='pixel_format' value='rgb'/>{filter}</film></sensor><sensor type='perspective'/>"
        );
        let opened = read_with(&sensor, &[]);
        assert_eq!(opened.warnings, []);
        opened.description.sensors
    };
    let sensors = film("<rfilter type='box'/>");
    let camera = &sensors[0];
    assert_eq!((camera.name.as_str(), sensors[1].name.as_str()), ("main", "sensor-2"));
    assert_eq!((camera.fov_degrees, camera.fov_axis), (40.0, FovAxis::Larger));
    assert_eq!((camera.width, camera.height, camera.filter), (20, 10, Filter::Box { radius: 0.5 }));
    assert_eq!((camera.near_clip, camera.far_clip), (Some(0.5), Some(9.0)));
    assert_eq!(camera.to_world.translation, DVec3::new(0.0, 0.0, -5.0));
    assert_eq!(film("<rfilter type='tent'/>")[0].filter, Filter::Tent { radius: 1.0 });
    let wide = film("<rfilter type='gaussian'><float name='stddev' value='2'/></rfilter>");
    assert_eq!(wide[0].filter, Filter::Gaussian { stddev: 2.0 });
}
