//! What is refused, and what comes of a fault: exit codes, words, and nothing half-written.

use super::*;

#[test]
fn an_unknown_sensor_is_refused_with_the_known_names() {
    let folder = Folder::new("sensor");
    let said = folder.fails(1, "render scene.xml -o x.exr --passes 1 --sensor back");
    assert!(["\"back\"", "\"front\"", "\"from above\""].iter().all(|name| said.contains(name)), "{said}");
    assert_eq!(folder.images(), [""; 0]);
}

#[test]
fn a_bad_scene_is_refused_with_the_place_in_the_file() {
    let folder = Folder::new("bad");
    folder.write("scene.xml", &SCENE.replace("type=\"dielectric\"", "type=\"dielectrc\""));
    let line = 1 + SCENE.lines().position(|line| line.contains("dielectric")).expect("glass");
    let said = folder.fails(1, "render scene.xml -o x.exr --passes 1");
    let (_, column) = said.split_once(&format!("scene.xml:{line}:")).unwrap_or_else(|| panic!("{said}"));
    assert!(column.starts_with(|c: char| c.is_ascii_digit()) && said.contains("\"dielectric\""), "{said}");
    let output = folder.run("render scene.xml -o x.exr --passes 1 --json");
    let event = &events(&output.stdout)[0];
    assert_eq!((&event["event"], &event["line"]), (&json!("error"), &json!(line)));
    assert_eq!(event["file"], "scene.xml");
    assert!(number(event, "column") > 1.0 && event["message"].is_string(), "{event}");
    let said = folder.fails(1, "render nowhere.xml -o x.exr");
    assert!(said.contains("nowhere.xml"), "{said}");
    assert_eq!(folder.images(), [""; 0]);
}

#[test]
fn bad_usage_exits_with_2_and_writes_nothing() {
    let folder = Folder::new("usage");
    for arguments in [
        "--alpha 0",
        "--alpha 1.01",
        "--alpha x",
        "--size 0x3",
        "--size 640",
        "--passes 0",
        "--photons 0",
        "--time 0s",
        "--radius -1",
        "--threads 0",
        "--every 0",
        "--layers shadow",
        "--layers direct,direct",
        "--memory much",
        "-D nothing",
        "--integrator bdpt",
        "--frobnicate",
    ] {
        folder.fails(2, &format!("render scene.xml -o x.exr {arguments}"));
    }
    for arguments in ["scene.xml -o x.jpg", "scene.xml -o exr", "scene.xml", "-o x.exr"] {
        folder.fails(2, &format!("render {arguments}"));
    }
    assert_eq!(folder.images(), [""; 0]);
}

/// Options that cannot both be had are refused before anything is rendered, and what would help is said.
#[test]
fn options_that_contradict_each_other_are_refused_at_once() {
    let folder = Folder::new("contradictions");
    let png = "x.png is a PNG, and only an EXR holds layers; write to x.exr instead";
    for (arguments, named) in [
        ("-o x.png --layers direct", png),
        ("-o x.png --layers radius,emission", png),
        ("-o x.exr --layers direct,direct", "--layers names direct twice"),
        ("-o x.exr --layers direct,radius,caustic,radius", "--layers names radius twice"),
        ("-o x.exr --layers shape_id --layers shape_id", "--layers names shape_id twice"),
        ("-o x.exr --layers direct,error_bias --error off", "--layers error_bias: --error off leaves out"),
    ] {
        let said = folder.fails(2, &format!("render scene.xml --passes 1 --photons 500 {arguments}"));
        assert!(said.contains(named), "{arguments}: {said}");
    }
    assert_eq!(folder.images(), [""; 0]);
    assert_eq!(folder.bytes("scene.xml"), SCENE.as_bytes());
    folder.done("render scene.xml --passes 1 --photons 500 -o x.exr --layers direct,error_bias,radius");
}

