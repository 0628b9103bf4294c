//! Where the triangles of a mesh stand in the scene: corners and normals in scene units, and which way around.
//!
//! Meshes that are in the scene by themselves and those that several shapes share go through the same operations, so that they have the
//! same bits.

use foton_math::glam::{DAffine3, DMat3, DVec3, Vec3, Vec4};

use crate::description::{Mesh, ShapeDescription};
use crate::normalise::Normalisation;
use crate::plane::triangle_normal;

/// Vertex normals this close to a triangle's own (within 0.03°) say that it is flat.
const FLAT_COSINE: f32 = 1.0 - 1e-7;

/// The map from a mesh to the scene.
#[derive(Clone, Debug)]
pub(crate) struct Placement {
    to_world: DAffine3,
    /// Of normals, flipped if the shape says so; `None` where the transform cannot be inverted.
    normals: Option<DMat3>,
    to_scene: Normalisation,
    /// Whether corners are counter-clockwise seen from inside: a mirroring transform turns them around, and so does flipping.
    is_turned: bool,
}

impl Placement {
    pub(crate) fn new(shape: &ShapeDescription, to_scene: &Normalisation) -> Self {
        let inverse = shape.to_world.matrix3.inverse();
        let sign = if shape.flip_normals { -1.0 } else { 1.0 };
        Self {
            to_world: shape.to_world,
            normals: inverse.is_finite().then(|| inverse.transpose() * sign),
            to_scene: *to_scene,
            is_turned: (shape.to_world.matrix3.determinant() < 0.0) != shape.flip_normals,
        }
    }

    /// A mesh by itself, in the space of `to_scene`.
    pub(crate) fn of_mesh(to_scene: &Normalisation) -> Self {
        let (to_world, normals) = (DAffine3::IDENTITY, Some(DMat3::IDENTITY));
        Self { to_world, normals, to_scene: *to_scene, is_turned: false }
    }

    /// Mesh to world.
    pub(crate) const fn to_world(&self) -> &DAffine3 {
        &self.to_world
    }

    /// World to scene.
    pub(crate) const fn to_scene(&self) -> &Normalisation {
        &self.to_scene
    }

    /// Whether normals can be brought into the scene.
    pub(crate) const fn can_be_inverted(&self) -> bool {
        self.normals.is_some()
    }

    /// A point in scene units.
    pub(crate) fn point(&self, p: DVec3) -> Vec3 {
        self.to_scene.point(self.to_world.transform_point3(p))
    }

    /// Four points at once, as x, y and z: the same operations in the same order as [`Placement::point`].
    #[inline(always)]
    pub(crate) fn points(&self, [x, y, z]: &[[f64; 4]; 3]) -> [Vec4; 3] {
        let m = &self.to_world.matrix3;
        [0, 1, 2].map(|axis| {
            let (mx, my, mz, t) =
                (m.x_axis[axis], m.y_axis[axis], m.z_axis[axis], self.to_world.translation[axis]);
            let lane = |i: usize| self.to_scene.coordinate(axis, mx * x[i] + my * y[i] + mz * z[i] + t);
            Vec4::new(lane(0), lane(1), lane(2), lane(3))
        })
    }

    /// A unit vertex normal; zero where it has no direction.
    pub(crate) fn normal(&self, n: DVec3) -> Vec3 {
        self.normals.map_or(Vec3::ZERO, |m| (m * n).normalize_or_zero().as_vec3())
    }

    /// A triangle of a mesh, if it has an area in scene units.
    pub(crate) fn triangle(&self, mesh: &Mesh, vertices: [u32; 3]) -> Option<Placed> {
        let position = |i: u32| self.point(mesh.positions[i as usize]);
        let normal = |i: u32| self.normal(mesh.normals[i as usize]);
        self.oriented(vertices, position, (!mesh.normals.is_empty()).then_some(normal))
    }

    /// The same by what positions and normals of its vertices are in scene units.
    pub(crate) fn oriented(
        &self,
        [a, mut b, mut c]: [u32; 3],
        position: impl Fn(u32) -> Vec3,
        normal: Option<impl Fn(u32) -> Vec3>,
    ) -> Option<Placed> {
        if self.is_turned {
            (b, c) = (c, b);
        }
        let corners = |[a, b, c]: [u32; 3]| [a, b, c].map(&position);
        let flat = triangle_normal(corners([a, b, c]))?;
        let mut normals = None;
        if let Some(normal) = normal {
            let [na, nb, nc] = [a, b, c].map(&normal);
            if (na + nb + nc).dot(flat) < 0.0 {
                (b, c) = (c, b);
            }
            let usable = [na, nb, nc].iter().all(|n| *n != Vec3::ZERO);
            let flat = [na, nb, nc].iter().all(|n| n.dot(flat).abs() > FLAT_COSINE);
            normals = (usable && !flat).then(|| [a, b, c].map(&normal));
        }
        Some(Placed { vertices: [a, b, c], corners: corners([a, b, c]), normals })
    }
}

/// A triangle in the scene.
pub(crate) struct Placed {
    /// Its vertices in the mesh, counter-clockwise seen from outside.
    pub(crate) vertices: [u32; 3],
    /// Where those are, in scene units.
    pub(crate) corners: [Vec3; 3],
    /// Their unit normals, unless it is flat.
    pub(crate) normals: Option<[Vec3; 3]>,
}
