//! Building that is cancelled, and what is told of it.

use std::sync::Mutex;

use foton_math::{Cancel, Cancelled};
use foton_scene::{BuildError, BuildOptions, BuildStep};

use super::*;

/// A bumpy ground of so many squares along a side, one of them twice, a ball and a disc.
fn ground(side: u32) -> SceneDescription {
    let height = |i: u32| f64::from(i * 7919 % 13) * 0.01;
    let corner = |i: u32| {
        DVec3::new(f64::from(i % (side + 1)), height(i), f64::from(i / (side + 1))) / f64::from(side) - 0.5
    };
    let square = |i: u32| {
        let first = i % side + i / side * (side + 1);
        [[first, first + side + 1, first + 1], [first + 1, first + side + 1, first + side + 2]]
    };
    let mesh = Mesh {
        positions: (0..(side + 1).pow(2)).map(corner).collect(),
        triangles: (0..side * side).chain([0]).flat_map(square).collect(),
        ..Mesh::default()
    };
    let ball = Geometry::Sphere { centre: DVec3::Y, radius: 0.2 };
    let shape = |name: &str, geometry| ShapeDescription {
        name: name.into(),
        geometry,
        to_world: DAffine3::IDENTITY,
        flip_normals: false,
        material: 0,
        radiance: None,
    };
    describe(vec![
        shape("ground", Geometry::Mesh(Arc::new(mesh))),
        shape("ball", ball),
        shape("disc", Geometry::Disc),
    ])
}

/// Builds with a request that comes after so many questions; what building was at last.
fn build_after(
    questions: u64,
    description: &SceneDescription,
) -> (Result<Scene, BuildError>, Option<BuildStep>) {
    let last = Mutex::new(None);
    let tell = |step: BuildStep, _| *last.lock().expect("whole") = Some(step);
    let cancel = Cancel::after(questions);
    let options = BuildOptions { cancel, tell: Some(&tell), ..BuildOptions::default() };
    let built = Scene::build_with(description, &options);
    (built, last.into_inner().expect("whole"))
}

#[test]
fn a_build_that_is_cancelled_ends_in_that_wherever_it_comes() {
    const PLACES: u64 = 400;
    let description = ground(50);
    let all = (0..).map(|power| 1 << power).find(|&n| build_after(n, &description).0.is_ok());
    let all = all.expect("some number is enough");
    let mut cancelled_in = Vec::new();
    for place in 0..PLACES {
        match build_after(all * place / PLACES, &description) {
            (Ok(_), _) => break,
            (Err(error), step) => {
                assert_eq!(error, BuildError::Cancelled(Cancelled));
                cancelled_in.push(step);
            }
        }
    }
    // Questions are asked all over it: the longer a step, the more.
    let share =
        |step| cancelled_in.iter().filter(|s| **s == Some(step)).count() as f64 / cancelled_in.len() as f64;
    for (step, least) in
        [(BuildStep::Tree, 0.02), (BuildStep::Patches, 0.25), (BuildStep::Coincidences, 0.25)]
    {
        assert!(share(step) > least, "{step:?}: {} of {}", share(step), cancelled_in.len());
    }
    let scene = build_after(all, &description).0.expect("not cancelled");
    assert_eq!(scene.census().triangles, 2 * 50 * 50 + 2);
}

#[test]
fn a_request_that_is_there_before_keeps_a_scene_from_being_built() {
    let cancel = Cancel::default();
    cancel.request();
    let options = BuildOptions { cancel: cancel.clone(), ..BuildOptions::default() };
    assert_eq!(Scene::build_with(&ground(1), &options).err(), Some(BuildError::Cancelled(Cancelled)));
    cancel.rearm();
    assert!(Scene::build_with(&ground(1), &options).is_ok());
}

#[test]
fn building_tells_what_it_is_at_and_how_far_that_is() {
    let told = Mutex::new(Vec::new());
    let tell = |step: BuildStep, share: f64| told.lock().expect("whole").push((step, share));
    let options = BuildOptions { tell: Some(&tell), ..BuildOptions::default() };
    Scene::build_with(&ground(80), &options).expect("sound");
    let told = told.into_inner().expect("whole");
    assert!(told.iter().all(|(_, share)| (0.0..=1.0).contains(share)), "{told:?}");
    for step in [BuildStep::Shapes, BuildStep::Tree, BuildStep::Patches, BuildStep::Coincidences] {
        let shares: Vec<f64> = told.iter().filter(|(of, _)| *of == step).map(|(_, share)| *share).collect();
        assert!(shares.iter().any(|&share| share >= 0.5), "{step:?}: {shares:?}");
    }
}
