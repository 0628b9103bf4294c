//! What a scene has the program say or do.

use super::interface::has_keys;
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
    let render = "render cellar.xml --direct photons --passes 2 --photons 20000 -o cellar.png";
    // Guidance, once it has learnt from the first pass, gives it less.
    for (arguments, share) in
        [("info cellar.xml".to_owned(), 65), (format!("{render} --guide off"), 65), (render.to_owned(), 43)]
    {
        let said = text(&folder.done(&arguments).stderr);
        assert!(
            said.contains(&format!("\"cellar lamp\" takes {share} % of the photons")),
            "{arguments}: {said}"
        );
        assert_eq!(said.matches("of the photons, and").count(), 1, "the other lamp is seen: {said}");
    }
    let output =
        folder.done("render cellar.xml --direct photons --passes 2 --photons 20000 -o cellar.png --json");
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

/// What was warned of in a render of two passes, with the end's event.
fn warnings(folder: &Folder, arguments: &str) -> (Vec<String>, Value) {
    let output = folder.done(&format!("render {arguments} --passes 2 --photons 20000 -o x.exr --json"));
    let events = events(&output.stdout);
    let chosen = events.iter().filter(|e| e["event"] == "warning");
    let warnings = chosen.map(|e| e["message"].as_str().expect("a message").to_owned()).collect();
    (warnings, events.last().expect("an end").clone())
}

/// Each line of the ledger is counted where it happens; here their sum is taken anew.
#[test]
fn the_ledger_has_a_line_for_everything_that_becomes_of_light_and_they_add_up() {
    let folder = Folder::new("ledger");
    let (none, done) = warnings(&folder, "scene.xml");
    assert_eq!(none, [""; 0]);
    let watts = |done: &Value, name: &str| number(&done["ledger"], name);
    let lines = ["absorbed", "escaped", "roulette", "truncated", "shading_normals", "lost"];
    let rest = |done: &Value| {
        let emitted = watts(done, "emitted");
        (emitted - lines.iter().map(|line| watts(done, line)).sum::<f64>()) / emitted
    };
    assert!(rest(&done).abs() < 1e-6 && watts(&done, "imbalance").abs() < 1e-6, "{}", done["ledger"]);
    assert!(watts(&done, "absorbed") > 0.0 && watts(&done, "escaped") > 0.0, "{}", done["ledger"]);
    assert_eq!(done["ledger"]["dropped_photons"], 0);
    // The glass passes light on as far as the cap allows, and the walls as often.
    let (said, done) = warnings(&folder, "scene.xml --max-depth 2");
    let share = 100.0 * watts(&done, "truncated") / watts(&done, "emitted");
    assert!(rest(&done).abs() < 1e-6 && share > 1.0, "{}", done["ledger"]);
    assert_eq!(said.len(), 1, "{said:?}");
    let expected = format!("{share:.1} % of the emitted power was cut off at the longest path, ");
    assert!(
        said[0].starts_with(&expected) && said[0].ends_with("at \"white\"; --max-depth sets it"),
        "{said:?}"
    );
}

/// Two lights whose power is a number in single precision, and whose sum is none.
#[test]
fn photons_that_are_dropped_are_warned_of_with_their_light() {
    let folder = Folder::new("dropped");
    let sun = |id: &str| {
        format!(
            r#"<emitter type="point" id="{id}"><point name="position" x="0" y="1.5" z="0"/>
            <rgb name="intensity" value="7e31"/></emitter>"#
        )
    };
    folder.write("scene.xml", &SCENE.replace("</scene>", &format!("{}{}</scene>", sun("one"), sun("two"))));
    let (said, done) = warnings(&folder, "scene.xml");
    let dropped = done["ledger"]["dropped_photons"].as_u64().expect("a count");
    assert!(dropped > 1000, "{dropped}");
    let line = said.iter().find(|line| line.contains("dropped")).expect("a warning");
    let start = format!("{dropped} photons or sums of them were dropped because they were not finite: ");
    let places = line.strip_prefix(&start).unwrap_or_else(|| panic!("{line}"));
    let [one, two] = ["one", "two"].map(|id| {
        let before = places.split(", ").find_map(|place| place.strip_suffix(&format!(" at \"{id}\"")));
        before.and_then(|n| n.parse::<u64>().ok()).unwrap_or_else(|| panic!("{id} is in {line}"))
    });
    assert_eq!(one + two, dropped);
    assert!(folder.exr("x.exr").0.pixels.iter().all(|c| c.is_finite()));
}

