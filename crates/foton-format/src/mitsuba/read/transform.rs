//! `<transform>`: steps applied in the order of the file, each multiplied from the left, as in Mitsuba 3.

use foton_input::shown;
use foton_math::glam::{DAffine3, DMat3, DVec3};

use crate::diagnostic::Report;
use crate::mitsuba::document::{Document, Element, NodeId};
use crate::mitsuba::read::attributes::{check_attributes, parse_attribute};
use crate::mitsuba::read::values;
use crate::spelling::did_you_mean;

const STEPS: &[&str] = &["translate", "rotate", "scale", "matrix", "lookat"];

/// The product of all steps inside a `<transform>`. An error where it is singular.
pub(crate) fn read(document: &Document, node: NodeId, report: &mut Report) -> Option<DAffine3> {
    let mut product = Some(DAffine3::IDENTITY);
    for (_, element) in document.elements_in(node) {
        let step = match element.name.as_str() {
            "translate" => translate(element, report),
            "rotate" => rotate(element, report),
            "scale" => scale(element, report),
            "matrix" => matrix(element, report),
            "lookat" | "lookAt" => look_at(element, report),
            tag => {
                let hint = did_you_mean(tag, STEPS.iter().copied());
                report.error(element.place, format!("unknown step <{}> of a transform{hint}", shown(tag)));
                None
            }
        };
        product = product.zip(step).map(|(before, step)| step * before);
    }
    let product = product?;
    let place = document.element(node).map_or_else(Default::default, |e| e.place);
    if !product.is_finite() {
        report.error(place, "the transform overflows");
        return None;
    }
    if is_singular(product.matrix3) {
        report.error(place, "the transform is singular: it flattens everything");
        return None;
    }
    Some(product)
}

/// Whether the axes lie in a plane, or an axis vanishes.
fn is_singular(m: DMat3) -> bool {
    let largest = m.to_cols_array().iter().fold(0.0_f64, |most, c| most.max(c.abs()));
    // What is very large or small has no volume that is a number.
    let m = if (1e-60..1e60).contains(&largest) { m } else { m * (1.0 / largest) };
    let volume = m.x_axis.length() * m.y_axis.length() * m.z_axis.length();
    m.determinant().abs() <= 1e-9 * volume
}

/// `x`, `y` and `z` (absent ones are `default`), or `value` with one or three numbers.
pub(crate) fn components(element: &Element, default: f64, report: &mut Report) -> Option<DVec3> {
    let axes = ["x", "y", "z"].map(|axis| element.attribute(axis));
    if let Some(value) = element.attribute("value") {
        if let Some(axis) = axes.into_iter().flatten().next() {
            report.error(
                axis.place,
                format!("<{}> has both \"value\" and \"{}\"", shown(&element.name), axis.name),
            );
            return None;
        }
        return parse_attribute(value, values::one_or_three, report);
    }
    let mut read = |i: usize| match axes[i] {
        Some(attribute) => parse_attribute(attribute, values::number, report),
        None => Some(default),
    };
    let (x, y, z) = (read(0), read(1), read(2));
    Some(DVec3::new(x?, y?, z?))
}

fn translate(element: &Element, report: &mut Report) -> Option<DAffine3> {
    let known = check_attributes(element, &[], &["x", "y", "z", "value"], report);
    known.then(|| components(element, 0.0, report)).flatten().map(DAffine3::from_translation)
}

fn scale(element: &Element, report: &mut Report) -> Option<DAffine3> {
    let known = check_attributes(element, &[], &["x", "y", "z", "value"], report);
    known.then(|| components(element, 1.0, report)).flatten().map(DAffine3::from_scale)
}

/// A turn about an axis through the origin, counter-clockwise seen against the axis, in degrees.
fn rotate(element: &Element, report: &mut Report) -> Option<DAffine3> {
    if !check_attributes(element, &["angle"], &["x", "y", "z", "value"], report) {
        return None;
    }
    let axis = components(element, 0.0, report);
    let angle = element.attribute("angle").and_then(|a| parse_attribute(a, values::number, report));
    let (axis, angle) = axis.zip(angle)?;
    let Some(unit) = axis.try_normalize() else {
        report.error(element.place, "a rotation needs an axis other than zero");
        return None;
    };
    if (axis.length() - 1.0).abs() > 1e-3 {
        let length = axis.length();
        let message =
            format!("the axis has length {length:.4}, not 1; it is scaled here, but not in Mitsuba");
        report.warning(element.place, message);
    }
    Some(DAffine3::from_axis_angle(unit, angle.to_radians()))
}

