//! Surfaces of revolution: spheres, disks, cylinders and what is cut out of them, cones, paraboloids and hyperboloids.
//!
//! What foton intersects as it is becomes a primitive; all else becomes triangles with the normals of the surface. Parameters u and v
//! are pbrt's: u is the angle, and the normal is that of ∂p/∂u × ∂p/∂v.

use std::f64::consts::{PI, TAU};

use foton_math::glam::{DAffine3, DVec2, DVec3};
use foton_scene::description::{Geometry, Mesh};

/// Segments around a whole circle, and from one end to the other.
const AROUND: f64 = 128.0;
const ALONG: u32 = 64;

/// A surface of revolution about z, up to an angle in radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Round {
    pub(crate) profile: Profile,
    pub(crate) phi_max: f64,
}

/// What turns about z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Profile {
    /// Between two heights.
    Sphere {
        radius: f64,
        from: f64,
        to: f64,
    },
    /// Flat at a height, from the rim inwards.
    Disc {
        height: f64,
        radius: f64,
        inner: f64,
    },
    Cylinder {
        radius: f64,
        from: f64,
        to: f64,
    },
    /// With its tip at a height.
    Cone {
        radius: f64,
        height: f64,
    },
    /// Of that radius at the upper end.
    Paraboloid {
        radius: f64,
        from: f64,
        to: f64,
    },
    /// A line between two points.
    Hyperboloid {
        from: DVec3,
        to: DVec3,
    },
}

impl Round {
    /// The primitive that is the same, with what brings it there; `None` where only a part of it is there.
    pub(crate) fn primitive(&self) -> Option<(Geometry, DAffine3)> {
        if self.phi_max < TAU * (1.0 - 1e-9) {
            return None;
        }
        match self.profile {
            Profile::Sphere { radius, from, to } if from <= -radius && to >= radius => {
                Some((Geometry::Sphere { centre: DVec3::ZERO, radius }, DAffine3::IDENTITY))
            }
            Profile::Disc { height, radius, inner } if inner <= 0.0 => {
                let scale = DAffine3::from_scale(DVec3::splat(radius));
                Some((Geometry::Disc, DAffine3::from_translation(DVec3::Z * height) * scale))
            }
            Profile::Cylinder { radius, from, to } => {
                let [from, to] = [from, to].map(|z| DVec3::Z * z);
                Some((Geometry::Cylinder { from, to, radius }, DAffine3::IDENTITY))
            }
            _ => None,
        }
    }

    /// What tells it from others.
    pub(crate) fn key(&self) -> Vec<u64> {
        let (kind, numbers) = match self.profile {
            Profile::Sphere { radius, from, to } => (0, vec![radius, from, to]),
            Profile::Disc { height, radius, inner } => (1, vec![height, radius, inner]),
            Profile::Cylinder { radius, from, to } => (2, vec![radius, from, to]),
            Profile::Cone { radius, height } => (3, vec![radius, height]),
            Profile::Paraboloid { radius, from, to } => (4, vec![radius, from, to]),
            Profile::Hyperboloid { from, to } => (5, [from.to_array(), to.to_array()].concat()),
        };
        let bits = numbers.into_iter().chain([self.phi_max]).map(f64::to_bits);
        std::iter::once(kind).chain(bits).collect()
    }

    fn segments(&self) -> [u32; 2] {
        #[allow(
            clippy::cast_sign_loss,
            clippy::cast_possible_truncation,
            reason = "the angle is at most a whole turn"
        )]
        let around = ((AROUND * self.phi_max / TAU).ceil() as u32).max(4);
        let along = match self.profile {
            Profile::Disc { .. } | Profile::Cylinder { .. } => 1,
            _ => ALONG,
        };
        [around, along]
    }

    /// Bytes that its triangles take.
    pub(crate) fn mesh_bytes(&self) -> u64 {
        let [around, along] = self.segments().map(u64::from);
        (around + 1) * (along + 1) * 64 + around * along * 24
    }

    /// Its triangles.
    pub(crate) fn mesh(&self) -> Mesh {
        let [around, along] = self.segments();
        let mut mesh = Mesh::default();
        let is_whole = self.phi_max >= TAU * (1.0 - 1e-9);
        for j in 0..=along {
            let v = f64::from(j) / f64::from(along);
            for i in 0..=around {
                let u = f64::from(i) / f64::from(around);
                // Both ends of a whole turn are the same points.
                let phi = if is_whole && i == around { 0.0 } else { u * self.phi_max };
                let (position, normal) = self.at(phi, v);
                mesh.positions.push(position);
                mesh.normals.push(normal);
                mesh.texture_coordinates.push(DVec2::new(u, v));
            }
        }
        let row = around + 1;
        for (j, i) in (0..along).flat_map(|j| (0..around).map(move |i| (j, i))) {
            let [a, b] = [j * row + i, (j + 1) * row + i];
            let both = [[a, a + 1, b + 1], [a, b + 1, b]];
            let kept = both.into_iter().filter(|t| mesh.has_area(*t)).collect::<Vec<_>>();
            mesh.triangles.extend(kept);
        }
        mesh
    }

    /// A point and the normal there.
    fn at(&self, phi: f64, v: f64) -> (DVec3, DVec3) {
        if let Profile::Hyperboloid { from, to } = self.profile {
            let turn = |p: DVec3| {
                DVec3::new(p.x * phi.cos() - p.y * phi.sin(), p.x * phi.sin() + p.y * phi.cos(), p.z)
            };
            let p = turn(from.lerp(to, v));
            let normal = DVec3::new(-p.y, p.x, 0.0).cross(turn(to - from));
            return (p, normal.normalize_or(DVec3::Z));
        }
        let [r, z, dr, dz] = self.profile.at(v);
        let (sin, cos) = phi.sin_cos();
        let normal = DVec3::new(dz * cos, dz * sin, -dr).normalize_or(DVec3::Z);
        (DVec3::new(r * cos, r * sin, z), normal)
    }
}

