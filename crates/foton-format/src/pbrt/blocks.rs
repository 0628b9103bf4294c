//! What ends close, objects and their instances, and files inside of files.

use std::path::Path;
use std::rc::Rc;

use foton_input::{quoted, shown_path};

use super::directives::begins_as_scene;
use super::packed;
use super::reader::{Object, Reader};
use super::state::{Open, Opened};
use super::tokens::{Fault, Tokens};
use crate::diagnostic::Place;
use crate::encoding::decoded;

/// Files inside of files, and how many there may be of them.
const DEEPEST: usize = 15;
const MAX_FILES: usize = 10_000;
/// Bytes that a byte of text takes, with its copy for messages and the numbers of one statement. What these become is counted there.
pub(crate) const BYTES_PER_TEXT_BYTE: u64 = 6;

impl Reader<'_> {
    /// Ends what was opened last.
    pub(crate) fn close(&mut self, word: &str, place: Place) {
        let begins = |what: &Open| match what {
            Open::Attribute(_) => "AttributeBegin",
            Open::Transform(..) => "TransformBegin",
            Open::Object(_) => "ObjectBegin",
        };
        let wanted = word.replace("End", "Begin");
        let Some(Opened { what, place: begin }) = self.open.pop() else {
            self.report.error(place, format!("{word} closes nothing"));
            return;
        };
        let found = begins(&what);
        if found != wanted {
            let line = self.report.line(begin, place);
            self.report.error(place, format!("{word} closes the {found} of {line}"));
        }
        self.end_scope();
        match what {
            Open::Transform(transforms, active) => {
                self.state.transforms = transforms;
                self.state.active = active;
            }
            Open::Attribute(state) => self.state = *state,
            Open::Object(state) => {
                self.state = *state;
                if let Some(object) = self.object.take() {
                    self.objects.insert(object.name.clone(), Rc::new(object));
                }
            }
        }
    }

    /// Says what was never closed.
    pub(crate) fn check_closed(&mut self) {
        for Opened { what, place } in std::mem::take(&mut self.open) {
            match what {
                Open::Attribute(_) => self.report.warning(place, "this AttributeBegin has no AttributeEnd"),
                Open::Transform(..) => self.report.warning(place, "this TransformBegin has no TransformEnd"),
                Open::Object(_) => self.report.error(place, "this ObjectBegin has no ObjectEnd"),
            }
        }
    }

    pub(crate) fn object_begin(&mut self, place: Place, tokens: &mut Tokens<'_>) -> Result<(), Fault> {
        let name = tokens.text("a name of an object")?;
        if self.object.is_some() {
            self.report.error(place, "an object cannot stand inside another one");
            let state = Box::new(self.state.clone());
            self.open(Open::Attribute(state), place);
            return Ok(());
        }
        if self.objects.contains_key(&name.value) {
            self.report
                .warning(name.place, format!("the object {} is defined once more", quoted(&name.value)));
        }
        let state = Box::new(self.state.clone());
        self.open(Open::Object(state), place);
        self.object = Some(Object { name: name.value, shapes: Vec::new(), instances: 0 });
        Ok(())
    }

    pub(crate) fn object_instance(&mut self, tokens: &mut Tokens<'_>) -> Result<(), Fault> {
        let name = tokens.text("a name of an object")?;
        if self.object.is_some() {
            return Err((name.place, "an object cannot have instances of others inside".to_owned()));
        }
        let Some(object) = self.objects.get_mut(&name.value) else {
            let names = self.objects.keys().map(String::as_str);
            let hint = self.report.did_you_mean(&name.value, names);
            return Err((name.place, format!("there is no object {}{hint}", quoted(&name.value))));
        };
        if let Some(object) = Rc::get_mut(object) {
            object.instances += 1;
        }
        let object = Rc::clone(object);
        for (i, shape) in object.shapes.iter().enumerate() {
            if self.files.cancel().is_requested() || self.report.is_full() {
                return Ok(());
            }
            let name = format!("{}-{}/{}", object.name, object.instances, i + 1);
            if !self.place_shape(shape, Some(self.state.transforms), name) {
                return Ok(());
            }
        }
        Ok(())
    }

    /// `Include` reads a file as if it stood here; what `Import` reads changes nothing that comes behind.
    pub(crate) fn include(&mut self, word: &str, tokens: &mut Tokens<'_>) -> Result<(), Fault> {
        let name = tokens.text("a name of a file")?;
        let place = name.place;
        if self.including.len() >= DEEPEST {
            return Err((place, format!("more than {DEEPEST} files include one another")));
        }
        self.files_included += 1;
        if self.files_included > MAX_FILES {
            return Err((place, format!("more than {MAX_FILES} files are included")));
        }
        let Some((path, bytes)) = self.files.read(&name.value, place, &mut self.report) else {
            return Ok(());
        };
        if self.including.contains(&path) {
            return Err((place, format!("{} includes itself", shown_path(&path))));
        }
        let text = self.unpacked(bytes, &path, place)?;
        if !begins_as_scene(&text) {
            return Err((
                place,
                format!("{} is no scene of pbrt: it begins with none of its directives", shown_path(&path)),
            ));
        }
        let folder = path.parent().unwrap_or(Path::new("")).to_owned();
        let lines_before = self.report.include(&path.to_string_lossy(), &folder, &text, place);
        let before = (word == "Import").then(|| Box::new(self.state.clone()));
        self.including.push(path);
        self.text(&text, lines_before);
        self.including.pop();
        if let Some(before) = before {
            self.state = *before;
        }
        Ok(())
    }

    /// The text of a file, which may be packed.
    fn unpacked(&mut self, bytes: Vec<u8>, path: &Path, place: Place) -> Result<String, Fault> {
        let cannot = |message: String| (place, format!("cannot read {}: {message}", shown_path(path)));
        let cancel = self.files.cancel();
        let bytes = packed::unpacked(bytes, &mut self.files.budget, cancel).map_err(cannot)?;
        self.files.budget.take(bytes.len() as u64 * BYTES_PER_TEXT_BYTE).map_err(cannot)?;
        decoded(bytes).map_err(|line| cannot(format!("line {line} is not UTF-8")))
    }
}
