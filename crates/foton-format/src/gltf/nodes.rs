//! The tree of nodes: where each stands in the world, and what it shows there.
//!
//! Nodes that show the same mesh share it, whatever they are called.

use std::rc::Rc;
use std::sync::Arc;

use foton_math::glam::{DAffine3, DQuat, DVec3};
use foton_scene::description::{Geometry, Mesh, ShapeDescription};

use super::accessor::Source;
use super::json::At;
use super::pose::Pose;
use super::reader::{Part, Reader};

/// Bytes that a shape takes with its name.
const SHAPE: u64 = size_of::<ShapeDescription>() as u64 + 64;

/// How far the last row of a matrix may be from that of an affine map.
const AFFINE: f64 = 1e-6;

/// A node of the scene, and where it stands.
struct Placed<'a> {
    node: At<'a>,
    global: DAffine3,
}

impl<'a> Reader<'a> {
    /// Adds all that the nodes of the scene show.
    pub(super) fn nodes(&mut self) {
        let placed = self.walk();
        let mut globals = vec![None; self.root.count("nodes")];
        for (index, placed) in &placed {
            globals[*index] = Some(placed.global);
        }
        for (done, (_, Placed { node, global })) in placed.iter().enumerate() {
            if self.files.cancel().is_requested() {
                return;
            }
            self.files.begin_part(done, placed.len());
            self.show(node, global, &globals);
        }
    }

    /// The nodes of the scene that is shown, in the order of the file, parents before children.
    fn walk(&mut self) -> Vec<(usize, Placed<'a>)> {
        let count = self.root.count("nodes");
        let mut is_seen = vec![false; count];
        let mut placed = Vec::new();
        let roots = self.roots();
        let mut open: Vec<(usize, DAffine3, String)> =
            roots.into_iter().rev().map(|(index, at)| (index, DAffine3::IDENTITY, at)).collect();
        while let Some((index, parent, named_at)) = open.pop() {
            if self.files.cancel().check_at(placed.len()).is_err() {
                break;
            }
            let node = self.root.get("nodes").and_then(|all| all.item(index));
            let Some(node) = node else {
                let message = format!("{named_at}: there is no nodes[{index}]: the file has {count} of them");
                self.report.error(crate::diagnostic::Place::default(), message);
                continue;
            };
            if std::mem::replace(&mut is_seen[index], true) {
                node.error(&mut self.report, "stands in two places of the tree, or within itself");
                continue;
            }
            let hidden = node.extension("KHR_node_visibility").and_then(|e| e.get("visible"));
            if hidden.is_some_and(|visible| visible.is_false()) {
                continue;
            }
            let Some(local) = self.local(&node) else { continue };
            let global = parent * local;
            if !global.is_finite() {
                node.error(&mut self.report, "stands farther away, or is larger, than numbers go");
                continue;
            }
            let children = node.indices("children", &mut self.report);
            let at = format!("{}.children", node.path());
            open.extend(children.into_iter().rev().map(|child| (child, global, at.clone())));
            placed.push((index, Placed { node, global }));
        }
        placed
    }

    /// The nodes that the scene begins with; in a file without scenes those that are no children.
    fn roots(&mut self) -> Vec<(usize, String)> {
        let root = self.root.clone();
        let scenes = root.count("scenes");
        if scenes == 0 {
            let nodes = root.items("nodes", &mut self.report);
            let mut is_child = vec![false; nodes.len()];
            for node in &nodes {
                for child in node.indices("children", &mut self.report) {
                    if let Some(is_child) = is_child.get_mut(child) {
                        *is_child = true;
                    }
                }
            }
            return (0..nodes.len()).filter(|i| !is_child[*i]).map(|i| (i, "nodes".to_owned())).collect();
        }
        let scene = match root.get("scene") {
            Some(_) => root.named("scene", "scenes", &root, &mut self.report).map(|(_, scene)| scene),
            None => root.get("scenes").and_then(|scenes| scenes.item(0)),
        };
        let Some(scene) = scene else { return Vec::new() };
        if scenes > 1 {
            let message = format!("is shown, the other scenes of the file ({}) are not", scenes - 1);
            scene.warn(&mut self.report, message);
        }
        let at = format!("{}.nodes", scene.path());
        scene.indices("nodes", &mut self.report).into_iter().map(|index| (index, at.clone())).collect()
    }

