//! χ² tests: directions that BSDFs sample, by bins of the sphere, against their pdf.

use std::f32::consts::PI;

use super::*;

/// Bins of the angle from the normal and of the azimuth.
const BINS: [usize; 2] = [12, 16];
/// Points of the quadrature along each side of a bin.
const POINTS: usize = 40;
const SAMPLES: u32 = 60_000;

fn bin_of(w: Vec3) -> usize {
    let row = (w.z.clamp(-1.0, 1.0).acos() / PI * BINS[0] as f32) as usize;
    let turn = w.y.atan2(w.x) / (2.0 * PI) + 0.5;
    row.min(BINS[0] - 1) * BINS[1] + ((turn * BINS[1] as f32) as usize).min(BINS[1] - 1)
}

/// What the pdf says of each bin, in samples.
fn expected(s: &Scattering, wo: Vec3) -> Vec<f64> {
    let mut expected = vec![0.0; BINS[0] * BINS[1]];
    let [rows, columns] = BINS.map(|n| n * POINTS);
    for i in 0..rows * columns {
        let theta = PI * ((i / columns) as f32 + 0.5) / rows as f32;
        let phi = (2.0 * ((i % columns) as f32 + 0.5) / columns as f32 - 1.0) * PI;
        let (sine, cosine) = theta.sin_cos();
        let w = Vec3::new(sine * phi.cos(), sine * phi.sin(), cosine);
        let solid_angle = 2.0 * PI * PI * sine / (rows * columns) as f32;
        expected[bin_of(w)] += f64::from(s.pdf(wo, w) * solid_angle) * f64::from(SAMPLES);
    }
    expected
}

/// Whether lobes are so wide that the quadrature tells the bins.
fn is_wide(s: &Scattering) -> bool {
    s.flags().spreads() && s.narrowest() > 0.19
}

#[test]
fn sampled_directions_follow_their_density() {
    let mut stream = Stream::new(36, Purpose::Test, 0, 0);
    for s in all().into_iter().filter(is_wide) {
        for wo in views().into_iter().filter(|&w| is_lit(&s, w)) {
            let mut counts = vec![0.0; BINS[0] * BINS[1]];
            for _ in 0..SAMPLES {
                let u_lobe = stream.next_1d();
                let sample = s.sample(wo, Transport::Radiance, u_lobe, stream.next_2d(), TOGETHER);
                if let Some(sample) = sample.filter(|x| !x.lobe.intersects(LobeFlags::DELTA)) {
                    counts[bin_of(sample.wi)] += 1.0;
                }
            }
            let expected = expected(&s, wo);
            // What is absorbed, leaves below the surface or takes a single direction is a bin of its own, with all bins that hold little.
            let n = f64::from(SAMPLES);
            let mut rest = (n - counts.iter().sum::<f64>(), n - expected.iter().sum::<f64>());
            let (mut chi2, mut degrees) = (0.0, -1.0);
            let mut add = |c: f64, e: f64| {
                chi2 += (c - e).powi(2) / e;
                degrees += 1.0;
            };
            for (&c, &e) in counts.iter().zip(&expected) {
                if e < 20.0 { rest = (rest.0 + c, rest.1 + e) } else { add(c, e) }
            }
            if rest.1 > 20.0 {
                add(rest.0, rest.1);
            }
            // Wilson–Hilferty at p = 10⁻⁴ (Šidák for 100 tests at 0.01).
            let k: f64 = 2.0 / (9.0 * degrees);
            let bound = degrees * (1.0 - k + 3.72 * k.sqrt()).powi(3);
            assert!(chi2 < bound, "{s:?} {wo}: χ² {chi2}, bound {bound} ({degrees} degrees of freedom)");
        }
    }
}
