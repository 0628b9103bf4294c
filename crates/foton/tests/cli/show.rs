//! Images of some kinds of light, and of photons as dots.

use super::*;

#[test]
fn kinds_of_light_add_up_to_all_light() {
    let folder = Folder::new("kinds");
    let render = "render scene.xml --passes 3 --photons 3000";
    folder.done(&format!("{render} -o all.exr"));
    let all = folder.exr("all.exr").0;
    let mut sum = vec![[0.0f64; 3]; all.pixels.len()];
    for kinds in ["direct,emission", "caustic", "indirect"] {
        folder.done(&format!("{render} -o part.exr --show {kinds}"));
        let (part, metadata) = folder.exr("part.exr");
        assert_eq!(metadata.get("foton:shown"), Some(kinds));
        assert!(part.pixels.iter().any(|c| c.luminance() > 0.0), "{kinds}");
        let pixels = part.pixels.iter().map(|c| [c.r, c.g, c.b].map(f64::from));
        sum.iter_mut().zip(pixels).for_each(|(s, c)| (0..3).for_each(|k| s[k] += c[k]));
    }
    for (sum, c) in sum.into_iter().zip(&all.pixels) {
        for (sum, c) in sum.into_iter().zip([c.r, c.g, c.b].map(f64::from)) {
            assert!((sum - c).abs() <= 1e-4 * c.abs() + 1e-6, "{sum} is not {c}");
        }
    }
    assert_eq!(folder.exr("all.exr").1.get("foton:shown"), None);
}

#[test]
fn photons_are_dots_on_black_in_the_colours_of_their_paths() {
    let folder = Folder::new("dots");
    folder.done("render scene.xml -o dots.exr --passes 1 --photons 400 --direct photons --show photons");
    let (image, metadata) = folder.exr("dots.exr");
    assert_eq!(metadata.get("foton:shown"), Some("photons"));
    let lit: Vec<_> = image.pixels.iter().filter(|c| c.luminance() > 0.0).collect();
    assert!(!lit.is_empty() && lit.len() < image.pixels.len(), "{} dots", lit.len());
    assert!(lit.iter().any(|c| c.r > c.b && c.b < 0.1), "direct light on the floor");
}

#[test]
fn what_cannot_be_shown_is_refused() {
    let folder = Folder::new("shown-refused");
    for (options, why) in [
        ("--show photons,direct", "--show photons stands alone"),
        ("--show photons --integrator path", "--integrator path has none"),
        ("--show direct --integrator all", "--integrator all makes several"),
        ("--show colours", "possible values"),
    ] {
        let said = folder.fails(2, &format!("render scene.xml -o x.exr --passes 1 {options}"));
        assert!(said.contains(why), "{options}: {said}");
    }
}
