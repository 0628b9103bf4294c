//! What moves while a shutter is open: shapes and cameras by keyframes, as in Mitsuba 0.6.
//!
//! The description states every transform as it is at the first keyframe; keyframes say how it goes on from there. So an edit that
//! moves a shape moves all of its way.

use std::collections::BTreeMap;

use foton_math::glam::{DAffine3, DMat3};

use super::SceneDescription;

/// How far, in shares of its largest number, a transform may be from what its parts make of it: beyond it is sheared.
const SHEARED: f64 = 1e-6;

/// Everything that moves.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Motion {
    /// By index of the shape.
    pub shapes: BTreeMap<usize, Keyframes>,
    /// By index of the sensor.
    pub sensors: BTreeMap<usize, Keyframes>,
    /// When the shutter of a sensor opens and closes, by its index; one that is not named takes everything as it is at time 0.
    pub shutters: BTreeMap<usize, [f64; 2]>,
}

/// Transforms at times; between two, translation, rotation and scale go on evenly.
#[derive(Clone, Debug, PartialEq)]
pub struct Keyframes(Vec<(f64, DAffine3)>);

impl Keyframes {
    /// `None` unless there are some, in the order of their times, which all differ, and no transform shears or mirrors.
    #[must_use]
    pub fn new(keyframes: Vec<(f64, DAffine3)>) -> Option<Self> {
        let in_order = keyframes.windows(2).all(|pair| pair[0].0 < pair[1].0);
        let are_sound = keyframes.iter().all(|(time, place)| time.is_finite() && !is_sheared(place));
        (!keyframes.is_empty() && in_order && are_sound).then_some(Self(keyframes))
    }

    /// All of them, in the order of time.
    #[must_use]
    pub fn all(&self) -> &[(f64, DAffine3)] {
        &self.0
    }

    /// The transform at a time: before the first keyframe and after the last, theirs.
    #[must_use]
    pub fn at(&self, time: f64) -> DAffine3 {
        let after = self.0.partition_point(|(t, _)| *t <= time);
        let (Some(before), Some(next)) = (after.checked_sub(1).map(|i| self.0[i]), self.0.get(after)) else {
            return self.0[after.min(self.0.len() - 1)].1;
        };
        let share = (time - before.0) / (next.0 - before.0);
        if share == 0.0 {
            return before.1;
        }
        let [a, b] = [&before.1, &next.1].map(DAffine3::to_scale_rotation_translation);
        DAffine3::from_scale_rotation_translation(
            a.0.lerp(b.0, share),
            a.1.slerp(b.1, share),
            a.2.lerp(b.2, share),
        )
    }

    /// What a transform that is `first` at the first keyframe is at a time.
    #[must_use]
    pub fn carried(&self, first: DAffine3, time: f64) -> DAffine3 {
        let stated = self.0[0].1;
        // Without an edit there is nothing to round.
        if first == stated { self.at(time) } else { self.at(time) * stated.inverse() * first }
    }

    /// Whether the transform is another at some time between these two.
    fn moves_within(&self, [open, close]: [f64; 2]) -> bool {
        self.times(open, close).any(|time| self.at(time) != self.at(open))
    }

    /// Its keyframes' times between two, and these.
    fn times(&self, open: f64, close: f64) -> impl Iterator<Item = f64> {
        let inside = self.0.iter().map(|(time, _)| *time).filter(move |t| *t > open && *t < close);
        [open, close].into_iter().chain(inside)
    }
}

/// Whether scale, rotation and translation do not make up a transform.
fn is_sheared(transform: &DAffine3) -> bool {
    let (scale, rotation, translation) = transform.to_scale_rotation_translation();
    let again = DAffine3::from_scale_rotation_translation(scale, rotation, translation);
    let largest = |m: DMat3| m.to_cols_array().into_iter().fold(0.0, |most: f64, c| most.max(c.abs()));
    let difference = largest(transform.matrix3 - again.matrix3);
    scale.min_element() <= 0.0 || difference.is_nan() || difference > SHEARED * largest(transform.matrix3)
}

impl Motion {
    /// Whether nothing moves, whatever a shutter does.
    #[must_use]
    pub fn is_still(&self) -> bool {
        self.shapes.is_empty() && self.sensors.is_empty()
    }

    /// When the shutter of a sensor opens and closes.
    #[must_use]
    pub fn shutter(&self, sensor: usize) -> [f64; 2] {
        self.shutters.get(&sensor).copied().unwrap_or([0.0; 2])
    }

    /// Whether anything that a sensor sees moves while its shutter is open.
    #[must_use]
    pub fn blurs(&self, sensor: usize) -> bool {
        let shutter = self.shutter(sensor);
        let of_sensor = self.sensors.get(&sensor);
        self.shapes.values().chain(of_sensor).any(|keyframes| keyframes.moves_within(shutter))
    }

    /// Times that tell where everything is at one time or another: keyframes, and some in between, where what turns sweeps past.
    pub(crate) fn times(&self) -> Vec<f64> {
        const BETWEEN: u32 = 8;
        let of = self.shapes.values().chain(self.sensors.values());
        let mut ends: Vec<f64> = of.flat_map(|keyframes| keyframes.0.iter().map(|(time, _)| *time)).collect();
        ends.sort_by(f64::total_cmp);
        let between = |pair: &[f64]| {
            let (a, b) = (pair[0], pair[1]);
            (0..BETWEEN).map(move |i| a + (b - a) * f64::from(i) / f64::from(BETWEEN)).collect::<Vec<_>>()
        };
        let mut times: Vec<f64> = ends.windows(2).flat_map(between).collect();
        times.extend(ends.last());
        times
    }

