//! Cells against worths that are known.

use foton_math::glam::{DAffine3, DVec3, Vec3};
use foton_math::{Purpose, Rgb, Stream};
use foton_scene::description::{
    EmitterDescription, EmitterKind, Filter, FovAxis, SceneDescription, SensorDescription,
};
use foton_scene::{Scene, Sources};

use super::cells::Cell;
use super::growth::DEFENSIVE_SHARE;
use super::*;
use crate::camera_paths::HitPoint;
use crate::codec::{Reader, StateError, Writer};

fn hit_point(position: Vec3, footprint: f32, weight: f32) -> HitPoint {
    HitPoint {
        position,
        normal: Vec3::Z,
        shading_normal: Vec3::Z,
        offset: 0.0,
        weight: Rgb::splat(weight),
        gloss: None,
        footprint,
        radius2: 1.0,
        curved: true,
        smallest2: 0.0,
        remaining_edges: 9,
        patch: 0,
    }
}

#[test]
fn light_is_worth_the_square_of_weight_over_footprint() {
    // Near the eye on the left, far on the right, and twice as heavy above.
    let of = |x: i32, footprint: f32, weight: f32| {
        let at = move |i: i32| Vec3::new((x + i % 64) as f32, (i / 64) as f32 + 100.0 * weight, 0.0);
        (0..4096).map(move |i| hit_point(at(i), footprint, weight))
    };
    let all: Vec<HitPoint> = of(0, 1.0, 1.0).chain(of(200, 10.0, 1.0)).chain(of(0, 1.0, 2.0)).collect();
    let worth = Worth::new(&all, |_| false);
    let at = |x: f32, y: f32| worth.at(Vec3::new(x, y, 0.0));
    assert_eq!((at(30.0, 130.0), at(30.0, 230.0)), (1.0, 4.0));
    assert!((at(230.0, 130.0) - 0.01).abs() < 1e-6);
    assert_eq!((at(120.0, 130.0), at(30.0, -50.0), at(f32::NAN, 0.0)), (0.0, 0.0, 0.0));
    assert_eq!(Worth::new(&[], |_| false).at(Vec3::ZERO), 0.0);
    assert_eq!(Worth::new(&all, |_| true).at(Vec3::ZERO), 0.0, "specular ones gather few");
}

/// Sources of two points of light, the first of three times the power, and of a sun.
fn sources() -> Sources {
    let point = |x: f64, intensity: f32| EmitterDescription {
        name: "lamp".into(),
        kind: EmitterKind::Point { position: DVec3::new(x, 0.0, 0.0), intensity: Rgb::splat(intensity) },
    };
    let sun = EmitterKind::Directional { direction: DVec3::NEG_Z, irradiance: Rgb::splat(1.0) };
    let description = SceneDescription {
        sensors: vec![SensorDescription {
            name: "camera".into(),
            to_world: DAffine3::IDENTITY,
            fov_degrees: 60.0,
            fov_axis: FovAxis::X,
            width: 4,
            height: 4,
            filter: Filter::Box { radius: 0.5 },
            ..SensorDescription::default()
        }],
        emitters: vec![
            point(1.0, 3.0),
            point(-1.0, 1.0),
            EmitterDescription { name: "sun".into(), kind: sun },
        ],
        ..SceneDescription::default()
    };
    Scene::build(&description).expect("a sound scene").sources(&[])
}

/// Lets photons start by `cells` and notes them, where `stores` says how much of a photon of power 1 is stored. Returns the samples, and
/// the estimate of the integral of that.
fn train(cells: &Cells, pass: u64, stores: impl Fn(&Start) -> f32) -> (Samples, f64) {
    const PHOTONS: u64 = 20_000;
    let (mut noted, mut sum) = (Vec::new(), 0.0);
    for i in 0..PHOTONS {
        let mut numbers = Stream::new(3, Purpose::Test, pass, i);
        let choice = (i as f64 + f64::from(numbers.next_1d())) / PHOTONS as f64;
        let start = cells.start(choice, std::array::from_fn(|_| numbers.next_1d())).expect("emitters");
        assert!(start.primary.iter().all(|u| (0.0..1.0).contains(u)));
        let power = stores(&start) / start.density as f32;
        let mut sample = Sample::new(&start);
        if power > 0.0 {
            sample.is_stored(Rgb::splat(power), 1.0);
        }
        noted.push(sample);
        sum += f64::from(power);
    }
    let mut samples = Samples::default();
    samples.take(noted);
    (samples, sum / PHOTONS as f64)
}

