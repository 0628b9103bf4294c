//! Materials that foton does not model stay in a file while what has them is edited, and go where they are.

use std::fs;

use foton_format::{Saved, save_edited};
use foton_math::Rgb;
use foton_scene::description::{Bsdf, Coating, Colour, Plastic, SceneDescription};

use super::{Folder, read, texts};

const SCENE: &str = r#"<scene version="3.0.0">
    <sensor type="perspective"/>
    <bsdf type="diffuse" id="chalk"/>
    <shape type="sphere" id="bust">
        <!-- Carrara. -->
        <subsurface type="dipole" id="marble"><string name="material" value="marble"/></subsurface>
    </shape>
    <shape type="sphere" id="wig"><bsdf type="hair" id="brown"><float name="eumelanin" value="2"/></bsdf></shape>
    <shape type="sphere" id="ball"><ref id="chalk"/></shape>
</scene>
"#;

/// The file after an edit, which it takes in its own place.
fn saved(test: &str, edit: impl FnOnce(&mut SceneDescription)) -> String {
    let folder = Folder::new(test);
    fs::write(folder.path(), SCENE).unwrap();
    let opened = read(&folder.path());
    let mut edited = opened.description.clone();
    edit(&mut edited);
    assert_eq!(save_edited(&opened, &edited, &folder.saved()).unwrap(), Saved::Changed);
    assert_eq!(texts(&read(&folder.saved()).description), texts(&edited));
    fs::read_to_string(folder.saved()).unwrap()
}

fn paint(bsdf: &mut Bsdf) {
    let Bsdf::Plastic(plastic) = bsdf else { panic!("a stand-in of plastic") };
    *bsdf = Bsdf::Plastic(Plastic { diffuse_reflectance: Rgb::new(0.1, 0.2, 0.3).into(), ..*plastic });
}

#[test]
fn a_shape_that_moves_keeps_what_its_stand_in_stands_for() {
    let text = saved("stand-in-moved", |d| {
        d.shapes[0].to_world.translation.x = 2.0;
        d.shapes[1].to_world.translation.y = 1.0;
    });
    for kept in
        ["<!-- Carrara. -->", "<subsurface type=\"dipole\"", "value=\"marble\"", "type=\"hair\"", "eumelanin"]
    {
        assert!(text.contains(kept), "{kept}: {text}");
    }
}

#[test]
fn a_stand_in_that_is_edited_takes_the_place_of_what_it_stood_for() {
    let text = saved("stand-in-edited", |d| {
        for shape in [0, 1] {
            let material = d.shapes[shape].material;
            paint(&mut d.materials[material].front);
        }
    });
    assert!(
        !text.contains("subsurface") && !text.contains("hair") && text.contains("<!-- Carrara. -->"),
        "{text}"
    );
    let text = saved("stand-in-other", |d| d.shapes[0].material = d.shapes[2].material);
    assert!(!text.contains("subsurface") && text.contains("hair"), "{text}");
}

#[test]
fn a_coating_comes_and_goes_in_the_materials_own_element() {
    let chalk = |d: &SceneDescription| d.shapes[2].material;
    let coated = saved("coated", |d| {
        let (material, coat) = (
            chalk(d),
            Coating { sigma_a: Colour::Constant(Rgb::new(0.0, 0.5, 1.0)), ..Coating::default(true) },
        );
        d.materials[material].coatings = [Some(coat), None];
    });
    assert!(coated.contains("<bsdf type=\"roughcoating\" id=\"chalk\">"), "{coated}");
    let folder = Folder::new("uncoated");
    fs::write(folder.path(), &coated).unwrap();
    let opened = read(&folder.path());
    let mut bare = opened.description.clone();
    let material = chalk(&bare);
    bare.materials[material].coatings = [None; 2];
    assert_eq!(save_edited(&opened, &bare, &folder.saved()).unwrap(), Saved::Changed);
    let text = fs::read_to_string(folder.saved()).unwrap();
    assert!(!text.contains("coating") && text.contains("<bsdf type=\"diffuse\" id=\"chalk\""), "{text}");
}