#[test]
fn a_render_beyond_the_memory_limit_is_refused_with_the_numbers() {
    let folder = Folder::new("memory");
    let said = folder.fails(1, "render scene.xml -o x.exr --passes 1 --memory 1K");
    assert!(said.contains("MiB") && said.contains("--memory"), "{said}");
    assert_eq!(folder.images(), [""; 0]);
    // The first number is the one that the limit is held to, and it is the sum of the others: 16 for the program, what stays,
    // and either photons or what hit points take while they are laid out.
    let numbers = |threads: u32| {
        let said = folder.fails(
            1,
            &format!("render scene.xml -o x.exr --passes 1 --size 128x96 --threads {threads} --memory 20M"),
        );
        assert!(said.contains("; 20 MiB may be used"), "{said}");
        ["about ", "scene ", "hit points ", "(and ", "pixels ", "photons "].map(|name| {
            let (_, rest) = said.split_once(name).unwrap_or_else(|| panic!("{said}"));
            rest.split(|c: char| !c.is_ascii_digit())
                .next()
                .and_then(|n| n.parse::<i64>().ok())
                .expect("a number")
        })
    };
    let [about, scene, hit_points, layout, pixels, photons] = numbers(1);
    let sum = 16 + scene + hit_points + pixels + photons.max(layout);
    assert!((about - sum).abs() <= 3, "{about}, not {sum}");
    // A pilot says that a photon is stored about once in this scene.
    assert!(photons >= 16, "2^18 photons in two copies: {photons}");
    // Each thread sorts with 2^20 counters of its own.
    assert_eq!(numbers(3)[5] - photons, 8);
    let just = |memory: i64| {
        format!("render scene.xml -o x.exr --passes 1 --size 128x96 --threads 1 --memory {memory}M")
    };
    folder.fails(1, &just(about - 1));
    folder.done(&just(about + 1));
}

/// 32,768² pixels are refused before anything is allocated, and so is what 32 bits cannot number however much memory there is.
#[test]
fn huge_images_are_refused_with_the_numbers() {
    let folder = Folder::new("huge");
    let said = folder.fails(1, "render scene.xml -o x.exr --passes 1 --size 32768x32768 --memory 64G");
    assert!(said.contains("65536 MiB may be used") && said.contains("M hit points"), "{said}");
    let said = folder.fails(1, "render scene.xml -o x.exr --passes 1 --size 65536x65536 --memory 900000G");
    assert!(said.contains("4.3 billion pixels") && said.contains("can be numbered"), "{said}");
    assert_eq!(folder.images(), [""; 0]);
}

/// What reading and building take is known before it is taken.
#[test]
fn scenes_that_cannot_be_read_or_built_in_the_memory_given_are_refused() {
    let folder = Folder::new("large");
    // A bumpy field of 2 · 274² triangles: without the refusal it renders in a moment, and the test fails.
    let side = 274;
    let mut mesh = String::new();
    for (i, j) in (0..=side).flat_map(|i| (0..=side).map(move |j| (i, j))) {
        mesh.push_str(&format!("v {i} {} {j}\n", (i * 7 + j * 13) % 5));
    }
    for (i, j) in (0..side).flat_map(|i| (0..side).map(move |j| (i, j))) {
        let (a, b) = (i * (side + 1) + j + 1, (i + 1) * (side + 1) + j + 1);
        mesh.push_str(&format!("f {a} {} {}\nf {a} {} {b}\n", a + 1, b + 1, b + 1));
    }
    fs::write(folder.file("large.obj"), &mesh).expect("written");
    let said = folder.fails(1, "render large.obj -o x.exr --passes 1 --size 8x8 --memory 4M");
    assert!(said.contains("reading it takes up to 14 MiB, 4 MiB may be used"), "{said}");
    let said = folder.fails(1, "render large.obj -o x.exr --passes 1 --size 8x8 --memory 60M");
    assert!(
        said.contains("building this scene takes about 83 MiB; 60 MiB may be used"),
        "150,152 triangles of 444 bytes, 75,625 corners of 48, and 16 MiB: {said}"
    );
    // `foton info` builds the same, for its census and its probe.
    let said = folder.fails(1, "info large.obj --memory 4M");
    assert!(said.contains("reading it takes up to 14 MiB, 4 MiB may be used"), "{said}");
    let said = folder.fails(1, "info large.obj --memory 60M");
    assert!(said.contains("building this scene takes about 83 MiB; 60 MiB may be used"), "{said}");
    assert_eq!(folder.images(), ["large.obj"]);
}

#[test]
fn a_place_that_cannot_be_written_is_refused_before_rendering() {
    let folder = Folder::new("places");
    fs::create_dir(folder.file("folder.exr")).expect("a folder");
    for (output, named) in
        [("missing/x.exr", "missing"), ("folder.exr", "folder.exr"), ("gem.obj/x.png", "gem.obj")]
    {
        let output = folder.run(&format!("render scene.xml -o {output} --passes 3 --photons 500 --json"));
        assert_eq!(output.status.code(), Some(1));
        assert!(text(&output.stderr).contains(named), "{}", text(&output.stderr));
        let events = events(&output.stdout);
        assert_eq!(events.len(), 1, "no pass was rendered: {events:?}");
        assert_eq!(events[0]["event"], "error");
    }
    assert_eq!(folder.images(), ["folder.exr"]);
}
