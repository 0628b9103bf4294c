//! Films: numbered PNGs in a folder of their own, and an MP4 of them where `ffmpeg` is installed.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Command as Program, Stdio};

use foton_film::{Image, Metadata, write_new, write_png};
use foton_input::shown_path;

use crate::engine::command::Event;
use crate::snapshot::{Look, next_run};

/// Frames a second of an MP4.
const RATE: u32 = 8;

/// A folder of frames.
pub(crate) struct Film {
    folder: PathBuf,
    frames: u32,
    look: Look,
    /// What makes MP4s.
    ffmpeg: PathBuf,
}

impl Film {
    /// Makes a folder for a film in another, such as `ring-film-001`.
    pub(crate) fn new(home: &Path, name: &str, look: Look, ffmpeg: &Path) -> Result<Self, String> {
        let home = std::path::absolute(home).unwrap_or_else(|_| home.to_owned());
        let failed = |cause| format!("cannot make a folder for the film in {}: {cause}", shown_path(&home));
        fs::create_dir_all(&home).map_err(failed)?;
        loop {
            let folder = home.join(next_run(&home, name));
            match fs::create_dir(&folder) {
                Ok(()) => return Ok(Self { folder, frames: 0, look, ffmpeg: ffmpeg.to_owned() }),
                Err(cause) if cause.kind() == io::ErrorKind::AlreadyExists => {}
                Err(cause) => return Err(failed(cause)),
            }
        }
    }

    /// Adds a frame.
    pub(crate) fn add(&mut self, image: &Image, mut metadata: Metadata) -> Result<(), String> {
        let path = self.folder.join(format!("frame-{:04}.png", self.frames + 1));
        let Look { tone_map, exposure_stops } = self.look;
        metadata.set("foton:look", format!("exposure={exposure_stops} tone_map={}", tone_map.key()));
        let write = |path: &Path| write_png(path, image, tone_map, exposure_stops, &metadata);
        write_new(&path, write).map_err(|error| error.to_string())?;
        self.frames += 1;
        Ok(())
    }

    /// Makes an MP4 of the frames, if there is a program for it. What there is to say of the film.
    pub(crate) fn finish(&self) -> Event {
        let frames = format!("{} frames are in {}", self.frames, shown_path(&self.folder));
        if self.frames == 0 {
            return Event::Failed(format!(
                "the film has no frame; its folder is {}",
                shown_path(&self.folder)
            ));
        }
        let mut program = Program::new(&self.ffmpeg);
        program.args(["-nostdin", "-loglevel", "error", "-n", "-framerate", &RATE.to_string()]);
        program.args(["-i", "frame-%04d.png", "-pix_fmt", "yuv420p"]);
        // The format wants even sides.
        program.args(["-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "film.mp4"]);
        program.current_dir(&self.folder).stdin(Stdio::null()).stdout(Stdio::null());
        match program.output() {
            Ok(output) if output.status.success() => Event::Saved(vec![self.folder.join("film.mp4")]),
            Ok(output) => {
                let said =
                    String::from_utf8_lossy(&output.stderr).lines().next().unwrap_or_default().to_owned();
                Event::Failed(format!("ffmpeg made no film: {}. {frames}", foton_input::printable(&said)))
            }
            Err(_) => {
                Event::Notice(format!("{frames}. Where ffmpeg is installed, they become a film.mp4 too"))
            }
        }
    }
}
