//! Meshes that move, as they stand when nothing moves: blended between shapes by the weights of the file, and bent by the joints of a skin.

use foton_math::glam::{DAffine3, DMat3, DVec3};

use super::accessor::{Accessor, Source};
use super::json::At;
use crate::diagnostic::Report;

/// Joints for each vertex: those of `JOINTS_0`.
const JOINTS: usize = 4;

/// How a mesh stands.
#[derive(Default)]
pub(super) struct Pose {
    /// The share of each shape that it blends into.
    pub(super) weights: Vec<f64>,
    /// What each joint does to vertices; empty where there is no skin.
    pub(super) joints: Vec<DAffine3>,
}

/// What moves the vertices of a part.
pub(super) struct Movers<'b> {
    pose: &'b Pose,
    /// Positions and normals that are added, with their shares.
    targets: Vec<(f64, Option<Accessor<'b>>, Option<Accessor<'b>>)>,
    joints: Option<(Accessor<'b>, Accessor<'b>)>,
}

impl<'b> Movers<'b> {
    /// Of a primitive with that many vertices; `None` where something is wrong, which is said.
    pub(super) fn of(
        primitive: &At<'_>,
        pose: &'b Pose,
        source: &Source<'_, 'b>,
        count: usize,
        report: &mut Report,
    ) -> Option<Self> {
        let mut targets = Vec::new();
        for (target, &weight) in primitive.items("targets", report).iter().zip(&pose.weights) {
            if weight != 0.0 {
                let position = source.of_vertices(target, "POSITION", (3, count), report)?;
                let normal = source.of_vertices(target, "NORMAL", (3, count), report)?;
                targets.push((weight, position, normal));
            }
        }
        let mut joints = None;
        if !pose.joints.is_empty() {
            let attributes = primitive.get("attributes")?;
            let numbers = source.of_vertices(&attributes, "JOINTS_0", (JOINTS, count), report)?;
            let weights = source.of_vertices(&attributes, "WEIGHTS_0", (JOINTS, count), report)?;
            joints = numbers.zip(weights);
        }
        Some(Self { pose, targets, joints })
    }

    /// Whether it leaves all vertices where they are.
    pub(super) fn is_still(&self) -> bool {
        self.targets.is_empty() && self.joints.is_none()
    }

    /// A position and a normal moved.
    pub(super) fn moved(&self, vertex: usize, mut position: DVec3, mut normal: DVec3) -> (DVec3, DVec3) {
        for (weight, positions, normals) in &self.targets {
            let added = |of: &Option<Accessor<'_>>| {
                of.as_ref().map_or(DVec3::ZERO, |of| DVec3::from_array(of.read(vertex)) * *weight)
            };
            position += added(positions);
            normal += added(normals);
        }
        let Some((joints, weights)) = &self.joints else { return (position, normal) };
        let (numbers, shares) = (joints.read::<JOINTS>(vertex), weights.read::<JOINTS>(vertex));
        let (mut matrix, mut translation, mut sum) = (DMat3::ZERO, DVec3::ZERO, 0.0);
        for (number, share) in numbers.into_iter().zip(shares) {
            if let Some(joint) = self.pose.joints.get(number as usize).filter(|_| share > 0.0) {
                matrix += joint.matrix3 * share;
                translation += joint.translation * share;
                sum += share;
            }
        }
        if sum <= 0.0 {
            return (position, normal);
        }
        let moved = (matrix * position + translation) / sum;
        let turned = matrix.inverse().transpose() * normal;
        (moved, if turned.is_finite() { turned } else { normal })
    }
}
