//! Edits of what stands inside blends, bump maps and normal maps.

use std::fs;

use foton_format::{Saved, save_edited};
use foton_math::Rgb;
use foton_scene::description::{Bsdf, Diffuse, SceneDescription};

use super::{Folder, read};

const SCENE: &str = r#"<scene version="3.0.0">
    <sensor type="perspective"/>
    <texture type="checkerboard" id="squares"/>
    <bsdf type="blendbsdf" id="blend">
        <ref name="weight" id="squares"/>
        <bsdf type="twosided"><bsdf type="bumpmap"><ref name="heights" id="squares"/>
            <bsdf type="diffuse"><rgb name="reflectance" value="0.1"/></bsdf>
        </bsdf></bsdf>
        <bsdf type="diffuse"><rgb name="reflectance" value="0.2"/></bsdf>
    </bsdf>
    <shape type="sphere"><ref id="blend"/></shape>
</scene>
"#;

/// What the scene's own file becomes by an edit, and how.
fn saved(folder: &Folder, edit: impl FnOnce(&mut SceneDescription)) -> (Saved, String) {
    fs::write(folder.path(), SCENE).unwrap();
    let opened = read(&folder.path());
    let mut edited = opened.description.clone();
    edit(&mut edited);
    let saved = save_edited(&opened, &edited, &folder.saved()).unwrap();
    let again = read(&folder.saved()).description;
    let scatters = |d: &SceneDescription| {
        format!("{:?}", d.materials.iter().map(|m| (m.front, m.back)).collect::<Vec<_>>())
    };
    assert_eq!(scatters(&again), scatters(&edited));
    (saved, fs::read_to_string(folder.saved()).unwrap())
}

#[test]
fn a_component_of_a_blend_changes_in_its_place() {
    let folder = Folder::new("blend");
    let red = Bsdf::Diffuse(Diffuse { reflectance: Rgb::new(0.5, 0.25, 0.125).into() });
    for (material, old) in [(0, "0.1"), (1, "0.2")] {
        let (saved, text) = saved(&folder, |d| {
            d.materials[material].front = red;
            d.materials[material].back = d.materials[material].back.map(|_| red);
        });
        let wanted = SCENE.replace(&format!("value=\"{old}\""), "value=\"0.5, 0.25, 0.125\"");
        assert_eq!((saved, text.replace("0.5 0.25 0.125", "0.5, 0.25, 0.125")), (Saved::Changed, wanted));
    }
    // Another relief is none of the file's values.
    let (saved, text) = saved(&folder, |d| d.materials[0].relief = None);
    assert!(matches!(saved, Saved::Anew { .. }) && text.contains("blendbsdf"), "{text}");
}
