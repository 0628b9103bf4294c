//! Named media: read and known by name, and said to have no effect, since media are not rendered yet.

use foton_input::quoted;

use super::parameters::Parameters;
use super::reader::Reader;
use super::tokens::{Fault, Token, Tokens};
use crate::mitsuba::read::properties::Located;
use crate::spelling::did_you_mean;

/// Media of both versions.
const MEDIA: [&str; 6] = ["homogeneous", "heterogeneous", "uniformgrid", "rgbgrid", "cloud", "nanovdb"];

impl Reader<'_> {
    /// `MakeNamedMedium` and `MediumInterface`.
    pub(crate) fn medium_directive(&mut self, word: &str, tokens: &mut Tokens<'_>) -> Result<(), Fault> {
        let name = tokens.text("a name of a medium")?;
        if word == "MakeNamedMedium" {
            let list = tokens.parameters(&mut self.report);
            let p = Parameters::new(name.value.clone(), name.place, list);
            let kind = p.text("type", &mut self.report);
            p.ignore_rest();
            match kind {
                Some(kind) if MEDIA.contains(&kind.value.as_str()) => {}
                Some(kind) => {
                    let hint = did_you_mean(&kind.value, MEDIA);
                    self.report.warning(kind.place, format!("unknown medium {}{hint}", quoted(&kind.value)));
                }
                None => self.report.warning(name.place, "a named medium needs its \"string type\""),
            }
            self.media.define(name.value, ());
            return Ok(());
        }
        // One name is for both sides.
        let second = match tokens.peek() {
            Some(Ok((Token::Text(_), _))) => Some(tokens.text("a name of a medium")?),
            _ => None,
        };
        let names =
            [name.value.clone(), second.as_ref().map_or_else(|| name.value.clone(), |s| s.value.clone())];
        for (name, place) in [(&names[0], name.place), (&names[1], second.map_or(name.place, |s| s.place))] {
            if !name.is_empty() && self.media.find(name).is_none() {
                let hint = self.report.did_you_mean(name, self.media.all());
                self.report.warning(place, format!("there is no medium {}{hint}", quoted(name)));
            }
        }
        let is_empty = names.iter().all(String::is_empty);
        self.state.media = (!is_empty).then_some(Located { value: names, place: name.place });
        Ok(())
    }

    /// Says once that the media around a shape are not rendered.
    pub(crate) fn say_media(&mut self) {
        if let Some(media) = &self.state.media {
            let message = "media are not rendered: light goes through them as through nothing".to_owned();
            let place = media.place;
            self.report.warn_once(place, message);
        }
    }
}
