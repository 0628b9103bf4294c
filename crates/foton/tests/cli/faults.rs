//! Faults of our own, made to happen, and what is left after them.

use super::*;

/// Programs built without debug assertions cannot be made to fail, and have nothing to show here.
#[test]
fn a_fault_in_a_pass_saves_the_image_of_the_passes_before() {
    let folder = Folder::new("fault");
    let render = "render scene.xml --photons 500 --threads 3 -o";
    let two = folder.done(&format!("{render} two.exr --passes 2"));
    assert!(two.status.success());
    let three = folder.done(&format!("{render} three.exr --passes 3"));
    assert!(three.status.success());
    let fails = |fault: &str, output: &str| {
        let arguments = format!(
            "{render} {output} --passes 9 --checkpoint {output}.ck --checkpoint-every 0.001ms --json"
        );
        let failed = folder.command(&arguments).env("FOTON_FAULT", fault).output().expect("starts");
        assert_eq!(failed.status.code(), Some(1), "{fault}");
        let last = events(&failed.stdout).pop().expect("an event");
        assert_eq!(last["event"], "error");
        last["message"].as_str().expect("a message").to_owned()
    };
    for stage in ["trace", "sort", "gather"] {
        let said = fails(&format!("0:{stage}:3"), "part.exr");
        assert_eq!(
            said,
            format!(
                "foton has a fault and the render stops, in its stage \"{stage}\": FOTON_FAULT asked for this. What was written is \
                 the image after 2 complete passes"
            )
        );
        assert!(folder.exr("part.exr").0 == folder.exr("two.exr").0, "{stage}: the image of two passes");
        fs::remove_file(folder.file("part.exr")).expect("written");
    }
    // While a pass is added to the pixels there is no whole image, and before the first there is none at all.
    for fault in ["0:radiance:3", "0:eye_pass:0", "0:trace:1"] {
        let said = fails(fault, "none.exr");
        assert!(said.contains("FOTON_FAULT asked") && !folder.file("none.exr").exists(), "{fault}: {said}");
        if fault == "0:radiance:3" {
            fs::rename(folder.file("none.exr.ck"), folder.file("radiance.ck")).expect("there");
        }
    }
    // The checkpoint is that of two passes, and not of hit points that have the third.
    folder.done(&format!("{render} rest.exr --passes 3 --resume radiance.ck"));
    assert!(folder.exr("rest.exr").0 == folder.exr("three.exr").0);
}
