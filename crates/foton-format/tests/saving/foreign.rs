//! A scene that was opened from a file of another format is saved as a Mitsuba scene, and edited further there.

use std::fs;
use std::path::Path;

use foton_format::{Opened, Saved, save_edited};
use foton_math::Rgb;
use foton_math::glam::DAffine3;
use foton_scene::description::{Bsdf, Diffuse, Material, SceneDescription};

use super::{Folder, read, texts};

const MODEL: &str = "mtllib model.mtl\nv 0 0 0\nv 1 0 0\nv 1 0.2 1\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 1 1\n\
                     usemtl clay\nf 1/1 2/2 3/3\nusemtl lamp\nf 1 3 4\n";
const MATERIALS: &str = "newmtl clay\nKd 0.1 0.2 0.3\nnewmtl lamp\nKd 0 0 0\nKe 3 2 1\n";

/// What is said, whatever materials are called: ids of a scene file are those of shapes, too.
fn said(description: &SceneDescription) -> Vec<String> {
    let mut unnamed = description.clone();
    unnamed.materials.iter_mut().for_each(|m| m.name.clear());
    // Zeros of either sign are one number.
    texts(&unnamed).into_iter().map(|text| text.replace("-0.0,", "0.0,").replace("-0.0)", "0.0)")).collect()
}

fn model(folder: &Folder) -> Opened {
    fs::write(folder.0.join("model.obj"), MODEL).unwrap();
    fs::write(folder.0.join("model.mtl"), MATERIALS).unwrap();
    read(&folder.0.join("model.obj"))
}

fn edit(description: &mut SceneDescription) {
    description.shapes[0].to_world = DAffine3::from_rotation_y(0.3);
    description.shapes[1].radiance = Some(Rgb::new(1.0, 1.0 / 3.0, 2.0).into());
    description.sensors[0].fov_degrees = 33.0;
    let front = Bsdf::Diffuse(Diffuse { reflectance: Rgb::new(0.9, 0.1, 0.2).into() });
    description.materials[0] = Material { front, ..description.materials[0].clone() };
}

#[test]
fn an_edited_model_is_saved_as_a_scene_of_its_own_and_opens_as_it_was() {
    let folder = Folder::new("foreign");
    let opened = model(&folder);
    let mut edited = opened.description.clone();
    edit(&mut edited);
    let path = folder.0.join("model.xml");
    let saved = save_edited(&opened, &edited, &path).unwrap();
    assert_eq!(saved, Saved::Anew { why: "it was opened from a mesh file".to_owned() });
    assert_eq!(said(&read(&path).description), said(&edited));
    // The model is as it was.
    assert_eq!(fs::read_to_string(folder.0.join("model.obj")).unwrap(), MODEL);
    // From here on it is a scene file like others.
    let again = read(&path);
    let mut moved = again.description.clone();
    moved.shapes[1].to_world.translation.y = 2.0;
    assert_eq!(save_edited(&again, &moved, &path).unwrap(), Saved::Changed);
    assert_eq!(said(&read(&path).description), said(&moved));
}

#[test]
fn meshes_of_others_that_lie_where_a_scene_is_saved_stay() {
    let folder = Folder::new("foreign-beside");
    let opened = model(&folder);
    fs::create_dir_all(folder.0.join("meshes")).unwrap();
    let mine = folder.0.join("meshes/model-clay.ply");
    fs::write(&mine, "ply of mine").unwrap();
    let path = folder.0.join("model.xml");
    save_edited(&opened, &opened.description, &path).unwrap();
    assert_eq!(fs::read_to_string(&mine).unwrap(), "ply of mine");
    assert_eq!(said(&read(&path).description), said(&opened.description));
    // Nor is the model itself written over, by whatever name.
    let refused = |path: &Path| save_edited(&opened, &opened.description, path).is_err();
    assert!(refused(&folder.0.join("model.obj")) && refused(&folder.0.join("model.mtl")));
}

/// One of the instances of a group moves: its element changes, and no other.
#[test]
fn an_instance_is_moved_in_its_own_element() {
    let folder = Folder::new("instance");
    let group = r#"<shape type="shapegroup" id="tiles"><shape type="obj">
        <string name="filename" value="meshes/tile.obj"/></shape></shape>"#;
    let at = |id: &str| {
        format!("<shape type=\"instance\" id=\"{id}\"><ref id=\"tiles\"/> <!-- {id} --></shape>\n")
    };
    let scene = format!(
        "<scene version=\"3.0.0\">\n<sensor type=\"perspective\"/>\n{group}\n{}{}</scene>\n",
        at("a"),
        at("b")
    );
    fs::write(folder.path(), scene).unwrap();
    let opened = read(&folder.path());
    let mut edited = opened.description.clone();
    edited.shapes[1].to_world.translation.x = 3.0;
    edited.hidden.shapes.insert(0);
    assert_eq!(save_edited(&opened, &edited, &folder.saved()).unwrap(), Saved::Changed);
    let text = fs::read_to_string(folder.saved()).unwrap();
    assert_eq!((text.matches("to_world").count(), text.contains("<!-- b -->")), (1, true), "{text}");
    let again = read(&folder.saved()).description;
    assert_eq!((texts(&again), again.hidden), (texts(&edited), edited.hidden.clone()));
    // One of them goes.
    edited.shapes.remove(0);
    edited.hidden.shapes.clear();
    assert_eq!(save_edited(&opened, &edited, &folder.saved()).unwrap(), Saved::Changed);
    assert_eq!(texts(&read(&folder.saved()).description), texts(&edited));
}
