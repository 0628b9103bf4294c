//! The meshes of the scenes in `assets/`, made from a few numbers: what lies there is what [`write_all`] writes.
//!
//! Not a modeller: bodies of revolution, one cut gem, a curved backdrop, a basin of wavy water, a hall with what stands in it.

mod gem;
mod lathe;
mod mesh;
mod museum;
mod pool;
mod still_life;

use std::path::Path;
use std::{fs, io};

use mesh::Mesh;

/// Writes every generated file below `dir`, the folder `assets/`, and makes the folders that are missing.
///
/// # Errors
/// What the file system says.
pub(crate) fn write_all(dir: &Path) -> io::Result<()> {
    for (name, mesh) in solids().into_iter().chain(sheets()) {
        let path = dir.join(name);
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder)?;
        }
        fs::write(path, mesh.to_obj())?;
    }
    Ok(())
}

/// The closed meshes, each with its file's path. All but the gem stand on y = 0; the outside is air.
fn solids() -> Vec<(&'static str, Mesh)> {
    vec![
        ("glass-and-ring/meshes/goblet.obj", still_life::goblet().revolve(96)),
        ("glass-and-ring/meshes/ring.obj", still_life::ring().revolve(160)),
        ("glass-and-ring/meshes/gem.obj", gem::gem()),
        ("ring/meshes/band.obj", still_life::band().revolve(160)),
        ("museum/meshes/column.obj", museum::column().revolve(12)),
        ("museum/meshes/vase.obj", museum::vase().revolve(24)),
    ]
}

/// The open ones.
fn sheets() -> Vec<(&'static str, Mesh)> {
    let [light, middle, dark] = pool::tiles();
    let [pale, grey] = museum::tiles();
    vec![
        ("glass-and-ring/meshes/backdrop.obj", still_life::backdrop()),
        ("pool/meshes/water.obj", pool::water()),
        ("pool/meshes/joints.obj", pool::joints()),
        ("pool/meshes/tiles-light.obj", light),
        ("pool/meshes/tiles-middle.obj", middle),
        ("pool/meshes/tiles-dark.obj", dark),
        ("museum/meshes/tiles-light.obj", pale),
        ("museum/meshes/tiles-dark.obj", grey),
        ("museum/meshes/ceiling.obj", museum::ceiling()),
        ("museum/meshes/sponge.obj", museum::sponge()),
        ("museum/meshes/frame.obj", museum::frame()),
    ]
}

#[cfg(test)]
mod tests;
