//! Files in two roles: what is read is not written over, and two things are not written to one file, whatever names and links say.

use super::*;

const RENDER: &str = "render scene.xml --passes 1 --photons 500";

/// The scene with its gem in a file of its own that it includes, and with a texture.
fn with_files(folder: &Folder) {
    let image = Image::black(2, 2);
    write_exr(&folder.file("wood.exr"), &image, &[], &Metadata::default()).expect("written");
    write_exr(&folder.file("other.exr"), &image, &[], &Metadata::default()).expect("written");
    let texture = r#"<bsdf type="diffuse"><texture type="bitmap" name="reflectance">
        <string name="filename" value="wood.exr"/></texture></bsdf>"#;
    let shape = format!("<scene version=\"3.0.0\"><shape type=\"sphere\">{texture}</shape></scene>");
    folder.write("part.xml", &shape);
    let whole = SCENE.replace("</scene>", "<include filename=\"part.xml\"/></scene>");
    folder.write("scene.xml", &whole);
}

/// All files with their bytes.
fn contents(folder: &Folder) -> Vec<(PathBuf, Vec<u8>)> {
    let entries = fs::read_dir(&folder.0).expect("there").map(|entry| entry.expect("an entry").path());
    let mut all: Vec<_> = entries.filter_map(|path| Some((path.clone(), fs::read(path).ok()?))).collect();
    all.sort();
    all
}

/// Each is refused with these words, and nothing is touched.
fn refused(folder: &Folder, cases: &[(i32, &str, &str)]) {
    let before = contents(folder);
    for (code, arguments, said) in cases {
        let found = folder.fails(*code, arguments);
        assert!(found.contains(said), "foton {arguments}: {found}");
    }
    let names = |files: &[(PathBuf, Vec<u8>)]| files.iter().map(|(path, _)| path.clone()).collect::<Vec<_>>();
    assert_eq!(names(&contents(folder)), names(&before));
    assert!(contents(folder) == before, "every file is as it was");
}

#[test]
fn outputs_are_not_each_other() {
    let folder = Folder::new("roles-outputs");
    folder.write("old.ck", "a checkpoint");
    fs::hard_link(folder.file("old.ck"), folder.file("old.exr")).expect("a link");
    let render = |arguments: &str| format!("{RENDER} {arguments}");
    let each = "one would be written over the other; give each a file of its own";
    refused(
        &folder,
        &[
            (
                2,
                &render("-o x.exr --checkpoint ./x.exr"),
                &format!("-o x.exr and --checkpoint ./x.exr are the same file: {each}"),
            ),
            (2, &render("-o old.exr --checkpoint old.ck"), "-o old.exr and --checkpoint old.ck are the same"),
            (
                2,
                &render("-o x.exr --every pow2 --checkpoint x-000004.exr"),
                "--every x-000004.exr and --checkpoint x-000004.exr are the same file",
            ),
            (
                2,
                &render("-o x.exr --every 3 --checkpoint ./x-000012.exr"),
                "--every x-000012.exr and --checkpoint ./x-000012.exr are the same file",
            ),
        ],
    );
    // Nothing comes after five passes of pow2.
    folder.done(&render("-o x.exr --every pow2 --checkpoint x-000005.exr"));
}

#[test]
fn outputs_are_not_inputs() {
    let folder = Folder::new("roles-inputs");
    with_files(&folder);
    folder.done("render scene.xml --passes 1 --photons 500 -o a.exr --checkpoint a.ck");
    fs::copy(folder.file("a.exr"), folder.file("b.exr")).expect("copied");
    fs::copy(folder.file("wood.exr"), folder.file("x-000002.exr")).expect("copied");
    folder.write("numbered.xml", &SCENE.replace("gem.obj", "./gem.obj"));
    let render = |arguments: &str| format!("{RENDER} {arguments}");
    let over = "what is read would be written over; write to another file";
    refused(
        &folder,
        &[
            (
                2,
                &render("-o x.exr --checkpoint ./scene.xml"),
                &format!("--checkpoint ./scene.xml and the scene scene.xml are the same file: {over}"),
            ),
            (2, &render("-o a.exr --resume ./a.exr"), "-o a.exr and --resume ./a.exr are the same file"),
            (1, &render("-o wood.exr"), "-o wood.exr and the scene's file wood.exr are the same file"),
            (
                1,
                &render("-o x.exr --checkpoint gem.obj"),
                "--checkpoint gem.obj and the scene's file gem.obj",
            ),
            (
                1,
                &render("-o x.exr --checkpoint part.xml"),
                "--checkpoint part.xml and the scene's file part.xml",
            ),
            (2, "compare a.exr b.exr -o b.exr", "-o b.exr and the reference B b.exr are the same file"),
            (2, "compare a.exr b.exr -o ./a.exr", "-o ./a.exr and the image A a.exr are the same file"),
            (2, "compare a.exr a.exr -o a.exr", "are the same file"),
            (
                2,
                "convert scene.xml scene.xml",
                "the output scene.xml and the scene scene.xml are the same file",
            ),
            (1, "convert scene.xml part.xml", "the output part.xml and the scene's file part.xml"),
        ],
    );
    // The same twice is no clash where both are read, and a checkpoint may go on in its own file.
    folder.done("compare a.exr a.exr");
    folder.done("compare a.exr b.exr -o c.exr");
    folder.done("render scene.xml --photons 500 -o x.exr --resume a.ck --checkpoint a.ck --passes 2");
    assert_eq!(folder.exr("x.exr").1.get("foton:passes"), Some("2"));
    folder.done("render scene.xml --photons 500 -o x.exr --resume a.ck --passes 3");
    assert_eq!(folder.exr("x.exr").1.get("foton:passes"), Some("3"));
}

