//! A part of the image, rendered alone.

use super::*;

#[test]
fn a_region_is_rendered_alone_and_says_so() {
    let folder = Folder::new("region");
    let render = "render scene.xml --passes 2 --photons 2000";
    folder.done(&format!("{render} -o whole.exr"));
    folder.done(&format!("{render} -o part.exr --region 4,6,10,8"));
    folder.done(&format!("{render} -o again.exr --region 4,6,10,8 --threads 1"));
    assert!(folder.bytes("part.exr") == folder.bytes("again.exr"), "the same bits each time");
    let (part, metadata) = folder.exr("part.exr");
    assert_eq!((part.width, part.height), (10, 8));
    let settings = metadata.get("foton:settings").expect("there");
    assert!(
        settings.ends_with(
            "size=10x8 sensor=front hit_points_per_sample=8 layers=false region=4,6,10,8 of=24x16"
        ),
        "{settings}"
    );
    // Of the whole image it has the light, up to noise, and not the bits.
    let (whole, _) = folder.exr("whole.exr");
    let cut = (6..14).flat_map(|y| (4..14).map(move |x| y * 24 + x)).map(|i| whole.pixels[i].luminance());
    let (all, here) = (cut.sum::<f32>(), part.pixels.iter().map(|c| c.luminance()).sum::<f32>());
    assert!((here / all - 1.0).abs() < 0.1, "{here} is not {all}");
    let memory = |arguments: &str| {
        let found = events(&folder.done(&format!("info scene.xml --json {arguments}")).stdout);
        number(&found[0]["memory"], "expected_hit_points")
    };
    assert!(memory("--region 4,6,10,8") < 0.5 * memory(""));
    for (region, why) in [
        ("20,6,10,8", "the region 20,6,10,8 is not inside the image of 24 x 16 pixels"),
        ("0,0,4294967295,1", "is not inside"),
    ] {
        let said = folder.fails(1, &format!("{render} -o no.exr --region {region}"));
        assert!(said.contains(why), "{said}");
    }
    let said = folder.fails(2, &format!("{render} -o no.exr --region 1,2,0,4"));
    assert!(said.contains("expected X,Y,WIDTH,HEIGHT"), "{said}");
    folder.done(&format!("{render} -o x.exr --region 0,0,8,8 --checkpoint x.ck"));
    let said = folder.fails(1, &format!("{render} -o no.exr --region 1,0,8,8 --resume x.ck"));
    assert!(said.contains("size 8x8 at 0,0 of 24x16, not 8x8 at 1,0 of 24x16"), "{said}");
}