    /// Takes out what a list of shapes no longer has at `gone`.
    pub fn remove_shape(&mut self, gone: usize) {
        remove(&mut self.shapes, gone);
    }

    /// Takes out what a list of sensors no longer has at `gone`.
    pub fn remove_sensor(&mut self, gone: usize) {
        remove(&mut self.sensors, gone);
        remove(&mut self.shutters, gone);
    }

    /// Lets a shape move as another does.
    pub fn copy_shape(&mut self, from: usize, to: usize) {
        copy(&mut self.shapes, from, to);
    }

    /// Lets a sensor move as another does, with its shutter.
    pub fn copy_sensor(&mut self, from: usize, to: usize) {
        copy(&mut self.sensors, from, to);
        copy(&mut self.shutters, from, to);
    }
}

fn remove<T>(of: &mut BTreeMap<usize, T>, gone: usize) {
    let left = std::mem::take(of).into_iter().filter(|(i, _)| *i != gone);
    *of = left.map(|(i, value)| (if i > gone { i - 1 } else { i }, value)).collect();
}

fn copy<T: Clone>(of: &mut BTreeMap<usize, T>, from: usize, to: usize) {
    if let Some(value) = of.get(&from).cloned() {
        of.insert(to, value);
    }
}

impl SceneDescription {
    /// The scene as it is at a time, where nothing moves.
    #[must_use]
    pub fn at(&self, time: f64) -> Self {
        let mut now = Self { motion: Motion::default(), ..self.clone() };
        now.motion.shutters.clone_from(&self.motion.shutters);
        for (i, shape) in now.shapes.iter_mut().enumerate() {
            if let Some(keyframes) = self.motion.shapes.get(&i) {
                shape.to_world = keyframes.carried(shape.to_world, time);
            }
        }
        for (i, sensor) in now.sensors.iter_mut().enumerate() {
            if let Some(keyframes) = self.motion.sensors.get(&i) {
                sensor.to_world = keyframes.carried(sensor.to_world, time);
            }
        }
        now
    }
}

#[cfg(test)]
mod tests {
    use foton_math::glam::{DQuat, DVec3};

    use super::*;

    fn shift(x: f64) -> DAffine3 {
        DAffine3::from_translation(DVec3::new(x, 0.0, 0.0))
    }

    #[test]
    fn transforms_go_on_evenly_and_stand_still_outside() {
        let turn = DAffine3::from_quat(DQuat::from_rotation_z(1.0)) * DAffine3::from_scale(DVec3::splat(3.0));
        let keyframes =
            Keyframes::new(vec![(1.0, DAffine3::IDENTITY), (2.0, turn), (4.0, shift(2.0))]).expect("sound");
        assert_eq!(keyframes.at(0.0), DAffine3::IDENTITY);
        assert_eq!(keyframes.at(9.0), shift(2.0));
        let half = keyframes.at(1.5);
        let expected =
            DAffine3::from_quat(DQuat::from_rotation_z(0.5)) * DAffine3::from_scale(DVec3::splat(2.0));
        assert!(half.abs_diff_eq(expected, 1e-12), "{half:?}");
        assert!((keyframes.at(3.0).translation.x - 1.0).abs() < 1e-12);
    }

    #[test]
    fn an_edit_carries_all_of_the_way() {
        let keyframes = Keyframes::new(vec![(0.0, shift(1.0)), (1.0, shift(3.0))]).expect("sound");
        assert_eq!(keyframes.carried(shift(1.0), 1.0), shift(3.0));
        assert_eq!(keyframes.carried(shift(5.0), 1.0), shift(7.0));
    }

    #[test]
    fn what_is_no_motion_is_refused() {
        let shear = DAffine3::from_mat3(DMat3::from_cols(DVec3::X, DVec3::new(0.5, 1.0, 0.0), DVec3::Z));
        let mirror = DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0));
        for keyframes in [
            vec![],
            vec![(1.0, shift(0.0)), (1.0, shift(1.0))],
            vec![(f64::NAN, shift(0.0))],
            vec![(0.0, shear)],
            vec![(0.0, mirror)],
        ] {
            assert_eq!(Keyframes::new(keyframes), None);
        }
    }

    #[test]
    fn only_what_moves_while_the_shutter_is_open_blurs() {
        let mut motion = Motion::default();
        motion.shapes.insert(3, Keyframes::new(vec![(0.0, shift(0.0)), (1.0, shift(1.0))]).expect("sound"));
        assert!(!motion.blurs(0) && !motion.is_still(), "it is open at time 0 alone");
        motion.shutters.insert(0, [0.25, 0.5]);
        motion.shutters.insert(1, [1.0, 2.0]);
        assert!(motion.blurs(0) && !motion.blurs(1));
        motion.remove_sensor(0);
        assert_eq!(motion.shutter(0), [1.0, 2.0]);
        motion.remove_shape(1);
        motion.copy_shape(2, 5);
        assert_eq!(motion.shapes.keys().copied().collect::<Vec<_>>(), [2, 5]);
    }
}
