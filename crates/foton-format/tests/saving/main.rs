//! An edited scene goes back into its own file: what changed is changed, and the rest stays as it was.

mod blends;
mod foreign;
mod lights;
mod stand_ins;

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use foton_format::{Opened, Options, Saved, open, read_str, save_edited};
use foton_math::Rgb;
use foton_math::glam::{DAffine3, DVec3};
use foton_scene::description::{
    Bsdf, Colour, Conductor, Dielectric, Diffuse, EmitterDescription, EmitterKind, FovAxis, Geometry, Lens,
    Mesh, MicrofacetDistribution, Microfacets, Mirror, Plastic, SceneDescription, ShapeDescription,
};

const SCENE: &str = r#"<!-- A test scene, with a comment before it. -->
<scene version="3.0.0">
    <default name="integrator" value="path"/>
    <default name="ior" value="1.5"/>
    <integrator type="$integrator"/>
    <sensor type="perspective" id="eye">
        <!-- Fifty millimetres. -->
        <string name="focal_length" value="50mm"/>
        <transform name="to_world"><lookat origin="0, 1, 9" target="0, 1, 0" up="0, 1, 0"/></transform>
        <film type="hdrfilm"><integer name="width" value="64"/><integer name="height" value="48"/></film>
    </sensor>
    <texture type="checkerboard" id="squares"/>
    <bsdf type="dielectric" id="glass"><float name="int_ior" value="$ior"/></bsdf>
    <bsdf type="twosided" id="board"><bsdf type="roughplastic">
        <ref name="diffuse_reflectance" id="squares"/>
        <float name="alpha" value="0.2"/>
    </bsdf></bsdf>
    <bsdf type="roughconductor" id="metal"><string name="material" value="Au"/><ref name="alpha" id="squares"/></bsdf>
    <shape type="sphere" id="ball">
        <point name="center" x="0" y="1" z="0"/> <!-- The middle. -->
        <ref id="glass"/>
    </shape>
    <shape type="sphere" id="bead"><ref id="glass"/></shape>
    <shape type="obj" id="tile">
        <string name="filename" value="meshes/tile.obj"/>
        <transform name="to_world">
            <rotate y="1" angle="30"/>
        </transform>
        <ref id="board"/>
    </shape>
    <shape type="cylinder" id="tube">
        <transform name="to_world"><scale x="1" y="1" z="3"/></transform>
        <ref id="metal"/>
    </shape>
    <shape type="rectangle" id="lamp">
        <emitter type="area"><rgb name="radiance" value="1 2 3"/></emitter>
    </shape>
    <emitter type="point" id="bulb"><point name="position" value="0 4 0"/></emitter>
    <emitter type="spot" id="key"><rgb name="intensity" value="5"/></emitter>
</scene>
"#;

const TILE: &str = "v 0 0 0\nv 1 0 0\nv 1 0.2 1\nv 0 0 1\nf 1 2 3\nf 1 3 4\n";

/// A folder of a test's own with the scene in it, removed when the test is over.
struct Folder(PathBuf);