#[test]
fn what_a_scene_cannot_have_in_single_precision_is_said_by_name() {
    let folder = Folder::new("extremes");
    let with = |shapes: &str| {
        folder.write("odd.xml", &SCENE.replace("</scene>", &format!("{shapes}</scene>")));
        warnings(&folder, "odd.xml").0
    };
    let speck = r#"<shape type="sphere" id="speck"><point name="center" x="1e4" y="0" z="0"/><float name="radius" value="5e-4"/>
        <ref id="white"/></shape>"#;
    let said = with(speck);
    let expected = "\"speck\" is only 2 steps of single precision across, so small is it where it stands: its shape is rounded to those";
    assert_eq!(said, [expected]);
    folder.write("line.obj", &format!("{GEM}f 1 2 2\nf 3 3 4\n"));
    let said =
        with(r#"<shape type="obj"><string name="filename" value="line.obj"/><ref id="white"/></shape>"#);
    assert_eq!(said, ["left out 2 triangles without area"]);
    let said = with(
        r#"<shape type="rectangle" id="sign"><transform name="to_world"><translate z="-9"/></transform><ref id="white"/></shape>
        <shape type="rectangle" id="letter"><transform name="to_world"><scale value="0.5"/><translate z="-9"/></transform>
        <ref id="white"/></shape>"#,
    );
    let expected = "\"letter\" lies exactly in \"sign\", which hides it there: what is opaque counts before masks, then the first in the file";
    assert_eq!(said, [expected]);
    let said = warnings(&folder, "scene.xml --radius 1e9").0;
    assert!(
        said.len() == 1 && said[0].starts_with("--radius is larger than the whole scene and is cut to that")
    );
}

/// What is wrong with a light or too far away is said with the place of its element.
#[test]
fn what_single_precision_does_not_hold_is_said_with_its_place() {
    let folder = Folder::new("places-of-parts");
    let end = SCENE.lines().count();
    let lamp = |emission: &str, position: &str| {
        format!(
            "<emitter type=\"point\" id=\"star\"><point name=\"position\" value=\"{position}\"/>\
             <rgb name=\"intensity\" value=\"{emission}\"/></emitter>"
        )
    };
    let write =
        |part: &str| folder.write("scene.xml", &SCENE.replace("</scene>", &format!("  {part}</scene>")));
    write(&lamp("1e37", "0, 1, 0"));
    let said = folder.fails(1, "render scene.xml -o x.exr --passes 1");
    let start =
        format!("error: scene.xml:{end}:3: \"star\" emits more than single precision holds: of its 1.0e37, ");
    assert!(said.contains(&start) && said.contains("can take up to about"), "{said}");
    let output = folder.run("render scene.xml -o x.exr --passes 1 --json");
    let event = &events(&output.stdout)[0];
    assert_eq!(
        (&event["event"], &event["line"], &event["column"]),
        (&json!("error"), &json!(end), &json!(3))
    );
    write(&lamp("1", "0, 1e30, 0"));
    let said = folder.fails(1, "render scene.xml -o x.exr --passes 1");
    assert!(said.contains(&format!("error: scene.xml:{end}:3: \"star\" is ")), "{said}");
    assert!(said.contains("bring it nearer"), "{said}");
    assert_eq!(folder.images(), [""; 0]);
    write(&lamp("1e8", "0, 1e4, 0"));
    for command in ["render scene.xml -o x.exr --passes 1 --photons 1000", "info scene.xml"] {
        let said = text(&folder.done(command).stderr);
        let start =
            format!("warning: scene.xml:{end}:3: \"star\" is 2e3 times as far away as the scene is large, ");
        assert!(said.contains(&start) && said.contains("irradiance \"1"), "{said}");
    }
    // An included part has the place of its <include>.
    folder.write("part.xml", &format!("<scene version=\"3.0.0\">\n\n\n{}</scene>", lamp("1e37", "0, 1, 0")));
    write("<include filename=\"part.xml\"/>");
    let said = folder.fails(1, "render scene.xml -o x.exr --passes 1");
    assert!(said.contains(&format!("error: scene.xml:{end}:3: \"star\"")), "{said}");
}

#[test]
fn a_scene_without_light_is_black_with_a_warning() {
    let folder = Folder::new("dark");
    folder.write("scene.xml", &SCENE.replace("9, 8, 7", "0, 0, 0"));
    let (said, done) = warnings(&folder, "scene.xml");
    assert_eq!(said, ["nothing in the scene emits light: the image will be black"]);
    assert_eq!(done["ledger"]["emitted"], 0.0);
    assert!(folder.exr("x.exr").0.pixels.iter().all(|c| c.is_black()));
}

#[test]
fn findings_show_their_line_and_json_has_the_same_keys_as_ever() {
    let folder = Folder::new("excerpts");
    folder.write(
        "wrong.xml",
        "<scene version='3.0.0'>\n  <!-- a -- b -->\n  <shape type='spere'/>\n  <shape type='cube'><bsdf type='diffuse'/></shape>\n</scene>\n",
    );
    let output = folder.run("info wrong.xml --json");
    assert_eq!(output.status.code(), Some(1));
    let said = text(&output.stderr);
    let wanted = "error: wrong.xml:3:16: unknown shape \"spere\", did you mean \"sphere\"?\n  |\n3 |   <shape type='spere'/>\n  |                ^^^^^\n  |\n  = help: the shape plugins that foton reads are ";
    assert!(said.contains(wanted) && !said.contains('\u{1b}'), "{said}");
    let events = events(&output.stdout);
    let error = events.iter().find(|e| e["event"] == "error").expect("an error");
    has_keys(error, "event message file line column");
    assert_eq!(error.as_object().map(|keys| keys.len()), Some(5), "{error}");
}

#[test]
fn scenes_open_without_what_is_missing_where_that_is_allowed() {
    let folder = Folder::new("missing");
    let gone = "<shape type='obj'><string name='filename' value='gone.obj'/></shape>\n\
        <shape type='sphere'><bsdf type='diffuse'><texture type='bitmap' name='reflectance'>\
        <string name='filename' value='gone.png'/></texture></bsdf></shape>\n</scene>";
    folder.write("missing.xml", &SCENE.replace("</scene>", gone));
    let outputs =
        ["info missing.xml", "convert missing.xml out.xml", "render missing.xml -o x.png --passes 1"];
    for arguments in outputs {
        let refused = folder.run(arguments);
        let said = text(&refused.stderr);
        assert_eq!(refused.status.code(), Some(1), "{said}");
        assert!(said.contains("gone.obj: ") && said.contains("gone.png: "), "{said}");
        assert_eq!(said.matches("= help: --allow-missing opens the scene").count(), 1, "{said}");
        let opened = folder.done(&format!("{arguments} --allow-missing"));
        let said = text(&opened.stderr);
        assert!(said.contains("gone.obj is missing: the shape is left out"), "{said}");
        assert!(said.contains("gone.png is missing: magenta stands for it"), "{said}");
    }
}
