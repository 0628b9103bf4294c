//! Hit points: where eye paths end on surfaces that spread light, laid out for the gather.
//!
//! Three orders meet here. *Sample order* is that of the eye pass: a pixel's hit points are neighbours in it. *Slot order* is
//! that of the packets, 16 slots each, some empty. Statistics have slots of their own, apart from the query records.

use foton_math::glam::Vec3;
use foton_math::{Cancel, Cancelled, Frame, Rgb};
use foton_scene::Scattering;

use crate::adaptive::Evidence;
use crate::not_finite::{LeftOut, Quantity};
use crate::packet::{self, LANES, Packet};
use crate::photon::Photon;
use crate::refine::Statistics;

/// A hit point as the eye pass finds it. Scene units.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HitPoint {
    pub(crate) position: Vec3,
    /// Unit geometric normal on the eye's side.
    pub(crate) normal: Vec3,
    /// Unit shading normal on the same side.
    pub(crate) shading_normal: Vec3,
    /// An origin for shadow rays, certainly on the eye's side.
    pub(crate) origin: Vec3,
    /// Eye throughput, times the BSDF's value where that is Lambertian: radiance at the eye per irradiance here (sr⁻¹).
    pub(crate) weight: Rgb,
    /// Index of its [`Gloss`]; `None` for a Lambertian one.
    pub(crate) gloss: Option<u32>,
    /// First squared radius.
    pub(crate) radius2: f32,
    /// Squared half-thickness of the slab in which photons count, over the squared radius.
    pub(crate) slab2: f32,
    /// The squared radius below which it does not shrink.
    pub(crate) smallest2: f32,
    /// The most edges that a photon's path may have here.
    pub(crate) budget: u8,
    /// See [`Surface::patch_towards`](foton_scene::Surface::patch_towards).
    pub(crate) patch: u8,
}

/// How a hit point weighs light from each direction, where that is not the same for all.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Gloss {
    pub(crate) scattering: Scattering,
    /// The frame around the shading normal in which the BSDF is stated.
    pub(crate) frame: Frame,
    /// Unit direction to the eye in that frame.
    pub(crate) wo: Vec3,
    /// Whether it stands for lobes that the eye path follows, and weighs what that cannot find.
    pub(crate) narrow: bool,
}

impl Gloss {
    /// The value of its lobes for light from the unit direction `wi` (sr⁻¹).
    pub(crate) fn eval(&self, wi: Vec3) -> Rgb {
        let wi = self.frame.to_local(wi);
        if self.narrow {
            self.scattering.eval_followed(self.wo, wi)
        } else {
            self.scattering.eval_kept(self.wo, wi)
        }
    }

    /// Whether it weighs a photon of the place: kept lobes all, followed ones those alone that no eye path could bring.
    #[inline(always)]
    pub(crate) const fn takes(&self, photon: &Photon) -> bool {
        !self.narrow || photon.is_lone()
    }
}

/// Light that arrives at a hit point, per path class or in all: Σ Φ/(π r²) over the photons of one pass (W·m⁻²), each
/// photon weighed by the BSDF's value where that is not Lambertian (W·m⁻²·sr⁻¹).
pub(crate) type Irradiance<const LAYERS: usize> = [Rgb; LAYERS];

/// What shadow rays need of a slot.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShadowOrigin {
    pub(crate) origin: Vec3,
    pub(crate) shading_normal: Vec3,
}

/// All hit points. Packets of Lambertian ones come first. Vectors whose names end in `_slots` have [`LANES`] entries a packet.
pub(crate) struct HitPoints {
    pub(crate) packets: Vec<Packet>,
    /// Packets from here on hold hit points that are not Lambertian.
    pub(crate) first_glossy: usize,
    /// [`LANES`] entries a packet from `first_glossy` on.
    pub(crate) gloss_slots: Vec<Option<Gloss>>,
    /// Shading normals over 127, as the packets' own are, by packet, as three rows of lanes; empty when the scene has none that matter.
    pub(crate) shading_normals: Vec<[[f32; LANES]; 3]>,
    /// Empty unless direct light comes by shadow rays.
    pub(crate) shadow_slots: Vec<ShadowOrigin>,
    pub(crate) statistics_slots: Vec<Statistics>,
    /// [`HitPoint::smallest2`].
    pub(crate) smallest2_slots: Vec<f32>,
    /// Empty unless radii adapt or the error is asked for.
    pub(crate) evidence_slots: Vec<Evidence>,
    /// In sample order: where the hit point is.
    pub(crate) slot_of: Vec<u32>,
    /// In sample order: [`HitPoint::weight`].
    pub(crate) weights: Vec<Rgb>,
    /// The hit points of pixel p are `pixel_start[p]..pixel_start[p + 1]` in sample order.
    pub(crate) pixel_start: Vec<u32>,
}

