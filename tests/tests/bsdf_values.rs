//! Every BSDF against Mitsuba's values on a grid of directions: `tests/golden/bsdf-values.txt`, made by
//! `tests/conformance/bsdf_values.py`, where its columns are explained.
//!
//! Mitsuba takes the shadowing of Beckmann's facets from a rational fit, 0.4 % off. What a rough coat sends back inside it sums
//! over 64 points without weighing the two ends by half, which makes the base of its rough plastic up to 2 % too dark. Hence
//! the two bounds.

use foton_format::Options;
use foton_math::Ray;
use foton_math::glam::{Vec2, Vec3};
use foton_scene::{LobeFlags, Scattering, Scene, Transport};

const GOLDEN: &str = include_str!("../golden/bsdf-values.txt");

/// The largest relative deviation, and that under rough coats.
const BOUND: f64 = 0.01;
const COAT_BOUND: f64 = 0.03;

/// A square of the BSDF, and what it does at a point.
fn scattering(bsdf: &str) -> Scattering {
    let xml = format!(
        r#"<scene version="3.0.0"><sensor type="perspective"/>{bsdf}
           <shape type="rectangle"><ref id="it"/></shape></scene>"#
    );
    let no_files = |_: &std::path::Path| Err(std::io::ErrorKind::NotFound.into());
    let opened = foton_format::read_str("golden", &xml, &no_files, &Options::default())
        .expect("a scene of one square");
    let scene = Scene::build(&opened.description).expect("one square");
    let above = scene.normalisation().point((0.1, 0.2, 1.0).into());
    let surface = scene.nearest(Ray::new(above, -Vec3::Z)).expect("the square is there");
    scene.scattering(&surface, true).expect("its front")
}

fn direction(theta: f64, phi: f64) -> Vec3 {
    let ((s, c), (sp, cp)) = (theta.to_radians().sin_cos(), phi.to_radians().sin_cos());
    Vec3::new((s * cp) as f32, (s * sp) as f32, c as f32)
}

/// The largest relative deviation of a block's values and pdfs, and of its delta lobes; and how many lines it has.
fn compare(s: &Scattering, lines: &[&str]) -> [f64; 3] {
    let mut worst = [0f64; 3];
    let numbers = |line: &str| -> Vec<f64> {
        line.split(' ').skip(1).map(|n| n.parse().expect("the file holds numbers")).collect()
    };
    for line in lines {
        let n = numbers(line);
        let (wo, wi) = (direction(n[0], n[1]), direction(n[2], n[3]));
        // What is far below the peaks may be off by a little more of itself.
        let deviation =
            |ours: f32, theirs: f64, floor: f64| (f64::from(ours) - theirs).abs() / theirs.abs().max(floor);
        if line.starts_with("value") {
            let value = s.eval(wo, wi, LobeFlags::ALL).to_array();
            for (ours, theirs) in value.into_iter().zip(&n[4..7]) {
                worst[0] = worst[0].max(deviation(ours, *theirs, 1e-3));
            }
            if n[7] > 0.0 {
                worst[1] = worst[1].max(deviation(s.pdf(wo, wi), n[7], 1e-3));
            }
        } else {
            let lobes = s.lobes(wo, Transport::Radiance, Vec2::splat(0.5), LobeFlags::ALL);
            let near = lobes.iter().flatten().find(|l| l.wi.distance(wi) < 1e-3);
            let Some(lobe) = near else { return [f64::INFINITY; 3] };
            for (ours, theirs) in lobe.weight.to_array().into_iter().zip(&n[4..7]) {
                worst[2] = worst[2].max(deviation(ours, *theirs, 1e-3));
            }
        }
    }
    worst
}

#[test]
fn values_pdfs_and_delta_lobes_are_mitsubas() {
    let mut blocks = 0;
    let mut faults = Vec::new();
    let mut lines = GOLDEN.lines().skip(1).peekable();
    while let Some(name) = lines.next().and_then(|l| l.strip_prefix("bsdf ")) {
        let xml = lines.next().expect("XML follows the name");
        let mut values = Vec::new();
        while let Some(line) = lines.next_if(|l| !l.starts_with("bsdf ")) {
            values.push(line);
        }
        let worst = compare(&scattering(xml), &values);
        blocks += 1;
        let bound = if xml.contains("roughplastic") { COAT_BOUND } else { BOUND };
        if worst.iter().any(|w| *w > bound) {
            faults.push(format!("{name}: {worst:?}"));
        }
    }
    assert!(faults.is_empty() && blocks == 35, "{blocks} BSDFs; {faults:#?}");
}