#[test]
fn images_on_the_way_are_not_textures() {
    let folder = Folder::new("roles-every");
    with_files(&folder);
    fs::rename(folder.file("wood.exr"), folder.file("x-000002.exr")).expect("ours");
    let part = text(&folder.bytes("part.xml")).replace("wood.exr", "x-000002.exr");
    folder.write("part.xml", &part);
    let said = "--every x-000002.exr and the scene's file x-000002.exr are the same file";
    refused(
        &folder,
        &[
            (1, &format!("{RENDER} -o x.exr --every pow2"), said),
            (1, &format!("{RENDER} -o x.exr --every 1"), said),
        ],
    );
    folder.done(&format!("{RENDER} -o x.exr --every 3"));
}

/// Names differ, files do not.
#[cfg(unix)]
#[test]
fn links_hide_nothing() {
    use std::os::unix::fs::symlink;
    let folder = Folder::new("roles-links");
    with_files(&folder);
    folder.done(&format!("{RENDER} -o a.exr --checkpoint a.ck"));
    fs::create_dir(folder.file("sub")).expect("a folder");
    for (target, link) in [
        ("scene.xml", "to-scene.ck"),
        ("../gem.obj", "sub/to-gem.ck"),
        ("to-wood.exr", "chain.exr"),
        ("wood.exr", "to-wood.exr"),
        ("a.exr", "to-a.exr"),
        ("sub", "door"),
        ("new.exr", "sub/dangling.exr"),
        ("other.exr", "y-000001.exr"),
    ] {
        symlink(target, folder.file(link)).expect("a link");
    }
    fs::hard_link(folder.file("part.xml"), folder.file("hard.xml")).expect("a link");
    fs::hard_link(folder.file("wood.exr"), folder.file("hard.exr")).expect("a link");
    let render = |arguments: &str| format!("{RENDER} {arguments}");
    let same = "are the same file";
    refused(
        &folder,
        &[
            (
                2,
                &render("-o x.exr --checkpoint to-scene.ck"),
                "--checkpoint to-scene.ck and the scene scene.xml",
            ),
            (
                1,
                &render("-o x.exr --checkpoint sub/to-gem.ck"),
                "--checkpoint sub/to-gem.ck and the scene's file",
            ),
            (1, &render("-o x.exr --checkpoint door/to-gem.ck"), same),
            (1, &render("-o chain.exr"), "-o chain.exr and the scene's file wood.exr are the same file"),
            (1, &render("-o hard.exr"), "-o hard.exr and the scene's file wood.exr are the same file"),
            (1, "convert scene.xml hard.xml", "the output hard.xml and the scene's file part.xml"),
            (2, "compare other.exr a.exr -o to-a.exr", "-o to-a.exr and the reference B a.exr"),
            (2, &render("-o door/new.exr --checkpoint sub/dangling.exr"), same),
            (
                2,
                &render("-o y.exr --every 1 --checkpoint other.exr"),
                "--every y-000001.exr and --checkpoint other.exr",
            ),
        ],
    );
}