/// Rows of a 3×3 or an affine 4×4 matrix.
fn matrix(element: &Element, report: &mut Report) -> Option<DAffine3> {
    if !check_attributes(element, &["value"], &[], report) {
        return None;
    }
    let value = element.attribute("value")?;
    let n = parse_attribute(value, values::numbers, report)?;
    let rows = |width: usize| {
        let row = |i: usize| DVec3::new(n[i * width], n[i * width + 1], n[i * width + 2]);
        DMat3::from_cols(row(0), row(1), row(2)).transpose()
    };
    match n.len() {
        9 => Some(DAffine3::from_mat3(rows(3))),
        16 if n[12..] == [0.0, 0.0, 0.0, 1.0] => {
            Some(DAffine3::from_mat3_translation(rows(4), DVec3::new(n[3], n[7], n[11])))
        }
        16 => {
            report.error(value.value_place, "the last row of a 4×4 matrix must be 0 0 0 1");
            None
        }
        other => {
            report.error(value.value_place, format!("a matrix has 9 or 16 numbers, not {other}"));
            None
        }
    }
}

/// A camera at `origin` that looks along +z at `target`, with +y towards `up` and +x to its left.
fn look_at(element: &Element, report: &mut Report) -> Option<DAffine3> {
    if !check_attributes(element, &["origin", "target"], &["up"], report) {
        return None;
    }
    let mut read = |name| {
        element.attribute(name).map_or(Some(DVec3::ZERO), |a| parse_attribute(a, values::vector, report))
    };
    let (origin, target, up) = (read("origin"), read("target"), read("up"));
    let (origin, target, up) = (origin?, target?, up?);
    let towards = target - origin;
    // The square of a distance may be no number where the distance is one.
    let direction =
        towards.try_normalize().or_else(|| (towards / towards.abs().max_element()).try_normalize());
    let Some(direction) = direction else {
        report.error(element.place, "the origin and the target of this lookat are the same point");
        return None;
    };
    let up = if up == DVec3::ZERO { any_perpendicular(direction) } else { up };
    let left = up.normalize_or_zero().cross(direction);
    if left.length() < 1e-9 {
        report.error(element.place, "the up vector of this lookat is parallel to its direction");
        return None;
    }
    let left = left.normalize();
    let up = direction.cross(left);
    Some(DAffine3::from_mat3_translation(DMat3::from_cols(left, up, direction), origin))
}

/// The first tangent of Mitsuba's frame around `n` (Duff et al., "Building an Orthonormal Basis, Revisited").
fn any_perpendicular(n: DVec3) -> DVec3 {
    let sign = 1.0_f64.copysign(n.z);
    let a = -1.0 / (sign + n.z);
    DVec3::new(n.x * n.x * a * sign + 1.0, n.x * n.y * a * sign, -n.x * sign)
}

