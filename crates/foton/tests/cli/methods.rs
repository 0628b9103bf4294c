//! `--integrator`: each method alone, and all of them.

use foton_integrator::Method;

use super::*;

/// Names of all methods.
fn methods() -> Vec<&'static str> {
    Method::ALL.into_iter().map(Method::name).collect()
}

#[test]
fn every_method_writes_images_checkpoints_and_layers_and_says_which_it_is() {
    let folder = Folder::new("each-method");
    for method in methods() {
        let render = format!(
            "render scene.xml --integrator {method} --photons 2000 --layers direct,indirect,emission,error_noise"
        );
        folder.done(&format!("{render} --passes 4 -o whole.exr"));
        let (_, metadata) = folder.exr("whole.exr");
        let settings = metadata.get("foton:settings").expect("settings").to_owned();
        assert!(settings.starts_with(&format!("integrator={method} ")), "{settings}");
        assert_eq!(settings.contains("alpha="), method.ends_with("ppm"), "{settings}");
        folder.done(&format!("{render} --passes 2 -o half.exr --checkpoint half.ck"));
        folder.done(&format!("{render} --passes 4 -o whole-again.exr --resume half.ck"));
        assert!(folder.bytes("whole.exr") == folder.bytes("whole-again.exr"), "{method}");
        folder.done(&format!("{render} --passes 4 -o one.exr --threads 1"));
        assert!(folder.bytes("whole.exr") == folder.bytes("one.exr"), "{method}");
    }
    let said = folder.fails(1, "render scene.xml --integrator ppm --passes 4 -o x.exr --resume half.ck");
    assert!(said.contains("integrator photon-map, not ppm"), "{said}");
}

#[test]
fn what_a_method_cannot_do_is_refused_or_said() {
    let folder = Folder::new("method-limits");
    for (arguments, why) in [
        (
            "--integrator path --layers radius",
            "the layer radius tells of photons, which --integrator path does not have",
        ),
        ("--integrator all --checkpoint x.ck", "--checkpoint is of a render by one method"),
        ("--integrator all --layers direct", "--layers is of a render by one method"),
        (
            "--integrator path --reference r.exr",
            "--reference is what --integrator all compares its images with",
        ),
    ] {
        let said = folder.fails(2, &format!("render scene.xml -o x.exr --passes 1 {arguments}"));
        assert!(said.contains(why), "{arguments}: {said}");
    }
    let point = r#"<emitter type="point"><point name="position" x="0" y="1.5" z="0"/><rgb name="intensity" value="1"/></emitter>"#;
    folder.write("point.xml", &SCENE.replace("</scene>", &format!("{point}</scene>")));
    for (scene, method, is_said) in [
        ("point", "path", true),
        ("point", "whitted", true),
        ("point", "ppm", false),
        ("scene", "path", false),
    ] {
        let arguments = format!("render {scene}.xml -o x.exr --passes 1 --photons 500 --integrator {method}");
        let said = text(&folder.done(&arguments).stderr);
        assert_eq!(said.contains("these caustics are missing"), is_said, "{arguments}: {said}");
    }
}

/// A small figure beside light that is missing would be worse than none.
#[test]
fn no_error_is_told_where_a_method_misses_light() {
    let folder = Folder::new("method-errors");
    let point = r#"<emitter type="point"><point name="position" x="0" y="1.5" z="0"/><rgb name="intensity" value="1"/></emitter>"#;
    folder.write("point.xml", &SCENE.replace("</scene>", &format!("{point}</scene>")));
    for (scene, method, is_told) in [
        ("scene", "sppm", true),
        ("scene", "path", true),
        ("point", "path", false),
        ("scene", "whitted", false),
        ("scene", "photon-map", false),
    ] {
        let render =
            format!("render {scene}.xml -o x.exr --integrator {method} --photons 2000 --passes 12 --json");
        let events = events(&folder.done(&render).stdout);
        assert_eq!(events.last().expect("an end")["error"].is_number(), is_told, "{render}");
        let said = text(&folder.done(&render.replace("--json", "")).stderr);
        assert_eq!(said.contains("the error of the image is not estimated"), !is_told, "{said}");
    }
}

#[test]
fn all_methods_make_a_sheet_an_image_each_and_a_table() {
    let folder = Folder::new("all-methods");
    let all = "render scene.xml -o sheet.png --integrator all --passes 3 --photons 2000";
    let events = events(&folder.done(&format!("{all} --json")).stdout);
    let of: Vec<&Value> = events.iter().filter(|e| e["event"] == "method").collect();
    assert_eq!(of.iter().map(|e| e["integrator"].as_str().expect("a name")).collect::<Vec<_>>(), methods());
    for (event, method) in of.iter().zip(methods()) {
        interface::has_keys(event, "event integrator passes seconds error difference output");
        let alone = format!("render scene.xml -o alone.exr --integrator {method} --passes 3 --photons 2000");
        folder.done(&alone);
        assert!(folder.bytes("alone.exr") == folder.bytes(&format!("sheet-{method}.exr")), "{method}");
    }
    // The one that the others are compared with has no difference.
    assert_eq!(of.iter().filter(|e| e["difference"].is_null()).count(), 1);
    let sheet = foton_film::read_png(&folder.file("sheet.png")).expect("a sheet");
    assert!(sheet.width > 2 * 24 && sheet.height > 16);
    let said = text(&folder.done(&format!("{all} --reference alone.exr")).stderr);
    assert!(said.contains("differs from alone.exr by"), "{said}");
    folder.done("render scene.xml -o small.exr --size 12x8 --passes 1 --photons 500");
    let said =
        folder.fails(1, "render scene.xml -o other.png --integrator all --reference small.exr --passes 1");
    assert!(said.contains("only images of one size") && !folder.file("other-ppm.exr").exists(), "{said}");
    let said = folder.fails(2, "render scene.xml -o sheet.png --integrator all --reference sheet-path.exr");
    assert!(said.contains("sheet-path.exr"), "{said}");
}

#[test]
fn the_scene_decides_where_asked_to_and_that_is_said() {
    let folder = Folder::new("auto-method");
    let matt = SCENE.replace(r#"<bsdf type="dielectric"/>"#, "");
    folder.write("matt.xml", &matt);
    folder.write(
        "lens.xml",
        &matt.replace(r#"type="perspective""#, r#"type="thinlens""#).replace(
            r#"<transform name="to_world"><lookat"#,
            r#"<float name="aperture_radius" value="0.1"/><transform name="to_world"><lookat"#,
        ),
    );
    for (scene, method, why) in [
        ("scene", "sppm", "mirrors or glass"),
        ("matt", "sppm", "edges converge"),
        ("lens", "sppm", "a lens"),
    ] {
        let render = format!("render {scene}.xml -o auto.exr --photons 500 --passes 2 --integrator");
        let said = text(&folder.done(&format!("{render} auto")).stderr);
        assert!(
            said.contains(&format!("--integrator auto: {method}, because")) && said.contains(why),
            "{said}"
        );
        let chosen = folder.bytes("auto.exr");
        folder.done(&format!("{render} {method}"));
        assert!(folder.bytes("auto.exr") == chosen, "{scene}");
        let info = text(&folder.done(&format!("info {scene}.xml")).stdout);
        assert!(info.contains(&format!("--integrator auto would take {method}")), "{info}");
    }
}