/// What `foton measure` writes has names of its own, among which an input may be.
#[test]
fn a_sweep_writes_over_none_of_its_inputs() {
    let folder = Folder::new("roles-measure");
    with_files(&folder);
    fs::create_dir_all(folder.file("dir/images")).expect("a folder");
    fs::create_dir_all(folder.file("dir/parts")).expect("a folder");
    for to in ["dir/reference.exr", "dir/images/wood.exr"] {
        fs::copy(folder.file("wood.exr"), folder.file(to)).expect("copied");
    }
    fs::copy(folder.file("gem.obj"), folder.file("dir/gem.obj")).expect("copied");
    folder.write("dir/summary.csv", SCENE);
    folder.write("dir/parts/00000500-runs.csv", GEM);
    let scene = |gem: &str| SCENE.replace("gem.obj", gem);
    folder.write("dir/part.xml", &scene("parts/00000500-runs.csv"));
    refused(
        &folder,
        &[
            (
                2,
                "measure dir/summary.csv -o dir",
                "-o with its dir/summary.csv and the scene dir/summary.csv",
            ),
            (
                2,
                "measure scene.xml -o ./scene.xml",
                "-o ./scene.xml and the scene scene.xml are the same file",
            ),
            (1, "measure scene.xml -o gem.obj", "-o gem.obj and the scene's file gem.obj are the same file"),
            (1, "measure scene.xml -o other.exr", "other.exr: not a directory"),
            (
                1,
                "measure dir/part.xml -o dir",
                "-o with its dir/parts/00000500-runs.csv and the scene's file",
            ),
        ],
    );
    assert_eq!(text(&folder.bytes("dir/summary.csv")), SCENE);
    assert_eq!(text(&folder.bytes("dir/parts/00000500-runs.csv")), GEM);
}

/// A scene that was converted before reads meshes by the very names that converting it again would write.
#[test]
fn converting_writes_over_no_mesh_that_the_scene_reads() {
    let folder = Folder::new("roles-convert");
    folder.done("convert scene.xml out.xml");
    let meshes = |folder: &Folder| {
        let entries = fs::read_dir(folder.file("meshes")).expect("meshes");
        let mut names: Vec<_> =
            entries.map(|e| e.expect("an entry").file_name().into_string().expect("text")).collect();
        names.sort();
        names
    };
    let first = meshes(&folder);
    let [mesh] = &first[..] else { panic!("{first:?}") };
    // Its own mesh by its own name, but another scene.
    folder.write("in.xml", &text(&folder.bytes("out.xml")));
    let mesh = format!("meshes/{mesh}");
    let marked = [&folder.bytes(&mesh)[..], b"\n"].concat();
    fs::write(folder.file(&mesh), &marked).expect("written");
    folder.done("convert in.xml out.xml");
    assert!(folder.bytes(&mesh) == marked, "the mesh that was read is as it was");
    assert_eq!(meshes(&folder).len(), 2);
    folder.done(&RENDER.replace("scene.xml", "out.xml -o x.exr"));
}

#[test]
fn a_frame_log_replaces_no_other_file() {
    let folder = Folder::new("roles-log");
    let said = folder.fails(2, "scene.xml --frame-log ./scene.xml");
    assert!(said.contains("--frame-log ./scene.xml and the scene scene.xml are the same file"), "{said}");
    assert_eq!(text(&folder.bytes("scene.xml")), SCENE);
}

/// The shell has opened it already.
#[cfg(unix)]
#[test]
fn standard_output_is_no_file_that_is_read_or_written() {
    let folder = Folder::new("roles-streams");
    with_files(&folder);
    let run = |to: &str, arguments: &str| {
        let file = fs::OpenOptions::new().append(true).create(true).open(folder.file(to)).expect("opened");
        let output = folder.command(arguments).stdout(file).output().expect("starts");
        (output.status.code(), text(&output.stderr))
    };
    let before = contents(&folder);
    for (to, code, arguments, said) in [
        ("scene.xml", 2, "info scene.xml", "standard output goes into the scene scene.xml"),
        ("gem.obj", 1, "info scene.xml --json", "standard output goes into the scene's file gem.obj"),
        ("other.exr", 2, "compare wood.exr wood.exr -o other.exr", "standard output goes into -o other.exr"),
        (
            "other.exr",
            2,
            "render scene.xml --passes 1 -o other.exr --json",
            "standard output goes into -o other.exr",
        ),
    ] {
        let (found, words) = run(to, arguments);
        assert!(found == Some(code) && words.contains(said), "foton {arguments} > {to}: {words}");
    }
    assert!(contents(&folder) == before, "every file is as it was");
    assert_eq!(run("log.txt", "info scene.xml").0, Some(0));
    // Where nothing is printed, an image may be meant to go there.
    std::os::unix::fs::symlink("/dev/stdout", folder.file("out.exr")).expect("a link");
    let (code, said) = run("y.exr", "render scene.xml --passes 1 --photons 500 -o out.exr");
    assert!(code == Some(0) && folder.exr("y.exr").0.width > 0, "{said}");
}
