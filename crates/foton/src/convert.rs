//! `foton convert`: any readable scene to Mitsuba 3 XML with PLY meshes.

use foton_film::check_writable;
use foton_integrator::Cancel;
use foton_scene::Scene;
use foton_scene::description::{Coating, Motion, SceneDescription};

use crate::args::Convert;
use crate::console::{Console, Failure};
use crate::opening::{open, refuse_to_build, refuse_two_roles};

/// What to say of materials that Mitsuba 3 does not have, once for each plugin.
fn not_of_mitsuba_3(description: &SceneDescription) -> Vec<String> {
    let mut said = Vec::new();
    for material in &description.materials {
        for plugin in material.coatings.iter().flatten().map(Coating::plugin) {
            if !said.iter().any(|(p, _)| *p == plugin) {
                let name = &material.name;
                let message = format!(
                    "the material \"{name}\" is written with a \"{plugin}\" of Mitsuba 0.6: Mitsuba 3 does not have such a plugin and will refuse the file"
                );
                said.push((plugin, message));
            }
        }
        let sides = [Some(material.front), material.back];
        for bsdf in sides.into_iter().flatten().filter(|b| !b.is_of_mitsuba_3()) {
            let plugin = bsdf.plugin();
            let what = if bsdf.info().is_of_mitsuba_3 { "microfacets of Phong" } else { "such a plugin" };
            let (name, said_before) = (&material.name, said.iter().any(|(p, _)| *p == plugin));
            if !said_before {
                let message = format!(
                    "the material \"{name}\" is written as \"{plugin}\" of Mitsuba 0.6: Mitsuba 3 does not have {what} and will refuse the file"
                );
                said.push((plugin, message));
            }
        }
    }
    said.into_iter().map(|(_, message)| message).collect()
}

/// Runs `foton convert`.
pub(crate) fn run(args: &Convert, console: &Console) -> Result<(), Failure> {
    check_writable(&args.output)?;
    // A signal ends the program at once: there is nothing to save.
    let opened = open(&args.scene, &args.read, None, console, &Cancel::default())?;
    refuse_two_roles(args.roles(), &opened)?;
    for finding in &opened.warnings {
        console.diagnostic(finding);
    }
    if !opened.description.motion.is_still() {
        console.warning("what moves is written as it is at its first keyframe: Mitsuba 3 has no motion");
    }
    for message in not_of_mitsuba_3(&opened.description) {
        console.warning(&message);
    }
    // What cannot be rendered is not worth writing; building also checks every index.
    refuse_to_build(&opened.description, None)?;
    let scene = args.scene.display().to_string();
    Scene::build(&opened.description).map_err(|cause| Failure::of_build(&opened, &scene, &cause))?;
    // Mitsuba 3 would refuse the file.
    let still = SceneDescription { motion: Motion::default(), ..opened.description };
    foton_format::write_scene(&still, &args.output, &opened.files)?;
    console.line(&format!("wrote {}", args.output.display()));
    Ok(())
}
