//! `foton convert`: any readable scene to Mitsuba 3 XML with PLY meshes.

use foton_format::Options;
use foton_scene::Scene;

use crate::args::Convert;
use crate::talk::{Failure, Talk};

/// Runs `foton convert`.
pub(crate) fn run(args: &Convert, talk: &Talk) -> Result<(), Failure> {
    let options = Options { defines: args.defines.clone(), ..Options::default() };
    let opened = foton_format::open(&args.scene, &options).map_err(Failure::Open)?;
    for finding in &opened.warnings {
        talk.finding(finding);
    }
    // What cannot be rendered is not worth writing; building also checks every index.
    let scene = args.scene.display().to_string();
    Scene::build(&opened.description).map_err(|cause| Failure::Build { scene, cause })?;
    foton_format::write_scene(&opened.description, &args.output)?;
    talk.line(&format!("wrote {}", args.output.display()));
    Ok(())
}