impl Profile {
    /// Radius and height from one end to the other, and the direction in which they go on.
    fn at(&self, v: f64) -> [f64; 4] {
        match *self {
            Self::Sphere { radius, from, to } => {
                let angle = |z: f64| (z / radius).clamp(-1.0, 1.0).acos();
                let (begin, end) = (angle(from), angle(to));
                let theta = begin + v * (end - begin);
                let (sin, cos) = theta.sin_cos();
                // Poles are points.
                let sin = if (theta - PI).abs() < 1e-12 { 0.0 } else { sin };
                let back = (end - begin).signum();
                [radius * sin, radius * cos, cos * back, -sin * back]
            }
            Self::Disc { height, radius, inner } => {
                [radius + v * (inner - radius), height, inner - radius, 0.0]
            }
            Self::Cylinder { radius, from, to } => [radius, from + v * (to - from), 0.0, to - from],
            Self::Cone { radius, height } => [radius * (1.0 - v), height * v, -radius, height],
            Self::Paraboloid { radius, from, to } => {
                let z = from + v * (to - from);
                [radius * (z / to).max(0.0).sqrt(), z, radius, 2.0 * (z * to).max(0.0).sqrt()]
            }
            Self::Hyperboloid { .. } => [0.0; 4],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(mesh: &Mesh) -> f64 {
        let of = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
            0.5 * (b - a).cross(c - a).length()
        };
        mesh.triangles.iter().map(of).sum()
    }

    #[test]
    fn triangles_have_the_area_and_the_normals_of_the_surface() {
        let half = |profile| Round { profile, phi_max: PI };
        for (round, wanted) in [
            (half(Profile::Sphere { radius: 2.0, from: -2.0, to: 1.0 }), PI * 2.0 * 3.0),
            (half(Profile::Disc { height: 1.0, radius: 2.0, inner: 1.0 }), 0.5 * PI * 3.0),
            (half(Profile::Cylinder { radius: 2.0, from: -1.0, to: 1.0 }), PI * 2.0 * 2.0),
            (half(Profile::Cone { radius: 3.0, height: 4.0 }), 0.5 * PI * 3.0 * 5.0),
            (
                half(Profile::Paraboloid { radius: 1.0, from: 0.0, to: 1.0 }),
                PI / 12.0 * (5f64.powf(1.5) - 1.0),
            ),
            (half(Profile::Hyperboloid { from: DVec3::X, to: DVec3::new(1.0, 0.0, 2.0) }), PI * 2.0),
        ] {
            let mesh = round.mesh();
            let found = area(&mesh);
            assert!((found / wanted - 1.0).abs() < 2e-3, "{round:?}: {found} is not {wanted}");
            for t in &mesh.triangles {
                let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
                let normal = (b - a).cross(c - a).normalize();
                let agrees = t.iter().all(|&i| mesh.normals[i as usize].dot(normal) > 0.9);
                assert!(agrees, "{round:?}: {t:?}");
            }
            let bytes = mesh.positions.len() * 64 + mesh.triangles.len() * 12;
            assert!(round.mesh_bytes() >= bytes as u64);
        }
    }

    #[test]
    fn what_is_whole_is_a_primitive() {
        let whole = |profile| Round { profile, phi_max: TAU }.primitive().is_some();
        assert!(whole(Profile::Sphere { radius: 1.0, from: -1.0, to: 1.0 }));
        assert!(!whole(Profile::Sphere { radius: 1.0, from: -0.5, to: 1.0 }));
        assert!(whole(Profile::Disc { height: 1.0, radius: 1.0, inner: 0.0 }));
        assert!(!whole(Profile::Disc { height: 1.0, radius: 1.0, inner: 0.5 }));
    }
}
