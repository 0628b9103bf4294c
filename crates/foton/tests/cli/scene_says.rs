//! What a scene has the program say or do.

use super::*;

/// The scene with a lamp of the same size, below the floor, where nothing is seen.
fn with_a_cellar() -> String {
    let cellar = r#"<shape type="rectangle" id="cellar lamp">
        <transform name="to_world"><scale value="0.5"/><rotate x="1" angle="90"/><translate y="-50"/></transform>
        <emitter type="area"><rgb name="radiance" value="18, 16, 14"/></emitter>
    </shape>
    </scene>"#;
    SCENE.replace("</scene>", cellar)
}

#[test]
fn info_and_render_name_a_light_that_takes_photons_in_vain() {
    let folder = Folder::new("starved");
    folder.write("cellar.xml", &with_a_cellar());
    // Twice the power; each emitter has a small share beside that by power.
    for arguments in ["info cellar.xml", "render cellar.xml --passes 2 --photons 20000 -o cellar.png"] {
        let said = text(&folder.done(arguments).stderr);
        assert!(said.contains("\"cellar lamp\" takes 65 % of the photons"), "{arguments}: {said}");
        assert_eq!(said.matches("of the photons, and").count(), 1, "the other lamp is seen: {said}");
    }
    let output = folder.done("render cellar.xml --passes 2 --photons 20000 -o cellar.png --json");
    let events = events(&output.stdout);
    let lights = events.last().expect("an end")["lights"].as_array().expect("a list").clone();
    let rate = |name: &str| {
        let light = lights.iter().find(|l| l["name"] == name).expect("by its name");
        number(light, "hit_rate")
    };
    assert_eq!(rate("cellar lamp"), 0.0);
    let other = lights.iter().find(|l| l["name"] != "cellar lamp").expect("the lamp");
    assert!(number(other, "hit_rate") > 0.3, "{other}");
    assert!(!text(&folder.done("info scene.xml").stderr).contains("of the photons, and"));
}

#[test]
fn passes_that_the_file_asks_for_are_done_unless_the_user_says_otherwise() {
    let folder = Folder::new("max-passes");
    let integrator = r#"<integrator type="sppm"><integer name="max_passes" value="3"/></integrator><sensor type="perspective" id="front">"#;
    let scene = SCENE.replace(r#"<sensor type="perspective" id="front">"#, integrator);
    folder.write("three.xml", &scene);
    let passes = |arguments: &str| {
        let events =
            events(&folder.done(&format!("render three.xml --photons 1000 --json {arguments}")).stdout);
        number(events.last().expect("an end"), "passes")
    };
    assert_eq!(passes("-o a.png"), 3.0);
    assert_eq!(passes("-o a.png --passes 2"), 2.0);
    let said = text(&folder.done("render three.xml --photons 1000 -o a.png").stderr);
    assert!(said.contains("3 passes, as the scene file says"), "{said}");
}