#[test]
fn photons_gather_where_they_are_worth_most_and_the_light_stays_the_same() {
    let sources = sources();
    // A hundredth of the first lamp's directions, a thousandth of the sun's beam; the second lamp is never seen.
    let stores = |start: &Start| {
        let [_, x, y, across, along] = start.primary;
        match start.emitter {
            0 if across < 0.1 && (0.3..0.4).contains(&along) => 3.0,
            2 if (0.52..0.56).contains(&x) && (0.7..0.725).contains(&y) => 1.0,
            _ => 0.0f32,
        }
    };
    let whole = 3.0 * 0.01 + 0.001;
    let share_stored = |samples: &Samples| {
        samples.noted.iter().filter(|s| s.worth > 0.0).count() as f64 / samples.noted.len() as f64
    };
    let mut cells = Cells::unguided(&sources);
    let mut shares = Vec::new();
    let mut sum = 0.0;
    const PASSES: u64 = 6;
    for pass in 0..PASSES {
        let (mut samples, integral) = train(&cells, pass, stores);
        shares.push(share_stored(&samples));
        sum += integral / PASSES as f64;
        cells = grow(&mut samples, &sources);
        let mass: f64 = cells.iter().map(|(_, probability)| probability).sum();
        let volume: f64 = cells.iter().map(|(cell, _)| cell.volume()).sum();
        assert!((mass - 1.0).abs() < 1e-9 && (volume - 3.0).abs() < 1e-6, "{mass} {volume}");
        for (cell, probability) in cells.iter() {
            let unguided = sources.choices().find(|c| c.0 == cell.emitter as usize).expect("it emits").1;
            assert!(probability >= DEFENSIVE_SHARE * unguided * cell.volume());
        }
    }
    assert!((sum / whole - 1.0).abs() < 0.05, "{sum} for {whole}");
    assert!(shares[0] < 0.01 && shares[5] > 0.5, "{shares:?}");
}

#[test]
fn even_worth_cuts_few_cells() {
    let sources = sources();
    let (mut samples, _) = train(&Cells::unguided(&sources), 0, |_| 1.0);
    let cells = grow(&mut samples, &sources);
    assert!(cells.len() < 8, "{}", cells.len());
}

#[test]
fn numbers_that_an_emitter_does_not_use_are_not_cut() {
    let sources = sources();
    // Chance that looks like structure: the worth goes by numbers that make no difference.
    let stores = |start: &Start| f32::from(u8::from(start.primary[0] < 0.1 && start.primary[1] < 0.3));
    let (mut samples, _) = train(&Cells::unguided(&sources), 0, stores);
    let cells = grow(&mut samples, &sources);
    let mut lamps = cells.iter().filter(|(cell, _)| cell.emitter < 2);
    assert!(lamps.all(|(cell, _)| cell.size[..3] == [1.0; 3]));
    assert!(
        cells.iter().all(|(cell, _)| cell.emitter < 2 || cell.size[0] == 1.0 && cell.size[3..] == [1.0; 2])
    );
}

#[test]
fn nothing_learnt_is_no_guidance() {
    let sources = sources();
    assert_eq!(grow(&mut Samples::default(), &sources), Cells::unguided(&sources));
    let (mut samples, _) = train(&Cells::unguided(&sources), 0, |_| 0.0);
    assert_eq!(grow(&mut samples, &sources), Cells::unguided(&sources));
    let (mut samples, _) = train(&Cells::unguided(&sources), 0, |_| f32::INFINITY);
    assert_eq!(grow(&mut samples, &sources), Cells::unguided(&sources));
}

#[test]
fn cells_survive_a_state_and_no_others_are_read() {
    let sources = sources();
    let (mut samples, _) = train(&Cells::unguided(&sources), 0, |start| start.primary[3]);
    let cells = grow(&mut samples, &sources);
    let mut out = Writer::default();
    cells.write(&mut out);
    let state = out.finish();
    assert_eq!(Cells::read(&mut Reader::new(&state), 3), Ok(cells));
    assert_eq!(Cells::read(&mut Reader::new(&state), 2), Err(StateError::OtherRender));
    assert!(Cells::read(&mut Reader::new(&state[..state.len() - 1]), 3).is_err());
    let mut broken = state;
    // The size of the first cell along its first axis.
    broken[8 + 8 + 5 * 8..][..4].copy_from_slice(&2f32.to_le_bytes());
    assert_eq!(Cells::read(&mut Reader::new(&broken), 3), Err(StateError::Impossible));
}

#[test]
fn training_passes_grow_rare() {
    let training: Vec<u64> = (0..200).filter(|&before| is_training_pass(before)).map(|b| b + 1).collect();
    assert_eq!(training, [1, 2, 4, 8, 16, 32, 64, 128, 192]);
}

#[test]
fn nearly_all_photons_in_one_cell_bring_the_same_light() {
    let (mut corner, mut rest) = (Cell::whole(0), Cell::whole(0));
    (corner.size[3], rest.low[3], rest.size[3]) = (0.25, 0.25, 0.75);
    let cells =
        Cells::new(vec![corner, rest, Cell::whole(1), Cell::whole(2)], vec![0.997, 0.001, 0.001, 0.001]);
    // The integral of one of the numbers over three emitters.
    const PASSES: u64 = 40;
    let sum: f64 = (0..PASSES).map(|pass| train(&cells, pass, |start| start.primary[3]).1).sum();
    assert!((sum / PASSES as f64 / 1.5 - 1.0).abs() < 0.03, "{}", sum / PASSES as f64);
}
