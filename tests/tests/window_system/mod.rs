//! What the system does to the window: its graphics adapter is lost, it is minimised, files fall on it.

mod newcomer;

use super::*;

#[test]
// Programs built without debug assertions cannot be made to lose their adapter.
#[cfg(debug_assertions)]
fn the_render_goes_on_without_an_adapter_or_a_viewer_and_files_are_dropped() {
    let (_folder, mut driver) = opened("window-system", Some("device:3"));

    another_adapter_goes_on_with_the_same_render(&mut driver);
    zooming_compiles_nothing(&mut driver);
    minimised_it_draws_nothing_and_renders(&mut driver);
    a_dropped_file_is_opened_and_a_bad_one_said(&mut driver);
}

fn another_adapter_goes_on_with_the_same_render(driver: &mut Driver) {
    // On a busy machine the first one may be lost before the window was seen to be open.
    driver.window.log.rewind();
    for which in ["an adapter", "another adapter"] {
        driver.window.wait(which, |line| (line["event"] == "adapter").then_some(()));
    }
    driver.window.wait("it said", |line| {
        (line["event"] == "notice" && line["message"].as_str()?.contains("adapter was lost and is back"))
            .then_some(())
    });
    driver.window.frame("more passes", |f| (number(&f["pass"]) >= 6.0).then_some(()));
    let passes: Vec<f64> = driver
        .window
        .log
        .lines()
        .iter()
        .filter_map(|line| line.get("frame"))
        .inspect(|f| assert_eq!(f["render"], 1, "nothing starts anew"))
        .map(|f| number(&f["pass"]))
        .collect();
    assert!(passes.is_sorted(), "{passes:?}");
    // The picture, and the panels with their letters, which the first adapter was given once.
    driver.until("recovered", |image| light(image, [0.5, 0.5]) > 0.02);
    let all = driver.display.picture(&driver.folder.join("recovered-panels.png"));
    let [left, top, width, height] = driver.window.place("alpha").map(|v| v as u32);
    let row = |y| &all.pixels[(y * all.width + left) as usize..(y * all.width + left + width) as usize];
    let brightest = (top..top + height).flat_map(row).map(|c| c.luminance()).fold(0.0, f32::max);
    assert!(brightest > 0.2, "no slider at {left}, {top}: {brightest}");
}

fn minimised_it_draws_nothing_and_renders(driver: &mut Driver) {
    let client = driver.display.client();
    let window = client.find("foton");
    client.minimise(window, true);
    // Longer than the frame that was being drawn.
    let worked = |driver: &Driver, ticks: u64| {
        let (begin, before) = (Instant::now(), driver.window.cpu_ticks());
        while driver.window.cpu_ticks()[0] < before[0] + ticks {
            assert!(begin.elapsed() < PATIENCE, "it does not render");
            std::thread::sleep(std::time::Duration::from_millis(20));
        }
        let after = driver.window.cpu_ticks();
        [after[0] - before[0], after[1] - before[1]]
    };
    worked(driver, 50);
    driver.window.log.skip();
    let pass =
        driver.window.log.lines().iter().rev().find_map(|line| Some(number(&line.get("frame")?["pass"])));
    let lines = driver.window.log.lines().len();
    let [all, window_thread] = worked(driver, 200);
    assert_eq!(driver.window.log.lines().len(), lines, "frames that nobody sees");
    assert!(10 * window_thread <= all, "the window's thread took {window_thread} ticks of {all}");
    client.minimise(window, false);
    let shown = driver.window.frame("a frame", |f| Some(number(&f["pass"])));
    assert!(Some(shown) > pass, "the newest picture, not that of pass {pass:?}: {shown}");
}

/// A driver that puts the view's numbers into the machine code of shaders would keep one for each that was ever seen.
fn zooming_compiles_nothing(driver: &mut Driver) {
    driver.point([60.0, 45.0]);
    driver.display.hand("keydown ctrl");
    let before = driver.window.frame("a frame", |f| Some(number(&f["render"])));
    let zoom_out = |driver: &mut Driver| {
        driver.display.hand("click 5");
        driver.window.log.skip();
        driver.window.wait("a frame", |line| (line["event"] == "drawn").then_some(()));
    };
    // Until a pixel holds several texels, which is another shader.
    (0..12).for_each(|_| zoom_out(driver));
    let compiled = driver.window.compiled();
    (0..8).for_each(|_| zoom_out(driver));
    let in_all = driver.window.compiled();
    assert!(in_all <= compiled + 1, "{compiled} stretches of machine code became {in_all}");
    driver.display.hand("keyup ctrl key f");
    let after = driver.window.frame("a frame", |f| Some(number(&f["render"])));
    assert_eq!(before, after, "the picture is zoomed, not the camera moved");
}

fn a_dropped_file_is_opened_and_a_bad_one_said(driver: &mut Driver) {
    let client = driver.display.client();
    let window = client.find("foton");
    let bad = driver.folder.join("bad.xml");
    fs::write(&bad, SCENE.replacen("\"diffuse\" id=\"grey\"", "\"difuse\" id=\"grey\"", 1)).expect("written");
    client.drop_file(window, &bad, || {});
    let said = driver.window.wait("the error", |line| {
        (line["event"] == "error").then(|| line["message"].as_str().expect("words").to_owned())
    });
    assert!(said.contains("bad.xml:10:") && said.contains("did you mean \"diffuse\"?"), "{said}");
    let before = driver.window.frame("a frame", |f| Some((number(&f["render"]), number(&f["pass"]))));
    driver.window.frame("the last scene going on", |f| {
        (number(&f["render"]) == before.0 && number(&f["pass"]) > before.1).then_some(())
    });
    let good = driver.folder.join("zwölf % größer #1.xml");
    fs::write(&good, SCENE).expect("written");
    client.drop_file(window, &good, || {
        driver.until("held", |image| {
            // The frame around the canvas, in the colour of what is chosen.
            let c = image.pixels[(image.width * 5 + image.width / 2) as usize];
            c.b > 1.5 * c.r && c.b > 0.1
        });
    });
    driver.window.frame("it opened", |f| (f["scene"] == "zwölf % größer #1.xml").then_some(()));
    driver.window.frame("it rendering", |f| (f["activity"] == "rendering").then_some(()));
}

/// So that what is owed to a checkpoint is written, as with the window's own button.
#[test]
fn a_signal_closes_the_window_and_does_not_kill_it() {
    let (_folder, mut driver) = opened("window-signal", None);
    let status = Command::new("kill").args(["-TERM", &driver.window.process().to_string()]).status();
    assert!(status.expect("kill runs").success());
    assert!(driver.window.end().1, "all was well");
}
