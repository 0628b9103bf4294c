//! Options of `foton render` that contradict each other: refused before anything is read.

use std::path::Path;

use foton_session::snapshot::Format;

use super::{ErrorWish, RenderArgs};

impl RenderArgs {
    /// What cannot be done as it was asked for, and what would help.
    pub(crate) fn contradiction(&self) -> Option<String> {
        self.layers_in_vain().or_else(|| self.file_in_two_roles())
    }

    fn layers_in_vain(&self) -> Option<String> {
        let first = self.layers.first()?;
        if self.output.1 == Format::Png {
            let (path, exr) = (&self.output.0, self.output.0.with_extension("exr"));
            return Some(format!(
                "--layers {}: {} is a PNG, and only an EXR holds layers; write to {} instead, or leave --layers out",
                first.name(),
                path.display(),
                exr.display()
            ));
        }
        let twice = self.layers.iter().enumerate().find(|(i, layer)| self.layers[..*i].contains(layer));
        if let Some((_, layer)) = twice {
            return Some(format!("--layers names {} twice; an EXR holds each layer once", layer.name()));
        }
        let needs_error = self.layers.iter().find(|layer| layer.needs_error());
        needs_error.filter(|_| self.error == Some(ErrorWish::Off)).map(|layer| {
            format!("--layers {}: --error off leaves out what that shows; leave out either", layer.name())
        })
    }

    /// A file that would be read or written as two things.
    fn file_in_two_roles(&self) -> Option<String> {
        let roles = [("the image", &self.output.0), ("the scene", &self.scene)];
        let state = [("--checkpoint", &self.checkpoint), ("--resume", &self.resume)];
        state.into_iter().find_map(|(option, file)| {
            let file = file.as_ref()?;
            let (role, _) = roles.into_iter().find(|(_, other)| is_same(other, file))?;
            Some(format!("{option} {} is {role}, too; give the state a file of its own", file.display()))
        })
    }
}

/// Whether two paths name one file, as far as names tell; links are followed where there is a file.
fn is_same(a: &Path, b: &Path) -> bool {
    let whole = |path: &Path| path.canonicalize().or_else(|_| std::path::absolute(path)).ok();
    whole(a).is_some_and(|a| whole(b) == Some(a))
}
