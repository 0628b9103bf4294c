//! `foton [SCENE]` where there is no window: a picture within a minute, readable after ten seconds.

use std::path::Path;
use std::time::Duration;

use foton_film::check_writable;
use foton_session::snapshot::{self, Format, Look};
use foton_session::{Session, Shown, StopRule};

use crate::args::ReadOptions;
use crate::console::{Console, Failure};
use crate::embedded::ALL;
use crate::interrupts::{begin_step, interrupt_on_signals, say_limit};
use crate::opening::{Bounds, build, how_to_read, refuse_beyond_memory};
use crate::settings::SettingsBuilder;
use crate::writing::{Content, Output, finish};

/// When to stop, writing included.
const TIME: Duration = Duration::from_secs(55);

/// When the first picture is written.
const FIRST_PICTURE: Duration = Duration::from_secs(8);

/// Renders `scene`, or the embedded one, to the next free `foton-001.png` and `.exr` in the working folder.
pub(crate) fn render(scene: Option<&Path>, read: &ReadOptions, console: &mut Console) -> Result<(), Failure> {
    let interrupt = interrupt_on_signals(console);
    let cancel = interrupt.cancel();
    console.begin();
    let options = how_to_read(read, None, cancel);
    let (opened, name) = match scene {
        Some(path) => {
            (foton_format::open(path, &options), path.file_name().unwrap_or_default().to_string_lossy())
        }
        None => (ALL[0].open(&options), ALL[0].name.into()),
    };
    let opened = opened.map_err(Failure::of_open)?;
    let suggested = opened.suggested;
    let (scene, identity) = build(opened, &name, 0, Bounds::default(), console, cancel)?;
    let settings = SettingsBuilder::of_scene(&suggested).error(true).build();
    console.of_settings(&scene, &settings);
    refuse_beyond_memory(&scene, &settings, None, None)?;
    let stem = snapshot::next_free(Path::new(""));
    let output = |extension, format| Output { path: stem.with_extension(extension), format, is_new: true };
    let (mut png, exr) = (output("png", Format::Png), output("exr", Format::Exr));
    for path in [&png.path, &exr.path] {
        check_writable(path)?;
    }
    let content = Content { layers: &[], shown: Shown::All, look: Look::default(), identity: &identity };
    begin_step("collecting hit points");
    console.stage("collecting hit points");
    let mut session = Session::start(scene, settings, None, cancel)?;
    interrupt.begin_passes();
    console.line(&format!("rendering {name} for a minute to {}; Ctrl-C stops earlier", png.path.display()));
    let rule = StopRule::time(TIME);
    let mut first_picture = false;
    let cause = session.run(&rule, &interrupt, &mut |progress| {
        console.pass(progress, &rule);
        if !first_picture && progress.elapsed >= FIRST_PICTURE {
            first_picture = true;
            match png.write(&content, progress.render) {
                Ok(()) => png.is_new = false,
                Err(error) => console.warning(&format!("the first picture is missing: {error}")),
            }
        }
    });
    say_limit(cause, console);
    finish(&session, &[png, exr], &content, Vec::new(), console)
}
