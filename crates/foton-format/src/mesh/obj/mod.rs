//! Wavefront OBJ to positions, normals, texture coordinates and triangles by index. Groups and curves are not
//! read; materials are kept by name. Colours of vertices (`v x y z r g b`) are read.
//!
//! Our own reader, because errors must name the line. Two passes over the bytes: the first counts, so that the
//! second allocates once and can check every index where it stands. What exporters get wrong and what can be done
//! without is mended or left out, counted and warned of: normals and texture coordinates that are no numbers, faces of
//! fewer than three corners.

mod colours;
mod kind;
mod parser;
#[cfg(test)]
mod tests;

use foton_math::glam::{DVec2, DVec3};

use crate::diagnostic::Place;
use crate::mesh::words::Problem;

/// How warnings that readers of meshes share go on.
pub(crate) const LEFT_OUT: &str = "fewer than three corners and are left out";
pub(crate) const NORMALS_MENDED: &str = "zero or not finite: the faces around say where they point";
pub(crate) const TEXTURES_MENDED: &str = "not finite and taken as zero";

/// The contents of a file, still by index.
pub(crate) struct Obj {
    pub(crate) positions: Vec<DVec3>,
    /// Linear colours of the positions; none where no position has one.
    pub(crate) colours: Vec<[f32; 3]>,
    pub(crate) normals: Vec<DVec3>,
    /// Texture coordinates, v upwards as a rule.
    pub(crate) textures: Vec<DVec2>,
    pub(crate) triangles: Vec<[Corner; 3]>,
    /// Files with materials, and where they are named.
    pub(crate) libraries: Vec<(Place, String)>,
    /// Names of materials, each with the number of triangles before the first that has it.
    pub(crate) materials: Vec<(usize, String)>,
    /// What was mended or left out.
    pub(crate) warnings: Vec<Problem>,
}

/// A corner of a face.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) struct Corner {
    /// Index of the position, from 0.
    pub(crate) position: u32,
    /// Number of the texture coordinate, from 1; 0: none.
    pub(crate) texture: u32,
    /// Number of the normal, from 1; 0: none.
    pub(crate) normal: u32,
}

impl Obj {
    /// Corners whose normal is zero have none; how many normals those are.
    fn drop_zero_normals(&mut self) -> usize {
        let mut is_dropped = vec![false; self.normals.len()];
        for corner in self.triangles.iter_mut().flatten().filter(|c| c.normal != 0) {
            let index = corner.normal as usize - 1;
            if self.normals[index].try_normalize().is_none() {
                is_dropped[index] = true;
                corner.normal = 0;
            }
        }
        is_dropped.iter().filter(|&&dropped| dropped).count()
    }

    /// Triangles that are gone no longer stand before a material.
    fn renumber_materials(&mut self, gone: &[usize]) {
        let mut gone = gone.iter().peekable();
        let mut count = 0;
        for (before, _) in &mut self.materials {
            while gone.next_if(|&at| at < before).is_some() {
                count += 1;
            }
            *before -= count;
        }
    }
}
