//! Refinement: what a pass has found at the hit points of a packet becomes irradiance, and their radii shrink.

use std::f32::consts::PI;

use foton_math::Rgb;
use foton_transport::Quantity;
use foton_transport::photon_map::{LANES, Packet};

use super::rule::Rule;
use super::slots::{Found, Slots};
use super::tally::Tally;

/// Turns a packet's sums into irradiance, refines its hit points, and writes the radii of the next pass.
pub(super) fn refine<const LAYERS: usize>(
    packet: &mut Packet,
    found: &Found<LAYERS>,
    slots: Slots<'_, LAYERS>,
    rule: Rule,
    tally: &mut Tally,
) {
    let Slots { statistics, smallest2, irradiance, counts, radius_statistics, .. } = slots;
    for l in 0..LANES {
        let radius2 = packet.radius2[l];
        if radius2 < 0.0 {
            continue;
        }
        let per_area = 1.0 / (PI * radius2);
        for (out, flux) in irradiance[l].iter_mut().zip(&found.flux) {
            *out = Rgb::new(flux[0][l], flux[1][l], flux[2][l]) * per_area;
            if !out.is_finite() {
                *out = Rgb::BLACK;
                tally.leave_out(Quantity::Irradiance, packet, l);
            }
        }
        let count = u64::from(found.count[l]) + counts.get(l).copied().unwrap_or(0);
        let smallest2 = f64::from(smallest2[l]);
        let floored = match rule.common {
            None => {
                let known = radius_statistics.get(l).filter(|_| rule.adapts);
                let alpha = known.map_or(rule.alpha, |e| e.alpha(rule.alpha));
                statistics[l].refine(count, alpha, smallest2)
            }
            Some(rho) => statistics[l].shrink(count, rho, smallest2),
        };
        tally.floored += u64::from(floored);
        tally.accepted += count;
        tally.unknown += u64::from(statistics[l].is_unknown());
        tally.radius2 += statistics[l].radius2();
        packet.radius2[l] = statistics[l].radius2() as f32;
    }
}
