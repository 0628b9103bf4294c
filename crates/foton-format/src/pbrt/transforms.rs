//! Directives of transforms: they change the space of what comes next.

use foton_input::quoted;
use foton_math::glam::{DAffine3, DVec3};

use super::reader::Reader;
use super::state::{look_at, of_columns, rotation};
use super::tokens::{Fault, Tokens};
use crate::diagnostic::Place;
use crate::spelling::did_you_mean;

impl Reader<'_> {
    pub(crate) fn transform(
        &mut self,
        word: &str,
        place: Place,
        tokens: &mut Tokens<'_>,
    ) -> Result<(), Fault> {
        match word {
            "Identity" => self.state.set(|_| DAffine3::IDENTITY),
            "ReverseOrientation" => self.state.reverses = !self.state.reverses,
            "Translate" => {
                let by = DVec3::from_array(tokens.fixed()?);
                self.state.concatenate(DAffine3::from_translation(by));
            }
            "Scale" => {
                let by = DVec3::from_array(tokens.fixed()?);
                if by.to_array().contains(&0.0) {
                    return Err((place, "a factor of Scale is zero".to_owned()));
                }
                self.state.concatenate(DAffine3::from_scale(by));
            }
            "Rotate" => {
                let [degrees, x, y, z] = tokens.fixed()?;
                let turn = rotation(degrees, DVec3::new(x, y, z))
                    .ok_or((place, "the axis of Rotate has no length".to_owned()))?;
                self.state.concatenate(turn);
            }
            "LookAt" => {
                let [ex, ey, ez, tx, ty, tz, ux, uy, uz] = tokens.fixed()?;
                let (eye, target, up) =
                    (DVec3::new(ex, ey, ez), DVec3::new(tx, ty, tz), DVec3::new(ux, uy, uz));
                let message = "LookAt has no direction, or looks along its up vector";
                self.state.concatenate(look_at(eye, target, up).ok_or((place, message.to_owned()))?);
            }
            "Transform" | "ConcatTransform" => self.matrix(word, place, tokens)?,
            "CoordinateSystem" | "CoordSysTransform" => self.named_transform(word, tokens)?,
            "ActiveTransform" => self.active_transform(tokens)?,
            _ => {
                let times = tokens.fixed::<2>()?;
                if times[0] > times[1] {
                    return Err((place, "the motion ends before it begins".to_owned()));
                }
                self.times = times;
            }
        }
        let is_sound =
            self.state.transforms.0.iter().all(|t| t.is_finite() && t.matrix3.determinant() != 0.0);
        if !is_sound {
            self.state.set(|_| DAffine3::IDENTITY);
            return Err((place, "the transform has no inverse that numbers can tell".to_owned()));
        }
        Ok(())
    }

    fn named_transform(&mut self, word: &str, tokens: &mut Tokens<'_>) -> Result<(), Fault> {
        let name = tokens.text("a name of a coordinate system")?;
        if word == "CoordinateSystem" {
            self.coordinate_systems.insert(name.value, self.state.transforms);
            return Ok(());
        }
        let Some(&known) = self.coordinate_systems.get(&name.value) else {
            let names = self.coordinate_systems.keys().map(String::as_str);
            let hint = self.report.did_you_mean(&name.value, names);
            let message = format!("there is no coordinate system {}{hint}", quoted(&name.value));
            return Err((name.place, message));
        };
        self.state.set(|i| known.0[i]);
        Ok(())
    }

    fn matrix(&mut self, word: &str, place: Place, tokens: &mut Tokens<'_>) -> Result<(), Fault> {
        let numbers = tokens.fixed::<16>()?;
        let Some(matrix) = of_columns(&numbers) else {
            let message = "a matrix must be affine: its numbers 4, 8, 12 and 16 are 0, 0, 0 and 1";
            return Err((place, message.to_owned()));
        };
        if word == "Transform" {
            self.state.set(|_| matrix);
        } else {
            self.state.concatenate(matrix);
        }
        Ok(())
    }

    fn active_transform(&mut self, tokens: &mut Tokens<'_>) -> Result<(), Fault> {
        const NAMES: [&str; 3] = ["StartTime", "EndTime", "All"];
        let which = tokens.name("StartTime, EndTime or All")?;
        self.state.active = match which.value {
            "StartTime" => [true, false],
            "EndTime" => [false, true],
            "All" => [true; 2],
            other => {
                let hint = did_you_mean(other, NAMES);
                return Err((
                    which.place,
                    format!("ActiveTransform takes StartTime, EndTime or All, not {}{hint}", quoted(other)),
                ));
            }
        };
        Ok(())
    }
}
