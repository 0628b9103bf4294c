//! All cameras of a scene in one go.

use super::*;

#[test]
fn all_cameras_are_rendered_in_one_go_with_photons_that_they_share() {
    let folder = Folder::new("all-cameras");
    let render = "render scene.xml --passes 3 --photons 2000 --guide off";
    let said = folder.done(&format!("{render} -o x.exr --sensor all"));
    assert_eq!(folder.images(), ["x-from-above.exr", "x-front.exr"]);
    assert!(text(&said.stderr).contains("camera from above: 3 passes"), "{}", text(&said.stderr));
    for (sensor, image) in [("front", "x-front.exr"), ("from above", "x-from-above.exr")] {
        let mut alone = folder.command(&format!("{render} -o alone.exr --sensor"));
        assert!(alone.arg(sensor).output().is_ok_and(|o| o.status.success()));
        let ((all, metadata), (one, own)) = (folder.exr(image), folder.exr("alone.exr"));
        assert!(all == one, "{sensor}: unguided photons are those of a render of its own");
        assert_eq!(metadata.get("foton:settings"), own.get("foton:settings"));
        assert_eq!(metadata.get("foton:cameras"), Some("front, from above"));
        assert_eq!(own.get("foton:cameras"), None);
    }
    // Guided to what both see, they are others, on any number of threads the same.
    let guided = "render scene.xml --passes 3 --photons 2000 --sensor all";
    folder.done(&format!("{guided} -o a.exr --threads 1"));
    folder.done(&format!("{guided} -o b.exr --threads 3"));
    for name in ["front", "from-above"] {
        assert!(folder.bytes(&format!("a-{name}.exr")) == folder.bytes(&format!("b-{name}.exr")), "{name}");
    }
    assert!(folder.exr("a-front.exr").0 != folder.exr("x-front.exr").0);
}

#[test]
fn a_method_without_photons_renders_one_camera_after_the_other() {
    let folder = Folder::new("cameras-by-path");
    folder.done("render scene.xml -o x.png --passes 2 --integrator path --sensor all");
    assert_eq!(folder.images(), ["x-from-above.png", "x-front.png"]);
}

#[test]
fn what_is_of_one_camera_is_refused_beside_all() {
    let folder = Folder::new("cameras-refused");
    for option in [
        "--checkpoint x.ck",
        "--resume x.ck",
        "--every 2",
        "--region 0,0,4,4",
        "--integrator all",
        "--strict",
    ] {
        let said = folder.fails(2, &format!("render scene.xml -o x.exr --passes 1 --sensor all {option}"));
        let name = option.split(' ').next().expect("a word");
        assert!(said.contains(name) && said.contains("of a render by one camera"), "{said}");
    }
    // No image goes over what the scene reads.
    folder.write("gem-front.exr", GEM);
    folder.write("other.xml", &SCENE.replace("gem.obj", "gem-front.exr"));
    let said = folder.fails(1, "render other.xml -o gem.exr --passes 1 --sensor all");
    assert!(said.contains("gem-front.exr are the same file"), "{said}");
    // A camera of that name is that camera.
    folder.write("named.xml", &SCENE.replace("id=\"front\"", "id=\"all\""));
    folder.done("render named.xml -o one.exr --passes 1 --photons 500 --sensor all");
    assert!(folder.file("one.exr").exists());
}