impl Folder {
    fn new(test: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("foton-saving-{}-{test}", std::process::id()));
        fs::create_dir_all(folder.join("scene/meshes")).unwrap();
        fs::write(folder.join("scene/meshes/tile.obj"), TILE).unwrap();
        fs::write(folder.join("scene/scene.xml"), SCENE).unwrap();
        Self(folder)
    }

    fn path(&self) -> PathBuf {
        self.0.join("scene/scene.xml")
    }

    fn saved(&self) -> PathBuf {
        self.0.join("scene/saved.xml")
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn read(path: &Path) -> Opened {
    open(path, &Options::default()).unwrap_or_else(|e| panic!("{e}"))
}

/// Everything but the order of materials, numbers to the last digit.
fn texts(description: &SceneDescription) -> Vec<String> {
    let shapes = description.shapes.iter().map(|shape| {
        let material = &description.materials[shape.material];
        format!("{:?}", (material, ShapeDescription { material: 0, ..shape.clone() }))
    });
    let d = description;
    let rest = [format!("{:?}", (&d.sensors, &d.emitters, d.max_depth)), format!("{:?}", d.textures)];
    shapes.chain(rest).collect()
}

/// Saves an edit; the lines of the file that it changed.
fn changed_lines(folder: &Folder, edit: impl FnOnce(&mut SceneDescription)) -> Vec<String> {
    let opened = read(&folder.path());
    let mut edited = opened.description.clone();
    edit(&mut edited);
    assert_eq!(save_edited(&opened, &edited, &folder.saved()).unwrap(), Saved::Changed);
    assert_eq!(texts(&read(&folder.saved()).description), texts(&edited));
    let text = fs::read_to_string(folder.saved()).unwrap();
    text.lines().filter(|line| !SCENE.contains(line)).map(|line| line.trim().to_owned()).collect()
}

#[test]
fn an_unedited_scene_is_saved_as_it_was() {
    let folder = Folder::new("unedited");
    assert!(changed_lines(&folder, |_| ()).is_empty());
    assert_eq!(fs::read_to_string(folder.saved()).unwrap(), SCENE);
}

#[test]
fn a_scene_is_not_saved_over_a_mesh_that_it_reads() {
    let folder = Folder::new("over-mesh");
    let opened = read(&folder.path());
    let mesh = folder.0.join("scene/meshes/tile.obj");
    let other = folder.0.join("scene/tile.xml");
    fs::hard_link(&mesh, &other).unwrap();
    for path in [&mesh, &other, &folder.0.join("scene/../scene/meshes/tile.obj")] {
        let error = save_edited(&opened, &opened.description, path).unwrap_err().to_string();
        let said = format!("cannot write {}: it is a file that the scene reads", path.display());
        assert_eq!(error, said);
    }
    assert_eq!(fs::read_to_string(&mesh).unwrap(), TILE);
    // Its own file is what saving is for.
    assert_eq!(save_edited(&opened, &opened.description, &folder.path()).unwrap(), Saved::Changed);
}

#[test]
fn a_moved_shape_changes_its_own_lines() {
    let folder = Folder::new("moved");
    let lines = changed_lines(&folder, |d| {
        let Geometry::Sphere { centre, radius } = &mut d.shapes[0].geometry else { panic!("a sphere") };
        (*centre, *radius) = (DVec3::new(0.1, 1.0, -0.3), 1.25);
    });
    let wanted = [
        "<point name=\"center\" value=\"0.1 1 -0.3\"/> <!-- The middle. -->",
        "<float name=\"radius\" value=\"1.25\"/>",
    ];
    assert_eq!(lines, wanted);
    let lines =
        changed_lines(&folder, |d| d.shapes[2].to_world.translation += DVec3::new(1.0, 1.0 / 3.0, 0.0));
    assert_eq!(lines.len(), 1);
    assert!(lines[0].starts_with("<transform name=\"to_world\"><matrix value=\"0.866"), "{lines:?}");
    let lines = changed_lines(&folder, |d| d.shapes[1].to_world.translation.x = -4.0);
    let matrix = "<matrix value=\"1 0 0 -4  0 1 0 0  0 0 1 0  0 0 0 1\"/>";
    let wanted = format!(
        "<shape type=\"sphere\" id=\"bead\"><ref id=\"glass\"/><transform name=\"to_world\">{matrix}</transform></shape>"
    );
    assert_eq!(lines, [wanted]);
}

#[test]
fn a_tube_that_was_brought_into_the_world_is_moved_there() {
    let folder = Folder::new("tube");
    let lines = changed_lines(&folder, |d| d.shapes[3].to_world.translation.y = 2.0);
    assert_eq!(lines.len(), 4, "{lines:?}");
}

#[test]
fn values_of_materials_change_and_textures_stay() {
    let folder = Folder::new("materials");
    let lines = changed_lines(&folder, |d| {
        let Bsdf::Dielectric(Dielectric { int_ior, .. }) = &mut d.materials[0].front else { panic!("glass") };
        *int_ior = 1.77;
    });
    assert_eq!(
        lines,
        ["<bsdf type=\"dielectric\" id=\"glass\"><float name=\"int_ior\" value=\"1.77\"/></bsdf>"]
    );
    let lines = changed_lines(&folder, |d| {
        let Bsdf::Plastic(Plastic { roughness: Some(r), .. }) = &mut d.materials[1].front else {
            panic!("plastic")
        };
        (r.alpha_u, r.alpha_v) = (0.3.into(), 0.3.into());
        d.materials[1].back = Some(d.materials[1].front);
    });
    assert_eq!(lines, ["<float name=\"alpha\" value=\"0.3\"/>"]);
    let lines = changed_lines(&folder, |d| {
        let Bsdf::Conductor(Conductor { k, .. }) = &mut d.materials[2].front else { panic!("a metal") };
        k.b = 2.5;
    });
    assert!(lines[0].contains("eta") && !lines[0].contains("Au"), "{lines:?}");
    assert!(lines[0].contains("<ref name=\"alpha\" id=\"squares\"/>"), "{lines:?}");
    let rough = |change: fn(&mut Microfacets)| {
        changed_lines(&folder, |d| {
            let Bsdf::Conductor(Conductor { roughness: Some(r), .. }) = &mut d.materials[2].front else {
                panic!("a rough metal")
            };
            change(r);
        })
    };
    let lines = rough(|r| r.distribution = MicrofacetDistribution::Ggx);
    assert!(lines[0].contains("id=\"squares\"") && lines[0].contains("ggx"), "{lines:?}");
    let lines = rough(|r| (r.alpha_u, r.alpha_v) = (0.3.into(), 0.3.into()));
    assert!(!lines[0].contains("squares") && lines[0].contains("name=\"alpha\" value=\"0.3\""), "{lines:?}");
}

#[test]
fn smooth_becomes_rough_and_one_kind_another_in_the_same_place() {
    let folder = Folder::new("kinds");
    let lines = changed_lines(&folder, |d| {
        let Bsdf::Dielectric(Dielectric { roughness, .. }) = &mut d.materials[0].front else {
            panic!("glass")
        };
        let distribution = MicrofacetDistribution::Ggx;
        *roughness = Some(Microfacets { distribution, alpha_u: 0.1.into(), alpha_v: 0.2.into() });
    });
    assert!(
        lines[0].contains("type=\"roughdielectric\" id=\"glass\"") && lines[0].contains("$ior"),
        "{lines:?}"
    );
    let mirror = Bsdf::Mirror(Mirror { reflectance: Colour::Constant(Rgb::new(0.9, 0.8, 0.7)) });
    let lines =
        changed_lines(&folder, |d| (d.materials[0].front, d.materials[0].back) = (mirror, Some(mirror)));
    assert!(lines.iter().any(|l| l.contains("twosided") && l.contains("id=\"glass\"")), "{lines:?}");
    changed_lines(&folder, |d| d.materials[0].opacity = Some(Colour::Constant(Rgb::splat(0.25))));
}

#[test]
fn a_shape_gets_a_material_of_its_own() {
    let folder = Folder::new("own");
    changed_lines(&folder, |d| {
        let mut own = d.materials[0].clone();
        own.name = "glass of bead".to_owned();
        let Bsdf::Dielectric(Dielectric { int_ior, .. }) = &mut own.front else { panic!("glass") };
        *int_ior = 2.4;
        d.materials.push(own);
        d.shapes[1].material = d.materials.len() - 1;
    });
    // The lamp's black material stands in no file; a textured one is copied with its texture.
    for (shape, name) in [(4, "own black"), (2, "own $board")] {
        let opened = read(&folder.path());
        let mut edited = opened.description.clone();
        let mut own = edited.materials[edited.shapes[shape].material].clone();
        own.name = name.to_owned();
        edited.materials.push(own);
        edited.shapes[shape].material = edited.materials.len() - 1;
        assert_eq!(save_edited(&opened, &edited, &folder.saved()).unwrap(), Saved::Changed);
        let again = read(&folder.saved()).description;
        assert_eq!(again.materials[again.shapes[shape].material].name, name);
    }
}

#[test]
fn in_another_folder_files_are_found_and_defines_have_become_defaults() {
    let folder = Folder::new("elsewhere");
    let options = Options { defines: vec![("ior".into(), "1.9".into())], ..Options::default() };
    let opened = open(&folder.path(), &options).unwrap();
    let mut edited = opened.description.clone();
    edited.shapes[2].to_world.translation.y = 0.5;
    fs::create_dir_all(folder.0.join("other/inner")).unwrap();
    let there = folder.0.join("other/inner/copy.xml");
    assert_eq!(save_edited(&opened, &edited, &there).unwrap(), Saved::Changed);
    let text = fs::read_to_string(&there).unwrap();
    assert!(text.contains("\n    <path value=\"../../scene\"/>\n"), "{text}");
    assert!(text.contains("<default name=\"ior\" value=\"1.9\"/>"), "{text}");
    let again = read(&there);
    assert_eq!(texts(&again.description), texts(&edited));
    // And once more, from there.
    let third = folder.0.join("third.xml");
    assert_eq!(save_edited(&again, &edited, &third).unwrap(), Saved::Changed);
    assert_eq!(texts(&read(&third).description), texts(&edited));
}

/// Adds a mesh that is in no file.
fn add_mesh(d: &mut SceneDescription) {
    let positions = vec![DVec3::ZERO, DVec3::X, DVec3::Y];
    let mesh = Mesh { positions, triangles: vec![[0, 1, 2]], ..Mesh::default() };
    let geometry = Geometry::Mesh(mesh.into());
    d.shapes.push(ShapeDescription { name: "model".into(), geometry, ..d.shapes[0].clone() });
}

#[test]
fn what_has_no_place_in_the_file_is_written_anew_with_the_reason() {
    let folder = Folder::new("anew");
    let opened = read(&folder.path());
    let why = |opened: &Opened, edit: &dyn Fn(&mut SceneDescription)| {
        let mut edited = opened.description.clone();
        edit(&mut edited);
        let saved = save_edited(opened, &edited, &folder.saved()).unwrap();
        let again = read(&folder.saved()).description;
        assert_eq!(again.shapes.len(), edited.shapes.len());
        for (a, b) in again.shapes.iter().zip(&edited.shapes) {
            assert_eq!((a.to_world, a.radiance), (b.to_world, b.radiance));
        }
        match saved {
            Saved::Anew { why } => why,
            Saved::Changed => panic!("changed in place"),
        }
    };
    let raise = |d: &mut SceneDescription| d.shapes[0].to_world.translation.y += 1.0;
    assert_eq!(
        why(&opened, &|d| d.max_depth = Some(3)),
        "a change of its longest path has no place in the file"
    );
    assert_eq!(why(&opened, &add_mesh), "the mesh of \"model\" is in no file of the scene");
    let memory = read_str(
        "memory",
        "<scene version='3.0.0'><shape type='sphere'/></scene>",
        &|_| Err(std::io::ErrorKind::NotFound.into()),
        &Options::default(),
    );
    assert_eq!(why(&memory.unwrap(), &raise), "the scene was not opened from a file");
    let tile = folder.0.join("scene/meshes/tile.obj");
    assert_eq!(why(&read(&tile), &raise), "it was opened from a mesh file");
    // Nor is the mesh file written over.
    assert!(save_edited(&read(&tile), &opened.description, &tile).is_err());
    let write = |name: &str, text: &str| {
        let path = folder.0.join("scene").join(name);
        fs::write(&path, text).unwrap();
        read(&path)
    };
    let old = write("old.xml", "<scene version='0.6.0'><shape type='sphere'/></scene>");
    assert_eq!(why(&old, &raise), "the file is of an old version, with other names");
    fs::write(folder.0.join("scene/part.xml"), "<shape version='3.0.0' type='sphere' id='ball'/>").unwrap();
    let included = write("whole.xml", "<scene version='3.0.0'><include filename='part.xml'/></scene>");
    assert_eq!(why(&included, &raise), "\"ball\" stands in an included file");
    // Two materials of one element: a change of one alone cannot be said there.
    let nested = "<scene version='3.0.0'><bsdf type='diffuse' id='a'/><bsdf type='twosided' id='b'><ref id='a'/></bsdf>\
                  <shape type='sphere'><ref id='a'/></shape><shape type='cube'><ref id='b'/></shape></scene>";
    let red = Bsdf::Diffuse(Diffuse { reflectance: Rgb::new(0.5, 0.1, 0.1).into() });
    let nested = write("nested.xml", nested);
    assert_eq!(
        why(&nested, &|d| d.materials[0].front = red),
        "a change of the material of shape \"shape-2\" has no place in the file"
    );
}

#[test]
fn a_scene_that_cannot_be_written_says_so_and_leaves_the_old_one() {
    let folder = Folder::new("refused");
    let opened = read(&folder.path());
    let nowhere = folder.0.join("not/there/scene.xml");
    assert!(save_edited(&opened, &opened.description, &nowhere).is_err());
    // A broken scene is not written over a sound one.
    let mut edited = opened.description.clone();
    edited.shapes[2].geometry = Geometry::Mesh(Arc::default());
    fs::remove_dir_all(folder.0.join("scene/meshes")).unwrap();
    fs::write(folder.0.join("scene/meshes"), "in the way").unwrap();
    assert!(save_edited(&opened, &edited, &folder.path()).is_err());
    assert_eq!(fs::read_to_string(folder.path()).unwrap(), SCENE);
}
