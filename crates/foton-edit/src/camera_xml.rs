//! A camera as text to paste into a scene file: Mitsuba 3's XML, with every number to its last bit.
//!
//! Scene files are written elsewhere; this is one element for the clipboard.

use std::fmt::Write;

use foton_scene::description::{Filter, Projection, SensorDescription};
use foton_scene::plugins::sensors;

/// The `<sensor>` element of a camera. It reads back as an equal camera.
#[must_use]
pub fn camera_xml(sensor: &SensorDescription) -> String {
    let mut xml = format!("<sensor type=\"{}\">\n", sensors::of(sensor).name);
    // Writing to a string does not fail.
    if let Some(lens) = sensor.lens {
        for (parameter, value) in
            [(sensors::APERTURE_RADIUS, lens.aperture_radius), (sensors::FOCUS_DISTANCE, lens.focus_distance)]
        {
            let _ = writeln!(xml, "    <float name=\"{}\" value=\"{value}\"/>", parameter.name);
        }
    }
    if sensor.projection == Projection::Perspective {
        let _ = writeln!(xml, "    <float name=\"fov\" value=\"{}\"/>", sensor.fov_degrees);
        let _ = writeln!(xml, "    <string name=\"fov_axis\" value=\"{}\"/>", sensor.fov_axis.name());
    }
    for (parameter, offset) in sensors::OFFSETS.iter().zip(sensor.principal_point_offset) {
        if offset != 0.0 {
            let _ = writeln!(xml, "    <float name=\"{}\" value=\"{offset}\"/>", parameter.name);
        }
    }
    for (name, clip) in sensors::clips(sensor) {
        let _ = writeln!(xml, "    <float name=\"{name}\" value=\"{clip}\"/>");
    }
    let m = sensor.to_world.matrix3;
    let rows: Vec<String> = (0..3)
        .map(|i| {
            let t = sensor.to_world.translation[i];
            format!("{} {} {} {t}", m.x_axis[i], m.y_axis[i], m.z_axis[i])
        })
        .collect();
    let _ = writeln!(xml, "    <transform name=\"to_world\">");
    let _ = writeln!(xml, "        <matrix value=\"{}  0 0 0 1\"/>", rows.join("  "));
    let _ = writeln!(xml, "    </transform>");
    let _ = writeln!(xml, "    <film type=\"hdrfilm\">");
    let _ = writeln!(xml, "        <integer name=\"width\" value=\"{}\"/>", sensor.width);
    let _ = writeln!(xml, "        <integer name=\"height\" value=\"{}\"/>", sensor.height);
    let filter = match sensor.filter {
        Filter::Box { .. } => "<rfilter type=\"box\"/>".to_owned(),
        Filter::Tent { radius } => {
            format!("<rfilter type=\"tent\"><float name=\"radius\" value=\"{radius}\"/></rfilter>")
        }
        Filter::Gaussian { stddev } => {
            format!("<rfilter type=\"gaussian\"><float name=\"stddev\" value=\"{stddev}\"/></rfilter>")
        }
    };
    let _ = writeln!(xml, "        {filter}\n    </film>\n</sensor>");
    xml
}