    /// Node to parent.
    fn local(&mut self, node: &At<'a>) -> Option<DAffine3> {
        let report = &mut self.report;
        if let Some(matrix) = node.get("matrix") {
            let m: [f64; 16] = node.numbers("matrix", report)?;
            let last = [m[3], m[7], m[11], m[15] - 1.0];
            if last.into_iter().any(|x| x.abs() > AFFINE) {
                matrix.error(report, "must be affine: 0 0 0 1 in the last row");
                return None;
            }
            let column = |i: usize| DVec3::new(m[i], m[i + 1], m[i + 2]);
            return Some(DAffine3::from_cols(column(0), column(4), column(8), column(12)));
        }
        let translation = node.numbers("translation", report).map_or(DVec3::ZERO, DVec3::from_array);
        let scale = node.numbers("scale", report).map_or(DVec3::ONE, DVec3::from_array);
        let rotation = node.numbers("rotation", report).map_or(DQuat::IDENTITY, DQuat::from_array);
        Some(DAffine3::from_scale_rotation_translation(scale, unit(rotation), translation))
    }

    /// Adds what a node shows.
    fn show(&mut self, node: &At<'a>, global: &DAffine3, globals: &[Option<DAffine3>]) {
        let root = self.root.clone();
        let stated = node.text("name", &mut self.report).unwrap_or_default();
        let named = |reader: &mut Self, at: &At<'a>, otherwise: &str| {
            let own = at.text("name", &mut reader.report).unwrap_or_default();
            let name = if stated.is_empty() { own } else { stated };
            if name.is_empty() { otherwise.to_owned() } else { name.to_owned() }
        };
        if let Some((index, mesh)) = node.named("mesh", "meshes", &root, &mut self.report) {
            let name = named(self, &mesh, &format!("mesh-{index}"));
            self.mesh(node, (index, &mesh), global, globals, &name);
        }
        if let Some((index, camera)) = node.named("camera", "cameras", &root, &mut self.report) {
            let name = named(self, &camera, &format!("camera-{index}"));
            self.camera(node, &camera, global, &name);
        }
        let punctual = "KHR_lights_punctual";
        if let Some(at) = node.extension(punctual) {
            let Some(lights) = root.extension(punctual) else {
                return at.error(&mut self.report, "the file has no lights");
            };
            if let Some((index, light)) = at.named("light", "lights", &lights, &mut self.report) {
                let name = named(self, &light, &format!("light-{index}"));
                self.light(node, &light, global, &name);
            }
        }
    }

    /// Adds the shapes of a node's mesh, once or many times.
    fn mesh(
        &mut self,
        node: &At<'a>,
        mesh: (usize, &At<'a>),
        global: &DAffine3,
        globals: &[Option<DAffine3>],
        name: &str,
    ) {
        let (pose, is_own) = self.pose(node, mesh.1, globals);
        let parts = self.mesh_parts(mesh, &pose, is_own);
        // A skin says where its mesh is, and not the node.
        let global = if pose.joints.is_empty() { *global } else { DAffine3::IDENTITY };
        let Some(instances) = node.extension("EXT_mesh_gpu_instancing") else {
            return self.shapes(node, &parts, &global, name);
        };
        for local in self.instances(&instances).unwrap_or_default() {
            if self.files.cancel().is_requested() || self.report.is_full() {
                return;
            }
            self.shapes(node, &parts, &(global * local), name);
        }
    }

    fn shapes(&mut self, node: &At<'a>, parts: &[Part], to_world: &DAffine3, name: &str) {
        for part in parts {
            if let Err(message) = self.files.budget.take(SHAPE) {
                return node.error(&mut self.report, message);
            }
            let (mesh, to_world) = if to_world.matrix3.determinant() == 0.0 {
                (Arc::new(flattened(&part.mesh, to_world)), DAffine3::IDENTITY)
            } else {
                (Arc::clone(&part.mesh), *to_world)
            };
            let name = self.unique(name);
            self.description.shapes.push(ShapeDescription {
                name,
                geometry: Geometry::Mesh(mesh),
                to_world,
                flip_normals: false,
                material: part.surface.material,
                radiance: part.surface.radiance,
            });
        }
    }

    /// The parts of a mesh; those of one that stands as it is for all nodes are made once.
    fn mesh_parts(&mut self, (index, mesh): (usize, &At<'a>), pose: &Pose, is_own: bool) -> Vec<Part> {
        let mut parts = Vec::new();
        for (i, primitive) in mesh.items("primitives", &mut self.report).iter().enumerate() {
            if self.files.cancel().is_requested() || self.report.is_full() {
                break;
            }
            let known = self.made.parts.get(&(index, i)).filter(|_| !is_own).cloned();
            let made = known.unwrap_or_else(|| self.parts_of(primitive, pose).into());
            if !is_own {
                self.made.parts.insert((index, i), Arc::clone(&made));
            }
            parts.extend(made.iter().cloned());
        }
        parts
    }

    /// How the mesh of a node stands, and whether in a way of its own.
    fn pose(&mut self, node: &At<'a>, mesh: &At<'a>, globals: &[Option<DAffine3>]) -> (Pose, bool) {
        let own = node.any_numbers("weights", &mut self.report);
        let is_own = own.is_some() || node.get("skin").is_some();
        let weights = own.or_else(|| mesh.any_numbers("weights", &mut self.report)).unwrap_or_default();
        let joints = self.joints(node, globals).unwrap_or_default();
        (Pose { weights, joints }, is_own)
    }

    /// What each joint of a node's skin does to vertices.
    fn joints(&mut self, node: &At<'a>, globals: &[Option<DAffine3>]) -> Option<Vec<DAffine3>> {
        let (root, buffers) = (self.root.clone(), Rc::clone(&self.buffers));
        let (_, skin) = node.named("skin", "skins", &root, &mut self.report)?;
        self.notice("skins are shown as the nodes of the file stand, without their animations", &skin);
        let source = Source { root: &root, buffers: &buffers };
        let numbers = skin.indices("joints", &mut self.report);
        let inverse = match skin.get("inverseBindMatrices") {
            Some(_) => Some(source.accessor(&skin, "inverseBindMatrices", &mut self.report)?),
            None => None,
        };
        if let Some(inverse) = inverse.as_ref().filter(|i| i.width != 16 || i.count < numbers.len()) {
            let message = format!("{} inverse bind matrices are too few, or are none", inverse.count);
            skin.error(&mut self.report, message);
            return None;
        }
        let joint = |(i, number): (usize, &usize)| {
            let global = globals.get(*number).copied().flatten().unwrap_or(DAffine3::IDENTITY);
            let Some(inverse) = &inverse else { return global };
            let m: [f64; 16] = inverse.read(i);
            let column = |i: usize| DVec3::new(m[i], m[i + 1], m[i + 2]);
            global * DAffine3::from_cols(column(0), column(4), column(8), column(12))
        };
        Some(numbers.iter().enumerate().map(joint).collect())
    }

    /// The transforms of instances.
    fn instances(&mut self, at: &At<'a>) -> Option<Vec<DAffine3>> {
        let (root, buffers) = (self.root.clone(), Rc::clone(&self.buffers));
        let source = Source { root: &root, buffers: &buffers };
        let Some(attributes) = at.get("attributes") else {
            at.error(&mut self.report, "needs \"attributes\"");
            return None;
        };
        let report = &mut self.report;
        let translations = source.of_vertices(&attributes, "TRANSLATION", (3, 0), report)?;
        let rotations = source.of_vertices(&attributes, "ROTATION", (4, 0), report)?;
        let scales = source.of_vertices(&attributes, "SCALE", (3, 0), report)?;
        let all = [&translations, &rotations, &scales];
        let counts: Vec<usize> = all.into_iter().flatten().map(|accessor| accessor.count).collect();
        let Some(&count) = counts.first() else {
            attributes.error(report, "needs TRANSLATION, ROTATION or SCALE");
            return None;
        };
        if counts.iter().any(|other| *other != count) {
            attributes.error(report, "must have as many of each");
            return None;
        }
        if let Err(message) = self.files.budget.check(count as u64 * SHAPE) {
            attributes.error(&mut self.report, message);
            return None;
        }
        let vector = |of: &Option<super::accessor::Accessor<'_>>, i: usize, otherwise: DVec3| {
            of.as_ref().map_or(otherwise, |of| DVec3::from_array(of.read(i)))
        };
        let transform = |i: usize| {
            let turn = rotations.as_ref().map_or(DQuat::IDENTITY, |of| DQuat::from_array(of.read(i)));
            let (scale, shift) = (vector(&scales, i, DVec3::ONE), vector(&translations, i, DVec3::ZERO));
            DAffine3::from_scale_rotation_translation(scale, unit(turn), shift)
        };
        let transforms: Vec<DAffine3> = (0..count).map(transform).collect();
        if let Some(bad) = transforms.iter().position(|t| !t.is_finite()) {
            attributes.error(&mut self.report, format!("the transform of instance {bad} is no number"));
            return None;
        }
        Some(transforms)
    }
}

/// A rotation of unit length; none where it has no length.
fn unit(rotation: DQuat) -> DQuat {
    let length = rotation.length();
    if length.is_finite() && length > 0.0 { rotation / length } else { DQuat::IDENTITY }
}

/// A mesh as it stands in the world, where that takes away a dimension: without normals, which have no direction then.
fn flattened(mesh: &Mesh, to_world: &DAffine3) -> Mesh {
    let positions = mesh.positions.iter().map(|p| to_world.transform_point3(*p)).collect();
    Mesh { positions, normals: Vec::new(), ..mesh.clone() }
}
