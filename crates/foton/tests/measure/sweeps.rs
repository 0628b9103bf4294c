//! `foton measure` from outside: tables, page, going on, refusals. Not whether its figures are right: `foton-measure` tests those.

use std::fs;

use foton_film::read_exr;
use serde_json::Value;

use crate::{Folder, err, out};

/// A lamp over a floor, small enough that a part takes a blink.
const SCENE: &str = r#"<scene version="3.0.0">
    <sensor type="perspective">
        <transform name="to_world"><lookat origin="0, 1, 3" target="0, 0.3, 0" up="0, 1, 0"/></transform>
        <film type="hdrfilm"><integer name="width" value="16"/><integer name="height" value="12"/></film>
    </sensor>
    <shape type="rectangle"><transform name="to_world"><scale value="2"/><rotate x="1" angle="-90"/></transform></shape>
    <shape type="rectangle">
        <transform name="to_world"><scale value="0.5"/><rotate x="1" angle="90"/><translate y="1.5"/></transform>
        <emitter type="area"><rgb name="radiance" value="9, 8, 7"/></emitter>
    </shape>
</scene>
"#;

const SWEEP: [&str; 9] = ["room.xml", "-o", "sweep", "--budget", "1ms", "--seeds", "2", "--spp", "1"];

fn sweep(folder: &Folder, more: &[&str]) -> Vec<Value> {
    let args = [&SWEEP[..], &["--photons", "500", "--json"], more].concat();
    let output = folder.foton("measure", &args);
    assert_eq!(output.status.code(), Some(0), "{}", err(&output));
    out(&output).lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

fn event<'a>(events: &'a [Value], name: &str) -> &'a Value {
    events.iter().find(|e| e["event"] == name).unwrap_or_else(|| panic!("no {name} in {events:?}"))
}

#[test]
fn a_sweep_leaves_tables_and_a_page_that_needs_no_network_and_goes_on_where_it_ended() {
    let folder = Folder::new("sweep");
    folder.text("room.xml", SCENE);
    let events = sweep(&folder, &[]);
    let (reference, job, done) = (event(&events, "reference"), event(&events, "job"), event(&events, "done"));
    assert!(reference["noise"].as_f64().unwrap() > 0.0, "{reference}");
    assert_eq!(job["photons_per_pass"], 500);
    assert_eq!((job["configurations"].as_u64(), job["was_finished"].as_bool()), (Some(13), Some(false)));
    // Time was up at once: the first part alone is done.
    assert_eq!((done["jobs_done"].as_u64(), done["jobs"].as_u64()), (Some(1), Some(11)));
    assert!(done["recommendation"].as_str().unwrap().starts_with("For room at "), "{done}");
    let read = |name: &str| fs::read_to_string(folder.path(&format!("sweep/{name}"))).unwrap();
    let (page, summary, runs) = (read("index.html"), read("summary.csv"), read("runs.csv"));
    for outside in ["http://", "https://", "src=\"/", "<script", "@import"] {
        assert!(!page.contains(outside), "{outside}");
    }
    assert!(
        page.contains("data:image/png;base64,")
            && page.contains("<svg")
            && page.contains("prefers-color-scheme")
    );
    let columns = |text: &str| text.lines().map(|l| l.split(',').count()).collect::<Vec<_>>();
    for table in [&summary, &runs] {
        let columns = columns(table);
        assert!(columns.len() > 13 && columns.iter().all(|n| *n == columns[0]), "{columns:?}");
    }
    assert_eq!(runs.lines().count() - 1, 2 * (summary.lines().count() - 1), "a row a seed");

    let again = sweep(&folder, &[]);
    assert_eq!(event(&again, "job")["was_finished"], true);
    assert!(read("summary.csv") == summary && read("index.html") == page, "nothing ran, nothing changed");

    let other = folder.foton("measure", &[&SWEEP[..], &["--photons", "600"]].concat());
    assert_eq!(other.status.code(), Some(1));
    assert!(err(&other).contains("sweep holds a sweep of something else"), "{}", err(&other));

    fs::write(folder.path("sweep/parts/00000500-summary.csv"), "torn").unwrap();
    let torn = folder.foton("measure", &[&SWEEP[..], &["--photons", "500"]].concat());
    assert_eq!(torn.status.code(), Some(1));
    assert!(err(&torn).contains("00000500-summary.csv: not a table"), "{}", err(&torn));
}

#[test]
fn what_cannot_be_swept_is_refused_in_a_line() {
    let folder = Folder::new("no-sweep");
    folder.text("room.xml", SCENE);
    folder.text("dark.xml", &SCENE.replace("9, 8, 7", "0, 0, 0"));
    folder.exr("small.exr", &crate::image());
    let refused = |args: &[&str]| {
        let output = folder.foton("measure", args);
        (output.status.code().unwrap(), err(&output))
    };
    let brief = ["-o", "x", "--budget", "1ms", "--photons", "500"];
    for (code, args, said) in [
        (2, vec!["room.xml"], "-o <DIR>"),
        (2, vec!["room.xml", "--seeds", "1"], "1 is not in 2..=1000"),
        (2, vec!["room.xml", "--reference", "a.png"], "expected a name that ends in .exr"),
        (2, vec!["room.xml", "--radius", "0.5x"], "a factor such as x0.5"),
        (1, vec!["room.xml", "--reference", "none.exr"], "none.exr"),
        (1, vec!["room.xml", "--reference", "small.exr"], "the reference does not fit"),
        (1, vec!["dark.xml"], "there is no error to measure"),
    ] {
        let mut args = args;
        if !(code == 2 && said == "-o <DIR>") {
            args.extend(brief);
        }
        let (got, text) = refused(&args);
        assert!(got == code && text.contains(said), "{args:?}: {got} {text}");
    }
}

#[test]
fn presets_set_photons_and_alpha_and_options_come_before_them() {
    let folder = Folder::new("presets");
    folder.text("room.xml", SCENE);
    let settings = |args: &[&str]| {
        let output = folder.foton("render", &[&["room.xml", "-o", "a.exr", "--passes", "1"], args].concat());
        assert_eq!(output.status.code(), Some(0), "{}", err(&output));
        let (_, metadata) = read_exr(&folder.path("a.exr")).unwrap();
        metadata.get("foton:settings").unwrap().to_owned()
    };
    let (preview, balanced) = (settings(&["--preset", "preview"]), settings(&["--preset", "balanced"]));
    assert!(
        preview.contains(" photons=65536 ") && settings(&["--preset", "final"]).contains(" alpha=0.8 "),
        "{preview}"
    );
    assert_eq!(balanced, settings(&[]));
    let own =
        settings(&["--preset", "preview", "--photons", "1000", "--radius", "x3", "--radius-rule", "global"]);
    assert!(
        own.contains(" photons=1000 ") && own.contains(" radius=footprint*3 radius_rule=global "),
        "{own}"
    );
}
