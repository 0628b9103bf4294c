//! What a file of a stranger may not do: be read without end, take all memory or time, or have another file's content told.

use std::io;
use std::path::{Path, PathBuf};
use std::sync::mpsc;
use std::time::Duration;

use foton_format::{Options, open, read_str};
use foton_input::is_printable;

use super::png;

/// What a scene may say to have a file read, each with `FILE` for its name.
const WAYS: [&str; 8] = [
    "<include filename='FILE'/>",
    "<shape type='obj'><string name='filename' value='FILE'/></shape>",
    "<shape type='ply'><string name='filename' value='FILE'/></shape>",
    "<shape type='stl'><string name='filename' value='FILE'/></shape>",
    "<shape type='serialized'><string name='filename' value='FILE'/></shape>",
    "<texture type='bitmap'><string name='filename' value='FILE'/></texture>",
    "<emitter type='envmap'><string name='filename' value='FILE'/></emitter>",
    "<bsdf type='diffuse'><spectrum name='reflectance' filename='FILE'/></bsdf>",
];

fn scene(inside: &str) -> String {
    format!("<scene version='3.0.0'><sensor type='perspective'/>{inside}</scene>")
}

fn messages(xml: &str, files: &dyn Fn(&Path) -> io::Result<Vec<u8>>, options: &Options) -> Vec<String> {
    let found = match read_str("s.xml", xml, files, options) {
        Ok(opened) => opened.warnings,
        Err(error) => error.diagnostics().to_vec(),
    };
    found.iter().map(ToString::to_string).collect()
}

fn no_files(_: &Path) -> io::Result<Vec<u8>> {
    Err(io::ErrorKind::NotFound.into())
}

/// What a scene says within a minute; reading it takes far less, or for ever.
fn soon(what: &str, say: impl FnOnce() -> Vec<String> + Send + 'static) -> Vec<String> {
    let (sender, receiver) = mpsc::channel();
    std::thread::spawn(move || sender.send(say()));
    receiver.recv_timeout(Duration::from_secs(60)).unwrap_or_else(|_| panic!("{what} is still being read"))
}