impl HitPoints {
    /// Lays hit points out. `pixel_start` is as in [`HitPoints`].
    ///
    /// # Errors
    /// When cancelled.
    pub(crate) fn new(
        found: &[HitPoint],
        gloss: &[Gloss],
        pixel_start: Vec<u32>,
        shading_normals: bool,
        shadow_rays: bool,
        cancel: &Cancel,
    ) -> Result<Self, Cancelled> {
        let mut groups = packet::group(found, |h| h.gloss.is_none(), cancel)?;
        let first_glossy = groups.len();
        if !gloss.is_empty() {
            groups.extend(packet::group(found, |h| h.gloss.is_some(), cancel)?);
        }
        let mut gloss_slots = vec![None; (groups.len() - first_glossy) * LANES];
        let mut packets = Vec::with_capacity(groups.len());
        let mut normals = Vec::with_capacity(if shading_normals { groups.len() } else { 0 });
        let mut slot_of = vec![0u32; found.len()];
        let slots = groups.len() * LANES;
        let mut statistics_slots = vec![Statistics::EMPTY_SLOT; slots];
        let mut smallest2_slots = vec![0.0; slots];
        let nowhere = ShadowOrigin { origin: Vec3::ZERO, shading_normal: Vec3::ZERO };
        let mut shadow_slots = vec![nowhere; if shadow_rays { slots } else { 0 }];
        for (p, group) in groups.iter().enumerate() {
            cancel.check_at(p)?;
            let members = || group.iter().map(|&i| &found[i as usize]);
            packets.push(Packet::new(members()));
            if shading_normals {
                normals.push(packet::rows(members().map(|h| h.shading_normal / 127.0)));
            }
            for (lane, &i) in group.iter().enumerate() {
                let slot = p * LANES + lane;
                let h = &found[i as usize];
                slot_of[i as usize] = slot as u32;
                statistics_slots[slot] = Statistics::new(h.radius2);
                smallest2_slots[slot] = h.smallest2;
                if let Some(g) = h.gloss {
                    gloss_slots[slot - first_glossy * LANES] = Some(gloss[g as usize]);
                }
                if let Some(shadow) = shadow_slots.get_mut(slot) {
                    *shadow = ShadowOrigin { origin: h.origin, shading_normal: h.shading_normal };
                }
            }
        }
        Ok(Self {
            packets,
            first_glossy,
            gloss_slots,
            shading_normals: normals,
            shadow_slots,
            statistics_slots,
            smallest2_slots,
            evidence_slots: Vec::new(),
            slot_of,
            weights: found.iter().map(|h| h.weight).collect(),
            pixel_start,
        })
    }

    /// Makes room for what radii that adapt go by, and the error's upper end.
    #[must_use]
    pub(crate) fn with_evidence(self) -> Self {
        Self { evidence_slots: vec![Evidence::default(); self.statistics_slots.len()], ..self }
    }

    /// How a slot weighs light, where that is not Lambertian.
    pub(crate) fn gloss(&self, slot: usize) -> Option<&Gloss> {
        self.gloss_slots.get(slot.checked_sub(self.first_glossy * LANES)?)?.as_ref()
    }

    /// Whether any weighs light by where it comes from.
    pub(crate) const fn ask_for_directions(&self) -> bool {
        !(self.gloss_slots.is_empty() && self.shading_normals.is_empty())
    }

    /// How many there are.
    pub(crate) const fn len(&self) -> usize {
        self.slot_of.len()
    }

    /// What is noted of a pixel whose sum was not finite, by its first hit point.
    pub(crate) fn left_out_at(&self, first: u32) -> LeftOut {
        let slot = self.slot_of[first as usize] as usize;
        self.packets[slot / LANES].left_out(Quantity::PixelSum, slot % LANES)
    }

    /// Statistics of all hit points, in sample order.
    pub(crate) fn statistics(&self) -> impl Iterator<Item = &Statistics> {
        self.slot_of.iter().map(|&slot| &self.statistics_slots[slot as usize])
    }

    /// Bytes held.
    pub(crate) const fn bytes(&self) -> usize {
        size_of::<Packet>() * self.packets.len()
            + size_of::<Option<Gloss>>() * self.gloss_slots.len()
            + size_of::<[[f32; LANES]; 3]>() * self.shading_normals.len()
            + size_of::<ShadowOrigin>() * self.shadow_slots.len()
            + (size_of::<Statistics>() + size_of::<f32>()) * self.statistics_slots.len()
            + size_of::<Evidence>() * self.evidence_slots.len()
            + (size_of::<u32>() + size_of::<Rgb>()) * self.slot_of.len()
            + size_of::<u32>() * self.pixel_start.len()
    }
}
