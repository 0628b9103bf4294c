//! `--strict`: the first value that is not finite ends the render, with its place and the image of the passes before.

use super::interface::has_keys;
use super::*;

const RENDER: &str = "render scene.xml --photons 1000 --passes 400 --json";

/// The scene over a black box that the camera does not see into, with a light as bright as numbers go. A small triangle there, whose normals
/// lean over, makes more of a photon now and then.
fn over_a_bright_box(folder: &Folder) {
    folder.write("leaning.obj", "v 0 -1 0\nv 0 -1 .05\nv .05 -1 0\nvn .98 .2 0\nf 1//1 2//1 3//1\n");
    let below = r#"<shape type="cube">
            <transform name="to_world"><scale value="0.3"/><translate x="0.2" y="-1"/></transform>
            <bsdf type="diffuse"><rgb name="reflectance" value="0"/></bsdf>
        </shape>
        <emitter type="point" id="deep"><point name="position" value="0.4, -0.96, 0"/>
            <rgb name="intensity" value="2.9e31"/></emitter>
        <shape type="obj" id="leaning"><string name="filename" value="leaning.obj"/><ref id="white"/></shape>
    </scene>"#;
    folder.write("scene.xml", &SCENE.replace("</scene>", below));
}

#[test]
fn the_first_value_that_is_not_finite_ends_a_strict_render_with_its_place() {
    let folder = Folder::new("strict");
    over_a_bright_box(&folder);
    let output = folder.run(&format!("{RENDER} --strict -o x.exr --checkpoint x.ck --threads 2"));
    assert_eq!(output.status.code(), Some(1), "{}", text(&output.stderr));
    let found = events(&output.stdout);
    let named = |name: &str| found.iter().find(|e| e["event"] == name).unwrap_or_else(|| panic!("{name}"));
    let place = named("not_finite");
    has_keys(place, "event pass quantity light shape material position");
    assert_eq!(place["quantity"], "scattered_power");
    assert_eq!(
        (&place["light"], &place["shape"], &place["material"]),
        (&json!("deep"), &json!("leaning"), &json!("white"))
    );
    let at: Vec<f64> = (0..3).map(|i| place["position"][i].as_f64().expect("a number")).collect();
    assert!(
        (at[1] + 1.0).abs() < 1e-3 && (-1e-3..0.051).contains(&at[0]) && (-1e-3..0.051).contains(&at[2]),
        "{at:?}"
    );
    let pass = number(place, "pass") as u64;
    assert!(pass > 1, "{place}");
    let complete = pass - 1;
    assert_eq!((&named("done")["passes"], &named("done")["outputs"]), (&json!(complete), &json!(["x.exr"])));
    let said = text(&output.stderr);
    let error = format!(
        "error: stopped by --strict: in pass {pass} the power of a photon that leaves a surface is not finite"
    );
    assert!(said.contains(&error), "{said}");
    assert!(
        said.contains(&format!("What was written is the image after {complete} complete passes")),
        "{said}"
    );
    // The image and the place are the same on any number of threads, and the image is that of a render of so many passes.
    let again = folder.run(&format!("{RENDER} --strict -o y.exr --threads 1"));
    assert!(events(&again.stdout).contains(place));
    folder.done(&format!("render scene.xml --photons 1000 --passes {complete} -o z.exr"));
    for other in ["y.exr", "z.exr"] {
        assert!(folder.bytes("x.exr") == folder.bytes(other), "{other}");
    }
    // Hit points may be half-way between two passes, so no checkpoint is written of them.
    assert!(!folder.images().contains(&"x.ck".to_owned()), "{:?}", folder.images());
}

#[test]
fn without_strict_the_place_is_said_and_the_render_goes_on() {
    let folder = Folder::new("not-strict");
    over_a_bright_box(&folder);
    let strict = folder.run(&format!("{RENDER} --strict -o x.exr"));
    let place = events(&strict.stdout).into_iter().find(|e| e["event"] == "not_finite").expect("a place");
    let passes = number(&place, "pass") + 1.0;
    let output = folder.done(&format!(
        "render scene.xml --photons 1000 --passes {passes} -o x.exr --checkpoint x.ck --json"
    ));
    assert!(events(&output.stdout).contains(&place), "{}", text(&output.stdout));
    let said = text(&output.stderr);
    assert!(said.contains(" at \"white\"\n") && said.contains("first occurrence: in pass "), "{said}");
    assert!(folder.exr("x.exr").0.pixels.iter().all(|c| c.is_finite()));
    // Its places are not in the checkpoint.
    let said = folder.fails(1, &format!("{RENDER} --strict -o y.exr --resume x.ck"));
    assert!(
        said.contains("x.ck: the passes of this checkpoint have left out ") && said.contains("--strict"),
        "{said}"
    );
    // A render without such values is what it is, strict or not.
    folder.write("scene.xml", SCENE);
    folder.done("render scene.xml --photons 1000 --passes 3 -o plain.exr");
    folder.done("render scene.xml --photons 1000 --passes 3 -o strict.exr --strict");
    assert!(folder.bytes("plain.exr") == folder.bytes("strict.exr"));
}

#[test]
fn a_value_that_is_not_finite_in_the_first_pass_leaves_no_image() {
    let folder = Folder::new("strict-first");
    folder.write("scene.xml", &SCENE.replace("9, 8, 7", "1e32"));
    let said = folder.fails(1, "render scene.xml --photons 1000 --passes 3 --strict -o x.exr");
    assert!(
        said.contains("stopped by --strict: in pass 1 ") && said.contains("No image was written"),
        "{said}"
    );
    assert_eq!(folder.images(), [""; 0]);
}