/// A folder with files of ours; it is removed when it is dropped.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("foton-strangers-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        Self(folder)
    }

    fn file(&self, name: &str, contents: impl AsRef<[u8]>) -> PathBuf {
        let path = self.0.join(name);
        std::fs::write(&path, contents).expect("a file");
        path
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

#[test]
fn no_message_tells_what_stands_in_a_file_of_another_kind() {
    let secrets = [
        "PASSWORD=hunter2\0HOME=/home/hunter2\0",
        "root:x:0:0:hunter2:/root:/bin/sh\nhunter2:hunter2\n",
        "hunter2",
        "hunter2 hunter2\nhunter2",
        "hunter2 1\n2 hunter2\n",
        "# a comment\nhunter2 = 7\n",
        "f hunter2 hunter2\nhunter2 = 5\n",
        "v hunter2 1 2\nhunter2: 5\nvt hunter2",
        "{\"password\": \"hunter2\"}",
        "<hunter2/>",
        "<hunter2><a>hunter2</b></hunter2>",
        "<!-- -->\n<config>&hunter2;</config>",
        "<?xml version='1.0'?><config hunter2='1' hunter2='2'/>",
        "\u{feff}[hunter2]\n",
        "ply hunter2\nformat hunter2\n",
        "solidhunter2 is none",
        "\n\n\n\nhunter2\n                                                                                hunter2hunter2hunter2",
    ];
    for secret in secrets {
        for way in WAYS {
            let files = |_: &Path| Ok(secret.as_bytes().to_vec());
            let said = messages(&scene(&way.replace("FILE", "secret")), &files, &Options::default());
            assert!(!said.is_empty(), "{way} of {secret:?} is read as if it were one");
            // The four bytes that a binary STL file has for its number, as a number.
            let number = u32::from_le_bytes(*b"hunt").to_string();
            for word in ["hunter2", "HOME", "config", &number] {
                assert!(!said.concat().contains(word), "{way} of {secret:?}: {said:?}");
            }
        }
        let folder = Folder::new("materials");
        folder.file("secret", secret);
        let model = folder.file("model.obj", "mtllib secret\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n");
        let said = open(&model, &Options::default()).expect("a model").warnings;
        let said: String = said.iter().map(|d| format!("{d}\n")).collect();
        assert!(said.contains("secret has no materials") && !said.contains("hunter2"), "{secret:?}: {said}");
        for extension in ["xml", "obj", "ply", "stl"] {
            let path = folder.file(&format!("secret.{extension}"), secret);
            let error = open(&path, &Options::default()).expect_err("no scene").to_string();
            let told = error.contains("hunter2") && extension != "xml";
            assert!(!told && error.len() < 1000, "{extension} of {secret:?}: {error}");
        }
    }
}

/// A long word with all that a terminal or a reader can be misled by; XML does not allow escape itself.
fn nasty(xml: bool) -> String {
    let escape = if xml { "" } else { "\u{1b}]0;title\u{7}\u{1b}[2J" };
    format!("a{escape}\u{9b}31m\u{202e}\u{2066}\u{200b}\u{2028}{}", "long".repeat(100_000))
}

#[test]
fn whatever_a_message_quotes_is_short_and_printable() {
    let word = nasty(true);
    let tag = "x".repeat(100_000);
    let templates = [
        "<bsdf type='WORD'/>",
        "<shape type='sphere'><float name='WORD' value='1'/></shape>",
        "<shape type='sphere'><float name='radius' value='WORD'/></shape>",
        "<shape type='sphere'><float name='radius' value='1' TAG='2'/></shape>",
        "<shape type='sphere'><integer name='radius' value='1'/><ref id='WORD'/></shape>",
        "<shape type='sphere'><boolean name='flip_normals' value='WORD'/></shape>",
        "<shape type='sphere'><point name='center' value='WORD'/></shape>",
        "<shape type='sphere'><TAG/></shape>",
        "<shape type='sphere'><float name='radius' value='1'><TAG/></float></shape>",
        "<shape type='sphere'><transform name='to_world'><TAG/></transform></shape>",
        "<bsdf type='diffuse' id='WORD'/><bsdf type='diffuse' id='WORD'/>",
        "<alias id='WORD' as='b'/>",
        "<bsdf type='diffuse'><rgb name='reflectance' value='#WORD'/></bsdf>",
        "<bsdf type='diffuse'><srgb name='reflectance' value='WORD'/></bsdf>",
        "<bsdf type='diffuse'><spectrum name='reflectance' value='1:WORD'/></bsdf>",
        "<bsdf type='diffuse'><spectrum name='reflectance' value='1:2 WORD'/></bsdf>",
        "<bsdf type='dielectric'><string name='int_ior' value='WORD'/></bsdf>",
        "<bsdf type='conductor'><string name='material' value='WORD'/></bsdf>",
        "<bsdf type='roughconductor'><string name='distribution' value='WORD'/></bsdf>",
        "<texture type='bitmap'><string name='filter_type' value='WORD'/></texture>",
        "<texture type='bitmap'><string name='filename' value='WORD'/></texture>",
        "<shape type='obj'><string name='filename' value='WORD'/></shape>",
        "<bsdf type='diffuse'><spectrum name='reflectance' filename='WORD'/></bsdf>",
        "<include filename='WORD'/>",
        "<include filename='WORD' TAG='1'/>",
        "<sensor type='perspective'><string name='focal_length' value='WORD'/></sensor>",
        "<float name='a' value='$TAG'/>",
        "<TAG></x>",
        "<a>&TAG;</a>",
        "<a TAG='1' TAG='2'/>",
        "<TAG:a/>",
    ];
    for template in templates {
        let xml = scene(&template.replace("WORD", &word).replace("TAG", &tag));
        let said = messages(&xml, &no_files, &Options::default());
        assert!(!said.is_empty(), "{template}");
        for message in said {
            assert!(message.chars().count() < 500, "{template}: {} characters", message.len());
            assert!(message.chars().all(is_printable), "{template}: {message:?}");
        }
    }
    let define = Options { defines: vec![(nasty(false), nasty(false))], ..Options::default() };
    let said = messages(&scene(""), &no_files, &define).concat();
    assert!(
        said.starts_with("s.xml: -D a\\u{1b}]0;title") && said.len() < 200 && said.chars().all(is_printable),
        "{said:?}"
    );
}

#[test]
fn meshes_and_their_materials_quote_what_is_short_and_printable() {
    let folder = Folder::new("quotes");
    let word = nasty(false);
    folder.file("m.mtl", format!("newmtl {word}\nKd {word}\nd {word}\nmap_Kd {word}\nmap_{word} 1\nillum 4\nNi 1\nnewmtl b\nTr {word}\n"));
    let good = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (name, contents) in [
        ("a.obj", format!("{good}f 1 2 {word}\nv {word}\nf 1/{word} 2 3\n")),
        (
            "b.obj",
            format!(
                "mtllib m.mtl\nmtllib {word}\n{good}usemtl {word}\nf 1 2 3\nusemtl gone{word}\nf 3 2 1\n"
            ),
        ),
        ("c.ply", format!("ply\nformat {word} 1.0\n")),
        ("d.ply", format!("ply\nformat ascii 1.0\nelement vertex 1\nproperty {word} x\n")),
        ("e.ply", format!("ply\nformat ascii 1.0\nelement {word} 1\nelement {word} 1\n")),
        ("f.ply", format!("ply\n{word}\n")),
        (
            "g.ply",
            format!(
                "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n1 2 {word}\n3 0 0 0\n"
            ),
        ),
        (
            "h.ply",
            format!(
                "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nelement {word} 99999999\nproperty int a\nend_header\n1 2 3\n3 0 0 0\n"
            ),
        ),
        ("i.stl", format!("solid s\nfacet\nouter loop\nvertex 0 0 {word}\n")),
        ("j.stl", format!("solid s\n{word}\n")),
    ] {
        let path = folder.file(name, contents);
        let found = match open(&path, &Options::default()) {
            Ok(opened) => {
                for shape in &opened.description.shapes {
                    assert!(
                        shape.name.chars().count() < 2500 && shape.name.chars().all(is_printable),
                        "{:?}",
                        shape.name
                    );
                }
                opened.warnings
            }
            Err(error) => error.diagnostics().to_vec(),
        };
        assert!(!found.is_empty(), "{name}");
        for message in found.iter().map(ToString::to_string) {
            assert!(
                message.chars().count() < 700,
                "{name}: {} characters: {}",
                message.len(),
                &message[..400]
            );
            assert!(message.chars().all(is_printable), "{name}: {message:?}");
        }
    }
}

#[test]
fn names_of_a_scene_are_printable_and_still_differ() {
    let word = nasty(true);
    let xml = scene(&format!(
        "<shape type='sphere' id='{word}1'/><shape type='sphere' id='{word}2'/><shape type='cube' id='größe'/>"
    ));
    let opened = read_str("s.xml", &xml, &no_files, &Options::default()).expect("a scene");
    let names: Vec<_> = opened.description.shapes.iter().map(|s| s.name.as_str()).collect();
    assert!(names.iter().all(|name| name.len() < 1000 && name.chars().all(is_printable)), "{names:?}");
    assert!(names[0] != names[1] && names[2] == "größe", "{names:?}");
}

#[test]
fn very_many_problems_are_counted_and_not_listed() {
    let said = soon("a scene of errors", || {
        let wrong = "<shape type='x' id='a'><bsdf type='y'><ref id='c'/></bsdf></shape>".repeat(50_000);
        messages(&scene(&wrong), &no_files, &Options::default())
    });
    assert_eq!(said.len(), 1001);
    assert!(said[1000].starts_with("s.xml: ") && said[1000].ends_with(" more errors"), "{}", said[1000]);
}

#[cfg(unix)]
#[test]
fn what_is_no_file_is_refused_wherever_a_scene_names_it() {
    let folder = Folder::new("kinds");
    let pipe = folder.0.join("pipe");
    assert!(std::process::Command::new("mkfifo").arg(&pipe).status().expect("mkfifo").success());
    let socket = folder.0.join("socket");
    let _listener = std::os::unix::net::UnixListener::bind(&socket).expect("a socket");
    let kinds = [
        ("/dev/zero".into(), "it is a device"),
        (pipe.display().to_string(), "it is a pipe"),
        (socket.display().to_string(), "it is a socket"),
        (folder.0.display().to_string(), "it is a folder"),
        (
            "/proc/self/environ".into(),
            if cfg!(target_os = "linux") { "it is a file of the kernel" } else { "cannot read" },
        ),
    ];
    for (name, kind) in &kinds {
        for way in WAYS {
            let path = folder.file("scene.xml", scene(&way.replace("FILE", name)));
            let said = soon(&format!("{way} of {name}"), move || {
                vec![open(&path, &Options::default()).expect_err("refused").to_string()]
            });
            assert!(said[0].contains(kind), "{way} of {name}: {said:?}");
        }
        // What cannot be read of materials is a warning.
        let model = folder.file("model.obj", format!("mtllib {name}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
        let said = soon(&format!("mtllib {name}"), move || {
            let opened = open(&model, &Options::default()).expect("a model");
            opened.warnings.iter().map(ToString::to_string).collect()
        });
        let said = said.concat();
        assert!(said.contains(kind), "mtllib {name}: {said:?}");
    }
}

#[cfg(unix)]
#[test]
fn a_scene_that_the_user_names_may_come_from_a_pipe() {
    let folder = Folder::new("pipes");
    for (name, contents) in [
        ("scene", scene("<shape type='sphere'/>")),
        ("model.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n".to_owned()),
    ] {
        let pipe = folder.0.join(name);
        assert!(std::process::Command::new("mkfifo").arg(&pipe).status().expect("mkfifo").success());
        let writer = std::thread::spawn({
            let pipe = pipe.clone();
            move || std::fs::write(pipe, contents)
        });
        assert!(
            open(&pipe, &Options::default()).is_ok_and(|opened| !opened.description.shapes.is_empty()),
            "{name}"
        );
        writer.join().expect("no panic").expect("written");
    }
}

/// Options with so many MiB.
fn within(mebibytes: u64) -> Options {
    Options { memory: Some(mebibytes << 20), ..Options::default() }
}

#[test]
fn small_files_that_stand_for_much_are_refused_by_the_memory_that_they_take() {
    let mesh: String = (0..2000).map(|i| format!("v {i} 0 {}\nv {i} 1 0\n", i % 2)).collect();
    let faces: String = (1..3999).map(|i| format!("f {i} {} {}\n", i + 1, i + 2)).collect();
    let mesh = mesh + &faces;
    let files = move |path: &Path| match path.to_str() {
        Some("flat.png") => {
            let mut bytes = Vec::new();
            let image = image::GrayImage::new(8000, 8000);
            image.write_to(&mut io::Cursor::new(&mut bytes), image::ImageFormat::Png).expect("written");
            Ok(bytes)
        }
        Some("wide.png") => Ok(png(16_000)),
        Some("mesh.obj") => Ok(mesh.clone().into_bytes()),
        Some("twice.xml") => {
            Ok(format!("<scene version='3.0.0'>{}</scene>", "<shape type='cube'/>".repeat(5000)).into_bytes())
        }
        _ => no_files(path),
    };
    let texture = "<texture type='bitmap'><string name='filename' value='flat.png'/></texture>";
    let said = messages(&scene(texture), &files, &within(64));
    assert_eq!(
        said,
        [
            "s.xml:1:106: cannot read flat.png: reading it takes up to 977 MiB with what was read before, 64 MiB may be used"
        ]
    );
    // A mesh without normals is another for each transform.
    let shape = |i: usize| {
        format!(
            "<shape type='obj'><transform name='to_world'><scale x='{i}'/></transform><string name='filename' value='mesh.obj'/></shape>\n"
        )
    };
    let shapes = |n: usize| (1..=n).map(shape).collect::<String>();
    let said = messages(&scene(&shapes(1000)), &files, &within(64));
    assert!(
        said[0].contains("cannot make one more mesh of this file: reading it takes up to 64 MiB with"),
        "{}",
        said[0]
    );
    assert_eq!(messages(&scene(&shapes(10)), &files, &within(64)), [""; 0]);
    assert_eq!(messages(&scene(&shape(2).repeat(1000)), &files, &within(64)), [""; 0]);
    let said = messages(&scene(&"<include filename='twice.xml'/>\n".repeat(100)), &files, &within(64));
    assert!(said.iter().any(|s| s.contains("with what was read before, 64 MiB may be used")), "{said:?}");
    let said = messages(&scene(&"<shape type='cube'/>".repeat(200_000)), &files, &within(64));
    assert_eq!(said, ["s.xml: reading it takes up to 228 MiB, 64 MiB may be used"]);
}

#[test]
fn elements_with_very_many_attributes_or_values_are_read_soon_or_refused() {
    let many = |what: fn(usize) -> String| (0..100_000).map(what).collect::<String>();
    let attributes = scene(&format!("<shape type='cube' {}/>", many(|i| format!("a{i}='' "))));
    let said = soon("many attributes", move || messages(&attributes, &no_files, &Options::default()));
    assert_eq!(said, ["s.xml:1:52: an element has more than 1000 attributes"]);
    let spaces = scene(&many(|i| format!("<a xmlns:b{i}='c{i}'/>")));
    let said = soon("many name spaces", move || messages(&spaces, &no_files, &Options::default()));
    assert_eq!(said, ["s.xml:1:1: more than 64 name spaces are declared"]);
    let values =
        scene(&format!("<shape type='cube'>{}</shape>", many(|i| format!("<float name='a{i}' value='1'/>"))));
    assert_eq!(soon("many values", move || messages(&values, &no_files, &Options::default())).len(), 1001);
    let paths = scene(&many(|i| format!("<path value='{i}'/>")));
    let said = soon("many paths", move || messages(&paths, &no_files, &Options::default()));
    assert!(said[0].ends_with("files are looked for in 64 folders already"), "{}", said[0]);
}

#[test]
fn files_of_materials_are_read_once_and_their_names_are_bounded() {
    let folder = Folder::new("libraries");
    folder.file("m.mtl", "newmtl a\nKd 1 0 0\n".repeat(20_000));
    let lines = "mtllib m.mtl\n".repeat(20_000) + "mtllib" + &" word".repeat(200_000) + "\n";
    let path = folder.file("model.obj", lines + "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n");
    let said = soon("many libraries", move || {
        let opened = open(&path, &Options::default()).expect("a model");
        opened.warnings.iter().map(ToString::to_string).collect()
    });
    assert!(said.iter().any(|s| s.contains("are too long: their materials are grey")), "{said:?}");
}
