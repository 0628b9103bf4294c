//! The files beside a scene file: their names, and whose they are. Files that were not written for this very scene file are never
//! replaced: meshes and images carry a mark that says for which they were.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use foton_film::{Image, Metadata, WriteError, atomic_write, head_of, is_same_file, write_exr};
use foton_scene::description::{Bitmap, Mesh};

use super::names::file_name;
use super::{Writer, mesh};

/// Folders beside the scene file.
const MESHES: &str = "meshes";
const TEXTURES: &str = "textures";

/// The metadata that an image has its mark under.
const KEY: &str = "foton:part";
/// A mark stands within so many bytes of a file's beginning.
const HEAD: usize = 4096;

impl Writer<'_> {
    /// A file beside the scene for something of a name: as it stands in the scene, and its path.
    fn file(&mut self, folder: &str, name: &str, extension: &str) -> Result<(String, PathBuf), WriteError> {
        let base = format!("{}-{}", self.stem, file_name(name));
        let mut number = 1;
        let mut file = format!("{folder}/{base}.{extension}");
        while !self.files.insert(file.to_lowercase()) || !self.may_write(&self.folder.join(&file)) {
            number += 1;
            file = format!("{folder}/{base}-{number}.{extension}");
        }
        let inside = self.folder.join(folder);
        fs::create_dir_all(&inside).map_err(|cause| WriteError::Io { path: inside, cause })?;
        let path = self.folder.join(&file);
        Ok((file, path))
    }

    /// Whether there is nothing at a path, or a file that was written for the same scene file and that nothing reads.
    fn may_write(&self, path: &Path) -> bool {
        // A link without a target is something, too.
        if path.symlink_metadata().is_err() {
            return true;
        }
        let is_ours = || {
            let mark = self.mark.as_bytes();
            head_of(path, HEAD).is_ok_and(|head| head.windows(mark.len()).any(|part| part == mark))
        };
        !self.kept.iter().any(|kept| is_same_file(kept, path)) && is_ours()
    }

    pub(super) fn bitmap(&mut self, bitmap: &Arc<Bitmap>, name: &str) -> Result<String, WriteError> {
        let key = Arc::as_ptr(bitmap);
        if let Some(file) = self.bitmaps.get(&key) {
            return Ok(file.clone());
        }
        let (file, path) = self.file(TEXTURES, name, "exr")?;
        let Bitmap { width, height, pixels, .. } = &**bitmap;
        let image = Image { width: *width, height: *height, pixels: pixels.clone() };
        let metadata: Metadata = [(KEY, &self.mark)].into_iter().collect();
        write_exr(&path, &image, &[], &metadata)?;
        self.bitmaps.insert(key, file.clone());
        Ok(file)
    }

    pub(super) fn mesh(&mut self, mesh: &Arc<Mesh>, name: &str) -> Result<String, WriteError> {
        let key = Arc::as_ptr(mesh);
        if let Some(file) = self.meshes.get(&key) {
            return Ok(file.clone());
        }
        let (file, path) = self.file(MESHES, name, "ply")?;
        atomic_write(&path, |out| mesh::write_ply(mesh, &self.mark, out))?;
        self.meshes.insert(key, file.clone());
        Ok(file)
    }
}
