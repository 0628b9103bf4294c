//! Refinement: what a pass has found at the hit points of a packet becomes irradiance, and their radii shrink.

use std::f32::consts::PI;

use foton_math::Rgb;
use foton_transport::Quantity;
use foton_transport::photon_map::Packet;

use super::arrived::Lanes;
use super::kept::KeptStatistics;
use super::rule::Rule;
use super::slots::{Found, Slots};
use super::tally::Tally;

/// Turns a packet's sums into irradiance at the lanes for which photons have counted, refines its hit points, and writes the radii of the
/// next pass. `index` is that of the packet in its block. Returns whether any radius may have shrunk.
pub(super) fn refine<const LAYERS: usize>(
    (index, packet): (usize, &mut Packet),
    found: &Found<LAYERS>,
    slots: &mut Slots<'_, LAYERS>,
    rule: Rule,
    tally: &mut Tally,
) -> bool {
    let lanes = slots.lanes[index];
    for (l, _) in lanes.each() {
        let per_area = 1.0 / (PI * packet.radius2[l]);
        let irradiance = found.flux.map(|[r, g, b]| {
            let irradiance = Rgb::new(r[l], g[l], b[l]) * per_area;
            if irradiance.is_finite() {
                return irradiance;
            }
            tally.leave_out(Quantity::Irradiance, packet, l);
            Rgb::BLACK
        });
        slots.entries.irradiance.push(irradiance);
        if rule.error {
            slots.entries.moments.push(found.moments(packet, rule.question, l));
        }
    }
    // A pass that finds nothing at a hit point changes nothing there, unless all radii shrink together.
    let shrinking = if rule.common.is_some() { Lanes::ALL } else { lanes };
    for (l, _) in shrinking.each() {
        if packet.radius2[l] < 0.0 {
            continue;
        }
        let place = slots.places(index).start + l;
        let mut statistics = slots.statistics[place].beside(packet.radius2[l]);
        let (count, smallest2) =
            (u64::from(found.count[l]), f64::from(slots.smallest2[slots.first_place[index] as usize + l]));
        slots.sums.take_off(&statistics);
        let floored = match rule.common {
            None => {
                let known = slots.radius_statistics.get(place).filter(|_| rule.adapts);
                let alpha = known.map_or(rule.alpha, |kept| kept.sums().alpha(rule.alpha));
                statistics.refine(count, alpha, smallest2)
            }
            Some(rho) => statistics.shrink(count, rho, smallest2),
        };
        slots.sums.add(&statistics);
        slots.statistics[place] = KeptStatistics::new(&statistics);
        tally.floored += u64::from(floored);
        tally.accepted += count;
        packet.radius2[l] = statistics.radius2() as f32;
    }
    !shrinking.is_none()
}
