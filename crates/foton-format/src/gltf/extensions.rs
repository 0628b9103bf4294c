//! Extensions: those that are read, and what is said of the others.

use foton_input::quoted;

use super::buffers::UNPACK;
use super::json::At;
use crate::diagnostic::Report;

/// Extensions of which something is read; what is left out of them is said where they stand.
const READ: &[&str] = &[
    "EXT_mesh_gpu_instancing",
    "EXT_texture_webp",
    "KHR_lights_punctual",
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_diffuse_transmission",
    "KHR_materials_dispersion",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_iridescence",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_node_visibility",
    "KHR_texture_transform",
];

/// Extensions that stand beside what is read, and change nothing of it.
const BESIDE: &[&str] = &[
    "EXT_meshopt_compression",
    "EXT_texture_avif",
    "KHR_draco_mesh_compression",
    "KHR_meshopt_compression",
    "KHR_texture_basisu",
    "KHR_xmp_json_ld",
];

/// Extensions that pack meshes, and what they are called.
const PACKED: [(&str, &str); 3] = [
    ("KHR_draco_mesh_compression", "Draco"),
    ("EXT_meshopt_compression", "meshopt"),
    ("KHR_meshopt_compression", "meshopt"),
];

/// What pictures in other formats are called, where a file has no others.
const PICTURES: [(&str, &str); 2] = [("KHR_texture_basisu", "KTX2"), ("EXT_texture_avif", "AVIF")];

/// Says which extensions are not read. Whether the file can be read without them.
pub(super) fn check(root: &At<'_>, report: &mut Report) -> bool {
    let mut is_readable = true;
    let mut required = Vec::new();
    for at in root.items("extensionsRequired", report) {
        let Some(name) = at.as_text() else { continue };
        required.push(name);
        if let Some((_, packer)) = PACKED.iter().find(|(packed, _)| *packed == name) {
            at.error(report, format!("meshes packed by {packer} ({name}) are not read"));
            report.help(UNPACK);
            is_readable = false;
        } else if let Some((_, format)) = PICTURES.iter().find(|(picture, _)| *picture == name) {
            at.error(report, format!("images of the format {format} ({name}) are not read"));
            report.help("convert the images of the file to PNG or JPEG");
        } else if !READ.contains(&name) && !BESIDE.contains(&name) {
            let message = format!("the file cannot be shown without {}, which is not read", quoted(name));
            let hint = report.did_you_mean(name, READ.iter().copied());
            at.error(report, message + &hint);
        }
    }
    for at in root.items("extensionsUsed", report) {
        if let Some(name) = at.as_text()
            && !READ.contains(&name)
            && !BESIDE.contains(&name)
            && !required.contains(&name)
        {
            at.warn(report, format!("{} is not read: what it says is left out", quoted(name)));
        }
    }
    is_readable
}
