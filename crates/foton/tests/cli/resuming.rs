//! What options do to a render that goes on from a checkpoint: each is applied or refused, none is ignored.

use super::*;

const RENDER: &str = "render scene.xml --threads 2";

/// A checkpoint of three passes of up to 2,000 photons.
fn three_passes(folder: &Folder) {
    folder.done(&format!("{RENDER} --photons 2000 -o x.exr --passes 3 --checkpoint x.ck"));
}

/// The same render with changes after three of its six passes, made by the library.
fn changed_on_the_way(folder: &Folder, changes: &[SettingChange]) -> Image {
    let opened = foton_format::open(&folder.file("scene.xml"), &foton_format::Options::default());
    let scene = Scene::build(&opened.expect("the scene opens").description).expect("the scene is sound");
    let photons_per_pass = 2000.try_into().expect("above zero");
    let settings = RenderSettings {
        error: true,
        ppm: PpmSettings { photons_per_pass, ..PpmSettings::default() },
        ..RenderSettings::default()
    };
    let interrupt = Interrupt::default();
    let mut session = Session::start(Arc::new(scene), settings, Some(1), interrupt.cancel()).expect("starts");
    session.run(&StopRule::passes(3), &interrupt, &mut |_| ());
    changes.iter().for_each(|&change| session.render_mut().change(change));
    session.run(&StopRule::passes(6), &interrupt, &mut |_| ());
    session.render().image()
}

#[test]
fn alpha_photons_and_presets_change_a_resumed_render_from_the_next_pass_on() {
    let folder = Folder::new("resume-changes");
    three_passes(&folder);
    let alpha = |a| SettingChange::Alpha(Alpha::new(a).expect("in range"));
    let photons = |n: u32| SettingChange::PhotonsPerPass(n.try_into().expect("above zero"));
    let unchanged = changed_on_the_way(&folder, &[]);
    for (arguments, changes) in [
        ("", vec![]),
        ("--alpha 0.9", vec![alpha(0.9)]),
        ("--photons 7000", vec![photons(7000)]),
        ("--alpha 0.5 --photons 300", vec![alpha(0.5), photons(300)]),
        ("--preset final", vec![alpha(0.8), photons(1 << 18)]),
        ("--preset preview --photons 1000", vec![photons(1000)]),
        // What is so already is no change.
        ("--photons 2000", vec![]),
    ] {
        let said = folder.done(&format!("{RENDER} -o y.exr --resume x.ck --passes 6 {arguments}"));
        let (image, metadata) = folder.exr("y.exr");
        assert!(image == changed_on_the_way(&folder, &changes), "{arguments}");
        assert_eq!(image == unchanged, changes.is_empty(), "{arguments}");
        let lines: Vec<String> = changes.iter().map(|change| format!("3 {change}")).collect();
        assert_eq!(metadata.get("foton:changes").unwrap_or_default(), lines.join("\n"), "{arguments}");
        for change in &changes {
            let line = format!("{change} from pass 4 on");
            assert!(text(&said.stderr).contains(&line), "{line}: {}", text(&said.stderr));
        }
    }
}

#[test]
fn what_cannot_change_on_the_way_is_refused_by_name() {
    let folder = Folder::new("resume-refusals");
    three_passes(&folder);
    for (arguments, named) in [
        ("--seed 7", "seed 0, not 7"),
        ("--spp 2", "spp 4, not 2"),
        ("--size 12x8", "size 24x16, not 12x8"),
        ("--radius 0.2", "radius x1, not 0.2*1"),
        ("--radius x0.5", "radius x1, not x0.5"),
        ("--radius-rule local", "radius-rule adaptive, not local"),
        ("--direct shadow-rays", "direct auto, not shadow-rays"),
        ("--max-depth 5", "max-depth 250, not 5"),
        ("--layers caustic", "kinds of light summed, not kept apart"),
        ("--error off", "error estimated, not off"),
        ("--seed 7 --error off --spp 1", "seed 0, not 7; spp 4, not 1; error estimated, not off"),
    ] {
        let said = folder.fails(1, &format!("{RENDER} -o y.exr --resume x.ck --passes 6 {arguments}"));
        let expected = format!("x.ck: the checkpoint was made with {named}, which cannot change on the way");
        assert!(said.contains(&expected), "{arguments}: {said}");
    }
    for arguments in ["-D white=0.6", "-D width=20"] {
        let said = folder.fails(1, &format!("{RENDER} -o y.exr --resume x.ck --passes 6 {arguments}"));
        assert!(said.contains("x.ck: the checkpoint is of another scene"), "{arguments}: {said}");
    }
    let mut sensor = folder.command(&format!("{RENDER} -o y.exr --resume x.ck --passes 6"));
    let output = sensor.args(["--sensor", "from above"]).output().expect("the program starts");
    assert!(text(&output.stderr).contains("sensor front, not from above"), "{}", text(&output.stderr));
    assert_eq!(folder.images(), ["x.ck", "x.exr"]);
    // These change nothing of what was rendered.
    folder.done(&format!("{RENDER} -o y.exr --resume x.ck --passes 4 --layers radius,error_noise --every 1"));
}

#[test]
fn a_checkpoint_that_is_past_the_stop_rule_says_that_nothing_is_added() {
    let folder = Folder::new("resume-past");
    three_passes(&folder);
    for rule in ["--passes 3", "--passes 1", "--time 1ms"] {
        let said = text(&folder.done(&format!("{RENDER} -o y.exr --resume x.ck {rule}")).stderr);
        assert!(said.contains("the checkpoint has 3 passes in "), "{rule}: {said}");
        assert!(said.contains("nothing is added"), "{rule}: {said}");
        assert_eq!(folder.exr("y.exr").1.get("foton:passes"), Some("3"));
    }
    let said = text(&folder.done(&format!("{RENDER} -o y.exr --resume x.ck --passes 4")).stderr);
    assert!(!said.contains("nothing is added"), "{said}");
}
