//! The dialog driven as a person drives it, by its labels and by keys, in a folder made for the test.

use std::cell::RefCell;
use std::rc::Rc;

use egui::accesskit::Role;
use egui::{Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use super::*;

/// A folder that is removed with its value: scenes/{inner/, a.XML, b.obj, notes.txt, .hidden.xml}.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("foton-files-{}-{name}", std::process::id()));
        let scenes = path.join("scenes");
        std::fs::create_dir_all(scenes.join("inner")).expect("a folder of our own");
        for file in ["a.XML", "b.obj", "notes.txt", ".hidden.xml", "inner/deep.ply"] {
            std::fs::write(scenes.join(file), "").expect("a file of our own");
        }
        Self(path)
    }

    fn scenes(&self) -> PathBuf {
        self.0.join("scenes")
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// Shows the dialog until it is done; what it came to is in the cell.
fn harness(mut dialog: FileDialog) -> (Harness<'static>, Rc<RefCell<Outcome>>) {
    let outcome = Rc::new(RefCell::new(Outcome::Browsing));
    let kept = Rc::clone(&outcome);
    let mut harness = Harness::builder().with_size(egui::vec2(640.0, 480.0)).build_ui(move |ui| {
        if *kept.borrow() == Outcome::Browsing {
            *kept.borrow_mut() = dialog.show(ui.ctx());
        }
    });
    harness.run();
    (harness, outcome)
}

fn press(harness: &mut Harness<'_>, modifiers: Modifiers, key: Key) {
    harness.key_press_modifiers(modifiers, key);
    harness.run();
}

fn type_name(harness: &mut Harness<'_>, text: &str) {
    harness.get_by_role_and_label(Role::TextInput, "Name").type_text(text);
    harness.run();
}

#[test]
fn scenes_and_folders_are_listed_and_a_click_and_open_choose() {
    let folder = Folder::new("click");
    let (mut harness, outcome) = harness(FileDialog::open(&folder.scenes(), SCENES));
    assert!(harness.query_by_label("Folder inner").is_some());
    assert!(harness.query_by_label("notes.txt").is_none() && harness.query_by_label(".hidden.xml").is_none());
    harness.get_by_label("b.obj").click();
    harness.run();
    harness.get_by_role_and_label(Role::Button, "Open").click();
    harness.run();
    assert_eq!(*outcome.borrow(), Outcome::Chosen(folder.scenes().join("b.obj")));
}

#[test]
fn arrows_and_enter_choose_without_a_mouse() {
    let folder = Folder::new("keys");
    let (mut harness, outcome) = harness(FileDialog::open(&folder.scenes(), SCENES));
    // Down selects the folder, Enter goes into it; down and Enter choose its only file.
    for key in [Key::ArrowDown, Key::Enter, Key::ArrowDown] {
        press(&mut harness, Modifiers::NONE, key);
    }
    assert!(harness.query_by_label("deep.ply").is_some());
    press(&mut harness, Modifiers::ALT, Key::ArrowUp);
    assert!(harness.query_by_label("b.obj").is_some());
    for key in [Key::ArrowUp, Key::ArrowUp, Key::Enter] {
        press(&mut harness, Modifiers::NONE, key);
    }
    assert_eq!(*outcome.borrow(), Outcome::Chosen(folder.scenes().join("a.XML")));
}

#[test]
fn a_typed_path_is_opened_and_one_that_is_not_there_is_said() {
    let folder = Folder::new("typed");
    let (mut harness, outcome) = harness(FileDialog::open(&folder.0, SCENES));
    type_name(&mut harness, "scenes/none.xml");
    press(&mut harness, Modifiers::NONE, Key::Enter);
    assert!(harness.query_by_label_contains("There is no file").is_some());
    press(&mut harness, Modifiers::COMMAND, Key::A);
    type_name(&mut harness, "scenes/inner/deep.ply");
    press(&mut harness, Modifiers::NONE, Key::Enter);
    assert_eq!(*outcome.borrow(), Outcome::Chosen(folder.0.join("scenes/inner/deep.ply")));
}

#[test]
fn escape_and_cancel_close() {
    let folder = Folder::new("cancel");
    let (mut by_key, outcome) = harness(FileDialog::open(&folder.0, SCENES));
    press(&mut by_key, Modifiers::NONE, Key::Escape);
    assert_eq!(*outcome.borrow(), Outcome::Cancelled);
    let (mut by_button, outcome) = harness(FileDialog::open(&folder.0, SCENES));
    by_button.get_by_label("Cancel").click();
    by_button.run();
    assert_eq!(*outcome.borrow(), Outcome::Cancelled);
}

#[test]
fn saving_adds_the_extension_and_asks_before_it_replaces() {
    let folder = Folder::new("save");
    let mut new = FileDialog::save(&folder.scenes().join("mine"), SCENES);
    assert_eq!(new.submit(), Some(folder.scenes().join("mine.xml")));
    let (mut harness, outcome) = harness(FileDialog::save(&folder.scenes().join("b.obj"), SCENES));
    harness.get_by_label("Save").click();
    harness.run();
    assert!(harness.query_by_label_contains("Replace it?").is_some());
    assert_eq!(*outcome.borrow(), Outcome::Browsing);
    harness.get_by_label("Replace").click();
    harness.run();
    assert_eq!(*outcome.borrow(), Outcome::Chosen(folder.scenes().join("b.obj")));
}

#[test]
fn breadcrumbs_lead_up_and_a_folder_that_cannot_be_read_is_said() {
    let folder = Folder::new("crumbs");
    let (mut harness, _) = harness(FileDialog::open(&folder.scenes().join("inner"), SCENES));
    harness.get_by_label("scenes").click();
    harness.run();
    assert!(harness.query_by_label("b.obj").is_some());
    let gone = FileDialog::open(&folder.0.join("gone"), SCENES);
    assert!(
        gone.entries.is_empty() && gone.trouble.is_some_and(|trouble| trouble.contains("cannot be read"))
    );
}

#[test]
fn a_tilde_is_the_home_folder() {
    let home = std::env::home_dir().expect("there is one where tests run");
    assert_eq!(listing::resolve(Path::new("/x"), "~/a.xml"), home.join("a.xml"));
    assert_eq!(listing::resolve(Path::new("/x"), "~a.xml"), Path::new("/x/~a.xml"));
    assert_eq!(listing::resolve(Path::new("/x"), "/y/a.xml"), Path::new("/y/a.xml"));
}
