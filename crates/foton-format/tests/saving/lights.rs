//! Lights and cameras of an edited scene in its own file.

use super::*;

#[test]
fn lights_and_cameras_change_in_place() {
    let folder = Folder::new("lights");
    let lines = changed_lines(&folder, |d| d.shapes[4].radiance = Some(Rgb::new(0.5, 1.0 / 3.0, 7.0).into()));
    assert_eq!(lines.len(), 1);
    changed_lines(&folder, |d| d.shapes[0].radiance = Some(Rgb::splat(2.0).into()));
    changed_lines(&folder, |d| {
        let EmitterKind::Point { position, intensity } = &mut d.emitters[0].kind else { panic!("a point") };
        (*position, *intensity) = (DVec3::new(1.0, 2.0, 0.1), Rgb::new(0.1, 0.2, 0.3));
        let EmitterKind::Spot { to_world, cutoff_degrees, .. } = &mut d.emitters[1].kind else {
            panic!("a spot")
        };
        *to_world = DAffine3::from_rotation_x(0.3);
        *cutoff_degrees = 31.0;
    });
    let lines = changed_lines(&folder, |d| {
        d.sensors[0].to_world = DAffine3::from_rotation_y(0.4);
        (d.sensors[0].fov_degrees, d.sensors[0].fov_axis) = (33.0, FovAxis::Y);
        d.sensors[0].width = 128;
    });
    assert!(lines.iter().all(|l| !l.contains("focal_length")), "{lines:?}");
    let lines = changed_lines(&folder, |d| {
        d.sensors[0].lens = Some(Lens { aperture_radius: 0.25, focus_distance: 3.0 });
    });
    assert!(lines.iter().any(|l| l.contains("thinlens")), "{lines:?}");
    assert!(fs::read_to_string(folder.saved()).unwrap().contains("Fifty millimetres"));
}

#[test]
fn projectors_and_textured_spots_change_in_place() {
    let folder = Folder::new("projector");
    let scene = fs::read_to_string(folder.path()).unwrap();
    let lights = "<emitter type=\"projector\" id=\"slide\"><ref name=\"irradiance\" id=\"squares\"/>\n\
        <transform name=\"to_world\"><scale value=\"2\"/></transform>\n</emitter>\n\
        <emitter type=\"spot\" id=\"gobo\"><ref name=\"texture\" id=\"squares\"/></emitter>\n</scene>";
    fs::write(folder.path(), scene.replace("</scene>", lights)).unwrap();
    changed_lines(&folder, |d| {
        let EmitterKind::Projector { to_world, scale, fov_degrees, .. } = &mut d.emitters[2].kind else {
            panic!("a projector")
        };
        assert_eq!(*scale, 2.0);
        (*scale, *fov_degrees) = (0.75, 12.5);
        to_world.translation.x = 3.0;
        let EmitterKind::Spot { intensity, .. } = &mut d.emitters[3].kind else { panic!("a spot") };
        *intensity = Rgb::splat(7.0);
        // Copies of them.
        for i in [2, 3] {
            let copy = d.emitters[i].clone();
            d.emitters.push(EmitterDescription { name: format!("copy-{i}"), ..copy });
        }
    });
    let opened = read(&folder.path());
    let mut edited = opened.description.clone();
    let EmitterKind::Spot { texture, .. } = &mut edited.emitters[3].kind else { panic!("a spot") };
    *texture = None;
    assert!(matches!(save_edited(&opened, &edited, &folder.saved()), Ok(Saved::Anew { .. })));
}

#[test]
fn how_much_an_orthographic_camera_shows_is_its_transform() {
    let folder = Folder::new("orthographic");
    let sensor = fs::read_to_string(folder.path()).unwrap();
    let (from, to) = (sensor.find("<sensor").unwrap(), sensor.find("</sensor>").unwrap());
    let parallel = "<sensor type=\"orthographic\"><float name=\"near_clip\" value=\"0.25\"/>\n        <transform name=\"to_world\"><scale value=\"4\"/></transform>";
    fs::write(folder.path(), format!("{}{parallel}{}", &sensor[..from], &sensor[to..])).unwrap();
    let lines =
        changed_lines(&folder, |d| d.sensors[0].to_world *= DAffine3::from_scale(DVec3::new(3.0, 3.0, 1.0)));
    assert!(lines.iter().any(|l| l.contains("matrix")), "{lines:?}");
    assert!(lines.iter().any(|l| l.contains("near_clip\" value=\"0.25\"")), "{lines:?}");
}