/// The factor by which a transform scales all lengths, if the squares of those change evenly within a relative
/// `tolerance`; it may mirror.
pub(crate) fn even_scale(m: DMat3, tolerance: f64) -> Option<f64> {
    let gram = m.transpose() * m;
    let square = (gram.x_axis.x + gram.y_axis.y + gram.z_axis.z) / 3.0;
    let error = gram - DMat3::from_diagonal(DVec3::splat(square));
    let largest = error.to_cols_array().iter().fold(0.0_f64, |a, e| a.max(e.abs()));
    (largest <= tolerance * square).then(|| square.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn product(steps: &str) -> DAffine3 {
        let document = Document::parse(&format!("<transform name='to_world'>{steps}</transform>")).unwrap();
        let mut report = Report::new("t", std::path::Path::new(""));
        let transform = read(&document, document.root(), &mut report);
        assert_eq!(report.finish().unwrap(), []);
        transform.unwrap()
    }

    /// Rows of the upper three.
    fn assert_rows(steps: &str, rows: [[f64; 4]; 3]) {
        let t = product(steps);
        for (i, row) in rows.iter().enumerate() {
            let found = [t.matrix3.x_axis[i], t.matrix3.y_axis[i], t.matrix3.z_axis[i], t.translation[i]];
            for (a, b) in found.iter().zip(row) {
                assert!((a - b).abs() < 1e-6, "{steps}: row {i} is {found:?}, not {row:?}");
            }
        }
    }

    #[test]
    fn each_step_is_the_matrix_of_its_definition() {
        let (s, c) = (0.5, 0.75_f64.sqrt());
        assert_rows("<translate x='1' z='3'/>", [[1., 0., 0., 1.], [0., 1., 0., 0.], [0., 0., 1., 3.]]);
        assert_rows("<translate value='1 2 3'/>", [[1., 0., 0., 1.], [0., 1., 0., 2.], [0., 0., 1., 3.]]);
        assert_rows("<scale value='2'/>", [[2., 0., 0., 0.], [0., 2., 0., 0.], [0., 0., 2., 0.]]);
        assert_rows("<scale x='2' z='3'/>", [[2., 0., 0., 0.], [0., 1., 0., 0.], [0., 0., 3., 0.]]);
        assert_rows("<rotate x='1' angle='30'/>", [[1., 0., 0., 0.], [0., c, -s, 0.], [0., s, c, 0.]]);
        assert_rows("<rotate y='1' angle='30'/>", [[c, 0., s, 0.], [0., 1., 0., 0.], [-s, 0., c, 0.]]);
        assert_rows("<rotate z='1' angle='30'/>", [[c, -s, 0., 0.], [s, c, 0., 0.], [0., 0., 1., 0.]]);
        assert_rows(
            "<matrix value='1 2 3 4 5 6 7 8 10'/>",
            [[1., 2., 3., 0.], [4., 5., 6., 0.], [7., 8., 10., 0.]],
        );
        assert_rows(
            "<matrix value='1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 12, 13, 0, 0, 0, 1'/>",
            [[1., 2., 3., 4.], [5., 6., 7., 8.], [9., 10., 12., 13.]],
        );
        assert_rows(
            "<lookat origin='0,0,4' target='0,0,0' up='0,1,0'/>",
            [[-1., 0., 0., 0.], [0., 1., 0., 0.], [0., 0., -1., 4.]],
        );
    }

    /// Volumes and squares of distances that are no numbers make no transform singular and no two points one.
    #[test]
    fn very_large_and_very_small_transforms_are_transforms() {
        for size in [1e150, 1e15, 1e-15, 1e-120] {
            let scaled = product(&format!("<scale value='{size:e}'/>"));
            assert_eq!(scaled.matrix3.x_axis.x, size);
            let from_afar =
                product(&format!("<lookat origin='0, 0, {:e}' target='0,0,0' up='0,1,0'/>", size * size));
            assert!((from_afar.matrix3.z_axis.z + 1.0).abs() < 1e-12, "{from_afar}");
        }
    }

    #[test]
    fn a_rotation_about_any_axis_follows_rodrigues() {
        let r = 0.5_f64.sqrt();
        assert_rows(
            "<rotate value='0.70710678 0.70710678 0' angle='90'/>",
            [[0.5, 0.5, r, 0.], [0.5, 0.5, -r, 0.], [-r, r, 0., 0.]],
        );
    }

    #[test]
    fn later_steps_act_on_the_result_of_earlier_ones() {
        let (s, c) = (1.0, 3.0_f64.sqrt());
        assert_rows(
            "<rotate x='1' angle='30'/><translate x='1' y='2' z='3'/><scale value='2'/>",
            [[2., 0., 0., 2.], [0., c, -s, 4.], [0., s, c, 6.]],
        );
    }

    #[test]
    fn a_lookat_is_the_camera_of_mitsuba() {
        // Printed by Mitsuba 3.9.1.
        assert_rows(
            "<lookat origin='1,2,3' target='0,0.5,0' up='0,1,0'/>",
            [
                [-0.948683, -0.135526, -0.285714, 1.],
                [0., 0.903508, -0.428571, 2.],
                [0.316228, -0.406579, -0.857143, 3.],
            ],
        );
    }

    #[test]
    fn only_even_scaling_counts_as_such() {
        let m = |steps| product(steps).matrix3;
        assert!(
            (even_scale(m("<rotate y='1' angle='20'/><scale value='-3'/>"), 1e-9).unwrap() - 3.0).abs()
                < 1e-9
        );
        assert_eq!(even_scale(m("<scale x='1.01'/>"), 1e-4), None);
        assert_eq!(even_scale(m("<matrix value='1 0.01 0 0 1 0 0 0 1'/>"), 1e-4), None);
    }
}
