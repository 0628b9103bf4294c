//! `foton convert`: any readable scene to Mitsuba 3 XML with PLY meshes.

use foton_film::check_writable;
use foton_integrator::Cancel;
use foton_scene::Scene;
use foton_scene::description::{Motion, SceneDescription};

use crate::args::Convert;
use crate::console::{Console, Failure};
use crate::opening::{open, refuse_to_build, refuse_two_roles};

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
    // What cannot be rendered is not worth writing; building also checks every index.
    refuse_to_build(&opened.description, None)?;
    let scene = args.scene.display().to_string();
    Scene::build(&opened.description).map_err(|cause| Failure::of_build(&opened, &scene, &cause))?;
    // Mitsuba 3 would refuse the file.
    let still = SceneDescription { motion: Motion::default(), ..opened.description };
    for message in foton_format::beyond_mitsuba_3(&still) {
        console.warning(&message);
    }
    foton_format::write_scene(&still, &args.output, &opened.files)?;
    console.line(&format!("wrote {}", args.output.display()));
    Ok(())
}
